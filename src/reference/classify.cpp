#include "reference/classify.h"

#include "base/check.h"
#include "base/parallel.h"
#include "shared/edge_detail.h"

#include <algorithm>

namespace tessera::reference
{

namespace
{

// A corner of a triangle being classified: its domain point, and its undisplaced position relative to the eye.
struct Corner
{
	DomainPoint domain;
	vec3 relative;
};

struct Decision
{
	bool split;
	uint32_t a, b, c;  // factors, or pieces per edge of a split triangle

	bool isOne() const { return !split && a == 1 && b == 1 && c == 1; }
};

Decision decide(const Surface& surface, const EdgeBase& base, const Corner& p, const Corner& q, const Corner& r, const View& view, FactorRule rule)
{
	const EdgeView edge_a = edgeByMetric(surface, base, p.domain, q.domain, p.relative, q.relative, view);
	const EdgeView edge_b = edgeByMetric(surface, base, q.domain, r.domain, q.relative, r.relative, view);
	const EdgeView edge_c = edgeByMetric(surface, base, r.domain, p.domain, r.relative, p.relative, view);
	const uint32_t a = edgeFactor(edge_a, rule), b = edgeFactor(edge_b, rule), c = edgeFactor(edge_c, rule);
	if (a != 0 && b != 0 && c != 0)
		return { false, a, b, c };
	return { true, edgePieces(edge_a, rule), edgePieces(edge_b, rule), edgePieces(edge_c, rule) };
}

// Classifies cluster after cluster and appends to one result.
class Classifier
{
public:
	Classifier(const HostScene& scene, const View& view, FactorRule rule, uint32_t max_levels, Classified& result)
		: scene_(scene), view_(view), rule_(rule), max_levels_(max_levels), result_(result)
	{}

	void addCluster(ClusterRef ref, uint32_t visible_cluster)
	{
		ref_ = ref;
		cluster_ = scene_.cluster(ref);
		placement_ = scene_.placement(ref, view_);
		for (uint32_t v = 0; v < clusterVertices(cluster_); ++v)
			relative_[v] = placed(placement_, AT(vec3, scene_.surface().positions, cluster_.first_vertex + v));
		bool full = true;
		for (uint32_t t = 0; t < clusterTriangles(cluster_); ++t)
		{
			decisions_[t] = decide(scene_.surface(), edgeBase(t), baseCorner(t, 0), baseCorner(t, 1), baseCorner(t, 2), view_, rule_);
			full = full && decisions_[t].isOne();
		}
		if (full)
		{
			result_.full_clusters.push_back(ref);
			result_.full_cluster_triangles += clusterTriangles(cluster_);
			return;
		}
		for (uint32_t t = 0; t < clusterTriangles(cluster_); ++t)
		{
			base_ = scene_.base(ref, t);
			add(decisions_[t], domainCorner(0), domainCorner(1), domainCorner(2), visible_cluster, t, 0);
		}
	}

private:
	Corner baseCorner(uint32_t t, uint32_t corner) const
	{
		const uint32_t triangle = AT(uint32_t, scene_.surface().triangles, cluster_.first_triangle + t);
		return { domainCorner(corner), relative_[triangleVertex(triangle, corner)] };
	}

	EdgeBase edgeBase(uint32_t t) const
	{
		return { cluster_.first_triangle + t, placement_.inverse_scale_squared, placement_.triangle_reach, placement_.hidden_squared };
	}

	void add(Decision decision, DomainPoint p, DomainPoint q, DomainPoint r, uint32_t visible_cluster, uint32_t triangle, uint32_t level)
	{
		const DomainPiece piece = inPatternOrder({ p, q, r, visible_cluster, triangle, decision.a, decision.b, decision.c, 0 });
		if (!decision.split)
		{
			result_.parts.push_back({ ref_, piece });
			result_.part_micro_triangles += patternTriangles(scene_.pattern(piece));
			return;
		}
		result_.splits.push_back({ ref_, piece });
		if (result_.split_counts.size() <= level)
			result_.split_counts.resize(level + 1);
		++result_.split_counts[level];
		if (level < max_levels_)
			cut(piece, level);
		else
			++result_.uncut_triangles;
	}

	void cut(const DomainPiece& piece, uint32_t level)
	{
		const PatternRange pattern = scene_.pattern(piece);
		Corner corners[kMaxPatternVertices];
		const TriangleCorners base_corners = triangleCorners(scene_.surface(), base_);
		for (uint32_t v = 0; v < patternVertices(pattern); ++v)
		{
			const DomainPoint point = patternPoint(piece, v, pattern, scene_.table(), triangleEdgeFlags(base_.flags));
			corners[v] = { point, placed(placement_, weightedVec3(base_corners.position0, base_corners.position1, base_corners.position2,
																  domainWeights(point))) };
		}
		for (uint32_t t = 0; t < patternTriangles(pattern); ++t)
		{
			const uvec3 child = patternTriangle(t, pattern, scene_.table(), piece.mirror);
			const Corner &p = corners[child.x], &q = corners[child.y], &r = corners[child.z];
			add(decide(scene_.surface(), edgeBase(piece.triangle), p, q, r, view_, rule_), p.domain, q.domain, r.domain, piece.visible_cluster,
				piece.triangle, level + 1);
		}
	}

	const HostScene& scene_;
	const View& view_;
	FactorRule rule_;
	uint32_t max_levels_;
	Classified& result_;
	ClusterRef ref_ = {};
	ClusterRecord cluster_ = {};
	Placement placement_ = {};
	BaseTriangle base_ = {};
	vec3 relative_[128];
	Decision decisions_[128];
};

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from)
{
	to.insert(to.end(), from.begin(), from.end());
}

Classified joined(const std::vector<Classified>& chunks)
{
	Classified result;
	size_t part_count = 0, split_count = 0;
	for (const Classified& chunk : chunks)
	{
		part_count += chunk.parts.size();
		split_count += chunk.splits.size();
	}
	result.parts.reserve(part_count);
	result.splits.reserve(split_count);
	for (const Classified& chunk : chunks)
	{
		append(result.parts, chunk.parts);
		append(result.splits, chunk.splits);
		append(result.full_clusters, chunk.full_clusters);
		result.split_counts.resize(std::max(result.split_counts.size(), chunk.split_counts.size()));
		for (size_t level = 0; level < chunk.split_counts.size(); ++level)
			result.split_counts[level] += chunk.split_counts[level];
		result.uncut_triangles += chunk.uncut_triangles;
		result.part_micro_triangles += chunk.part_micro_triangles;
		result.full_cluster_triangles += chunk.full_cluster_triangles;
	}
	return result;
}

}  // namespace

Classified classify(const HostScene& scene, const View& view, FactorRule rule, std::span<const ClusterRef> visible, uint32_t max_levels)
{
	CHECK(rule.table_size >= 1 && rule.table_size <= scene.tableSize() && rule.max_split >= 2 && rule.max_split <= scene.tableSize(),
		  "table size {} of {}, max split {}", rule.table_size, scene.tableSize(), rule.max_split);
	constexpr size_t kChunk = 32;
	std::vector<Classified> chunks((visible.size() + kChunk - 1) / kChunk);
	parallelFor(chunks.size(), [&](size_t chunk) {
		Classifier classifier(scene, view, rule, max_levels, chunks[chunk]);
		for (size_t i = chunk * kChunk; i < std::min(visible.size(), (chunk + 1) * kChunk); ++i)
			classifier.addCluster(visible[i], static_cast<uint32_t>(i));
	});
	return joined(chunks);
}

}  // namespace tessera::reference
