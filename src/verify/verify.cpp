#include "verify/verify.h"

#include "base/log.h"
#include "frame/lists.h"
#include "scene/factor_rule.h"
#include "verify/bounds_check.h"
#include "verify/finite_check.h"
#include "verify/holes_check.h"
#include "verify/leak_check.h"
#include "verify/overlay.h"
#include "verify/paths_check.h"
#include "verify/watertight_check.h"

#include <algorithm>

namespace tessera::verify
{

namespace
{

// Depth of the compute rasteriser on two devices: interpolated in float from equal vertices.
constexpr double kDeviceDepthRoom = 1e-6;

std::vector<NamedCheck> allChecks()
{
	return {
		{ kWatertight, "gap, mesh units", {} }, { kNoHoles, "part of a base triangle", {} },      { kNoLeaks, "pixels", {} },
		{ kConservative, "depth", {} },         { kDeterministic, "mesh units or counts", {} },   { kPaths, "pixels from an edge", {} },
		{ kFinite, "error, mesh units", {} },   { kDevices, "mesh units or relative depth", {} },
	};
}

// Twice the room in the lists that decide whether a frame fits.
RenderOptions withOtherCapacities(RenderOptions options, const BuiltScene& scene, const Device& device)
{
	const PlanInput input = { options, scene.traits, sizesOf(scene), traitsOf(device), {}, {} };
	const auto capacities = listCapacities(input);
	for (const std::string_view name : { "part_triangles", "split_triangles", "full_clusters", "visible_clusters" })
	{
		const ListDesc* list = findList(name);
		if (list && capacities)
			options.capacities[std::string(name)] = std::min((*capacities)[list->index] * 2, mostEntries(*list));
	}
	return options;
}

// All ways of drawing by one raster path.
struct PathSources
{
	Raster path = Raster::Soft;
	std::unique_ptr<FrameSource> uncut, culled;
	std::vector<std::unique_ptr<FrameSource>> variations;
};

class Run
{
public:
	explicit Run(const Request& request) : request_(request), truth_(*request.scene, *request.table, request.options.metric)
	{
		report_.checks = allChecks();
	}

	Result<Report> run()
	{
		TRY(makeFault());
		// Pipelines are specialised by whether the rate is 0.
		for (const bool zero : { false, true })
		{
			std::vector<float> rates;
			std::copy_if(request_.rates.begin(), request_.rates.end(), std::back_inserter(rates), [&](float rate) { return (rate == 0) == zero; });
			if (!rates.empty())
				TRY(runRates(rates));
		}
		return std::move(report_);
	}

private:
	const BuiltScene& given() const
	{
		return request_.fault == Fault::Crack || request_.fault == Fault::Drop || request_.fault == Fault::Nan ? faulty_.scene : *request_.scene;
	}
	const BuiltScene& givenToVariations() const { return request_.fault == Fault::Tie ? faulty_.scene : given(); }

	Status makeFault()
	{
		if (request_.fault == Fault::None || request_.fault == Fault::Cull)
			return {};
		TRY_ASSIGN(faulty_, withFault(*request_.scene, request_.fault, request_.seed));
		report_.injected = faulty_.what;
		return {};
	}

	Result<std::unique_ptr<FrameSource>> source(Device& device, const BuiltScene& scene, RenderOptions options, Raster path, float rate,
												bool with_micro, const Variation& variation) const
	{
		options.raster = path;
		options.rate = rate;
		return FrameSource::create(device, truth_, scene, *request_.table, options, with_micro, variation, request_.seed);
	}

	Result<PathSources> makeSources(Raster path, float rate)
	{
		PathSources sources;
		sources.path = path;
		Device& device = *request_.device;
		const RenderOptions& uncut = request_.uncut_options;
		TRY_ASSIGN(sources.uncut, source(device, given(), uncut, path, rate, true, {}));
		if (request_.options.cull.any() && request_.fault != Fault::Cull)
		{
			TRY_ASSIGN(sources.culled, source(device, given(), request_.options, path, rate, false, {}));
		}
		const RenderOptions roomy = withOtherCapacities(uncut, *request_.scene, device);
		const Variation other_groups = { "other workgroup sizes and kernels, height maps as texels",
										 false,
										 device.is_cpu ? 64u : 128u,
										 device.limits.mesh_workgroup_threads == 32 ? 64u : 32u,
										 std::max(1u, device.limits.loop_workgroups / 3),
										 true,
										 true };
		Variation everything = other_groups;
		everything.name = "other capacities, workgroup sizes and kernels, height maps as texels, shuffled";
		everything.shuffled = true;
		std::vector<std::pair<RenderOptions, Variation>> ways = { { roomy, everything } };
		if (!request_.one_variation)
			ways = { { roomy, { "other capacities" } }, { uncut, other_groups }, { uncut, { "shuffled instances and clusters", true } } };
		for (const auto& [options, variation] : ways)
		{
			TRY_ASSIGN(auto varied, source(device, givenToVariations(), options, path, rate, true, variation));
			sources.variations.push_back(std::move(varied));
		}
		return sources;
	}

	Status runRates(const std::vector<float>& rates)
	{
		std::vector<PathSources> paths;
		for (const Raster path : request_.paths)
		{
			TRY_ASSIGN(PathSources sources, makeSources(path, rates.front()));
			paths.push_back(std::move(sources));
		}
		std::unique_ptr<FrameSource> other;
		if (request_.other_device)
		{
			TRY_ASSIGN(other,
					   source(*request_.other_device, *request_.scene, request_.uncut_options, request_.paths.front(), rates.front(), true, {}));
		}
		size_t done = 0;
		for (const NamedCamera& camera : request_.cameras)
			for (const float rate : rates)
			{
				if (request_.tells_progress)
					logInfo("verifying camera {}, rate {} ({} of {})", camera.name, rate, ++done, request_.cameras.size() * rates.size());
				TRY(runFrame(camera, rate, paths, other.get()));
			}
		return {};
	}

	Status runFrame(const NamedCamera& camera, float rate, std::vector<PathSources>& paths, FrameSource* other)
	{
		const uint64_t before = report_.violations();
		marks_ = {};
		Capture first;
		for (PathSources& path : paths)
		{
			frame_ = fmt::format("camera {}, rate {}, {}", camera.name, rate, rasterName(path.path));
			TRY_ASSIGN(Capture uncut, path.uncut->capture(camera.camera, rate));
			if (first.visible.pixels.empty() || !sameMicro(first, uncut, path.path))
				checkGeometry(uncut);
			const Screen screen(truth_, uncut.view);
			add(kNoLeaks, Silhouette(screen, uncut.micro).leaks(uncut.visible));
			TRY(checkCulling(path, camera, rate, screen, uncut));
			TRY(checkVariations(path, camera, rate, uncut));
			if (first.visible.pixels.empty())
				first = std::move(uncut);
			else if (first.result.rate_granted == uncut.result.rate_granted)
				add(kPaths, checkPaths(screen, uncut.micro, first.visible, uncut.visible, std::string(rasterName(path.path))));
		}
		if (other)
			TRY(checkDevices(*other, camera, rate, first));
		const FrameResult& result = first.result;
		const uint64_t violations = report_.violations() - before;
		if (report_.picture.empty() || violations > most_violations_)
		{
			most_violations_ = violations;
			report_.picture = request_.paints_violations ? paintViolations(first.visible, first.picture, marks_) : first.picture;
			report_.picture_frame = fmt::format("camera {}, rate {}", camera.name, rate);
		}
		report_.frames.push_back({ camera.name, result.rate_wanted, result.rate_granted, result.every_factor_one, result.counts.micro_triangles,
								   first.visible.covered(), violations });
		return {};
	}

	void add(std::string_view check, CheckResult result)
	{
		result.setFrame(frame_);
		marks_.merge(result);
		report_.check(check).merge(result);
	}

	// Every raster path draws the same micro-triangles, or is checked for itself.
	bool sameMicro(const Capture& first, const Capture& uncut, Raster path)
	{
		const CheckResult same = compareMicro(first.micro, uncut.micro, fmt::format("--raster {}'s", rasterName(request_.paths.front())));
		const bool equal = same.violations == 0;
		if (first.result.rate_granted == uncut.result.rate_granted)
			add(kDeterministic, same);
		if (!equal)
			logInfo("{} draws other micro-triangles", rasterName(path));
		return equal;
	}

	void checkGeometry(const Capture& uncut)
	{
		const Screen screen(truth_, uncut.view);
		add(kWatertight, checkWatertight(truth_, uncut.micro));
		add(kNoHoles, checkHoles(truth_, uncut.micro));
		add(kConservative, checkBounds(truth_, uncut.view, uncut.micro));
		add(kFinite, checkFinite(truth_, uncut.view, screen, uncut.micro));
		const uint32_t table_size = request_.table->max_edge_segments;
		const FactorRule rule = factorRule(uncut.view, table_size, std::min(request_.uncut_options.max_split, table_size));
		const std::vector<ClusterRef> all = reference::allClusters(truth_);
		MicroSet expected = referenceMicro(truth_, uncut.view, reference::classify(truth_, uncut.view, rule, all));
		sortMicro(expected);
		add(kDeterministic, compareMicro(expected, uncut.micro, "the CPU's"));
		report_.seams.merge(measureSeams(truth_, uncut.view, screen, uncut.micro));
		if (request_.usual_way)
		{
			report_.usual_way.merge(measureUsualWay(truth_, uncut.view, uncut.micro));
			report_.usual_way.lost = std::max(report_.usual_way.lost, lostTheUsualWay(uncut.result));
		}
	}

	// A fault in culling is made for what is seen first.
	Status makeCullFault(PathSources& path, const NamedCamera& camera, float rate, const Capture& uncut)
	{
		if (request_.fault != Fault::Cull || path.culled || !request_.options.cull.any())
			return {};
		if (report_.injected.empty() && uncut.visible.covered() > 0)
		{
			TRY_ASSIGN(faulty_, withCullFault(*request_.scene, uncut.visible, camera.camera, request_.seed));
			report_.injected = faulty_.what;
		}
		if (!report_.injected.empty())
		{
			TRY_ASSIGN(path.culled, source(*request_.device, faulty_.scene, request_.options, path.path, rate, false, {}));
		}
		return {};
	}

	Status checkCulling(PathSources& path, const NamedCamera& camera, float rate, const Screen& screen, const Capture& uncut)
	{
		TRY(makeCullFault(path, camera, rate, uncut));
		if (!path.culled)
			return {};
		// Once after the frame of another camera and once after its own: culling may remember what was seen before.
		for (int time = 0; time < 2; ++time)
		{
			TRY_ASSIGN(const Capture culled, path.culled->capture(camera.camera, rate));
			CheckResult result;
			if (culled.result.rate_granted == uncut.result.rate_granted && culled.result.every_factor_one == uncut.result.every_factor_one)
				result = checkConservative(screen, uncut.micro, uncut.visible, culled.drawn, culled.visible);
			else
				++result.sums["frames not compared: other granted rates"];
			add(kConservative, std::move(result));
		}
		return {};
	}

	Status checkVariations(PathSources& path, const NamedCamera& camera, float rate, const Capture& uncut)
	{
		TRY_ASSIGN(const Capture again, path.uncut->capture(camera.camera, rate));
		add(kDeterministic, compareFrames(uncut, again, "again"));
		for (const auto& variation : path.variations)
		{
			TRY_ASSIGN(const Capture varied, variation->capture(camera.camera, rate));
			add(kDeterministic, compareFrames(uncut, varied, variation->variation().name));
		}
		return {};
	}

	Status checkDevices(FrameSource& other, const NamedCamera& camera, float rate, const Capture& first)
	{
		frame_ = fmt::format("camera {}, rate {}, {}", camera.name, rate, rasterName(request_.paths.front()));
		TRY_ASSIGN(const Capture there, other.capture(camera.camera, rate));
		CheckResult result = compareMicro(first.micro, there.micro, "the first device's");
		// Only the compute rasteriser decides in integers which pixels a triangle covers; the others round as their device does.
		const bool decides_exactly = request_.paths.front() == Raster::Soft;
		result.merge(decides_exactly ? comparePictures(first.visible, there.visible, "the other device", kDeviceDepthRoom)
									 : checkPaths(Screen(truth_, first.view), first.micro, first.visible, there.visible, "the other device"));
		add(kDevices, std::move(result));
		return {};
	}

	const Request& request_;
	reference::HostScene truth_;
	FaultyScene faulty_;
	Report report_;
	std::string frame_;
	CheckResult marks_;  // of all checks, in the frame being checked
	uint64_t most_violations_ = 0;
};

}  // namespace

uint64_t Report::violations() const
{
	uint64_t sum = 0;
	for (const NamedCheck& check : checks)
		sum += check.result.violations;
	return sum;
}

CheckResult& Report::check(std::string_view name)
{
	return std::find_if(checks.begin(), checks.end(), [&](const NamedCheck& check) { return check.name == name; })->result;
}

Result<Report> run(const Request& request)
{
	return Run(request).run();
}

std::vector<Raster> rasterPaths(const Device& device)
{
	std::vector<Raster> paths;
	if (device.gates.buffer_atomics_64)
		paths.push_back(Raster::Soft);
	if (device.gates.mesh_shader)
		paths.push_back(Raster::Mesh);
	if (device.gates.fragment_primitive_id)
		paths.push_back(Raster::Indexed);
	if (device.gates.rays())
		paths.push_back(Raster::Rt);
	return paths;
}

}  // namespace tessera::verify
