// Moving clusters, templates and bottom-level structures.
#include "layer/operation.h"

#include <algorithm>

namespace tessera::layer
{

namespace
{

// The driver copies a structure; used where source and destination both stay.
VkResult copyStructure(const Operation& operation, const BottomLevel& from, BottomLevel& to)
{
	Device& device = operation.device();
	VkAccelerationStructureCreateInfoKHR info = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR };
	to = from;
	// What only one of them can own: the copy has tables of its own below.
	to.storage = OwnBuffer::make(device, from.structure_bytes, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR, false);
	if (!to.storage)
		return VK_ERROR_OUT_OF_DEVICE_MEMORY;
	info.buffer = to.storage->handle();
	info.size = from.structure_bytes;
	info.type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
	if (const VkResult result = device.next.CreateAccelerationStructureKHR(device.handle, &info, nullptr, &to.handle); result != VK_SUCCESS)
		return result;
	VkAccelerationStructureDeviceAddressInfoKHR of = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR };
	of.accelerationStructure = to.handle;
	to.real_address = device.next.GetAccelerationStructureDeviceAddressKHR(device.handle, &of);
	VkCopyAccelerationStructureInfoKHR copy = { VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR };
	copy.src = from.handle;
	copy.dst = to.handle;
	copy.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_CLONE_KHR;
	return operation.context.link.run(operation.context.queue,
									  [&](VkCommandBuffer commands) { device.next.CmdCopyAccelerationStructureKHR(commands, &copy); });
}

void checkMoves(const Operation& operation, std::span<const VkDeviceAddress> sources, std::span<const Product> products)
{
	if (!operation.input.move.noMoveOverlap)
		return;
	for (size_t i = 0; i < products.size(); ++i)
		for (size_t k = 0; k < sources.size(); ++k)
			if (products[i].bytes && products[k].bytes && products[i].address < sources[k] + products[k].bytes &&
				sources[k] < products[i].address + products[i].bytes)
				operation.report().violation("move-overlap", "{}: result {} at {:#x} overlaps source {} at {:#x}, but noMoveOverlap is true",
											 operation.name(), i, products[i].address, k, sources[k]);
}

// A bottom-level structure's driver part follows its record.
VkResult moveStructure(const Operation& operation, VkDeviceAddress from, VkDeviceAddress to)
{
	Structures& structures = operation.device().structures;
	const BottomLevel* source = structures.find(from);
	if (!source || from == to)
		return VK_SUCCESS;
	if (!operation.input.move.noMoveOverlap)
	{
		structures.moved(operation.device(), from, to);
		return VK_SUCCESS;
	}
	BottomLevel copy;
	const VkResult result = copyStructure(operation, *source, copy);
	if (result == VK_SUCCESS)
		structures.putCopy(operation.device(), to, std::move(copy));
	return result;
}

}  // namespace

VkResult moveObjects(const Operation& operation)
{
	const RecordKind kind = kindOf(operation.input);
	std::vector<VkDeviceAddress> sources(operation.count);
	for (uint32_t i = 0; i < operation.count; ++i)
		sources[i] = operation.argument<VkClusterAccelerationStructureMoveObjectsInfoNV>(i).srcAccelerationStructure;
	std::vector<std::optional<std::vector<std::byte>>> records;
	if (const VkResult result = readRecords(operation, sources, kind, { "move-source", "move-source" }, records); result != VK_SUCCESS)
		return result;
	std::vector<Product> products(operation.count);
	for (size_t i = 0; i < products.size(); ++i)
		products[i].bytes = records[i] ? records[i]->size() : 0;
	if (const VkResult result = placeProducts(operation, products); result != VK_SUCCESS)
		return result;
	if (operation.input.mode() == VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_COMPUTE_SIZES_NV)
		return VK_SUCCESS;
	checkMoves(operation, sources, products);
	std::vector<std::pair<VkDeviceAddress, std::vector<std::byte>>> moved;
	for (size_t i = 0; i < products.size(); ++i)
		if (products[i].bytes)
		{
			if (kind == RecordKind::BottomLevel)
				if (const VkResult result = moveStructure(operation, sources[i], products[i].address); result != VK_SUCCESS)
					return result;
			readdress(*records[i], products[i].address);
			moved.emplace_back(products[i].address, std::move(*records[i]));
		}
	return writeRecords(operation, moved, kind == RecordKind::BottomLevel);
}

}  // namespace tessera::layer
