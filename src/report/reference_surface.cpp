#include "report/reference_surface.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::report
{

namespace
{

constexpr double kStep = 1e-6;            // of a weight, for derivatives: far below a texel, far above what double rounds
constexpr uint32_t kMostCuts = 512;       // per edge of a base triangle in the coarse mesh
constexpr uint32_t kMostCurvedCuts = 16;  // of a PN triangle that is not displaced

dvec3 threeWeights(dvec2 w)
{
	return { w.x, w.y, 1 - w.x - w.y };
}

bool isInside(dvec2 w)
{
	return w.x >= 0 && w.y >= 0 && w.x + w.y <= 1;
}

// The nearest weights inside the triangle, in the metric of the weights.
dvec2 clamped(dvec2 w)
{
	if (isInside(w))
		return w;
	const dvec2 result = nearestWeights(dvec3(w, 0), dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 0));
	return { std::clamp(result.x, 0.0, 1.0), std::clamp(result.y, 0.0, 1.0 - std::clamp(result.x, 0.0, 1.0)) };
}

// Cuts per edge for a triangle that covers `texels` texels.
uint32_t cutsFor(double texels, double cuts_per_texel)
{
	if (texels <= 0)
		return 1;
	return static_cast<uint32_t>(std::clamp(std::ceil(std::sqrt(texels * cuts_per_texel)), 3.0, double(kMostCuts)));
}

}  // namespace

ReferenceSurface::ReferenceSurface(const reference::HostScene& scene, const View& view, uint32_t most_triangles)
	: scene_(scene), view_(view), surface_(scene, view_)
{
	const BuiltScene& built = scene.built();
	double texels = 0;
	for (uint32_t c = 0; c < built.clusters.size(); ++c)
		for (uint32_t t = 0; t < clusterTriangles(built.clusters[c]); ++t)
			texels += texelArea({ c, t });
	const double cuts_per_texel = std::min(4.0, most_triangles / std::max(texels, 1.0));
	if (built.traits.has_pn)
		least_cuts_ = static_cast<uint32_t>(
			std::clamp(std::sqrt(most_triangles / double(std::max<size_t>(built.triangles.size(), 1))), 1.0, double(kMostCurvedCuts)));
	coarse_.resize(built.meshes.size());
	for (size_t m = 0; m < built.meshes.size(); ++m)
		coarse_[m] = coarseOf(built.meshes[m], cuts_per_texel);
}

// Texels of the height map that a base triangle covers; 0 where it is not displaced.
double ReferenceSurface::texelArea(BaseRef ref) const
{
	const BaseTriangle base = baseTriangle(ref);
	if (base.height_map == NO_INDEX)
		return 0;
	const auto& uvs = scene_.built().uvs;
	const HeightMap& map = scene_.built().height_maps[base.height_map].record;
	const dvec2 size(map.width, map.height);
	const dvec2 a = (dvec2(uvs[base.v1]) - dvec2(uvs[base.v0])) * size, b = (dvec2(uvs[base.v2]) - dvec2(uvs[base.v0])) * size;
	return std::max(std::abs(a.x * b.y - a.y * b.x) / 2, 1e-3);
}

ReferenceSurface::Coarse ReferenceSurface::coarseOf(const MeshRecord& mesh, double cuts_per_texel) const
{
	Coarse coarse;
	std::vector<uint32_t> first_vertex, first_triangle, cuts;
	uint32_t vertices = 0, triangles = 0;
	for (uint32_t c = mesh.first_cluster; c < mesh.first_cluster + mesh.cluster_count; ++c)
		for (uint32_t t = 0; t < clusterTriangles(scene_.built().clusters[c]); ++t)
		{
			coarse.bases.push_back({ c, t });
			cuts.push_back(std::max(least_cuts_, cutsFor(texelArea({ c, t }), cuts_per_texel)));
			first_vertex.push_back(vertices);
			first_triangle.push_back(triangles);
			vertices += (cuts.back() + 1) * (cuts.back() + 2) / 2;
			triangles += cuts.back() * cuts.back();
		}
	if (triangles == 0)
		return coarse;
	std::vector<vec3> positions(vertices);
	std::vector<uvec3> corners(triangles);
	coarse.base_index.resize(triangles);
	coarse.weights.resize(triangles);
	parallelFor(coarse.bases.size(), [&](size_t i) {
		const BaseTriangle base = baseTriangle(coarse.bases[i]);
		const uint32_t n = cuts[i];
		const auto weightsAt = [n](uint32_t row, uint32_t column) {
			return vec2(float(column) / float(n), float(row) / float(n));
		};
		// Rows of constant second weight; row r has n + 1 - r points.
		const auto vertexAt = [&](uint32_t row, uint32_t column) {
			return first_vertex[i] + row * (n + 1) - row * (row - 1) / 2 + column;
		};
		uint32_t next = first_triangle[i];
		const auto add = [&](std::array<uvec2, 3> at) {
			for (int k = 0; k < 3; ++k)
			{
				corners[next][k] = vertexAt(at[size_t(k)].x, at[size_t(k)].y);
				coarse.weights[next][size_t(k)] = weightsAt(at[size_t(k)].x, at[size_t(k)].y);
			}
			coarse.base_index[next++] = static_cast<uint32_t>(i);
		};
		for (uint32_t row = 0; row <= n; ++row)
			for (uint32_t column = 0; column + row <= n; ++column)
			{
				positions[vertexAt(row, column)] = surface_.onFinestMip(base, threeWeights(weightsAt(row, column)));
				if (column + row < n)
					add({ uvec2(row, column), uvec2(row, column + 1), uvec2(row + 1, column) });
				if (column + row + 1 < n)
					add({ uvec2(row, column + 1), uvec2(row + 1, column + 1), uvec2(row + 1, column) });
			}
	});
	coarse.slack = 3 * meanDeviation(coarse, positions, corners);
	coarse.set.emplace_back(positions, corners);
	return coarse;
}

// Root mean square of how far the middles of the triangles lie from the surface there.
double ReferenceSurface::meanDeviation(const Coarse& coarse, const std::vector<vec3>& positions, const std::vector<uvec3>& corners) const
{
	constexpr size_t kChunk = 4096;
	std::vector<double> chunks((corners.size() + kChunk - 1) / kChunk);
	parallelFor(chunks.size(), [&](size_t chunk) {
		for (size_t t = chunk * kChunk; t < std::min(corners.size(), (chunk + 1) * kChunk); ++t)
		{
			const dvec3 middle = (dvec3(positions[corners[t].x]) + dvec3(positions[corners[t].y]) + dvec3(positions[corners[t].z])) / 3.0;
			const auto& w = coarse.weights[t];
			const dvec3 there = point({ coarse.bases[coarse.base_index[t]], (dvec2(w[0]) + dvec2(w[1]) + dvec2(w[2])) / 3.0 });
			const double squared = glm::dot(there - middle, there - middle);
			chunks[chunk] += std::isfinite(squared) ? squared : 0;
		}
	});
	double sum = 0;
	for (const double chunk : chunks)
		sum += chunk;
	return std::sqrt(sum / double(corners.size()));
}

uint64_t ReferenceSurface::triangleCount() const
{
	uint64_t count = 0;
	for (const Coarse& coarse : coarse_)
		count += coarse.base_index.size();
	return count;
}

dvec3 ReferenceSurface::point(const SurfaceSpot& spot) const
{
	return surface_.onFinestMip(baseTriangle(spot.base), threeWeights(spot.weights));
}

// Differences are taken away from the edges: there the heights may be another triangle's.
SurfaceFrame ReferenceSurface::frame(const SurfaceSpot& spot) const
{
	const BaseTriangle base = baseTriangle(spot.base);
	const dvec2 w = spot.weights;
	const auto at = [&](dvec2 weights) {
		return surface_.onFinestMip(base, threeWeights(weights));
	};
	// Moves towards the third corner when there is room, else away from it.
	const double u = w.x >= kStep ? -kStep : kStep, v = w.y >= kStep ? -kStep : kStep;
	const dvec3 here = at(w);
	return { here, (at({ w.x + u, w.y }) - here) / u, (at({ w.x, w.y + v }) - here) / v };
}

// Moves `spot` to the nearest point within its base triangle; returns its distance.
double ReferenceSurface::descend(dvec3 q, SurfaceSpot& spot) const
{
	constexpr int kMostSteps = 12, kMostHalvings = 4;
	constexpr double kSmallGain = 1e-6;  // relative; less is not worth another step
	double best = glm::length(point(spot) - q);
	for (int step = 0; step < kMostSteps && best > 0; ++step)
	{
		const SurfaceFrame here = frame(spot);
		const dvec3 to_q = q - here.point;
		const double uu = glm::dot(here.along_u, here.along_u), uv = glm::dot(here.along_u, here.along_v), vv = glm::dot(here.along_v, here.along_v);
		const double determinant = uu * vv - uv * uv;
		if (!(determinant > 1e-14 * uu * vv))
			break;
		const double ru = glm::dot(here.along_u, to_q), rv = glm::dot(here.along_v, to_q);
		dvec2 move = dvec2(vv * ru - uv * rv, uu * rv - uv * ru) / determinant;
		const double before = best;
		for (int halving = 0; halving <= kMostHalvings; ++halving, move *= 0.5)
		{
			const SurfaceSpot tried = { spot.base, clamped(spot.weights + move) };
			const double distance = glm::length(point(tried) - q);
			if (distance < best)
			{
				best = distance;
				spot = tried;
				break;
			}
		}
		if (!(best < before * (1 - kSmallGain)))
			break;
	}
	return best;
}

double ReferenceSurface::distance(uint32_t mesh, dvec3 q, const SurfaceSpot& start) const
{
	const Coarse& coarse = coarse_[mesh];
	double best = std::numeric_limits<double>::infinity();
	if (!coarse.set.empty())
		for (const NearestTriangle& near : coarse.set[0].nearestOfGroups(q, coarse.slack, coarse.base_index))
		{
			const auto& w = coarse.weights[near.triangle];
			const dvec2 weights = dvec2(w[0]) * near.weights.x + dvec2(w[1]) * near.weights.y + dvec2(w[2]) * (1 - near.weights.x - near.weights.y);
			SurfaceSpot spot = { coarse.bases[coarse.base_index[near.triangle]], clamped(weights) };
			best = std::min(best, descend(q, spot));
		}
	// The coarse mesh may miss what lies between its points.
	SurfaceSpot spot = start;
	return glm::length(point(start) - q) < best ? descend(q, spot) : best;
}

}  // namespace tessera::report
