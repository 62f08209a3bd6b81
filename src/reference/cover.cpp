#include "reference/cover.h"

#include "reference/evaluate.h"
#include "reference/piece_groups.h"

#include <fmt/format.h>

#include <set>

namespace tessera::reference
{

namespace
{

// A micro-edge; `turns` is +1 from p to q, -1 from q to p.
struct Segment
{
	uint64_t p, q;  // p < q
	int turns;
};

uint64_t keyOfPoint(DomainPoint p)
{
	return uint64_t(p.u) << 32 | p.v;
}

DomainPoint pointOf(uint64_t key)
{
	return { uint32_t(key >> 32), uint32_t(key) };
}

// Doubled, in domain units squared: at most 2^46.
int64_t doubledArea(DomainPoint p, DomainPoint q, DomainPoint r)
{
	const int64_t u1 = int64_t(q.u) - p.u, v1 = int64_t(q.v) - p.v;
	const int64_t u2 = int64_t(r.u) - p.u, v2 = int64_t(r.v) - p.v;
	return u1 * v2 - u2 * v1;
}

double sliverMeasure(const DomainPiece& piece)
{
	const uint32_t longest = std::max({ domainLength(piece.c0, piece.c1), domainLength(piece.c1, piece.c2), domainLength(piece.c2, piece.c0) });
	return longest == 0 ? 0 : std::abs(double(doubledArea(piece.c0, piece.c1, piece.c2))) / longest;
}

// Checks base triangle after base triangle.
class Checker
{
public:
	Checker(const HostScene& scene, CoverReport& report) : scene_(scene), report_(report) {}

	void check(std::span<const ReferencePiece> group)
	{
		++report_.base_triangles;
		segments_.clear();
		int64_t area = 0;
		for (const ReferencePiece& part : group)
		{
			if (!isValid(scene_, part))
			{
				++report_.invalid_parts;
				problem(part, "the part names something that does not exist");
				continue;
			}
			area += addPart(part);
		}
		if (area != int64_t(DOMAIN_SIZE) * DOMAIN_SIZE)
		{
			++report_.wrong_areas;
			problem(group[0], fmt::format("the areas of its micro-triangles add up to {:.9f} of its own", double(area) / 0x1p46));
		}
		checkSegments(group[0]);
	}

private:
	void problem(const ReferencePiece& at, std::string_view what)
	{
		if (report_.first_problem.empty())
			report_.first_problem =
				fmt::format("instance {} cluster {} triangle {}: {}", at.cluster.instance, at.cluster.cluster, at.piece.triangle, what);
	}

	int64_t addPart(const ReferencePiece& part)
	{
		evaluateDomain(scene_, part, mesh_);
		int64_t sum = 0;
		bool sliver = false;
		for (const uvec3 triangle : mesh_.triangles)
		{
			const DomainPoint p = mesh_.points[triangle.x], q = mesh_.points[triangle.y], r = mesh_.points[triangle.z];
			const int64_t area = doubledArea(p, q, r);
			sum += area;
			report_.negative_areas += area < 0;
			report_.zero_areas += area == 0;
			sliver = sliver || area <= 0;
			addSegment(p, q);
			addSegment(q, r);
			addSegment(r, p);
		}
		report_.micro_triangles += mesh_.triangles.size();
		if (sliver)
			report_.worst_sliver = std::max(report_.worst_sliver, sliverMeasure(part.piece));
		return sum;
	}

	void addSegment(DomainPoint p, DomainPoint q)
	{
		const uint64_t a = keyOfPoint(p), b = keyOfPoint(q);
		if (a < b)
			segments_.push_back({ a, b, 1 });
		else if (b < a)
			segments_.push_back({ b, a, -1 });
	}

	void checkSegments(const ReferencePiece& at)
	{
		std::sort(segments_.begin(), segments_.end(), [](const Segment& a, const Segment& b) { return a.p != b.p ? a.p < b.p : a.q < b.q; });
		int64_t walked[3] = { 0, 0, 0 };
		for (size_t i = 0; i < segments_.size();)
		{
			const Segment segment = segments_[i];
			int turns = 0;
			for (; i < segments_.size() && segments_[i].p == segment.p && segments_[i].q == segment.q; ++i)
				turns += segments_[i].turns;
			if (turns != 0 && !walkBorder(segment, turns, walked))
			{
				++report_.open_segments;
				const DomainPoint p = pointOf(segment.p), q = pointOf(segment.q);
				problem(at, fmt::format("the micro-edge ({}, {}) - ({}, {}) has no opposite", p.u, p.v, q.u, q.v));
			}
		}
		for (const int64_t length : walked)
			if (length != int64_t(DOMAIN_SIZE))
			{
				++report_.open_segments;
				problem(at, "the micro-edges along a border do not walk it exactly once");
			}
	}

	// False when the segment is not one forward step along a border.
	static bool walkBorder(const Segment& segment, int turns, int64_t (&walked)[3])
	{
		const DomainPoint p = pointOf(segment.p), q = pointOf(segment.q);
		for (uint32_t edge = 0; edge < 3; ++edge)
			if (isOnEdge(p, edge) && isOnEdge(q, edge))
			{
				const int64_t step = (int64_t(alongEdge(q, edge)) - int64_t(alongEdge(p, edge))) * turns;
				walked[edge] += step;
				return step > 0 && std::abs(turns) == 1;
			}
		return false;
	}

	const HostScene& scene_;
	CoverReport& report_;
	DomainMesh mesh_;
	std::vector<Segment> segments_;
};

void add(CoverReport& sum, const CoverReport& other)
{
	sum.base_triangles += other.base_triangles;
	sum.micro_triangles += other.micro_triangles;
	sum.invalid_parts += other.invalid_parts;
	sum.wrong_areas += other.wrong_areas;
	sum.open_segments += other.open_segments;
	sum.negative_areas += other.negative_areas;
	sum.zero_areas += other.zero_areas;
	sum.worst_sliver = std::max(sum.worst_sliver, other.worst_sliver);
	if (sum.first_problem.empty())
		sum.first_problem = other.first_problem;
}

using ClusterKey = std::pair<uint32_t, uint32_t>;

// Every visible cluster is full, or all of its triangles have parts; nothing else is drawn.
void checkClusters(const HostScene& scene, std::span<const ClusterRef> visible, std::span<const ClusterRef> full_clusters,
				   const std::vector<std::span<const ReferencePiece>>& groups, CoverReport& report)
{
	std::set<ClusterKey> visible_keys, full;
	for (const ClusterRef ref : visible)
		visible_keys.emplace(ref.instance, ref.cluster);
	for (const ClusterRef ref : full_clusters)
		if (!full.emplace(ref.instance, ref.cluster).second || !visible_keys.contains({ ref.instance, ref.cluster }))
			++report.repeated_clusters;
	uint64_t expected = 0;
	for (const ClusterKey& key : visible_keys)
		if (!full.contains(key))
			expected += clusterTriangles(scene.built().clusters[key.second]);

	std::set<std::array<uint32_t, 3>> covered;
	for (const auto group : groups)
	{
		const auto [instance, cluster] = group[0].cluster;
		if (full.contains({ instance, cluster }) || !visible_keys.contains({ instance, cluster }) ||
			!covered.insert({ instance, cluster, group[0].piece.triangle }).second)
			++report.repeated_clusters;
	}
	report.missing_triangles = expected - std::min<uint64_t>(expected, covered.size());
	if (report.first_problem.empty() && report.missing_triangles > 0)
		report.first_problem = fmt::format("{} base triangles of visible clusters are not drawn", report.missing_triangles);
	if (report.first_problem.empty() && report.repeated_clusters > 0)
		report.first_problem = fmt::format("{} clusters or base triangles are drawn twice, or without being visible", report.repeated_clusters);
}

}  // namespace

CoverReport checkCover(const HostScene& scene, std::span<const ClusterRef> visible, std::span<const ClusterRef> full_clusters,
					   std::span<const ReferencePiece> parts)
{
	const auto groups = groupsOf(parts);
	const auto chunks = inChunks<CoverReport>(groups.size(), 64, [&](CoverReport& chunk, size_t first, size_t end) {
		Checker checker(scene, chunk);
		for (size_t i = first; i < end; ++i)
			checker.check(groups[i]);
	});
	CoverReport report;
	for (const CoverReport& chunk : chunks)
		add(report, chunk);
	checkClusters(scene, visible, full_clusters, groups, report);
	return report;
}

}  // namespace tessera::reference
