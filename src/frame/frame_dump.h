// The micro-triangles of a drawn frame, read back: what export writes and verification checks.
#pragma once
#include "frame/renderer.h"
#include "raster/dump_micro.h"
#include "shared/domain.h"

#include <span>

namespace tessera
{

// The vertex of its item at a corner, 0..2.
inline uint32_t cornerOf(const DumpTriangle& triangle, uint32_t corner)
{
	return triangle.corners >> 10 * corner & 0x3ffu;
}

// What a renderer must be made with for readDump, and for readVisibility.
inline constexpr std::string_view kDumpOutputs[] = { "micro_dump" };
inline constexpr std::string_view kVisibilityOutputs[] = { "kept_visibility" };
inline constexpr std::string_view kDumpAndVisibilityOutputs[] = { "micro_dump", "kept_visibility" };

// The lists of one drawn round, as the device holds them, and what it draws from them.
struct FrameDump
{
	std::vector<ClusterRef> visible;
	std::vector<DomainPiece> parts;       // unpacked part triangles
	std::vector<uint32_t> full_clusters;  // indices into visible
	std::vector<bool> part_is_drawn;      // false: found hidden by occlusion culling
	std::vector<bool> cluster_is_drawn;   // the same of full_clusters
	std::vector<DumpItem> items;          // full clusters (empty ones for those that are not drawn), then batches
	std::vector<DumpVertex> vertices;     // of all items
	std::vector<DumpTriangle> triangles;

	bool isBatch(size_t item) const { return item >= full_clusters.size(); }
	std::span<const DumpVertex> verticesOf(size_t item) const
	{
		return std::span(vertices).subspan(items[item].first_vertex, items[item].vertex_count);
	}
	std::span<const DumpTriangle> trianglesOf(size_t item) const
	{
		return std::span(triangles).subspan(items[item].first_triangle, items[item].triangle_count);
	}
};

// Reads the last drawn round. Errors: DeviceLost, BadInput (out of memory), CheckFailed (the device wrote what cannot be: an item with too many
// entries, an index that points nowhere).
Result<FrameDump> readDump(Renderer& renderer);

// The lists alone: no items.
Result<FrameDump> readLists(Renderer& renderer);

// Per pixel, rows top to bottom: depth bits << 32 | payload; 0 is background. Errors: as above.
Result<std::vector<uint64_t>> readVisibility(Renderer& renderer);

}  // namespace tessera
