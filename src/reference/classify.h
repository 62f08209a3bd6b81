// cluster_classify and triangle_split on the CPU, through the same headers: the same pieces, bit for bit.
#pragma once
#include "reference/host_scene.h"
#include "reference/pieces.h"
#include "shared/lists.h"

namespace tessera::reference
{

struct Classified
{
	// By visible cluster, then triangle; pieces of one base triangle lie together.
	std::vector<ReferencePiece> parts;
	std::vector<ReferencePiece> splits;  // of every level
	std::vector<ClusterRef> full_clusters;
	std::vector<uint64_t> split_counts;  // split triangles per level; as many as there are levels that have some
	uint64_t uncut_triangles = 0;        // split triangles of level `max_levels`: what the device calls an overflow; their area is missing
	uint64_t part_micro_triangles = 0;
	uint64_t full_cluster_triangles = 0;

	uint64_t microTriangles() const { return part_micro_triangles + full_cluster_triangles; }
	// How many levels have to be cut for everything to be drawn.
	uint32_t levels() const { return static_cast<uint32_t>(split_counts.size()); }
};

// What becomes of every triangle of `visible`. `rule` (factorRule of scene/factor_rule.h): both at most the scene's table. Triangles are cut up to
// `max_levels` times. On all threads; the result does not depend on them. Time and memory are linear in the pieces (about 60 bytes
// each).
Classified classify(const HostScene& scene, const View& view, FactorRule rule, std::span<const ClusterRef> visible,
					uint32_t max_levels = MAX_SPLIT_LEVELS - 1);

}  // namespace tessera::reference
