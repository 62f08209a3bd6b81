#include "verify/holes_check.h"

#include "reference/piece_groups.h"

#include <fmt/format.h>

#include <algorithm>

namespace tessera::verify
{

namespace
{

constexpr double kWholeArea = double(DOMAIN_SIZE) * double(DOMAIN_SIZE);  // doubled

// A micro-edge; `turns` is +1 from p to q, -1 from q to p.
struct Segment
{
	uint64_t p, q;  // p < q
	int turns;
};

uint64_t keyOf(DomainPoint p)
{
	return uint64_t(p.u) << 32 | p.v;
}

DomainPoint pointOf(uint64_t key)
{
	return { uint32_t(key >> 32), uint32_t(key) };
}

bool isInside(DomainPoint p)
{
	return p.u <= DOMAIN_SIZE && p.v <= DOMAIN_SIZE - p.u;
}

// Doubled, in domain units squared: at most 2^46.
int64_t doubledArea(const std::array<DomainPoint, 3>& t)
{
	const int64_t u1 = int64_t(t[1].u) - t[0].u, v1 = int64_t(t[1].v) - t[0].v;
	const int64_t u2 = int64_t(t[2].u) - t[0].u, v2 = int64_t(t[2].v) - t[0].v;
	return u1 * v2 - u2 * v1;
}

bool isSliver(const std::array<DomainPoint, 3>& piece)
{
	const uint32_t longest = std::max({ domainLength(piece[0], piece[1]), domainLength(piece[1], piece[2]), domainLength(piece[2], piece[0]) });
	return std::abs(double(doubledArea(piece))) <= kSliver * longest;
}

// Checks base triangle after base triangle.
class Checker
{
public:
	explicit Checker(CheckResult& result) : result_(result) {}

	void check(std::span<const MicroTriangle> group)
	{
		++result_.sums["base triangles"];
		result_.sums["micro-triangles"] += group.size();
		at_ = &group[0];
		segments_.clear();
		int64_t area = 0;
		for (const MicroTriangle& t : group)
			area += addTriangle(t);
		if (area != int64_t(DOMAIN_SIZE) * DOMAIN_SIZE)
			problem(std::abs(double(area) / kWholeArea - 1), kNoPoint,
					fmt::format("its micro-triangles add up to {:.9f} of its area", double(area) / kWholeArea));
		checkSegments();
	}

private:
	void problem(double size, DomainPoint point, const std::string& what)
	{
		result_.violation(size, { at_->cluster, at_->triangle, point, what, {} });
	}

	int64_t addTriangle(const MicroTriangle& t)
	{
		if (!std::all_of(t.domain.begin(), t.domain.end(), isInside))
		{
			problem(0, kNoPoint, fmt::format("micro-triangle {} has a corner of another triangle", t.micro));
			return 0;
		}
		const int64_t area = doubledArea(t.domain);
		if (area <= 0 && isSliver(t.piece))
			++result_.sums["turned over or empty within slivers"];
		else if (area <= 0)
			problem(std::abs(double(area)) / kWholeArea, t.domain[0],
					fmt::format("micro-triangle {} has {} area", t.micro, area == 0 ? "no" : "negative"));
		for (uint32_t i = 0; i < 3; ++i)
			addSegment(t.domain[i], t.domain[(i + 1) % 3]);
		return area;
	}

	void addSegment(DomainPoint p, DomainPoint q)
	{
		const uint64_t a = keyOf(p), b = keyOf(q);
		if (a != b)
			segments_.push_back({ std::min(a, b), std::max(a, b), a < b ? 1 : -1 });
	}

	void checkSegments()
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
				const DomainPoint p = pointOf(segment.p), q = pointOf(segment.q);
				problem(double(domainLength(p, q)) / DOMAIN_SIZE, p, fmt::format("the micro-edge to ({}, {}) has no opposite", q.u, q.v));
			}
		}
		for (const int64_t length : walked)
			if (length != int64_t(DOMAIN_SIZE))
				problem(std::abs(double(length) / DOMAIN_SIZE - 1), kNoPoint, "the micro-edges along a border do not walk it exactly once");
	}

	// False when the segment is not one forward step along a border.
	static bool walkBorder(const Segment& segment, int turns, int64_t (&walked)[3])
	{
		const DomainPoint p = pointOf(segment.p), q = pointOf(segment.q);
		for (uint32_t edge = 0; edge < 3; ++edge)
			if (reference::isOnEdge(p, edge) && reference::isOnEdge(q, edge))
			{
				const int64_t step = (int64_t(reference::alongEdge(q, edge)) - int64_t(reference::alongEdge(p, edge))) * turns;
				walked[edge] += step;
				return step > 0 && std::abs(turns) == 1;
			}
		return false;
	}

	CheckResult& result_;
	const MicroTriangle* at_ = nullptr;
	std::vector<Segment> segments_;
};

// Base triangles of the scene that no micro-triangle names.
void checkMissing(const reference::HostScene& scene, std::span<const std::span<const MicroTriangle>> groups, CheckResult& result)
{
	std::map<std::pair<uint32_t, uint32_t>, std::vector<bool>> seen;
	for (const auto group : groups)
	{
		const ClusterRef ref = group[0].cluster;
		std::vector<bool>& triangles = seen[{ ref.instance, ref.cluster }];
		triangles.resize(std::max<size_t>(triangles.size(), group[0].triangle + 1));
		triangles[group[0].triangle] = true;
	}
	for (const ClusterRef ref : reference::allClusters(scene))
	{
		const auto found = seen.find({ ref.instance, ref.cluster });
		for (uint32_t t = 0; t < clusterTriangles(scene.cluster(ref)); ++t)
			if (found == seen.end() || t >= found->second.size() || !found->second[t])
				result.violation(1, { ref, t, kNoPoint, "the base triangle is not drawn", {} });
	}
}

}  // namespace

CheckResult checkHoles(const reference::HostScene& scene, std::span<const MicroTriangle> sorted)
{
	const auto groups = baseTriangles(sorted);
	const auto chunks = reference::inChunks<CheckResult>(groups.size(), 64, [&](CheckResult& chunk, size_t first, size_t end) {
		Checker checker(chunk);
		for (size_t i = first; i < end; ++i)
			checker.check(groups[i]);
	});
	CheckResult result;
	for (const CheckResult& chunk : chunks)
		result.merge(chunk);
	checkMissing(scene, groups, result);
	return result;
}

}  // namespace tessera::verify
