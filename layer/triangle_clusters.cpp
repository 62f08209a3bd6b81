// Building clusters and templates of triangles from indices and vertices.
#include "layer/operation.h"

#include <algorithm>
#include <cstddef>
#include <set>

namespace tessera::layer
{

namespace
{

using ClusterInfo = VkClusterAccelerationStructureBuildTriangleClusterInfoNV;
using TemplateInfo = VkClusterAccelerationStructureBuildTriangleClusterTemplateInfoNV;
static_assert(offsetof(TemplateInfo, instantiationBoundingBoxLimit) == sizeof(ClusterInfo), "a template's arguments begin as a cluster's");
static_assert(sizeof(ClusterInfo) == 64 && sizeof(TemplateInfo) == 72);

// One argument, and where what it points to is in the reads.
struct Request
{
	TemplateInfo info = {};
	std::string text;
	bool usable = true;
	std::optional<size_t> indices, vertices, geometry, bounds;
	VertexSource source;
};

TemplateInfo argumentOf(const Operation& operation, uint32_t index)
{
	if (operation.input.type() == VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_TEMPLATE_NV)
		return operation.argument<TemplateInfo>(index);
	TemplateInfo info = {};
	const auto cluster = operation.argument<ClusterInfo>(index);
	std::memcpy(&info, &cluster, sizeof(cluster));
	return info;
}

uint32_t indexBytes(const TemplateInfo& info)
{
	return info.indexType;
}  // the bits' values are the sizes: 1, 2 and 4
uint32_t indexStride(const TemplateInfo& info)
{
	return info.indexBufferStride ? info.indexBufferStride : indexBytes(info);
}
uint32_t geometryStride(const TemplateInfo& info)
{
	return info.geometryIndexAndFlagsBufferStride ? info.geometryIndexAndFlagsBufferStride : 4;
}

uint32_t baseGeometry(const TemplateInfo& info)
{
	uint32_t packed;
	std::memcpy(&packed, &info.baseGeometryIndexAndGeometryFlags, sizeof(packed));
	return packed;
}

// The rules for the numbers of an argument. False when nothing can be built of it.
bool checkNumbers(const Operation& operation, const Request& request)
{
	Report& report = operation.report();
	const TemplateInfo& info = request.info;
	const auto& limits = operation.input.triangles;
	const char* name = operation.name();
	const char* text = request.text.c_str();
	bool usable = true;
	if (info.clusterID == UINT32_MAX)
		report.violation("cluster-id-reserved", "{}: {} has clusterID 0xffffffff, which stands for no cluster", name, text);
	if (info.clusterFlags & ~VK_CLUSTER_ACCELERATION_STRUCTURE_CLUSTER_ALLOW_DISABLE_OPACITY_MICROMAPS_NV)
		report.violation("cluster-flags", "{}: {} has clusterFlags {:#x} with unknown bits", name, text, info.clusterFlags);
	if (info.triangleCount > limits.maxClusterTriangleCount)
		report.violation("triangles-above-max", "{}: {} has {} triangles, maxClusterTriangleCount is {}", name, text, uint32_t(info.triangleCount),
						 limits.maxClusterTriangleCount);
	if (info.vertexCount > limits.maxClusterVertexCount)
		report.violation("vertices-above-max", "{}: {} has {} vertices, maxClusterVertexCount is {}", name, text, uint32_t(info.vertexCount),
						 limits.maxClusterVertexCount);
	usable = info.triangleCount <= clusterProperties().maxTrianglesPerCluster && info.vertexCount <= clusterProperties().maxVerticesPerCluster;
	if (info.positionTruncateBitCount < limits.minPositionTruncateBitCount || info.positionTruncateBitCount > 32)
		report.violation("truncate-bits", "{}: {} has positionTruncateBitCount {}, right is from minPositionTruncateBitCount {} to 32", name, text,
						 uint32_t(info.positionTruncateBitCount), limits.minPositionTruncateBitCount);
	if (info.indexType != 1 && info.indexType != 2 && info.indexType != 4)
	{
		report.violation("index-type", "{}: {} has indexType {}, right is one bit of 1, 2 and 4", name, text, uint32_t(info.indexType));
		return false;
	}
	if (info.indexBufferStride % indexBytes(info) != 0)
		report.violation("index-stride", "{}: {} has indexBufferStride {}, right is 0 or a multiple of {}", name, text, info.indexBufferStride,
						 indexBytes(info));
	if (info.geometryIndexAndFlagsBufferStride % 4 != 0)
		report.violation("geometry-stride", "{}: {} has geometryIndexAndFlagsBufferStride {}, right is 0 or a multiple of 4", name, text,
						 info.geometryIndexAndFlagsBufferStride);
	if (info.opacityMicromapArray)
		report.limit("limit-opacity-micromap", "{}: {} has an opacity micromap, which this layer leaves out", name, text);
	return usable;
}

void addReads(const Operation& operation, Reads& reads, Request& request)
{
	const TemplateInfo& info = request.info;
	if (info.triangleCount > 0)
	{
		const VkDeviceSize bytes = VkDeviceSize(indexStride(info)) * (3 * info.triangleCount - 1) + indexBytes(info);
		const std::string text = request.text + "'s indexBuffer";
		checkAlignment(operation, "index-buffer", info.indexBuffer, indexBytes(info), text);
		if (const auto place = placeOf(operation, "index-buffer", info.indexBuffer, bytes, 0, text))
			request.indices = reads.add(*place, bytes);
		else
			request.usable = false;
	}
	if (info.geometryIndexAndFlagsBuffer && info.triangleCount > 0)
	{
		const VkDeviceSize bytes = VkDeviceSize(geometryStride(info)) * (info.triangleCount - 1) + 4;
		const std::string text = request.text + "'s geometryIndexAndFlagsBuffer";
		checkAlignment(operation, "geometry-buffer", info.geometryIndexAndFlagsBuffer, 4, text);
		if (const auto place = placeOf(operation, "geometry-buffer", info.geometryIndexAndFlagsBuffer, bytes, 0, text))
			request.geometry = reads.add(*place, bytes);
	}
	request.source = { info.vertexBuffer, info.vertexBufferStride, info.vertexCount };
	const bool is_template = kindOf(operation.input) == RecordKind::Template;
	if (!is_template || info.vertexBuffer)
	{
		request.vertices = addVertexRead(operation, reads, request.source, request.text + "'s vertexBuffer");
		request.usable = request.usable && request.vertices;
	}
	if (info.instantiationBoundingBoxLimit)
	{
		const std::string text = request.text + "'s instantiationBoundingBoxLimit";
		checkAlignment(operation, "bounds", info.instantiationBoundingBoxLimit, clusterProperties().clusterTemplateBoundsByteAlignment, text);
		if (const auto place = placeOf(operation, "bounds", info.instantiationBoundingBoxLimit, 6 * sizeof(float), 0, text))
			request.bounds = reads.add(*place, 6 * sizeof(float));
	}
}

std::vector<uint8_t> readIndices(const Operation& operation, const Reads& reads, Request& request)
{
	std::vector<uint8_t> indices(size_t(3) * request.info.triangleCount);
	for (size_t i = 0; i < indices.size(); ++i)
	{
		uint32_t index = 0;
		std::memcpy(&index, reads.at(*request.indices).data() + i * indexStride(request.info), indexBytes(request.info));
		if (index >= request.info.vertexCount)
		{
			operation.report().violation("index-out-of-range", "{}: {} has index {} at {}, its vertexCount is {}", operation.name(), request.text,
										 index, i, uint32_t(request.info.vertexCount));
			request.usable = false;
			index = 0;
		}
		indices[i] = static_cast<uint8_t>(index);
	}
	return indices;
}

std::vector<uint32_t> readGeometry(const Operation& operation, const Reads& reads, const Request& request)
{
	const uint32_t base = baseGeometry(request.info);
	std::vector<uint32_t> geometry = { base };
	if (request.geometry)
	{
		geometry.resize(request.info.triangleCount);
		for (size_t i = 0; i < geometry.size(); ++i)
		{
			uint32_t own = 0;
			std::memcpy(&own, reads.at(*request.geometry).data() + i * geometryStride(request.info), sizeof(own));
			geometry[i] = ((base | own) & ~kGeometryIndexMask) | (((base & kGeometryIndexMask) + (own & kGeometryIndexMask)) & kGeometryIndexMask);
		}
	}
	std::set<uint32_t> indices;
	const auto& limits = operation.input.triangles;
	const uint32_t most = std::min(limits.maxGeometryIndexValue, clusterProperties().maxClusterGeometryIndex - 1);
	for (const uint32_t packed : geometry)
	{
		indices.insert(packed & kGeometryIndexMask);
		if (packed >> 24 & 0x1fu)
			operation.report().violation("geometry-reserved-bits", "{}: {} has reserved bits {:#x} beside its geometry index, right is 0",
										 operation.name(), request.text, packed >> 24 & 0x1fu);
	}
	if (*indices.rbegin() > most)
		operation.report().violation("geometry-index-above-max", "{}: {} has geometry index {}, at most {} was declared or is possible",
									 operation.name(), request.text, *indices.rbegin(), most);
	if (indices.size() > limits.maxClusterUniqueGeometryCount)
		operation.report().violation("geometries-above-max", "{}: {} has {} different geometry indices, maxClusterUniqueGeometryCount is {}",
									 operation.name(), request.text, indices.size(), limits.maxClusterUniqueGeometryCount);
	return geometry;
}

Cluster makeCluster(const Operation& operation, const Reads& reads, Request& request)
{
	Cluster cluster;
	cluster.id = request.info.clusterID;
	cluster.vertex_format = operation.input.triangles.vertexFormat;
	cluster.truncate_bits = request.info.positionTruncateBitCount;
	cluster.triangle_count = request.info.triangleCount;
	cluster.vertex_count = request.info.vertexCount;
	cluster.indices = readIndices(operation, reads, request);
	cluster.geometry = readGeometry(operation, reads, request);
	if (request.vertices)
		cluster.vertices = vertexValues(operation, reads.at(*request.vertices), request.source, cluster.truncate_bits, request.text);
	if (request.bounds)
	{
		cluster.bounds.emplace();
		std::memcpy(cluster.bounds->data(), reads.at(*request.bounds).data(), 6 * sizeof(float));
		for (size_t axis = 0; axis < 3; ++axis)
			if (!((*cluster.bounds)[axis] <= (*cluster.bounds)[axis + 3]))
				operation.report().violation("bounds-order", "{}: {} has an instantiationBoundingBoxLimit from {} to {}, right is from less to more",
											 operation.name(), request.text, (*cluster.bounds)[axis], (*cluster.bounds)[axis + 3]);
	}
	return cluster;
}

std::vector<Request> makeRequests(const Operation& operation)
{
	std::vector<Request> requests(operation.count);
	uint64_t triangles = 0, vertices = 0;
	for (uint32_t i = 0; i < operation.count; ++i)
	{
		requests[i].info = argumentOf(operation, i);
		requests[i].text = fmt::format("argument {}", i);
		requests[i].usable = checkNumbers(operation, requests[i]);
		triangles += requests[i].info.triangleCount;
		vertices += requests[i].info.vertexCount;
	}
	checkTotals(operation, triangles, vertices);
	return requests;
}

}  // namespace

VkResult buildTriangleClusters(const Operation& operation)
{
	const RecordKind kind = kindOf(operation.input);
	std::vector<Request> requests = makeRequests(operation);
	Reads reads;
	for (Request& request : requests)
		if (request.usable)
			addReads(operation, reads, request);
	if (const VkResult result = operation.context.read(reads); result != VK_SUCCESS)
		return result;
	std::vector<Cluster> clusters(requests.size());
	std::vector<Product> products(requests.size());
	for (size_t i = 0; i < requests.size(); ++i)
		if (requests[i].usable)
		{
			clusters[i] = makeCluster(operation, reads, requests[i]);
			products[i].bytes = requests[i].usable ? bytesOf(kind, clusters[i]) : 0;
		}
	if (const VkResult result = placeProducts(operation, products); result != VK_SUCCESS)
		return result;
	if (operation.input.mode() == VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_COMPUTE_SIZES_NV)
		return VK_SUCCESS;
	std::vector<std::pair<VkDeviceAddress, std::vector<std::byte>>> records;
	for (size_t i = 0; i < products.size(); ++i)
		if (products[i].address && products[i].bytes)
			records.emplace_back(products[i].address, encode(kind, clusters[i], products[i].address));
	return writeRecords(operation, records);
}

}  // namespace tessera::layer
