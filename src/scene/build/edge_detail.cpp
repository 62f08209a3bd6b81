#include "scene/build/edge_detail.h"

#include "base/parallel.h"
#include "scene/build/detail_curves.h"
#include "scene/build/displaced_points.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace tessera
{

namespace
{

constexpr uint64_t kMostSamples = 8'000'000;  // about 0.2 us each, on one thread
constexpr uint32_t kCurvedLevel = 5;          // samples of PN triangles, whatever is displaced: their deviation falls by two octaves a level
constexpr uint32_t kChords = 16;
constexpr float kMostRoughness = 15;

// Clusters and their triangles, by the scene's order.
template <typename Visit>
void forEachTriangle(const BuiltScene& scene, const Visit& visit)
{
	parallelFor(scene.clusters.size(), [&](size_t index) {
		const ClusterRecord& cluster = scene.clusters[index];
		for (uint32_t t = 0; t < clusterTriangles(cluster); ++t)
			visit(cluster, t, cluster.first_triangle + t);
	});
}

// An edge of a triangle, by the welded vertices at its ends.
struct WeldedEdge
{
	uint64_t ends;
	uint32_t triangle;  // global
	uint32_t edge;
};

// Sorted by their ends: all edges that are one lie together.
std::vector<WeldedEdge> weldedEdges(const BuiltScene& scene)
{
	std::vector<WeldedEdge> edges;
	edges.reserve(3 * scene.triangles.size());
	for (const ClusterRecord& cluster : scene.clusters)
		for (uint32_t t = cluster.first_triangle; t < cluster.first_triangle + clusterTriangles(cluster); ++t)
			for (uint32_t edge = 0; edge < 3; ++edge)
			{
				const uint32_t flags = scene.triangles[t];
				const uint32_t a = scene.weld_ids[cluster.first_vertex + triangleVertex(flags, edge)];
				const uint32_t b = scene.weld_ids[cluster.first_vertex + triangleVertex(flags, (edge + 1) % 3)];
				const uint64_t ends = uint64_t(std::min(a, b)) << 32 | std::max(a, b);
				edges.push_back({ ends, t, edge });
			}
	std::sort(edges.begin(), edges.end(), [](const WeldedEdge& a, const WeldedEdge& b) {
		return std::pair(a.ends, 3ull * a.triangle + a.edge) < std::pair(b.ends, 3ull * b.triangle + b.edge);
	});
	return edges;
}

template <typename Visit>
void forEachGroup(std::span<const WeldedEdge> edges, const Visit& visit)
{
	for (size_t first = 0, end = 0; first < edges.size(); first = end)
	{
		while (end < edges.size() && edges[end].ends == edges[first].ends)
			++end;
		visit(edges.subspan(first, end - first));
	}
}

class DetailBuilder
{
public:
	explicit DetailBuilder(BuiltScene& scene) : scene_(scene), points_(scene), curves_(scene.triangles.size()), edge_curves_(3 * curves_.size()) {}

	void build()
	{
		findSamplesLevels();
		limitSamples();
		forEachTriangle(scene_, [&](const ClusterRecord& cluster, uint32_t t, uint32_t index) { measure(cluster, t, index); });
		forEachGroup(weldedEdges(scene_), [&](std::span<const WeldedEdge> group) {
			DetailCurve shared;
			for (const WeldedEdge& edge : group)
				shared.include(curves_[edge.triangle]);
			for (const WeldedEdge& edge : group)
				edge_curves_[3 * edge.triangle + edge.edge] = shared;
		});
		write();
	}

private:
	// Samples lie at most two thirds of a texel apart.
	void findSamplesLevels()
	{
		samples_levels_.resize(curves_.size());
		forEachTriangle(scene_, [&](const ClusterRecord& cluster, uint32_t t, uint32_t index) {
			const DisplacedPoints::Triangle triangle = points_.triangle(cluster, t);
			const double level = std::ceil(std::log2(1.5 * std::max(double(triangle.longest_texels), 1.0)));
			const double least = triangle.is_curved ? kCurvedLevel : kLeastSamplesLevel;
			samples_levels_[index] = triangle.moves ? uint32_t(std::clamp(level, least, double(kMostSamplesLevel))) : 0;
		});
	}

	void limitSamples()
	{
		for (uint32_t most = kMostSamplesLevel; most >= kLeastSamplesLevel; --most)
		{
			uint64_t count = 0;
			for (uint32_t& level : samples_levels_)
			{
				level = std::min(level, most);
				count += level ? sampleCount(level) : 0;
			}
			if (count <= kMostSamples)
				return;
		}
	}

	void measure(const ClusterRecord& cluster, uint32_t t, uint32_t index)
	{
		const uint32_t level = samples_levels_[index];
		if (level == 0)
			return;
		const DisplacedPoints::Triangle triangle = points_.triangle(cluster, t);
		const uint32_t shift = 23 - level;
		curves_[index] = measureCurve(level, [&](uint32_t i, uint32_t j) { return points_.at(triangle, { i << shift, j << shift }); });
	}

	// Codes above the bias in 8 bits: what is 2^-32 of the largest deviation or less counts as none.
	void write()
	{
		int largest = DetailCurve::kNone;
		for (const DetailCurve& curve : curves_)
			largest = std::max(largest, curve.codes[0]);
		for (size_t t = 0; t < curves_.size(); ++t)
		{
			TriangleDetail& record = scene_.triangle_details.emplace_back();
			record.bias = largest - 255;
			for (uint32_t e = 0; e < 4; ++e)
				pack(e < 3 ? edge_curves_[3 * t + e] : curves_[t], record.bias, &record.curves[2 * e]);
		}
	}

	static void pack(const DetailCurve& curve, int bias, uint32_t* words)
	{
		words[0] = words[1] = 0;
		for (uint32_t i = 0; i < 8; ++i)
			words[i / 4] |= uint32_t(std::clamp(curve.codes[i] - bias, 0, 255)) << (8 * (i % 4));
	}

	BuiltScene& scene_;
	DisplacedPoints points_;
	std::vector<uint32_t> samples_levels_;  // per triangle; 0: not displaced
	std::vector<DetailCurve> curves_;       // per triangle
	std::vector<DetailCurve> edge_curves_;  // per triangle and edge
};

float roughnessOf(const DisplacedPoints& points, const DisplacedPoints::Triangle& triangle, uint32_t edge)
{
	const DomainPoint from = domainCorner(edge), to = domainCorner((edge + 1) % 3);
	const auto at = [&](uint32_t k) {
		return dvec3(points.at(triangle, edgePoint(from, to, k, kChords, 7)));
	};
	double displaced = 0;
	for (uint32_t k = 0; k < kChords; ++k)
		displaced += glm::length(at(k + 1) - at(k));
	const vec3 corners[3] = { triangle.corners.position0, triangle.corners.position1, triangle.corners.position2 };
	const double length = glm::length(dvec3(corners[(edge + 1) % 3]) - dvec3(corners[edge]));
	if (!(length > 0))
		return 0;
	return float(std::clamp(displaced * displaced / (length * length) - 1, 0.0, double(kMostRoughness)));
}

}  // namespace

void buildEdgeDetails(BuiltScene& scene)
{
	if (!scene.uvs.empty() || scene.traits.has_pn)
		DetailBuilder(scene).build();
}

void buildEdgeRoughness(BuiltScene& scene)
{
	if (scene.uvs.empty() && !scene.traits.has_pn)
		return;
	scene.edge_roughness.assign(scene.triangles.size(), vec3(0));
	const DisplacedPoints points(scene);
	forEachTriangle(scene, [&](const ClusterRecord& cluster, uint32_t t, uint32_t index) {
		const DisplacedPoints::Triangle triangle = points.triangle(cluster, t);
		for (uint32_t edge = 0; edge < 3 && triangle.moves; ++edge)
			scene.edge_roughness[index][int(edge)] = roughnessOf(points, triangle, edge);
	});
	const std::vector<WeldedEdge> edges = weldedEdges(scene);
	forEachGroup(edges, [&](std::span<const WeldedEdge> group) {
		float largest = 0;
		for (const WeldedEdge& edge : group)
			largest = std::max(largest, scene.edge_roughness[edge.triangle][int(edge.edge)]);
		for (const WeldedEdge& edge : group)
			scene.edge_roughness[edge.triangle][int(edge.edge)] = largest;
		scene.most_roughness = std::max(scene.most_roughness, largest);
	});
}

}  // namespace tessera
