#include "scene/build/bounds.h"

#include "base/parallel.h"
#include "scene/build/height_map.h"
#include "scene/build/pn_patch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

namespace tessera
{

namespace
{

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNeverBackFacing = 2;
constexpr float kFarthestReach = 1e30f;
// Rounding of a normalised interpolated direction, and of the interval arithmetic with it.
constexpr double kDirectionRounding = 1e-5;
// Directions that spread to more than this (cosine) from their mean are bounded by everything.
constexpr double kWidestSpread = 0.05;

// One cluster's triangles as the bounds need them.
struct ClusterTriangle
{
	uint32_t flags;
	uint32_t vertices[3];  // global
	uint32_t index;        // global
};

ClusterTriangle clusterTriangle(const BuiltScene& scene, const ClusterRecord& cluster, uint32_t i)
{
	ClusterTriangle triangle;
	triangle.index = cluster.first_triangle + i;
	triangle.flags = scene.triangles[triangle.index];
	for (uint32_t corner = 0; corner < 3; ++corner)
		triangle.vertices[corner] = cluster.first_vertex + triangleVertex(triangle.flags, corner);
	return triangle;
}

void includeFootprint(const std::vector<HeightRanges>& maps, uint32_t map, vec2 low, vec2 high, uint32_t mips, Interval& reach)
{
	if (map == NO_INDEX)
		reach.include(0.0f);
	else
		reach.include(maps[map].displacement(maps[map].over(low, high, mips)));
}

// The triangle, or the owner of one of its edges or corners, has a height map.
bool readsHeights(const BuiltScene& scene, const ClusterTriangle& triangle, uint32_t own_map)
{
	bool reads = own_map != NO_INDEX;
	const uint32_t first = scene.first_seam_edges.empty() ? 0 : scene.first_seam_edges[triangle.index];
	for (int i = 0; i < std::popcount(triangleSeamFlags(triangle.flags)); ++i)
		reads = reads || scene.seam_edges[first + uint32_t(i)].height_map != NO_INDEX;
	for (const uint32_t vertex : triangle.vertices)
		if (!scene.seam_corner_indices.empty() && scene.seam_corner_indices[vertex] != NO_INDEX)
			reads = reads || scene.seam_corners[scene.seam_corner_indices[vertex]].height_map != NO_INDEX;
	return reads;
}

// Every displacement that a point of the triangle can have while the finest `mips` are read, whoever owns its edges and corners.
Interval triangleReach(const BuiltScene& scene, const std::vector<HeightRanges>& maps, const ClusterTriangle& triangle, uint32_t own_map,
					   uint32_t mips = MAX_HEIGHT_LEVELS)
{
	Interval reach;
	const vec2 a = scene.uvs[triangle.vertices[0]], b = scene.uvs[triangle.vertices[1]], c = scene.uvs[triangle.vertices[2]];
	includeFootprint(maps, own_map, glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)), mips, reach);
	uint32_t record = scene.first_seam_edges.empty() ? 0 : scene.first_seam_edges[triangle.index];
	for (uint32_t edge = 0; edge < 3; ++edge)
		if (triangleSeamFlags(triangle.flags) & (1u << edge))
		{
			const SeamEdge& seam = scene.seam_edges[record++];
			includeFootprint(maps, seam.height_map, glm::min(seam.uv_first, seam.uv_second), glm::max(seam.uv_first, seam.uv_second), mips, reach);
		}
	for (const uint32_t vertex : triangle.vertices)
		if (!scene.seam_corner_indices.empty() && scene.seam_corner_indices[vertex] != NO_INDEX)
		{
			const SeamCorner& corner = scene.seam_corners[scene.seam_corner_indices[vertex]];
			includeFootprint(maps, corner.height_map, corner.uv, corner.uv, mips, reach);
		}
	return reach;
}

struct DirectionBox
{
	dvec3 low = dvec3(2);
	dvec3 high = dvec3(-2);
	bool has_zero = false;  // some vertex is not displaced at all
};

// Grows `box` by every normalised interpolation of three directions. Interpolations lie in the convex hull of the directions; its
// points have at least the length c, the smallest cosine to a common axis, so that normalising lengthens components by at
// most 1 / c. Zero directions pull towards 0 and leave the hull's cone as it is.
void includeDirections(const vec3 (&directions)[3], DirectionBox& box)
{
	dvec3 sum(0), low(2), high(-2);
	for (const vec3 direction : directions)
	{
		const dvec3 d(direction);
		const bool zero = d == dvec3(0);
		box.has_zero = box.has_zero || zero;
		if (zero)
			continue;
		sum += d;
		low = glm::min(low, d);
		high = glm::max(high, d);
	}
	if (low.x > 1.5)
		return;
	const double length = glm::length(sum);
	double cosine = 1;
	for (const vec3 direction : directions)
		if (direction != vec3(0))
			cosine = length > 1e-6 ? std::min(cosine, glm::dot(dvec3(direction), sum) / length) : 0;
	if (cosine < kWidestSpread)
	{
		box.low = dvec3(-1);
		box.high = dvec3(1);
		return;
	}
	for (int axis = 0; axis < 3; ++axis)
	{
		const double lowest = low[axis] < 0 ? low[axis] / cosine : low[axis];
		const double highest = high[axis] > 0 ? high[axis] / cosine : high[axis];
		box.low[axis] = std::min(box.low[axis], std::max(lowest - kDirectionRounding, -1 - kDirectionRounding));
		box.high[axis] = std::max(box.high[axis], std::min(highest + kDirectionRounding, 1 + kDirectionRounding));
	}
}

float largestDensity(const BuiltScene& scene, const ClusterTriangle& triangle)
{
	float largest = 0;
	uint32_t record = scene.first_seam_edges.empty() ? 0 : scene.first_seam_edges[triangle.index];
	for (uint32_t edge = 0; edge < 3; ++edge)
		if (triangleSeamFlags(triangle.flags) & (1u << edge))
		{
			const SeamEdge& seam = scene.seam_edges[record++];
			largest = std::max({ largest, seam.density_first, seam.density_second });
		}
	for (const uint32_t vertex : triangle.vertices)
	{
		largest = std::max(largest, scene.densities[vertex]);
		if (!scene.seam_corner_indices.empty() && scene.seam_corner_indices[vertex] != NO_INDEX)
			largest = std::max(largest, scene.seam_corners[scene.seam_corner_indices[vertex]].density);
	}
	return largest;
}

// Writes the reaches of the cluster's triangles as it goes.
void boundDisplacement(const BuiltScene& scene, const std::vector<HeightRanges>& maps, const ClusterRecord& cluster, DisplacedBounds& bounds,
					   std::span<TriangleReach> triangle_reaches)
{
	const uint32_t own_map = scene.material_height_maps[cluster.material];
	Interval reach;
	DirectionBox directions;
	for (uint32_t i = 0; i < clusterTriangles(cluster); ++i)
	{
		const ClusterTriangle triangle = clusterTriangle(scene, cluster, i);
		const Interval own = triangleReach(scene, maps, triangle, own_map);
		reach.include(own);
		triangle_reaches[triangle.index] = {};
		// Heights of 0 count: an offset may move what they leave in place.
		if (!readsHeights(scene, triangle, own_map))
			continue;
		includeDirections({ scene.directions[triangle.vertices[0]], scene.directions[triangle.vertices[1]], scene.directions[triangle.vertices[2]] },
						  directions);
		const auto upTo = [&](uint32_t mip) {
			Interval some = triangleReach(scene, maps, triangle, own_map, mip + 1);
			// Where there is no direction a point stays where it is.
			if (directions.has_zero)
				some.include(0.0f);
			return glm::clamp(vec2(some.low, some.high), -kFarthestReach, kFarthestReach);
		};
		triangle_reaches[triangle.index] = { upTo(REACH_FINE_MIP), upTo(REACH_COARSE_MIP), largestDensity(scene, triangle) };
	}
	if (directions.has_zero)
		reach.include(0.0f);
	const bool moves = directions.low.x <= directions.high.x;
	// Heights near the largest floats would make boxes of infinities less infinities.
	bounds.reach_low = moves ? std::max(reach.low, -kFarthestReach) : 0;
	bounds.reach_high = moves ? std::min(reach.high, kFarthestReach) : 0;
	bounds.direction_low = moves ? vec3(directions.low) : vec3(0);
	bounds.direction_high = moves ? vec3(directions.high) : vec3(0);
}

dvec3 facetNormal(const BuiltScene& scene, const ClusterTriangle& triangle)
{
	const dvec3 p0(scene.positions[triangle.vertices[0]]), p1(scene.positions[triangle.vertices[1]]), p2(scene.positions[triangle.vertices[2]]);
	const dvec3 area = glm::cross(p1 - p0, p2 - p0);
	const double length = glm::length(area);
	return length > 0 ? area / length : dvec3(0);
}

// Facets without area draw nothing and do not count.
void boundNormals(const BuiltScene& scene, const ClusterRecord& cluster, DisplacedBounds& bounds)
{
	dvec3 sum(0);
	for (uint32_t i = 0; i < clusterTriangles(cluster); ++i)
		sum += facetNormal(scene, clusterTriangle(scene, cluster, i));
	const double length = glm::length(sum);
	if (length < 1e-6)
		return;
	const vec3 axis(sum / length);
	double cosine = 1;
	for (uint32_t i = 0; i < clusterTriangles(cluster); ++i)
		if (const dvec3 normal = facetNormal(scene, clusterTriangle(scene, cluster, i)); normal != dvec3(0))
			cosine = std::min(cosine, glm::dot(normal, dvec3(axis)));
	if (cosine < kWidestSpread)
		return;
	bounds.cone_axis = axis;
	bounds.cone_cutoff = float(std::sqrt(std::max(0.0, 1 - cosine * cosine)) + 1e-4);
}

// Grows the box by the control points, whose hull contains the surface; and the ball that contains what they add.
void boundPatches(const BuiltScene& scene, const ClusterRecord& cluster, DisplacedBounds& bounds)
{
	double farthest = 0;
	for (uint32_t t = 0; t < clusterTriangles(cluster); ++t)
	{
		const PnPatch patch = pnPatch(scene, cluster, t);
		for (const dvec3& point : patch.points)
		{
			bounds.low = glm::min(bounds.low, vec3(point));
			bounds.high = glm::max(bounds.high, vec3(point));
		}
		for (const dvec3& bulge : patch.bulges)
			farthest = std::max(farthest, glm::length(bulge));
	}
	bounds.bulge = farthest > 0 ? std::nextafter(float(farthest), kInfinity) : 0;
}

float longestEdge(const BuiltScene& scene, const ClusterRecord& cluster)
{
	double longest_squared = 0;
	for (uint32_t t = 0; t < clusterTriangles(cluster); ++t)
	{
		const ClusterTriangle triangle = clusterTriangle(scene, cluster, t);
		for (int corner = 0; corner < 3; ++corner)
		{
			const dvec3 edge = dvec3(scene.positions[triangle.vertices[corner]]) - dvec3(scene.positions[triangle.vertices[(corner + 1) % 3]]);
			longest_squared = std::max(longest_squared, glm::dot(edge, edge));
		}
	}
	return longest_squared > 0 ? std::nextafter(float(std::sqrt(longest_squared)), kInfinity) : 0.0f;
}

DisplacedBounds clusterBounds(const BuiltScene& scene, const std::vector<HeightRanges>& maps, const ClusterRecord& cluster,
							  std::span<TriangleReach> triangle_reaches)
{
	DisplacedBounds bounds = emptyBounds();
	for (uint32_t v = cluster.first_vertex; v < cluster.first_vertex + clusterVertices(cluster); ++v)
	{
		bounds.low = glm::min(bounds.low, scene.positions[v]);
		bounds.high = glm::max(bounds.high, scene.positions[v]);
	}
	bounds.longest_edge = longestEdge(scene, cluster);
	if (scene.traits.has_pn)
		boundPatches(scene, cluster, bounds);
	if (!scene.uvs.empty())
		boundDisplacement(scene, maps, cluster, bounds, triangle_reaches);
	const bool displaced = bounds.reach_low != 0 || bounds.reach_high != 0;
	if (!displaced && bounds.bulge == 0 && !scene.materials[cluster.material].double_sided)
		boundNormals(scene, cluster, bounds);
	return bounds;
}

// The union of a mesh's clusters.
DisplacedBounds meshBounds(const BuiltScene& scene, const MeshRecord& mesh)
{
	DisplacedBounds bounds = emptyBounds();
	bounds.direction_low = vec3(kInfinity);
	bounds.direction_high = vec3(-kInfinity);
	for (uint32_t i = mesh.first_cluster; i < mesh.first_cluster + mesh.cluster_count; ++i)
	{
		const DisplacedBounds& cluster = scene.cluster_bounds[i];
		bounds.low = glm::min(bounds.low, cluster.low);
		bounds.high = glm::max(bounds.high, cluster.high);
		bounds.bulge = std::max(bounds.bulge, cluster.bulge);
		bounds.longest_edge = std::max(bounds.longest_edge, cluster.longest_edge);
		bounds.reach_low = i == mesh.first_cluster ? cluster.reach_low : std::min(bounds.reach_low, cluster.reach_low);
		bounds.reach_high = i == mesh.first_cluster ? cluster.reach_high : std::max(bounds.reach_high, cluster.reach_high);
		if (cluster.direction_low == vec3(0) && cluster.direction_high == vec3(0))
			continue;
		bounds.direction_low = glm::min(bounds.direction_low, cluster.direction_low);
		bounds.direction_high = glm::max(bounds.direction_high, cluster.direction_high);
	}
	if (bounds.direction_low.x > bounds.direction_high.x)
		bounds.direction_low = bounds.direction_high = vec3(0);
	if (mesh.cluster_count == 0)
		bounds.low = bounds.high = vec3(0);
	return bounds;
}

void boundWorld(BuiltScene& scene)
{
	dvec3 low(kInfinity), high(-kInfinity);
	for (const Instance& instance : scene.instances)
	{
		if (scene.meshes[instance.mesh].cluster_count == 0)
			continue;
		const Box box = displacedBox(scene.mesh_bounds[instance.mesh], 1.0f, 0.0f);
		for (int corner = 0; corner < 8; ++corner)
		{
			const dvec3 p(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y, corner & 4 ? box.high.z : box.low.z);
			const dvec3 placed_corner(instance.world * dvec4(p, 1));
			low = glm::min(low, placed_corner);
			high = glm::max(high, placed_corner);
		}
	}
	const bool empty = low.x > high.x;
	scene.world_low = empty ? dvec3(0) : low;
	scene.world_high = empty ? dvec3(0) : high;
}

}  // namespace

DisplacedBounds emptyBounds()
{
	DisplacedBounds bounds = {};
	bounds.low = vec3(kInfinity);
	bounds.high = vec3(-kInfinity);
	bounds.cone_axis = vec3(0, 0, 1);
	bounds.cone_cutoff = kNeverBackFacing;
	return bounds;
}

void buildBounds(BuiltScene& scene)
{
	std::vector<HeightRanges> maps;
	for (const HeightMapData& map : scene.height_maps)
		maps.emplace_back(map);
	scene.cluster_bounds.resize(scene.clusters.size());
	scene.triangle_reaches.resize(scene.uvs.empty() ? 0 : scene.triangles.size());
	constexpr size_t kBand = 64;
	parallelFor((scene.clusters.size() + kBand - 1) / kBand, [&](size_t band) {
		for (size_t i = band * kBand; i < std::min(scene.clusters.size(), (band + 1) * kBand); ++i)
			scene.cluster_bounds[i] = clusterBounds(scene, maps, scene.clusters[i], scene.triangle_reaches);
	});
	for (const MeshRecord& mesh : scene.meshes)
	{
		scene.mesh_bounds.push_back(meshBounds(scene, mesh));
		scene.mesh_longest_edge.push_back(scene.mesh_bounds.back().longest_edge);
	}
	boundWorld(scene);
}

}  // namespace tessera
