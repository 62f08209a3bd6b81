// Top-level structures: their instances are read when the queue comes to the build. Where one refers to a structure of clusters, the driver's
// structure takes its place; every instance gets a slot of the lookup table in place of its custom index.
#include "layer/device.h"
#include "layer/operation.h"

#include <algorithm>

namespace tessera::layer
{

namespace
{

using Placed = VkAccelerationStructureInstanceKHR;

constexpr const char* kBuild = "top-level build";

bool isTopLevel(const VkAccelerationStructureBuildGeometryInfoKHR& info)
{
	if (info.type == VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR)
		return true;
	for (uint32_t i = 0; i < info.geometryCount; ++i)
		if ((info.pGeometries ? info.pGeometries[i] : *info.ppGeometries[i]).geometryType == VK_GEOMETRY_TYPE_INSTANCES_KHR)
			return true;
	return false;
}

TopLevelBuild copyOf(const VkAccelerationStructureBuildGeometryInfoKHR& info, const VkAccelerationStructureBuildRangeInfoKHR* ranges)
{
	TopLevelBuild build;
	build.info = info;
	for (uint32_t i = 0; i < info.geometryCount; ++i)
		build.geometries.push_back(info.pGeometries ? info.pGeometries[i] : *info.ppGeometries[i]);
	build.ranges.assign(ranges, ranges + info.geometryCount);
	build.info.pGeometries = nullptr;
	build.info.ppGeometries = nullptr;
	return build;
}

std::optional<Place> checkedPlace(const HostContext& context, VkDeviceAddress address, VkDeviceSize bytes, const char* what)
{
	const auto place = context.device.addresses.find(address, bytes, 0);
	if (!place)
		context.device.report.violation("instances-range", "{}: {} at {:#x} with {} bytes does not lie in one live buffer", kBuild, what, address,
										bytes);
	return place;
}

// Instances that are given by a list of their addresses.
VkResult readByAddress(const HostContext& context, VkDeviceAddress list, std::span<Placed> instances)
{
	const auto place = checkedPlace(context, list, instances.size() * sizeof(VkDeviceAddress), "the list of instances");
	if (!place)
		return VK_SUCCESS;
	Reads addresses;
	addresses.add(*place, instances.size() * sizeof(VkDeviceAddress));
	if (const VkResult result = context.read(addresses); result != VK_SUCCESS)
		return result;
	Reads reads;
	std::vector<std::pair<size_t, size_t>> numbers;
	for (size_t i = 0; i < instances.size(); ++i)
	{
		VkDeviceAddress address = 0;
		std::memcpy(&address, addresses.at(0).data() + i * sizeof(address), sizeof(address));
		if (const auto one = checkedPlace(context, address, sizeof(Placed), "an instance"))
			numbers.emplace_back(i, reads.add(*one, sizeof(Placed)));
	}
	const VkResult result = context.read(reads);
	for (const auto& [i, number] : numbers)
		if (result == VK_SUCCESS)
			instances[i] = reads.as<Placed>(number);
	return result;
}

VkResult readInstances(const HostContext& context, const TopLevelBuild& build, std::vector<Placed>& instances)
{
	if (build.geometries.empty())
		return VK_SUCCESS;
	const auto& data = build.geometries[0].geometry.instances;
	instances.resize(build.ranges[0].primitiveCount);
	const VkDeviceAddress first = data.data.deviceAddress + build.ranges[0].primitiveOffset;
	if (instances.empty())
		return VK_SUCCESS;
	if (data.arrayOfPointers)
		return readByAddress(context, first, instances);
	const auto place = checkedPlace(context, first, instances.size() * sizeof(Placed), "the instances");
	if (!place)
		return VK_SUCCESS;
	Reads reads;
	reads.add(*place, instances.size() * sizeof(Placed));
	const VkResult result = context.read(reads);
	if (result == VK_SUCCESS)
		std::memcpy(instances.data(), reads.at(0).data(), reads.at(0).size());
	return result;
}

// Records that the program's memory no longer has: something else was written where a structure of clusters is still referred to.
VkResult checkRecords(const HostContext& context, std::span<const Placed> instances)
{
	Reads reads;
	std::vector<std::pair<VkDeviceAddress, size_t>> numbers;
	std::vector<VkDeviceAddress> seen;
	for (const Placed& instance : instances)
		seen.push_back(instance.accelerationStructureReference);
	std::sort(seen.begin(), seen.end());
	seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
	for (const VkDeviceAddress address : seen)
		if (const BottomLevel* structure = context.device.structures.find(address))
			if (const auto place = context.device.addresses.find(address, structure->record_bytes, 0))
			{
				context.hazards.read(address, structure->record_bytes, "a structure of clusters");
				numbers.emplace_back(address, reads.add(*place, structure->record_bytes));
			}
	const VkResult result = context.read(reads);
	for (const auto& [address, number] : numbers)
		if (result == VK_SUCCESS)
		{
			const auto head = headOf(reads.at(number), address);
			if (!head || head->serial != context.device.structures.find(address)->serial || !isIntact(reads.at(number)))
				context.device.report.violation("structure-overwritten",
												"{}: something else was written over the structure of clusters at {:#x} that an instance refers to",
												kBuild, address);
		}
	return result;
}

// The driver's version of an instance, and its slot.
Slot translate(const HostContext& context, size_t index, Placed& instance, uint32_t slot_number)
{
	Slot slot;
	slot.custom_index = instance.instanceCustomIndex;
	instance.instanceCustomIndex = slot_number & 0xffffffu;
	const VkDeviceAddress reference = instance.accelerationStructureReference;
	if (const BottomLevel* structure = context.device.structures.find(reference))
	{
		slot.first_row = structure->first_row;
		slot.row_step = 1;
		slot.keep_geometry = 0;
		instance.accelerationStructureReference = structure->real_address;
		if (structure->culls_nothing)
			instance.flags |= VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
	}
	else if (reference != 0 && !context.device.structures.isDriverAddress(reference))
	{
		context.device.report.violation("instance-reference",
										"{}: instance {} refers to {:#x}, which is no bottom-level structure; right is an address that a build "
										"of clusters wrote or vkGetAccelerationStructureDeviceAddressKHR returned",
										kBuild, index, reference);
		instance.accelerationStructureReference = 0;
	}
	return slot;
}

VkResult buildDriver(const HostContext& context, const TopLevelBuild& build, VkDeviceAddress instances)
{
	std::vector<VkAccelerationStructureGeometryKHR> geometries = build.geometries;
	std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges = build.ranges;
	if (!geometries.empty())
	{
		geometries[0].geometry.instances.arrayOfPointers = VK_FALSE;
		geometries[0].geometry.instances.data.deviceAddress = instances;
		ranges[0].primitiveOffset = 0;
	}
	VkAccelerationStructureBuildGeometryInfoKHR info = build.info;
	info.pGeometries = geometries.data();
	const VkAccelerationStructureBuildRangeInfoKHR* first = ranges.data();
	return context.link.run(context.queue,
							[&](VkCommandBuffer commands) { context.device.next.CmdBuildAccelerationStructuresKHR(commands, 1, &info, &first); });
}

}  // namespace

VkResult execute(const HostContext& context, const TopLevelBuild& build)
{
	Device& device = context.device;
	std::vector<Placed> instances;
	VkResult result = readInstances(context, build, instances);
	if (result == VK_SUCCESS)
		result = checkRecords(context, instances);
	if (result != VK_SUCCESS)
		return result;
	TopLevel top;
	top.slot_count = static_cast<uint32_t>(instances.size());
	top.first_slot = device.lookup->slots.take(top.slot_count);
	top.instances =
		OwnBuffer::make(device, instances.size() * sizeof(Placed), VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR, true);
	if (top.first_slot == UINT32_MAX || !top.instances)
		return VK_ERROR_OUT_OF_DEVICE_MEMORY;
	if (top.first_slot + top.slot_count > 1u << 24)
		device.report.limit("limit-instances", "more than 2^24 instances in all top-level structures");
	for (size_t i = 0; i < instances.size(); ++i)
	{
		const auto number = static_cast<uint32_t>(top.first_slot + i);
		const Slot slot = translate(context, i, instances[i], number);
		top.has_clusters = top.has_clusters || slot.row_step;
		device.lookup->slots.set(number, &slot);
	}
	std::copy_n(reinterpret_cast<const std::byte*>(instances.data()), instances.size() * sizeof(Placed), top.instances->data());
	result = buildDriver(context, build, top.instances->address());
	device.report.count("top-level builds", 1);
	device.report.count("instances of clusters", top.has_clusters ? instances.size() : 0);
	device.structures.put(device, build.info.dstAccelerationStructure, std::move(top));
	return result;
}

VkResult execute(const HostContext& context, const CopyOfStructure& copy)
{
	context.device.structures.copied(context.device, copy.source, copy.destination);
	return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL cmdBuildAccelerationStructures(VkCommandBuffer buffer, uint32_t count,
														  const VkAccelerationStructureBuildGeometryInfoKHR* infos,
														  const VkAccelerationStructureBuildRangeInfoKHR* const* ranges)
{
	Device& device = deviceOf(buffer);
	const Recording* recording = device.active ? device.recordings.find(buffer) : nullptr;
	std::vector<VkAccelerationStructureBuildGeometryInfoKHR> bottom;
	std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> bottom_ranges;
	std::vector<TopLevelBuild> top;
	for (uint32_t i = 0; i < count; ++i)
		if (recording && isTopLevel(infos[i]))
			top.push_back(copyOf(infos[i], ranges[i]));
		else
		{
			bottom.push_back(infos[i]);
			bottom_ranges.push_back(ranges[i]);
		}
	if (!bottom.empty())
		device.next.CmdBuildAccelerationStructuresKHR(recording ? recording->current : buffer, static_cast<uint32_t>(bottom.size()), bottom.data(),
													  bottom_ranges.data());
	for (TopLevelBuild& build : top)
		recordHostCommand(device, buffer, std::move(build), "vkCmdBuildAccelerationStructuresKHR of a top-level structure");
}

VKAPI_ATTR void VKAPI_CALL cmdBuildAccelerationStructuresIndirect(VkCommandBuffer buffer, uint32_t count,
																  const VkAccelerationStructureBuildGeometryInfoKHR* infos,
																  const VkDeviceAddress* addresses, const uint32_t* strides,
																  const uint32_t* const* most)
{
	Device& device = deviceOf(buffer);
	const Recording* recording = device.active ? device.recordings.find(buffer) : nullptr;
	if (recording && std::any_of(infos, infos + count, isTopLevel))
		device.report.limit("limit-top-level",
							"vkCmdBuildAccelerationStructuresIndirectKHR of a top-level structure: the layer does not see its instances");
	device.next.CmdBuildAccelerationStructuresIndirectKHR(recording ? recording->current : buffer, count, infos, addresses, strides, most);
}

VKAPI_ATTR VkResult VKAPI_CALL buildAccelerationStructures(VkDevice handle, VkDeferredOperationKHR deferred, uint32_t count,
														   const VkAccelerationStructureBuildGeometryInfoKHR* infos,
														   const VkAccelerationStructureBuildRangeInfoKHR* const* ranges)
{
	Device& device = deviceOf(handle);
	if (device.active && std::any_of(infos, infos + count, isTopLevel))
		device.report.limit("limit-top-level", "vkBuildAccelerationStructuresKHR of a top-level structure: the layer does not see its instances");
	return device.next.BuildAccelerationStructuresKHR(handle, deferred, count, infos, ranges);
}

VKAPI_ATTR void VKAPI_CALL cmdCopyAccelerationStructure(VkCommandBuffer buffer, const VkCopyAccelerationStructureInfoKHR* info)
{
	Device& device = deviceOf(buffer);
	const Recording* recording = device.active ? device.recordings.find(buffer) : nullptr;
	device.next.CmdCopyAccelerationStructureKHR(recording ? recording->current : buffer, info);
	if (recording)
		recordHostCommand(device, buffer, CopyOfStructure{ info->src, info->dst }, "vkCmdCopyAccelerationStructureKHR");
}

}  // namespace tessera::layer
