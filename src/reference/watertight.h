// Do the triangles on both sides of every shared edge have the same micro-vertices along it, to the bit? (DESIGN.md, contract C1)
#pragma once
#include "reference/host_scene.h"
#include "reference/pieces.h"

namespace tessera::reference
{

struct WatertightReport
{
	uint64_t shared_edges = 0;     // base edges with two or more triangles among those given
	uint64_t open_edges = 0;       // with one: borders of the mesh, or the other side was culled
	uint64_t points = 0;           // compared, along shared edges
	uint64_t differing_edges = 0;  // the sides differ in number, place or displaced position
	uint64_t not_finite = 0;       // points whose position is not finite
	uint64_t invalid_parts = 0;    // left out: they name something that does not exist
	std::string first_problem;     // empty when it holds

	bool holds() const { return first_problem.empty(); }
};

// `parts`: pieces of one base triangle lie together, as classify and canonicalPieces give them. Edges are the same when their
// welded vertices are. Positions come from the shared headers: from surfaceVertex in full clusters, from surfacePoint in parts.
// On all threads; memory about 20 bytes per micro-vertex on an edge.
WatertightReport checkWatertight(const HostScene& scene, const View& view, std::span<const ClusterRef> full_clusters,
								 std::span<const ReferencePiece> parts);

}  // namespace tessera::reference
