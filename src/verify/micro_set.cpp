#include "verify/micro_set.h"

#include "reference/evaluate.h"
#include "shared/visibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace tessera::verify
{

namespace
{

bool isBefore(DomainPoint a, DomainPoint b)
{
	return a.u != b.u ? a.u < b.u : a.v < b.v;
}

// The corner with the smallest domain point first; winding stays.
void turnToFirst(MicroTriangle& t)
{
	const auto first = std::min_element(t.domain.begin(), t.domain.end(), isBefore) - t.domain.begin();
	std::rotate(t.displaced.begin(), t.displaced.begin() + first, t.displaced.end());
	std::rotate(t.domain.begin(), t.domain.begin() + first, t.domain.end());
}

std::array<DomainPoint, 3> wholeTriangle()
{
	return { domainCorner(0), domainCorner(1), domainCorner(2) };
}

// Turns one item of the device into micro-triangles.
class ItemReader
{
public:
	ItemReader(const reference::HostScene& scene, const FrameDump& dump, const SceneOrder& order) : scene_(scene), dump_(dump), order_(order) {}

	void read(size_t index, MicroSet& set) const
	{
		const std::span<const DumpVertex> vertices = dump_.verticesOf(index);
		for (const DumpTriangle& triangle : dump_.trianglesOf(index))
		{
			std::array<const DumpVertex*, 3> corners;
			for (uint32_t i = 0; i < 3; ++i)
				corners[i] = &vertices[cornerOf(triangle, i)];
			MicroTriangle micro = dump_.isBatch(index) ? ofPart(triangle.payload, corners) : ofFullCluster(triangle.payload, corners);
			turnToFirst(micro);
			set.push_back(micro);
		}
	}

private:
	// Undoes what is turned over for mirrored instances, and takes the positions.
	void takeCorners(MicroTriangle& micro, std::array<const DumpVertex*, 3>& corners) const
	{
		if (scene_.instances()[micro.cluster.instance].mirrored != 0)
			std::swap(corners[0], corners[1]);
		for (uint32_t i = 0; i < 3; ++i)
			micro.displaced[i] = corners[i]->displaced;
	}

	MicroTriangle ofPart(uint32_t payload, std::array<const DumpVertex*, 3> corners) const
	{
		const DomainPiece& part = dump_.parts[corners[0]->owner];
		MicroTriangle micro = { order_(dump_.visible[part.visible_cluster]), part.triangle, payloadTriangle(payload), {}, {}, {} };
		micro.piece = { part.c0, part.c1, part.c2 };
		takeCorners(micro, corners);
		for (uint32_t i = 0; i < 3; ++i)
		{
			const bool own = payloadKind(payload) == KIND_PART_TRIANGLE && corners[i]->owner == payloadIndex(payload);
			micro.domain[i] = own ? DomainPoint{ corners[i]->u, corners[i]->v } : kNoPoint;
		}
		return micro;
	}

	MicroTriangle ofFullCluster(uint32_t payload, std::array<const DumpVertex*, 3> corners) const
	{
		MicroTriangle micro = { order_(dump_.visible[corners[0]->owner]), payloadTriangle(payload), 0, wholeTriangle(), {}, {} };
		takeCorners(micro, corners);
		const ClusterRecord& cluster = scene_.cluster(micro.cluster);
		const bool exists = micro.triangle < clusterTriangles(cluster);
		const uint32_t base = exists ? scene_.built().triangles[cluster.first_triangle + micro.triangle] : 0;
		for (uint32_t i = 0; i < 3; ++i)
		{
			const bool own = exists && payloadKind(payload) == KIND_FULL_CLUSTER && corners[i]->owner == payloadIndex(payload) &&
							 corners[i]->u == triangleVertex(base, i);
			micro.domain[i] = own ? domainCorner(i) : kNoPoint;
		}
		return micro;
	}

	const reference::HostScene& scene_;
	const FrameDump& dump_;
	const SceneOrder& order_;
};

// Any order does that puts identities first; all members are words without padding, and floats count as bits.
int compare(const MicroTriangle& a, const MicroTriangle& b)
{
	return std::memcmp(&a, &b, sizeof(MicroTriangle));
}

bool isLess(const MicroTriangle& a, const MicroTriangle& b)
{
	return compare(a, b) < 0;
}

bool sameTriangle(const MicroTriangle& a, const MicroTriangle& b)
{
	return a.cluster.instance == b.cluster.instance && a.cluster.cluster == b.cluster.cluster && a.triangle == b.triangle;
}

// How far two versions of one micro-triangle lie apart, mesh units.
double distanceOf(const MicroTriangle& a, const MicroTriangle& b)
{
	double largest = 0;
	for (uint32_t i = 0; i < 3; ++i)
	{
		const double distance = glm::length(dvec3(a.displaced[i]) - dvec3(b.displaced[i]));
		largest = distance <= largest ? largest : distance;  // what is not a number stays
	}
	return largest;
}

bool sameIdentity(const MicroTriangle& a, const MicroTriangle& b)
{
	return std::memcmp(&a, &b, offsetof(MicroTriangle, displaced)) == 0;
}

}  // namespace

void appendDump(const reference::HostScene& scene, const FrameDump& dump, const SceneOrder& order, MicroSet& set)
{
	const ItemReader reader(scene, dump, order);
	for (size_t item = 0; item < dump.items.size(); ++item)
		reader.read(item, set);
}

MicroSet referenceMicro(const reference::HostScene& scene, const View& view, const reference::Classified& classified)
{
	MicroSet set;
	set.reserve(classified.microTriangles());
	const auto add = [&](MicroTriangle micro, const reference::Evaluated& mesh, uint32_t t, const auto& domainAt) {
		for (uint32_t i = 0; i < 3; ++i)
		{
			const uint32_t v = mesh.triangles[t][int(i)];
			micro.displaced[i] = mesh.vertices[v].displaced;
			micro.domain[i] = domainAt(i, v);
		}
		turnToFirst(micro);
		set.push_back(micro);
	};
	for (const reference::ReferencePiece& part : classified.parts)
	{
		const reference::Evaluated mesh = reference::evaluatePart(scene, view, part);
		const DomainPiece& piece = part.piece;
		for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
			add({ part.cluster, piece.triangle, t, { piece.c0, piece.c1, piece.c2 }, {}, {} }, mesh, t,
				[&](uint32_t, uint32_t v) { return mesh.vertices[v].domain; });
	}
	for (const ClusterRef ref : classified.full_clusters)
	{
		const reference::Evaluated mesh = reference::evaluateFullCluster(scene, view, ref);
		for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
			add({ ref, t, 0, wholeTriangle(), {}, {} }, mesh, t, [](uint32_t corner, uint32_t) { return domainCorner(corner); });
	}
	return set;
}

void sortMicro(MicroSet& set)
{
	std::sort(set.begin(), set.end(), isLess);
}

std::vector<std::span<const MicroTriangle>> baseTriangles(std::span<const MicroTriangle> sorted)
{
	std::vector<std::span<const MicroTriangle>> groups;
	for (size_t first = 0, i = 1; i <= sorted.size(); ++i)
		if (i == sorted.size() || !sameTriangle(sorted[first], sorted[i]))
		{
			groups.push_back(sorted.subspan(first, i - first));
			first = i;
		}
	return groups;
}

CheckResult compareMicro(const MicroSet& expected, const MicroSet& found, const std::string& what)
{
	CheckResult result;
	result.sums["micro-triangles compared"] = expected.size();
	const auto report = [&](const MicroTriangle& t, double size, const std::string& text) {
		result.violation(size, { t.cluster, t.triangle, t.domain[0], text, {} });
	};
	size_t i = 0, j = 0;
	while (i < expected.size() || j < found.size())
	{
		const bool both = i < expected.size() && j < found.size();
		const int order = !both ? (i < expected.size() ? -1 : 1) : compare(expected[i], found[j]);
		if (order == 0)
			++i, ++j;
		else if (both && sameIdentity(expected[i], found[j]))
		{
			const double distance = distanceOf(expected[i], found[j]);
			report(expected[i++], distance, fmt::format("micro-triangle {} lies {:.3g} mesh units from {}", found[j].micro, distance, what));
			++j;
		}
		else if (order < 0)
			report(expected[i], 0, fmt::format("micro-triangle {} is missing: it is one of {}", expected[i].micro, what)), ++i;
		else
			report(found[j], 0, fmt::format("micro-triangle {} is none of {}", found[j].micro, what)), ++j;
	}
	return result;
}

}  // namespace tessera::verify
