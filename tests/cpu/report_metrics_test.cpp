// Error metrics against closed forms: a sphere, a sine, convergence, the float floor; and pictures against formulas.
#include "reference_test_scenes.h"

#include "report/geometry_error.h"
#include "report/image_error.h"
#include "report/numerics.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numbers>
#include <random>

namespace tessera::test
{

namespace
{

using namespace report;

constexpr double kPi = std::numbers::pi;

// One channel of float: height(u, v) at every texel's centre.
template <typename Height>
Image heightImage(uint32_t width, uint32_t height, const Height& heightAt)
{
	Image image;
	image.name = "heights";
	image.width = width;
	image.height = height;
	image.channels = 1;
	image.format = TexelFormat::F32;
	image.texels.resize(size_t(width) * height * sizeof(float));
	for (uint32_t y = 0; y < height; ++y)
		for (uint32_t x = 0; x < width; ++x)
		{
			const auto value = float(heightAt((x + 0.5) / width, (y + 0.5) / height));
			std::memcpy(image.texels.data() + (size_t(y) * width + x) * sizeof value, &value, sizeof value);
		}
	return image;
}

// An octahedron far too small to see, every point of which is moved by 1 along the direction from its centre: the unit sphere to 1e-5.
ImportedScene inflatedOctahedron()
{
	ImportedScene scene;
	Primitive primitive;
	primitive.material = addDisplaced(scene, constantImage(1, 1, TexelFormat::F32, 1.0), 1, 0);
	constexpr float kSize = 1e-5f;
	const vec3 axes[6] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { -1, 0, 0 }, { 0, -1, 0 }, { 0, 0, -1 } };
	for (const vec3& axis : axes)
		addVertex(primitive, axis * kSize, axis, vec2(0));
	for (uint32_t octant = 0; octant < 8; ++octant)
	{
		const uint32_t x = octant & 1 ? 3 : 0, y = octant & 2 ? 4 : 1, z = octant & 4 ? 5 : 2;
		const bool turned = ((octant & 1) + (octant >> 1 & 1) + (octant >> 2 & 1)) % 2 != 0;
		addTriangle(primitive, x, turned ? z : y, turned ? y : z);
	}
	addPlacedMesh(scene, { primitive });
	return scene;
}

// A rhombus of side 1 of cells x cells x 2 equilateral triangles; v runs from 0 to 1 across its rows.
ImportedScene rhombus(uint32_t cells, Image heights, float factor)
{
	ImportedScene scene;
	Primitive primitive;
	primitive.material = addDisplaced(scene, std::move(heights), factor, 0, Wrap::Repeat);
	for (uint32_t j = 0; j <= cells; ++j)
		for (uint32_t i = 0; i <= cells; ++i)
		{
			const float s = float(i) / float(cells), t = float(j) / float(cells);
			addVertex(primitive, vec3(s + 0.5f * t, t * std::sqrt(0.75f), 0), vec3(0, 0, 1), vec2(s, t));
		}
	for (uint32_t j = 0; j < cells; ++j)
		for (uint32_t i = 0; i < cells; ++i)
		{
			const uint32_t a = j * (cells + 1) + i, c = a + cells + 1;
			addTriangle(primitive, a, a + 1, c);
			addTriangle(primitive, a + 1, c + 1, c);
		}
	addPlacedMesh(scene, { primitive });
	return scene;
}

// From above, one distance for all: an edge of length L gets L * 1000 / (rate * height) segments.
Camera fromAbove(const BuiltScene& scene, double height_world)
{
	Camera camera;
	camera.target = (scene.world_low + scene.world_high) / 2.0;
	camera.eye = camera.target + dvec3(0, 0, 5);
	camera.orthographic = true;
	camera.height_world = height_world;
	return camera;
}

View orthographicView(const ReferenceScene& scene, double height_world, double rate_px)
{
	ViewRequest request = { 1000, 1000 };
	request.rate_px = rate_px;
	return viewOf(scene, fromAbove(scene.built, height_world), request);
}

struct Measured
{
	RegionError whole, visible;
	uint64_t triangles = 0;
};

Measured measure(const ReferenceScene& scene, const View& view, const SamplingLimits& limits = { 1 << 14, 1 << 17, 0.01 })
{
	const Result<MicroScene> micro = tessellate(scene.host, view, 8);
	const ReferenceSurface surface(scene.host, view, 200'000);
	const SurfacePair pair(scene.host, view, surface, *micro);
	Progress progress(false);
	const double diagonal = glm::length(scene.built.world_high - scene.built.world_low);
	return { wholeSurfaceError(pair, diagonal, limits, progress), visibleError(pair, diagonal, limits, progress), micro->triangleCount() };
}

// The micro-triangles of one face of the sphere with n segments per edge, in closed form.
template <typename Visit>
void forEachSphereTriangle(int n, const Visit& visit)
{
	const auto at = [n](int i, int j) {
		return glm::normalize(dvec3(i, j, n - i - j));
	};
	for (int i = 0; i < n; ++i)
		for (int j = 0; i + j < n; ++j)
		{
			visit(at(i, j), at(i + 1, j), at(i, j + 1));
			if (i + j + 1 < n)
				visit(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
		}
}

struct SphereError
{
	double max = 0, rms = 0;
};

// Distance of a point p of a triangle to the sphere is 1 - |p|: largest at the foot of the centre (within it: else at the nearest point to it).
SphereError sphereError(int n)
{
	SphereError error;
	double squares = 0, area = 0;
	forEachSphereTriangle(n, [&](dvec3 a, dvec3 b, dvec3 c) {
		const dvec2 w = nearestWeights(dvec3(0), a, b, c);
		error.max = std::max(error.max, 1 - glm::length(a * w.x + b * w.y + c * (1 - w.x - w.y)));
		const double own = glm::length(glm::cross(b - a, c - a)) / 2;
		constexpr int kCuts = 60;
		double sum = 0;
		for (int i = 0; i < kCuts; ++i)
			for (int j = 0; i + j < kCuts; ++j)
				for (int half = 0; half < (i + j + 1 < kCuts ? 2 : 1); ++half)
				{
					const double u = (i + (half ? 2.0 : 1.0) / 3) / kCuts, v = (j + (half ? 2.0 : 1.0) / 3) / kCuts;
					const double distance = 1 - glm::length(a * u + b * v + c * (1 - u - v));
					sum += distance * distance;
				}
		squares += own * sum / (kCuts * kCuts);
		area += own;
	});
	error.rms = std::sqrt(squares / area);
	return error;
}

double slopeOf(const std::vector<dvec2>& points)
{
	dvec2 mean(0);
	for (const dvec2& p : points)
		mean += glm::log(p) / double(points.size());
	double xy = 0, xx = 0;
	for (const dvec2& p : points)
	{
		const dvec2 d = glm::log(p) - mean;
		xy += d.x * d.y;
		xx += d.x * d.x;
	}
	return xy / xx;
}

Picture pictureOf(uint32_t width, uint32_t height, const std::function<uint8_t(uint32_t, uint32_t)>& value)
{
	Picture picture = { width, height, std::vector<uint8_t>(size_t(width) * height * 4, 255), {} };
	for (uint32_t y = 0; y < height; ++y)
		for (uint32_t x = 0; x < width; ++x)
			for (size_t channel = 0; channel < 3; ++channel)
				picture.rgba[4 * (size_t(y) * width + x) + channel] = value(x, y);
	return picture;
}

}  // namespace

// --- nearest points --------------------------------------------------------------------------------------------------------------

TEST(triangleSet, findsTheNearestPointThatLookingAtEveryTriangleFinds)
{
	std::mt19937 random(3);
	const auto number = [&](double low, double high) {
		return std::uniform_real_distribution<double>(low, high)(random);
	};
	std::vector<vec3> positions;
	std::vector<uvec3> triangles;
	for (uint32_t i = 0; i < 300; ++i)
	{
		const dvec3 middle(number(-1, 1), number(-1, 1), number(-1, 1));
		for (int k = 0; k < 3; ++k)
			positions.push_back(vec3(middle + dvec3(number(-1, 1), number(-1, 1), number(-1, 1)) * 0.1));
		triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
	}
	const TriangleSet set(positions, triangles);
	for (int i = 0; i < 500; ++i)
	{
		const dvec3 q(number(-2, 2), number(-2, 2), number(-2, 2));
		double least = std::numeric_limits<double>::infinity();
		for (const uvec3 t : triangles)
		{
			const dvec3 a = positions[t.x], b = positions[t.y], c = positions[t.z];
			const dvec2 w = nearestWeights(q, a, b, c);
			least = std::min(least, glm::length(a * w.x + b * w.y + c * (1 - w.x - w.y) - q));
		}
		ASSERT_TRUE(set.nearest(q, 100).has_value());
		EXPECT_EQ(set.nearest(q, 100)->distance, least);
		EXPECT_TRUE(set.nearest(q, least).has_value());
		EXPECT_FALSE(set.nearest(q, least * 0.999).has_value());
	}
}

TEST(triangleSet, nearestWeightsAreNotFartherThanAnyOtherPointOfTheTriangle)
{
	std::mt19937 random(5);
	const auto number = [&] {
		return std::uniform_real_distribution<double>(-1, 1)(random);
	};
	for (int i = 0; i < 2000; ++i)
	{
		const dvec3 a(number(), number(), number()), b(number(), number(), number()), c(number(), number(), number());
		const dvec3 q = dvec3(number(), number(), number()) * 2.0;
		const auto distance = [&](dvec2 w) {
			return glm::length(a * w.x + b * w.y + c * (1 - w.x - w.y) - q);
		};
		const dvec2 best = nearestWeights(q, a, b, c);
		EXPECT_GE(std::min({ best.x, best.y, 1 - best.x - best.y }), -1e-12);
		for (int u = 0; u <= 10; ++u)
			for (int v = 0; u + v <= 10; ++v)
				EXPECT_LE(distance(best), distance(dvec2(u, v) / 10.0) + 1e-12);
	}
}

// --- geometry --------------------------------------------------------------------------------------------------------------------

TEST(geometryError, sphereOfNSegmentsPerEdgeAgreesWithTheClosedForm)
{
	const ReferenceScene scene(inflatedOctahedron());
	for (const int n : { 1, 2, 3, 5, 8, 11 })
	{
		// Edges are sqrt(2) * 1e-5 long.
		const View view = orthographicView(scene, 1e-3, std::sqrt(2.0) * 1e-5 * 1e6 / n);
		const Measured measured = measure(scene, view);
		ASSERT_EQ(measured.triangles, uint64_t(8 * n * n));
		const SphereError expected = sphereError(n);
		for (const Figures* figures : { &measured.whole.to_reference_mesh, &measured.whole.to_tessellated_mesh })
			EXPECT_NEAR(figures->max, expected.max, 0.01 * expected.max + 1e-5) << n;
		EXPECT_NEAR(measured.whole.to_reference_mesh.rms, expected.rms, 0.01 * expected.rms + 1e-5) << n;
		EXPECT_TRUE(measured.whole.converged) << n << " change " << measured.whole.change;
		if (n == 1)
		{
			EXPECT_NEAR(measured.whole.mesh.max, 1 - 1 / std::sqrt(3.0), 0.0043);
			EXPECT_NEAR(measured.whole.normal_deg.max, 54.7356, 0.6);
		}
	}
}

TEST(geometryError, sineOnAPlaneAgreesWithTheClosedForm)
{
	constexpr double kAmplitude = 0.002;
	constexpr int kCells = 4;
	const auto sine = [](double, double v) {
		return std::cos(2 * kPi * v);
	};
	const ReferenceScene scene(rhombus(kCells, heightImage(2, 8192, sine), float(kAmplitude)));
	for (const int n : { 1, 2, 4, 8 })
	{
		View view = orthographicView(scene, 2, 1.0 / kCells * 500 / n);
		view.sample_over_focal_squared = 0;  // mip 0: micro-vertices lie on the reference surface
		const Measured measured = measure(scene, view);
		ASSERT_EQ(measured.triangles, uint64_t(2 * kCells * kCells * n * n));
		// Rows of micro-triangles are straight across v: what is left is a cosine cut into equal chords, one of which begins on the crest.
		const int rows = kCells * n;
		double max = 0, squares = 0;
		constexpr int kSteps = 400;
		for (int row = 0; row < rows; ++row)
			for (int i = 0; i < kSteps; ++i)
			{
				const double t = (i + 0.5) / kSteps, v = (row + t) / rows;
				const double chord = (1 - t) * std::cos(2 * kPi * row / rows) + t * std::cos(2 * kPi * (row + 1) / rows);
				const double distance = kAmplitude * std::abs(std::cos(2 * kPi * v) - chord);
				max = std::max(max, distance);
				squares += distance * distance / (rows * kSteps);
			}
		for (const Figures* figures : { &measured.whole.to_reference_mesh, &measured.whole.to_tessellated_mesh })
		{
			EXPECT_NEAR(figures->max, max, 0.01 * max) << n;
			EXPECT_NEAR(figures->rms, std::sqrt(squares), 0.01 * std::sqrt(squares)) << n;
		}
		// 500 pixels per world unit at any depth.
		EXPECT_NEAR(measured.visible.px.max, measured.visible.mesh.max * 500, 1e-6 * measured.visible.px.max);
		EXPECT_NEAR(measured.visible.px.max, max * 500, 0.01 * max * 500) << n;
		EXPECT_NEAR(measured.visible.px.rms, std::sqrt(squares) * 500, 0.01 * std::sqrt(squares) * 500) << n;
	}
}

TEST(geometryError, fallsWithTheSquareOfTheSegmentLengthOnASmoothMap)
{
	const auto waves = [](double u, double v) {
		return 0.5 + 0.25 * std::cos(2 * kPi * 2 * u) * std::sin(2 * kPi * (v + 0.1)) + 0.2 * std::sin(2 * kPi * (u - v));
	};
	const ReferenceScene scene(rhombus(4, heightImage(1024, 1024, waves), 0.05f));
	std::vector<dvec2> rms, max;
	for (const double rate : { 12.0, 8.0, 6.0, 4.0, 3.0, 2.0 })
	{
		const Measured measured = measure(scene, orthographicView(scene, 2, rate));
		rms.push_back({ rate, measured.whole.px.rms });
		max.push_back({ rate, measured.whole.px.max });
	}
	EXPECT_NEAR(slopeOf(rms), 2, 0.2);
	EXPECT_NEAR(slopeOf(max), 2, 0.2);
}

// At a rate a little finer than that of `edge`, the metric `detail` is as exact over the whole surface with at most half the micro-triangles.
TEST(geometryError, detailNeedsAtMostHalfTheTrianglesOfEdgeOnTerrainAndPlanet)
{
	for (const char* name : { "terrain", "planet" })
	{
		BuildOptions tables;
		tables.tables.details = true;
		const auto by_edge = builtinScene(name), by_detail = builtinScene(name, tables);
		const Camera camera = cameraOf(by_edge->built.cameras.at(0), by_edge->built);
		const auto at = [&](const ReferenceScene& scene, double rate_px) {
			ViewRequest request = { 480, 270 };
			request.rate_px = rate_px;
			return measure(scene, viewOf(scene, camera, request), { 1 << 15, 1 << 15, 0.01 });
		};
		const Measured edge = at(*by_edge, 4);
		double least = 1;
		for (const double rate : { 3.8, 3.2, 2.8 })
		{
			const Measured detail = at(*by_detail, rate);
			const double share = double(detail.triangles) / double(edge.triangles);
			fmt::print("{}: rate {}: {:.3f} of the micro-triangles, errors {:.3f} and {:.3f} px (99th percentile, largest), edge {:.3f} and {:.3f}\n",
					   name, rate, share, detail.whole.px.p99, detail.whole.px.max, edge.whole.px.p99, edge.whole.px.max);
			if (detail.whole.px.p99 <= edge.whole.px.p99 && detail.whole.px.max <= edge.whole.px.max * 1.05)
				least = std::min(least, share);
		}
		EXPECT_LE(least, 0.5) << name;
	}
}

TEST(geometryError, pnTrianglesAreMeasuredAgainstTheCurvedSurfaceThatTheyAre)
{
	const ReferenceScene flat(roundScene(2)), curved(roundScene(2), defaultTable(), { .pn = true });
	double before = 0;
	for (const double rate : { 64.0, 32.0, 16.0 })
	{
		EXPECT_LT(measure(flat, orthographicView(flat, 3, rate)).whole.mesh.max, 1e-6);
		const Measured measured = measure(curved, orthographicView(curved, 3, rate));
		printf("sphere of 32 PN triangles at rate %.0f: %llu micro-triangles, max %.2e, RMS %.2e\n", rate,
			   static_cast<unsigned long long>(measured.triangles), measured.whole.mesh.max, measured.whole.mesh.rms);
		// With the square of the segments' length.
		if (before > 0)
		{
			EXPECT_NEAR(before / measured.whole.mesh.rms, 4, 1.2);
		}
		before = measured.whole.mesh.rms;
	}
}

TEST(geometryError, flatDisplacementIsAtTheFloatFloorAtAnyRate)
{
	const ReferenceScene scene(rhombus(3, constantImage(64, 64, TexelFormat::U16, 40000), 0.3f));
	for (const double rate : { 200.0, 40.0, 10.0, 3.0 })
	{
		const Measured measured = measure(scene, orthographicView(scene, 2, rate), { 1 << 13, 1 << 14, 0.01 });
		EXPECT_LT(measured.whole.mesh.max, 2e-7) << rate;
		EXPECT_LT(measured.visible.mesh.max, 2e-7) << rate;
		EXPECT_LT(measured.whole.normal_deg.p99, 0.1) << rate;
	}
}

TEST(geometryError, whatIsHiddenCountsForTheWholeSurfaceOnly)
{
	// Seen from above, the lower of two sheets is hidden; it alone is displaced by waves.
	const auto waves = [](double u, double v) {
		return std::sin(2 * kPi * 3 * u) * std::sin(2 * kPi * 3 * v);
	};
	ImportedScene imported = rhombus(2, heightImage(256, 256, waves), 0.1f);
	Primitive cover;
	cover.material = addPlain(imported, "cover");
	addVertex(cover, vec3(-1, -1, 1), vec3(0, 0, 1), vec2(0));
	addVertex(cover, vec3(5, -1, 1), vec3(0, 0, 1), vec2(0));
	addVertex(cover, vec3(-1, 5, 1), vec3(0, 0, 1), vec2(0));
	addTriangle(cover, 0, 1, 2);
	addPlacedMesh(imported, { cover });
	const ReferenceScene scene(imported);
	const Measured measured = measure(scene, orthographicView(scene, 2, 100));
	EXPECT_GT(measured.whole.mesh.max, 0.01);
	EXPECT_LT(measured.visible.mesh.max, 1e-6);
	EXPECT_GT(measured.visible.samples, 1000u);
}

TEST(geometryError, instancesAreMeasuredInTheirOwnUnitsAndInPixels)
{
	ImportedScene imported = inflatedOctahedron();
	imported.instances[0].world = glm::dmat4(3.0);
	imported.instances[0].world[3] = dvec4(1000, -500, 20, 1);
	const ReferenceScene scene(imported);
	const View view = orthographicView(scene, 1e-3, std::sqrt(2.0) * 3e-5 * 1e6 / 2);
	const Measured measured = measure(scene, view);
	const double expected = sphereError(2).max;
	EXPECT_NEAR(measured.whole.mesh.max, expected, 0.01 * expected);
	EXPECT_NEAR(measured.whole.px.max, 3 * expected * 1e6, 0.01 * 3 * expected * 1e6);
	const double diagonal = glm::length(scene.built.world_high - scene.built.world_low);
	EXPECT_NEAR(measured.whole.relative.max, 3 * expected / diagonal, 0.01 * 3 * expected / diagonal);
}

TEST(geometryError, doublingTheSamplesOnceMoreStaysWithinWhatIsSaid)
{
	const std::unique_ptr<ReferenceScene> scene = builtinScene("builtin:planet");
	Camera camera = framingCamera(scene->built);
	ViewRequest request = { 320, 240 };
	request.rate_px = 8;
	const View view = viewOf(*scene, camera, request);
	const Result<MicroScene> micro = tessellate(scene->host, view, 8);
	const ReferenceSurface surface(scene->host, view, 400'000);
	const SurfacePair pair(scene->host, view, surface, *micro);
	Progress progress(false);
	const SamplingLimits limits = { 1 << 15, 1 << 18, 0.02 };
	const RegionError error = wholeSurfaceError(pair, 1, limits, progress);
	EXPECT_LE(error.change, 0.02);
	const RegionError denser = wholeSurfaceError(pair, 1, { 2 * error.samples, 4 * error.samples, 0 }, progress);
	EXPECT_LE(relativeChange(error.px, denser.px), 0.04);
	// A reference mesh of four times the triangles as starting points changes nothing that counts.
	const ReferenceSurface finer(scene->host, view, 1'600'000);
	const SurfacePair finer_pair(scene->host, view, finer, *micro);
	const RegionError same = wholeSurfaceError(finer_pair, 1, { error.samples / 2, error.samples, 0 }, progress);
	EXPECT_LE(relativeChange(error.px, same.px), 0.01);
}

TEST(numerics, theSurfacesOfTheTestScenesAreFiniteClosedAndWithinTheirBounds)
{
	for (const NamedScene& named : allScenes())
	{
		const ReferenceScene scene(named.scene);
		const Camera camera = framingCamera(scene.built);
		ViewRequest request = { 320, 240 };
		request.rate_px = 6;
		const View view = viewOf(scene, camera, request);
		const Result<MicroScene> micro = tessellate(scene.host, view, 8);
		const Numerics numerics = measureNumerics(scene.host, view, *micro);
		EXPECT_EQ(numerics.not_finite, 0u) << named.name;
		EXPECT_EQ(numerics.differing_edges, 0u) << named.name << " " << numerics.first_problem;
		EXPECT_GT(numerics.vertices, 0u) << named.name;
		EXPECT_LE(numerics.worst_share_of_bound, 1) << named.name;
		EXPECT_LE(numerics.worst_base_ulp, 1.6) << named.name;
		EXPECT_EQ(micro->triangleCount(), micro->pieces.microTriangles()) << named.name;
	}
}

// --- pictures --------------------------------------------------------------------------------------------------------------------

TEST(imageError, equalPicturesAreEqual)
{
	const Picture picture = pictureOf(200, 180, [](uint32_t x, uint32_t y) { return uint8_t(x * 7 + y * 3); });
	const ImageError error = compareImages(picture, picture);
	EXPECT_FALSE(error.psnr_db.has_value());
	EXPECT_NEAR(error.ssim, 1, 1e-12);
	EXPECT_NEAR(error.ms_ssim.value(), 1, 1e-12);
	EXPECT_EQ(error.differing_pixels, 0u);
}

TEST(imageError, constantPicturesFollowTheFormulas)
{
	const Picture a = pictureOf(64, 48, [](uint32_t, uint32_t) { return uint8_t(100); });
	const Picture b = pictureOf(64, 48, [](uint32_t, uint32_t) { return uint8_t(110); });
	const ImageError error = compareImages(a, b);
	EXPECT_NEAR(error.psnr_db.value(), 20 * std::log10(255.0 / 10), 1e-9);
	const double c1 = 2.55 * 2.55;
	EXPECT_NEAR(error.ssim, (2 * 100.0 * 110 + c1) / (100.0 * 100 + 110.0 * 110 + c1), 1e-9);
	EXPECT_FALSE(error.ms_ssim.has_value());
	EXPECT_EQ(error.differing_pixels, 64u * 48);
}

TEST(imageError, weakerContrastFollowsTheFormula)
{
	// A checkerboard of single pixels: the window sees mean 128 and all of the variance.
	const auto board = [](int contrast) {
		return pictureOf(32, 32, [contrast](uint32_t x, uint32_t y) { return uint8_t(128 + ((x + y) % 2 ? contrast : -contrast)); });
	};
	const double c2 = 7.65 * 7.65;
	EXPECT_NEAR(compareImages(board(40), board(20)).ssim, (2 * 40.0 * 20 + c2) / (40.0 * 40 + 20.0 * 20 + c2), 2e-3);
	EXPECT_NEAR(compareImages(board(40), board(-40)).ssim, (-2 * 40.0 * 40 + c2) / (2 * 40.0 * 40 + c2), 2e-3);
}

TEST(imageError, silhouettesAreThePixelsThatOnlyOneOfThemCovers)
{
	Picture a = pictureOf(16, 16, [](uint32_t, uint32_t) { return uint8_t(0); });
	Picture b = a;
	a.covered.assign(256, false);
	b.covered.assign(256, false);
	for (size_t i = 10; i < 20; ++i)
		a.covered[i] = true;
	for (size_t i = 13; i < 25; ++i)
		b.covered[i] = true;
	const ImageError error = compareImages(a, b);
	EXPECT_EQ(error.silhouette_pixels, 8u);
	EXPECT_EQ(error.covered_pixels, 12u);
}

}  // namespace tessera::test
