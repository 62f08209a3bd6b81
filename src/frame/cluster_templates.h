// Templates that rays' clusters are made from: one per cluster of the scene, one per pattern of the table and one per pattern mirrored. Built once.
#pragma once
#include "gpu/cluster_structures.h"
#include "gpu/commands.h"
#include "raytracing/cluster_lists.h"
#include "scene/scene.h"
#include "tables/table.h"

namespace tessera
{

// Triangles of a template on the host: three 8-bit indices each, and where its vertices lie.
struct TemplateShape
{
	uint32_t first_index = 0;  // into the indices of all
	uint32_t triangle_count = 0;
	uint32_t first_vertex = 0;  // of the scene, or of the table
	uint32_t vertex_count = 0;
};
struct TemplateShapes
{
	std::vector<TemplateShape> shapes;  // clusters of the scene, then patterns as they are and mirrored in turn
	std::vector<uint8_t> indices;
	std::vector<vec3> pattern_positions;  // of the table's vertices: barycentric coordinates
	size_t scene_clusters = 0;
};
TemplateShapes templateShapes(const BuiltScene& scene, const TessellationTable& table);

struct TemplateOptions
{
	uint64_t positions = 0;  // address of the scene's vertices, float x, y, z
	bool opaque = true;      // false: any-hit shaders look at every hit
	uint32_t truncated_bits = 0;

	bool operator==(const TemplateOptions&) const = default;
};

class ClusterTemplates
{
public:
	// Waits for the device. Errors: BadInput (out of memory).
	static Result<ClusterTemplates> create(Device& device, CommandRecorder& commands, const TemplateShapes& shapes, const TemplateOptions& options);

	uint64_t records() const { return records_.address(); }  // address of ClusterTemplate[]
	uint32_t count() const { return count_; }
	uint32_t mostTriangles() const { return most_triangles_; }
	uint32_t mostVertices() const { return most_vertices_; }
	uint64_t bytes() const;

private:
	std::vector<Buffer> memory_;
	Buffer records_;
	uint32_t count_ = 0, most_triangles_ = 0, most_vertices_ = 0;
};

}  // namespace tessera
