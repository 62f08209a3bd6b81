// Charts as SVG, readable on light and dark ground, with a title to hover on every mark.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tessera::report
{

inline constexpr size_t kChartColors = 8;

struct ChartPoint
{
	double x = 0, y = 0;
	std::string hint;     // shown on hovering
	bool strong = false;  // drawn full; others are drawn hollow
};

struct ChartSeries
{
	std::string name;
	size_t color = 0;                // below kChartColors
	std::vector<ChartPoint> points;  // joined in this order
	bool joined = true;
};

// A dashed line across the chart.
struct ChartLevel
{
	double y = 0;
	std::string name;
	bool at_right = false;  // where its name stands; else at the left
};

// A point cloud or curves over logarithmic axes. Values that are not above 0 are drawn at the axis' end.
struct LineChart
{
	std::string title, x_label, y_label;
	std::vector<ChartSeries> series;
	std::vector<ChartPoint> front;  // a line behind the points; may be empty
	std::string front_name;
	std::vector<ChartLevel> levels;
};

struct BarSegment
{
	size_t color = 0;
	double value = 0;  // >= 0
	std::string hint;
};
struct Bar
{
	std::string label;
	std::vector<BarSegment> segments;
	std::string end_label;
};
struct BarChart
{
	std::string title, x_label;
	std::vector<std::string> names;  // of the colours
	std::vector<Bar> bars;
};

// The <svg> element. Its classes are styled by chartStyle(), which a page needs once and a file of its own in every chart.
std::string chartSvg(const LineChart& chart);
std::string chartSvg(const BarChart& chart);
std::string chartStyle();
std::string standaloneSvg(const std::string& svg);

// & < > " for HTML and SVG.
std::string escaped(std::string_view text);

}  // namespace tessera::report
