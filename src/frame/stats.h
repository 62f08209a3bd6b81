// What a drawn frame tells of itself: the numbers behind --stats, the report and the viewer (DESIGN.md, contract C7).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace tessera
{

struct PassTime
{
	std::string name;
	double gpu_ms = 0;  // all repetitions, attempts and rounds of the frame together
};

struct ListStats
{
	std::string name;
	uint64_t wanted = 0;  // of the attempt that was drawn
	uint32_t capacity = 0;
	uint32_t peak = 0;       // largest wanted since the list was made, refused attempts included
	uint32_t peak_used = 0;  // most that a drawn frame held
	uint64_t bytes = 0;
};

// What was built of clusters for rays.
struct RayClusterStats
{
	bool built = false;
	uint64_t templates = 0;           // made at load
	uint64_t full = 0, parts = 0;     // made from templates: full clusters, and part triangles
	uint64_t units = 0, groups = 0;   // transient clusters: of triangles of factor 1, and of parts with factors up to 2
	uint64_t structures = 0;          // bottom-level
	uint64_t generated_vertices = 0;  // micro-vertices that all of them are made of
	uint64_t template_bytes = 0;
	uint64_t data_bytes = 0, data_used_bytes = 0;            // of clusters: reserved, and taken at their largest sizes
	uint64_t structure_bytes = 0, structure_used_bytes = 0;  // of bottom-level structures: reserved, and taken; within operation_bytes
	uint64_t operation_bytes = 0;  // lists, inputs, scratch memory, and the bottom-level structures, which lie where inputs did
	std::vector<ListStats> lists;
	uint64_t total() const { return template_bytes + data_bytes + operation_bytes; }
};

// What rays were traced through.
struct RayStats
{
	bool traced = false;
	bool refitted = false;             // the last build moved vertices of the one before; else all was built
	ListStats triangles;               // wanted: those of the frame; capacity: those that the structure is built of
	uint64_t geometry_bytes = 0;       // reserved
	uint64_t geometry_used_bytes = 0;  // what the driver asks for as many as the frame has
	uint64_t scene_bytes = 0, scratch_bytes = 0;
	// Structures of meshes that instances share; instances of this frame that do; memory of all of it.
	uint64_t shared_structures = 0, shared_instances = 0, shared_bytes = 0;
	RayClusterStats clusters;
	uint64_t total() const { return geometry_bytes + scene_bytes + scratch_bytes + shared_bytes + clusters.total(); }
};

struct FrameCountsRead
{
	uint64_t full_clusters = 0;
	uint64_t visible_clusters = 0;
	uint64_t part_triangles = 0;
	uint64_t split_triangles = 0;
	uint64_t micro_triangles = 0;  // of parts and full clusters
	uint64_t hidden_parts = 0;     // left out by the first phase of occlusion culling
	uint64_t revealed_parts = 0;   // drawn in the second
	uint64_t hidden_clusters = 0;  // full ones, likewise
	uint64_t revealed_clusters = 0;
	uint64_t hidden_instances = 0;  // whose segments had grown because something hides them
	uint64_t covered_pixels = 0;
};

struct FrameResult
{
	double gpu_ms = 0;  // every pass of the attempt that was drawn, clears and barriers included
	std::vector<PassTime> passes;
	double rate_wanted = 0, rate_granted = 0;
	uint32_t coarsening = 0;  // j: the granted rate is rate x 2^(j/16)
	bool every_factor_one = false;
	uint32_t rounds = 1;
	uint32_t attempts = 1;        // 1: the device found a rate that fits, or needed none; more: rounds, or packings that grew
	uint32_t hidden_redraws = 0;  // of them: drawn again because an instance that had been hidden was seen
	FrameCountsRead counts;
	std::vector<ListStats> lists;
	RayStats rays;
};

struct MemoryStats
{
	uint64_t lists = 0, geometry = 0, textures = 0, images = 0;
	uint64_t rays = 0;  // acceleration structures, their instances and scratch memory
	uint64_t total() const { return lists + geometry + textures + images + rays; }
};

}  // namespace tessera
