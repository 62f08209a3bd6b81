// rate_search: lists that are too small, in turn and together, down to the smallest legal sizes. The frame is coarser and whole, at the
// smallest j that fits by the CPU reference's count, without asking the host.
#include "gpu_test.h"

#include "frame/pass_runner.h"
#include "frame/rate_steps.h"
#include "pipeline/passes.h"
#include "scene/factor_rule.h"

#include <algorithm>

namespace tessera::test
{

namespace
{

using rateSearch = GpuTest;
using Capacities = std::map<std::string, uint32_t>;

RenderOptions uncut(float rate, Raster raster)
{
	RenderOptions options = smallOptions(rate);
	options.raster = raster;
	options.cull = { false, false, false };
	return options;
}

using Demand = std::map<std::string, uint64_t>;

// What a frame wants of its lists at coarsening j, by the reference.
Demand demandAt(const GpuFrame& frame, const Camera& camera, uint32_t j)
{
	const RenderOptions& options = frame.renderer->planInput().options;
	ViewRequest request = { options.width_px, options.height_px };
	request.rate_px = coarsenedRate(double(options.rate), j);
	const View view = *makeView(camera, frame.scene.built, request);
	const reference::HostScene& host = frame.scene.host;
	const reference::Classified made = reference::classify(host, view, factorRule(view, 11, options.max_split), frame.visible);
	uint64_t vertices = 0;
	for (const reference::ReferencePiece& part : made.parts)
		vertices += patternVertices(host.pattern(part.piece));
	for (const ClusterRef& full : made.full_clusters)
		vertices += clusterVertices(host.cluster(full));
	return { { "part_triangles", made.parts.size() },
			 { "split_triangles", made.splits.size() },
			 { "full_clusters", made.full_clusters.size() },
			 { "micro_vertices", vertices },
			 { "expanded_triangles", made.microTriangles() } };
}

bool fits(const Demand& demand, const Capacities& capacities)
{
	return std::all_of(capacities.begin(), capacities.end(), [&](const auto& list) {
		const auto found = demand.find(list.first);
		return found == demand.end() || found->second <= list.second;
	});
}

// The granted j fits, no smaller one does; nothing is lost; a further frame changes nothing.
void expectSmallestThatFits(GpuFrame& frame, const Camera& camera, const Capacities& capacities, const std::string& what)
{
	ASSERT_EQ(frame.result.rounds, 1u) << what;
	EXPECT_EQ(frame.result.attempts, 1u) << what << ": the host was asked";
	const uint32_t j = frame.result.coarsening;
	EXPECT_TRUE(fits(demandAt(frame, camera, j), capacities) || frame.result.every_factor_one) << what << ": j = " << j;
	for (uint32_t finer = 0; finer < j; ++finer)
		ASSERT_FALSE(fits(demandAt(frame, camera, finer), capacities)) << what << ": " << finer << " would fit, " << j << " was granted";
	for (const ListStats& list : frame.result.lists)
		EXPECT_LE(list.wanted, list.capacity) << what << ": " << list.name;
	expectSameAsReference(frame, what);
	expectCovered(frame, what);
	const std::vector<uint8_t> picture = frame.picture();
	drawAgain(frame, camera);
	EXPECT_EQ(frame.result.coarsening, j) << what << ": a still camera keeps its rate";
	EXPECT_EQ(frame.result.attempts, 1u) << what;
	EXPECT_EQ(differingPixels(frame.picture(), picture), 0u) << what;
}

// Every list that `frame` filled and that a rate can relieve, at `share` of what was wanted, but legal.
Capacities shrunk(const GpuFrame& frame, double share)
{
	Capacities capacities;
	for (const char* name : { "part_triangles", "split_triangles", "micro_vertices", "expanded_triangles" })
		for (const ListStats& list : frame.result.lists)
			if (list.name == name && list.wanted > findList(name)->least_capacity)
				capacities[name] = std::max(uint32_t(double(list.wanted) * share), findList(name)->least_capacity);
	return capacities;
}

}  // namespace

TEST_F(rateSearch, eachListAloneAndAllTogetherGiveTheSmallestJThatFits)
{
	for (const char* name : { "cube", "terrain" })
		for (const Raster raster : rasterPaths())
		{
			const auto scene = gpuScene(name);
			const Camera camera = closeTo(*scene, 0.4);
			RenderOptions options = uncut(2, raster);
			const GpuFrame roomy = drawFrame(*scene, options, camera);
			ASSERT_EQ(roomy.result.coarsening, 0u);
			const Capacities together = shrunk(roomy, 0.4);
			EXPECT_GE(together.size(), 2u) << name;
			for (const auto& [list, capacity] : together)
			{
				// What a list is does not depend on who draws; each is once the only one.
				if (raster != rasterPaths().front() && list != "expanded_triangles")
					continue;
				options.capacities = { { list, capacity } };
				GpuFrame tight = drawFrame(*scene, options, camera);
				const std::string what = fmt::format("{}, raster {}, {}={}", name, int(raster), list, capacity);
				EXPECT_GT(tight.result.coarsening, 0u) << what;
				expectSmallestThatFits(tight, camera, options.capacities, what);
			}
			options.capacities = together;
			GpuFrame tight = drawFrame(*scene, options, camera);
			expectSmallestThatFits(tight, camera, together, fmt::format("{}, raster {}, all lists", name, int(raster)));
		}
}

TEST_F(rateSearch, theSmallestLegalListsStillDrawTheWholeScene)
{
	Capacities smallest;
	for (const ListDesc& list : listDescs())
		smallest[std::string(list.name)] = list.least_capacity;
	for (const char* name : { "cube", "instances:24" })
	{
		const auto scene = gpuScene(name);
		for (const Raster raster : rasterPaths())
		{
			RenderOptions options = uncut(3, raster);
			const GpuFrame roomy = drawFrame(*scene, options);
			options.capacities = smallest;
			GpuFrame tight = drawFrame(*scene, options);
			const std::string what = fmt::format("{}, raster {}", name, int(raster));
			EXPECT_GT(tight.result.coarsening, 0u) << what;
			if (tight.result.rounds == 1)
				expectSmallestThatFits(tight, scene->camera, smallest, what);
			EXPECT_EQ(tight.result.counts.visible_clusters, roomy.result.counts.visible_clusters) << what;
			const auto pixels = double(roomy.result.counts.covered_pixels);
			EXPECT_NEAR(double(tight.result.counts.covered_pixels), pixels, 0.05 * pixels + 10) << what;
		}
	}
}

TEST_F(rateSearch, thePictureIsThatOfAFrameAskedForAtTheGrantedRate)
{
	for (const char* name : { "planet", "terrain" })
		for (const Raster raster : rasterPaths())
		{
			if (name == std::string("planet") && raster != rasterPaths().back())
				continue;
			const auto scene = gpuScene(name);
			const Camera camera = closeTo(*scene, 0.7);
			RenderOptions options = uncut(1.5f, raster);
			options.rate = 3;
			const GpuFrame asked = drawFrame(*scene, options, camera);
			options.rate = 1.5f;
			options.capacities = { { "part_triangles", uint32_t(asked.list("part_triangles").wanted) } };
			const GpuFrame granted = drawFrame(*scene, options, camera);
			const std::string what = fmt::format("{}, raster {}", name, int(raster));
			ASSERT_EQ(granted.result.coarsening, 16u) << what << ": twice the rate";
			EXPECT_EQ(granted.result.rate_granted, asked.result.rate_granted) << what;
			EXPECT_EQ(granted.result.counts.micro_triangles, asked.result.counts.micro_triangles) << what;
			EXPECT_EQ(reference::firstDifference(asked.parts, granted.parts).value_or(""), "") << what;
			EXPECT_EQ(std::memcmp(&granted.view(), &asked.view(), sizeof(View)), 0) << what;
			EXPECT_EQ(differingPixels(granted.picture(), asked.picture()), 0u) << what;
		}
}

TEST_F(rateSearch, withCullingWhatIsSeenIsWholeToo)
{
	const auto scene = gpuScene("terrain");
	const Camera camera = closeTo(*scene, 0.3);
	RenderOptions options = smallOptions(1.5f);
	const GpuFrame roomy = drawFrame(*scene, options, camera);
	options.capacities = { { "part_triangles", uint32_t(roomy.list("part_triangles").wanted / 3) },
						   { "split_triangles", uint32_t(roomy.list("split_triangles").wanted / 2) } };
	const GpuFrame tight = drawFrame(*scene, options, camera);
	EXPECT_GT(tight.result.coarsening, 0u);
	EXPECT_EQ(tight.result.attempts, 1u) << "the counts were not those of the listing";
	expectSameAsReference(tight, "terrain");
	RenderOptions all = options;
	all.capacities = {};
	all.cull = { false, false, false };
	all.rate = float(tight.result.rate_granted);
	const GpuFrame unculled = drawFrame(*scene, all, camera);
	EXPECT_LE(differingPixels(tight.picture(), unculled.picture(), 8), unculled.picture().size() / 4 / 200);
}

// j depends on the view alone.
TEST_F(rateSearch, aCameraThatMovesAndComesBackGetsTheSameRate)
{
	const auto scene = gpuScene("planet");
	RenderOptions options = uncut(2, rasterPaths().back());
	options.capacities = { { "part_triangles", 3000 } };
	GpuFrame frame = drawFrame(*scene, options);
	const uint32_t j = frame.result.coarsening;
	EXPECT_GT(j, 0u);
	for (const double nearness : { 0.5, 0.8, 3.0 })
	{
		drawAgain(frame, closeTo(*scene, nearness));
		EXPECT_EQ(frame.result.attempts, 1u);
		expectSmallestThatFits(frame, closeTo(*scene, nearness), options.capacities, fmt::format("{}", nearness));
		drawAgain(frame, scene->camera);
		EXPECT_EQ(frame.result.coarsening, j) << nearness;
	}
}

TEST_F(rateSearch, everyRoundHasTheSameRate)
{
	const auto scene = gpuScene("instances:60");
	for (const Raster raster : rasterPaths())
	{
		RenderOptions options = uncut(2, raster);
		options.capacities = { { "visible_clusters", 64 }, { "part_triangles", 700 } };
		const GpuFrame rounds = drawFrame(*scene, options);
		ASSERT_GT(rounds.result.rounds, 1u);
		ASSERT_GT(rounds.result.coarsening, 0u);
		options.capacities = {};
		options.rate = float(rounds.result.rate_granted);
		const GpuFrame whole = drawFrame(*scene, options);
		ASSERT_EQ(whole.result.rounds, 1u);
		EXPECT_EQ(rounds.result.counts.visible_clusters, whole.result.counts.visible_clusters);
		// The asked rate is a float, the granted one is not: a tie may fall the other way.
		EXPECT_NEAR(double(rounds.result.counts.micro_triangles), double(whole.result.counts.micro_triangles), 8);
		EXPECT_LE(differingPixels(rounds.picture(), whole.picture(), 8), 20u);
	}
}

TEST_F(rateSearch, aBudgetIsKeptAndTheFrameWithinItIsWhole)
{
	const auto scene = gpuScene("terrain");
	const Camera camera = closeTo(*scene, 0.4);
	for (const Raster raster : rasterPaths())
	{
		RenderOptions options = uncut(0.5f, raster);
		uint32_t coarser = 0;
		for (const uint64_t budget : { 30'000'000ull, 700'000ull, 320'000ull })
		{
			options.lists_bytes = budget;
			GpuFrame tight = drawFrame(*scene, options, camera);
			const std::string what = fmt::format("raster {}, {} bytes", int(raster), budget);
			EXPECT_LE(tight.renderer->memory().lists, budget) << what;
			EXPECT_GE(tight.result.coarsening, coarser) << what;
			coarser = tight.result.coarsening;
			Capacities capacities;
			for (const ListStats& list : tight.result.lists)
				if (list.name != "batches")
					capacities[list.name] = list.capacity;
			expectSmallestThatFits(tight, camera, capacities, what);
		}
		EXPECT_GT(coarser, 0u);
	}
}

// Packings follow what other lists hold: they grow, at once where there is no other way, else before they are too small.
TEST_F(rateSearch, packingsGrowAndNeverCoarsen)
{
	const auto scene = gpuScene("terrain");
	GpuFrame frame = drawFrame(*scene, uncut(0.21f, drawingPaths().front()));
	const uint64_t wanted = frame.list("micro_vertices").wanted;
	ASSERT_GT(wanted, findList("micro_vertices")->default_capacity);
	EXPECT_EQ(frame.result.attempts, 2u);
	const uint32_t capacity = frame.list("micro_vertices").capacity;
	for (double nearness = 1; nearness > 0.85; nearness *= 0.93)
	{
		drawAgain(frame, closeTo(*scene, nearness));
		EXPECT_EQ(frame.result.attempts, 1u) << nearness;
		EXPECT_EQ(frame.result.coarsening, 0u) << nearness;
		EXPECT_GE(frame.list("micro_vertices").capacity, capacity) << nearness;
		EXPECT_GE(frame.list("micro_vertices").peak, wanted) << "peaks outlive the list's growth";
	}
	EXPECT_GT(frame.list("micro_vertices").capacity, capacity);
}

// Fewer levels than are needed: nothing overflows, and all the same everything is listed.
TEST_F(rateSearch, levelsThatWereNotPlannedLoseNothing)
{
	const auto scene = gpuScene("cube");
	const Camera camera = closeTo(*scene, 0.45);
	RenderOptions options = uncut(1, Raster::Auto);
	options.max_split = 2;
	GpuFrame frame = drawFrame(*scene, options, camera);
	ASSERT_GE(frame.expected().levels(), 3u);

	PlanInput input = frame.renderer->planInput();
	input.view.split_levels = 1;
	const Result<FramePlan> plan = planFrame(framePasses(), resourceDescs(), kWantedOutputs, input);
	ASSERT_TRUE(plan.has_value());
	auto resources = FrameResources::create(gpu(), scene->built, scene->table, input);
	ASSERT_TRUE(resources.has_value() && (*resources)->prepare(*plan, input).has_value());
	auto runner = PassRunner::create(gpu(), **resources);
	ASSERT_TRUE(runner.has_value() && (*runner)->preparePipelines(*plan, input).has_value());

	ViewRequest request = { options.width_px, options.height_px };
	request.rate_px = options.rate;
	const auto steps = rateSteps(camera, frame.view(), request, 0, 1e6, 11, options.max_split);
	ASSERT_TRUE((*resources)->commands().begin().has_value());
	ASSERT_TRUE((*resources)->writeView(frame.view(), 0, false, steps).has_value());
	ASSERT_TRUE((*runner)->record(*plan, input).has_value());
	(*resources)->recordCountsReadback((*resources)->commands().buffer());
	ASSERT_TRUE((*resources)->commands().submitAndWait().has_value());

	const FrameCounts counts = (*resources)->counts();
	EXPECT_EQ(counts.overflow, 0u);
	EXPECT_EQ(counts.rate_step, 0u);
	EXPECT_EQ(counts.listed_again, 1u);
	EXPECT_GT(counts.levels_missing, 0u);
	const ListHead parts = (*resources)->head(LIST_PART_TRIANGLES);
	ASSERT_EQ(parts.wanted, frame.parts.size());
	const auto bytes = (*resources)->read("part_triangles", parts.wanted * sizeof(DomainTriangle));
	const auto visible = (*resources)->read("visible_clusters", frame.visible.size() * sizeof(ClusterRef));
	ASSERT_TRUE(bytes.has_value() && visible.has_value());
	const auto found = reference::canonicalPieces({ reinterpret_cast<const DomainTriangle*>(bytes->data()), parts.wanted },
												  { reinterpret_cast<const ClusterRef*>(visible->data()), frame.visible.size() });
	EXPECT_EQ(reference::firstDifference(frame.expected().parts, found).value_or(""), "");
}

}  // namespace tessera::test
