// Clusters of templates and new vertices, and reading vertices for all that have some.
#include "layer/operation.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace tessera::layer
{

namespace
{

using Info = VkClusterAccelerationStructureInstantiateClusterInfoNV;

struct Request
{
	Info info = {};
	std::string text;
	const Cluster* from = nullptr;  // null: nothing can be made
	VertexSource source;
	std::optional<size_t> vertices;
};

// Every template that is referred to, once.
VkResult readTemplates(const Operation& operation, std::span<const Request> requests, std::unordered_map<VkDeviceAddress, Cluster>& templates)
{
	std::vector<VkDeviceAddress> addresses;
	for (const Request& request : requests)
		addresses.push_back(request.info.clusterTemplateAddress);
	std::sort(addresses.begin(), addresses.end());
	addresses.erase(std::unique(addresses.begin(), addresses.end()), addresses.end());
	std::vector<std::optional<std::vector<std::byte>>> records;
	const VkResult result = readRecords(operation, addresses, RecordKind::Template, { "template", "not-a-template" }, records);
	for (size_t i = 0; result == VK_SUCCESS && i < addresses.size(); ++i)
		if (records[i])
			templates[addresses[i]] = decode(*records[i]);
	return result;
}

void checkRequest(const Operation& operation, const Request& request)
{
	Report& report = operation.report();
	const Cluster& from = *request.from;
	const auto& limits = operation.input.triangles;
	const char* name = operation.name();
	if (request.info.reserved != 0)
		report.violation("instantiate-reserved-bits", "{}: {} has reserved bits {:#x}, right is 0", name, request.text,
						 uint32_t(request.info.reserved));
	if (from.id + request.info.clusterIdOffset == UINT32_MAX)
		report.violation("cluster-id-reserved", "{}: {} has clusterID {} of the template plus {}, which is 0xffffffff", name, request.text, from.id,
						 request.info.clusterIdOffset);
	if (from.vertex_format != limits.vertexFormat)
		report.violation("template-vertex-format", "{}: {} has vertexFormat {}, its template was built with {}", name, request.text,
						 int(limits.vertexFormat), int(from.vertex_format));
	if (from.triangle_count > limits.maxClusterTriangleCount)
		report.violation("triangles-above-max", "{}: {}'s template has {} triangles, maxClusterTriangleCount is {}", name, request.text,
						 from.triangle_count, limits.maxClusterTriangleCount);
	if (from.vertex_count > limits.maxClusterVertexCount)
		report.violation("vertices-above-max", "{}: {}'s template has {} vertices, maxClusterVertexCount is {}", name, request.text,
						 from.vertex_count, limits.maxClusterVertexCount);
	if (from.truncate_bits < limits.minPositionTruncateBitCount)
		report.violation("truncate-bits", "{}: {}'s template truncates {} bits, minPositionTruncateBitCount is {}", name, request.text,
						 from.truncate_bits, limits.minPositionTruncateBitCount);
}

void checkTotalsOf(const Operation& operation, std::span<const Request> requests)
{
	uint64_t triangles = 0, vertices = 0;
	for (const Request& request : requests)
		if (request.from)
		{
			triangles += request.from->triangle_count;
			vertices += request.from->vertex_count;
		}
	checkTotals(operation, triangles, vertices);
}

void addRead(const Operation& operation, Reads& reads, Request& request)
{
	request.source = { request.info.vertexBuffer.startAddress, request.info.vertexBuffer.strideInBytes, request.from->vertex_count };
	if (request.source.address)
	{
		request.vertices = addVertexRead(operation, reads, request.source, request.text + "'s vertexBuffer");
		if (!request.vertices)
			request.from = nullptr;
	}
	else if (request.from->vertices.empty() && request.from->vertex_count > 0)
	{
		operation.report().violation("template-without-vertices", "{}: {} has no vertexBuffer, and its template was built without vertices",
									 operation.name(), request.text);
		request.from = nullptr;
	}
}

void checkBounds(const Operation& operation, const Request& request, const Cluster& cluster)
{
	if (!request.from->bounds)
		return;
	const auto& box = *request.from->bounds;
	for (const Vertex& vertex : cluster.vertices)
		for (size_t axis = 0; axis < 3; ++axis)
			if (vertex[axis] < box[axis] || vertex[axis] > box[axis + 3])
			{
				operation.report().violation("instantiation-bounds", "{}: {} has a vertex at {} on axis {}, its template's limits are {} to {}",
											 operation.name(), request.text, vertex[axis], axis, box[axis], box[axis + 3]);
				return;
			}
}

Cluster makeCluster(const Operation& operation, const Reads& reads, const Request& request)
{
	Cluster cluster = *request.from;
	cluster.bounds.reset();
	cluster.id += request.info.clusterIdOffset;
	if (request.vertices)
		cluster.vertices = vertexValues(operation, reads.at(*request.vertices), request.source, cluster.truncate_bits, request.text);
	checkBounds(operation, request, cluster);
	// 24 bits with a sign.
	const int32_t offset = int32_t(uint32_t(request.info.geometryIndexOffset) << 8) >> 8;
	const auto most = int64_t(std::min(operation.input.triangles.maxGeometryIndexValue, clusterProperties().maxClusterGeometryIndex - 1));
	for (uint32_t& packed : cluster.geometry)
	{
		const int64_t index = int64_t(packed & kGeometryIndexMask) + offset;
		if (index < 0 || index > most)
			operation.report().violation("geometry-index-above-max", "{}: {} has geometry index {}, right is from 0 to {}", operation.name(),
										 request.text, index, most);
		packed = (packed & ~kGeometryIndexMask) | (uint32_t(index) & kGeometryIndexMask);
	}
	return cluster;
}

float component(const std::byte* bytes, const VertexLayout& layout, uint32_t truncate_bits)
{
	if (layout.component_bytes == 2)
	{
		int16_t value;
		std::memcpy(&value, bytes, sizeof(value));
		return std::max(float(value) / 32767.0f, -1.0f);
	}
	uint32_t bits;
	std::memcpy(&bits, bytes, sizeof(bits));
	bits = truncate_bits >= 32 ? 0 : bits >> truncate_bits << truncate_bits;
	float value;
	std::memcpy(&value, &bits, sizeof(value));
	return value;
}

}  // namespace

void checkTotals(const Operation& operation, uint64_t triangles, uint64_t vertices)
{
	const auto& limits = operation.input.triangles;
	if (triangles > limits.maxTotalTriangleCount)
		operation.report().violation("total-triangles-above-max", "{}: {} triangles in all, maxTotalTriangleCount is {}", operation.name(), triangles,
									 limits.maxTotalTriangleCount);
	if (vertices > limits.maxTotalVertexCount)
		operation.report().violation("total-vertices-above-max", "{}: {} vertices in all, maxTotalVertexCount is {}", operation.name(), vertices,
									 limits.maxTotalVertexCount);
}

std::optional<size_t> addVertexRead(const Operation& operation, Reads& reads, const VertexSource& source, const std::string& text)
{
	const auto layout = vertexLayout(operation.input.triangles.vertexFormat);
	if (!layout)
		return std::nullopt;
	checkAlignment(operation, "vertex-buffer", source.address, layout->component_bytes, text);
	if (source.stride % layout->component_bytes != 0 || (source.stride != 0 && source.stride < layout->bytes))
		operation.report().violation("vertex-stride", "{}: {} has stride {}, right is 0 or a multiple of {}, at least {}", operation.name(), text,
									 source.stride, layout->component_bytes, layout->bytes);
	const VkDeviceSize stride = source.stride ? source.stride : layout->bytes;
	const VkDeviceSize bytes = source.count ? stride * (source.count - 1) + layout->bytes : 0;
	const auto place = placeOf(operation, "vertex-buffer", source.address, bytes, 0, text);
	return place ? std::optional(reads.add(*place, bytes)) : std::nullopt;
}

std::vector<Vertex> vertexValues(const Operation& operation, std::span<const std::byte> bytes, const VertexSource& source, uint32_t truncate_bits,
								 const std::string& text)
{
	const VertexLayout layout = *vertexLayout(operation.input.triangles.vertexFormat);
	const size_t stride = source.stride ? source.stride : layout.bytes;
	std::vector<Vertex> vertices(source.count, Vertex{});
	for (size_t i = 0; i < vertices.size(); ++i)
	{
		for (uint32_t axis = 0; axis < std::min(layout.components, 3u); ++axis)
			vertices[i][axis] = component(bytes.data() + i * stride + axis * layout.component_bytes, layout, truncate_bits);
		// A NaN in x makes its triangles inactive; anything else that is not finite has no meaning.
		if (!std::isnan(vertices[i][0]) && !(std::isfinite(vertices[i][0]) && std::isfinite(vertices[i][1]) && std::isfinite(vertices[i][2])))
			operation.report().violation("vertex-not-finite", "{}: {} has vertex {} at ({}, {}, {})", operation.name(), text, i, vertices[i][0],
										 vertices[i][1], vertices[i][2]);
	}
	return vertices;
}

VkResult instantiateClusters(const Operation& operation)
{
	std::vector<Request> requests(operation.count);
	for (uint32_t i = 0; i < operation.count; ++i)
	{
		requests[i].info = operation.argument<Info>(i);
		requests[i].text = fmt::format("argument {}", i);
	}
	std::unordered_map<VkDeviceAddress, Cluster> templates;
	if (const VkResult result = readTemplates(operation, requests, templates); result != VK_SUCCESS)
		return result;
	const bool sizes_only = operation.input.mode() == VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_COMPUTE_SIZES_NV;
	Reads reads;
	for (Request& request : requests)
	{
		const auto found = templates.find(request.info.clusterTemplateAddress);
		if (found == templates.end())
			continue;
		request.from = &found->second;
		checkRequest(operation, request);
	}
	checkTotalsOf(operation, requests);
	for (Request& request : requests)
		if (request.from && !sizes_only)
			addRead(operation, reads, request);
	if (const VkResult result = operation.context.read(reads); result != VK_SUCCESS)
		return result;
	std::vector<Product> products(requests.size());
	for (size_t i = 0; i < requests.size(); ++i)
		if (requests[i].from)
			products[i].bytes = bytesOf(RecordKind::Cluster, *requests[i].from);
	VkResult result = placeProducts(operation, products);
	if (result != VK_SUCCESS || sizes_only)
		return result;
	std::vector<std::pair<VkDeviceAddress, std::vector<std::byte>>> records;
	for (size_t i = 0; i < products.size(); ++i)
		if (products[i].address && products[i].bytes)
			records.emplace_back(products[i].address, encode(RecordKind::Cluster, makeCluster(operation, reads, requests[i]), products[i].address));
	return writeRecords(operation, records);
}

}  // namespace tessera::layer
