// vkCmdBuildClusterAccelerationStructureIndirectNV: recorded as a copy, executed when the queue comes to it.
#include "layer/operation.h"

#include <algorithm>

namespace tessera::layer
{

namespace
{

constexpr VkBufferUsageFlags kInputUsage = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;

// Replaces each address that is given by the address where it stands.
VkResult resolveAddresses(Operation& operation)
{
	const VkFlags flags = operation.info.addressResolutionFlags;
	if (flags & ~0x3fu)
		operation.report().violation("resolution-flags", "{}: addressResolutionFlags {:#x} have unknown bits", operation.name(), flags);
	VkDeviceAddress* const addresses[] = { &operation.info.dstImplicitData,
										   &operation.info.scratchData,
										   &operation.info.dstAddressesArray.deviceAddress,
										   &operation.info.dstSizesArray.deviceAddress,
										   &operation.info.srcInfosArray.deviceAddress,
										   &operation.info.srcInfosCount };
	Reads reads;
	std::vector<std::pair<VkDeviceAddress*, size_t>> found;
	for (uint32_t bit = 0; bit < 6; ++bit)
		if (flags >> bit & 1u)
		{
			checkAlignment(operation, "resolution", *addresses[bit], 8, fmt::format("the address that flag {:#x} resolves", 1u << bit));
			const auto place =
				placeOf(operation, "resolution", *addresses[bit], 8, 0, fmt::format("the address that flag {:#x} resolves", 1u << bit));
			if (place)
				found.emplace_back(addresses[bit], reads.add(*place, 8));
			else
				*addresses[bit] = 0;
		}
	const VkResult result = operation.context.read(reads);
	if (result == VK_SUCCESS)
		for (const auto& [address, number] : found)
			*address = reads.as<VkDeviceAddress>(number);
	return result;
}

VkResult readCount(Operation& operation)
{
	const uint32_t most = operation.input.info.maxAccelerationStructureCount;
	operation.count = most;
	const VkDeviceAddress address = operation.info.srcInfosCount;
	if (!address)
		return VK_SUCCESS;
	checkAlignment(operation, "src-count", address, 4, "srcInfosCount");
	const auto place = placeOf(operation, "src-count", address, 4, kInputUsage, "srcInfosCount");
	operation.count = 0;
	if (!place)
		return VK_SUCCESS;
	Reads reads;
	reads.add(*place, 4);
	const VkResult result = operation.context.read(reads);
	if (result != VK_SUCCESS)
		return result;
	const auto count = reads.as<uint32_t>(0);
	if (count > most)
		operation.report().violation("src-count-above-max", "{}: srcInfosCount holds {}, maxAccelerationStructureCount is {}", operation.name(),
									 count, most);
	operation.count = std::min(count, most);
	return VK_SUCCESS;
}

VkResult readArguments(Operation& operation)
{
	const VkStridedDeviceAddressRegionKHR& array = operation.info.srcInfosArray;
	const size_t bytes = infoBytes(operation.input.type());
	const VkDeviceSize stride = array.stride ? array.stride : bytes;
	if (stride < bytes)
		operation.report().violation("src-infos-stride", "{}: srcInfosArray has stride {}, its structures have {} bytes", operation.name(), stride,
									 bytes);
	if (stride % 8 != 0)
		operation.report().violation("src-infos-stride", "{}: srcInfosArray has stride {}, right is a multiple of 8", operation.name(), stride);
	if (operation.count == 0)
		return VK_SUCCESS;
	checkAlignment(operation, "src-infos", array.deviceAddress, 8, "srcInfosArray");
	const VkDeviceSize needed = stride * (operation.count - 1) + bytes;
	if (array.size < needed)
		operation.report().violation("src-infos-size", "{}: srcInfosArray has {} bytes, {} structures of stride {} need {}", operation.name(),
									 array.size, operation.count, stride, needed);
	operation.context.hazards.read(array.deviceAddress, needed, "srcInfosArray");
	const auto place = placeOf(operation, "src-infos", array.deviceAddress, needed, kInputUsage, "srcInfosArray");
	if (!place)
	{
		operation.count = 0;
		return VK_SUCCESS;
	}
	Reads reads;
	reads.add(*place, needed);
	const VkResult result = operation.context.read(reads);
	if (result != VK_SUCCESS)
		return result;
	operation.arguments.resize(bytes * operation.count);
	for (uint32_t i = 0; i < operation.count; ++i)
		std::memcpy(operation.arguments.data() + i * bytes, reads.at(0).data() + i * stride, bytes);
	return VK_SUCCESS;
}

// The driver may write anything there: so does the layer, that nothing can be kept in it.
VkResult spoilScratch(const Operation& operation)
{
	const VkDeviceAddress address = operation.info.scratchData;
	checkAlignment(operation, "scratch", address, clusterProperties().clusterScratchByteAlignment, "scratchData");
	operation.context.hazards.write(address, operation.sizes.scratch, "scratchData");
	const auto place = placeOf(operation, "scratch", address, operation.sizes.scratch, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "scratchData");
	if (!place || place->offset % 4 != 0)
		return VK_SUCCESS;
	return operation.context.link.run(operation.context.queue, [&](VkCommandBuffer commands) {
		operation.device().next.CmdFillBuffer(commands, place->buffer, place->offset, operation.sizes.scratch, 0xcdcdcdcdu);
	});
}

}  // namespace

std::optional<Place> placeOf(const Operation& operation, const char* what, VkDeviceAddress address, VkDeviceSize size, VkBufferUsageFlags usage,
							 const std::string& text)
{
	const auto place = operation.device().addresses.find(address, size, usage);
	if (!place)
		operation.report().violation(fmt::format("{}-range", what), "{}: {} at {:#x} with {} bytes does not lie in one live buffer", operation.name(),
									 text, address, size);
	else if ((place->usage & usage) != usage)
		operation.report().violation(fmt::format("{}-usage", what), "{}: {} at {:#x} lies in a buffer of usage {:#x}, it needs {:#x}",
									 operation.name(), text, address, place->usage, usage);
	return place;
}

void checkAlignment(const Operation& operation, const char* what, VkDeviceAddress address, VkDeviceSize alignment, const std::string& text)
{
	if (address % alignment != 0)
		operation.report().violation(fmt::format("{}-alignment", what), "{}: {} at {:#x} is not a multiple of {}", operation.name(), text, address,
									 alignment);
}

ClusterInput copyOf(const VkClusterAccelerationStructureInputInfoNV& info)
{
	ClusterInput input;
	input.info = info;
	switch (info.opType)
	{
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_MOVE_OBJECTS_NV:
		input.move = *info.opInput.pMoveObjects;
		break;
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_CLUSTERS_BOTTOM_LEVEL_NV:
		input.bottom_level = *info.opInput.pClustersBottomLevel;
		break;
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_NV:
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_TEMPLATE_NV:
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_INSTANTIATE_TRIANGLE_CLUSTER_NV:
		input.triangles = *info.opInput.pTriangleClusters;
		break;
	default:
		break;
	}
	input.info.opInput.pTriangleClusters = nullptr;
	return input;
}

VkResult execute(const HostContext& context, const ClusterCommand& command)
{
	Operation operation = { context, command.input };
	operation.info = command.info;
	operation.sizes = sizesOf(command.input);
	VkResult result = resolveAddresses(operation);
	if (result == VK_SUCCESS)
		result = readCount(operation);
	if (result == VK_SUCCESS)
		result = readArguments(operation);
	if (result == VK_SUCCESS)
		result = spoilScratch(operation);
	if (result != VK_SUCCESS)
		return result;
	context.device.report.count(operation.name(), operation.count);
	context.device.report.count("commands", 1);
	switch (command.input.type())
	{
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_MOVE_OBJECTS_NV:
		return moveObjects(operation);
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_CLUSTERS_BOTTOM_LEVEL_NV:
		return buildBottomLevels(operation);
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_INSTANTIATE_TRIANGLE_CLUSTER_NV:
		return instantiateClusters(operation);
	default:
		return buildTriangleClusters(operation);
	}
}

VKAPI_ATTR void VKAPI_CALL cmdBuildClusterAccelerationStructureIndirect(VkCommandBuffer buffer,
																		const VkClusterAccelerationStructureCommandsInfoNV* info)
{
	Device& device = deviceOf(buffer);
	constexpr const char* kName = "vkCmdBuildClusterAccelerationStructureIndirectNV";
	ClusterCommand command = { copyOf(info->input), *info };
	checkInput(device, command.input, kName);
	if (info->sType != VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_COMMANDS_INFO_NV)
		device.report.violation("struct-type", "{}: pCommandInfos has sType {}, right is {}", kName, int(info->sType),
								int(VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_COMMANDS_INFO_NV));
	if (info->pNext)
		device.report.violation("struct-chain", "{}: pCommandInfos has a pNext, right is null", kName);
	if (const Recording* recording = device.recordings.find(buffer); recording && recording->open > 0)
		device.report.violation("inside-render-pass", "{} between vkCmd{} and its end, right is outside", kName, recording->opened_by);
	if (command.input.type() > VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_INSTANTIATE_TRIANGLE_CLUSTER_NV ||
		command.input.mode() > VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_COMPUTE_SIZES_NV)
		return;
	recordHostCommand(device, buffer, command, kName);
}

}  // namespace tessera::layer
