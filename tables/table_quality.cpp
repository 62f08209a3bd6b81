#include "tables/table_quality.h"

#include "tables/lattice.h"

#include <cmath>
#include <numbers>

namespace tessera
{

uint32_t countFetches(std::span<const uint32_t> triangles)
{
	std::array<uint32_t, 256> fetched_at = {};  // 1 + number of fetches before; 0 = never
	uint32_t fetches = 0;
	for (const uint32_t packed : triangles)
	{
		for (const uint32_t vertex : { packed & 0xff, packed >> 8 & 0xff, packed >> 16 & 0xff })
		{
			if (fetched_at[vertex] == 0 || fetches - (fetched_at[vertex] - 1) > kReuseWindow)
				fetched_at[vertex] = ++fetches;
		}
	}
	return fetches;
}

static ConfigQuality measureConfig(const TessellationTable& table, const TableConfig& config, const std::array<uint32_t, 3>& factors)
{
	ConfigQuality quality;
	quality.factors = factors;
	quality.triangle_count = config.triangle_count;
	quality.vertex_count = config.vertex_count;
	const bool uniform = factors[0] == factors[2];
	quality.least_triangles = uniform ? factors[0] * factors[0] : factors[0] + factors[1] + factors[2] - 2;
	double thinnest = 0;
	for (uint32_t t = 0; t < config.triangle_count; t++)
	{
		const uint32_t packed = table.triangles[config.first_triangle + t];
		std::array<LatticePoint, 3> p;
		for (uint32_t i = 0; i < 3; i++)
		{
			const uint32_t vertex = table.vertices[config.first_vertex + (packed >> (8 * i) & 0xff)];
			p[i] = { int32_t(vertex & 0xffff), int32_t(vertex >> 16) };
		}
		thinnest = std::max(thinnest, thinness(p[0], p[1], p[2]));
		// Longest side squared over the doubled area, which a lattice cell has sqrt(3) / 2 of.
		const int64_t longest = std::max({ squaredDistance(p[0], p[1]), squaredDistance(p[1], p[2]), squaredDistance(p[2], p[0]) });
		const double height_times_side = double(doubledArea(p[0], p[1], p[2])) * std::numbers::sqrt3 / 2;
		quality.worst_aspect = std::max(quality.worst_aspect, double(longest) / height_times_side);
	}
	quality.smallest_angle_deg = std::atan2(std::numbers::sqrt3, thinnest) * 180 / std::numbers::pi;
	const std::span<const uint32_t> triangles(table.triangles.data() + config.first_triangle, config.triangle_count);
	quality.fetches_per_triangle = double(countFetches(triangles)) / config.triangle_count;
	return quality;
}

TableQuality measureTable(const TessellationTable& table)
{
	const std::vector<std::array<uint32_t, 3>> factors = configFactors(table.max_edge_segments);
	TableQuality quality;
	std::vector<double> angles;
	double fetches = 0;
	quality.worst_angle.smallest_angle_deg = 180;
	for (size_t i = 0; i < factors.size(); i++)
	{
		const ConfigQuality config = measureConfig(table, table.configs[i], factors[i]);
		quality.configs.push_back(config);
		quality.triangle_count += config.triangle_count;
		quality.vertex_count += config.vertex_count;
		quality.least_triangles += config.least_triangles;
		fetches += config.fetches_per_triangle * config.triangle_count;
		angles.push_back(config.smallest_angle_deg);
		quality.mean_angle_deg += config.smallest_angle_deg / double(factors.size());
		if (config.smallest_angle_deg < quality.worst_angle.smallest_angle_deg)
			quality.worst_angle = config;
		if (config.worst_aspect > quality.worst_aspect.worst_aspect)
			quality.worst_aspect = config;
	}
	std::sort(angles.begin(), angles.end());
	quality.median_angle_deg = (angles[(angles.size() - 1) / 2] + angles[angles.size() / 2]) / 2;
	quality.fetches_per_triangle = fetches / quality.triangle_count;
	return quality;
}

static std::string nameOf(const ConfigQuality& config)
{
	return fmt::format("({},{},{})", config.factors[0], config.factors[1], config.factors[2]);
}

static bool isExample(const std::array<uint32_t, 3>& f)
{
	static constexpr std::array<std::array<uint32_t, 3>, 8> kExamples = {
		{ { 2, 1, 1 }, { 5, 1, 1 }, { 7, 3, 2 }, { 11, 1, 1 }, { 11, 6, 3 }, { 11, 10, 9 }, { 11, 11, 1 }, { 11, 11, 11 } }
	};
	return std::find(kExamples.begin(), kExamples.end(), f) != kExamples.end();
}

std::string qualityReport(const TableQuality& quality, bool every_config)
{
	const ConfigQuality& angle = quality.worst_angle;
	const ConfigQuality& aspect = quality.worst_aspect;
	std::string text = "| measure | value |\n|---|---|\n";
	text += fmt::format("| configs | {} |\n", quality.configs.size());
	text += fmt::format("| triangles, all configs | {} |\n", quality.triangle_count);
	text += fmt::format("| triangles without interior points (lower bound) | {} |\n", quality.least_triangles);
	text += fmt::format("| vertices, all configs | {} |\n", quality.vertex_count);
	text += fmt::format("| smallest angle, mean over configs | {:.1f} |\n", quality.mean_angle_deg);
	text += fmt::format("| smallest angle, median | {:.1f} |\n", quality.median_angle_deg);
	text += fmt::format("| smallest angle, worst | {:.1f} at {} |\n", angle.smallest_angle_deg, nameOf(angle));
	text += fmt::format("| aspect, worst | {:.1f} at {} |\n", aspect.worst_aspect, nameOf(aspect));
	text += fmt::format("| vertex fetches per triangle, last {} kept | {:.3f} |\n\n", kReuseWindow, quality.fetches_per_triangle);
	text += "| config | triangles | lower bound | vertices | smallest angle | worst aspect | fetches per triangle |\n|---|---|---|---|---|---|---|\n";
	for (const ConfigQuality& config : quality.configs)
	{
		if (every_config || isExample(config.factors))
			text += fmt::format("| {} | {} | {} | {} | {:.1f} | {:.1f} | {:.2f} |\n", nameOf(config), config.triangle_count, config.least_triangles,
								config.vertex_count, config.smallest_angle_deg, config.worst_aspect, config.fetches_per_triangle);
	}
	return text;
}

}  // namespace tessera
