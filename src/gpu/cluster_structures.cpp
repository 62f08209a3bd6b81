#include "gpu/cluster_structures.h"

#include "base/check.h"

namespace tessera
{

#ifdef VK_NV_cluster_acceleration_structure

namespace
{

struct OperationDesc
{
	VkClusterAccelerationStructureOpTypeNV type;
	uint32_t info_bytes;
};

OperationDesc descOf(ClusterOperation operation)
{
	switch (operation)
	{
	case ClusterOperation::BuildTemplates:
		return { VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_TEMPLATE_NV,
				 sizeof(VkClusterAccelerationStructureBuildTriangleClusterTemplateInfoNV) };
	case ClusterOperation::Instantiate:
		return { VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_INSTANTIATE_TRIANGLE_CLUSTER_NV,
				 sizeof(VkClusterAccelerationStructureInstantiateClusterInfoNV) };
	case ClusterOperation::BuildClusters:
		return { VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_NV,
				 sizeof(VkClusterAccelerationStructureBuildTriangleClusterInfoNV) };
	case ClusterOperation::BuildStructures:
		break;
	}
	return { VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_CLUSTERS_BOTTOM_LEVEL_NV,
			 sizeof(VkClusterAccelerationStructureBuildClustersBottomLevelInfoNV) };
}

VkClusterAccelerationStructureOpModeNV modeOf(ClusterDestination destination)
{
	switch (destination)
	{
	case ClusterDestination::Implicit:
		return VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_IMPLICIT_DESTINATIONS_NV;
	case ClusterDestination::Explicit:
		return VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_EXPLICIT_DESTINATIONS_NV;
	case ClusterDestination::SizesOnly:
		break;
	}
	return VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_COMPUTE_SIZES_NV;
}

// The input of an operation as the driver takes it, with what it points to.
struct Input
{
	explicit Input(const ClusterBuild& build)
	{
		triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
		triangles.maxClusterUniqueGeometryCount = 1;
		triangles.maxClusterTriangleCount = build.triangles_each;
		triangles.maxClusterVertexCount = build.vertices_each;
		triangles.maxTotalTriangleCount = build.triangles;
		triangles.maxTotalVertexCount = build.vertices;
		triangles.minPositionTruncateBitCount = build.truncated_bits;
		structures.maxTotalClusterCount = build.clusters;
		structures.maxClusterCountPerAccelerationStructure = build.clusters_each;
		info.maxAccelerationStructureCount = build.count;
		info.flags = build.flags;
		info.opType = descOf(build.operation).type;
		info.opMode = modeOf(build.destination);
		if (build.operation == ClusterOperation::BuildStructures)
			info.opInput.pClustersBottomLevel = &structures;
		else
			info.opInput.pTriangleClusters = &triangles;
	}
	Input(const Input&) = delete;
	Input& operator=(const Input&) = delete;

	VkClusterAccelerationStructureTriangleClusterInputNV triangles = { VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_TRIANGLE_CLUSTER_INPUT_NV };
	VkClusterAccelerationStructureClustersBottomLevelInputNV structures = {
		VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_CLUSTERS_BOTTOM_LEVEL_INPUT_NV
	};
	VkClusterAccelerationStructureInputInfoNV info = { VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_INPUT_INFO_NV };
};

VkStridedDeviceAddressRegionKHR arrayAt(uint64_t address, uint64_t stride, uint32_t count)
{
	return address == 0 ? VkStridedDeviceAddressRegionKHR{} : VkStridedDeviceAddressRegionKHR{ address, stride, stride * count };
}

}  // namespace

ClusterBuildSizes clusterBuildSizes(const Device& device, const ClusterBuild& build)
{
	const Input input(build);
	VkAccelerationStructureBuildSizesInfoKHR sizes = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR };
	device.functions.cluster_structure_sizes(device.handle, &input.info, &sizes);
	return { sizes.accelerationStructureSize, sizes.buildScratchSize };
}

void recordClusterBuild(const Device& device, VkCommandBuffer commands, const ClusterBuild& build, const ClusterBuildAddresses& addresses)
{
	const Input input(build);
	VkClusterAccelerationStructureCommandsInfoNV info = { VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_COMMANDS_INFO_NV };
	info.input = input.info;
	info.dstImplicitData = addresses.implicit;
	info.scratchData = addresses.scratch;
	info.dstAddressesArray = arrayAt(addresses.destinations, sizeof(uint64_t), build.count);
	info.dstSizesArray = arrayAt(addresses.sizes, sizeof(uint32_t), build.count);
	info.srcInfosArray = arrayAt(addresses.infos, descOf(build.operation).info_bytes, build.count);
	info.srcInfosCount = addresses.count;
	device.functions.build_cluster_structures(commands, &info);
}

#else

ClusterBuildSizes clusterBuildSizes(const Device&, const ClusterBuild&)
{
	CHECK(false, "built without {}", "VK_NV_cluster_acceleration_structure");
	return {};
}

void recordClusterBuild(const Device&, VkCommandBuffer, const ClusterBuild&, const ClusterBuildAddresses&)
{
	CHECK(false, "built without {}", "VK_NV_cluster_acceleration_structure");
}

#endif

}  // namespace tessera
