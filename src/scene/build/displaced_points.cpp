#include "scene/build/displaced_points.h"

#include "scene/build/height_map.h"

#include <algorithm>
#include <cmath>

namespace tessera
{

namespace
{

template <typename T>
uint64_t addressOf(const std::vector<T>& values)
{
	return reinterpret_cast<uint64_t>(values.data());
}

bool isCurved(const PnRises& rises)
{
	return rises.r01 != 0 || rises.r02 != 0 || rises.r10 != 0 || rises.r12 != 0 || rises.r20 != 0 || rises.r21 != 0;
}

}  // namespace

DisplacedPoints::DisplacedPoints(const BuiltScene& scene) : scene_(scene)
{
	for (const HeightMapData& map : scene.height_maps)
	{
		const HeightMap record = hostRecord(map);
		Heights heights = { record.width, record.height, record.wrap_u, record.wrap_v, record.factor, record.offset, {} };
		heights.texels.resize(size_t(record.width) * record.height);
		for (size_t texel = 0; texel < heights.texels.size(); ++texel)
			heights.texels[texel] = texelHeight(record, record.level_first[0] + uint32_t(texel));
		heights_.push_back(std::move(heights));
		height_maps_.push_back(record);
	}
	if (scene.uvs.empty())
	{
		no_uvs_.assign(scene.positions.size(), vec2(0));
		no_densities_.assign(scene.positions.size(), 0);
		no_height_maps_.assign(scene.materials.size(), NO_INDEX);
	}
	surface_.positions = addressOf(scene.positions);
	surface_.directions = addressOf(scene.directions);
	surface_.uvs = addressOf(scene.uvs.empty() ? no_uvs_ : scene.uvs);
	surface_.densities = addressOf(scene.uvs.empty() ? no_densities_ : scene.densities);
	surface_.triangles = addressOf(scene.triangles);
	surface_.first_seam_edges = addressOf(scene.first_seam_edges);
	surface_.seam_edges = addressOf(scene.seam_edges);
	surface_.seam_corner_indices = addressOf(scene.seam_corner_indices);
	surface_.seam_corners = addressOf(scene.seam_corners);
	surface_.material_height_maps = addressOf(scene.uvs.empty() ? no_height_maps_ : scene.material_height_maps);
	surface_.height_maps = addressOf(height_maps_);
	surface_.pn_directions = scene.traits.has_pn ? surface_.directions : 0;
}

DisplacedPoints::Triangle DisplacedPoints::triangle(const ClusterRecord& cluster, uint32_t index_in_cluster) const
{
	Triangle result;
	result.base = baseTriangle(surface_, cluster, index_in_cluster);
	result.corners = triangleCorners(surface_, result.base);
	result.on_seam = !scene_.seam_corner_indices.empty();
	const TriangleCorners& at = result.corners;
	result.is_curved =
		scene_.traits.has_pn && isCurved(pnRises(at.position0, at.position1, at.position2, at.direction0, at.direction1, at.direction2));
	result.moves = result.is_curved || result.base.height_map != NO_INDEX;
	const auto includeMap = [&](uint32_t map, vec2 from, vec2 to) {
		if (map == NO_INDEX)
			return;
		result.moves = true;
		const vec2 texels = (to - from) * vec2(height_maps_[map].width, height_maps_[map].height);
		result.longest_texels = std::max(result.longest_texels, glm::length(texels));
	};
	const vec2 uvs[3] = { result.corners.uv0, result.corners.uv1, result.corners.uv2 };
	const uint32_t seam_flags = triangleSeamFlags(result.base.flags);
	uint32_t seam = result.base.first_seam_edge;
	for (uint32_t edge = 0; edge < 3; ++edge)
	{
		includeMap(result.base.height_map, uvs[edge], uvs[(edge + 1) % 3]);
		if (seam_flags & (1u << edge))
		{
			const SeamEdge& record = scene_.seam_edges[seam++];
			includeMap(record.height_map, record.uv_first, record.uv_second);
		}
	}
	for (const uint32_t vertex : { result.base.v0, result.base.v1, result.base.v2 })
		if (result.on_seam && scene_.seam_corner_indices[vertex] != NO_INDEX)
			result.moves = result.moves || scene_.seam_corners[scene_.seam_corner_indices[vertex]].height_map != NO_INDEX;
	return result;
}

vec3 DisplacedPoints::at(const Triangle& triangle, DomainPoint p) const
{
	const SurfaceSample sample = sampleAtCorners(surface_, triangle.base, triangle.corners, triangle.on_seam, p);
	const float squared = glm::dot(sample.direction, sample.direction);
	if (sample.source.height_map == NO_INDEX || !(squared > 0))
		return sample.base;
	const Heights& heights = heights_[sample.source.height_map];
	return sample.base + sample.direction * ((heightAt(heights, sample.source.uv) * heights.factor + heights.offset) / std::sqrt(squared));
}

float DisplacedPoints::heightAt(const Heights& heights, vec2 uv)
{
	const float x = foldCoordinate(uv.x, heights.wrap_u) * float(heights.width) - 0.5f;
	const float y = foldCoordinate(uv.y, heights.wrap_v) * float(heights.height) - 0.5f;
	const float left = std::floor(x), top = std::floor(y);
	const uint32_t x0 = wrapTexel(int(left), heights.width, heights.wrap_u), x1 = wrapTexel(int(left) + 1, heights.width, heights.wrap_u);
	const uint32_t y0 = wrapTexel(int(top), heights.height, heights.wrap_v), y1 = wrapTexel(int(top) + 1, heights.height, heights.wrap_v);
	const float* row0 = &heights.texels[size_t(y0) * heights.width];
	const float* row1 = &heights.texels[size_t(y1) * heights.width];
	return glm::mix(glm::mix(row0[x0], row0[x1], x - left), glm::mix(row1[x0], row1[x1], x - left), y - top);
}

}  // namespace tessera
