#include "layer/driver_build.h"

#include <algorithm>
#include <cmath>

namespace tessera::layer
{

namespace
{

constexpr VkDeviceSize kStorageAlignment = 256;  // Vulkan's, for where a structure may begin
constexpr VkDeviceSize kScratchAlignment = 256;  // the most that any known device asks for

// A driver may lose a whole structure over a triangle that is not a number, so such a triangle becomes one without area.
bool isActive(const Cluster& cluster, size_t triangle)
{
	for (size_t corner = 0; corner < 3; ++corner)
		for (const float value : cluster.vertices[cluster.indices[3 * triangle + corner]])
			if (!std::isfinite(value))
				return false;
	return true;
}

VkGeometryFlagsKHR geometryFlags(uint32_t packed)
{
	const uint32_t flags = packed >> kGeometryFlagsShift;
	VkGeometryFlagsKHR out = 0;
	if (flags & VK_CLUSTER_ACCELERATION_STRUCTURE_GEOMETRY_OPAQUE_BIT_NV)
		out |= VK_GEOMETRY_OPAQUE_BIT_KHR;
	if (flags & VK_CLUSTER_ACCELERATION_STRUCTURE_GEOMETRY_NO_DUPLICATE_ANYHIT_INVOCATION_BIT_NV)
		out |= VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;
	return out;
}

// One geometry of a cluster: its triangles with these flags; the others keep their numbers but have no area.
void addGeometry(const Cluster& cluster, uint32_t flags, DriverBuild& build, DriverGeometry& all)
{
	VkAccelerationStructureBuildRangeInfoKHR range = {};
	range.primitiveCount = cluster.triangle_count;
	// Offsets for now: the buffer's address is added when there is a buffer.
	const VkDeviceSize first_vertex = (all.vertices.size() - cluster.vertices.size()) * sizeof(Vertex);
	const VkDeviceSize first_index = all.indices.size() * sizeof(uint32_t);
	for (size_t triangle = 0; triangle < cluster.triangle_count; ++triangle)
	{
		const bool drawn = cluster.geometryOf(triangle) >> kGeometryFlagsShift == flags && isActive(cluster, triangle);
		for (size_t corner = 0; corner < 3; ++corner)
			all.indices.push_back(cluster.indices[3 * triangle + (drawn ? corner : 0)]);
	}
	VkAccelerationStructureGeometryKHR geometry = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR };
	geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
	geometry.flags = geometryFlags(flags << kGeometryFlagsShift);
	auto& triangles = geometry.geometry.triangles;
	triangles = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR };
	triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
	triangles.vertexData.deviceAddress = first_vertex;
	triangles.indexData.deviceAddress = first_index;
	triangles.vertexStride = sizeof(Vertex);
	triangles.maxVertex = static_cast<uint32_t>(cluster.vertices.empty() ? 0 : cluster.vertices.size() - 1);
	triangles.indexType = VK_INDEX_TYPE_UINT32;
	build.geometries.push_back(geometry);
	build.ranges.push_back(range);
	build.triangle_counts.push_back(cluster.triangle_count);
}

void addCluster(const Operation& operation, const Cluster& cluster, DriverBuild& build, DriverGeometry& all, std::vector<Row>& rows,
				std::vector<uint32_t>& indices)
{
	for (const Vertex& vertex : cluster.vertices)
		all.vertices.push_back(std::isfinite(vertex[0] + vertex[1] + vertex[2]) ? vertex : Vertex{});
	Row row;
	row.cluster_id = cluster.id;
	row.first_triangle = static_cast<uint32_t>(indices.size());
	row.triangle_step = cluster.geometry.size() > 1 ? 1 : 0;
	std::vector<uint32_t> kinds;  // of flags
	for (const uint32_t packed : cluster.geometry)
	{
		indices.push_back(packed & kGeometryIndexMask);
		if (std::find(kinds.begin(), kinds.end(), packed >> kGeometryFlagsShift) == kinds.end())
			kinds.push_back(packed >> kGeometryFlagsShift);
	}
	constexpr uint32_t kCullDisable = VK_CLUSTER_ACCELERATION_STRUCTURE_GEOMETRY_CULL_DISABLE_BIT_NV;
	for (const uint32_t flags : kinds)
	{
		const bool culls_nothing = flags & kCullDisable;
		if (build.geometries.empty())
			build.made.culls_nothing = culls_nothing;
		else if (build.made.culls_nothing != culls_nothing)
			operation.report().limit("limit-cull-disable", "{}: one structure has geometries with and without CULL_DISABLE", operation.name());
		addGeometry(cluster, flags, build, all);
		rows.push_back(row);
	}
}

}  // namespace

bool addDriverGeometry(const Operation& operation, DriverBuild& build, DriverGeometry& all)
{
	std::vector<Row> rows;
	std::vector<uint32_t> indices;
	for (const Cluster& cluster : build.clusters)
		addCluster(operation, cluster, build, all, rows, indices);
	LookupTable& lookup = *operation.device().lookup;
	BottomLevel& made = build.made;
	made.row_count = static_cast<uint32_t>(rows.size());
	made.index_count = static_cast<uint32_t>(indices.size());
	made.first_row = lookup.rows.take(made.row_count);
	made.first_index = lookup.geometry_indices.take(made.index_count);
	if (made.first_row == UINT32_MAX || made.first_index == UINT32_MAX)
		return false;
	for (uint32_t i = 0; i < made.row_count; ++i)
	{
		rows[i].first_triangle += made.first_index;
		lookup.rows.set(made.first_row + i, &rows[i]);
	}
	for (uint32_t i = 0; i < made.index_count; ++i)
		lookup.geometry_indices.set(made.first_index + i, &indices[i]);
	return true;
}

namespace
{

VkAccelerationStructureBuildGeometryInfoKHR infoOf(const Operation& operation, const DriverBuild& build)
{
	VkAccelerationStructureBuildGeometryInfoKHR info = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR };
	info.type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
	info.flags = operation.input.info.flags &
				 (VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR | VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR |
				  VK_BUILD_ACCELERATION_STRUCTURE_LOW_MEMORY_BIT_KHR | VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_DATA_ACCESS_KHR);
	info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
	info.geometryCount = static_cast<uint32_t>(build.geometries.size());
	info.pGeometries = build.geometries.data();
	return info;
}

// Asks the driver for sizes and gives each build its share of the command's storage and scratch.
std::pair<VkDeviceSize, VkDeviceSize> layOut(const Operation& operation, std::span<DriverBuild> builds)
{
	VkDeviceSize storage = 0, scratch = 0;
	for (DriverBuild& build : builds)
	{
		const auto info = infoOf(operation, build);
		operation.device().next.GetAccelerationStructureBuildSizesKHR(operation.device().handle, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
																	  &info, build.triangle_counts.data(), &build.sizes);
		build.storage_offset = storage;
		build.scratch_offset = scratch;
		storage += alignUp(build.sizes.accelerationStructureSize, kStorageAlignment);
		scratch += alignUp(build.sizes.buildScratchSize, kScratchAlignment);
	}
	return { storage, scratch + kScratchAlignment };
}

bool createStructure(const Operation& operation, DriverBuild& build, const std::shared_ptr<OwnBuffer>& storage)
{
	Device& device = operation.device();
	VkAccelerationStructureCreateInfoKHR info = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR };
	info.buffer = storage->handle();
	info.offset = build.storage_offset;
	info.size = build.sizes.accelerationStructureSize;
	info.type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
	if (device.next.CreateAccelerationStructureKHR(device.handle, &info, nullptr, &build.made.handle) != VK_SUCCESS)
		return false;
	VkAccelerationStructureDeviceAddressInfoKHR of = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR };
	of.accelerationStructure = build.made.handle;
	build.made.real_address = device.next.GetAccelerationStructureDeviceAddressKHR(device.handle, &of);
	build.made.structure_bytes = build.sizes.accelerationStructureSize;
	build.made.storage = storage;
	return true;
}

}  // namespace

VkResult runDriverBuilds(const Operation& operation, std::span<DriverBuild> builds, const DriverGeometry& all)
{
	constexpr VkBufferUsageFlags kInput = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
	Device& device = operation.device();
	const VkDeviceSize vertex_bytes = alignUp(all.vertices.size() * sizeof(Vertex), 16), index_bytes = all.indices.size() * sizeof(uint32_t);
	const auto [storage_bytes, scratch_bytes] = layOut(operation, builds);
	const auto input = OwnBuffer::make(device, vertex_bytes + index_bytes, kInput, true);
	const auto storage = OwnBuffer::make(device, storage_bytes, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR, false);
	const auto scratch = OwnBuffer::make(device, scratch_bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, false);
	if (!input || !storage || !scratch)
		return VK_ERROR_OUT_OF_DEVICE_MEMORY;
	std::copy_n(reinterpret_cast<const std::byte*>(all.vertices.data()), all.vertices.size() * sizeof(Vertex), input->data());
	std::copy_n(reinterpret_cast<const std::byte*>(all.indices.data()), index_bytes, input->data() + vertex_bytes);
	std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
	std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
	for (DriverBuild& build : builds)
	{
		if (!createStructure(operation, build, storage))
			return VK_ERROR_OUT_OF_DEVICE_MEMORY;
		for (auto& geometry : build.geometries)
		{
			geometry.geometry.triangles.vertexData.deviceAddress += input->address();
			geometry.geometry.triangles.indexData.deviceAddress += input->address() + vertex_bytes;
		}
		infos.push_back(infoOf(operation, build));
		infos.back().dstAccelerationStructure = build.made.handle;
		infos.back().scratchData.deviceAddress = alignUp(scratch->address(), kScratchAlignment) + build.scratch_offset;
		ranges.push_back(build.ranges.data());
	}
	return operation.context.link.run(operation.context.queue, [&](VkCommandBuffer commands) {
		device.next.CmdBuildAccelerationStructuresKHR(commands, static_cast<uint32_t>(infos.size()), infos.data(), ranges.data());
	});
}

}  // namespace tessera::layer
