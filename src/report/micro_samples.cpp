#include "report/micro_samples.h"

#include "report/sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera::report
{

namespace
{

bool isFinite(dvec3 p)
{
	return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

dvec3 blend(dvec3 a, dvec3 b, dvec3 c, dvec2 w)
{
	return a * w.x + b * w.y + c * (1 - w.x - w.y);
}

double degreesBetween(dvec3 a, dvec3 b)
{
	return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * (180 / std::numbers::pi);
}

}  // namespace

double pxPerWorld(const View& view, dvec3 from_eye)
{
	const double focal_px = double(view.focal_y) * view.height_px / 2;
	if (view.distance_weight == 0)
		return focal_px * view.unit;
	return focal_px / std::max(glm::length(from_eye), double(view.near) / view.unit);
}

dvec3 eyeOf(const View& view)
{
	return dvec3(view.eye_high) + dvec3(view.eye_low);
}

SurfacePair::SurfacePair(const reference::HostScene& scene, const View& view, const ReferenceSurface& surface, const MicroScene& micro)
	: scene_(scene), view_(view), surface_(surface), micro_(micro), eye_(eyeOf(view))
{
	double area = 0;
	areas_.reserve(micro.triangleCount());
	for (size_t i = 0; i < micro.instances.size(); ++i)
	{
		const MicroMesh& mesh = micro.instances[i];
		dmat4 placement = scene.built().instances[i].world;
		placement[3] -= dvec4(eye_, 0);
		placements_.push_back(placement);
		const dmat3 linear = dmat3(placement);
		world_per_mesh_.push_back(std::sqrt((glm::dot(linear[0], linear[0]) + glm::dot(linear[1], linear[1]) + glm::dot(linear[2], linear[2])) / 3));
		sets_.emplace_back(mesh.positions, mesh.triangles);
		first_triangle_.push_back(areas_.size());
		for (const uvec3 t : mesh.triangles)
		{
			const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
			const double own = glm::length(glm::cross(linear * (b - a), linear * (c - a))) / 2;
			area += std::isfinite(own) ? own : 0;
			areas_.push_back(area);
		}
	}
	placed_ = std::make_unique<PlacedSets>(sets_, placements_);
}

MicroSpot SurfacePair::spotAt(double share, dvec2 within) const
{
	const uint64_t index = pieceAt(areas_, share);
	const auto instance =
		static_cast<uint32_t>(std::upper_bound(first_triangle_.begin(), first_triangle_.end(), index) - first_triangle_.begin() - 1);
	return { instance, static_cast<uint32_t>(index - first_triangle_[instance]), spreadOverTriangle(within) };
}

SurfacePair::Corners SurfacePair::cornersOf(const MicroSpot& spot) const
{
	const MicroMesh& mesh = micro_.instances[spot.instance];
	const uvec3 t = mesh.triangles[spot.triangle];
	return { mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z] };
}

std::optional<MicroSpot> SurfacePair::spotSeenAt(dvec2 pixel) const
{
	const dvec2 on_screen = { (pixel.x / view_.width_px * 2 - 1) / view_.focal_x, (1 - pixel.y / view_.height_px * 2) / view_.focal_y };
	const dvec3 across = dvec3(view_.right) * on_screen.x + dvec3(view_.up) * on_screen.y;
	const bool perspective = view_.distance_weight != 0;
	const dvec3 origin = perspective ? dvec3(0) : across / double(view_.unit);
	const dvec3 direction = perspective ? dvec3(view_.forward) + across : dvec3(view_.forward);
	const auto isShown = [&](const RayHit& hit) {
		const MicroMesh& mesh = micro_.instances[hit.mesh];
		const uint32_t cluster = mesh.bases[mesh.base_index[hit.triangle]].cluster;
		if (scene_.built().materials[scene_.built().clusters[cluster].material].double_sided)
			return true;
		const Corners corners = cornersOf({ hit.mesh, hit.triangle, {} });
		const dmat3 linear = dmat3(placements_[hit.mesh]);
		const dvec3 normal = glm::cross(linear * (corners.b - corners.a), linear * (corners.c - corners.a));
		return glm::dot(normal, direction) * glm::determinant(linear) < 0;
	};
	const std::optional<RayHit> hit = placed_->firstHit(origin, direction, double(view_.near) / view_.unit, isShown);
	return hit ? std::optional(MicroSpot{ hit->mesh, hit->triangle, hit->weights }) : std::nullopt;
}

// Also the area of the micro-triangle in the weights of its base triangle, doubled.
SurfaceSpot SurfacePair::referenceSpot(const MicroSpot& spot, double& domain_area) const
{
	const MicroMesh& mesh = micro_.instances[spot.instance];
	const uvec3 t = mesh.triangles[spot.triangle];
	const auto weightsOf = [&](uint32_t vertex) {
		const DomainPoint p = mesh.domain[vertex];
		return dvec3(p.u, p.v, 0) / double(DOMAIN_SIZE);
	};
	const dvec3 a = weightsOf(t.x), b = weightsOf(t.y), c = weightsOf(t.z);
	domain_area = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
	return { mesh.bases[mesh.base_index[spot.triangle]], dvec2(blend(a, b, c, spot.weights)) };
}

std::optional<Sample> SurfacePair::measure(const MicroSpot& spot) const
{
	const Corners corners = cornersOf(spot);
	const dvec3 tessellated = blend(corners.a, corners.b, corners.c, spot.weights);
	const dvec3 facet = glm::cross(corners.b - corners.a, corners.c - corners.a);
	double domain_area = 0;
	const SurfaceSpot reference_spot = referenceSpot(spot, domain_area);
	const SurfaceFrame reference = surface_.frame(reference_spot);
	const double facet_area = glm::length(facet);
	if (!isFinite(tessellated) || !isFinite(reference.point) || !(facet_area > 0))
		return std::nullopt;

	Sample sample;
	sample.spot = spot;
	const double trivial = glm::length(tessellated - reference.point);
	const std::optional<NearestTriangle> nearest = sets_[spot.instance].nearest(reference.point, trivial * (1 + 1e-9));
	sample.to_tessellated = nearest ? std::min(nearest->distance, trivial) : trivial;
	sample.to_reference = surface_.distance(scene_.built().instances[spot.instance].mesh, tessellated, reference_spot);
	const dvec3 normal = reference.normal();
	sample.area_ratio = glm::length(normal) * domain_area / facet_area;
	sample.normal_deviation = degreesBetween(normal, facet);
	sample.world_per_mesh = world_per_mesh_[spot.instance];
	sample.px_per_world = pxPerWorld(view_, dvec3(placements_[spot.instance] * dvec4(reference.point, 1)));
	return sample;
}

}  // namespace tessera::report
