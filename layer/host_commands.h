// Commands that the layer executes on the host, as they were recorded: copies of everything that their structures point to.
#pragma once
#include <vulkan/vulkan.h>

#include <memory>
#include <vector>

namespace tessera::layer
{

struct Device;
struct HostContext;

// The input of a cluster command with whatever its opInput pointed to.
struct ClusterInput
{
	VkClusterAccelerationStructureInputInfoNV info = {};
	VkClusterAccelerationStructureClustersBottomLevelInputNV bottom_level = {};
	VkClusterAccelerationStructureTriangleClusterInputNV triangles = {};
	VkClusterAccelerationStructureMoveObjectsInputNV move = {};

	VkClusterAccelerationStructureOpTypeNV type() const { return info.opType; }
	VkClusterAccelerationStructureOpModeNV mode() const { return info.opMode; }
};

struct ClusterCommand
{
	ClusterInput input;
	VkClusterAccelerationStructureCommandsInfoNV info = {};  // its input's pointers are not used
};

// One top-level structure of a vkCmdBuildAccelerationStructuresKHR.
struct TopLevelBuild
{
	VkAccelerationStructureBuildGeometryInfoKHR info = {};  // its pointers are not used
	std::vector<VkAccelerationStructureGeometryKHR> geometries;
	std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
};

// vkCmdCopyAccelerationStructureKHR between top-level structures: the driver copies, the layer notes that they have the same instances.
struct CopyOfStructure
{
	VkAccelerationStructureKHR source = VK_NULL_HANDLE, destination = VK_NULL_HANDLE;
};

// Copies the input; the structure that opInput points to is chosen by the type of operation.
ClusterInput copyOf(const VkClusterAccelerationStructureInputInfoNV& info);

VkResult execute(const HostContext& context, const ClusterCommand& command);
VkResult execute(const HostContext& context, const TopLevelBuild& build);
VkResult execute(const HostContext& context, const CopyOfStructure& copy);

VKAPI_ATTR void VKAPI_CALL cmdBuildClusterAccelerationStructureIndirect(VkCommandBuffer buffer,
																		const VkClusterAccelerationStructureCommandsInfoNV* info);
VKAPI_ATTR void VKAPI_CALL cmdBuildAccelerationStructures(VkCommandBuffer buffer, uint32_t count,
														  const VkAccelerationStructureBuildGeometryInfoKHR* infos,
														  const VkAccelerationStructureBuildRangeInfoKHR* const* ranges);
VKAPI_ATTR void VKAPI_CALL cmdBuildAccelerationStructuresIndirect(VkCommandBuffer buffer, uint32_t count,
																  const VkAccelerationStructureBuildGeometryInfoKHR* infos,
																  const VkDeviceAddress* addresses, const uint32_t* strides,
																  const uint32_t* const* most);
VKAPI_ATTR VkResult VKAPI_CALL buildAccelerationStructures(VkDevice device, VkDeferredOperationKHR deferred, uint32_t count,
														   const VkAccelerationStructureBuildGeometryInfoKHR* infos,
														   const VkAccelerationStructureBuildRangeInfoKHR* const* ranges);
VKAPI_ATTR void VKAPI_CALL cmdCopyAccelerationStructure(VkCommandBuffer buffer, const VkCopyAccelerationStructureInfoKHR* info);
VKAPI_ATTR void VKAPI_CALL getClusterAccelerationStructureBuildSizes(VkDevice device, const VkClusterAccelerationStructureInputInfoNV* info,
																	 VkAccelerationStructureBuildSizesInfoKHR* sizes);

}  // namespace tessera::layer
