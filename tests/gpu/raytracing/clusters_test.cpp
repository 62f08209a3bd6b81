// Rays through clusters, under the layer that emulates them: they see what rays through all triangles at once see, every kind of cluster occurs, and
// no rule of the extension is broken (that would end the process).
#include "cluster_test.h"

#include "verify/cameras.h"
#include "verify/frame_source.h"
#include "verify/paths_check.h"
#include "verify/screen.h"

namespace tessera::test
{

namespace
{

using rayClusters = ClusterTest;

std::unique_ptr<verify::FrameSource> sourceOf(const GpuScene& scene, const RenderOptions& options, bool with_micro)
{
	auto source = verify::FrameSource::create(clusterDevice(), scene.host, scene.built, scene.table, options, with_micro, {}, 1);
	EXPECT_TRUE(source) << (source ? "" : source.error().message);
	return source ? std::move(*source) : nullptr;
}

// Both may differ only where a pixel's centre lies on a micro-triangle's edge; counts may not at all.
void expectSameVisibility(const GpuScene& scene, const std::string& name, float rate, uint64_t seed, uint32_t cameras)
{
	const auto triangles = sourceOf(scene, pathOptions(rate, RayPath::Triangles), true),
			   clusters = sourceOf(scene, pathOptions(rate, RayPath::Clusters), false);
	ASSERT_TRUE(triangles && clusters) << name;
	std::vector<verify::NamedCamera> all = verify::randomCameras(scene.built, seed, cameras);
	all.push_back({ "its own", scene.camera });
	uint64_t covered = 0, differ = 0;
	for (const verify::NamedCamera& camera : all)
	{
		const std::string what = fmt::format("{} at rate {}, camera {}", name, rate, camera.name);
		const auto expected = triangles->capture(camera.camera, rate), found = clusters->capture(camera.camera, rate);
		ASSERT_TRUE(expected && found) << what;
		EXPECT_TRUE(found->result.rays.clusters.built && !expected->result.rays.clusters.built) << what;
		verify::CheckResult check =
			verify::checkPaths(verify::Screen(scene.host, expected->view), expected->micro, expected->visible, found->visible, "clusters");
		EXPECT_EQ(check.violations, 0u) << what << ": " << verify::describe(check.place);
		EXPECT_EQ(expected->result.counts.micro_triangles, found->result.counts.micro_triangles) << what;
		covered += expected->visible.covered();
		differ += check.sums["pixels that differ"];
	}
	EXPECT_GT(covered, all.size() * 96 * 54 / 20) << name << ": too little is seen";
	EXPECT_LE(differ * 50, covered) << name;
}

// Every micro-triangle is in one cluster.
void expectAllTriangles(const ClusterFrame& frame, const std::string& what)
{
	EXPECT_EQ(frame.list("ray_instantiated_triangles").wanted + frame.list("ray_transient_triangles").wanted, frame.result.counts.micro_triangles)
		<< what;
	EXPECT_EQ(frame.clusters().full, frame.result.counts.full_clusters) << what;
	EXPECT_EQ(frame.clusters().full + frame.clusters().parts, frame.list("ray_instantiations").wanted) << what;
	EXPECT_EQ(frame.clusters().units + frame.clusters().groups, frame.list("ray_transients").wanted) << what;
	for (const ListStats& list : frame.clusters().lists)
		EXPECT_LE(list.wanted, list.capacity) << what << ": " << list.name;
}

}  // namespace

TEST_F(rayClusters, seeWhatAllTrianglesAtOnceShow)
{
	for (const char* name : { "planet", "bricks" })
		expectSameVisibility(*gpuScene(name), name, 5, 21, 3);
}

TEST_F(rayClusters, seeMirroredShearedAndUntessellatedInstances)
{
	const GpuScene uneven(unevenScene());
	expectSameVisibility(uneven, "uneven instances", 6, 5, 2);
	expectSameVisibility(uneven, "uneven instances", 0, 6, 2);
}

TEST_F(rayClusters, knowTheSidesOfMaterials)
{
	ImportedScene imported = soupScene(3, 60);
	imported.materials[0].double_sided = true;
	const GpuScene soup(imported);
	ASSERT_TRUE(soup.built.traits.has_single_sided && soup.built.traits.has_double_sided) << "the scene has only one kind";
	expectSameVisibility(soup, "soup", 8, 2, 2);
	expectSameVisibility(soup, "soup", 0, 3, 1);
}

// All four kinds of cluster occur; each transient kind can be switched off, and then its triangles are made otherwise. The picture is the same.
TEST_F(rayClusters, everyKindOccursAndEachTransientKindCanBeSwitchedOff)
{
	const auto scene = gpuScene("bricks");
	const ClusterFrame expected = drawn(*scene, pathOptions(6, RayPath::Triangles), scene->camera);
	for (const uint32_t kinds : { 3u, 2u, 1u, 0u })
	{
		RenderOptions options = pathOptions(6, RayPath::Clusters);
		options.transient_units = kinds & 1;
		options.transient_groups = kinds & 2;
		const std::string what = fmt::format("kinds {}", kinds);
		const ClusterFrame frame = drawn(*scene, options, scene->camera);
		EXPECT_GT(frame.clusters().full, 0u) << what;
		EXPECT_GT(frame.clusters().parts, 0u) << what;
		EXPECT_EQ(frame.clusters().units > 0, options.transient_units) << what;
		EXPECT_EQ(frame.clusters().groups > 0, options.transient_groups) << what;
		EXPECT_EQ(frame.clusters().structures, scene->built.instances.size()) << what;
		EXPECT_EQ(frame.clusters().templates, scene->built.clusters.size() + 2 * scene->table.configs.size()) << what;
		expectAllTriangles(frame, what);
		EXPECT_EQ(differingPixels(frame.picture, expected.picture), 0u) << what;
	}
}

TEST_F(rayClusters, whatTheDriverIsToldOfABuildChangesNoPicture)
{
	const auto scene = gpuScene("bricks");
	const auto renderer = clusterRenderer(*scene, pathOptions(6, RayPath::Clusters));
	ASSERT_TRUE(renderer);
	const ClusterFrame expected = drawnBy(*renderer, scene->camera);
	for (const BuildPreference preference : { BuildPreference::FastBuild, BuildPreference::FastTrace })
	{
		RenderOptions options = pathOptions(6, RayPath::Clusters);
		options.transient_build = preference;
		ASSERT_TRUE(renderer->setOptions(options));
		EXPECT_EQ(differingPixels(drawnBy(*renderer, scene->camera).picture, expected.picture), 0u);
	}
}

// Positions that lose bits are near those that do not: more bits, farther.
TEST_F(rayClusters, truncatedPositionsAreNearExactOnes)
{
	const auto scene = gpuScene("bricks");
	const auto renderer = clusterRenderer(*scene, pathOptions(6, RayPath::Clusters));
	ASSERT_TRUE(renderer);
	const ClusterFrame exact = drawnBy(*renderer, scene->camera);
	RenderOptions options = pathOptions(6, RayPath::Clusters);
	options.truncated_bits = 8;
	ASSERT_TRUE(renderer->setOptions(options));
	const ClusterFrame near = drawnBy(*renderer, scene->camera);
	EXPECT_LE(differingPixels(near.picture, exact.picture, 8), 20u);
	options.truncated_bits = 22;
	ASSERT_TRUE(renderer->setOptions(options));
	EXPECT_GT(differingPixels(drawnBy(*renderer, scene->camera).picture, exact.picture), 1000u);
	options.truncated_bits = 0;
	ASSERT_TRUE(renderer->setOptions(options));
	EXPECT_EQ(differingPixels(drawnBy(*renderer, scene->camera).picture, exact.picture), 0u) << "templates are made again";
}

// What exceeds a limit coarsens the frame; nothing is missing: it is the picture of that rate.
TEST_F(rayClusters, limitsCoarsenTheFrameAndNothingIsMissing)
{
	const auto scene = gpuScene("bricks");
	for (const bool of_memory : { true, false })
	{
		RenderOptions options = pathOptions(1, RayPath::Clusters);
		if (of_memory)
			options.most_cluster_mib = 1;
		else
			options.most_cluster_vertices = kLeastClusterVertices;
		const auto renderer = clusterRenderer(*scene, options);
		ASSERT_TRUE(renderer);
		const ClusterFrame limited = drawnBy(*renderer, scene->camera);
		EXPECT_GT(limited.result.rate_granted, 1.0) << of_memory;
		EXPECT_LE(limited.clusters().data_bytes, options.most_cluster_mib * (1ull << 20) + 4096) << of_memory;
		EXPECT_LE(limited.clusters().generated_vertices, options.most_cluster_vertices) << of_memory;
		expectAllTriangles(limited, of_memory ? "memory" : "vertices");
		const ClusterFrame expected = drawn(*scene, pathOptions(float(limited.result.rate_granted), RayPath::Triangles), scene->camera);
		EXPECT_EQ(limited.result.counts.micro_triangles, expected.result.counts.micro_triangles) << of_memory;
		EXPECT_EQ(differingPixels(limited.picture, expected.picture, 1), 0u) << of_memory;
		EXPECT_EQ(drawnBy(*renderer, scene->camera).result.attempts, 1u) << of_memory << ": what fits is known";
	}
}

TEST_F(rayClusters, aReservationThatIsTooSmallIsMadeLargerInTheSameFrame)
{
	const auto scene = gpuScene("planet");
	const Camera far = closeTo(*scene, 30), near = closeTo(*scene, 0.5);
	const auto renderer = clusterRenderer(*scene, pathOptions(1, RayPath::Clusters));
	ASSERT_TRUE(renderer);
	drawnBy(*renderer, far);
	const ClusterFrame before = drawnBy(*renderer, far), after = drawnBy(*renderer, near);
	const ClusterFrame expected = drawn(*scene, pathOptions(1, RayPath::Triangles), near);
	ASSERT_GT(after.list("ray_instantiated_triangles").wanted, before.list("ray_instantiated_triangles").capacity)
		<< "the near frame does not need more than the far one had";
	EXPECT_GT(after.result.attempts, 1u);
	expectAllTriangles(after, "near");
	EXPECT_EQ(differingPixels(after.picture, expected.picture), 0u);
	EXPECT_EQ(drawnBy(*renderer, near).result.attempts, 1u);
	drawnBy(*renderer, far);
	EXPECT_LT(drawnBy(*renderer, far).list("ray_instantiated_triangles").capacity, after.list("ray_instantiated_triangles").capacity);
}

TEST_F(rayClusters, lightIsThatOfAllTrianglesAtOnceWithEveryRasteriser)
{
	const auto scene = gpuScene("bricks");
	for (const Raster raster : { Raster::Soft, Raster::Indexed, Raster::Rt })
	{
		RenderOptions options = pathOptions(8, RayPath::Clusters, raster);
		options.shadows = true;
		options.ao_samples = 1;
		const auto renderer = clusterRenderer(*scene, options);
		ASSERT_TRUE(renderer);
		const ClusterFrame clusters = drawnBy(*renderer, scene->camera);
		options.ray_path = RayPath::Triangles;
		ASSERT_TRUE(renderer->setOptions(options));
		const ClusterFrame triangles = drawnBy(*renderer, scene->camera);
		EXPECT_TRUE(clusters.clusters().built && !triangles.clusters().built);
		EXPECT_LE(differingPixels(clusters.picture, triangles.picture, 1), 5u) << rasterName(raster) << ": more than ties";
		options.ray_path = RayPath::Clusters;
		ASSERT_TRUE(renderer->setOptions(options));
		EXPECT_EQ(differingPixels(drawnBy(*renderer, scene->camera).picture, clusters.picture), 0u) << rasterName(raster) << ": and back again";
	}
}

// Rays start farther from a surface whose traced positions lose bits: seen from the sun's direction, all of a ball is lit.
TEST_F(rayClusters, aBallDoesNotShadowItselfWherePositionsLoseBits)
{
	ImportedScene imported = sphereScene(24, 48, TexelFormat::U8, Wrap::Repeat);
	imported.materials[0].displacement.reset();
	const GpuScene scene(imported);
	const dvec3 middle = (scene.built.world_low + scene.built.world_high) / 2.0, sun(0.4867, 0.6489, 0.5849);
	Camera camera = squareCamera(middle + sun * (boundingRadius(scene.built) * 3), middle);
	camera.fov_y_rad = 2 * std::atan(1.2 / 3);
	for (const uint32_t bits : { 6u, 12u })
	{
		RenderOptions options = pathOptions(3, RayPath::Clusters, Raster::Soft);
		options.shadows = true;
		options.truncated_bits = bits;
		const auto renderer = clusterRenderer(scene, options, { { "kept_visibility" } });
		ASSERT_TRUE(renderer);
		drawnBy(*renderer, camera);
		const auto seen = renderer->readResource("kept_visibility"), light = renderer->readResource("sun_visibility");
		ASSERT_TRUE(seen && light);
		size_t lit = 0, dark = 0;
		for (size_t pixel = 0; pixel < size_t(96) * 54; ++pixel)
		{
			uint64_t word = 0;
			float arrives = 0;
			std::memcpy(&word, seen->data() + pixel * sizeof word, sizeof word);
			std::memcpy(&arrives, light->data() + pixel * sizeof arrives, sizeof arrives);
			lit += word != 0 && arrives == 1;
			dark += word != 0 && arrives != 1;
		}
		EXPECT_GT(lit, 300u) << bits;
		EXPECT_EQ(dark, 0u) << bits;
	}
}

TEST_F(rayClusters, aSceneInRoundsIsSeenAsOne)
{
	const auto scene = gpuScene("instances:30", { 24, 16 });
	RenderOptions options = pathOptions(8, RayPath::Clusters);
	const ClusterFrame whole = drawn(*scene, options, scene->camera);
	options.capacities = { { "visible_clusters", 300 } };
	const ClusterFrame parts = drawn(*scene, options, scene->camera);
	EXPECT_GT(parts.result.rounds, 1u);
	EXPECT_EQ(whole.result.counts.covered_pixels, parts.result.counts.covered_pixels);
	EXPECT_EQ(differingPixels(whole.picture, parts.picture), 0u);
}

}  // namespace tessera::test
