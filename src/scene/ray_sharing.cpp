#include "scene/ray_sharing.h"

#include "scene/camera.h"

#include <algorithm>
#include <span>

namespace tessera
{

namespace
{

bool sharesFrom(const BuiltScene& scene, const Instance& instance, const View& view, const RaySharing& sharing)
{
	return mayShare(scene.mesh_bounds[instance.mesh], placementOf(placementRecord(instance), view), sharing, view);
}

}  // namespace

RaySharing raySharing(const View& view, bool tessellates)
{
	RaySharing sharing = {};
	sharing.tessellates = tessellates ? 1 : 0;
	const double focal_px = std::max(double(view.focal_x) * view.width_px, double(view.focal_y) * view.height_px) / 2;
	// Pixels that a displacement of one unit moves a point at distance 1 by, at most: in the picture's corners a pixel is a smaller angle.
	const double in_corners = 1 + 1 / (double(view.focal_x) * double(view.focal_x)) + 1 / (double(view.focal_y) * double(view.focal_y));
	const bool perspective = view.distance_weight != 0;
	const double room = double(SHARING_MOST_PX) / (double(SHARING_ROUNDING) * focal_px * (perspective ? in_corners : 1));
	if (perspective)
	{
		const double most = std::clamp(room - 1, 0.0, double(SHARING_MOST_REACH));
		sharing.most_reach_squared = static_cast<float>(most * most * (1 - 1e-5));
	}
	else
		sharing.most_span_squared = static_cast<float>(std::min(room * room, 1e30) * (1 - 1e-5));
	return sharing;
}

std::vector<uint8_t> undisplacedMeshes(const BuiltScene& scene)
{
	std::vector<uint8_t> undisplaced;
	for (const MeshRecord& mesh : scene.meshes)
	{
		const auto clusters = std::span(scene.clusters).subspan(mesh.first_cluster, mesh.cluster_count);
		undisplaced.push_back(
			std::ranges::all_of(clusters, [&](const ClusterRecord& cluster) { return scene.material_height_maps[cluster.material] == NO_INDEX; }));
	}
	return undisplaced;
}

std::vector<uint8_t> sharingMeshes(const BuiltScene& scene, const View& view, const RaySharing& sharing, std::vector<uint8_t> candidates)
{
	std::vector<uint8_t> found(scene.meshes.size(), 0);
	if (sharing.most_reach_squared <= 0 && sharing.most_span_squared <= 0)
		return found;
	for (const Instance& instance : scene.instances)
	{
		if (!candidates[instance.mesh])
			continue;
		if (!sharesFrom(scene, instance, view, sharing))
			continue;
		found[instance.mesh] = 1;
		candidates[instance.mesh] = 0;
	}
	return found;
}

uint64_t trianglesNotShared(const BuiltScene& scene, const View& view, const RaySharing& sharing, const std::vector<uint8_t>& candidates)
{
	uint64_t triangles = 0;
	for (const Instance& instance : scene.instances)
		if (!candidates[instance.mesh] || !sharesFrom(scene, instance, view, sharing))
			triangles += trianglesOf(scene, scene.meshes[instance.mesh]);
	return triangles;
}

uint32_t trianglesOf(const BuiltScene& scene, const MeshRecord& mesh)
{
	if (mesh.cluster_count == 0)
		return 0;
	const ClusterRecord& last = scene.clusters[mesh.first_cluster + mesh.cluster_count - 1];
	return last.first_triangle + clusterTriangles(last) - scene.clusters[mesh.first_cluster].first_triangle;
}

}  // namespace tessera
