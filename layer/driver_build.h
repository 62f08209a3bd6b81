// Bottom-level structures as the driver builds them: one geometry per cluster, so that a triangle's number is its number in the cluster.
#pragma once
#include "layer/operation.h"

namespace tessera::layer
{

// A structure to be built: its clusters, and what became of them.
struct DriverBuild
{
	std::vector<VkDeviceAddress> references;
	std::vector<Cluster> clusters;
	std::vector<VkAccelerationStructureGeometryKHR> geometries;
	std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
	std::vector<uint32_t> triangle_counts;
	VkAccelerationStructureBuildSizesInfoKHR sizes = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR };
	VkDeviceSize storage_offset = 0, scratch_offset = 0;
	BottomLevel made;
};

// Vertices and indices of all builds of a command.
struct DriverGeometry
{
	std::vector<Vertex> vertices;
	std::vector<uint32_t> indices;
};

// Adds the geometries of a build's clusters, and what shaders find out about them to the lookup table. False: out of memory.
bool addDriverGeometry(const Operation& operation, DriverBuild& build, DriverGeometry& all);

// Builds them all on the device, in memory of the layer. Fills `made` but for what the record says.
VkResult runDriverBuilds(const Operation& operation, std::span<DriverBuild> builds, const DriverGeometry& all);

}  // namespace tessera::layer
