// Do the micro-triangles cover every base triangle exactly once? Decided in integers (DESIGN.md, section 5).
#pragma once
#include "reference/host_scene.h"
#include "reference/pieces.h"

namespace tessera::reference
{

struct CoverReport
{
	uint64_t base_triangles = 0;     // cut into parts
	uint64_t micro_triangles = 0;    // of parts
	uint64_t invalid_parts = 0;      // name something that does not exist
	uint64_t missing_triangles = 0;  // of visible clusters: neither in a full cluster nor in parts
	uint64_t repeated_clusters = 0;  // full clusters that also have parts, or that are not visible
	uint64_t wrong_areas = 0;        // base triangles whose signed micro-triangle areas do not add up to their own
	uint64_t open_segments = 0;      // micro-edges inside a base triangle without their opposite; borders not walked exactly once
	uint64_t negative_areas = 0;     // micro-triangles; only slivers may have them
	uint64_t zero_areas = 0;
	double worst_sliver = 0;    // largest doubled area / longest edge, domain units, of a part that has such micro-triangles
	std::string first_problem;  // empty when it holds

	bool holds() const { return first_problem.empty(); }
};

// `parts`: pieces of one base triangle lie together, as classify and canonicalPieces give them; of any origin otherwise.
// Covers exactly once means: signed areas add up, every inner micro-edge has its opposite, borders are walked once; micro-triangles
// of negative or zero area are counted and are no failure by themselves. On all threads; n log n in the micro-triangles.
CoverReport checkCover(const HostScene& scene, std::span<const ClusterRef> visible, std::span<const ClusterRef> full_clusters,
					   std::span<const ReferencePiece> parts);

}  // namespace tessera::reference
