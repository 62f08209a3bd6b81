#include "verify/cameras.h"

#include "verify/random.h"

#include <fmt/format.h>

namespace tessera::verify
{

namespace
{

constexpr double kDegree = 3.14159265358979323846 / 180;

// A random vertex of the scene in the world, and the way out there.
struct SurfacePlace
{
	dvec3 point, normal;
};

SurfacePlace randomPlace(const BuiltScene& scene, Random& random)
{
	const Instance& instance = scene.instances[random.below(scene.instances.size())];
	const MeshRecord& mesh = scene.meshes[instance.mesh];
	const ClusterRecord& cluster = scene.clusters[mesh.first_cluster + random.below(mesh.cluster_count)];
	const uint32_t vertex = cluster.first_vertex + random.below(clusterVertices(cluster));
	dvec3 normal = dmat3(instance.world) * dvec3(scene.normals[vertex]);
	normal = glm::length(normal) > 0 ? glm::normalize(normal) : random.direction();
	return { dvec3(instance.world * dvec4(scene.positions[vertex], 1)), normal };
}

// Any direction across `normal`.
dvec3 across(dvec3 normal, Random& random)
{
	const dvec3 side = glm::cross(normal, random.direction());
	return glm::length(side) > 1e-6 ? glm::normalize(side) : glm::normalize(glm::cross(normal, dvec3(normal.y, normal.z, -normal.x)));
}

Camera looking(dvec3 eye, dvec3 target, double fov_deg)
{
	Camera camera;
	camera.eye = eye;
	camera.target = target;
	camera.fov_y_rad = fov_deg * kDegree;
	const dvec3 forward = glm::normalize(target - eye);
	camera.up = std::abs(forward.y) > 0.99 ? dvec3(0, 0, -1) : dvec3(0, 1, 0);
	return camera;
}

}  // namespace

std::vector<NamedCamera> randomCameras(const BuiltScene& scene, uint64_t seed, uint32_t count)
{
	const double radius = boundingRadius(scene);
	const dvec3 centre = (scene.world_low + scene.world_high) / 2.0;
	std::vector<NamedCamera> cameras;
	for (uint32_t i = 0; i < count; ++i)
	{
		Random random(seed * 0x10001 + i);
		const SurfacePlace place = randomPlace(scene, random);
		const auto add = [&](const char* kind, dvec3 eye, dvec3 target, double fov_deg) {
			cameras.push_back({ fmt::format("{} {}", kind, i), looking(eye, target, fov_deg) });
		};
		switch (i % 6)
		{
		case 0:
			add("far", centre + random.direction() * radius * random.between(2, 12), place.point, random.between(30, 70));
			break;
		case 1:
			add("close", place.point + (place.normal + random.direction() * 0.5) * radius * random.between(0.05, 0.3), place.point,
				random.between(40, 90));
			break;
		case 2:
			add("inside", centre + random.direction() * radius * random.between(0, 0.4), place.point + random.direction() * radius * 0.1, 90);
			break;
		case 3:
		{
			const dvec3 along = across(place.normal, random);
			add("grazing", place.point + (place.normal * random.between(0.002, 0.05) - along * 0.3) * radius, place.point + along * radius * 0.3, 60);
			break;
		}
		case 4:
			add("narrow", centre + random.direction() * radius * 5.0, place.point, random.between(0.5, 5));
			break;
		default:
			add("wide", place.point + place.normal * radius * random.between(0.1, 0.5), place.point, random.between(140, 170));
			break;
		}
	}
	return cameras;
}

std::vector<NamedCamera> sceneCameras(const BuiltScene& scene)
{
	std::vector<NamedCamera> cameras;
	for (size_t i = 0; i < scene.cameras.size(); ++i)
		cameras.push_back({ fmt::format("scene {}", i), cameraOf(scene.cameras[i], scene) });
	return cameras;
}

}  // namespace tessera::verify
