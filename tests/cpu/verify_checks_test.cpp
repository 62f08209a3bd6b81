// The checks of verify on micro-triangles of the CPU reference: they hold for every test scene, and each fails on data broken by hand.
#include "reference_test_scenes.h"

#include "verify/bounds_check.h"
#include "verify/cameras.h"
#include "verify/conservative_check.h"
#include "verify/fault.h"
#include "verify/finite_check.h"
#include "verify/holes_check.h"
#include "verify/leak_check.h"
#include "verify/overlay.h"
#include "verify/paths_check.h"
#include "verify/seam_jump.h"
#include "verify/usual_way.h"
#include "verify/watertight_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::test
{

namespace
{

using namespace verify;

// A scene, a view of it and what the reference draws.
struct Drawn
{
	std::unique_ptr<ReferenceScene> scene;
	View view;
	MicroSet set;

	Drawn(const ImportedScene& imported, double rate_px, double distance = 1) : scene(std::make_unique<ReferenceScene>(imported))
	{
		Camera camera = framingCamera(scene->built);
		camera.eye = camera.target + (camera.eye - camera.target) * distance;
		view = viewOf(*scene, camera, request(100, rate_px));
		set = referenceMicro(scene->host, view, classifyAll(*scene, view));
		sortMicro(set);
	}

	Screen screen() const { return { scene->host, view }; }
	CheckResult watertight() const { return checkWatertight(scene->host, set); }
	CheckResult holes() const { return checkHoles(scene->host, set); }
	CheckResult finite() const { return checkFinite(scene->host, view, screen(), set); }

	// A corner within a triangle's edge (not at its ends) of some micro-triangle, or inside the triangle.
	std::pair<size_t, uint32_t> corner(bool on_edge) const
	{
		for (size_t i = 0; i < set.size(); ++i)
			for (uint32_t c = 0; c < 3; ++c)
			{
				const DomainPoint p = set[i].domain[c];
				const int zeros = (p.u == 0) + (p.v == 0) + (domainW(p) == 0);
				if (zeros == (on_edge ? 1 : 0))
					return { i, c };
			}
		ADD_FAILURE() << "no such micro-vertex";
		return { 0, 0 };
	}
	vec3& positionOf(std::pair<size_t, uint32_t> at) { return set[at.first].displaced[at.second]; }
};

void nudge(vec3& p)
{
	p.x = std::nextafter(p.x, std::numeric_limits<float>::max());
}

// What a rasteriser without rounding would show; `off_px`: of one that has everything that much too far to the right.
VisiblePicture painted(const Drawn& drawn, double off_px = 0)
{
	VisiblePicture picture = { drawn.view.width_px, drawn.view.height_px, {} };
	picture.pixels.resize(size_t(picture.width_px) * picture.height_px);
	const Screen screen = drawn.screen();
	for (const MicroTriangle& t : drawn.set)
	{
		std::array<ScreenPoint, 3> p;
		if (!screen.project(t, p) || !screen.shows(t, p))
			continue;
		for (ScreenPoint& point : p)
			point.x += off_px;
		const PixelBox box = pixelBox(p, picture.width_px, picture.height_px);
		const double area = screenArea(p);
		for (uint32_t y = box.y0; y < box.y1; ++y)
			for (uint32_t x = box.x0; x < box.x1; ++x)
			{
				double least = 1, depth = 0;
				for (uint32_t c = 0; c < 3; ++c)
				{
					const ScreenPoint &a = p[(c + 1) % 3], &b = p[(c + 2) % 3];
					const double weight = ((b.x - a.x) * (y + 0.5 - a.y) - (b.y - a.y) * (x + 0.5 - a.x)) / area;
					least = std::min(least, weight);
					depth += weight * p[c].depth;
				}
				VisiblePixel& pixel = picture.pixels[size_t(y) * picture.width_px + x];
				if (least >= 0 && float(depth) > pixel.depth)
					pixel = { float(depth), identityOf(t) };
			}
	}
	return picture;
}

// Everything that is drawn, as a frame's lists would say it.
DrawnThings everythingOf(const Drawn& drawn)
{
	DrawnThings things;
	for (const MicroTriangle& t : drawn.set)
	{
		Identity part = identityOf(t);
		part.words[9] = 0;
		things.parts.push_back(part);
	}
	std::sort(things.parts.begin(), things.parts.end());
	things.parts.erase(std::unique(things.parts.begin(), things.parts.end()), things.parts.end());
	return things;
}

}  // namespace

TEST(verifyChecks, holdForEveryTestSceneNearAndFar)
{
	for (const NamedScene& named : allScenes())
		for (const double distance : { 0.4, 1.0, 6.0 })
		{
			const Drawn drawn(named.scene, 6, distance);
			ASSERT_FALSE(drawn.set.empty()) << named.name;
			const CheckResult watertight = drawn.watertight(), holes = drawn.holes(), finite = drawn.finite();
			EXPECT_EQ(watertight.violations, 0u) << named.name << ": " << describe(watertight.place);
			EXPECT_EQ(holes.violations, 0u) << named.name << ": " << describe(holes.place);
			EXPECT_EQ(finite.violations, 0u) << named.name << ": " << describe(finite.place);
			EXPECT_GT(watertight.sums.at("edge points compared") + watertight.sums.count("boundary edges"), 0u) << named.name;
		}
}

TEST(verifyChecks, aVertexOneBitOffOnAnEdgeIsACrack)
{
	Drawn drawn(cubeScene(2), 4);
	const auto at = drawn.corner(true);
	const DomainPoint moved = drawn.set[at.first].domain[at.second];
	// All micro-triangles of this base triangle agree: only the neighbour does not.
	for (MicroTriangle& t : drawn.set)
		for (uint32_t c = 0; c < 3; ++c)
			if (t.cluster.cluster == drawn.set[at.first].cluster.cluster && t.triangle == drawn.set[at.first].triangle && t.domain[c].u == moved.u &&
				t.domain[c].v == moved.v)
				nudge(t.displaced[c]);
	const CheckResult result = drawn.watertight();
	EXPECT_EQ(result.violations, 1u);
	EXPECT_GT(result.worst, 0);
	EXPECT_EQ(result.place.point.u, moved.u);
	EXPECT_EQ(drawn.holes().violations, 0u);
}

TEST(verifyChecks, anInnerVertexWithTwoPositionsIsACrack)
{
	Drawn drawn(cubeScene(1), 4);
	nudge(drawn.positionOf(drawn.corner(false)));
	EXPECT_GE(drawn.watertight().violations, 1u);
}

TEST(verifyChecks, anOpenSurfaceOfAClosedInputIsNotWatertight)
{
	Drawn drawn(cubeScene(1), 8);
	drawn.set.erase(drawn.set.begin(), drawn.set.begin() + std::ptrdiff_t(baseTriangles(drawn.set)[0].size()));
	const CheckResult result = drawn.watertight();
	EXPECT_GE(result.violations, 2u);  // vector area and Euler characteristic
	EXPECT_NE(describe(result.place), "");
}

TEST(verifyChecks, everyKindOfHoleIsSeen)
{
	const Drawn sound(cubeScene(2), 4);
	ASSERT_EQ(sound.holes().violations, 0u);
	const size_t middle = sound.set.size() / 2;
	const auto broken = [&](const auto& breakIt) {
		Drawn drawn(cubeScene(2), 4);
		breakIt(drawn.set);
		sortMicro(drawn.set);
		return drawn.holes();
	};
	const CheckResult missing = broken([&](MicroSet& set) { set.erase(set.begin() + std::ptrdiff_t(middle)); });
	EXPECT_GE(missing.violations, 2u);
	EXPECT_EQ(missing.place.cluster.cluster, sound.set[middle].cluster.cluster);
	EXPECT_EQ(missing.place.triangle, sound.set[middle].triangle);
	EXPECT_GE(broken([&](MicroSet& set) { set.push_back(set[middle]); }).violations, 2u) << "drawn twice";
	EXPECT_GE(broken([&](MicroSet& set) { std::swap(set[middle].domain[0], set[middle].domain[1]); }).violations, 2u) << "turned over";
	EXPECT_GE(broken([&](MicroSet& set) { ++set[middle].domain[1].u; }).violations, 1u) << "a T-junction one unit wide";
	EXPECT_GE(broken([&](MicroSet& set) { set[middle].domain[1] = kNoPoint; }).violations, 1u) << "a corner of another triangle";
	const CheckResult lost = broken([&](MicroSet& set) { set.erase(set.begin(), set.begin() + std::ptrdiff_t(baseTriangles(set)[0].size())); });
	EXPECT_EQ(lost.violations, 1u);
	EXPECT_NE(lost.place.what.find("not drawn"), std::string::npos);
}

TEST(verifyChecks, whatIsNotANumberOrNotRightIsSeen)
{
	for (const float bad : { std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity() })
	{
		Drawn drawn(cubeScene(1), 8);
		drawn.set[3].displaced[1].y = bad;
		EXPECT_EQ(drawn.finite().violations, 1u) << bad;
		EXPECT_NE(drawn.finite().place.what.find("not finite"), std::string::npos);
	}
	Drawn drawn(cubeScene(1), 8);
	drawn.set[3].displaced[1].y += 1e-4f;
	EXPECT_EQ(drawn.finite().violations, 1u);
	EXPECT_NEAR(drawn.finite().worst, 1e-4, 1e-5);
}

TEST(verifyChecks, setsThatDifferAreToldApartBitByBit)
{
	const Drawn drawn(cubeScene(1), 8);
	EXPECT_EQ(compareMicro(drawn.set, drawn.set, "itself").violations, 0u);
	MicroSet other = drawn.set;
	nudge(other[7].displaced[2]);
	sortMicro(other);
	const CheckResult moved = compareMicro(drawn.set, other, "the first");
	EXPECT_EQ(moved.violations, 1u);
	EXPECT_GT(moved.worst, 0);
	other = drawn.set;
	other.pop_back();
	EXPECT_EQ(compareMicro(drawn.set, other, "the first").violations, 1u);
	EXPECT_EQ(compareMicro(other, drawn.set, "the first").violations, 1u);
}

TEST(verifyChecks, aPixelOfBackgroundWithinTheSilhouetteIsALeak)
{
	const Drawn drawn(sphereScene(8, 12, TexelFormat::U8, Wrap::Repeat), 3);
	VisiblePicture picture = painted(drawn);
	const CheckResult sound = Silhouette(drawn.screen(), drawn.set).leaks(picture);
	EXPECT_EQ(sound.violations, 0u) << describe(sound.place);
	EXPECT_GT(sound.sums.at("pixels within the silhouette"), 500u);
	size_t inside = 0;
	while (!picture.pixels[inside + picture.width_px / 2 + picture.width_px * (picture.height_px / 2)].covered())
		++inside;
	picture.pixels[inside + picture.width_px / 2 + picture.width_px * (picture.height_px / 2)] = {};
	EXPECT_EQ(Silhouette(drawn.screen(), drawn.set).leaks(picture).violations, 1u);
}

TEST(verifyChecks, cullingWhatIsSeenIsNotConservative)
{
	const Drawn drawn(sphereScene(8, 12, TexelFormat::U8, Wrap::Repeat), 3);
	const VisiblePicture picture = painted(drawn);
	const DrawnThings everything = everythingOf(drawn);
	const CheckResult sound = checkConservative(drawn.screen(), drawn.set, picture, everything, picture);
	EXPECT_EQ(sound.violations, 0u) << describe(sound.place);
	EXPECT_EQ(sound.sums.count("culled micro-triangles"), 0u);

	// A part that is seen is left out: found even if the picture with culling were the same.
	const size_t centre = picture.width_px / 2 + picture.width_px * (picture.height_px / 2);
	Identity seen = picture.pixels[centre].identity;
	seen.words[9] = 0;
	DrawnThings fewer = everything;
	std::erase(fewer.parts, seen);
	ASSERT_EQ(fewer.parts.size() + 1, everything.parts.size());
	EXPECT_GT(checkConservative(drawn.screen(), drawn.set, picture, fewer, picture).violations, 0u);

	// Everything that is not seen may go.
	DrawnThings only_seen;
	for (const VisiblePixel& pixel : picture.pixels)
		if (pixel.covered())
		{
			only_seen.parts.push_back(pixel.identity);
			only_seen.parts.back().words[9] = 0;
		}
	sortDrawn(only_seen);
	const CheckResult bare = checkConservative(drawn.screen(), drawn.set, picture, only_seen, picture);
	EXPECT_EQ(bare.violations, 0u) << describe(bare.place);
	EXPECT_GT(bare.sums.at("culled micro-triangles"), 0u);
}

TEST(verifyChecks, otherIdentitiesAreViolationsAndTiesAreCounted)
{
	const Drawn drawn(cubeScene(1), 8);
	const VisiblePicture picture = painted(drawn);
	const size_t centre = picture.width_px / 2 + picture.width_px * (picture.height_px / 2);
	VisiblePicture other = picture;
	++other.pixels[centre].identity.words[2];
	EXPECT_EQ(comparePictures(picture, other, "again").violations, 0u);
	EXPECT_EQ(comparePictures(picture, other, "again").sums.at("ties"), 1u);
	other.pixels[centre].depth *= 1.5f;
	EXPECT_EQ(comparePictures(picture, other, "again").violations, 1u);
	EXPECT_EQ(comparePictures(picture, other, "again", 0.6).violations, 0u);
	other.pixels[centre] = {};
	EXPECT_EQ(comparePictures(picture, other, "again").violations, 1u);
}

TEST(verifyChecks, pathsMayDifferAtTheEdgesOfMicroTrianglesOnly)
{
	const Drawn drawn(cubeScene(2), 4);
	const VisiblePicture exact = painted(drawn);
	EXPECT_EQ(checkPaths(drawn.screen(), drawn.set, exact, exact, "").sums.count("pixels that differ"), 0u);
	const CheckResult rounded = checkPaths(drawn.screen(), drawn.set, exact, painted(drawn, 1.0 / 300), "");
	EXPECT_EQ(rounded.violations, 0u) << describe(rounded.place);
	EXPECT_GT(rounded.sums.at("pixels that differ"), 0u);
	EXPECT_GT(checkPaths(drawn.screen(), drawn.set, exact, painted(drawn, 1.0 / 16), "").violations, 0u);
}

TEST(verifyChecks, aPixelThatAnotherPathSeesOtherwiseIsFound)
{
	const Drawn drawn(cubeScene(2), 40);
	const VisiblePicture exact = painted(drawn);
	const size_t middle = exact.pixels.size() / 2 + exact.width_px / 2;
	ASSERT_TRUE(exact.pixels[middle].covered());
	VisiblePicture holed = exact, wrong = exact;
	holed.pixels[middle] = {};
	const auto other = std::find_if(exact.pixels.begin(), exact.pixels.end(), [&](const VisiblePixel& pixel) {
		return pixel.covered() && pixel.identity.triangle() != exact.pixels[middle].identity.triangle();
	});
	ASSERT_NE(other, exact.pixels.end());
	wrong.pixels[middle] = *other;
	EXPECT_EQ(checkPaths(drawn.screen(), drawn.set, exact, holed, "").violations, 1u);
	EXPECT_EQ(checkPaths(drawn.screen(), drawn.set, holed, exact, "").violations, 1u);
	EXPECT_EQ(checkPaths(drawn.screen(), drawn.set, exact, wrong, "").violations, 1u);
}

// Two planes that are seen at a flat angle and cross: which is nearer cannot be told within a pixel of that line, where positions are rounded.
TEST(verifyChecks, surfacesAtAFlatAngleMayDifferWhereTheyCrossAndNowhereElse)
{
	const Drawn drawn(cubeScene(1), 8);
	const View& view = drawn.view;
	const dvec3 eye = dvec3(view.eye_high) + dvec3(view.eye_low);
	const dvec3 right(view.right), up(view.up), forward(view.forward);
	ASSERT_EQ(drawn.scene->built.instances[0].world, dmat4(1));
	// At distance 1, so many times as deep as high; the line where they cross is 5 px above the middle.
	const double px = 1 / (double(view.focal_y) * view.height_px / 2), cross = 5 * px;
	const auto plane = [&](const MicroTriangle& like, double slope) {
		MicroTriangle t = like;
		const std::array<dvec2, 3> corners = { dvec2(-80 * px, 0), dvec2(80 * px, 0), dvec2(0, 60 * px) };
		for (uint32_t c = 0; c < 3; ++c)
			t.displaced[c] = vec3(eye + right * corners[c].x + up * corners[c].y + forward * (1 + 30 * cross + slope * (corners[c].y - cross)));
		return t;
	};
	MicroSet set = { plane(drawn.set[0], 30), plane(drawn.set[1], 30.2) };
	const Screen screen = drawn.screen();
	const auto seeing = [&](const MicroTriangle& t) {
		VisiblePicture picture = { view.width_px, view.height_px, {} };
		picture.pixels.assign(size_t(view.width_px) * view.height_px, { 0.5f, identityOf(t) });
		return picture;
	};
	// Where the line lies on screen: the plane's height there over its depth.
	const double line_px = view.height_px / 2.0 - cross / (1 + 30 * cross) / px;
	VisiblePicture near_line = seeing(set[0]), off_line = seeing(set[0]);
	const auto at = [&](double y_px) {
		return size_t(y_px) * view.width_px + view.width_px / 2;
	};
	near_line.pixels[at(line_px)] = off_line.pixels[at(line_px + 1.7)] = seeing(set[1]).pixels[0];
	EXPECT_EQ(checkPaths(screen, set, seeing(set[0]), near_line, "").violations, 0u);
	EXPECT_EQ(checkPaths(screen, set, seeing(set[0]), off_line, "").violations, 1u);
}

TEST(verifyChecks, aVertexOutsideItsBoundsIsNotConservative)
{
	Drawn drawn(coarseSphereScene(), 4);
	const CheckResult sound = checkBounds(drawn.scene->host, drawn.view, drawn.set);
	EXPECT_EQ(sound.violations, 0u) << describe(sound.place);
	EXPECT_GE(sound.largest.at("bound over reach of a cluster"), 1);
	drawn.set[5].displaced[0] *= 100.0f;
	EXPECT_GE(checkBounds(drawn.scene->host, drawn.view, drawn.set).violations, 1u);
}

TEST(verifyChecks, theUsualWayCracksWhereThisOneDoesNot)
{
	const Drawn cube(cubeScene(2), 6);
	ASSERT_EQ(cube.watertight().violations, 0u);
	const UsualWay usual = measureUsualWay(cube.scene->host, cube.view, cube.set);
	EXPECT_GT(usual.own_sides, 0u);
	EXPECT_GT(usual.own_sides_gap, 1e-3) << "hard edges come apart by about the displacement";
	EXPECT_GE(usual.barycentrics, usual.own_sides);
	// One plane without displacement: only barycentrics can crack it.
	const Drawn flat(triangleScene({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } }), 6);
	EXPECT_EQ(measureUsualWay(flat.scene->host, flat.view, flat.set).own_sides, 0u);
}

TEST(verifyChecks, violationsAreMarkedInThePicture)
{
	const Drawn drawn(cubeScene(1), 8);
	const VisiblePicture picture = painted(drawn);
	const std::vector<uint8_t> colors(picture.pixels.size() * 4, 200);
	const size_t centre = picture.width_px / 2 + picture.width_px * (picture.height_px / 2);
	const Identity& seen = picture.pixels[centre].identity;
	CheckResult marks;
	marks.violation(1, { seen.cluster(), seen.triangle(), kNoPoint, "wrong", {} });
	marks.violation(1, nowhere("a leak", 3));
	const std::vector<uint8_t> painted_over = paintViolations(picture, colors, marks);
	EXPECT_GT(painted_over[4 * centre], 200) << "red";
	EXPECT_LT(painted_over[4 * centre + 1], 100);
	EXPECT_EQ(painted_over[4 * 3 + 2], 255) << "magenta";
	EXPECT_EQ(painted_over[4 * 4], painted_over[4 * 4 + 1]) << "grey elsewhere";
}

TEST(verifyChecks, seamJumpsAreMeasuredWhereMapsDifferAndAreZeroWhereTheyAgree)
{
	const Drawn two_maps(twoMapsScene(), 6);
	const SeamJump jump = measureSeams(two_maps.scene->host, two_maps.view, two_maps.screen(), two_maps.set);
	EXPECT_GT(jump.points, 0u);
	EXPECT_GT(jump.largest_mesh, 0);
	EXPECT_GE(jump.largest_mesh, jump.meanMesh());
	const Drawn plain(triangleScene({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }), 6);
	EXPECT_EQ(measureSeams(plain.scene->host, plain.view, plain.screen(), plain.set).points, 0u);
}

TEST(verifyFaults, changeTheSceneInOnePlaceAndTheSameWayForTheSameSeed)
{
	const ReferenceScene scene(sphereScene(16, 24, TexelFormat::U8, Wrap::Repeat), defaultTable(), { 32, 32 });
	for (const Fault fault : { Fault::Crack, Fault::Drop, Fault::Nan, Fault::Tie })
	{
		const auto a = withFault(scene.built, fault, 3), b = withFault(scene.built, fault, 3), c = withFault(scene.built, fault, 4);
		ASSERT_TRUE(a && b && c);
		EXPECT_EQ(a->what, b->what);
		EXPECT_NE(a->what, c->what);
		const auto differs = [](const std::vector<vec3>& x, const std::vector<vec3>& y) {
			return std::memcmp(x.data(), y.data(), x.size() * sizeof(vec3)) != 0;
		};
		const bool changed =
			differs(a->scene.positions, scene.built.positions) || differs(a->scene.normals, scene.built.normals) ||
			(!scene.built.directions.empty() && differs(a->scene.directions, scene.built.directions)) ||
			std::memcmp(a->scene.clusters.data(), scene.built.clusters.data(), scene.built.clusters.size() * sizeof(ClusterRecord)) != 0;
		EXPECT_TRUE(changed) << a->what;
	}
}

TEST(verifyCameras, spanAViewAndAreTheSameForTheSameSeed)
{
	const auto scene = builtinScene("cube");
	const auto cameras = randomCameras(scene->built, 7, 24), again = randomCameras(scene->built, 7, 24);
	ASSERT_EQ(cameras.size(), 24u);
	for (size_t i = 0; i < cameras.size(); ++i)
	{
		EXPECT_EQ(cameras[i].camera, again[i].camera);
		EXPECT_TRUE(makeView(cameras[i].camera, scene->built, request(100, 4)).has_value()) << cameras[i].name;
	}
	EXPECT_FALSE(cameras[1].camera == randomCameras(scene->built, 8, 24)[1].camera);
}

}  // namespace tessera::test
