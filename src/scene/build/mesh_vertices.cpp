#include "scene/build/mesh_vertices.h"

#include "scene/build/color_texture.h"
#include "scene/build/flat_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tessera
{

namespace
{

uint64_t hashVertex(const MeshVertex& vertex)
{
	uint32_t words[9];
	std::memcpy(words, &vertex, sizeof words);
	uint64_t hash = words[8];
	for (int i = 0; i < 8; i += 2)
		hash = mixBits(hash + (words[i] | (uint64_t(words[i + 1]) << 32)));
	return hash;
}

bool sameVertex(const MeshVertex& a, const MeshVertex& b)
{
	return std::memcmp(&a, &b, sizeof a) == 0;
}

// What a primitive's vertices carry, per vertex of the input; empty: nothing.
struct PrimitiveAttributes
{
	std::vector<vec2> uvs, color_uvs;
	std::vector<uint32_t> colors;
};

std::vector<vec2> transformed(const Primitive& primitive, const std::optional<TextureUse>& use)
{
	std::vector<vec2> uvs;
	if (!use)
		return uvs;
	for (const vec2 uv : primitive.texcoords[use->texcoord])
		uvs.push_back(transformUv(*use, uv));
	return uvs;
}

PrimitiveAttributes attributesOf(const Primitive& primitive, uint32_t material, const MaterialUses& uses, bool with_colors)
{
	PrimitiveAttributes attributes;
	if (material == MaterialUses::kSkipped)
		return attributes;
	attributes.uvs = transformed(primitive, uses.height_uses[material]);
	attributes.color_uvs = transformed(primitive, uses.color_uses[material]);
	if (with_colors)
		for (const vec4 color : primitive.colors)
			attributes.colors.push_back(packColor(color));
	return attributes;
}

// Adds the vertices of one primitive, whose corners begin at `first_corner`.
void addPrimitive(const Primitive& primitive, const PrimitiveAttributes& attributes, uint32_t first_corner, const MeshWeld& weld,
				  const MeshNormals& normals, MeshVertices& result)
{
	FlatTable table(primitive.indices.size());
	// Most input vertices become one vertex: remember the last one that each became.
	std::vector<uint32_t> last(primitive.positions.size(), NO_INDEX);
	for (uint32_t i = 0; i < primitive.indices.size(); ++i)
	{
		const uint32_t source = primitive.indices[i];
		MeshVertex vertex;
		vertex.normal = normals.corner_normals[first_corner + i];
		vertex.uv = attributes.uvs.empty() ? vec2(0) : attributes.uvs[source];
		vertex.color_uv = attributes.color_uvs.empty() ? vec2(0) : attributes.color_uvs[source];
		vertex.color = attributes.colors.empty() ? 0xffffffff : attributes.colors[source];
		vertex.weld = weld.corner_welds[first_corner + i];
		if (last[source] == NO_INDEX || !sameVertex(result.vertices[last[source]], vertex))
		{
			const auto next = uint32_t(result.vertices.size());
			const auto same = [&](uint32_t other) {
				return sameVertex(result.vertices[other], vertex);
			};
			last[source] = table.findOrInsert(hashVertex(vertex), next, same);
			if (last[source] == next)
				result.vertices.push_back(vertex);
		}
		result.corner_vertices.push_back(last[source]);
	}
}

// Areas around a welded vertex, of the triangles that use one map.
struct Areas
{
	double texels = 0;
	double surface = 0;
};

// Areas of a triangle; both 0 when one of them vanishes.
Areas areasOf(const MeshCorners& corners, const MeshVertices& vertices, uint32_t triangle, const HeightMap& map)
{
	dvec3 p[3];
	dvec2 uv[3];
	for (uint32_t i = 0; i < 3; ++i)
	{
		p[i] = corners.positions[3 * triangle + i];
		uv[i] = vertices.vertices[vertices.corner_vertices[3 * triangle + i]].uv;
	}
	const dvec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
	const double texels = std::fabs(a.x * b.y - a.y * b.x) * map.width * map.height;
	const double surface = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
	return texels > 0 && surface > 0 ? Areas{ texels, surface } : Areas{};
}

}  // namespace

vec2 transformUv(const TextureUse& use, vec2 uv)
{
	const dvec3 from(uv.x, uv.y, 1);
	return vec2(cleanFloat(glm::dot(use.row0, from)), cleanFloat(glm::dot(use.row1, from)));
}

MeshVertices buildVertices(const Mesh& mesh, const MeshCorners& corners, const MeshWeld& weld, const MeshNormals& normals,
						   const std::vector<uint32_t>& materials, const MaterialUses& uses, const BuiltScene& scene, bool with_colors)
{
	MeshVertices result;
	result.corner_vertices.reserve(corners.positions.size());
	for (size_t i = 0; i < mesh.primitives.size(); ++i)
	{
		result.first_vertices.push_back(uint32_t(result.vertices.size()));
		const PrimitiveAttributes attributes = attributesOf(mesh.primitives[i], materials[i], uses, with_colors);
		addPrimitive(mesh.primitives[i], attributes, 3 * corners.first_triangles[i], weld, normals, result);
		result.height_maps.push_back(materials[i] == MaterialUses::kSkipped ? NO_INDEX : scene.material_height_maps[materials[i]]);
	}
	result.first_vertices.push_back(uint32_t(result.vertices.size()));
	result.densities.resize(result.vertices.size());
	return result;
}

void buildDensities(const MeshCorners& corners, const MeshWeld& weld, const std::vector<HeightMapData>& maps, MeshVertices& vertices)
{
	std::vector<Areas> sums(weld.first_corners.size());
	std::vector<bool> done(vertices.height_maps.size());
	for (size_t first = 0; first < vertices.height_maps.size(); ++first)
	{
		const uint32_t map = vertices.height_maps[first];
		if (done[first] || map == NO_INDEX)
			continue;
		// Sum up over all primitives with this map, then write their vertices and clean up behind us.
		std::fill(sums.begin(), sums.end(), Areas{});
		for (size_t i = first; i < vertices.height_maps.size(); ++i)
			for (uint32_t t = corners.first_triangles[i]; vertices.height_maps[i] == map && t < corners.first_triangles[i + 1]; ++t)
			{
				const Areas areas = areasOf(corners, vertices, t, maps[map].record);
				for (uint32_t corner = 3 * t; corner < 3 * t + 3; ++corner)
				{
					sums[weld.corner_welds[corner]].texels += areas.texels;
					sums[weld.corner_welds[corner]].surface += areas.surface;
				}
			}
		for (size_t i = first; i < vertices.height_maps.size(); ++i)
			for (uint32_t v = vertices.first_vertices[i]; vertices.height_maps[i] == map && v < vertices.first_vertices[i + 1]; ++v)
			{
				const Areas sum = sums[vertices.vertices[v].weld];
				vertices.densities[v] = sum.surface > 0 ? cleanFloat(std::min(std::sqrt(sum.texels / sum.surface), 1e15)) : 0.0f;
				done[i] = true;
			}
	}
}

}  // namespace tessera
