// Part triangles by base triangle, for checks that look at one base triangle at a time.
#pragma once
#include "base/parallel.h"
#include "reference/host_scene.h"
#include "reference/pieces.h"

#include <algorithm>

namespace tessera::reference
{

// True when the piece can be evaluated: everything it names exists. Pieces read back from a device may be anything.
inline bool isValid(const HostScene& scene, const ReferencePiece& reference)
{
	const auto [instance, cluster] = reference.cluster;
	const DomainPiece& piece = reference.piece;
	if (instance >= scene.instances().size() || cluster >= scene.built().clusters.size())
		return false;
	const auto inside = [](DomainPoint p) {
		return p.u <= DOMAIN_SIZE && p.v <= DOMAIN_SIZE - p.u;
	};
	return piece.triangle < clusterTriangles(scene.cluster(reference.cluster)) && piece.a <= scene.tableSize() && piece.a >= piece.b &&
		   piece.b >= piece.c && piece.c >= 1 && inside(piece.c0) && inside(piece.c1) && inside(piece.c2);
}

inline bool sameBaseTriangle(const ReferencePiece& a, const ReferencePiece& b)
{
	return a.cluster.instance == b.cluster.instance && a.cluster.cluster == b.cluster.cluster && a.piece.triangle == b.piece.triangle;
}

// The runs of pieces of one base triangle.
inline std::vector<std::span<const ReferencePiece>> groupsOf(std::span<const ReferencePiece> pieces)
{
	std::vector<std::span<const ReferencePiece>> groups;
	for (size_t first = 0, i = 1; i <= pieces.size(); ++i)
		if (i == pieces.size() || !sameBaseTriangle(pieces[first], pieces[i]))
		{
			groups.push_back(pieces.subspan(first, i - first));
			first = i;
		}
	return groups;
}

// Calls body(result, first, end) for chunks of [0, count) on all threads; a result per chunk, in order.
template <typename Chunk, typename Body>
std::vector<Chunk> inChunks(size_t count, size_t chunk_size, const Body& body)
{
	std::vector<Chunk> chunks((count + chunk_size - 1) / chunk_size);
	parallelFor(chunks.size(), [&](size_t i) { body(chunks[i], i * chunk_size, std::min(count, (i + 1) * chunk_size)); });
	return chunks;
}

// Where a domain point lies on the base triangle's edges. Edge e runs from corner e to corner e + 1.
inline bool isOnEdge(DomainPoint p, uint32_t edge)
{
	return (edge == 0 ? domainW(p) : edge == 1 ? p.u : p.v) == 0;
}

// Distance from corner e, 0..DOMAIN_SIZE, of a point on edge e.
inline uint32_t alongEdge(DomainPoint p, uint32_t edge)
{
	return edge == 0 ? p.v : edge == 1 ? domainW(p) : p.u;
}

}  // namespace tessera::reference
