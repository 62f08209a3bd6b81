// verify on a device: every promise holds on small scenes, and every seeded fault is found by its check.
#include "gpu_test.h"

#include "cpu/program_run.h"
#include "verify/verify.h"

#include <nlohmann/json.hpp>

namespace tessera::test
{

namespace
{

using nlohmann::json;
using verify::Fault;
using verify::Report;
using verifyScene = GpuTest;

verify::Request requestFor(const GpuScene& scene, std::vector<float> rates, uint32_t random_cameras)
{
	verify::Request request;
	request.device = &gpu();
	request.scene = &scene.built;
	request.table = &scene.table;
	request.options.width_px = 120;
	request.options.height_px = 68;
	request.uncut_options = request.options;
	request.uncut_options.cull = { false, false, false };
	request.paths = rasterPaths();
	request.cameras = verify::randomCameras(scene.built, 5, random_cameras);
	request.cameras.push_back({ "own", scene.camera });
	request.rates = std::move(rates);
	return request;
}

Report runOrDie(const verify::Request& request)
{
	Result<Report> report = verify::run(request);
	EXPECT_TRUE(report.has_value()) << report.error().message;
	return report ? std::move(*report) : Report{};
}

void expectHolds(const Report& report, const std::string& what)
{
	for (const verify::NamedCheck& check : report.checks)
		EXPECT_EQ(check.result.violations, 0u) << what << ": " << check.name << ": " << describe(check.result.place);
}

uint64_t lookedAt(Report& report, std::string_view check, const std::string& what)
{
	const auto& sums = report.check(check).sums;
	const auto found = sums.find(what);
	return found == sums.end() ? 0 : found->second;
}

}  // namespace

TEST_F(verifyScene, everyPromiseHoldsFromEveryKindOfCamera)
{
	const auto scene = gpuScene("cube");
	verify::Request request = requestFor(*scene, { 5 }, 6);
	request.paths = everyPath();
	Report report = runOrDie(request);
	expectHolds(report, "cube");
	EXPECT_EQ(report.frames.size(), 7u);
	// Nothing was skipped.
	EXPECT_GT(lookedAt(report, verify::kWatertight, "edge points compared"), 1000u);
	EXPECT_GT(lookedAt(report, verify::kNoHoles, "base triangles"), 300u);
	EXPECT_GT(lookedAt(report, verify::kNoLeaks, "pixels within the silhouette"), 5000u);
	EXPECT_GT(lookedAt(report, verify::kConservative, "culled micro-triangles"), 1000u);
	EXPECT_EQ(lookedAt(report, verify::kDeterministic, "frames compared"), report.frames.size() * 4 * everyPath().size());
	EXPECT_EQ(lookedAt(report, verify::kFinite, "compared in double"), lookedAt(report, verify::kFinite, "micro-vertices"));
	EXPECT_GT(report.seams.points, 0u);
}

TEST_F(verifyScene, everyPromiseHoldsForMirroredInstancesAndUnevenMatrices)
{
	const GpuScene scene(unevenScene());
	verify::Request request = requestFor(scene, { 4 }, 2);
	request.paths.resize(1);
	expectHolds(runOrDie(request), "uneven");
}

TEST_F(verifyScene, everyPromiseHoldsOnNonManifoldAndDegenerateInputAndWithoutTessellation)
{
	std::vector<float> rates = { 6, 0 };
	for (const ImportedScene& imported : { nonManifoldScene(), degenerateScene(), soupScene(3, 40) })
	{
		const GpuScene scene(imported);
		verify::Request request = requestFor(scene, rates, 1);
		request.paths.resize(1);
		expectHolds(runOrDie(request), "odd input");
		rates.resize(1);
	}
}

TEST_F(verifyScene, everyPromiseHoldsForPnTrianglesOnSmoothAndHardEdgesDisplacedOrNot)
{
	ImportedScene copies = roundScene(2);
	for (int i = 1; i < 4; ++i)
	{
		copies.instances.push_back(copies.instances[0]);
		copies.instances.back().world[3] = dvec4(1.5 * i, 0.3 * i, -2.0 * i, 1);
	}
	for (const ImportedScene& imported : { copies, cubeScene(2), soupScene(3, 40) })
	{
		const GpuScene scene(imported, defaultTable(), { .cluster_triangles = 16, .pn = true });
		ASSERT_TRUE(scene.built.traits.has_pn);
		verify::Request request = requestFor(scene, { 4 }, 2);
		request.paths.resize(1);
		expectHolds(runOrDie(request), "PN triangles");
	}
}

TEST_F(verifyScene, coarsenedFramesAndRoundsAreVerifiedToo)
{
	const auto scene = gpuScene("instances:40");
	verify::Request request = requestFor(*scene, { 1 }, 0);
	request.paths.resize(1);
	for (RenderOptions* options : { &request.options, &request.uncut_options })
		options->capacities = { { "part_triangles", 150 }, { "visible_clusters", 128 } };
	Report report = runOrDie(request);
	expectHolds(report, "tight lists");
	EXPECT_GT(report.frames[0].rate_granted, report.frames[0].rate_wanted);
}

TEST_F(verifyScene, noBackgroundShinesThroughAClosedDisplacedMeshFromTwoHundredPlaces)
{
	const ProgramRun run = runTessera("verify builtin:cube --raster soft --size 64x36 --rate 8 --leaks 200 --quiet --json -");
	EXPECT_EQ(run.exit_code, 0) << run.errors;
	const json report = json::parse(run.output, nullptr, false);
	ASSERT_TRUE(report.is_object());
	const json& looked_at = report["checks"]["no_leaks"]["looked_at"];
	EXPECT_EQ(looked_at["views"], 200);
	EXPECT_GT(looked_at["pixels within the silhouette"], 50'000);
}

// --- faults ----------------------------------------------------------------------------------------------------------------------

namespace
{

struct FaultRun
{
	ProgramRun run;
	json report;
};

FaultRun inject(const std::string& fault)
{
	FaultRun result;
	result.run = runTessera("verify builtin:planet --raster soft --size 120x68 --rate 8 --cameras 1 --quiet -o marks.png --json - --inject " + fault);
	result.report = json::parse(result.run.output, nullptr, false);
	return result;
}

void expectFound(const std::string& fault, const std::string& check)
{
	const FaultRun found = inject(fault);
	EXPECT_EQ(found.run.exit_code, 6) << fault << "\n" << found.run.errors;
	EXPECT_NE(found.run.errors.find(check), std::string::npos) << found.run.errors;
	EXPECT_NE(found.run.errors.find("fault injected: " + fault), std::string::npos) << found.run.errors;
	ASSERT_TRUE(found.report.is_object());
	EXPECT_EQ(found.report["injected"]["fault"], fault);
	EXPECT_NE(found.report["injected"]["where"], "");
	EXPECT_TRUE(std::filesystem::exists(scratchFolder() / "marks.png"));
	const json& result = found.report["checks"][check];
	EXPECT_GT(result["violations"], 0) << fault;
	EXPECT_NE(result["worst"]["what"], "") << fault;
	EXPECT_NE(result["worst"]["frame"], "") << fault;
}

}  // namespace

TEST_F(verifyScene, aCrackIsFoundByWatertight)
{
	expectFound("crack", "watertight");
}

TEST_F(verifyScene, aDroppedTriangleIsFoundByNoHoles)
{
	expectFound("drop", "no_holes");
}

TEST_F(verifyScene, cullingWhatIsSeenIsFoundByConservative)
{
	expectFound("cull", "conservative");
}

TEST_F(verifyScene, whatIsNotANumberIsFoundByFiniteAndRight)
{
	expectFound("nan", "finite_and_right");
}

TEST_F(verifyScene, aDecisionByOrderIsFoundByDeterministic)
{
	expectFound("tie", "deterministic");
}

TEST_F(verifyScene, theProgramPrintsATableAndEndsWithZero)
{
	const ProgramRun run = runTessera("verify builtin:quad --size 96x64 --rates 8,0 --cameras 0 --raster soft --quiet");
	EXPECT_EQ(run.exit_code, 0) << run.errors;
	for (const char* check : { "watertight", "no_holes", "no_leaks", "conservative", "deterministic", "finite_and_right" })
		EXPECT_NE(run.output.find(check), std::string::npos) << check;
	EXPECT_EQ(run.output.find("FAULT"), std::string::npos);
	EXPECT_EQ(runTessera("verify builtin:quad -o marks.jpg --quiet").exit_code, 2);
	EXPECT_EQ(runTessera("verify --suite mild --quiet").exit_code, 2);
	EXPECT_EQ(runTessera("verify --suite extreme:no_such_case --quiet").exit_code, 2);
	EXPECT_EQ(runTessera("verify builtin:quad --suite extreme --quiet").exit_code, 2);
	EXPECT_EQ(runTessera("verify builtin:quad --inject crack --raster soft --quiet").exit_code, 3);
	EXPECT_EQ(runTessera("verify builtin:quad --inject sabotage --quiet").exit_code, 2);
}

TEST_F(verifyScene, theSuiteEndsWithSixWhenACaseDoesNotComeOutAsStated)
{
	const ProgramRun right = runTessera("verify --suite extreme-quick:picture_33x17 --raster soft --usual-way --quiet --json -");
	EXPECT_EQ(right.exit_code, 0) << right.errors;
	const json report = json::parse(right.output, nullptr, false);
	ASSERT_TRUE(report.is_object());
	EXPECT_EQ(report["cases"][0]["case"], "picture_33x17");
	EXPECT_EQ(report["cases"][0]["passed"], true);
	EXPECT_EQ(report["cases"][0]["violations"], 0);
	EXPECT_GT(report["cases"][0]["checks"], 0);

	const ProgramRun wrong = runTessera("verify --suite extreme-quick:picture_33x17 --raster soft --inject tie --quiet");
	EXPECT_EQ(wrong.exit_code, 6) << wrong.errors;
	EXPECT_NE(wrong.output.find("FAILED picture_33x17: deterministic"), std::string::npos) << wrong.output;
}

}  // namespace tessera::test
