// Bottom-level structures of clusters: the driver's structure has one geometry per cluster, so that a triangle's number is its number in the cluster.
#include "layer/operation.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <unordered_set>

namespace tessera::layer
{

namespace
{

using Info = VkClusterAccelerationStructureBuildClustersBottomLevelInfoNV;

// A structure to be built: its clusters, and which part of the driver's input they became.
struct Build
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

// All builds of a command share these.
struct Geometry
{
	std::vector<Vertex> vertices;
	std::vector<uint32_t> indices;
};

constexpr VkDeviceSize kStorageAlignment = 256;  // Vulkan's, for where a structure may begin
constexpr VkDeviceSize kScratchAlignment = 256;  // the most that any known device asks for

// The lists of references; empty where there is no such list.
VkResult readReferences(const Operation& operation, std::vector<Build>& builds)
{
	Reads reads;
	std::vector<std::optional<size_t>> numbers(operation.count);
	const auto& limits = operation.input.bottom_level;
	uint64_t total = 0;
	for (uint32_t i = 0; i < operation.count; ++i)
	{
		const auto info = operation.argument<Info>(i);
		const std::string text = fmt::format("argument {}'s clusterReferences", i);
		total += info.clusterReferencesCount;
		if (info.clusterReferencesCount > limits.maxClusterCountPerAccelerationStructure)
			operation.report().violation("references-above-max", "{}: argument {} has {} clusters, maxClusterCountPerAccelerationStructure is {}",
										 operation.name(), i, info.clusterReferencesCount, limits.maxClusterCountPerAccelerationStructure);
		if (info.clusterReferencesStride < 8 || info.clusterReferencesStride % 8 != 0)
			operation.report().violation("references-stride", "{}: argument {} has clusterReferencesStride {}, right is a multiple of 8, at least 8",
										 operation.name(), i, info.clusterReferencesStride);
		if (info.clusterReferencesCount == 0)
			continue;
		checkAlignment(operation, "references", info.clusterReferences, 8, text);
		const VkDeviceSize bytes = VkDeviceSize(info.clusterReferencesStride) * (info.clusterReferencesCount - 1) + 8;
		if (const auto place = placeOf(operation, "references", info.clusterReferences, bytes, 0, text))
			numbers[i] = reads.add(*place, bytes);
	}
	if (total > limits.maxTotalClusterCount)
		operation.report().violation("total-references-above-max", "{}: {} clusters in all, maxTotalClusterCount is {}", operation.name(), total,
									 limits.maxTotalClusterCount);
	const VkResult result = operation.context.read(reads);
	for (uint32_t i = 0; result == VK_SUCCESS && i < operation.count; ++i)
		if (numbers[i])
		{
			const auto info = operation.argument<Info>(i);
			builds[i].references.resize(info.clusterReferencesCount);
			for (size_t k = 0; k < builds[i].references.size(); ++k)
				std::memcpy(&builds[i].references[k], reads.at(*numbers[i]).data() + k * info.clusterReferencesStride, 8);
		}
	return result;
}

VkResult readClusters(const Operation& operation, std::vector<Build>& builds)
{
	std::vector<VkDeviceAddress> addresses;
	for (size_t i = 0; i < builds.size(); ++i)
	{
		std::unordered_set<VkDeviceAddress> seen;
		for (const VkDeviceAddress reference : builds[i].references)
		{
			if (!seen.insert(reference).second)
				operation.report().violation("reference-twice", "{}: argument {} has the cluster at {:#x} twice", operation.name(), i, reference);
			addresses.push_back(reference);
		}
	}
	std::vector<std::optional<std::vector<std::byte>>> records;
	const VkResult result = readRecords(operation, addresses, RecordKind::Cluster, { "reference", "not-a-cluster" }, records);
	size_t next = 0;
	for (Build& build : builds)
		for (size_t i = 0; result == VK_SUCCESS && i < build.references.size(); ++i, ++next)
			if (records[next])
				build.clusters.push_back(decode(*records[next]));
	return result;
}

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
void addGeometry(const Cluster& cluster, uint32_t flags, Build& build, Geometry& all)
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

void addCluster(const Operation& operation, const Cluster& cluster, Build& build, Geometry& all, std::vector<Row>& rows,
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

// The input of the driver's builds, and what shaders find out about it.
bool addGeometry(const Operation& operation, Build& build, Geometry& all)
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

VkAccelerationStructureBuildGeometryInfoKHR infoOf(const Operation& operation, const Build& build)
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
std::pair<VkDeviceSize, VkDeviceSize> layOut(const Operation& operation, std::span<Build> builds)
{
	VkDeviceSize storage = 0, scratch = 0;
	for (Build& build : builds)
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

bool createStructure(const Operation& operation, Build& build, const std::shared_ptr<OwnBuffer>& storage)
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

// The builds themselves, on the device.
VkResult runBuilds(const Operation& operation, std::span<Build> builds, const Geometry& all)
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
	std::memcpy(input->data(), all.vertices.data(), all.vertices.size() * sizeof(Vertex));
	std::memcpy(input->data() + vertex_bytes, all.indices.data(), index_bytes);
	std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
	std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
	for (Build& build : builds)
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

}  // namespace

VkResult buildBottomLevels(const Operation& operation)
{
	static std::atomic<uint64_t> serial = 0;
	std::vector<Build> builds(operation.count);
	VkResult result = readReferences(operation, builds);
	const bool sizes_only = operation.input.mode() == VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_COMPUTE_SIZES_NV;
	if (result == VK_SUCCESS && !sizes_only)
		result = readClusters(operation, builds);
	if (result != VK_SUCCESS)
		return result;
	std::vector<Product> products(builds.size());
	for (size_t i = 0; i < builds.size(); ++i)
		products[i].bytes = bottomLevelBytes(builds[i].references.size());
	result = placeProducts(operation, products);
	if (result != VK_SUCCESS || sizes_only || builds.empty())
		return result;
	Geometry all;
	uint64_t clusters = 0;
	for (Build& build : builds)
	{
		if (!addGeometry(operation, build, all))
			return VK_ERROR_OUT_OF_DEVICE_MEMORY;
		clusters += build.clusters.size();
	}
	operation.report().count("clusters in bottom levels", clusters);
	operation.report().count("triangles in bottom levels", all.indices.size() / 3);
	if (result = runBuilds(operation, builds, all); result != VK_SUCCESS)
		return result;
	std::vector<std::pair<VkDeviceAddress, std::vector<std::byte>>> records;
	for (size_t i = 0; i < builds.size(); ++i)
	{
		builds[i].made.serial = ++serial;
		builds[i].made.record_bytes = products[i].bytes;
		if (!products[i].bytes)
			continue;
		records.emplace_back(products[i].address, encodeBottomLevel(builds[i].references, products[i].address, builds[i].made.serial));
	}
	result = writeRecords(operation, records);
	for (size_t i = 0; i < builds.size(); ++i)
		if (products[i].bytes)
			operation.device().structures.put(operation.device(), products[i].address, std::move(builds[i].made));
		else
			operation.device().structures.discard(operation.device(), builds[i].made);
	return result;
}

}  // namespace tessera::layer
