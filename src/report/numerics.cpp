#include "report/numerics.h"

#include "base/parallel.h"
#include "reference/double_surface.h"
#include "reference/evaluate.h"
#include "reference/watertight.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::report
{

namespace
{

double largest(dvec3 v)
{
	return std::max({ std::abs(v.x), std::abs(v.y), std::abs(v.z) });
}

// Of a float of this magnitude.
double ulpOf(double magnitude)
{
	const auto value = static_cast<float>(magnitude);
	return double(std::nextafter(value, std::numeric_limits<float>::infinity())) - double(value);
}

struct Worst
{
	double base = 0, displaced = 0, share = 0;

	void add(const Worst& other)
	{
		base = std::max(base, other.base);
		displaced = std::max(displaced, other.displaced);
		share = std::max(share, other.share);
	}
};

bool isFinite(vec3 p)
{
	return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

Worst compare(const reference::HostScene& scene, const View& view, const reference::DoubleSurface& surface, ClusterRef ref, uint32_t triangle,
			  DomainPoint point)
{
	const reference::MicroVertex vertex = reference::evaluatePoint(scene, view, ref, triangle, point);
	const reference::DoublePoint exact = surface.at(ref, triangle, point);
	if (!isFinite(vertex.displaced))
		return {};
	const BaseTriangle base = scene.base(ref, triangle);
	const auto& positions = scene.built().positions;
	const double size = std::max({ largest(positions[base.v0]), largest(positions[base.v1]), largest(positions[base.v2]) });
	const double base_error = largest(dvec3(vertex.base) - exact.base), displaced_error = largest(dvec3(vertex.displaced) - exact.displaced);
	const double share = exact.displaced_bound > 0 ? displaced_error / exact.displaced_bound : 0;
	return { base_error / ulpOf(size), displaced_error / ulpOf(std::max(size, largest(exact.displaced))), share };
}

// Every `stride`-th vertex of an instance.
Worst worstOf(const reference::HostScene& scene, const View& view, const reference::DoubleSurface& surface, const MicroMesh& mesh, uint32_t instance,
			  uint64_t stride)
{
	constexpr size_t kChunk = 1024;
	std::vector<uint32_t> base_of(mesh.positions.size());
	for (size_t t = 0; t < mesh.triangles.size(); ++t)
		for (int corner = 0; corner < 3; ++corner)
			base_of[mesh.triangles[t][corner]] = mesh.base_index[t];
	const size_t count = (mesh.positions.size() + stride - 1) / stride;
	std::vector<Worst> chunks((count + kChunk - 1) / kChunk);
	parallelFor(chunks.size(), [&](size_t chunk) {
		for (size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i)
		{
			const BaseRef base = mesh.bases[base_of[i * stride]];
			chunks[chunk].add(compare(scene, view, surface, { instance, base.cluster }, base.triangle, mesh.domain[i * stride]));
		}
	});
	Worst worst;
	for (const Worst& chunk : chunks)
		worst.add(chunk);
	return worst;
}

uint64_t withoutArea(const MicroMesh& mesh)
{
	uint64_t count = 0;
	for (const uvec3 t : mesh.triangles)
	{
		const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
		count += glm::length(glm::cross(b - a, c - a)) > 0 ? 0 : 1;
	}
	return count;
}

}  // namespace

Numerics measureNumerics(const reference::HostScene& scene, const View& view, const MicroScene& micro, uint64_t most_vertices)
{
	Numerics numerics;
	for (const MicroMesh& mesh : micro.instances)
	{
		numerics.vertices += mesh.positions.size();
		numerics.not_finite +=
			static_cast<uint64_t>(std::count_if(mesh.positions.begin(), mesh.positions.end(), [](vec3 p) { return !isFinite(p); }));
		numerics.zero_area_triangles += withoutArea(mesh);
	}
	const reference::DoubleSurface surface(scene, view);
	const uint64_t stride = numerics.vertices / std::max<uint64_t>(most_vertices, 1) + 1;
	Worst worst;
	for (uint32_t i = 0; i < micro.instances.size(); ++i)
		worst.add(worstOf(scene, view, surface, micro.instances[i], i, stride));
	numerics.worst_base_ulp = worst.base;
	numerics.worst_displaced_ulp = worst.displaced;
	numerics.worst_share_of_bound = worst.share;
	const reference::WatertightReport edges = reference::checkWatertight(scene, view, micro.pieces.full_clusters, micro.pieces.parts);
	numerics.shared_edges = edges.shared_edges;
	numerics.differing_edges = edges.differing_edges;
	numerics.edge_points = edges.points;
	numerics.first_problem = edges.first_problem;
	return numerics;
}

}  // namespace tessera::report
