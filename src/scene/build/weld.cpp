#include "scene/build/weld.h"

#include "scene/build/disjoint_sets.h"
#include "scene/build/flat_table.h"

#include <algorithm>
#include <cstring>

namespace tessera
{

namespace
{

uint64_t hashPosition(vec3 p)
{
	uint32_t bits[3];
	std::memcpy(bits, &p, sizeof bits);
	return mixBits(mixBits(bits[0] | (uint64_t(bits[1]) << 32)) + bits[2]);
}

// Per corner: the lowest corner at the same position.
std::vector<uint32_t> identifyPositions(const MeshCorners& corners)
{
	FlatTable table(corners.positions.size());
	std::vector<uint32_t> ids(corners.positions.size());
	for (uint32_t corner = 0; corner < ids.size(); ++corner)
	{
		const vec3 p = corners.positions[corner];
		const auto same = [&](uint32_t other) {
			return std::memcmp(&corners.positions[other], &p, sizeof p) == 0;
		};
		ids[corner] = table.findOrInsert(hashPosition(p), corner, same);
	}
	return ids;
}

// Finds the edges with equal ends, and unites the corners at both.
void joinEdges(const std::vector<uint32_t>& positions, DisjointSets& sets, MeshWeld& weld)
{
	const uint32_t count = uint32_t(positions.size());
	const auto key = [&](uint32_t edge) {
		const auto [low, high] = std::minmax(positions[edge], positions[nextCorner(edge)]);
		return low | (uint64_t(high) << 32);
	};
	FlatTable table(count);
	std::vector<uint32_t> uses(count, 0);
	weld.edge_owners.resize(count);
	for (uint32_t edge = 0; edge < count; ++edge)
	{
		const uint64_t own_key = key(edge);
		const uint32_t owner = table.findOrInsert(mixBits(own_key), edge, [&](uint32_t other) { return key(other) == own_key; });
		weld.edge_owners[edge] = owner;
		++uses[owner];
		const bool same_way = positions[owner] == positions[edge];
		sets.unite(edge, same_way ? owner : nextCorner(owner));
		sets.unite(nextCorner(edge), same_way ? nextCorner(owner) : owner);
		// An edge of length zero: both ends are one point.
		if (positions[edge] == positions[nextCorner(edge)])
			sets.unite(edge, nextCorner(edge));
	}
	weld.boundary_edges = uint32_t(std::count(uses.begin(), uses.end(), 1u));
	weld.nonmanifold_edges = uint32_t(std::count_if(uses.begin(), uses.end(), [](uint32_t n) { return n > 2; }));
}

}  // namespace

MeshCorners layOutCorners(const Mesh& mesh)
{
	MeshCorners corners;
	for (const Primitive& primitive : mesh.primitives)
	{
		corners.first_triangles.push_back(uint32_t(corners.positions.size() / 3));
		for (const uint32_t index : primitive.indices)
			corners.positions.push_back(primitive.positions[index]);
	}
	corners.first_triangles.push_back(uint32_t(corners.positions.size() / 3));
	return corners;
}

MeshWeld weldMesh(const MeshCorners& corners)
{
	MeshWeld weld;
	const uint32_t count = uint32_t(corners.positions.size());
	DisjointSets sets(count);
	joinEdges(identifyPositions(corners), sets, weld);

	// Number the sets in order of their first corner, which is their root.
	weld.corner_welds.resize(count);
	for (uint32_t corner = 0; corner < count; ++corner)
	{
		const uint32_t root = sets.root(corner);
		if (root == corner)
		{
			weld.corner_welds[corner] = uint32_t(weld.first_corners.size());
			weld.first_corners.push_back(corner);
		}
		else
			weld.corner_welds[corner] = weld.corner_welds[root];
	}
	return weld;
}

}  // namespace tessera
