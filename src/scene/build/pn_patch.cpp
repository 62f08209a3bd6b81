#include "scene/build/pn_patch.h"

#include <algorithm>

namespace tessera
{

PnPatch pnPatch(const std::array<vec3, 3>& positions, const std::array<vec3, 3>& directions)
{
	PnPatch patch;
	const dvec3 middle = (dvec3(positions[0]) + dvec3(positions[1]) + dvec3(positions[2])) / 3.0;
	dvec3 sum(0);
	for (size_t i = 0; i < 3; ++i)
	{
		patch.points[i] = positions[i];
		for (size_t k = 0; k < 2; ++k)
		{
			const size_t edge_point = 2 * i + k, j = (i + 1 + k) % 3;
			const dvec3 from(positions[i]), to(positions[j]), direction(directions[i]);
			patch.bulges[edge_point] = direction * (glm::dot(to - from, direction) / -3);
			patch.points[3 + edge_point] = (from * 2.0 + to) / 3.0 + patch.bulges[edge_point];
			sum += patch.bulges[edge_point];
		}
	}
	// The mean of the six edge points, and half of what it is beyond the corners' mean.
	patch.bulges[6] = sum / 6.0 * 1.5;
	patch.points[9] = middle + patch.bulges[6];
	return patch;
}

PnPatch pnPatch(const BuiltScene& scene, const ClusterRecord& cluster, uint32_t index_in_cluster)
{
	const uint32_t triangle = scene.triangles[cluster.first_triangle + index_in_cluster];
	std::array<vec3, 3> positions, directions;
	for (uint32_t corner = 0; corner < 3; ++corner)
	{
		const uint32_t vertex = cluster.first_vertex + triangleVertex(triangle, corner);
		positions[corner] = scene.positions[vertex];
		directions[corner] = scene.directions[vertex];
	}
	return pnPatch(positions, directions);
}

bool anyCurved(const BuiltScene& scene)
{
	const auto isCurved = [&](const ClusterRecord& cluster) {
		for (uint32_t t = 0; t < clusterTriangles(cluster); ++t)
		{
			const PnPatch patch = pnPatch(scene, cluster, t);
			if (std::any_of(patch.bulges.begin(), patch.bulges.end(), [](dvec3 bulge) { return bulge != dvec3(0); }))
				return true;
		}
		return false;
	};
	return !scene.directions.empty() && std::any_of(scene.clusters.begin(), scene.clusters.end(), isCurved);
}

}  // namespace tessera
