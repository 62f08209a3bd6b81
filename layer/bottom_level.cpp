// Bottom-level structures of clusters: the driver's structure has one geometry per cluster, so that a triangle's number is its number in the cluster.
#include "layer/driver_build.h"

#include <atomic>
#include <unordered_set>

namespace tessera::layer
{

namespace
{

using Info = VkClusterAccelerationStructureBuildClustersBottomLevelInfoNV;

// The lists of references; empty where there is no such list.
VkResult readReferences(const Operation& operation, std::vector<DriverBuild>& builds)
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
		operation.context.hazards.read(info.clusterReferences, bytes, "clusterReferences");
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

VkResult readClusters(const Operation& operation, std::vector<DriverBuild>& builds)
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
	for (DriverBuild& build : builds)
		for (size_t i = 0; result == VK_SUCCESS && i < build.references.size(); ++i, ++next)
			if (records[next])
				build.clusters.push_back(decode(*records[next]));
	return result;
}

}  // namespace

VkResult buildBottomLevels(const Operation& operation)
{
	static std::atomic<uint64_t> serial = 0;
	std::vector<DriverBuild> builds(operation.count);
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
	DriverGeometry all;
	uint64_t clusters = 0;
	for (DriverBuild& build : builds)
	{
		if (!addDriverGeometry(operation, build, all))
			return VK_ERROR_OUT_OF_DEVICE_MEMORY;
		clusters += build.clusters.size();
	}
	operation.report().count("clusters in bottom levels", clusters);
	operation.report().count("triangles in bottom levels", all.indices.size() / 3);
	if (result = runDriverBuilds(operation, builds, all); result != VK_SUCCESS)
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
