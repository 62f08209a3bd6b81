#include "gpu/acceleration_structure.h"

#include <utility>

namespace tessera
{

namespace
{

VkBuildAccelerationStructureFlagsKHR flagsOf(const BuildFlags& flags)
{
	return (flags.fast_trace ? VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR
							 : VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR) |
		   (flags.can_update ? VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR : 0) |
		   (flags.can_compact ? VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR : 0);
}

}  // namespace

StructureBuild::StructureBuild(const TriangleInput& input, const BuildFlags& flags)
	: type_(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR), flags_(flagsOf(flags)), count_(input.triangle_count)
{
	geometry_.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
	geometry_.flags = input.opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR : 0;
	VkAccelerationStructureGeometryTrianglesDataKHR& triangles = geometry_.geometry.triangles;
	triangles = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR };
	triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
	triangles.vertexData.deviceAddress = input.vertices;
	triangles.vertexStride = input.vertex_stride_bytes;
	triangles.maxVertex = input.most_vertex;
	triangles.indexType = VK_INDEX_TYPE_UINT32;
	triangles.indexData.deviceAddress = input.indices;
}

StructureBuild::StructureBuild(const InstanceInput& input, const BuildFlags& flags)
	: type_(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR), flags_(flagsOf(flags)), count_(input.instance_count)
{
	geometry_.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
	geometry_.geometry.instances = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR };
	geometry_.geometry.instances.data.deviceAddress = input.instances;
}

VkAccelerationStructureBuildGeometryInfoKHR StructureBuild::info(const VkAccelerationStructureGeometryKHR& geometry) const
{
	VkAccelerationStructureBuildGeometryInfoKHR info = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR };
	info.type = type_;
	info.flags = flags_;
	info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
	info.geometryCount = 1;
	info.pGeometries = &geometry;
	return info;
}

StructureBuild::Sizes StructureBuild::sizes(const Device& device, uint32_t count) const
{
	const VkAccelerationStructureBuildGeometryInfoKHR build = info(geometry_);
	VkAccelerationStructureBuildSizesInfoKHR sizes = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR };
	device.functions.acceleration_structure_sizes(device.handle, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &build, &count, &sizes);
	return { sizes.accelerationStructureSize, sizes.buildScratchSize, sizes.updateScratchSize };
}

void StructureBuild::record(const Device& device, VkCommandBuffer commands, VkAccelerationStructureKHR structure, uint64_t scratch,
							BuildMode mode) const
{
	VkAccelerationStructureBuildGeometryInfoKHR build = info(geometry_);
	const bool updates = mode == BuildMode::Update;
	build.mode = updates ? VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR : VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
	build.srcAccelerationStructure = updates ? structure : VK_NULL_HANDLE;
	build.dstAccelerationStructure = structure;
	build.scratchData.deviceAddress = scratch;
	const VkAccelerationStructureBuildRangeInfoKHR range = { count_, 0, 0, 0 };
	const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
	device.functions.build_acceleration_structures(commands, 1, &build, &ranges);
}

void recordCompaction(const Device& device, VkCommandBuffer commands, VkAccelerationStructureKHR from, VkAccelerationStructureKHR to)
{
	VkCopyAccelerationStructureInfoKHR copy = { VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR };
	copy.src = from;
	copy.dst = to;
	copy.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR;
	device.functions.copy_acceleration_structure(commands, &copy);
}

uint64_t scratchBytes(const Device& device, uint64_t bytes)
{
	return bytes + device.limits.scratch_alignment;
}

uint64_t scratchAddress(const Device& device, const Buffer& scratch)
{
	const uint64_t alignment = device.limits.scratch_alignment;
	return (scratch.address() + alignment - 1) / alignment * alignment;
}

Result<AccelerationStructure> AccelerationStructure::create(Device& device, VkAccelerationStructureTypeKHR type, uint64_t bytes,
															const std::string& name)
{
	AccelerationStructure structure;
	TRY_ASSIGN(structure.buffer_, Buffer::create(device, bytes, MemoryKind::Device, name, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR));
	VkAccelerationStructureCreateInfoKHR info = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR };
	info.buffer = structure.buffer_.handle();
	info.size = bytes;
	info.type = type;
	VK_TRY(device.functions.create_acceleration_structure(device.handle, &info, nullptr, &structure.handle_),
		   "creating an acceleration structure of {} bytes for {}", bytes, name);
	structure.device_ = &device;
	VkAccelerationStructureDeviceAddressInfoKHR address = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR };
	address.accelerationStructure = structure.handle_;
	structure.address_ = device.functions.acceleration_structure_address(device.handle, &address);
	device.nameObject(VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR, reinterpret_cast<uint64_t>(structure.handle_), name);
	return structure;
}

AccelerationStructure::~AccelerationStructure()
{
	if (handle_)
		device_->functions.destroy_acceleration_structure(device_->handle, handle_, nullptr);
}

void AccelerationStructure::swap(AccelerationStructure& other) noexcept
{
	std::swap(device_, other.device_);
	std::swap(buffer_, other.buffer_);
	std::swap(handle_, other.handle_);
	std::swap(address_, other.address_);
}

}  // namespace tessera
