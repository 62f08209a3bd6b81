#include "layer/sizes.h"

#include "layer/device.h"

#include <algorithm>

namespace tessera::layer
{

namespace
{

constexpr VkDeviceSize kScratchBase = 4096, kScratchPerStructure = 64, kScratchPerTriangle = 32;

VkDeviceSize triangleStructures(const ClusterInput& input)
{
	const RecordKind kind = kindOf(input);
	const auto& limits = input.triangles;
	// Whether triangles have geometry indices and flags of their own stands in the arguments only.
	const auto bytes = [&](uint64_t triangles, uint64_t vertices) {
		return kind == RecordKind::Template ? templateBytes(triangles, vertices, true) : clusterBytes(triangles, vertices, true);
	};
	const VkDeviceSize count = input.info.maxAccelerationStructureCount, alignment = alignmentOf(kind);
	const VkDeviceSize head = bytes(0, 0) + (alignment - 1) + sizeof(uint32_t);
	const VkDeviceSize by_totals = count * head + bytes(limits.maxTotalTriangleCount, limits.maxTotalVertexCount);
	const VkDeviceSize by_each = count * alignUp(bytes(limits.maxClusterTriangleCount, limits.maxClusterVertexCount), alignment);
	return alignUp(std::min(by_totals, by_each), alignment);
}

VkDeviceSize bottomLevelStructures(const ClusterInput& input)
{
	const VkDeviceSize count = input.info.maxAccelerationStructureCount, alignment = alignmentOf(RecordKind::BottomLevel);
	const VkDeviceSize by_totals =
		count * (bottomLevelBytes(0) + alignment - 1) + sizeof(VkDeviceAddress) * VkDeviceSize(input.bottom_level.maxTotalClusterCount);
	const VkDeviceSize by_each = count * alignUp(bottomLevelBytes(input.bottom_level.maxClusterCountPerAccelerationStructure), alignment);
	return alignUp(std::min(by_totals, by_each), alignment);
}

}  // namespace

RecordKind kindOf(const ClusterInput& input)
{
	switch (input.type())
	{
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_CLUSTERS_BOTTOM_LEVEL_NV:
		return RecordKind::BottomLevel;
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_TEMPLATE_NV:
		return RecordKind::Template;
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_MOVE_OBJECTS_NV:
		return static_cast<RecordKind>(input.move.type);
	default:
		return RecordKind::Cluster;
	}
}

VkDeviceSize alignmentOf(RecordKind kind)
{
	const auto properties = clusterProperties();
	switch (kind)
	{
	case RecordKind::BottomLevel:
		return properties.clusterBottomLevelByteAlignment;
	case RecordKind::Template:
		return properties.clusterTemplateByteAlignment;
	default:
		return properties.clusterByteAlignment;
	}
}

const char* nameOf(VkClusterAccelerationStructureOpTypeNV type)
{
	switch (type)
	{
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_MOVE_OBJECTS_NV:
		return "move objects";
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_CLUSTERS_BOTTOM_LEVEL_NV:
		return "build clusters bottom level";
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_NV:
		return "build triangle cluster";
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_TEMPLATE_NV:
		return "build triangle cluster template";
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_INSTANTIATE_TRIANGLE_CLUSTER_NV:
		return "instantiate triangle cluster";
	default:
		return "unknown operation";
	}
}

size_t infoBytes(VkClusterAccelerationStructureOpTypeNV type)
{
	switch (type)
	{
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_MOVE_OBJECTS_NV:
		return sizeof(VkClusterAccelerationStructureMoveObjectsInfoNV);
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_CLUSTERS_BOTTOM_LEVEL_NV:
		return sizeof(VkClusterAccelerationStructureBuildClustersBottomLevelInfoNV);
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_NV:
		return sizeof(VkClusterAccelerationStructureBuildTriangleClusterInfoNV);
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_TEMPLATE_NV:
		return sizeof(VkClusterAccelerationStructureBuildTriangleClusterTemplateInfoNV);
	default:
		return sizeof(VkClusterAccelerationStructureInstantiateClusterInfoNV);
	}
}

std::optional<VertexLayout> vertexLayout(VkFormat format)
{
	switch (format)
	{
	case VK_FORMAT_R32G32B32_SFLOAT:
		return VertexLayout{ 12, 4, 3 };
	case VK_FORMAT_R32G32B32A32_SFLOAT:
		return VertexLayout{ 16, 4, 4 };
	case VK_FORMAT_R32G32_SFLOAT:
		return VertexLayout{ 8, 4, 2 };
	case VK_FORMAT_R16G16B16A16_SNORM:
		return VertexLayout{ 8, 2, 4 };
	case VK_FORMAT_R16G16_SNORM:
		return VertexLayout{ 4, 2, 2 };
	default:
		return std::nullopt;
	}
}

Sizes sizesOf(const ClusterInput& input)
{
	const VkDeviceSize count = input.info.maxAccelerationStructureCount;
	Sizes sizes;
	sizes.scratch = kScratchBase + kScratchPerStructure * count;
	switch (input.type())
	{
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_MOVE_OBJECTS_NV:
		sizes.structures = input.move.maxMovedBytes;
		break;
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_CLUSTERS_BOTTOM_LEVEL_NV:
		sizes.structures = bottomLevelStructures(input);
		sizes.scratch += kScratchPerStructure * input.bottom_level.maxTotalClusterCount;
		break;
	default:
		sizes.structures = triangleStructures(input);
		sizes.scratch += kScratchPerTriangle * input.triangles.maxTotalTriangleCount;
	}
	sizes.scratch = alignUp(sizes.scratch, clusterProperties().clusterScratchByteAlignment);
	return sizes;
}

VKAPI_ATTR void VKAPI_CALL getClusterAccelerationStructureBuildSizes(VkDevice handle, const VkClusterAccelerationStructureInputInfoNV* info,
																	 VkAccelerationStructureBuildSizesInfoKHR* out)
{
	Device& device = deviceOf(handle);
	const ClusterInput input = copyOf(*info);
	checkInput(device, input, "vkGetClusterAccelerationStructureBuildSizesNV");
	if (out->sType != VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR)
		device.report.violation("struct-type", "vkGetClusterAccelerationStructureBuildSizesNV: pSizeInfo has sType {}, right is {}", int(out->sType),
								int(VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR));
	const Sizes sizes = sizesOf(input);
	out->accelerationStructureSize = sizes.structures;
	out->buildScratchSize = out->updateScratchSize = sizes.scratch;
}

}  // namespace tessera::layer
