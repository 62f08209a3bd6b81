// How the number of segments of an edge is found (DESIGN.md, section 5; shared/edge_factor.h and edge_detail.h).
#pragma once
#include <cstdint>
#include <string_view>

namespace tessera
{

enum class Metric : uint8_t
{
	Edge,       // length over distance
	Displaced,  // the same of the displaced edge, as it is seen from the eye
	Detail,     // as edge, and fewer where the displaced surface is straight
};
inline constexpr std::string_view kMetricNames[] = { "edge", "displaced", "detail" };
inline constexpr std::string_view metricName(Metric metric)
{
	return kMetricNames[static_cast<uint8_t>(metric)];
}

// The tables that metrics need beside the scene; none is made that no metric asks for.
struct MetricTables
{
	bool details = false;    // for Metric::Detail
	bool roughness = false;  // for Metric::Displaced

	void include(Metric metric)
	{
		details = details || metric == Metric::Detail;
		roughness = roughness || metric == Metric::Displaced;
	}
	static MetricTables of(Metric metric)
	{
		MetricTables tables;
		tables.include(metric);
		return tables;
	}
};

}  // namespace tessera
