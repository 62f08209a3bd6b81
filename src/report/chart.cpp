#include "report/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera::report
{

namespace
{

constexpr double kWidth = 720, kHeight = 400, kLeft = 78, kRight = 18, kTop = 62, kBottom = 48;
constexpr double kBarLeft = 170, kBarRight = 70, kBarStep = 24, kBarHeight = 16;

// A logarithmic axis from `from` to `to` in pixels.
struct LogAxis
{
	double low, high;  // powers of ten, log10
	double from, to;

	static LogAxis over(const std::vector<double>& values, double from, double to)
	{
		double least = 0, most = 0;
		for (const double v : values)
			if (v > 0 && std::isfinite(v))
			{
				least = least == 0 ? v : std::min(least, v);
				most = std::max(most, v);
			}
		if (least == 0)
			return { -1, 1, from, to };
		const double margin = std::max(0.04 * std::log10(most / least), 0.05);
		return { std::log10(least) - margin, std::log10(most) + margin, from, to };
	}

	double at(double value) const
	{
		const double place = value > 0 ? std::log10(value) : low;
		return from + (std::clamp(place, low, high) - low) / (high - low) * (to - from);
	}

	// About five round values.
	std::vector<double> evenTicks() const
	{
		const double least = std::pow(10, low), most = std::pow(10, high);
		const double power = std::pow(10, std::floor(std::log10((most - least) / 5)));
		const double steps = (most - least) / 5 / power;
		const double step = power * (steps > 7 ? 10 : steps > 3.5 ? 5 : steps > 1.5 ? 2 : 1);
		std::vector<double> ticks;
		for (double i = std::ceil(least / step); i * step <= most; ++i)
			ticks.push_back(i * step);
		return ticks;
	}

	// Powers of ten; also multiples of them where there is room, and every so many powers where there is little.
	std::vector<double> ticks() const
	{
		std::vector<double> ticks;
		const double decades = high - low;
		if (decades < 0.5)
			return evenTicks();
		const int step = std::max(1, static_cast<int>(decades / 7));
		for (int power = static_cast<int>(std::floor(low)); power <= std::ceil(high); ++power)
			for (const double factor : { 1.0, 1.5, 2.0, 3.0, 5.0, 7.0 })
			{
				const double value = factor * std::pow(10.0, power);
				const bool two_or_five = factor == 2 || factor == 5;
				const bool shown = factor == 1 ? power % step == 0 : decades < (two_or_five ? 2.5 : 1);
				if (shown && std::log10(value) >= low && std::log10(value) <= high)
					ticks.push_back(value);
			}
		return ticks;
	}
};

std::string tickText(double value)
{
	if (value >= 1e6)
		return fmt::format("{:g}M", value / 1e6);
	return value >= 1e4 ? fmt::format("{:g}k", value / 1e3) : fmt::format("{:g}", value);
}

std::string openSvg(double width, double height, const std::string& title)
{
	return fmt::format("<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
					   "role=\"img\" aria-label=\"{2}\">"
					   "<rect class=\"ground\" width=\"{0:g}\" height=\"{1:g}\"/><text class=\"heading\" x=\"14\" y=\"22\">{2}</text>",
					   width, height, escaped(title));
}

// Swatches with names, from left to right below the title.
std::string legend(const std::vector<std::pair<std::string, std::string>>& class_and_name)
{
	std::string svg;
	double x = 14;
	double y = 42;
	for (const auto& [style, name] : class_and_name)
	{
		const double width = 28 + 6.6 * double(name.size());
		if (x + width > kWidth && x > 14)
		{
			x = 14;
			y += 15;
		}
		svg += fmt::format("<rect class=\"{}\" x=\"{:g}\" y=\"{:g}\" width=\"12\" height=\"10\" rx=\"2\"/><text x=\"{:g}\" y=\"{:g}\">{}</text>",
						   style, x, y - 9, x + 17, y, escaped(name));
		x += width;
	}
	return svg;
}

std::string axes(const LogAxis& x, const LogAxis& y, const LineChart& chart)
{
	std::string svg;
	for (const double tick : x.ticks())
		svg += fmt::format("<path class=\"grid\" d=\"M{0:.1f} {1:g}V{2:g}\"/><text x=\"{0:.1f}\" y=\"{3:g}\" text-anchor=\"middle\">{4}</text>",
						   x.at(tick), kTop, kHeight - kBottom, kHeight - kBottom + 16, tickText(tick));
	for (const double tick : y.ticks())
		svg += fmt::format("<path class=\"grid\" d=\"M{1:g} {0:.1f}H{2:g}\"/><text x=\"{3:g}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>",
						   y.at(tick), kLeft, kWidth - kRight, kLeft - 7, y.at(tick) + 4, tickText(tick));
	svg += fmt::format("<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"middle\">{}</text>", (kLeft + kWidth - kRight) / 2, kHeight - 10,
					   escaped(chart.x_label));
	svg += fmt::format("<text transform=\"translate(16 {:g}) rotate(-90)\" text-anchor=\"middle\">{}</text>", (kTop + kHeight - kBottom) / 2,
					   escaped(chart.y_label));
	return svg;
}

// With its name above it.
std::string levelSvg(const ChartLevel& level, const LogAxis& y)
{
	const double left = kLeft, right = kWidth - kRight, height = y.at(level.y);
	return fmt::format(
		"<path class=\"level\" d=\"M{:g} {:.1f}H{:g}\"/><text class=\"level-name\" x=\"{:g}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", left,
		height, right, level.at_right ? right - 6 : left + 6, height - 5, level.at_right ? "end" : "start", escaped(level.name));
}

std::string pathThrough(const std::vector<ChartPoint>& points, const LogAxis& x, const LogAxis& y)
{
	std::string path;
	for (const ChartPoint& p : points)
		path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x.at(p.x), y.at(p.y));
	return path;
}

// `layer`: how many series lie above it; the lower ones are drawn larger, so that equal values show all of them.
std::string seriesSvg(const ChartSeries& series, size_t layer, const LogAxis& x, const LogAxis& y)
{
	const double radius = 4.5 + 2.5 * double(layer);
	std::string svg;
	if (series.joined && series.points.size() > 1)
		svg += fmt::format("<path class=\"line c{}\" stroke-width=\"{:g}\" d=\"{}\"/>", series.color, 2 + 2.5 * double(layer),
						   pathThrough(series.points, x, y));
	for (const ChartPoint& p : series.points)
		svg += fmt::format("<circle class=\"mark {} c{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:g}\"><title>{}</title></circle>",
						   p.strong ? "full" : "hollow", series.color, x.at(p.x), y.at(p.y), radius, escaped(p.hint));
	return svg;
}

}  // namespace

std::string escaped(std::string_view text)
{
	std::string result;
	for (const char c : text)
		switch (c)
		{
		case '&':
			result += "&amp;";
			break;
		case '<':
			result += "&lt;";
			break;
		case '>':
			result += "&gt;";
			break;
		case '"':
			result += "&quot;";
			break;
		default:
			result += c;
		}
	return result;
}

std::string chartSvg(const LineChart& chart)
{
	std::vector<double> xs, ys;
	std::vector<std::pair<std::string, std::string>> names;
	for (const ChartSeries& series : chart.series)
	{
		names.emplace_back(fmt::format("fill c{}", series.color), series.name);
		for (const ChartPoint& p : series.points)
		{
			xs.push_back(p.x);
			ys.push_back(p.y);
		}
	}
	for (const ChartLevel& level : chart.levels)
		ys.push_back(level.y);
	if (!chart.front.empty())
		names.emplace_back("fill front", chart.front_name);
	const LogAxis x = LogAxis::over(xs, kLeft, kWidth - kRight), y = LogAxis::over(ys, kHeight - kBottom, kTop);
	std::string svg = openSvg(kWidth, kHeight, chart.title) + legend(names) + axes(x, y, chart);
	if (chart.front.size() > 1)
		svg += fmt::format("<path class=\"line front\" d=\"{}\"/>", pathThrough(chart.front, x, y));
	for (const ChartLevel& level : chart.levels)
		svg += levelSvg(level, y);
	for (size_t i = 0; i < chart.series.size(); ++i)
		svg += seriesSvg(chart.series[i], chart.series.size() - 1 - i, x, y);
	return svg + "</svg>";
}

std::string chartSvg(const BarChart& chart)
{
	double most = 0;
	for (const Bar& bar : chart.bars)
	{
		double sum = 0;
		for (const BarSegment& segment : bar.segments)
			sum += segment.value;
		most = std::max(most, sum);
	}
	const double scale = (kWidth - kBarLeft - kBarRight) / std::max(most, 1e-12);
	const double top = kTop + 20, bottom = top + kBarStep * double(chart.bars.size());
	std::vector<std::pair<std::string, std::string>> names;
	for (size_t i = 0; i < chart.names.size(); ++i)
		names.emplace_back(fmt::format("fill c{}", i), chart.names[i]);
	std::string svg = openSvg(kWidth, bottom + 40, chart.title) + legend(names);
	const double step = std::pow(10.0, std::floor(std::log10(std::max(most, 1e-12) / 2)));
	const double spacing = most / step > 10 ? 5 * step : most / step > 5 ? 2 * step : step;
	for (int i = 0; i * spacing <= most; ++i)
		svg += fmt::format("<path class=\"grid\" d=\"M{0:.1f} {1:g}V{2:g}\"/><text x=\"{0:.1f}\" y=\"{3:g}\" text-anchor=\"middle\">{4:g}</text>",
						   kBarLeft + i * spacing * scale, top, bottom, bottom + 14, i * spacing);
	for (size_t i = 0; i < chart.bars.size(); ++i)
	{
		const double y = top + kBarStep * double(i) + (kBarStep - kBarHeight) / 2;
		svg += fmt::format("<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"end\">{}</text>", kBarLeft - 7, y + 12, escaped(chart.bars[i].label));
		double x = kBarLeft;
		for (const BarSegment& segment : chart.bars[i].segments)
		{
			svg += fmt::format("<rect class=\"segment c{}\" x=\"{:.2f}\" y=\"{:g}\" width=\"{:.2f}\" height=\"{:g}\"><title>{}</title></rect>",
							   segment.color, x, y, segment.value * scale, kBarHeight, escaped(segment.hint));
			x += segment.value * scale;
		}
		svg += fmt::format("<text x=\"{:.1f}\" y=\"{:g}\">{}</text>", x + 6, y + 12, escaped(chart.bars[i].end_label));
	}
	svg += fmt::format("<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"middle\">{}</text>", (kBarLeft + kWidth - kBarRight) / 2, bottom + 32,
					   escaped(chart.x_label));
	return svg + "</svg>";
}

std::string chartStyle()
{
	constexpr const char* kLight[kChartColors] = { "#1f66d1", "#d1480f", "#2b8a3e", "#8f37ad", "#a87b00", "#0b7a8f", "#c2255c", "#697077" };
	constexpr const char* kDark[kChartColors] = { "#6ea8fe", "#ff8f4a", "#63d17a", "#d18bf0", "#e8c33f", "#41c7dc", "#f783ac", "#a3abb3" };
	const auto theme = [](const char* ground, const char* text, const char* heading, const char* grid, const char* front, const auto& colors) {
		std::string css = fmt::format(".plot .ground{{fill:{}}}.plot text{{fill:{}}}.plot .heading{{fill:{}}}.plot .grid{{stroke:{}}}"
									  ".plot .line.front{{stroke:{}}}.plot .fill.front{{fill:{}}}.plot .hollow{{fill:{}}}.plot .level{{stroke:{}}}",
									  ground, text, heading, grid, front, front, ground, heading);
		for (size_t i = 0; i < kChartColors; ++i)
			css += fmt::format(".plot .line.c{0},.plot .mark.c{0}{{stroke:{1}}}.plot .full.c{0},.plot .fill.c{0},.plot .segment.c{0}{{fill:{1}}}", i,
							   colors[i]);
		return css;
	};
	std::string css = ".plot text{font-family:system-ui,'DejaVu Sans',sans-serif;font-size:12px}.plot .heading{font-size:14px;font-weight:600}"
					  ".plot .grid{stroke-width:1;fill:none}.plot .level{stroke-width:1.5;stroke-dasharray:7 5;fill:none}.plot .line{fill:none}.plot "
					  ".line.front{stroke-width:15;stroke-opacity:.6;"
					  "stroke-linejoin:round}.plot .mark{stroke-width:2}.plot .mark:hover{stroke-width:6}.plot .segment:hover{opacity:.7}";
	css += theme("#ffffff", "#4b5057", "#1b1e22", "#e6e7e9", "#ffd166", kLight);
	return css + "@media (prefers-color-scheme:dark){" + theme("#191c21", "#b4bac2", "#eceff2", "#30353c", "#6b5a1e", kDark) + "}";
}

std::string standaloneSvg(const std::string& svg)
{
	const size_t end_of_tag = svg.find('>') + 1;
	return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + svg.substr(0, end_of_tag) + "<style>" + chartStyle() + "</style>" +
		   svg.substr(end_of_tag) + "\n";
}

}  // namespace tessera::report
