#include "verify/fault.h"

#include "verify/random.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace tessera::verify
{

namespace
{

// Vertices that some instance draws.
std::vector<uint32_t> drawnVertices(const BuiltScene& scene)
{
	std::vector<bool> drawn(scene.positions.size());
	for (const Instance& instance : scene.instances)
	{
		const MeshRecord& mesh = scene.meshes[instance.mesh];
		for (uint32_t c = mesh.first_cluster; c < mesh.first_cluster + mesh.cluster_count; ++c)
			for (uint32_t v = 0; v < clusterVertices(scene.clusters[c]); ++v)
				drawn[scene.clusters[c].first_vertex + v] = true;
	}
	std::vector<uint32_t> vertices;
	for (uint32_t v = 0; v < drawn.size(); ++v)
		if (drawn[v])
			vertices.push_back(v);
	return vertices;
}

// Moves a float by 16 ulps, away from zero.
float nudged(float value)
{
	for (int i = 0; i < 16; ++i)
		value = std::nextafter(value, value < 0 ? -std::numeric_limits<float>::max() : std::numeric_limits<float>::max());
	return value;
}

void nudge(vec3& position)
{
	const vec3 size = glm::abs(position);
	const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
	position[axis] = size[axis] > 1e-6f ? nudged(position[axis]) : 1e-6f;
}

Result<std::string> crack(BuiltScene& scene, Random& random)
{
	std::vector<uint32_t> uses(scene.weld_ids.empty() ? 0 : *std::max_element(scene.weld_ids.begin(), scene.weld_ids.end()) + 1);
	std::vector<uint32_t> vertices = drawnVertices(scene);
	for (const uint32_t v : vertices)
		++uses[scene.weld_ids[v]];
	std::erase_if(vertices, [&](uint32_t v) { return uses[scene.weld_ids[v]] < 2; });
	if (vertices.empty())
		return badInput("--inject crack: {} has no vertex that two clusters share; --cluster-size 4x4 makes clusters smaller", scene.path);
	const uint32_t vertex = vertices[random.below(vertices.size())];
	nudge(scene.positions[vertex]);
	return fmt::format("vertex {} (welded vertex {}) lies 16 ulps away in one cluster", vertex, scene.weld_ids[vertex]);
}

Result<std::string> drop(BuiltScene& scene, Random& random)
{
	std::vector<uint32_t> clusters;
	for (const Instance& instance : scene.instances)
		for (uint32_t c = 0; c < scene.meshes[instance.mesh].cluster_count; ++c)
			if (clusterTriangles(scene.clusters[scene.meshes[instance.mesh].first_cluster + c]) > 1)
				clusters.push_back(scene.meshes[instance.mesh].first_cluster + c);
	if (clusters.empty())
		return badInput("--inject drop: {} has no cluster of two triangles or more", scene.path);
	const uint32_t cluster = clusters[random.below(clusters.size())];
	scene.clusters[cluster].counts -= 1u << 8;
	return fmt::format("cluster {} lacks its last triangle, {}", cluster, clusterTriangles(scene.clusters[cluster]));
}

Result<std::string> notANumber(BuiltScene& scene, Random& random)
{
	const std::vector<uint32_t> vertices = drawnVertices(scene);
	if (vertices.empty())
		return badInput("--inject nan: {} draws nothing", scene.path);
	const uint32_t vertex = vertices[random.below(vertices.size())];
	// Where directions are the normals, the device is given the latter for both.
	std::vector<vec3>& array = !scene.traits.has_displacement        ? scene.positions
							   : scene.traits.directions_are_normals ? scene.normals
																	 : scene.directions;
	array[vertex].y = std::numeric_limits<float>::quiet_NaN();
	return fmt::format("the {} of vertex {} is not a number", scene.traits.has_displacement ? "direction" : "position", vertex);
}

Result<std::string> tie(BuiltScene& scene, Random& random)
{
	const std::vector<uint32_t> vertices = drawnVertices(scene);
	if (vertices.empty())
		return badInput("--inject tie: {} draws nothing", scene.path);
	const uint32_t weld = scene.weld_ids[vertices[random.below(vertices.size())]];
	for (const uint32_t v : vertices)
		if (scene.weld_ids[v] == weld)
			nudge(scene.positions[v]);
	return fmt::format("welded vertex {} lies 16 ulps away in frames that are drawn another way", weld);
}

}  // namespace

Fault faultNamed(std::string_view name)
{
	const auto found = std::find(std::begin(kFaultNames), std::end(kFaultNames), name);
	return found == std::end(kFaultNames) ? Fault::None : static_cast<Fault>(found - std::begin(kFaultNames));
}

Result<FaultyScene> withFault(const BuiltScene& scene, Fault fault, uint64_t seed)
{
	FaultyScene faulty = { scene, {} };
	Random random(seed);
	switch (fault)
	{
	case Fault::Crack:
	{
		TRY_ASSIGN(faulty.what, crack(faulty.scene, random));
		break;
	}
	case Fault::Drop:
	{
		TRY_ASSIGN(faulty.what, drop(faulty.scene, random));
		break;
	}
	case Fault::Nan:
	{
		TRY_ASSIGN(faulty.what, notANumber(faulty.scene, random));
		break;
	}
	case Fault::Tie:
	{
		TRY_ASSIGN(faulty.what, tie(faulty.scene, random));
		break;
	}
	default:
		break;
	}
	return faulty;
}

Result<FaultyScene> withCullFault(const BuiltScene& scene, const VisiblePicture& picture, const Camera& camera, uint64_t seed)
{
	std::vector<size_t> covered;
	for (size_t i = 0; i < picture.pixels.size(); ++i)
		if (picture.pixels[i].covered())
			covered.push_back(i);
	if (covered.empty())
		return badInput("--inject cull: no cluster of {} is seen", scene.path);
	Random random(seed);
	const ClusterRef ref = picture.pixels[covered[random.below(covered.size())]].identity.cluster();
	FaultyScene faulty = { scene, fmt::format("the bounds of cluster {} lie behind the eye", ref.cluster) };
	const dvec3 behind = camera.eye + (camera.eye - camera.target) * 10.0;
	const dmat4& world = scene.instances[ref.instance].world;
	const vec3 point = vec3(dvec3(glm::inverse(world) * dvec4(behind, 1)));
	faulty.scene.cluster_bounds[ref.cluster] = { point, point, vec3(0), vec3(0), 0, 0, vec3(0, 0, 1), 2 };
	return faulty;
}

}  // namespace tessera::verify
