// What the layer writes where a driver would put a cluster, a template or a bottom-level structure: a record of its own, whole in the program's
// memory, so that memory which is reused too early, overwritten or copied by other means shows.
#pragma once
#include <vulkan/vulkan.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tessera::layer
{

enum class RecordKind : uint32_t
{
	BottomLevel = 0,  // the values of VkClusterAccelerationStructureTypeNV
	Cluster = 1,
	Template = 2,
};

struct RecordHead
{
	uint64_t magic;
	uint64_t address;   // where it was written
	uint64_t checksum;  // of what follows the head
	uint64_t serial;    // of a bottom-level structure
	RecordKind kind;
	uint32_t bytes;  // with the head
	uint32_t cluster_id;
	uint32_t triangle_count;  // a bottom-level structure: clusters
	uint32_t vertex_count;
	uint32_t vertex_format;
	uint32_t truncate_bits;
	uint32_t parts;  // kHas...
};
static_assert(sizeof(RecordHead) == 64);

using Vertex = std::array<float, 3>;

// A cluster, or a template: then vertices may be missing.
struct Cluster
{
	uint32_t id = 0;
	VkFormat vertex_format = VK_FORMAT_UNDEFINED;
	uint32_t truncate_bits = 0;
	uint32_t triangle_count = 0, vertex_count = 0;
	std::vector<Vertex> vertices;
	std::vector<uint8_t> indices;
	std::vector<uint32_t> geometry;  // of all triangles, or one per triangle: 24 bits of index, 5 of nothing, 3 of flags
	std::optional<std::array<float, 6>> bounds;

	uint32_t geometryOf(size_t triangle) const { return geometry[geometry.size() == 1 ? 0 : triangle]; }
};

inline constexpr uint32_t kGeometryIndexMask = 0xffffffu;
inline constexpr uint32_t kGeometryFlagsShift = 29;

// Bytes of a record, without rounding up to the next one's alignment.
uint64_t clusterBytes(uint64_t triangles, uint64_t vertices, bool geometry_per_triangle);
uint64_t templateBytes(uint64_t triangles, uint64_t vertices, bool geometry_per_triangle);
uint64_t bottomLevelBytes(uint64_t clusters);
uint64_t bytesOf(RecordKind kind, const Cluster& cluster);

std::vector<std::byte> encode(RecordKind kind, const Cluster& cluster, VkDeviceAddress address);
std::vector<std::byte> encodeBottomLevel(std::span<const VkDeviceAddress> clusters, VkDeviceAddress address, uint64_t serial);

// Nothing when the bytes are no record that was written to this address.
std::optional<RecordHead> headOf(std::span<const std::byte> bytes, VkDeviceAddress address);
// Are these, head included, what was written?
bool isIntact(std::span<const std::byte> record);
// Of an intact cluster or template.
Cluster decode(std::span<const std::byte> record);
// The same record for another address.
void readdress(std::span<std::byte> record, VkDeviceAddress address);

}  // namespace tessera::layer
