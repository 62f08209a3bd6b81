#include "verify/bounds_check.h"

#include "shared/bounds.h"

#include <fmt/format.h>

namespace tessera::verify
{

namespace
{

// Distance from a box; what is not a number lies outside.
double outside(const Box& box, vec3 p)
{
	const bool inside = p.x >= box.low.x && p.y >= box.low.y && p.z >= box.low.z && p.x <= box.high.x && p.y <= box.high.y && p.z <= box.high.z;
	if (inside)
		return 0;
	const dvec3 beyond = glm::max(glm::max(dvec3(box.low) - dvec3(p), dvec3(p) - dvec3(box.high)), dvec3(0));
	return std::max(glm::length(beyond), 1e-300);
}

bool sameCluster(ClusterRef a, ClusterRef b)
{
	return a.instance == b.instance && a.cluster == b.cluster;
}

// Checks one cluster of one instance; returns its box's diagonal over that of its micro-vertices, 0 when these span nothing.
double checkCluster(const Box& cluster_box, const Box& mesh_box, std::span<const MicroTriangle> cluster, CheckResult& result)
{
	vec3 low = cluster[0].displaced[0], high = low;
	for (const MicroTriangle& t : cluster)
		for (uint32_t i = 0; i < 3; ++i)
		{
			const vec3 p = t.displaced[i];
			low = glm::min(low, p);
			high = glm::max(high, p);
			for (const auto& [box, name] : { std::pair(&cluster_box, "cluster"), std::pair(&mesh_box, "mesh") })
				if (const double distance = outside(*box, p); distance > 0)
					result.violation(distance, { t.cluster,
												 t.triangle,
												 t.domain[i],
												 fmt::format("lies {:.3g} mesh units outside the bounds of its {}", distance, name),
												 {} });
		}
	const double reach = glm::length(dvec3(high) - dvec3(low));
	return reach > 0 ? glm::length(dvec3(cluster_box.high) - dvec3(cluster_box.low)) / reach : 0;
}

}  // namespace

CheckResult checkBounds(const reference::HostScene& scene, const View& view, std::span<const MicroTriangle> sorted)
{
	CheckResult result;
	const BuiltScene& built = scene.built();
	double sum = 0;
	uint64_t clusters = 0;
	for (size_t first = 0, i = 1; i <= sorted.size(); ++i)
	{
		if (i < sorted.size() && sameCluster(sorted[first].cluster, sorted[i].cluster))
			continue;
		const ClusterRef ref = sorted[first].cluster;
		const Box cluster_box = displacedBox(built.cluster_bounds[ref.cluster], view.displacement_scale, view.displacement_offset);
		const Box mesh_box = displacedBox(built.mesh_bounds[built.instances[ref.instance].mesh], view.displacement_scale, view.displacement_offset);
		const double ratio = checkCluster(cluster_box, mesh_box, sorted.subspan(first, i - first), result);
		first = i;
		if (ratio == 0)
			continue;
		sum += ratio;
		++clusters;
		result.measure("bound over reach of a cluster", ratio);
	}
	if (clusters > 0)
		result.measure("the same, mean of a frame", sum / double(clusters));
	result.sums["clusters within their bounds"] += clusters;
	return result;
}

}  // namespace tessera::verify
