#include "verify/topology.h"

#include "reference/piece_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace tessera::verify
{

namespace
{

// Rounding of sums in double, over positions in float: far below any crack that shows, far above noise.
constexpr double kAreaRoom = 1e-9;

uint64_t keyOf(DomainPoint p)
{
	return uint64_t(p.u) << 32 | p.v;
}

bool isInner(DomainPoint p)
{
	return p.u != 0 && p.v != 0 && domainW(p) != 0;
}

bool onOneEdge(DomainPoint p, DomainPoint q)
{
	return (p.u == 0 && q.u == 0) || (p.v == 0 && q.v == 0) || (domainW(p) == 0 && domainW(q) == 0);
}

// Of the input: welded vertices, edges and faces, each instance for itself.
struct InputShape
{
	int64_t corners = 0;
	int64_t euler = 0;     // vertices - edges + faces
	bool oriented = true;  // neighbours are wound alike, so that areas have a sign
};

InputShape shapeOf(const reference::HostScene& scene, const MeshRecord& mesh)
{
	std::set<uint32_t> vertices;
	std::set<std::pair<uint32_t, uint32_t>> edges, walked;
	InputShape shape;
	int64_t faces = 0;
	for (uint32_t cluster = mesh.first_cluster; cluster < mesh.first_cluster + mesh.cluster_count; ++cluster)
		for (uint32_t t = 0; t < clusterTriangles(scene.built().clusters[cluster]); ++t, ++faces)
		{
			const BaseTriangle base = scene.base({ 0, cluster }, t);
			const uint32_t w[3] = { scene.built().weld_ids[base.v0], scene.built().weld_ids[base.v1], scene.built().weld_ids[base.v2] };
			vertices.insert(w, w + 3);
			for (int i = 0; i < 3; ++i)
			{
				edges.insert(std::minmax(w[i], w[(i + 1) % 3]));
				shape.oriented &= walked.insert({ w[i], w[(i + 1) % 3] }).second;
			}
		}
	shape.corners = int64_t(vertices.size());
	shape.euler = shape.corners - int64_t(edges.size()) + faces;
	return shape;
}

InputShape shapeOf(const reference::HostScene& scene)
{
	std::map<uint32_t, InputShape> by_mesh;
	InputShape sum;
	for (const Instance& instance : scene.built().instances)
	{
		const auto [found, is_new] = by_mesh.try_emplace(instance.mesh);
		if (is_new)
			found->second = shapeOf(scene, scene.built().meshes[instance.mesh]);
		sum.corners += found->second.corners;
		sum.euler += found->second.euler;
		sum.oriented &= found->second.oriented;
	}
	return sum;
}

}  // namespace

void Topology::addTriangle(std::span<const MicroTriangle> group)
{
	std::vector<uint64_t> points;
	std::vector<std::pair<uint64_t, uint64_t>> edges;
	for (const MicroTriangle& t : group)
	{
		if (t.domain[0].u == NO_INDEX || t.domain[1].u == NO_INDEX || t.domain[2].u == NO_INDEX)
			continue;
		const uint64_t keys[3] = { keyOf(t.domain[0]), keyOf(t.domain[1]), keyOf(t.domain[2]) };
		const bool collapsed = keys[0] == keys[1] || keys[1] == keys[2] || keys[2] == keys[0];
		collapsed_ += collapsed;
		triangles_ += !collapsed;
		for (uint32_t i = 0; i < 3; ++i)
		{
			if (isInner(t.domain[i]))
				points.push_back(keys[i]);
			if (keys[i] != keys[(i + 1) % 3] && !onOneEdge(t.domain[i], t.domain[(i + 1) % 3]))
				edges.push_back(std::minmax(keys[i], keys[(i + 1) % 3]));
		}
		const dvec3 p(t.displaced[0]), q(t.displaced[1]), r(t.displaced[2]);
		const dvec3 cross = glm::cross(q - p, r - p);
		vector_area_ += cross / 2.0;
		area_ += glm::length(cross) / 2;
		volume_ += glm::dot(p, cross) / 6;
	}
	std::sort(points.begin(), points.end());
	std::sort(edges.begin(), edges.end());
	inner_points_ += std::unique(points.begin(), points.end()) - points.begin();
	inner_edges_ += std::unique(edges.begin(), edges.end()) - edges.begin();
}

void Topology::addEdge(bool is_loop, uint64_t points)
{
	if (points < 2)
		return;
	edge_points_ += int64_t(points) - 2;
	edge_segments_ += int64_t(points) - 1;
	collapsed_ += is_loop;
}

void Topology::add(const Topology& other)
{
	inner_points_ += other.inner_points_;
	inner_edges_ += other.inner_edges_;
	edge_points_ += other.edge_points_;
	edge_segments_ += other.edge_segments_;
	triangles_ += other.triangles_;
	collapsed_ += other.collapsed_;
	vector_area_ += other.vector_area_;
	area_ += other.area_;
	volume_ += other.volume_;
}

void Topology::check(const reference::HostScene& scene, CheckResult& result) const
{
	const SceneTraits& traits = scene.built().traits;
	result.sums["micro-triangles"] += uint64_t(triangles_ + collapsed_);
	if (traits.boundary_edges > 0 || traits.nonmanifold_edges > 0 || traits.degenerate_triangles > 0)
		return;
	const InputShape input = shapeOf(scene);
	if (input.oriented)
	{
		result.measure("volume, mesh units cubed", volume_);
		const double open = area_ > 0 ? glm::length(vector_area_) / area_ : 0;
		result.measure("vector area over area", open);
		if (!(open <= kAreaRoom))
			result.violation(open, nowhere(fmt::format("the closed input's output has vector area {:.3g} of its area", open)));
	}
	// Slivers may collapse micro-triangles, which makes no hole but may take an edge or two along.
	const int64_t euler = input.corners + edge_points_ + inner_points_ - edge_segments_ - inner_edges_ + triangles_;
	if (collapsed_ == 0 && euler != input.euler)
		result.violation(std::abs(double(euler - input.euler)),
						 nowhere(fmt::format("Euler characteristic {}, the input's is {}", euler, input.euler)));
}

}  // namespace tessera::verify
