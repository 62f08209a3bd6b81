#include "frame/renderer.h"

#include "base/check.h"
#include "frame/frame_outcome.h"
#include "frame/gate_check.h"
#include "frame/rate_controller.h"
#include "frame/rate_steps.h"
#include "plan/conditions.h"
#include "plan/forced.h"
#include "scene/factor_rule.h"

#include <algorithm>
#include <cstring>
#include <set>

namespace tessera
{

namespace
{

// Rounds are counted in 16 bits (shade.h).
constexpr uint32_t kMostRounds = 0x8000;
// After so many nothing is taken for hidden.
constexpr uint32_t kMostHiddenRedraws = 3;

class SceneRenderer final : public Renderer
{
public:
	SceneRenderer(Device& device, const BuiltScene& scene, const TessellationTable& table, std::span<const PassDesc* const> passes,
				  const RenderOptions& options, std::span<const std::string_view> more_outputs)
		: device_(device), scene_(scene), table_(table), passes_(passes), outputs_(std::begin(kWantedOutputs), std::end(kWantedOutputs))
	{
		outputs_.insert(outputs_.end(), more_outputs.begin(), more_outputs.end());
		input_ = { options, scene.traits, sizesOf(scene, table), traitsOf(device), {}, {} };
	}

	Status initialize()
	{
		TRY(checkGates(device_, input_));
		TRY(force(input_));
		TRY_ASSIGN(resources_, FrameResources::create(device_, scene_, table_, input_));
		TRY_ASSIGN(runner_, PassRunner::create(device_, *resources_));
		wanted_ = outputs_;
		TRY_ASSIGN(plan_, planFor(framingCamera(scene_), {}));
		return {};
	}

	Result<FrameResult> renderFrame(const Camera& camera, const RoundReader& after_round) override
	{
		TRY(beginFrame({ camera, {}, {}, after_round }));
		for (;;)
		{
			TRY(resources_->commands().wait());
			TRY_ASSIGN(const std::optional<FrameResult> result, advance());
			if (result)
				return *result;
		}
	}

	Status beginFrame(const FrameRequest& request) override
	{
		CHECK(!runs_, "a frame is drawn already");
		controller_.beginFrame(!rate_changed_ && request.camera == camera_);
		rate_changed_ = false;
		camera_ = request.camera;
		drawn_from_ = request.drawn_from;
		wanted_ = outputs_;
		wanted_.insert(wanted_.end(), request.more_outputs.begin(), request.more_outputs.end());
		after_round_ = request.after_round;
		attempts_ = 0;
		hidden_redraws_ = 0;
		growNearlyFull(*resources_, input_);
		return startAttempt();
	}

	Result<std::optional<FrameResult>> pollFrame() override
	{
		CHECK(runs_, "no frame is drawn");
		const auto finished = resources_->commands().isFinished();
		runs_ = finished.has_value();
		TRY(finished);
		if (!*finished)
			return std::optional<FrameResult>();
		return advance();
	}

	void setRate(float rate_px) override
	{
		RenderOptions& options = input_.options;
		CHECK((rate_px > 0) == (options.rate > 0) && options.raster != Raster::Auto, "rate {} after {}", rate_px, options.rate);
		rate_changed_ = rate_px != options.rate;
		options.rate = rate_px;
	}

	Status setOptions(const RenderOptions& options) override
	{
		CHECK(!runs_, "a frame is drawn");
		PlanInput input = input_;
		input.options = options;
		TRY(checkGates(device_, input));
		TRY(force(input));
		TRY(resources_->refit(input_, input));
		input_ = std::move(input);
		rate_changed_ = true;
		occlusion_ = {};
		return {};
	}

	VkBuffer pictureBuffer() const override { return resources_->buffer("picture").handle(); }

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
	const DumpLayout& dumpLayout() const override { return resources_->dumpLayout(); }
	MemoryStats memory() const override { return resources_->memory(); }
	const View& view() const override { return view_; }
	const View& drawnView() const override { return drawn_from_ ? draw_view_ : view_; }

	std::vector<std::string> shaderNames() const override
	{
		std::set<std::string> names;
		for (const PlanStep& step : plan_.steps)
			names.insert(step.pass->shaders.begin(), step.pass->shaders.end());
		return { names.begin(), names.end() };
	}

	Result<size_t> replaceShaders(std::span<const Shader> shaders) override
	{
		CHECK(!runs_, "a frame is drawn");
		std::vector<Shader> changed;
		for (const Shader& shader : shaders)
		{
			TRY_ASSIGN(const Shader* before, runner_->shader(shader.name));
			if (before->words != shader.words)
				changed.push_back(shader);
		}
		if (!changed.empty())
			TRY(runner_->replaceShaders(changed, plan_, input_));
		return changed.size();
	}

private:
	// With any view: what one needs and another does not is forced for that alone.
	Status force(PlanInput& input) const
	{
		input.view = {};
		TRY_ASSIGN(input.forced, forcedBy(input.options.forced, passes_, resourceDescs(), outputs_, input));
		return {};
	}

	ViewRequest requestFor(const Attempt& attempt) const
	{
		ViewRequest request = { input_.options.width_px, input_.options.height_px };
		request.rate_px = coarsenedRate(double(input_.options.rate), attempt.coarsening);
		request.every_factor_one = attempt.coarsening == RateController::kMostCoarsening;
		request.displacement_scale = input_.options.displacement_scale;
		request.displacement_offset = input_.options.displacement_offset;
		request.metric = input_.options.metric;
		request.ray_falloff = kRayFalloff.holds(input_) ? input_.options.ray_falloff : 0;
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
		// What hides what is seen from where it is drawn, which says nothing of what the other camera sees.
		input_.view.is_seen_elsewhere = drawn_from_.has_value();
		input_.view.looks_for_hidden = occlusion_.looks() && !drawn_from_;
		input_.view.rate_px = request.rate_px;
		if (drawn_from_)
		{
			TRY_ASSIGN(draw_view_, drawnFrom(view_, camera, *drawn_from_, scene_, request));
		}
		resources_->sharedStructures().look(view_, input_);
		steps_.clear();
		if (kTessellates.holds(input_))
			steps_ = rateSteps(camera, view_, request, attempt.coarsening, bound.largest_factor, table_size, max_split);
		return planFrame(passes_, resourceDescs(), wanted_, input_);
	}

	// Plans the next attempt at the frame and submits its first round.
	Status startAttempt()
	{
		attempt_ = controller_.next();
		runs_ = false;
		if (attempt_.rounds > kMostRounds)
			return badInput("{}: the frame needs more than {} rounds; make its lists larger (--capacity)", scene_.path, kMostRounds);
		if (attempt_.rounds > 1 && tracesLight(input_))
			return badInput(
				"{}: the frame needs {} rounds, and shadows and ambient occlusion need all of it at once; make its lists larger (--capacity "
				"visible_clusters, full_clusters{})",
				scene_.path, attempt_.rounds, buildsClusters(input_) ? "; --max-cluster-data, --max-cluster-vertices" : "");
		++attempts_;
		grew_ = false;
		outcome_ = { true, true, attempt_.coarsening };
		TRY_ASSIGN(plan_, planFor(camera_, attempt_));
		TRY(resources_->prepare(plan_, input_));
		TRY(runner_->preparePipelines(plan_, input_));
		result_ = {};
		result_.rounds = attempt_.rounds;
		return submitRound(0);
	}

	Status submitRound(uint32_t round)
	{
		CommandRecorder& commands = resources_->commands();
		round_ = round;
		TRY(commands.begin());
		TRY(resources_->writeView(view_, round, plan_.has("depth_pyramid"), steps_));
		if (round == 0 && rounds_left_over_)
			resources_->clearVisibility();
		rounds_left_over_ = round + 1 < attempt_.rounds;
		TRY(runner_->record(plan_, input_, drawn_from_ ? &draw_view_ : nullptr));
		resources_->recordCountsReadback(commands.buffer());
		TRY(commands.submit());
		runs_ = true;
		return {};
	}

	// A round is finished: takes what the device says of it. Submits the next round or attempt, or ends the frame.
	Result<std::optional<FrameResult>> advance()
	{
		runs_ = false;
		TRY(endRound());
		const bool goes_on = outcome_.fits && !grew_ && (attempt_.rounds == 1 || outcome_.coarsening == attempt_.coarsening);
		if (goes_on && round_ + 1 < attempt_.rounds)
		{
			TRY(submitRound(round_ + 1));
			return std::optional<FrameResult>();
		}
		grant(attempt_, result_);
		fillLists(*resources_, result_);
		result_.attempts = attempts_;
		result_.hidden_redraws = hidden_redraws_;
		if (grew_ || !controller_.accept(outcome_))
		{
			TRY(startAttempt());
			return std::optional<FrameResult>();
		}
		judgeOcclusion();
		return std::optional<FrameResult>(std::move(result_));
	}

	Status endRound()
	{
		TRY(runner_->readTimes());
		addTimes(*runner_, plan_, result_);
		judge(attempt_);
		TRY_ASSIGN(const bool rays_are_too_small, resources_->raysAreTooSmall(input_));
		grew_ |= rays_are_too_small;
		addCounts(*resources_, result_.counts);
		if (!outcome_.fits || grew_)
			return {};
		TRY_ASSIGN(grew_, resources_->growDump());
		takeHidden();
		return after_round_ && !grew_ ? after_round_(round_) : Status{};
	}

	// Goes on from what a whole picture says of what is hidden. Drawn again, other instances may turn out to be seen; but not for ever.
	void takeHidden()
	{
		if (grew_ || !plan_.has("measure_hidden") || !resources_->takeHidden())
			return;
		grew_ = true;
		if (++hidden_redraws_ == kMostHiddenRedraws)
			resources_->dropHidden();
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

	// What the device said: which rate, and did every list hold what was wanted at it?
	void judge(const Attempt& attempt)
	{
		const FrameCounts counts = resources_->counts();
		outcome_.coarsening = std::max(outcome_.coarsening, attempt.coarsening + counts.rate_step);
		if (kTessellates.holds(input_))
			judgeLevels(counts);
		if (counts.overflow == 0)
			return;
		const OverfullLists overfull = growOverfull(*resources_, input_);
		grew_ |= overfull.grew;
		outcome_.fits = false;
		// Without a rate that fits the lists are left overfull as they were; listed again they fit as they were counted.
		outcome_.rate_can_help = counts.listed_again != 0 && !overfull.of_clusters;
	}

	// Did looking for what is hidden pay in this frame?
	void judgeOcclusion()
	{
		const bool looked = result_.rounds == 1 && kLooksForHidden.holds(input_) && resources_->hadHistory();
		const OcclusionOutcome outcome = occlusionOutcome(result_);
		occlusion_.endFrame(looked ? &outcome : nullptr);
	}

	// More split levels than were planned for: rate_search has listed everything without them, and the next frame plans more. Where no
	// split was expected at all, there was no list for them: this frame is drawn again.
	void judgeLevels(const FrameCounts& counts)
	{
		const uint32_t levels = splitLevels(input_);
		if ((counts.levels_missing == 0 && counts.split_count[levels] == 0) || levels + 2 >= MAX_SPLIT_LEVELS)
			return;
		levels_needed_ = levels + 2;
		grew_ |= levels == 0;
	}

	Device& device_;
	const BuiltScene& scene_;
	const TessellationTable& table_;
	std::span<const PassDesc* const> passes_;
	std::vector<std::string_view> outputs_, wanted_;  // of every frame, and of this one
	PlanInput input_;
	FramePlan plan_;
	View view_ = {};
	std::unique_ptr<FrameResources> resources_;
	std::unique_ptr<PassRunner> runner_;
	RateController controller_;
	OcclusionController occlusion_;
	// The frame that is drawn, or was last.
	bool runs_ = false;  // a round is submitted and not yet taken
	Camera camera_ = {};
	std::optional<Camera> drawn_from_;
	View draw_view_ = {};
	RoundReader after_round_;
	uint32_t attempts_ = 0, round_ = 0, hidden_redraws_ = 0;
	Attempt attempt_;
	AttemptOutcome outcome_;
	FrameResult result_;
	bool rate_changed_ = false;
	std::vector<RateStep> steps_;    // candidates of the attempt
	bool rounds_left_over_ = false;  // the last attempt ended between rounds: what it saw is still in the visibility buffer
	uint32_t levels_needed_ = 0;     // more split levels than the host foresaw were needed
	bool grew_ =
		false;  // the frame must be drawn again at the same rate: with more levels, larger packings, or what turned out to be seen as fine as it is
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
