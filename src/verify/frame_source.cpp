#include "verify/frame_source.h"

#include "pipeline/passes.h"
#include "verify/random.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>

namespace tessera::verify
{

namespace
{

void shuffle(std::span<uint32_t> order, Random& random)
{
	for (size_t i = order.size(); i > 1; --i)
		std::swap(order[i - 1], order[random.below(i)]);
}

template <typename T>
void permute(std::vector<T>& items, const std::vector<uint32_t>& order)
{
	const std::vector<T> before = items;
	for (size_t i = 0; i < items.size(); ++i)
		items[i] = before[order[i]];
}

// The same scene with instances and clusters in another order. order(shuffled) = original.
void shuffleScene(BuiltScene& scene, SceneOrder& order, uint64_t seed)
{
	Random random(seed);
	order.instances.resize(scene.instances.size());
	order.clusters.resize(scene.clusters.size());
	std::iota(order.instances.begin(), order.instances.end(), 0u);
	std::iota(order.clusters.begin(), order.clusters.end(), 0u);
	shuffle(order.instances, random);
	for (const MeshRecord& mesh : scene.meshes)
		shuffle(std::span(order.clusters).subspan(mesh.first_cluster, mesh.cluster_count), random);
	permute(scene.instances, order.instances);
	permute(scene.clusters, order.clusters);
	permute(scene.cluster_bounds, order.clusters);
}

// The device with other numbers of threads, until the end of the scope.
class OtherLimits
{
public:
	OtherLimits(Device& device, const Variation& variation) : device_(device), before_(device.limits)
	{
		if (variation.compute_threads > 0)
			device.limits.compute_workgroup_threads = variation.compute_threads;
		if (variation.mesh_threads > 0)
			device.limits.mesh_workgroup_threads = variation.mesh_threads;
		if (variation.loop_workgroups > 0)
			device.limits.loop_workgroups = variation.loop_workgroups;
		if (variation.height_texels)
			device.limits.most_footprint_bytes = 0;
		if (variation.other_kernels)
			device.limits.most_small_rate_px = device.limits.most_small_rate_px > 0 ? 0.0f : 16.0f;
	}
	~OtherLimits() { device_.limits = before_; }
	OtherLimits(const OtherLimits&) = delete;
	OtherLimits& operator=(const OtherLimits&) = delete;

private:
	Device& device_;
	DeviceLimits before_;
};

void compareCount(const char* name, uint64_t expected, uint64_t found, const std::string& what, CheckResult& result)
{
	if (expected != found)
		result.violation(std::abs(double(expected) - double(found)), nowhere(fmt::format("{}: {} {}, not {}", what, found, name, expected)));
}

void compareColors(const Capture& expected, const Capture& found, const std::string& what, CheckResult& result)
{
	const auto& pixels = expected.visible.pixels;
	for (size_t i = 0; i < std::min({ pixels.size(), expected.picture.size() / 4, found.picture.size() / 4 }); ++i)
	{
		if (std::memcmp(&expected.picture[4 * i], &found.picture[4 * i], 4) == 0 || pixels[i].identity != found.visible.pixels[i].identity)
			continue;
		result.violation(0, { pixels[i].identity.cluster(),
							  pixels[i].identity.triangle(),
							  kNoPoint,
							  fmt::format("{}: pixel {}, {} has another colour", what, i % expected.visible.width_px, i / expected.visible.width_px),
							  {} });
	}
}

}  // namespace

Result<std::unique_ptr<FrameSource>> FrameSource::create(Device& device, const reference::HostScene& truth, const BuiltScene& given,
														 const TessellationTable& table, const RenderOptions& options, bool with_micro,
														 const Variation& variation, uint64_t seed)
{
	std::unique_ptr<FrameSource> source(new FrameSource(device, truth));
	source->variation_ = variation;
	source->with_micro_ = with_micro;
	if (variation.shuffled)
	{
		source->shuffled_ = given;
		shuffleScene(source->shuffled_, source->order_, seed);
	}
	const OtherLimits other(device, variation);
	const std::span<const std::string_view> outputs = with_micro ? std::span<const std::string_view>(kDumpAndVisibilityOutputs) : kVisibilityOutputs;
	// What a frame is may not depend on those before it: they are compared.
	RenderOptions alone = options;
	alone.ray_hidden = false;
	TRY_ASSIGN(source->renderer_, Renderer::create(device, variation.shuffled ? source->shuffled_ : given, table, framePasses(), alone, outputs));
	return source;
}

Status FrameSource::checkExistence(const FrameDump& dump) const
{
	const BuiltScene& scene = truth_.built();
	for (const ClusterRef ref : dump.visible)
		if (ref.instance >= scene.instances.size() || ref.cluster >= scene.clusters.size())
			return fail(ExitCode::CheckFailed, "the frame has cluster {} of instance {}, and the scene has {} and {}", ref.cluster, ref.instance,
						scene.clusters.size(), scene.instances.size());
	for (const DomainPiece& part : dump.parts)
		if (part.triangle >= clusterTriangles(scene.clusters[order_(dump.visible[part.visible_cluster]).cluster]))
			return fail(ExitCode::CheckFailed, "the frame has a part of triangle {}, which its cluster lacks", part.triangle);
	return {};
}

Status FrameSource::readRound(uint32_t round, Capture& capture)
{
	if (round == 0)
	{
		capture = {};
		capture.visible.width_px = renderer_->planInput().options.width_px;
		capture.visible.height_px = renderer_->planInput().options.height_px;
	}
	TRY_ASSIGN(const FrameDump dump, with_micro_ ? readDump(*renderer_) : readLists(*renderer_));
	TRY(checkExistence(dump));
	TRY_ASSIGN(const std::vector<uint64_t> words, readVisibility(*renderer_));
	addRound(dump, order_, words, capture.visible);
	addDrawn(dump, order_, capture.drawn);
	if (with_micro_)
		appendDump(truth_, dump, order_, capture.micro);
	return {};
}

Result<Capture> FrameSource::capture(const Camera& camera, float rate_px, bool sorts)
{
	const OtherLimits other(device_, variation_);
	Capture capture;
	renderer_->setRate(rate_px);
	TRY_ASSIGN(FrameResult result, renderer_->renderFrame(camera, [&](uint32_t round) { return readRound(round, capture); }));
	capture.result = std::move(result);
	capture.view = renderer_->view();
	TRY_ASSIGN(capture.picture, renderer_->readPicture());
	if (sorts)
	{
		sortMicro(capture.micro);
		sortDrawn(capture.drawn);
	}
	return capture;
}

CheckResult compareFrames(const Capture& expected, const Capture& found, const std::string& what)
{
	CheckResult result;
	if (expected.result.rate_granted != found.result.rate_granted || expected.result.every_factor_one != found.result.every_factor_one)
	{
		++result.sums["frames not compared: other granted rates"];
		return result;
	}
	++result.sums["frames compared"];
	result.merge(comparePictures(expected.visible, found.visible, what));
	compareColors(expected, found, what, result);
	if (!expected.micro.empty() && !found.micro.empty())
		result.merge(compareMicro(expected.micro, found.micro, "the first frame's; " + what));
	const FrameCountsRead &a = expected.result.counts, &b = found.result.counts;
	compareCount("full clusters", a.full_clusters, b.full_clusters, what, result);
	compareCount("visible clusters", a.visible_clusters, b.visible_clusters, what, result);
	compareCount("part triangles", a.part_triangles, b.part_triangles, what, result);
	compareCount("split triangles", a.split_triangles, b.split_triangles, what, result);
	compareCount("micro-triangles", a.micro_triangles, b.micro_triangles, what, result);
	if (result.sums["ties"] == 0)
		compareCount("covered pixels", a.covered_pixels, b.covered_pixels, what, result);
	return result;
}

}  // namespace tessera::verify
