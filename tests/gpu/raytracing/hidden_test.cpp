// What something hides gets coarser over frames where only rays of light meet it (--ray-hidden): what is seen stays as it is in every frame, factors
// are the reference's, counts follow the camera, and its shadow hardly moves.
#include "gpu/visibility.h"
#include "ray_test.h"

#include "pipeline/passes.h"
#include "reference/watertight.h"

#include <glm/gtc/matrix_transform.hpp>

namespace tessera::test
{

namespace
{

using hidden = RayTest;

const dvec3 kSun(0.4867, 0.6489, 0.5849);  // shaders/lib/lighting.glsl
// Level, along the sun's direction and across it: shadows fall sideways, and that of the wall is a line.
const dvec3 kSide = glm::normalize(dvec3(kSun.x, 0, kSun.z));
const dvec3 kAhead(kSide.z, 0, -kSide.x);
const dvec3 kUp(0, 1, 0);
constexpr uint32_t kBall = 0;
constexpr double kBallHeight = 2;
// Some frames of growing: a quarter of the way, where a falloff of 16 is felt as one of 4 at its end.
constexpr uint32_t kLongFrames = HIDDEN_WAIT_FRAMES + uint32_t(0.25f / HIDDEN_STEP);
constexpr float kSteepFalloff = 16;

void addSquare(ImportedScene& scene, dvec3 middle, dvec3 half_right, dvec3 half_up)
{
	Primitive square;
	square.material = addPlain(scene, "plain");
	scene.materials.back().double_sided = true;
	for (const dvec3& corner : { -half_right - half_up, half_right - half_up, half_right + half_up, -half_right + half_up })
		addVertex(square, vec3(middle + corner), vec3(glm::normalize(glm::cross(half_right, half_up))), vec2(0));
	addTriangle(square, 0, 1, 2);
	addTriangle(square, 0, 2, 3);
	addPlacedMesh(scene, { square });
}

enum class Floor : bool
{
	No,
	Yes,
};

// A bumpy ball behind a wall that covers it, seen from besideBy(0); on the floor the ball's shadow lies beside the wall.
ImportedScene wallScene(Floor floor = Floor::No)
{
	ImportedScene scene = sphereScene(6, 12, TexelFormat::U8, Wrap::Repeat);
	scene.instances[kBall].world = glm::scale(glm::translate(dmat4(1), kAhead * 4.0 + kUp * 2.0), dvec3(2));
	addSquare(scene, kAhead * -2.0 + kUp * 2.0, kSide * 3.3, kUp * 3.0);
	if (floor == Floor::Yes)
		addSquare(scene, kAhead * 4.0 + kUp * -4.5 + kSide * -9.0, kSide * 2.0, kAhead * 3.0);
	return scene;
}

// Moved sideways by that much. At 0 the ball is hidden, at kSeenFrom all of it is seen.
Camera besideBy(double distance)
{
	const dvec3 eye = kAhead * -6.0 + kUp * 2.0 + kSide * distance;
	return squareCamera(eye, eye + kAhead);
}
constexpr double kSeenFrom = 7.5;
constexpr uint32_t kLargeWidth_px = 240;

RenderOptions lit(bool hides, float ray_falloff = kSteepFalloff)
{
	RenderOptions options = rayOptions(1, Raster::Soft);
	options.width_px = 160;
	options.height_px = 90;
	options.shadows = true;
	options.ray_falloff = ray_falloff;
	options.ray_hidden = hides;
	return options;
}

// A renderer that has drawn nothing yet, and lets itself be asked who is seen.
GpuFrame begun(const GpuScene& scene, const RenderOptions& options)
{
	static constexpr std::string_view kMore[] = { "kept_visibility" };
	GpuFrame frame = { scene, nullptr, {}, {}, {}, {}, {} };
	auto renderer = Renderer::create(gpu(), scene.built, scene.table, framePasses(), options, kMore);
	EXPECT_TRUE(renderer) << (renderer ? "" : renderer.error().message);
	frame.renderer = std::move(*renderer);
	return frame;
}

uint64_t drawnCount(GpuFrame& frame, const Camera& camera)
{
	drawAgain(frame, camera);
	return frame.result.counts.micro_triangles;
}

// Until what is hidden is much coarser. Gives the last count.
uint64_t drawLong(GpuFrame& frame, const Camera& camera)
{
	uint64_t count = 0;
	for (uint32_t i = 0; i < kLongFrames; ++i)
		count = drawnCount(frame, camera);
	return count;
}

void expectSameSeen(const GpuFrame& whole, const GpuFrame& falling, const std::string& what)
{
	const VisibilityDifference difference = compareVisibility(visibilityOf(whole), visibilityOf(falling), 160);
	EXPECT_EQ(difference.others + difference.ties, 0u) << what << ": " << difference.first;
	EXPECT_GT(difference.covered, 1000u) << what;
}

}  // namespace

TEST_F(hidden, aBallBehindAWallGetsCoarserAndWhatIsSeenDoesNot)
{
	const GpuScene scene(wallScene());
	GpuFrame whole = begun(scene, lit(false)), falling = begun(scene, lit(true));
	const uint64_t all = drawnCount(whole, besideBy(0));
	uint64_t before = all;
	for (uint32_t i = 0; i < kLongFrames; ++i)
	{
		const uint64_t count = drawnCount(falling, besideBy(0));
		EXPECT_TRUE(i >= HIDDEN_WAIT_FRAMES || count == all) << i;
		EXPECT_LE(count, before) << i;
		before = count;
		EXPECT_EQ(falling.result.hidden_redraws, 0u) << i;
	}
	RecordProperty("counts", fmt::format("{} to {}", all, before));
	EXPECT_LT(before + 1000, all);
	EXPECT_EQ(falling.result.counts.hidden_instances, 1u);
	expectSameSeen(whole, falling, "at last");
}

TEST_F(hidden, factorsAreTheReferencesBitForBitAndNothingCracks)
{
	for (const Metric metric : { Metric::Edge, Metric::Detail })
	{
		BuildOptions build;
		build.tables = MetricTables::of(metric);
		// Such that the ball's triangles are split, hidden as they are.
		static const TessellationTable kTable = smallTable(2);
		GpuScene scene(wallScene(), kTable, build);
		RenderOptions options = lit(true);
		options.metric = metric;
		options.max_split = 2;
		GpuFrame frame = begun(scene, options);
		for (uint32_t i = 0; i < HIDDEN_WAIT_FRAMES + 3; ++i)
			drawAgain(frame, besideBy(0));
		const std::string what(metricName(metric));
		EXPECT_TRUE(std::ranges::any_of(frame.splits, [](const auto& split) { return split.cluster.instance == kBall; })) << what;
		EXPECT_NE(frame.result.counts.micro_triangles, frame.expected().microTriangles()) << what << ": without the offsets it must differ";
		const auto offsets = frame.read<HiddenInstance>("hidden_instances");
		ASSERT_EQ(offsets.size(), 2u);
		EXPECT_GT(offsets[kBall].distance_world, 0.4) << what;
		EXPECT_EQ(offsets[1].distance_world, 0) << what << ": the wall is seen";
		scene.host.setHidden(offsets);
		expectSameAsReference(frame, what);
		expectCovered(frame, what);
		std::vector<reference::ReferencePiece> parts = frame.parts;
		reference::sortPieces(parts);
		const reference::WatertightReport cracks = reference::checkWatertight(scene.host, frame.view(), frame.fullClusters(), parts);
		EXPECT_TRUE(cracks.holds()) << what << ": " << cracks.first_problem;
	}
}

// A frame that does not fit is coarsened with the same offsets.
TEST_F(hidden, aListThatIsTooSmallCoarsensToWhatTheReferenceMakesOfThatRate)
{
	GpuScene scene(wallScene());
	RenderOptions options = lit(true);
	GpuFrame roomy = begun(scene, options);
	drawLong(roomy, besideBy(0));
	options.capacities = { { "part_triangles", uint32_t(roomy.parts.size() * 2 / 3) } };
	GpuFrame tight = begun(scene, options);
	drawLong(tight, besideBy(0));
	EXPECT_GT(tight.result.rate_granted, tight.result.rate_wanted);
	EXPECT_EQ(tight.result.counts.hidden_instances, 1u);
	scene.host.setHidden(tight.read<HiddenInstance>("hidden_instances"));
	expectSameAsReference(tight, "two thirds of the parts");
}

TEST_F(hidden, aCameraThatSlidesSeesEverythingAsFineAsItIsAndNeverDrawsTwice)
{
	const GpuScene scene(wallScene());
	GpuFrame whole = begun(scene, lit(false, 4)), falling = begun(scene, lit(true, 4));
	drawLong(falling, besideBy(0));
	double before = 0, largest = 0, largest_step = 0;  // shares of all that are not there
	for (double distance = 0.25; distance <= kSeenFrom; distance += 0.25)
	{
		const uint64_t count = drawnCount(falling, besideBy(distance)), all = drawnCount(whole, besideBy(distance));
		const std::string what = fmt::format("{:.2f} beside", distance);
		EXPECT_EQ(falling.result.hidden_redraws, 0u) << what;
		expectSameSeen(whole, falling, what);
		ASSERT_LE(count, all) << what;
		const double missing = double(all - count) / double(all);
		largest_step = std::max(largest_step, before - missing);
		largest = std::max(largest, missing);
		before = missing;
	}
	RecordProperty("missing", fmt::format("{:.3f}, in steps of {:.3f}", largest, largest_step));
	EXPECT_EQ(before, 0) << "all is seen";
	EXPECT_GT(largest, 0.08);
	// A step is 1.7 pixels, of the 11 over which segments grow.
	EXPECT_LT(largest_step, largest / 2);
}

TEST_F(hidden, aCameraThatJumpsDrawsAgainAndSeesNothingCoarse)
{
	const GpuScene scene(wallScene());
	GpuFrame whole = begun(scene, lit(false)), falling = begun(scene, lit(true));
	drawLong(falling, besideBy(0));
	const uint64_t count = drawnCount(falling, besideBy(kSeenFrom)), all = drawnCount(whole, besideBy(kSeenFrom));
	EXPECT_EQ(falling.result.hidden_redraws, 1u);
	EXPECT_EQ(count, all);
	EXPECT_EQ(falling.result.counts.hidden_instances, 0u);
	expectSameSeen(whole, falling, "after the jump");
	EXPECT_EQ(drawnCount(falling, besideBy(kSeenFrom)), all);
	EXPECT_EQ(falling.result.hidden_redraws, 0u);
	// Back behind the wall it has to wait again.
	EXPECT_EQ(drawnCount(falling, besideBy(0)), drawnCount(whole, besideBy(0)));
}

// Away from all of it, nothing that may have been coarse is in the picture: no need to draw again.
TEST_F(hidden, aCameraThatTurnsRoundDrawsOnce)
{
	const GpuScene scene(wallScene());
	GpuFrame falling = begun(scene, lit(true));
	drawLong(falling, besideBy(0));
	Camera away = besideBy(0);
	away.target = away.eye - kAhead;
	drawAgain(falling, away);
	EXPECT_EQ(falling.result.hidden_redraws, 0u);
	EXPECT_EQ(falling.result.counts.hidden_instances, 1u);
	drawAgain(falling, away);
	EXPECT_EQ(falling.result.counts.hidden_instances, 0u) << "its being out of view is what counts now";
}

TEST_F(hidden, whatFlickersAtTheOccludersEdgeStaysFine)
{
	const GpuScene scene(wallScene());
	GpuFrame whole = begun(scene, lit(false)), falling = begun(scene, lit(true));
	for (uint32_t i = 0; i < 3 * HIDDEN_WAIT_FRAMES; ++i)
	{
		// Seen in every sixth frame.
		const Camera camera = besideBy(i % 6 ? 0 : kSeenFrom);
		const uint64_t count = drawnCount(falling, camera);
		EXPECT_TRUE(i > 6 || count == drawnCount(whole, camera)) << i;
		EXPECT_EQ(falling.result.counts.hidden_instances, 0u) << i;
		EXPECT_EQ(falling.result.hidden_redraws, 0u) << i;
	}
}

TEST_F(hidden, otherOptionsBeginAnew)
{
	const GpuScene scene(wallScene());
	GpuFrame falling = begun(scene, lit(true));
	const uint64_t all = drawnCount(falling, besideBy(0));
	EXPECT_LT(drawLong(falling, besideBy(0)), all);
	ASSERT_TRUE(falling.renderer->setOptions(lit(true)));
	EXPECT_EQ(drawnCount(falling, besideBy(0)), all);
}

// The viewer's debug camera shows what was made coarser: nothing is measured from there.
TEST_F(hidden, seenFromElsewhereItStaysAsItWas)
{
	const GpuScene scene(wallScene());
	GpuFrame falling = begun(scene, lit(true));
	const uint64_t coarse = drawLong(falling, besideBy(0));
	const std::vector<HiddenInstance> before = falling.read<HiddenInstance>("hidden_instances_next");
	ASSERT_EQ(before.size(), 2u);
	for (int i = 0; i < 2; ++i)
	{
		ASSERT_TRUE(falling.renderer->beginFrame({ besideBy(0), besideBy(kSeenFrom), {}, {} }));
		Result<std::optional<FrameResult>> result = std::optional<FrameResult>();
		while (result && !*result)
			result = falling.renderer->pollFrame();
		ASSERT_TRUE(result) << result.error().message;
		EXPECT_EQ((*result)->hidden_redraws, 0u);
		EXPECT_EQ((*result)->counts.hidden_instances, 0u) << "nobody counts";
		EXPECT_LT((*result)->counts.micro_triangles, coarse + 1) << i;
		EXPECT_GT((*result)->counts.micro_triangles, coarse / 2) << i;
		const std::vector<HiddenInstance> after = falling.read<HiddenInstance>("hidden_instances");
		ASSERT_EQ(after.size(), 2u);
		EXPECT_EQ(after[kBall].distance_world, before[kBall].distance_world);
	}
}

TEST_F(hidden, raysThatFindVisibilitySeeTheSame)
{
	const GpuScene scene(wallScene());
	RenderOptions with = lit(true), without = lit(false);
	with.raster = without.raster = Raster::Rt;
	GpuFrame whole = begun(scene, without), falling = begun(scene, with);
	EXPECT_GT(drawnCount(whole, besideBy(0)), drawLong(falling, besideBy(0)));
	expectSameSeen(whole, falling, "hidden");
	drawAgain(whole, besideBy(kSeenFrom));
	drawAgain(falling, besideBy(kSeenFrom));
	EXPECT_EQ(falling.result.hidden_redraws, 1u);
	expectSameSeen(whole, falling, "after a jump");
}

TEST_F(hidden, theShadowOfWhatIsHiddenHardlyMoves)
{
	const GpuScene scene(wallScene(Floor::Yes));
	RenderOptions unlit_options = lit(false), whole_options = lit(false), falling_options = lit(true);
	for (RenderOptions* options : { &unlit_options, &whole_options, &falling_options })
	{
		options->width_px = kLargeWidth_px;
		options->height_px = kLargeWidth_px * 9 / 16;
	}
	unlit_options.shadows = false;
	GpuFrame unlit = begun(scene, unlit_options), whole = begun(scene, whole_options), falling = begun(scene, falling_options);
	drawAgain(unlit, besideBy(0));
	const uint64_t all = drawnCount(whole, besideBy(0));
	EXPECT_LT(drawLong(falling, besideBy(0)) + 1000, all);
	const size_t dark = differingPixels(unlit.picture(), whole.picture(), 8), differing = differingPixels(whole.picture(), falling.picture(), 8);
	RecordProperty("pixels", fmt::format("{} dark, {} differ", dark, differing));
	EXPECT_GT(dark, 300u) << "no shadow falls into the picture";
	EXPECT_LT(differing, dark / 10);
}

}  // namespace tessera::test
