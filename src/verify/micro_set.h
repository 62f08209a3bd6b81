// The micro-triangles of a frame as a plain list: what the checks look at, whoever made it.
#pragma once
#include "frame/frame_dump.h"
#include "reference/classify.h"
#include "reference/host_scene.h"
#include "verify/check.h"

#include <array>

namespace tessera::verify
{

struct MicroTriangle
{
	ClusterRef cluster;
	uint32_t triangle;                  // of the cluster
	uint32_t micro;                     // of the part; 0 in full clusters
	std::array<DomainPoint, 3> piece;   // corners of the part in pattern order; the whole triangle in full clusters
	std::array<DomainPoint, 3> domain;  // its own corners, in the base triangle's winding, the smallest first; NO_INDEX: not known
	std::array<vec3, 3> displaced;      // mesh units
};
static_assert(sizeof(MicroTriangle) == 100 && std::is_trivially_copyable_v<MicroTriangle>, "compared as bytes");

using MicroSet = std::vector<MicroTriangle>;

// Which instance and cluster of the scene the device's own numbers stand for; empty: the same.
struct SceneOrder
{
	std::vector<uint32_t> instances, clusters;

	ClusterRef operator()(ClusterRef ref) const
	{
		return { instances.empty() ? ref.instance : instances[ref.instance], clusters.empty() ? ref.cluster : clusters[ref.cluster] };
	}
};

// Adds what the device drew in one round. Corners that belong to another triangle than the payload says get domain NO_INDEX.
void appendDump(const reference::HostScene& scene, const FrameDump& dump, const SceneOrder& order, MicroSet& set);

// The same from the CPU's float reference.
MicroSet referenceMicro(const reference::HostScene& scene, const View& view, const reference::Classified& classified);

// By instance, cluster, triangle, then the rest: equal sets become equal lists.
void sortMicro(MicroSet& set);

// Runs of micro-triangles of one base triangle in a sorted set.
std::vector<std::span<const MicroTriangle>> baseTriangles(std::span<const MicroTriangle> sorted);

// Every micro-triangle that only one of two sorted sets has is a violation. `what` says what they are, such as "the CPU's".
CheckResult compareMicro(const MicroSet& expected, const MicroSet& found, const std::string& what);

}  // namespace tessera::verify
