#include "scene/build/cluster_build.h"

#include "base/check.h"
#include "scene/build/flat_table.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

namespace tessera
{

namespace
{

// How much clusters favour facing one way over being compact: a little helps back-face culling.
constexpr float kConeWeight = 0.25f;

// Three vertices in cyclic order, the lowest first: the same for every rotation of a triangle.
uvec3 rotatedToLowest(uvec3 t)
{
	if (t.y < t.x && t.y < t.z)
		return uvec3(t.y, t.z, t.x);
	return t.z < t.x && t.z < t.y ? uvec3(t.z, t.x, t.y) : t;
}

// Finds the input triangle behind three vertices that meshoptimizer hands back; equal triangles are handed out in input order.
class TriangleFinder
{
public:
	explicit TriangleFinder(const std::vector<uint32_t>& indices)
		: table_(indices.size() / 3), heads_(indices.size() / 3), next_(indices.size() / 3), keys_(indices.size() / 3)
	{
		const auto count = uint32_t(keys_.size());
		for (uint32_t triangle = count; triangle-- > 0;)
		{
			keys_[triangle] = rotatedToLowest(uvec3(indices[3 * triangle], indices[3 * triangle + 1], indices[3 * triangle + 2]));
			const uint32_t entry = find(keys_[triangle], triangle);
			next_[triangle] = entry == triangle ? NO_INDEX : heads_[entry];
			heads_[entry] = triangle;
		}
	}

	uint32_t take(uvec3 vertices)
	{
		const uint32_t entry = find(rotatedToLowest(vertices), NO_INDEX - 1);
		CHECK(entry < next_.size() && heads_[entry] != NO_INDEX, "a triangle that is not in the mesh");
		const uint32_t triangle = heads_[entry];
		heads_[entry] = next_[triangle];
		return triangle;
	}

private:
	uint32_t find(uvec3 key, uint32_t otherwise)
	{
		const uint64_t hash = mixBits(mixBits(key.x | (uint64_t(key.y) << 32)) + key.z);
		return table_.findOrInsert(hash, otherwise, [&](uint32_t entry) { return keys_[entry] == key; });
	}

	FlatTable table_;
	std::vector<uint32_t> heads_;  // per entry: the lowest triangle not yet taken
	std::vector<uint32_t> next_;
	std::vector<uvec3> keys_;
};

struct Meshlets
{
	std::vector<meshopt_Meshlet> meshlets;
	std::vector<uint32_t> vertices;
	std::vector<uint8_t> triangles;
};

// Positions whose squared areas would overflow or vanish in float are scaled by a power of two: meshoptimizer leaves out
// triangles whose distance it cannot tell.
void bringIntoRange(std::vector<vec3>& positions)
{
	constexpr float kLeast = 0x1p-20f, kMost = 0x1p+20f;
	float largest = 0;
	for (const vec3& p : positions)
		largest = std::max({ largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z) });
	if (largest == 0 || (largest >= kLeast && largest <= kMost))
		return;
	const int exponent = -std::ilogb(largest);
	for (vec3& p : positions)
		p = vec3(std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent));
}

// A vertex of very many triangles: the searches for a good next triangle go through all of them at every step.
bool hasHub(const std::vector<uint32_t>& indices, size_t vertex_count)
{
	constexpr uint32_t kMost = 4096;
	std::vector<uint32_t> uses(vertex_count);
	return std::any_of(indices.begin(), indices.end(), [&](uint32_t vertex) { return ++uses[vertex] > kMost; });
}

Meshlets cutIntoMeshlets(const std::vector<uint32_t>& indices, std::vector<vec3> positions, const BuildOptions& options)
{
	bringIntoRange(positions);
	const bool in_order = hasHub(indices, positions.size());
	std::vector<uint32_t> ordered = indices;
	if (!in_order)
		meshopt_optimizeVertexCache(ordered.data(), indices.data(), indices.size(), positions.size());
	Meshlets result;
	const size_t most = meshopt_buildMeshletsBound(indices.size(), options.cluster_vertices, options.cluster_triangles);
	result.meshlets.resize(most);
	result.vertices.resize(most * options.cluster_vertices);
	result.triangles.resize(most * options.cluster_triangles * 3);
	const size_t count = in_order ? meshopt_buildMeshletsScan(result.meshlets.data(), result.vertices.data(), result.triangles.data(), ordered.data(),
															  ordered.size(), positions.size(), options.cluster_vertices, options.cluster_triangles)
								  : meshopt_buildMeshlets(result.meshlets.data(), result.vertices.data(), result.triangles.data(), ordered.data(),
														  ordered.size(), &positions[0].x, positions.size(), sizeof(vec3), options.cluster_vertices,
														  options.cluster_triangles, kConeWeight);
	result.meshlets.resize(count);
	return result;
}

class ClusterAppender
{
public:
	ClusterAppender(const MeshParts& mesh, const VertexArrays& arrays, BuiltScene& scene) : mesh_(mesh), arrays_(arrays), scene_(scene)
	{
		seam_corners_.resize(mesh.vertices.vertices.size(), NO_INDEX);
	}

	void appendPrimitive(uint32_t primitive, const BuildOptions& options)
	{
		const uint32_t first_triangle = mesh_.corners.first_triangles[primitive];
		const uint32_t first_vertex = mesh_.vertices.first_vertices[primitive];
		std::vector<vec3> positions;
		for (uint32_t v = first_vertex; v < mesh_.vertices.first_vertices[primitive + 1]; ++v)
			positions.push_back(positionOf(v));
		std::vector<uint32_t> indices;
		for (uint32_t corner = 3 * first_triangle; corner < 3 * mesh_.corners.first_triangles[primitive + 1]; ++corner)
			indices.push_back(mesh_.vertices.corner_vertices[corner] - first_vertex);
		if (indices.empty())
			return;

		TriangleFinder finder(indices);
		const Meshlets cut = cutIntoMeshlets(indices, positions, options);
		size_t triangles = 0;
		for (const meshopt_Meshlet& meshlet : cut.meshlets)
			triangles += meshlet.triangle_count;
		CHECK(3 * triangles == indices.size(), "clusters have {} of {} triangles", triangles, indices.size() / 3);
		for (const meshopt_Meshlet& meshlet : cut.meshlets)
			appendCluster(meshlet, cut, first_vertex, first_triangle, finder, mesh_.materials[primitive]);
	}

private:
	vec3 positionOf(uint32_t vertex) const { return mesh_.corners.positions[mesh_.weld.first_corners[mesh_.vertices.vertices[vertex].weld]]; }

	void appendCluster(const meshopt_Meshlet& meshlet, const Meshlets& cut, uint32_t first_vertex, uint32_t first_triangle, TriangleFinder& finder,
					   uint32_t material)
	{
		ClusterRecord record;
		record.first_vertex = uint32_t(scene_.positions.size());
		record.first_triangle = uint32_t(scene_.triangles.size());
		record.counts = meshlet.vertex_count | (meshlet.triangle_count << 8);
		record.material = material;
		scene_.clusters.push_back(record);
		const uint32_t* vertices = cut.vertices.data() + meshlet.vertex_offset;
		for (uint32_t i = 0; i < meshlet.vertex_count; ++i)
			appendVertex(first_vertex + vertices[i]);
		for (uint32_t i = 0; i < meshlet.triangle_count; ++i)
		{
			const uint8_t* local = cut.triangles.data() + meshlet.triangle_offset + 3 * i;
			const uint32_t triangle = first_triangle + finder.take(uvec3(vertices[local[0]], vertices[local[1]], vertices[local[2]]));
			appendTriangle(triangle, first_vertex, vertices, local);
		}
	}

	void appendVertex(uint32_t index)
	{
		const MeshVertex& vertex = mesh_.vertices.vertices[index];
		scene_.positions.push_back(positionOf(index));
		scene_.normals.push_back(vertex.normal);
		scene_.weld_ids.push_back(mesh_.first_weld_id + vertex.weld);
		if (arrays_.color_uvs)
			scene_.color_uvs.push_back(vertex.color_uv);
		if (arrays_.colors)
			scene_.colors.push_back(vertex.color);
		if (arrays_.directions)
			scene_.directions.push_back(mesh_.normals.weld_directions[vertex.weld]);
		if (!arrays_.displacement)
			return;
		scene_.uvs.push_back(vertex.uv);
		scene_.densities.push_back(mesh_.vertices.densities[index]);
		scene_.seam_corner_indices.push_back(seamCornerOf(index));
	}

	// The record of a vertex that another one owns; vertices that several clusters hold share it.
	uint32_t seamCornerOf(uint32_t vertex)
	{
		const uint32_t owner = mesh_.seams.corner_owners[vertex];
		if (owner != vertex && seam_corners_[vertex] == NO_INDEX)
		{
			seam_corners_[vertex] = uint32_t(scene_.seam_corners.size());
			scene_.seam_corners.push_back(seamCorner(owner, mesh_.vertices));
		}
		return seam_corners_[vertex];
	}

	// `local`: the cluster's vertices of the triangle, in some rotation of the input's corners. The input's rotation is kept.
	void appendTriangle(uint32_t triangle, uint32_t first_vertex, const uint32_t* vertices, const uint8_t* local)
	{
		uint32_t corners[3];
		uint32_t edge_flags = 0;
		for (uint32_t i = 0; i < 3; ++i)
		{
			const uint32_t corner = 3 * triangle + i;
			const uint32_t wanted = mesh_.vertices.corner_vertices[corner] - first_vertex;
			corners[i] = *std::find_if(local, local + 3, [&](uint8_t candidate) { return vertices[candidate] == wanted; });
			edge_flags |= uint32_t(mesh_.weld.corner_welds[corner] < mesh_.weld.corner_welds[nextCorner(corner)]) << i;
		}
		uint32_t seam_flags = 0;
		if (arrays_.displacement)
		{
			seam_flags = mesh_.seams.edge_flags[triangle];
			scene_.first_seam_edges.push_back(seam_flags ? uint32_t(scene_.seam_edges.size()) : 0);
			for (uint32_t i = 0; i < 3; ++i)
				if (seam_flags & (1u << i))
					scene_.seam_edges.push_back(seamEdge(3 * triangle + i, mesh_.seams, mesh_.weld, mesh_.corners, mesh_.vertices));
		}
		scene_.triangles.push_back(packBaseTriangle(corners[0], corners[1], corners[2], edge_flags, seam_flags));
		scene_.source_triangles.push_back(triangle);
	}

	const MeshParts& mesh_;
	const VertexArrays& arrays_;
	BuiltScene& scene_;
	std::vector<uint32_t> seam_corners_;  // per vertex of the mesh: its record or NO_INDEX
};

}  // namespace

void appendClusters(const MeshParts& mesh, const BuildOptions& options, const VertexArrays& arrays, BuiltScene& scene)
{
	MeshRecord record;
	record.first_cluster = uint32_t(scene.clusters.size());
	ClusterAppender appender(mesh, arrays, scene);
	for (uint32_t primitive = 0; primitive + 1 < mesh.vertices.first_vertices.size(); ++primitive)
		appender.appendPrimitive(primitive, options);
	record.cluster_count = uint32_t(scene.clusters.size()) - record.first_cluster;
	scene.meshes.push_back(record);
}

}  // namespace tessera
