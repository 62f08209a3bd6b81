#include "frame/renderer.h"

#include "base/check.h"
#include "frame/occlusion_controller.h"
#include "frame/pass_runner.h"
#include "frame/rate_controller.h"
#include "frame/rate_steps.h"
#include "plan/conditions.h"
#include "scene/factor_rule.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace tessera
{

namespace
{

Status checkGates(const Device& device, const PlanInput& input)
{
	const RenderOptions& options = input.options;
	const Raster raster = chosenRaster(input);
	if (raster == Raster::Soft && !device.gates.buffer_atomics_64)
		return fail(ExitCode::DeviceCannot, "--raster soft: {} lacks 64-bit buffer atomics; --raster mesh or indexed needs none", device.name);
	if (raster == Raster::Mesh && !device.gates.mesh_shader)
		return fail(ExitCode::DeviceCannot, "--raster mesh: {} lacks VK_EXT_mesh_shader; --raster indexed needs no mesh shaders", device.name);
	if (raster == Raster::Indexed && !device.gates.fragment_primitive_id)
		return fail(ExitCode::DeviceCannot, "--raster indexed: {} lacks primitive ids in fragment shaders (geometryShader) or 32-bit indices",
					device.name);
	if (options.width_px == 0 || options.height_px == 0 || std::max(options.width_px, options.height_px) > device.limits.max_image_extent)
		return fail(ExitCode::Usage, "--size {}x{}: {} can draw from 1x1 to {}x{}", options.width_px, options.height_px, device.name,
					device.limits.max_image_extent, device.limits.max_image_extent);
	return {};
}

// Rounds are counted in 16 bits (shade.h).
constexpr uint32_t kMostRounds = 0x8000;

class SceneRenderer final : public Renderer
{
public:
	SceneRenderer(Device& device, const BuiltScene& scene, const TessellationTable& table, std::span<const PassDesc* const> passes,
				  const RenderOptions& options, std::span<const std::string_view> more_outputs)
		: device_(device), scene_(scene), table_(table), passes_(passes), outputs_(std::begin(kWantedOutputs), std::end(kWantedOutputs))
	{
		outputs_.insert(outputs_.end(), more_outputs.begin(), more_outputs.end());
		input_ = { options, scene.traits, sizesOf(scene), traitsOf(device), {} };
	}

	Status initialize()
	{
		TRY(checkGates(device_, input_));
		TRY_ASSIGN(resources_, FrameResources::create(device_, scene_, table_, input_));
		TRY_ASSIGN(runner_, PassRunner::create(device_, *resources_));
		TRY_ASSIGN(plan_, planFor(framingCamera(scene_), {}));
		return {};
	}

	Result<FrameResult> renderFrame(const Camera& camera, const RoundReader& after_round) override
	{
		controller_.beginFrame(!rate_changed_ && camera == last_camera_);
		rate_changed_ = false;
		last_camera_ = camera;
		after_round_ = after_round;
		growAhead();
		for (uint32_t attempts = 1;; ++attempts)
		{
			const Attempt attempt = controller_.next();
			if (attempt.rounds > kMostRounds)
				return badInput("{}: the frame needs more than {} rounds; make its lists larger (--capacity)", scene_.path, kMostRounds);
			TRY_ASSIGN(FrameResult result, drawAttempt(camera, attempt));
			result.attempts = attempts;
			if (grew_)
				continue;
			if (!controller_.accept(outcome_))
				continue;
			judgeOcclusion(result);
			return result;
		}
	}

	void setRate(float rate_px) override
	{
		RenderOptions& options = input_.options;
		CHECK((rate_px > 0) == (options.rate > 0) && options.raster != Raster::Auto, "rate {} after {}", rate_px, options.rate);
		rate_changed_ = rate_px != options.rate;
		options.rate = rate_px;
	}

	Result<std::vector<uint8_t>> readPicture() override
	{
		const uint64_t bytes = uint64_t(input_.options.width_px) * input_.options.height_px * 4;
		TRY_ASSIGN(const std::vector<std::byte> raw, resources_->read("picture", bytes));
		std::vector<uint8_t> picture(raw.size());
		std::memcpy(picture.data(), raw.data(), raw.size());
		return picture;
	}

	Result<std::vector<std::byte>> readResource(std::string_view name) override
	{
		uint64_t bytes = UINT64_MAX;
		if (const ListDesc* list = findList(name))
		{
			const ListHead head = resources_->head(list->index);
			bytes = uint64_t(std::min(head.wanted, head.capacity)) * list->record_bytes;
		}
		return resources_->read(name, bytes);
	}

	const FramePlan& plan() const override { return plan_; }
	const PlanInput& planInput() const override { return input_; }
	MemoryStats memory() const override { return resources_->memory(); }
	const View& view() const override { return view_; }

private:
	ViewRequest requestFor(const Attempt& attempt) const
	{
		ViewRequest request = { input_.options.width_px, input_.options.height_px };
		request.rate_px = coarsenedRate(double(input_.options.rate), attempt.coarsening);
		request.every_factor_one = attempt.coarsening == RateController::kMostCoarsening;
		request.displacement_scale = input_.options.displacement_scale;
		return request;
	}

	Result<FramePlan> planFor(const Camera& camera, const Attempt& attempt)
	{
		const ViewRequest request = requestFor(attempt);
		TRY_ASSIGN(view_, makeView(camera, scene_, request));
		const uint32_t table_size = table_.max_edge_segments, max_split = std::min(input_.options.max_split, table_size);
		const FactorRule rule = factorRule(view_, table_size, max_split);
		const FactorBound bound = boundFactors(camera, scene_, request, rule.table_size, rule.max_split);
		input_.view.factors_above_one = bound.above_one;
		input_.view.split_levels = bound.split_levels > 0 || levels_needed_ > 0 ? std::max(bound.split_levels, levels_needed_) : 0;
		input_.view.rounds = attempt.rounds;
		input_.view.looks_for_hidden = occlusion_.looks();
		input_.view.rate_px = request.rate_px;
		steps_.clear();
		if (kTessellates.holds(input_))
			steps_ = rateSteps(camera, view_, request, attempt.coarsening, bound.largest_factor, table_size, max_split);
		return planFrame(passes_, resourceDescs(), outputs_, input_);
	}

	// One attempt: plans, draws all rounds, and leaves in outcome_ whether everything fitted at one rate.
	Result<FrameResult> drawAttempt(const Camera& camera, const Attempt& attempt)
	{
		grew_ = false;
		outcome_ = { true, true, attempt.coarsening };
		TRY_ASSIGN(plan_, planFor(camera, attempt));
		TRY(resources_->prepare(plan_, input_));
		TRY(runner_->preparePipelines(plan_, input_));
		FrameResult result;
		result.rounds = attempt.rounds;
		const auto goes_on = [&] {
			return outcome_.fits && !grew_ && (attempt.rounds == 1 || outcome_.coarsening == attempt.coarsening);
		};
		for (uint32_t round = 0; round < attempt.rounds && goes_on(); ++round)
			TRY(drawRound(attempt, round, result));
		grant(attempt, result);
		fillLists(result);
		return result;
	}

	// What the device made of the rate, as if it had been asked for.
	void grant(const Attempt& attempt, FrameResult& result)
	{
		result.rate_wanted = double(input_.options.rate);
		result.rate_granted = coarsenedRate(result.rate_wanted, outcome_.coarsening);
		result.coarsening = outcome_.coarsening;
		const uint32_t step = outcome_.coarsening - attempt.coarsening;
		if (step == 0)
		{
			result.every_factor_one = outcome_.coarsening > 0 && !kTessellates.holds(input_);
			return;
		}
		view_.rate_over_focal_squared = steps_[step].rate_over_focal_squared;
		view_.sample_over_focal_squared = steps_[step].sample_over_focal_squared;
		result.every_factor_one = step + 1 == steps_.size();
	}

	Status drawRound(const Attempt& attempt, uint32_t round, FrameResult& result)
	{
		CommandRecorder& commands = resources_->commands();
		TRY(commands.begin());
		TRY(resources_->writeView(view_, round, plan_.has("depth_pyramid"), steps_));
		if (round == 0 && rounds_left_over_)
			resources_->clearVisibility();
		rounds_left_over_ = round + 1 < attempt.rounds;
		TRY(runner_->record(plan_, input_));
		resources_->recordCountsReadback(commands.buffer());
		TRY(commands.submitAndWait());
		TRY(runner_->readTimes());
		addTimes(result);
		judge(attempt);
		addCounts(result);
		if (!outcome_.fits || grew_)
			return {};
		TRY_ASSIGN(grew_, resources_->growDump());
		return after_round_ && !grew_ ? after_round_(round) : Status{};
	}

	void addTimes(FrameResult& result) const
	{
		result.gpu_ms += runner_->totalMs();
		for (size_t i = 0; i < plan_.steps.size(); ++i)
		{
			const std::string_view name = plan_.steps[i].pass->name;
			auto found = std::find_if(result.passes.begin(), result.passes.end(), [&](const PassTime& time) { return time.name == name; });
			if (found == result.passes.end())
				found = result.passes.insert(result.passes.end(), { std::string(name), 0 });
			found->gpu_ms += runner_->stepMs()[i];
		}
	}

	// What the device said: which rate, and did every list hold what was wanted at it?
	void judge(const Attempt& attempt)
	{
		const FrameCounts counts = resources_->counts();
		outcome_.coarsening = std::max(outcome_.coarsening, attempt.coarsening + counts.rate_step);
		if (kTessellates.holds(input_))
			judgeLevels(counts);
		if (counts.overflow == 0)
			return;
		bool clusters = false;
		for (const ListDesc& list : listDescs())
		{
			const ListHead head = resources_->head(list.index);
			if (head.wanted <= head.capacity)
				continue;
			grew_ |= resources_->grow(list, head.wanted, input_);
			clusters |= list.index == LIST_CLUSTER_GROUPS || list.index == LIST_VISIBLE_CLUSTERS || list.index == LIST_FULL_CLUSTERS;
		}
		outcome_.fits = false;
		// Without a rate that fits the lists are left overfull as they were; listed again they fit as they were counted.
		outcome_.rate_can_help = counts.listed_again != 0 && !clusters;
	}

	// Did looking for what is hidden pay in this frame?
	void judgeOcclusion(const FrameResult& result)
	{
		const auto took = [&](std::string_view pass) {
			const auto found = std::find_if(result.passes.begin(), result.passes.end(), [&](const PassTime& time) { return time.name == pass; });
			return found == result.passes.end() ? 0 : found->gpu_ms;
		};
		OcclusionOutcome outcome;
		outcome.parts = result.counts.part_triangles;
		outcome.left_out = result.counts.hidden_parts - std::min(result.counts.hidden_parts, result.counts.revealed_parts);
		outcome.raster_ms = took("raster_micro");
		outcome.looking_ms = took("depth_pyramid") + took("retest_parts") + took("raster_revealed");
		const bool looked = result.rounds == 1 && plan_.has("depth_pyramid") && resources_->hadHistory();
		occlusion_.endFrame(looked ? &outcome : nullptr);
	}

	// More split levels than were planned for: rate_search has listed everything without them, and the next frame plans more. Where no
	// split was expected at all, there was no list for them: this frame is drawn again.
	void judgeLevels(const FrameCounts& counts)
	{
		const uint32_t levels = kSplits.holds(input_) ? input_.view.split_levels : 0;
		if ((counts.levels_missing == 0 && counts.split_count[levels] == 0) || levels + 2 >= MAX_SPLIT_LEVELS)
			return;
		levels_needed_ = levels + 2;
		grew_ |= levels == 0;
	}

	// Packings that the last frame nearly filled grow before they are too small, so that a moving camera seldom draws a frame twice.
	void growAhead()
	{
		for (const ListDesc& list : listDescs())
		{
			if (!growsOnDemand(list) || !resources_->has(list.name))
				continue;
			const ListHead head = resources_->head(list.index);
			if (head.wanted <= head.capacity && uint64_t(head.wanted) * 10 > uint64_t(resources_->capacity(list.name)) * 9)
				resources_->grow(list, head.wanted, input_);
		}
	}

	void addCounts(FrameResult& result) const
	{
		const FrameCounts counts = resources_->counts();
		FrameCountsRead& sum = result.counts;
		sum.visible_clusters += resources_->head(LIST_VISIBLE_CLUSTERS).wanted;
		sum.full_clusters += resources_->head(LIST_FULL_CLUSTERS).wanted;
		sum.part_triangles += resources_->head(LIST_PART_TRIANGLES).wanted;
		sum.split_triangles += resources_->head(LIST_SPLIT_TRIANGLES).wanted;
		sum.micro_triangles += (uint64_t(counts.micro_high) << 32 | counts.micro_low) + counts.full_cluster_triangles;
		sum.hidden_parts += counts.hidden_parts;
		sum.revealed_parts += counts.revealed_parts;
		sum.covered_pixels = counts.covered_pixels;  // of the whole depth image, so the last round's count is the frame's
	}

	void fillLists(FrameResult& result) const
	{
		for (const ListDesc& list : listDescs())
		{
			if (!resources_->has(list.name))
				continue;
			const ListHead head = resources_->head(list.index);
			result.lists.push_back({ std::string(list.name), head.wanted, head.capacity, head.peak, head.peak_used, listBytes(list, head.capacity) });
		}
	}

	Device& device_;
	const BuiltScene& scene_;
	const TessellationTable& table_;
	std::span<const PassDesc* const> passes_;
	std::vector<std::string_view> outputs_;
	PlanInput input_;
	FramePlan plan_;
	View view_ = {};
	std::unique_ptr<FrameResources> resources_;
	std::unique_ptr<PassRunner> runner_;
	RateController controller_;
	OcclusionController occlusion_;
	AttemptOutcome outcome_;
	Camera last_camera_ = {};
	RoundReader after_round_;
	bool rate_changed_ = false;
	std::vector<RateStep> steps_;    // candidates of the attempt
	bool rounds_left_over_ = false;  // the last attempt ended between rounds: what it saw is still in the visibility buffer
	uint32_t levels_needed_ = 0;     // more split levels than the host foresaw were needed
	bool grew_ = false;              // the frame must be drawn again with more levels or larger packings, at the same rate
};

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(Device& device, const BuiltScene& scene, const TessellationTable& table,
												   std::span<const PassDesc* const> passes, const RenderOptions& options,
												   std::span<const std::string_view> more_outputs)
{
	auto renderer = std::make_unique<SceneRenderer>(device, scene, table, passes, options, more_outputs);
	TRY(renderer->initialize());
	return renderer;
}

}  // namespace tessera
