#include "layer/record.h"

#include <cstring>

namespace tessera::layer
{

namespace
{

constexpr uint64_t kMagic = 0x54434c5553544552ull;
constexpr uint32_t kHasVertices = 1, kHasBounds = 2, kGeometryPerTriangle = 4;

uint64_t checksumOf(std::span<const std::byte> bytes)
{
	uint64_t sum = 0xcbf29ce484222325ull;
	for (size_t i = 0; i < bytes.size(); i += sizeof(uint64_t))
	{
		uint64_t word = 0;
		std::memcpy(&word, bytes.data() + i, std::min(sizeof(word), bytes.size() - i));
		sum = (sum ^ word) * 0x100000001b3ull;
		sum ^= sum >> 29;
	}
	return sum;
}

template <typename Type>
void append(std::vector<std::byte>& bytes, const Type* values, size_t count)
{
	const auto* first = reinterpret_cast<const std::byte*>(values);
	bytes.insert(bytes.end(), first, first + count * sizeof(Type));
}

template <typename Type>
std::span<const std::byte> take(std::span<const std::byte> bytes, Type* values, size_t count)
{
	if (count)
		std::memcpy(values, bytes.data(), count * sizeof(Type));
	return bytes.subspan(count * sizeof(Type));
}

std::vector<std::byte> finish(RecordHead head, std::vector<std::byte> bytes)
{
	head.magic = kMagic;
	head.bytes = static_cast<uint32_t>(bytes.size());
	head.checksum = checksumOf(std::span(bytes).subspan(sizeof(head)));
	std::memcpy(bytes.data(), &head, sizeof(head));
	return bytes;
}

}  // namespace

uint64_t clusterBytes(uint64_t triangles, uint64_t vertices, bool geometry_per_triangle)
{
	return sizeof(RecordHead) + sizeof(uint32_t) * (geometry_per_triangle ? triangles : 1) + sizeof(Vertex) * vertices + 3 * triangles;
}

uint64_t templateBytes(uint64_t triangles, uint64_t vertices, bool geometry_per_triangle)
{
	return clusterBytes(triangles, vertices, geometry_per_triangle) + 6 * sizeof(float);
}

uint64_t bottomLevelBytes(uint64_t clusters)
{
	return sizeof(RecordHead) + sizeof(VkDeviceAddress) * clusters;
}

uint64_t bytesOf(RecordKind kind, const Cluster& cluster)
{
	const bool per_triangle = cluster.geometry.size() > 1;
	if (kind == RecordKind::Cluster)
		return clusterBytes(cluster.triangle_count, cluster.vertex_count, per_triangle);
	return templateBytes(cluster.triangle_count, cluster.vertices.size(), per_triangle) - (cluster.bounds ? 0 : 6 * sizeof(float));
}

std::vector<std::byte> encode(RecordKind kind, const Cluster& cluster, VkDeviceAddress address)
{
	RecordHead head = {};
	head.address = address;
	head.kind = kind;
	head.cluster_id = cluster.id;
	head.triangle_count = cluster.triangle_count;
	head.vertex_count = cluster.vertex_count;
	head.vertex_format = cluster.vertex_format;
	head.truncate_bits = cluster.truncate_bits;
	head.parts =
		(cluster.vertices.empty() ? 0 : kHasVertices) | (cluster.bounds ? kHasBounds : 0) | (cluster.geometry.size() > 1 ? kGeometryPerTriangle : 0);
	std::vector<std::byte> bytes(sizeof(head));
	if (cluster.bounds)
		append(bytes, cluster.bounds->data(), 6);
	append(bytes, cluster.geometry.data(), cluster.geometry.size());
	append(bytes, cluster.vertices.data(), cluster.vertices.size());
	append(bytes, cluster.indices.data(), cluster.indices.size());
	return finish(head, std::move(bytes));
}

std::vector<std::byte> encodeBottomLevel(std::span<const VkDeviceAddress> clusters, VkDeviceAddress address, uint64_t serial)
{
	RecordHead head = {};
	head.address = address;
	head.serial = serial;
	head.kind = RecordKind::BottomLevel;
	head.triangle_count = static_cast<uint32_t>(clusters.size());
	std::vector<std::byte> bytes(sizeof(head));
	append(bytes, clusters.data(), clusters.size());
	return finish(head, std::move(bytes));
}

std::optional<RecordHead> headOf(std::span<const std::byte> bytes, VkDeviceAddress address)
{
	RecordHead head;
	if (bytes.size() < sizeof(head))
		return std::nullopt;
	std::memcpy(&head, bytes.data(), sizeof(head));
	if (head.magic != kMagic || head.address != address || head.bytes < sizeof(head))
		return std::nullopt;
	return head;
}

bool isIntact(std::span<const std::byte> record)
{
	RecordHead head;
	std::memcpy(&head, record.data(), sizeof(head));
	return record.size() == head.bytes && checksumOf(record.subspan(sizeof(head))) == head.checksum;
}

Cluster decode(std::span<const std::byte> record)
{
	RecordHead head;
	std::memcpy(&head, record.data(), sizeof(head));
	Cluster cluster;
	cluster.id = head.cluster_id;
	cluster.vertex_format = static_cast<VkFormat>(head.vertex_format);
	cluster.truncate_bits = head.truncate_bits;
	cluster.triangle_count = head.triangle_count;
	cluster.vertex_count = head.vertex_count;
	cluster.geometry.resize(head.parts & kGeometryPerTriangle ? head.triangle_count : 1);
	cluster.vertices.resize(head.parts & kHasVertices ? head.vertex_count : 0);
	cluster.indices.resize(size_t(3) * head.triangle_count);
	std::span<const std::byte> bytes = record.subspan(sizeof(head));
	if (head.parts & kHasBounds)
	{
		cluster.bounds.emplace();
		bytes = take(bytes, cluster.bounds->data(), 6);
	}
	bytes = take(bytes, cluster.geometry.data(), cluster.geometry.size());
	bytes = take(bytes, cluster.vertices.data(), cluster.vertices.size());
	take(bytes, cluster.indices.data(), cluster.indices.size());
	return cluster;
}

void readdress(std::span<std::byte> record, VkDeviceAddress address)
{
	RecordHead head;
	std::memcpy(&head, record.data(), sizeof(head));
	head.address = address;
	std::memcpy(record.data(), &head, sizeof(head));
}

}  // namespace tessera::layer
