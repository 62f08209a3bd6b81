#include "verify/usual_way.h"

#include "base/parallel.h"
#include "verify/watertight_check.h"

#include <algorithm>

namespace tessera::verify
{

namespace
{

vec3 basePosition(const BuiltScene& scene, const BaseTriangle& base, DomainPoint p, bool float_barycentrics)
{
	const vec3 &p0 = scene.positions[base.v0], &p1 = scene.positions[base.v1], &p2 = scene.positions[base.v2];
	const vec3 weights = domainWeights(p);
	const vec3 flat = float_barycentrics ? p2 + (p0 - p2) * weights.x + (p1 - p2) * weights.y : weightedVec3(p0, p1, p2, weights);
	if (!scene.traits.has_pn)
		return flat;
	const vec3 &n0 = scene.normals[base.v0], &n1 = scene.normals[base.v1], &n2 = scene.normals[base.v2];
	return pnPoint(flat, pnRises(p0, p1, p2, n0, n1, n2), n0, n1, n2, weights);
}

// The displaced point by nothing but the triangle's own vertices.
vec3 usualPoint(const reference::HostScene& scene, const View& view, ClusterRef ref, uint32_t triangle, DomainPoint p, bool float_barycentrics)
{
	const BuiltScene& built = scene.built();
	const BaseTriangle base = scene.base(ref, triangle);
	const vec3 point = basePosition(built, base, p, float_barycentrics);
	if (base.height_map == NO_INDEX)
		return point;
	const vec3 weights = domainWeights(p);
	const vec3 normal = weightedVec3(built.normals[base.v0], built.normals[base.v1], built.normals[base.v2], weights);
	const HeightSource source = ownHeightSource(triangleCorners(scene.surface(), base), base.height_map, weights);
	return displacedPoint(point, normalized(normal), displacementAt(scene.surface(), source, point, scene.placement(ref, view), view));
}

CheckResult cracksOf(const reference::HostScene& scene, const View& view, MicroSet set, bool float_barycentrics)
{
	constexpr size_t kChunk = 1024;
	parallelFor((set.size() + kChunk - 1) / kChunk, [&](size_t chunk) {
		for (size_t i = chunk * kChunk; i < std::min(set.size(), (chunk + 1) * kChunk); ++i)
			for (uint32_t corner = 0; corner < 3; ++corner)
				if (set[i].domain[corner].u != NO_INDEX)
					set[i].displaced[corner] = usualPoint(scene, view, set[i].cluster, set[i].triangle, set[i].domain[corner], float_barycentrics);
	});
	return checkWatertight(scene, set, false);
}

}  // namespace

void UsualWay::merge(const UsualWay& other)
{
	points += other.points;
	own_sides += other.own_sides;
	own_sides_gap = std::max(own_sides_gap, other.own_sides_gap);
	barycentrics += other.barycentrics;
	barycentrics_gap = std::max(barycentrics_gap, other.barycentrics_gap);
	lost = std::max(lost, other.lost);
}

UsualWay measureUsualWay(const reference::HostScene& scene, const View& view, std::span<const MicroTriangle> sorted)
{
	const MicroSet set(sorted.begin(), sorted.end());
	const CheckResult own_sides = cracksOf(scene, view, set, false), barycentrics = cracksOf(scene, view, set, true);
	const auto compared = own_sides.sums.find("edge points compared");
	return { compared == own_sides.sums.end() ? 0 : compared->second, own_sides.violations, own_sides.worst, barycentrics.violations,
			 barycentrics.worst };
}

uint64_t lostTheUsualWay(const FrameResult& result)
{
	uint64_t lost = 0;
	for (const ListStats& list : result.lists)
		if ((list.name == "part_triangles" || list.name == "split_triangles") && list.peak > list.capacity)
			lost += list.peak - list.capacity;
	return lost;
}

}  // namespace tessera::verify
