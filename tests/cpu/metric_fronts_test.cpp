// Metrics at equal error: the arithmetic of comparing fronts, and that `detail` is never worse than `edge` on any built-in scene.
#include "reference_test_scenes.h"

#include "report/metric_fronts.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tessera::test
{

namespace
{

using namespace report;

constexpr uint32_t kWidth = 240, kHeight = 135;

report::Run runWith(const char* metric, double error_px, double ms, uint64_t triangles)
{
	report::Run run;
	run.setting.rate = 1;
	run.setting.raster = "soft";
	run.setting.metric = metric;
	run.setting.width = kWidth;
	run.setting.height = kHeight;
	run.gpu_ms = timeFigures({ ms });
	run.counts.micro_triangles = triangles;
	run.surface.emplace();
	run.surface->visible.samples = 1;
	run.surface->visible.px = { 2 * error_px, error_px, error_px };
	run.surface->whole.px = { 2 * error_px, error_px, error_px };
	return run;
}

// The scene at a rate by a metric, at a small picture from its own camera; errors by so many samples.
report::Run measured(const ReferenceScene& scene, Metric metric, double rate_px)
{
	ViewRequest request = { kWidth, kHeight };
	request.rate_px = rate_px;
	request.metric = metric;
	const View view = viewOf(scene, cameraOf(scene.built.cameras.at(0), scene.built), request);
	const Result<MicroScene> micro = tessellate(scene.host, view, 8);
	const ReferenceSurface surface(scene.host, view, 300'000);
	const SurfacePair pair(scene.host, view, surface, *micro);
	Progress progress(false);
	constexpr SamplingLimits kSamples = { 1 << 15, 1 << 15, 0.01 };
	report::Run run = runWith(metricName(metric).data(), 1, 1, micro->triangleCount());
	run.setting.rate = rate_px;
	run.surface->visible = visibleError(pair, 1, kSamples, progress);
	run.surface->whole = wholeSurfaceError(pair, 1, kSamples, progress);
	return run;
}

}  // namespace

TEST(metricFronts, costsAreInterpolatedAsPowersOfTheErrorAlongTheFront)
{
	const report::Run runs[] = { runWith("edge", 4, 1, 100), runWith("edge", 1, 4, 1600), runWith("edge", 2, 9, 9000) };
	const report::Run* pointers[] = { &runs[0], &runs[1], &runs[2] };
	// The third is beaten. Time goes with 1 / error, triangles with 1 / error^2.
	EXPECT_NEAR(*costAt(pointers, ErrorKind::SeenP99, Cost::Time, 2), 2, 1e-9);
	EXPECT_NEAR(*costAt(pointers, ErrorKind::SeenP99, Cost::Triangles, 2), 400, 1e-6);
	EXPECT_FALSE(costAt(pointers, ErrorKind::SeenP99, Cost::Time, 5));
	EXPECT_FALSE(costAt(pointers, ErrorKind::SeenP99, Cost::Time, 0.5));
}

TEST(metricFronts, metricsAreComparedWhereBothReach)
{
	// From 2 px down to 1 both reach: there detail takes a quarter of the triangles and twice the time.
	const report::Run runs[] = { runWith("edge", 4, 1, 100), runWith("edge", 1, 4, 1600), runWith("detail", 2, 4, 100),
								 runWith("detail", 0.5, 16, 1600) };
	const auto triangles = compareMetrics(runs, ErrorKind::SeenP99, Cost::Triangles);
	ASSERT_EQ(triangles.size(), 1u);
	EXPECT_NEAR(triangles[0].ratio, 0.25, 1e-9);
	EXPECT_NEAR(triangles[0].worst_ratio, 0.25, 1e-9);
	EXPECT_EQ(triangles[0].least_px, 1);
	EXPECT_EQ(triangles[0].most_px, 2);
	EXPECT_NEAR(compareMetrics(runs, ErrorKind::SeenP99, Cost::Time)[0].ratio, 2, 1e-9);
	EXPECT_NE(describe(triangles[0], ErrorKind::SeenP99).find("0.250 times the micro-triangles of edge"), std::string::npos);
	// Not where they do not, nor with a single metric.
	const report::Run apart[] = { runs[0], runs[1], runWith("detail", 0.5, 1, 1), runWith("detail", 0.1, 2, 2) };
	EXPECT_TRUE(compareMetrics(apart, ErrorKind::SeenP99, Cost::Time).empty());
	EXPECT_TRUE(compareMetrics(std::span(runs, 2), ErrorKind::SeenP99, Cost::Time).empty());
}

class detailAgainstEdge : public testing::TestWithParam<const char*>
{
protected:
	static std::vector<report::Run> runsOf(Metric metric, std::initializer_list<double> rates)
	{
		BuildOptions options;
		options.tables = MetricTables::of(metric);
		const auto scene = builtinScene(GetParam(), options);
		std::vector<report::Run> runs;
		for (const double rate : rates)
			runs.push_back(measured(*scene, metric, rate));
		for (const report::Run& run : runs)
			fmt::print("{} rate {}: {} micro-triangles, 99th percentile {:.4f} px seen, {:.4f} of the whole surface\n", run.setting.metric,
					   run.setting.rate, run.counts.micro_triangles, run.surface->visible.px.p99, run.surface->whole.px.p99);
		return runs;
	}
};

// The 99th percentile of 32,768 samples is known to about 1 %, for either metric: errors that differ by no more than 2 % count as equal. (Where a
// height map has more in it than coarse rates show, errors hardly fall over a range of rates, and 1 % of error is many triangles.)
TEST_P(detailAgainstEdge, detailNeedsNoMoreTrianglesAtEqualError)
{
	constexpr double kEqual = 1.02;
	constexpr int kLevels = 65;
	std::vector<report::Run> runs = runsOf(Metric::Edge, { 16, 8, 4, 2, 1 });
	const size_t edge_count = runs.size();
	for (report::Run& run : runsOf(Metric::Detail, { 16, 8, 4, 2, 1, 0.5 }))
		runs.push_back(std::move(run));
	std::vector<const report::Run*> edge, detail;
	for (size_t i = 0; i < runs.size(); ++i)
		(i < edge_count ? edge : detail).push_back(&runs[i]);
	uint64_t fewest = UINT64_MAX;
	for (const report::Run* run : detail)
		fewest = std::min(fewest, run->counts.micro_triangles);
	for (const ErrorKind kind : { ErrorKind::SeenP99, ErrorKind::WholeP99 })
	{
		const auto comparisons = compareMetrics(runs, kind, Cost::Triangles);
		ASSERT_EQ(comparisons.size(), 1u) << "no errors in common";
		const double least = comparisons[0].least_px, most = comparisons[0].most_px;
		double worst = 0;
		for (int level = 0; level < kLevels; ++level)
		{
			const double error = std::clamp(least * std::pow(most / least, double(level) / (kLevels - 1)), least, most);
			const auto edge_cost = costAt(edge, kind, Cost::Triangles, error);
			// Beyond its coarsest run that one will do.
			const double detail_cost = costAt(detail, kind, Cost::Triangles, error * kEqual).value_or(double(fewest));
			ASSERT_TRUE(edge_cost) << error;
			worst = std::max(worst, detail_cost / *edge_cost);
		}
		fmt::print("{} {} Within {} of the error at worst {:.3f} times.\n", GetParam(), describe(comparisons[0], kind), kEqual, worst);
		EXPECT_LE(comparisons[0].ratio, 1) << nameOf(kind);
		EXPECT_LE(worst, 1 + 1e-9) << nameOf(kind);
	}
}

INSTANTIATE_TEST_SUITE_P(builtIns, detailAgainstEdge,
						 testing::Values("planet", "showcase:12", "terrain", "bricks", "instances:12", "quad", "cube", "materials"),
						 [](const testing::TestParamInfo<const char*>& one) {
							 const std::string_view name = one.param;
							 return std::string(name.substr(0, name.find(':')));
						 });

}  // namespace tessera::test
