// Cluster acceleration structures (VK_NV_cluster_acceleration_structure): templates, clusters made of them or of triangles, and bottom-level
// structures of clusters. Sizes, and how builds are recorded; all memory is the caller's. Nothing here may be called on a device whose gate is
// closed.
#pragma once
#include "gpu/resources.h"

namespace tessera
{

enum class ClusterOperation
{
	BuildTemplates,   // infos: VkClusterAccelerationStructureBuildTriangleClusterTemplateInfoNV
	Instantiate,      // VkClusterAccelerationStructureInstantiateClusterInfoNV
	BuildClusters,    // VkClusterAccelerationStructureBuildTriangleClusterInfoNV
	BuildStructures,  // VkClusterAccelerationStructureBuildClustersBottomLevelInfoNV
};

enum class ClusterDestination
{
	Implicit,   // one range of memory, which the driver deals out
	Explicit,   // an address for each
	SizesOnly,  // nothing is built: sizes are computed
};

// The most that one recording of an operation may meet: sizes follow from it.
struct ClusterBuild
{
	ClusterOperation operation = ClusterOperation::BuildClusters;
	ClusterDestination destination = ClusterDestination::Explicit;
	VkBuildAccelerationStructureFlagsKHR flags = 0;
	uint32_t count = 1;  // templates, clusters or structures
	// Of templates and clusters: each, and all together.
	uint32_t triangles_each = 0, vertices_each = 0, triangles = 0, vertices = 0;
	uint32_t truncated_bits = 0;
	// Of structures: clusters of each, and of all together.
	uint32_t clusters_each = 0, clusters = 0;
};

// What the device reads and writes: addresses of arrays without gaps.
struct ClusterBuildAddresses
{
	uint64_t infos = 0;
	uint64_t count = 0;         // of a 32-bit number of infos, at most ClusterBuild::count; 0: so many
	uint64_t destinations = 0;  // 64-bit addresses: read where they are explicit, else written
	uint64_t sizes = 0;         // 32-bit bytes of each, written; 0: not wanted
	uint64_t implicit = 0;      // memory that is dealt out
	uint64_t scratch = 0;
};

struct ClusterBuildSizes
{
	uint64_t bytes = 0;  // of all with implicit destinations
	uint64_t scratch_bytes = 0;
};
ClusterBuildSizes clusterBuildSizes(const Device& device, const ClusterBuild& build);

void recordClusterBuild(const Device& device, VkCommandBuffer commands, const ClusterBuild& build, const ClusterBuildAddresses& addresses);

// The address at or after this one with such an alignment, a power of two.
inline uint64_t alignedUp(uint64_t address, uint64_t alignment)
{
	return (address + alignment - 1) / alignment * alignment;
}

}  // namespace tessera
