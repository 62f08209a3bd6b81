// Micro-vertices against the reference, and who is seen at every pixel: by every raster path, under culling, from both sides.
#include "visibility.h"

#include <glm/gtc/matrix_transform.hpp>

#include <random>

namespace tessera::test
{

namespace
{

using raster = GpuTest;

RenderOptions optionsFor(float rate, Raster path)
{
	RenderOptions options = smallOptions(rate);
	options.raster = path;
	return options;
}

// The scenes that most tests here look at.
std::vector<std::pair<std::string, std::unique_ptr<GpuScene>>> someScenes()
{
	std::vector<std::pair<std::string, std::unique_ptr<GpuScene>>> scenes;
	for (const char* name : { "planet", "bricks", "materials", "instances:30" })
		scenes.emplace_back(name, gpuScene(name));
	scenes.emplace_back("uneven instances", std::make_unique<GpuScene>(unevenScene()));
	return scenes;
}

bool sameBits(const vec4& a, const vec4& b)
{
	return std::memcmp(&a, &b, sizeof(vec4)) == 0;
}

void expectSameVertices(const GpuFrame& frame, const std::string& what)
{
	const std::vector<vec4> vertices = frame.read<vec4>("micro_vertices");
	uint64_t compared = 0, different = 0;
	std::string first;
	const auto compare = [&](const std::vector<reference::MicroVertex>& expected, uint32_t first_vertex, const std::string& name) {
		ASSERT_LE(first_vertex + expected.size(), vertices.size()) << what;
		for (size_t v = 0; v < expected.size(); ++v, ++compared)
			if (const vec4& found = vertices[first_vertex + v]; !sameBits(found, expected[v].clip) && different++ == 0)
				first = fmt::format("{} vertex {}: {} {} {} {} instead of {} {} {} {}", name, v, found.x, found.y, found.z, found.w,
									expected[v].clip.x, expected[v].clip.y, expected[v].clip.z, expected[v].clip.w);
	};
	const reference::HostScene& host = frame.scene.host;
	for (const Batch& batch : frame.read<Batch>("batches"))
	{
		uint32_t vertex = batch.first_vertex;
		for (uint32_t part = batchFirst(batch.parts); part < batchFirst(batch.parts) + batchCount(batch.parts); ++part)
		{
			const reference::Evaluated expected = reference::evaluatePart(host, frame.view(), frame.parts.at(part));
			compare(expected.vertices, vertex, describe(frame.parts[part]));
			vertex += uint32_t(expected.vertices.size());
		}
	}
	for (const FullCluster& full : frame.read<FullCluster>("full_clusters"))
	{
		const ClusterRef ref = frame.visible.at(full.visible_cluster);
		compare(reference::evaluateFullCluster(host, frame.view(), ref).vertices, full.first_vertex, fmt::format("cluster {}", ref.cluster));
	}
	EXPECT_EQ(different, 0u) << what << ": " << first;
	EXPECT_GT(compared, 0u) << what;
}

// Pixels that may fall either way between two raster paths: the last bit of an edge or of a depth.
size_t mostUndecided(size_t covered)
{
	return covered / 100 + 4;
}

}  // namespace

// --- vertices --------------------------------------------------------------------------------------------------------------------

TEST_F(raster, microVerticesEqualTheReferenceBitForBit)
{
	for (const auto& [name, scene] : someScenes())
		for (const Raster path : drawingPaths())
			for (const float rate : { 10.0f, 3.0f })
				expectSameVertices(drawFrame(*scene, optionsFor(rate, path)), fmt::format("{} at rate {}", name, rate));
}

TEST_F(raster, microVerticesOnSeamsEqualTheReferenceBitForBit)
{
	for (const NamedScene& named : allScenes())
	{
		const GpuScene scene(named.scene);
		for (const float rate : { 0.0f, 3.0f })
			expectSameVertices(drawFrame(scene, smallOptions(rate)), fmt::format("{} at rate {}", named.name, rate));
	}
}

TEST_F(raster, microVerticesOfPnTrianglesEqualTheReferenceBitForBit)
{
	ImportedScene plain = cubeScene(2);
	plain.materials[0].displacement.reset();
	const std::pair<const char*, ImportedScene> scenes[] = { { "round", roundScene(2) },
															 { "hard edges", plain },
															 { "hard edges and seams, displaced", cubeScene(2) },
															 { "sphere", sphereScene(7, 9, TexelFormat::F32, Wrap::MirroredRepeat) },
															 { "soup", soupScene(1, 40) } };
	for (const auto& [name, imported] : scenes)
	{
		const GpuScene scene(imported, defaultTable(), { .pn = true });
		ASSERT_TRUE(scene.built.traits.has_pn) << name;
		for (const Raster path : drawingPaths())
		{
			const GpuFrame frame = drawFrame(scene, optionsFor(3, path));
			expectSameVertices(frame, name);
			expectSameAsReference(frame, name);
			expectCovered(frame, name);
		}
	}
}

TEST_F(raster, microVerticesOfScaledAndUnscaledDisplacementEqualTheReferenceBitForBit)
{
	const auto scene = gpuScene("cube");
	for (const auto& [scale, offset] : { std::pair(-0.7f, 0.0f), std::pair(0.0f, 0.0f), std::pair(2.5f, 0.0f), std::pair(0.5f, 0.3f) })
	{
		RenderOptions options = smallOptions(4);
		options.displacement_scale = scale;
		options.displacement_offset = offset;
		expectSameVertices(drawFrame(*scene, options), fmt::format("scale {}, offset {}", scale, offset));
	}
}

// --- who is seen -----------------------------------------------------------------------------------------------------------------

TEST_F(raster, everyPixelSeesTheMicroTriangleThatTheReferenceSees)
{
	for (const auto& [name, scene] : someScenes())
		for (const Raster path : drawingPaths())
			for (const float rate : { 0.0f, 5.0f })
			{
				const GpuFrame frame = drawFrame(*scene, optionsFor(rate, path));
				const std::vector<VisiblePixel> seen = visibilityOf(frame);
				const std::vector<ExpectedPixel> expected = expectedVisibility(frame);
				size_t wrong = 0, decided = 0, covered = 0;
				std::string first;
				for (size_t i = 0; i < seen.size(); ++i)
				{
					covered += seen[i].covered();
					decided += expected[i].decided && expected[i].covered;
					if (!expected[i].decided || (expected[i].covered == seen[i].covered() && expected[i].identity == seen[i].identity))
						continue;
					if (wrong++ == 0)
						first = fmt::format("pixel {}: {} instead of {}", i, describe(seen[i].identity), describe(expected[i].identity));
				}
				EXPECT_EQ(wrong, 0u) << name << " at rate " << rate << ": " << first;
				EXPECT_GT(decided * 10, covered * 8) << name << " at rate " << rate << ": too little is decided";
				EXPECT_EQ(covered, frame.result.counts.covered_pixels) << name;
			}
}

TEST_F(raster, everyPathSeesTheSameMicroTriangles)
{
	const std::vector<Raster> paths = drawingPaths();
	for (const auto& [name, scene] : someScenes())
		for (const float rate : { 0.0f, 12.0f, 3.0f })
		{
			const GpuFrame first = drawFrame(*scene, optionsFor(rate, paths[0]));
			for (size_t path = 1; path < paths.size(); ++path)
			{
				const std::string what = fmt::format("{} at rate {}, raster {}", name, rate, int(paths[path]));
				const GpuFrame other = drawFrame(*scene, optionsFor(rate, paths[path]));
				expectSameAsReference(other, what);
				const VisibilityDifference difference = compareVisibility(visibilityOf(first), visibilityOf(other), 160, 2e-5);
				EXPECT_EQ(difference.others, 0u) << what << ": " << difference.first;
				EXPECT_LE(difference.ties, difference.covered / 500) << what;
				// Depth, which shading starts from, may differ in its last bits.
				EXPECT_LE(differingPixels(first.picture(), other.picture(), 1), difference.ties) << what;
			}
		}
}

// The view of micro-triangles colours identities: it compares paths whose visibility is not kept after shading.
TEST_F(raster, everyPathGivesTheSamePicturesOfIdentitiesAndColours)
{
	const std::vector<Raster> paths = rasterPaths();
	for (const auto& [name, scene] : someScenes())
		for (const ViewMode view : { ViewMode::Triangles, ViewMode::Depth, ViewMode::Shaded })
		{
			RenderOptions options = optionsFor(6, paths[0]);
			options.view = view;
			const GpuFrame first = drawFrame(*scene, options);
			for (size_t path = 1; path < paths.size(); ++path)
			{
				options.raster = paths[path];
				const GpuFrame other = drawFrame(*scene, options);
				const size_t covered = first.result.counts.covered_pixels;
				EXPECT_NEAR(double(other.result.counts.covered_pixels), double(covered), double(mostUndecided(covered))) << name;
				EXPECT_LE(differingPixels(first.picture(), other.picture(), 1), mostUndecided(covered)) << name << " view " << int(view);
			}
		}
}

// --- culling ---------------------------------------------------------------------------------------------------------------------

TEST_F(raster, cullingChangesNoPixel)
{
	for (const auto& [name, scene] : someScenes())
		for (const Raster path : rasterPaths())
			for (const double nearness : { 0.5, 0.2 })
			{
				if (name == "materials")
					continue;  // one cluster
				RenderOptions options = optionsFor(6, path);
				const Camera camera = closeTo(*scene, nearness);
				const GpuFrame culled = drawFrame(*scene, options, camera);
				options.cull = { false, false, false };
				const GpuFrame whole = drawFrame(*scene, options, camera);
				const std::string what = fmt::format("{} at {} of the way, raster {}", name, nearness, int(path));
				ASSERT_EQ(culled.result.rate_granted, whole.result.rate_granted) << what;
				const VisibilityDifference difference = compareVisibility(visibilityOf(culled), visibilityOf(whole), 160);
				EXPECT_EQ(difference.others, 0u) << what << ": " << difference.first;
				EXPECT_LE(difference.ties, difference.covered / 500) << what;
				EXPECT_LE(differingPixels(culled.picture(), whole.picture()), mostUndecided(difference.covered) - 4) << what;
				EXPECT_EQ(culled.result.counts.covered_pixels, whole.result.counts.covered_pixels) << what;
				const bool small = whole.result.counts.visible_clusters < 20;
				EXPECT_TRUE(small || culled.result.counts.visible_clusters < whole.result.counts.visible_clusters) << what << ": nothing was culled";
			}
}

TEST_F(raster, everyKindOfCullingAloneChangesNoPixelFromWithin)
{
	// From the middle of a field of boulders, in four directions.
	const auto scene = gpuScene("instances:100");
	const dvec3 middle = (scene->built.world_low + scene->built.world_high) / 2.0;
	const double reach = boundingRadius(scene->built);
	for (const dvec3 way : { dvec3(1, 0.1, 0.2), dvec3(-0.3, -0.2, 1), dvec3(-1, 0.3, -0.4), dvec3(0.1, -0.9, -0.3) })
	{
		Camera camera = squareCamera(middle, middle + way * reach);
		camera.near_world = 0;
		RenderOptions options = smallOptions(8);
		options.cull = { false, false, false };
		const GpuFrame whole = drawFrame(*scene, options, camera);
		for (const CullOptions cull : { CullOptions{ true, false, false }, CullOptions{ false, true, false }, CullOptions{ false, false, true } })
		{
			options.cull = cull;
			const GpuFrame culled = drawFrame(*scene, options, camera);
			const VisibilityDifference difference = compareVisibility(visibilityOf(culled), visibilityOf(whole), 160);
			EXPECT_EQ(difference.others, 0u) << difference.first;
			EXPECT_LE(difference.ties, difference.covered / 500 + 1);
		}
	}
}

TEST_F(raster, clustersThatShowTheirBackAreCulledAndNoOthers)
{
	// Plain spheres: round, mirrored, flattened and turned.
	ImportedScene spheres = sphereScene(24, 48, TexelFormat::U8, Wrap::Repeat);
	spheres.materials[0].displacement.reset();
	const auto place = [&](dvec3 at, dvec3 scale) {
		spheres.instances.push_back({ 0, glm::rotate(glm::scale(glm::translate(dmat4(1), at), scale), 0.5, dvec3(1, 2, 1)) });
	};
	place(dvec3(3, 0, 0), dvec3(-1, 1, 1));
	place(dvec3(0, 3, 0), dvec3(1, 0.2, 1.5));
	place(dvec3(-3, 0, 0), dvec3(-0.3, -1, -1));
	const BuildOptions small_clusters = { 24, 16 };
	const GpuScene single(spheres, defaultTable(), small_clusters);
	for (Material& material : spheres.materials)
		material.double_sided = true;
	const GpuScene twofold(spheres, defaultTable(), small_clusters);
	for (const dvec3 eye : { dvec3(2, 3, 9), dvec3(-1.6, 1.4, 0.3), dvec3(0.1, 0.2, 0), dvec3(3, 0.4, 1.05), dvec3(-9, -4, 1) })
	{
		const Camera camera = squareCamera(eye, dvec3(0.2, 0.3, 0.1));
		RenderOptions options = smallOptions(10);
		options.cull = { false, true, false };
		const GpuFrame culled = drawFrame(single, options, camera), kept = drawFrame(twofold, options, camera);
		options.cull = { false, false, false };
		const GpuFrame whole = drawFrame(single, options, camera);
		const VisibilityDifference difference = compareVisibility(visibilityOf(culled), visibilityOf(whole), 160);
		EXPECT_EQ(difference.others, 0u) << difference.first;
		EXPECT_LT(culled.result.counts.visible_clusters * 10, whole.result.counts.visible_clusters * 8) << "too little was culled";
		EXPECT_EQ(kept.result.counts.visible_clusters, whole.result.counts.visible_clusters) << "two-sided materials have no back";
	}
}

// Bumpy sheets seen from behind and from near by: some triangles of a cluster show their front, others their back.
TEST_F(raster, bumpySheetsLoseNothingToBackfaceCulling)
{
	constexpr uint32_t kSide = 16;
	std::mt19937 random(5);
	const auto unit = [&] {
		return double(random()) / 4294967296.0;
	};
	size_t fewer = 0;
	for (const double bump : { 0.01, 0.1, 0.5 })
	{
		ImportedScene sheet;
		Primitive primitive;
		primitive.material = addPlain(sheet, "plain");
		for (uint32_t j = 0; j <= kSide; ++j)
			for (uint32_t i = 0; i <= kSide; ++i)
				addVertex(primitive, vec3(float(i), float(j), float(unit() * bump)), vec3(0, 0, 1), vec2(0));
		for (uint32_t j = 0; j < kSide; ++j)
			for (uint32_t i = 0; i < kSide; ++i)
			{
				const uint32_t a = j * (kSide + 1) + i, b = a + 1, c = a + kSide + 1, d = c + 1;
				addTriangle(primitive, a, b, d);
				addTriangle(primitive, a, d, c);
			}
		addPlacedMesh(sheet, { primitive });
		const GpuScene scene(sheet, defaultTable(), { 24, 16 });
		RenderOptions options = smallOptions(0);
		options.cull = { false, true, false };
		GpuFrame culled = drawFrame(scene, options);
		options.cull = { false, false, false };
		GpuFrame whole = drawFrame(scene, options);
		for (int i = 0; i < 60; ++i)
		{
			const dvec3 eye(unit() * kSide, unit() * kSide, unit() * 8 - 7);
			const Camera camera = squareCamera(eye, dvec3(unit() * kSide, unit() * kSide, bump / 2));
			drawAgain(culled, camera);
			drawAgain(whole, camera);
			const VisibilityDifference difference = compareVisibility(visibilityOf(culled), visibilityOf(whole), 160);
			ASSERT_EQ(difference.others, 0u) << "camera " << i << ": " << difference.first;
			fewer += culled.result.counts.visible_clusters < whole.result.counts.visible_clusters;
		}
	}
	EXPECT_GT(fewer, 30u);
}

// Through a narrow view, most of what a cluster can reach is what its height map says: the base triangles lie elsewhere.
TEST_F(raster, peaksInNarrowViewsAreNotLostToCulling)
{
	const BuildOptions small_clusters = { 16, 8 };
	std::vector<std::unique_ptr<GpuScene>> scenes;
	for (const ImportedScene& imported : { cubeScene(4), sphereScene(12, 24, TexelFormat::U16, Wrap::Repeat), coarseSphereScene() })
		scenes.push_back(std::make_unique<GpuScene>(imported, defaultTable(), small_clusters));
	for (const auto& scene : scenes)
	{
		RenderOptions options = smallOptions(12);
		options.displacement_scale = 4;
		GpuFrame culled = drawFrame(*scene, options);
		options.cull = { false, false, false };
		GpuFrame whole = drawFrame(*scene, options);
		options.rate = 2;
		const GpuFrame fine = drawFrame(*scene, options);
		const std::vector<reference::ReferencePiece>& parts = fine.parts;
		ASSERT_FALSE(parts.empty());
		size_t fewer = 0;
		for (size_t i = 0; i < 40; ++i)
		{
			// A vertex that sticks out, just inside a side of the picture, seen along the surface.
			const reference::ReferencePiece& part = parts[i * 7919 % parts.size()];
			const reference::MicroVertex vertex = reference::evaluatePart(scene->host, fine.view(), part).vertices.front();
			const dvec3 peak(vertex.displaced), out = glm::normalize(peak - dvec3(vertex.base) + dvec3(1e-6));
			const dvec3 along = glm::normalize(glm::cross(out, dvec3(0.3, i % 2 ? 1 : -1, 0.5)));
			Camera camera;
			camera.fov_y_rad = 0.03;
			camera.up = i % 4 < 2 ? out : along + glm::cross(out, along);
			camera.eye = peak + along * 20.0;
			camera.target = peak + out * (20 * 0.0145);
			drawAgain(culled, camera);
			drawAgain(whole, camera);
			const VisibilityDifference difference = compareVisibility(visibilityOf(culled), visibilityOf(whole), 160);
			ASSERT_EQ(difference.others, 0u) << "camera " << i << ": " << difference.first;
			ASSERT_LE(difference.ties, difference.covered / 500 + 1) << "camera " << i;
			fewer += culled.result.counts.visible_clusters < whole.result.counts.visible_clusters;
		}
		EXPECT_TRUE(fewer > 10 || scene->built.clusters.size() < 4) << "nothing was culled";
	}
}

// --- sides -----------------------------------------------------------------------------------------------------------------------

namespace
{

// Two unit squares side by side, both showing their backs to +z; the right one's material has two sides if asked.
ImportedScene twoBacks(bool left_double, bool right_double)
{
	ImportedScene scene;
	std::vector<Primitive> squares(2);
	for (uint32_t side = 0; side < 2; ++side)
	{
		const float x = side ? 0.1f : -1.1f;
		Primitive& square = squares[side];
		square.material = addPlain(scene, side ? "right" : "left");
		scene.materials[square.material].double_sided = side ? right_double : left_double;
		for (const vec2 corner : { vec2(0, 0), vec2(0, 1), vec2(1, 1), vec2(1, 0) })
			addVertex(square, vec3(corner.x + x, corner.y - 0.5f, 0), vec3(0, 0, -1), corner);
		addTriangle(square, 0, 1, 2);
		addTriangle(square, 0, 2, 3);
	}
	addPlacedMesh(scene, std::move(squares));
	return scene;
}

ImportedScene withDoubleSides(ImportedScene scene)
{
	for (Material& material : scene.materials)
		material.double_sided = true;
	return scene;
}

size_t coveredPixels(const ImportedScene& imported, float rate, Raster path, const Camera& camera)
{
	const GpuScene scene(imported);
	return drawFrame(scene, optionsFor(rate, path), camera).result.counts.covered_pixels;
}

}  // namespace

TEST_F(raster, backsShowOnlyWhereTheirMaterialHasTwoSides)
{
	// 90 px high, 90 degrees, 3 away: a unit is 15 px, so a square has 225.
	const Camera camera = squareCamera(dvec3(0, 0, 3), dvec3(0)), behind = squareCamera(dvec3(0, 0, -3), dvec3(0));
	for (const Raster path : rasterPaths())
		for (const float rate : { 0.0f, 4.0f })
		{
			EXPECT_EQ(coveredPixels(twoBacks(false, false), rate, path, camera), 0u) << rate;
			EXPECT_NEAR(double(coveredPixels(twoBacks(true, true), rate, path, camera)), 450, 30) << rate;
			EXPECT_NEAR(double(coveredPixels(twoBacks(false, true), rate, path, camera)), 225, 15) << rate;
			EXPECT_EQ(coveredPixels(twoBacks(false, false), rate, path, behind), coveredPixels(twoBacks(true, true), rate, path, behind)) << rate;
			EXPECT_EQ(coveredPixels(twoBacks(false, true), rate, path, behind), coveredPixels(twoBacks(true, true), rate, path, behind)) << rate;
		}
}

TEST_F(raster, aMirroredInstanceShowsItsOutside)
{
	ImportedScene plain = cubeScene(2), mirrored = cubeScene(2);
	mirrored.instances[0].world = glm::scale(dmat4(1), dvec3(-1, 1, 1));
	const Camera camera = squareCamera(dvec3(1.5, 1.2, 4), dvec3(0));
	Camera reflected = camera;
	reflected.eye.x = -camera.eye.x;
	for (const Raster path : rasterPaths())
		for (const float rate : { 0.0f, 5.0f })
		{
			const size_t outside = coveredPixels(plain, rate, path, camera);
			EXPECT_GT(outside, 500u);
			// The same picture, left and right exchanged; pixel centres on an edge may fall to the other side.
			EXPECT_NEAR(double(coveredPixels(mirrored, rate, path, reflected)), double(outside), 6);
			EXPECT_EQ(coveredPixels(withDoubleSides(mirrored), rate, path, reflected), coveredPixels(mirrored, rate, path, reflected));
			EXPECT_EQ(coveredPixels(withDoubleSides(plain), rate, path, camera), outside);
		}
}

TEST_F(raster, aClosedMeshIsNotSeenFromWithinUnlessItHasTwoSides)
{
	const Camera within = squareCamera(dvec3(0.1, 0.2, 0.1), dvec3(1, 0.3, 0.2));
	for (const Raster path : rasterPaths())
		for (const bool mirrored : { false, true })
		{
			ImportedScene cube = cubeScene(2);
			if (mirrored)
				cube.instances[0].world = glm::scale(dmat4(1), dvec3(1, -1, 1));
			EXPECT_EQ(coveredPixels(cube, 5, path, within), 0u) << mirrored;
			EXPECT_EQ(coveredPixels(withDoubleSides(cube), 5, path, within), 160u * 90u) << mirrored << ": there is a hole";
		}
}

// --- the untessellated mesh ------------------------------------------------------------------------------------------------------

TEST_F(raster, rateZeroDrawsTheMeshAsAnyRateDoesWhenNothingIsDisplaced)
{
	for (const char* name : { "planet", "bricks" })
	{
		const auto scene = gpuScene(name);
		for (const Raster path : rasterPaths())
		{
			RenderOptions options = optionsFor(0, path);
			options.displacement_scale = 0;
			const GpuFrame off = drawFrame(*scene, options);
			EXPECT_FALSE(off.renderer->plan().has("cluster_classify"));
			EXPECT_EQ(off.result.counts.part_triangles, 0u);
			options.rate = 2;
			const GpuFrame cut = drawFrame(*scene, options);
			EXPECT_GT(cut.result.counts.part_triangles, 0u) << name;
			const size_t covered = off.result.counts.covered_pixels;
			EXPECT_NEAR(double(cut.result.counts.covered_pixels), double(covered), double(mostUndecided(covered))) << name;
			EXPECT_LE(differingPixels(off.picture(), cut.picture(), 3), mostUndecided(covered)) << name;
		}
	}
}

}  // namespace tessera::test
