#include "scene/build/seams.h"

#include "scene/build/disjoint_sets.h"

#include <algorithm>
#include <compare>
#include <cstring>

namespace tessera
{

namespace
{

// The map of the primitive that a position in a list of ranges lies in. `firsts`: first_triangles or first_vertices.
uint32_t mapAt(const std::vector<uint32_t>& firsts, const MeshVertices& vertices, uint32_t index)
{
	const auto after = std::upper_bound(firsts.begin(), firsts.end(), index);
	return vertices.height_maps[size_t(after - firsts.begin()) - 1];
}

SeamEdge edgeValues(uint32_t first_vertex, uint32_t second_vertex, uint32_t height_map, const MeshVertices& vertices)
{
	SeamEdge values;
	values.uv_first = vertices.vertices[first_vertex].uv;
	values.uv_second = vertices.vertices[second_vertex].uv;
	values.density_first = vertices.densities[first_vertex];
	values.density_second = vertices.densities[second_vertex];
	values.height_map = height_map;
	return values;
}

// What `edge` itself says, with its ends in the order of `like`, an edge with the same ends.
SeamEdge valuesInOrderOf(uint32_t edge, uint32_t like, const MeshWeld& weld, const MeshCorners& corners, const MeshVertices& vertices)
{
	uint32_t first = edge, second = nextCorner(edge);
	if (weld.corner_welds[first] != weld.corner_welds[like])
		std::swap(first, second);
	const uint32_t height_map = mapAt(corners.first_triangles, vertices, edge / 3);
	return edgeValues(vertices.corner_vertices[first], vertices.corner_vertices[second], height_map, vertices);
}

bool readAlike(uint32_t edge, uint32_t other, const MeshWeld& weld, const MeshCorners& corners, const MeshVertices& vertices)
{
	const SeamEdge own = valuesInOrderOf(edge, edge, weld, corners, vertices);
	const SeamEdge others = valuesInOrderOf(other, edge, weld, corners, vertices);
	return std::memcmp(&own, &others, sizeof own) == 0;
}

// Per triangle: the first triangle of its chart.
std::vector<uint32_t> findCharts(const MeshCorners& corners, const MeshWeld& weld, const MeshVertices& vertices)
{
	DisjointSets sets(corners.triangleCount());
	for (uint32_t edge = 0; edge < weld.edge_owners.size(); ++edge)
	{
		const uint32_t other = weld.edge_owners[edge];
		if (other != edge && readAlike(edge, other, weld, corners, vertices))
			sets.unite(edge / 3, other / 3);
	}
	std::vector<uint32_t> charts(corners.triangleCount());
	for (uint32_t triangle = 0; triangle < charts.size(); ++triangle)
		charts[triangle] = sets.root(triangle);
	return charts;
}

// Per triangle: the rank of its chart, the largest chart first, equal ones in input order.
std::vector<uint32_t> rankCharts(const std::vector<uint32_t>& charts)
{
	std::vector<uint32_t> sizes(charts.size(), 0), order, ranks(charts.size());
	for (const uint32_t chart : charts)
		if (sizes[chart]++ == 0)
			order.push_back(chart);
	std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return sizes[a] > sizes[b]; });
	std::vector<uint32_t> rank_of(charts.size());
	for (uint32_t rank = 0; rank < order.size(); ++rank)
		rank_of[order[rank]] = rank;
	for (size_t triangle = 0; triangle < charts.size(); ++triangle)
		ranks[triangle] = rank_of[charts[triangle]];
	return ranks;
}

// What decides ownership, least first: of an edge, how many of its ends another side owns (else heights would jump at
// every vertex of a seam); the chart, the largest first, since beside a strip of small charts the large one runs through; and where both sides lie in
// one chart (a cylinder's seam), the texture coordinate, so that one side keeps owning there too; then input order.
struct OwnerKey
{
	uint32_t foreign_ends = 0;
	uint32_t chart_rank = NO_INDEX;
	float u = 0, v = 0;
	auto operator<=>(const OwnerKey&) const = default;
};

// Of items 0..count-1 in groups, the one of each group with the least key, then the lowest; per group.
template <typename GroupOf, typename KeyOf>
std::vector<uint32_t> firstByKey(uint32_t count, size_t groups, GroupOf groupOf, KeyOf keyOf)
{
	std::vector<uint32_t> firsts(groups, NO_INDEX);
	for (uint32_t item = 0; item < count; ++item)
	{
		uint32_t& first = firsts[groupOf(item)];
		if (first == NO_INDEX || keyOf(item) < keyOf(first))
			first = item;
	}
	return firsts;
}

}  // namespace

SeamEdge seamEdge(uint32_t edge, const MeshSeams& seams, const MeshWeld& weld, const MeshCorners& corners, const MeshVertices& vertices)
{
	return valuesInOrderOf(seams.edge_owners[edge], edge, weld, corners, vertices);
}

SeamCorner seamCorner(uint32_t owner_vertex, const MeshVertices& vertices)
{
	SeamCorner corner;
	corner.uv = vertices.vertices[owner_vertex].uv;
	corner.density = vertices.densities[owner_vertex];
	corner.height_map = mapAt(vertices.first_vertices, vertices, owner_vertex);
	return corner;
}

MeshSeams findSeams(const MeshCorners& corners, const MeshWeld& weld, const MeshVertices& vertices)
{
	MeshSeams seams;
	const uint32_t edge_count = uint32_t(weld.edge_owners.size());
	const std::vector<uint32_t> ranks = rankCharts(findCharts(corners, weld, vertices));
	const auto cornerKey = [&](uint32_t corner) {
		const vec2 uv = vertices.vertices[vertices.corner_vertices[corner]].uv;
		return OwnerKey{ 0, ranks[corner / 3], uv.x, uv.y };
	};
	const auto corner_firsts = firstByKey(
		edge_count, weld.first_corners.size(), [&](uint32_t corner) { return weld.corner_welds[corner]; }, cornerKey);
	const auto isForeign = [&](uint32_t corner) {
		const SeamCorner own = seamCorner(vertices.corner_vertices[corner], vertices);
		const SeamCorner owner = seamCorner(vertices.corner_vertices[corner_firsts[weld.corner_welds[corner]]], vertices);
		return std::memcmp(&own, &owner, sizeof own) != 0 ? 1u : 0u;
	};
	const auto edgeKey = [&](uint32_t edge) {
		const OwnerKey first = cornerKey(edge), second = cornerKey(nextCorner(edge));
		return OwnerKey{ isForeign(edge) + isForeign(nextCorner(edge)), first.chart_rank, first.u + second.u, first.v + second.v };
	};
	const auto edge_firsts = firstByKey(
		edge_count, edge_count, [&](uint32_t edge) { return weld.edge_owners[edge]; }, edgeKey);

	seams.edge_flags.resize(corners.triangleCount());
	seams.edge_owners.resize(edge_count);
	for (uint32_t edge = 0; edge < edge_count; ++edge)
	{
		const uint32_t owner = seams.edge_owners[edge] = edge_firsts[weld.edge_owners[edge]];
		if (readAlike(edge, owner, weld, corners, vertices))
			continue;
		seams.edge_flags[edge / 3] |= uint8_t(1u << (edge % 3));
		++seams.seam_edges;
	}

	seams.corner_owners.resize(vertices.vertices.size());
	for (uint32_t vertex = 0; vertex < seams.corner_owners.size(); ++vertex)
	{
		const uint32_t owner = vertices.corner_vertices[corner_firsts[vertices.vertices[vertex].weld]];
		const SeamCorner own = seamCorner(vertex, vertices);
		const SeamCorner owners = seamCorner(owner, vertices);
		const bool differs = std::memcmp(&own, &owners, sizeof own) != 0;
		seams.corner_owners[vertex] = differs ? owner : vertex;
		seams.seam_corners += differs;
	}
	return seams;
}

}  // namespace tessera
