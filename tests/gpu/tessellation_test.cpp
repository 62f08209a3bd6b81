// cluster_classify, triangle_split and batch_parts against the CPU reference, bit for bit, as sets; and lists that are too small.
#include "gpu_test.h"
#include "scene/builtin.h"

#include "scene/factor_rule.h"

#include <algorithm>

namespace tessera::test
{

namespace
{

using tessellation = GpuTest;

RenderOptions uncut(float rate)
{
	RenderOptions options = smallOptions(rate);
	options.cull = { false, false, false };
	return options;
}

Camera orthographic(const GpuScene& scene)
{
	Camera camera = scene.camera;
	camera.orthographic = true;
	camera.height_world = boundingRadius(scene.built) * 2;
	return camera;
}

uint64_t mostMicroTriangles(const GpuFrame& frame)
{
	return frame.result.counts.micro_triangles;
}

}  // namespace

// --- known answers ---------------------------------------------------------------------------------------------------------------

TEST_F(tessellation, squareAtKnownDistanceGetsHandComputedFactors)
{
	// Side 1, every corner 5 away, focal length 45 px (90 px high, 90 degrees), rate 1.8: 1 / 5 * 45 / 1.8 = 5 segments, the diagonal
	// sqrt(2) * 5 = 7.07: 7.
	const GpuScene scene(squareScene());
	const Camera camera = squareCamera(dvec3(0, 0, std::sqrt(25 - 0.5)), dvec3(0));
	const GpuFrame frame = drawFrame(scene, smallOptions(1.8f), camera);

	ASSERT_EQ(frame.parts.size(), 2u);
	for (const reference::ReferencePiece& part : frame.parts)
		EXPECT_EQ((std::array{ part.piece.a, part.piece.b, part.piece.c }), (std::array{ 7u, 5u, 5u }));
	EXPECT_EQ(frame.result.counts.split_triangles, 0u);
	EXPECT_EQ(frame.result.counts.full_clusters, 0u);
	EXPECT_EQ(frame.result.counts.micro_triangles, 2u * defaultTable().configs[configIndex(7, 5, 5)].triangle_count);
	EXPECT_EQ(frame.result.rate_granted, frame.result.rate_wanted);
	EXPECT_EQ(frame.result.attempts, 1u);
}

TEST_F(tessellation, squareUnderAnOrthographicCameraCountsPixelsOfItsFace)
{
	// 90 px show 2 units: a side has 45 px, 3 segments of 15 px; the diagonal 63.6 px, 4.24: 4.
	const GpuScene scene(squareScene());
	Camera camera = squareCamera(dvec3(0, 0, 7), dvec3(0));
	camera.orthographic = true;
	camera.height_world = 2;
	const GpuFrame frame = drawFrame(scene, smallOptions(15), camera);
	ASSERT_EQ(frame.parts.size(), 2u);
	for (const reference::ReferencePiece& part : frame.parts)
		EXPECT_EQ((std::array{ part.piece.a, part.piece.b, part.piece.c }), (std::array{ 4u, 3u, 3u }));
}

TEST_F(tessellation, aLongEdgeIsSplitIntoHandComputedPieces)
{
	// As the first, at rate 0.3: 30 segments and 42.4 on the diagonal, so ceil(30 / 11) = 3 and ceil(42.4 / 11) = 4 pieces.
	const GpuScene scene(squareScene());
	const Camera camera = squareCamera(dvec3(0, 0, std::sqrt(25 - 0.5)), dvec3(0));
	const GpuFrame frame = drawFrame(scene, smallOptions(0.3f), camera);
	uint32_t whole = 0;
	for (const reference::ReferencePiece& split : frame.splits)
		if (domainLength(split.piece.c0, split.piece.c1) == DOMAIN_SIZE)
		{
			++whole;
			EXPECT_EQ((std::array{ split.piece.a, split.piece.b, split.piece.c }), (std::array{ 4u, 3u, 3u }));
		}
	EXPECT_EQ(whole, 2u);
	EXPECT_GE(frame.parts.size(), 2u * defaultTable().configs[configIndex(4, 3, 3)].triangle_count);
	expectCovered(frame, "square");
}

// --- the reference ---------------------------------------------------------------------------------------------------------------

TEST_F(tessellation, builtInScenesAreClassifiedAsByTheReferenceFromCoarseToFine)
{
	for (const char* name : { "planet", "terrain", "bricks", "cube", "materials", "instances:24" })
	{
		const auto scene = gpuScene(name);
		for (const float rate : { 40.0f, 9.0f, 2.5f })
		{
			const GpuFrame frame = drawFrame(*scene, uncut(rate));
			expectSameAsReference(frame, fmt::format("{} at rate {}", name, rate));
			expectCovered(frame, fmt::format("{} at rate {}", name, rate));
		}
	}
}

TEST_F(tessellation, sampleFilesAreClassifiedAsByTheReference)
{
	for (const char* name : { "gltf/displaced_quad.glb", "gltf/hierarchy.gltf", "sphere.gltf", "terrain.gltf" })
	{
		const std::filesystem::path root = TESSERA_SOURCE_ROOT;
		if (!std::filesystem::exists(root / "tests/data" / name) && !std::filesystem::exists(root / "bench/scenes" / name))
			continue;
		const auto scene = gpuScene(name);
		for (const float rate : { 16.0f, 4.0f })
		{
			const GpuFrame frame = drawFrame(*scene, uncut(rate));
			expectSameAsReference(frame, fmt::format("{} at rate {}", name, rate));
			expectCovered(frame, fmt::format("{} at rate {}", name, rate));
		}
	}
}

TEST_F(tessellation, closeCamerasSplitAgainAndAgain)
{
	for (const uint32_t max_split : { 2u, 8u, 11u })
	{
		uint32_t most_levels = 0;
		for (const char* name : { "quad", "cube", "materials" })
		{
			const auto scene = gpuScene(name);
			RenderOptions options = uncut(4);
			options.max_split = max_split;
			const GpuFrame frame = drawFrame(*scene, options, closeTo(*scene, 0.45));
			expectSameAsReference(frame, fmt::format("{} split by {}", name, max_split));
			expectCovered(frame, fmt::format("{} split by {}", name, max_split));
			most_levels = std::max(most_levels, frame.expected().levels());
		}
		EXPECT_GE(most_levels, max_split == 2 ? 3u : 2u) << max_split;
	}
}

TEST_F(tessellation, aSmallTableSplitsWhereTheLargeOneDoesNot)
{
	const ImportedScene imported = sphereScene(12, 24, TexelFormat::U16, Wrap::Repeat);
	for (const uint32_t size : { 2u, 5u, 11u })
	{
		const TessellationTable table = smallTable(size);
		const GpuScene scene(imported, table);
		const GpuFrame frame = drawFrame(scene, uncut(1.5f));
		expectSameAsReference(frame, fmt::format("table of {}", size));
		expectCovered(frame, fmt::format("table of {}", size));
		EXPECT_EQ(frame.splits.empty(), size == 11) << size;
	}
}

TEST_F(tessellation, mirroredAndUnevenInstancesAreClassifiedAsByTheReference)
{
	const GpuScene scene(unevenScene());
	for (const float rate : { 12.0f, 3.0f })
	{
		const GpuFrame frame = drawFrame(scene, uncut(rate));
		expectSameAsReference(frame, fmt::format("rate {}", rate));
		expectCovered(frame, fmt::format("rate {}", rate));
	}
}

TEST_F(tessellation, everySeamyTestSceneIsClassifiedAsByTheReference)
{
	for (const NamedScene& named : allScenes())
	{
		const GpuScene scene(named.scene);
		const GpuFrame frame = drawFrame(scene, uncut(3));
		expectSameAsReference(frame, named.name);
		expectCovered(frame, named.name);
	}
}

TEST_F(tessellation, orthographicViewsAreClassifiedAsByTheReference)
{
	for (const char* name : { "planet", "bricks" })
	{
		const auto scene = gpuScene(name);
		const GpuFrame frame = drawFrame(*scene, uncut(4), orthographic(*scene));
		expectSameAsReference(frame, name);
		expectCovered(frame, name);
	}
}

TEST_F(tessellation, visibleClustersUnderCullingAreAllThatTheReferenceKeeps)
{
	for (const char* name : { "planet", "instances:200" })
	{
		const auto scene = gpuScene(name);
		const Camera camera = closeTo(*scene, 0.5);
		RenderOptions options = smallOptions(6);
		options.cull = { true, false, false };
		const GpuFrame frame = drawFrame(*scene, options, camera);
		expectSameAsReference(frame, name);
		// Rounding may differ where a box touches the frustum's side; nearly all must agree.
		const size_t expected = reference::clustersInFrustum(scene->host, frame.view()).size(), all = reference::allClusters(scene->host).size();
		EXPECT_NEAR(double(frame.visible.size()), double(expected), 2 + 0.01 * double(expected)) << name;
		EXPECT_LT(frame.visible.size(), all) << name << ": nothing was culled, so nothing is tested";
	}
}

TEST_F(tessellation, rateZeroLeavesEveryClusterFull)
{
	const auto scene = gpuScene("bricks");
	const GpuFrame frame = drawFrame(*scene, uncut(0));
	EXPECT_EQ(frame.parts.size(), 0u);
	EXPECT_EQ(frame.result.counts.full_clusters, reference::allClusters(scene->host).size());
	EXPECT_EQ(frame.result.counts.micro_triangles, scene->built.traits.instanced_triangles);
	EXPECT_FALSE(frame.renderer->plan().has("cluster_classify"));
}

// --- batches ---------------------------------------------------------------------------------------------------------------------

TEST_F(tessellation, everyPartIsInOneBatchWithinItsLimitsAndVertexRangesAreDisjoint)
{
	for (const char* name : { "planet", "materials", "instances:24" })
	{
		const auto scene = gpuScene(name);
		for (const float rate : { 9.0f, 2.5f })
		{
			const GpuFrame frame = drawFrame(*scene, uncut(rate));
			std::vector<uint32_t> batch_of(frame.parts.size(), 0);
			std::vector<std::pair<uint32_t, uint32_t>> ranges;  // of micro-vertices
			uint64_t triangles = 0;
			for (const Batch& batch : frame.read<Batch>("batches"))
			{
				const uint32_t first = batchFirst(batch.parts), count = batchCount(batch.parts);
				ASSERT_LE(count, BATCH_MAX_PARTS);
				ASSERT_LE(first + count, frame.parts.size());
				uint32_t batch_vertices = 0, batch_triangles = 0;
				for (uint32_t part = first; part < first + count; ++part)
				{
					++batch_of[part];
					const PatternRange& pattern = scene->host.pattern(frame.parts[part].piece);
					batch_vertices += patternVertices(pattern);
					batch_triangles += patternTriangles(pattern);
				}
				EXPECT_LE(batch_vertices, BATCH_MAX_VERTICES);
				EXPECT_LE(batch_triangles, BATCH_MAX_TRIANGLES);
				triangles += batch_triangles;
				ranges.emplace_back(batch.first_vertex, batch.first_vertex + batch_vertices);
			}
			EXPECT_TRUE(std::all_of(batch_of.begin(), batch_of.end(), [](uint32_t count) { return count == 1; })) << name;
			for (const FullCluster& full : frame.read<FullCluster>("full_clusters"))
				ranges.emplace_back(full.first_vertex, full.first_vertex + clusterVertices(scene->host.cluster(frame.visible[full.visible_cluster])));
			std::sort(ranges.begin(), ranges.end());
			for (size_t i = 1; i < ranges.size(); ++i)
				ASSERT_LE(ranges[i - 1].second, ranges[i].first) << name;
			EXPECT_LE(ranges.back().second, frame.list("micro_vertices").wanted) << name;
			EXPECT_EQ(triangles, frame.expected().part_micro_triangles) << name;
		}
	}
}

// --- lists that are too small ----------------------------------------------------------------------------------------------------

namespace
{

size_t coveredPixels(const GpuFrame& frame)
{
	return frame.result.counts.covered_pixels;
}

void expectCoarsenedButWhole(const GpuFrame& tight, const GpuFrame& roomy, const std::string& what)
{
	EXPECT_GT(tight.result.rate_granted, tight.result.rate_wanted) << what;
	EXPECT_EQ(tight.result.attempts, 1u) << what << ": the device finds the rate by itself";
	for (const ListStats& list : tight.result.lists)
	{
		EXPECT_LE(list.wanted, list.capacity) << what << ": " << list.name;
		EXPECT_LE(list.peak_used, list.capacity) << what << ": " << list.name;
		EXPECT_GE(list.peak, list.peak_used) << what << ": " << list.name;
	}
	expectSameAsReference(tight, what);
	expectCovered(tight, what);
	EXPECT_LT(mostMicroTriangles(tight), mostMicroTriangles(roomy)) << what;
	// The surface is coarser, its outline moves a little.
	EXPECT_NEAR(double(coveredPixels(tight)), double(coveredPixels(roomy)), 0.02 * double(coveredPixels(roomy)) + 10) << what;
}

}  // namespace

TEST_F(tessellation, listsThatAreTooSmallCoarsenTheFrameAndLoseNothing)
{
	using Capacities = std::map<std::string, uint32_t>;
	struct Case
	{
		const char* scene;
		double nearness;
		Capacities capacities;
	};
	for (const Case& c : { Case{ "planet", 0.7, { { "part_triangles", 2500 } } }, Case{ "terrain", 0.3, { { "split_triangles", 100 } } },
						   Case{ "cube", 0.5, { { "part_triangles", 1000 }, { "split_triangles", 100 } } } })
	{
		const auto scene = gpuScene(c.scene);
		RenderOptions options = uncut(1.5f);
		const GpuFrame roomy = drawFrame(*scene, options, closeTo(*scene, c.nearness));
		options.capacities = c.capacities;
		GpuFrame tight = drawFrame(*scene, options, closeTo(*scene, c.nearness));
		expectCoarsenedButWhole(tight, roomy, c.scene);
		for (const auto& [name, capacity] : c.capacities)
			EXPECT_EQ(tight.list(name).capacity, capacity);

		// One step finer does not fit: j is the smallest found to. It stays while nothing moves.
		const double granted = tight.result.rate_granted;
		drawAgain(tight, closeTo(*scene, c.nearness));
		EXPECT_EQ(tight.result.rate_granted, granted) << c.scene;
		EXPECT_EQ(tight.result.attempts, 1u) << c.scene;
		ViewRequest finer = { options.width_px, options.height_px };
		finer.rate_px = double(options.rate) * std::exp2((tight.result.coarsening - 1) / 16.0);
		const Result<View> view = makeView(closeTo(*scene, c.nearness), scene->built, finer);
		ASSERT_TRUE(view.has_value());
		const reference::Classified overfull = reference::classify(scene->host, *view, factorRule(*view, 11, 8), tight.visible);
		const auto most = [&](const char* name) {
			return c.capacities.count(name) ? c.capacities.at(name) : UINT32_MAX;
		};
		EXPECT_TRUE(overfull.parts.size() > most("part_triangles") || overfull.splits.size() > most("split_triangles")) << c.scene;
	}
}

// One entry short: what lies behind the list is another list or the scene, and all of that is compared afterwards.
TEST_F(tessellation, aListOneEntryShortIsNeverOverfullAndNothingBehindItIsHarmed)
{
	const auto scene = gpuScene("instances:60");
	RenderOptions options = uncut(5);
	const GpuFrame roomy = drawFrame(*scene, options);
	for (const char* name : { "part_triangles", "full_clusters", "visible_clusters", "cluster_groups" })
	{
		const uint64_t wanted = roomy.list(name).wanted;
		ASSERT_GT(wanted, name == std::string("cluster_groups") ? 1u : 64u) << name;
		options.capacities = { { name, uint32_t(wanted - 1) } };
		const GpuFrame tight = drawFrame(*scene, options);
		EXPECT_EQ(tight.result.attempts > 1, tight.result.rounds > 1) << name;
		EXPECT_EQ(tight.list(name).capacity, wanted - 1) << name;
		EXPECT_GE(tight.list(name).peak, wanted) << name;
		EXPECT_LE(tight.list(name).peak_used, wanted - 1) << name;
		if (tight.result.rounds > 1)
		{
			EXPECT_EQ(tight.result.rate_granted, roomy.result.rate_granted) << name;
			EXPECT_EQ(tight.result.counts.micro_triangles, roomy.result.counts.micro_triangles) << name;
			EXPECT_EQ(differingPixels(tight.picture(), roomy.picture()), 0u) << name;
		}
		else
		{
			expectSameAsReference(tight, name);
			expectCovered(tight, name);
		}
	}
}

TEST_F(tessellation, aSceneOfMoreClustersThanTheListHoldsIsDrawnInRoundsToTheSamePicture)
{
	const auto scene = gpuScene("instances:60");
	for (const Raster raster : rasterPaths())
	{
		RenderOptions options = uncut(6);
		options.raster = raster;
		const GpuFrame whole = drawFrame(*scene, options);
		ASSERT_GT(whole.visible.size(), 64u);
		options.capacities = { { "visible_clusters", 64 } };
		GpuFrame rounds = drawFrame(*scene, options);
		EXPECT_GT(rounds.result.rounds, 1u);
		EXPECT_EQ(rounds.result.rate_granted, whole.result.rate_granted);
		EXPECT_EQ(rounds.result.counts.visible_clusters, whole.result.counts.visible_clusters);
		EXPECT_EQ(rounds.result.counts.part_triangles, whole.result.counts.part_triangles);
		EXPECT_EQ(rounds.result.counts.micro_triangles, whole.result.counts.micro_triangles);
		EXPECT_EQ(rounds.result.counts.covered_pixels, whole.result.counts.covered_pixels);
		EXPECT_EQ(differingPixels(rounds.picture(), whole.picture()), 0u);
		drawAgain(rounds, scene->camera);
		EXPECT_EQ(differingPixels(rounds.picture(), whole.picture()), 0u) << "second frame";
	}
}

TEST_F(tessellation, manyGroupsOfManyInstancesFitTheSmallestListInEnoughRounds)
{
	// Small clusters: several groups in each instance, so that groups of different instances could meet in one round.
	ImportedScene imported = *makeBuiltinScene("planet");
	imported.instances.resize(4, imported.instances.front());
	for (size_t i = 0; i < imported.instances.size(); ++i)
		imported.instances[i].world[3].x += double(i) * 0.7;
	const GpuScene scene(imported, defaultTable(), { 64, 16 });
	RenderOptions options = uncut(12);
	options.raster = Raster::Soft;
	const GpuFrame whole = drawFrame(scene, options);
	options.capacities = { { "visible_clusters", 64 } };
	const GpuFrame rounds = drawFrame(scene, options);
	EXPECT_GE(rounds.result.rounds * 64u, whole.visible.size());
	EXPECT_EQ(rounds.result.counts.visible_clusters, whole.result.counts.visible_clusters);
	EXPECT_EQ(rounds.result.counts.micro_triangles, whole.result.counts.micro_triangles);
	EXPECT_EQ(differingPixels(rounds.picture(), whole.picture()), 0u);
}

TEST_F(tessellation, everyFactorOneIsTheLastResort)
{
	const auto scene = gpuScene("cube");
	RenderOptions options = uncut(2);
	options.capacities = { { "part_triangles", 1 } };
	const GpuFrame frame = drawFrame(*scene, options);
	EXPECT_LE(frame.result.counts.part_triangles, 1u);
	expectSameAsReference(frame, "cube");
	expectCovered(frame, "cube");
	EXPECT_GT(coveredPixels(frame), 0u);
}

}  // namespace tessera::test
