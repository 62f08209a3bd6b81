#include "scene/seams.h"

#include <algorithm>
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

}  // namespace

SeamEdge seamEdge(uint32_t edge, const MeshWeld& weld, const MeshCorners& corners, const MeshVertices& vertices)
{
	const uint32_t owner = weld.edge_owners[edge];
	uint32_t first = owner, second = nextCorner(owner);
	if (weld.corner_welds[first] != weld.corner_welds[edge])
		std::swap(first, second);
	const uint32_t height_map = mapAt(corners.first_triangles, vertices, owner / 3);
	return edgeValues(vertices.corner_vertices[first], vertices.corner_vertices[second], height_map, vertices);
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
	seams.edge_flags.resize(corners.triangleCount());
	for (size_t primitive = 0; primitive < vertices.height_maps.size(); ++primitive)
		for (uint32_t edge = 3 * corners.first_triangles[primitive]; edge < 3 * corners.first_triangles[primitive + 1]; ++edge)
		{
			if (weld.edge_owners[edge] == edge)
				continue;
			const SeamEdge own =
				edgeValues(vertices.corner_vertices[edge], vertices.corner_vertices[nextCorner(edge)], vertices.height_maps[primitive], vertices);
			const SeamEdge owner = seamEdge(edge, weld, corners, vertices);
			if (std::memcmp(&own, &owner, sizeof own) == 0)
				continue;
			seams.edge_flags[edge / 3] |= uint8_t(1u << (edge % 3));
			++seams.seam_edges;
		}

	seams.corner_owners.resize(vertices.vertices.size());
	for (uint32_t vertex = 0; vertex < seams.corner_owners.size(); ++vertex)
	{
		const uint32_t owner = vertices.corner_vertices[weld.first_corners[vertices.vertices[vertex].weld]];
		const SeamCorner own = seamCorner(vertex, vertices);
		const SeamCorner owners = seamCorner(owner, vertices);
		const bool differs = std::memcmp(&own, &owners, sizeof own) != 0;
		seams.corner_owners[vertex] = differs ? owner : vertex;
		seams.seam_corners += differs;
	}
	return seams;
}

}  // namespace tessera
