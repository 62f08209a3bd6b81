#include "app/list_options.h"

#include "app/option_text.h"

#include <algorithm>

namespace tessera
{

using nlohmann::ordered_json;

namespace
{

constexpr uint32_t kMostExtent = 65536;  // of a picture; the device may take less
constexpr double kMostRate = 1e6;

// Each part read by `read` (nothing when it is wrong), or what would be right.
template <typename T, typename Read>
Status parseList(std::vector<T>& values, std::string_view text, std::string_view right, const Read& read)
{
	std::vector<T> list;
	for (const std::string_view part : splitAt(text, ','))
	{
		const std::optional<T> value = read(part);
		if (!value)
			return fail(ExitCode::Usage, "{} is right", right);
		if (std::find(list.begin(), list.end(), *value) != list.end())
			return fail(ExitCode::Usage, "{} is there twice", part);
		list.push_back(*value);
	}
	values = std::move(list);
	return {};
}

template <typename T, typename Print>
std::vector<std::string> printList(const std::vector<T>& values, const Print& print)
{
	std::string text;
	for (const T& value : values)
		text += (text.empty() ? "" : ",") + print(value);
	return values.empty() ? std::vector<std::string>{} : std::vector{ text };
}

Status parseRates(AppOptions& options, std::string_view text)
{
	const auto read = [](std::string_view part) -> std::optional<double> {
		const std::optional<double> number = readNumber(part);
		return number && *number >= 0 && *number <= kMostRate ? number : std::nullopt;
	};
	return parseList(options.rates, text, "numbers from 0 to 1000000, such as 16,8,4", read);
}

std::vector<std::string> printRates(const AppOptions& options)
{
	return printList(options.rates, [](double rate) { return fmt::format("{}", rate); });
}

template <typename Enum>
Status parseNames(std::vector<Enum>& values, std::string_view text, std::span<const std::string_view> names)
{
	const auto read = [&](std::string_view part) -> std::optional<Enum> {
		const auto found = std::find(names.begin(), names.end(), part);
		return found == names.end() ? std::nullopt : std::optional(static_cast<Enum>(found - names.begin()));
	};
	return parseList(values, text, fmt::format("some of {}", joinNames(names)), read);
}

Status parseRasters(AppOptions& options, std::string_view text)
{
	return parseNames(options.rasters, text, kRasterNames);
}

Status parseMetrics(AppOptions& options, std::string_view text)
{
	return parseNames(options.metrics, text, kMetricNames);
}

std::vector<std::string> printMetrics(const AppOptions& options)
{
	return printList(options.metrics, [](Metric metric) { return std::string(metricName(metric)); });
}

ordered_json metricsJson(const AppOptions& options)
{
	ordered_json json = ordered_json::array();
	for (const Metric metric : options.metrics)
		json.push_back(metricName(metric));
	return json;
}

std::vector<std::string> printRasters(const AppOptions& options)
{
	return printList(options.rasters, [](Raster raster) { return std::string(rasterName(raster)); });
}

Status parseSizes(AppOptions& options, std::string_view text)
{
	const auto read = [](std::string_view part) -> std::optional<std::array<uint32_t, 2>> {
		return readPair(part, 1, kMostExtent);
	};
	return parseList(options.sizes, text, "sizes such as 1920x1080,3840x2160", read);
}

std::vector<std::string> printSizes(const AppOptions& options)
{
	return printList(options.sizes, [](const std::array<uint32_t, 2>& size) { return fmt::format("{}x{}", size[0], size[1]); });
}

ordered_json rastersJson(const AppOptions& options)
{
	ordered_json json = ordered_json::array();
	for (const Raster raster : options.rasters)
		json.push_back(rasterName(raster));
	return json;
}

}  // namespace

constinit const Custom kRatesOption = { parseRates, printRates, [](const AppOptions& options) {
										   return ordered_json(options.rates);
									   } };
constinit const Custom kRastersOption = { parseRasters, printRasters, rastersJson };
constinit const Custom kMetricsOption = { parseMetrics, printMetrics, metricsJson };
constinit const Custom kSizesOption = { parseSizes, printSizes, [](const AppOptions& options) {
										   return ordered_json(options.sizes);
									   } };

std::vector<double> ratesOf(const AppOptions& options)
{
	return options.rates.empty() ? std::vector{ 16.0, 8.0, 4.0, 2.0, 1.0, 0.5 } : options.rates;
}

std::vector<Raster> rastersOf(const AppOptions& options)
{
	return options.rasters.empty() ? std::vector{ options.raster } : options.rasters;
}

std::vector<Metric> metricsOf(const AppOptions& options)
{
	return options.metrics.empty() ? std::vector{ options.metric } : options.metrics;
}

std::vector<std::array<uint32_t, 2>> sizesOf(const AppOptions& options)
{
	return options.sizes.empty() ? std::vector{ std::array{ options.width_px, options.height_px } } : options.sizes;
}

}  // namespace tessera
