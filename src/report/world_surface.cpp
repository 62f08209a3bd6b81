#include "report/world_surface.h"

#include "report/sampling.h"

#include <cmath>
#include <limits>

namespace tessera::report
{

namespace
{

// Meshes, placed one after another.
struct Gathered
{
	dvec3 origin;
	std::vector<vec3> positions;
	std::vector<uvec3> triangles;

	void add(std::span<const vec3> mesh_positions, std::span<const uvec3> mesh_triangles, const dmat4& world)
	{
		const auto first = static_cast<uint32_t>(positions.size());
		for (const vec3& position : mesh_positions)
			positions.push_back(vec3(dvec3(world * dvec4(dvec3(position), 1)) - origin));
		for (const uvec3& triangle : mesh_triangles)
			triangles.push_back(triangle + first);
	}

	WorldSurface surface() const { return WorldSurface(origin, positions, triangles); }
};

dvec3 middleOf(const ImportedScene& model)
{
	dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
	for (const Instance& instance : model.instances)
		for (const Primitive& primitive : model.meshes[instance.mesh].primitives)
			for (const vec3& position : primitive.positions)
			{
				const dvec3 world = dvec3(instance.world * dvec4(dvec3(position), 1));
				low = glm::min(low, world);
				high = glm::max(high, world);
			}
	return low / 2.0 + high / 2.0;
}

uint64_t trianglesOf(const ImportedScene& model)
{
	uint64_t count = 0;
	for (const Instance& instance : model.instances)
		for (const Primitive& primitive : model.meshes[instance.mesh].primitives)
			count += primitive.indices.size() / 3;
	return count;
}

}  // namespace

WorldSurface::WorldSurface(dvec3 origin, std::span<const vec3> positions, std::span<const uvec3> triangles)
	: origin_(origin), set_(positions, triangles)
{
	dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
	for (const vec3& position : positions)
	{
		low = glm::min(low, dvec3(position));
		high = glm::max(high, dvec3(position));
	}
	low_ = origin + low;
	high_ = origin + high;
	double area = 0;
	areas_.reserve(triangles.size());
	for (const uvec3 t : triangles)
	{
		const dvec3 a = positions[t.x], b = positions[t.y], c = positions[t.z];
		const double own = glm::length(glm::cross(b - a, c - a)) / 2;
		area += std::isfinite(own) ? own : 0;
		areas_.push_back(area);
	}
}

WorldSpot WorldSurface::spotAt(dvec3 numbers) const
{
	return { static_cast<uint32_t>(pieceAt(areas_, numbers.x)), spreadOverTriangle({ numbers.y, numbers.z }) };
}

dvec3 WorldSurface::point(const WorldSpot& spot) const
{
	const uvec3 t = set_.triangles()[spot.triangle];
	const dvec3 a = set_.positions()[t.x], b = set_.positions()[t.y], c = set_.positions()[t.z];
	return a * spot.weights.x + b * spot.weights.y + c * (1 - spot.weights.x - spot.weights.y);
}

double WorldSurface::distance(dvec3 q) const
{
	constexpr double kInfinity = std::numeric_limits<double>::infinity();
	const std::optional<NearestTriangle> nearest = set_.nearest(q, kInfinity);
	return nearest ? nearest->distance : kInfinity;
}

Result<WorldSurface> originalSurface(const ImportedScene& model)
{
	const uint64_t count = trianglesOf(model);
	if (count > kMostWorldTriangles)
		return badInput("{}: has {} triangles over its instances; at most {} are measured against", model.path, count, kMostWorldTriangles);
	Gathered gathered = { middleOf(model), {}, {} };
	std::vector<uvec3> triangles;
	for (const Instance& instance : model.instances)
		for (const Primitive& primitive : model.meshes[instance.mesh].primitives)
		{
			triangles.clear();
			for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3)
				triangles.emplace_back(primitive.indices[i], primitive.indices[i + 1], primitive.indices[i + 2]);
			gathered.add(primitive.positions, triangles, instance.world);
		}
	WorldSurface surface = gathered.surface();
	if (!(surface.area() > 0))
		return badInput("{}: has no triangle with an area; nothing can be measured against it", model.path);
	return surface;
}

WorldSurface drawnSurface(const reference::HostScene& scene, const MicroScene& micro, dvec3 origin)
{
	Gathered gathered = { origin, {}, {} };
	for (size_t i = 0; i < micro.instances.size(); ++i)
		gathered.add(micro.instances[i].positions, micro.instances[i].triangles, scene.built().instances[i].world);
	return gathered.surface();
}

WorldSurface describedSurface(const reference::HostScene& scene, const ReferenceSurface& surface, dvec3 origin)
{
	Gathered gathered = { origin, {}, {} };
	for (const Instance& instance : scene.built().instances)
		if (const TriangleSet* triangles = surface.trianglesOf(instance.mesh))
			gathered.add(triangles->positions(), triangles->triangles(), instance.world);
	return gathered.surface();
}

}  // namespace tessera::report
