// Distances to an original, against closed forms: planes, spheres, a sine; and the asteroid of glmark2, whose high model is known.
#include "reference_test_scenes.h"

#include "report/original_error.h"
#include "scene/displacement_option.h"
#include "scene/gltf_import.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <unistd.h>

namespace tessera::test
{

namespace
{

using namespace report;

constexpr double kPi = std::numbers::pi;
constexpr SamplingLimits kLimits = { 1 << 14, 1 << 18, 0.01 };

// 500 pixels per world unit, from above.
View viewFromAbove(const ReferenceScene& scene, double rate_px)
{
	Camera camera;
	camera.target = (scene.built.world_low + scene.built.world_high) / 2.0;
	camera.eye = camera.target + dvec3(0, 0, 5);
	camera.orthographic = true;
	camera.height_world = 2;
	ViewRequest request = { 1000, 1000 };
	request.rate_px = rate_px;
	View view = viewOf(scene, camera, request);
	view.sample_over_focal_squared = 0;  // mip 0: micro-vertices lie on the reference surface
	return view;
}

WorldSurface originalOf(const ImportedScene& model)
{
	Result<WorldSurface> surface = originalSurface(model);
	EXPECT_TRUE(surface);
	return std::move(*surface);
}

constexpr double kDiagonal = 10;

AgainstOriginal measure(const ReferenceScene& scene, const WorldSurface& original, const View& view)
{
	Progress progress(false);
	const Result<MicroScene> micro = tessellate(scene.host, view, 8);
	const ReferenceSurface surface(scene.host, view, 200'000);
	return OriginalMeasure(original, kDiagonal, kLimits).measure(scene.host, view, surface, *micro, progress);
}

// Of the undisplaced scene.
OriginalError errorOf(const ImportedScene& scene, const ImportedScene& original)
{
	const ReferenceScene built(scene);
	return measure(built, originalOf(original), viewFromAbove(built, 1000)).drawn;
}

ImportedScene square(dvec3 corner)
{
	return triangleScene({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } },
						 glm::dmat4(1) + glm::dmat4(dvec4(0), dvec4(0), dvec4(0), dvec4(corner, 0)));
}

ImportedScene sphereAt(uint32_t cuts, double radius, dvec3 middle)
{
	ImportedScene scene = roundScene(cuts);
	dmat4& world = scene.instances[0].world;
	world = dmat4(radius);
	world[3] = dvec4(middle, 1);
	return scene;
}

void expectAll(const Figures& figures, double expected, double tolerance)
{
	EXPECT_NEAR(figures.max, expected, tolerance);
	EXPECT_NEAR(figures.rms, expected, tolerance);
	EXPECT_NEAR(figures.p99, expected, tolerance);
}

// How far the triangles lie within the unit sphere: root mean square by area, and largest.
dvec2 depthInUnitSphere(const Primitive& primitive)
{
	constexpr int kCuts = 40;
	double squares = 0, area = 0, most = 0;
	for (size_t i = 0; i < primitive.indices.size(); i += 3)
	{
		const auto corner = [&](size_t k) {
			return dvec3(primitive.positions[primitive.indices[i + k]]);
		};
		const dvec3 a = corner(0), b = corner(1), c = corner(2);
		const dvec2 w = nearestWeights(dvec3(0), a, b, c);
		most = std::max(most, 1 - glm::length(a * w.x + b * w.y + c * (1 - w.x - w.y)));
		const double own = glm::length(glm::cross(b - a, c - a)) / 2 / (kCuts * kCuts);
		for (int u = 0; u < kCuts; ++u)
			for (int v = 0; u + v < kCuts; ++v)
				for (int half = 0; half < (u + v + 1 < kCuts ? 2 : 1); ++half)
				{
					const double x = (u + (half ? 2.0 : 1.0) / 3) / kCuts, y = (v + (half ? 2.0 : 1.0) / 3) / kCuts;
					const double depth = 1 - glm::length(a * x + b * y + c * (1 - x - y));
					squares += own * depth * depth;
					area += own;
				}
	}
	return { std::sqrt(squares / area), most };
}

constexpr double kAmplitude = 0.02;

double sineHeight(double v)
{
	return kAmplitude * std::cos(2 * kPi * v);
}

// A square of 4 x 4 quads, a sine across it.
ImportedScene displacedBySine()
{
	constexpr uint32_t kTexels = 8192, kCells = 4;
	Image image;
	image.name = "sine";
	image.width = 2;
	image.height = kTexels;
	image.channels = 1;
	image.format = TexelFormat::F32;
	std::vector<float> texels;
	for (uint32_t y = 0; y < kTexels; ++y)
		texels.insert(texels.end(), 2, float(sineHeight((y + 0.5) / kTexels)));
	image.texels.resize(texels.size() * sizeof(float));
	std::memcpy(image.texels.data(), texels.data(), image.texels.size());
	ImportedScene scene;
	Primitive primitive;
	primitive.material = addDisplaced(scene, std::move(image), 1, 0);
	for (uint32_t j = 0; j <= kCells; ++j)
		for (uint32_t i = 0; i <= kCells; ++i)
			addVertex(primitive, vec3(float(i), float(j), 0) / float(kCells), vec3(0, 0, 1), vec2(float(i), float(j)) / float(kCells));
	for (uint32_t j = 0; j < kCells; ++j)
		for (uint32_t i = 0; i < kCells; ++i)
		{
			const uint32_t a = j * (kCells + 1) + i, c = a + kCells + 1;
			addTriangle(primitive, a, a + 1, c);
			addTriangle(primitive, a + 1, c + 1, c);
		}
	addPlacedMesh(scene, { primitive });
	return scene;
}

// The same surface as strips, `above` higher.
ImportedScene modelledSine(double above)
{
	constexpr uint32_t kStrips = 4096;
	ImportedScene scene;
	Primitive primitive;
	primitive.material = addPlain(scene, "plain");
	for (uint32_t j = 0; j <= kStrips; ++j)
		for (const float x : { 0.0f, 1.0f })
			addVertex(primitive, vec3(x, float(j) / kStrips, float(sineHeight(double(j) / kStrips) + above)), vec3(0, 0, 1), vec2(0));
	for (uint32_t j = 0; j < kStrips; ++j)
	{
		addTriangle(primitive, 2 * j, 2 * j + 1, 2 * j + 2);
		addTriangle(primitive, 2 * j + 1, 2 * j + 3, 2 * j + 2);
	}
	addPlacedMesh(scene, { primitive });
	return scene;
}

}  // namespace

TEST(originalError, aPlaneMovedAlongItsNormalIsAsFarAwayAsItWasMoved)
{
	const OriginalError error = errorOf(square(dvec3(0)), square({ 0, 0, 0.125 }));
	for (const Figures* figures : { &error.to_original_world, &error.to_surface_world, &error.world })
		expectAll(*figures, 0.125, 1e-6);
	expectAll(error.relative, 0.125 / kDiagonal, 1e-7);
	expectAll(error.px, 0.125 * 500, 1e-3);
	EXPECT_TRUE(error.converged);
	expectAll(errorOf(square(dvec3(0)), square(dvec3(0))).world, 0, 1e-7);
	// Far from the world's origin too.
	expectAll(errorOf(square({ 1e6, -2e6, 3e5 }), square({ 1e6, -2e6, 3e5 + 0.125 })).world, 0.125, 1e-6);
}

TEST(originalError, aPlaneMovedAlongItselfIsAwayWhereTheTwoDoNotOverlap)
{
	const double moved = 0.25;
	const OriginalError error = errorOf(square(dvec3(0)), square({ moved, 0, 0 }));
	for (const Figures* figures : { &error.to_original_world, &error.to_surface_world })
	{
		EXPECT_NEAR(figures->max, moved, 0.01 * moved);
		// A strip of that width.
		const double rms = std::sqrt(moved * moved * moved / 3);
		EXPECT_NEAR(figures->rms, rms, 0.01 * rms);
		EXPECT_NEAR(figures->p99, moved - 0.01, 0.01 * moved);
	}
}

TEST(originalError, concentricSpheresAreAsFarApartAsTheirRadii)
{
	const dvec3 middle(1000, -500, 20);
	const OriginalError error = errorOf(sphereAt(64, 1, middle), sphereAt(64, 1.1, middle));
	for (const Figures* figures : { &error.to_original_world, &error.to_surface_world, &error.world })
		expectAll(*figures, 0.1, 0.001);
	expectAll(error.px, 50, 0.5);
	expectAll(error.relative, 0.01, 0.0001);
}

TEST(originalError, aSubdividedSphereAgainstAFinerOneAgreesWithTheClosedForm)
{
	for (const uint32_t cuts : { 2u, 4u })
	{
		const OriginalError error = errorOf(roundScene(cuts), roundScene(96));
		const dvec2 expected = depthInUnitSphere(roundScene(cuts).meshes[0].primitives[0]);
		EXPECT_NEAR(error.to_original_world.rms, expected.x, 0.01 * expected.x) << cuts;
		EXPECT_NEAR(error.to_original_world.max, expected.y, 0.01 * expected.y) << cuts;
		EXPECT_NEAR(error.to_surface_world.max, expected.y, 0.01 * expected.y) << cuts;
	}
}

TEST(originalError, fallsWithTheRateToWhatTheReferenceSurfaceLeaves)
{
	constexpr double kAbove = 0.003;
	const ReferenceScene scene(displacedBySine());
	const WorldSurface original = originalOf(modelledSine(kAbove));
	double last = 1e30;
	for (const double rate : { 125.0, 60.0, 30.0, 15.0, 4.0 })
	{
		const AgainstOriginal measured = measure(scene, original, viewFromAbove(scene, rate));
		// A little less where the surface slopes, and at the two ends farther from what ends sooner.
		EXPECT_NEAR(measured.floor.world.rms, kAbove, 0.02 * kAbove) << rate;
		const double undisplaced = std::sqrt(kAmplitude * kAmplitude / 2 + kAbove * kAbove);
		EXPECT_NEAR(measured.undisplaced.to_original_world.rms, undisplaced, 0.03 * undisplaced) << rate;
		EXPECT_LT(measured.drawn.world.rms, last * 1.001) << rate;
		EXPECT_GE(measured.drawn.world.rms, 0.99 * measured.floor.world.rms) << rate;
		last = measured.drawn.world.rms;
		if (rate == 4)
		{
			EXPECT_NEAR(last, measured.floor.world.rms, 0.01 * last);
		}
		if (rate == 125)
		{
			EXPECT_GT(last, 1.3 * measured.floor.world.rms);
		}
	}
}

TEST(originalError, everyInstanceOfTheOriginalCountsAndEveryOneThatIsDrawn)
{
	ImportedScene two = square(dvec3(0));
	two.instances.push_back(two.instances[0]);
	two.instances[1].world[3] = dvec4(0, 0, 3, 1);
	expectAll(errorOf(two, two).world, 0, 1e-6);
	const OriginalError missing = errorOf(two, square(dvec3(0)));
	EXPECT_NEAR(missing.to_original_world.max, 3, 1e-6);
	EXPECT_NEAR(missing.to_original_world.rms, 3 / std::sqrt(2.0), 0.03);
	EXPECT_NEAR(missing.to_surface_world.max, 0, 1e-6);
	EXPECT_NEAR(errorOf(square(dvec3(0)), two).to_surface_world.max, 3, 1e-6);
}

TEST(originalError, theSameInputGivesTheSameFigures)
{
	const OriginalError a = errorOf(roundScene(3), roundScene(20)), b = errorOf(roundScene(3), roundScene(20));
	EXPECT_EQ(a.world, b.world);
	EXPECT_EQ(a.px, b.px);
	EXPECT_EQ(a.samples, b.samples);
}

TEST(originalError, anOriginalWithoutAreaIsRefused)
{
	const Result<WorldSurface> flat = originalSurface(triangleScene({ { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } }));
	ASSERT_FALSE(flat);
	EXPECT_NE(flat.error().message.find("no triangle with an area"), std::string::npos) << flat.error().message;
}

// The low asteroid and its height map against the high one.
TEST(originalErrorOfTheAsteroid, fallsWithTheRateAndIsSmallerThanWithoutDisplacement)
{
	namespace fs = std::filesystem;
	const fs::path data = "/usr/share/glmark2", map = data / "textures/asteroid-height-map.png";
	if (!fs::exists(map) || std::system("command -v assimp > /dev/null") != 0)
		GTEST_SKIP() << "glmark2-data or assimp-utils is not installed (thirdparty/setup.sh --all)";
	const fs::path folder = fs::temp_directory_path() / fmt::format("tessera_asteroid_{}", getpid());
	fs::create_directories(folder);
	const auto modelOf = [&](const std::string& name) {
		const fs::path file = folder / (name + ".glb");
		const std::string command = fmt::format("assimp export {}/models/asteroid-{}.3ds {} -f glb2 > /dev/null", data.string(), name, file.string());
		EXPECT_EQ(std::system(command.c_str()), 0) << command;
		const Result<ImportedScene> model = importGltf(file);
		EXPECT_TRUE(model) << name;
		return model ? *model : ImportedScene();
	};
	ImportedScene low = modelOf("low");
	const ImportedScene high = modelOf("high");
	fs::remove_all(folder);
	ASSERT_FALSE(HasFailure());
	ASSERT_TRUE(attachDisplacement(low, map.string() + ":0.0224:-0.0131"));

	const ReferenceScene scene(low);
	const WorldSurface original = originalOf(high);
	double last = 1e30;
	for (const double rate : { 100.0, 8.0, 3.0 })
	{
		const AgainstOriginal measured = measure(scene, original, viewFromAbove(scene, rate));
		fmt::print("asteroid at rate {}: {:.5f} (root mean square); floor {:.5f}, not displaced {:.5f}; change {:.3f}\n", rate,
				   measured.drawn.world.rms, measured.floor.world.rms, measured.undisplaced.world.rms, measured.drawn.change);
		EXPECT_LT(measured.drawn.world.rms, last) << rate;
		last = measured.drawn.world.rms;
		if (rate > 3)
			continue;
		EXPECT_NEAR(last, measured.floor.world.rms, 0.03 * last);
		EXPECT_LT(last, 0.95 * measured.undisplaced.world.rms);
	}
}

}  // namespace tessera::test
