// A cluster command as it is executed: its addresses resolved, its arguments read.
//
//   cluster_command    resolves addresses, reads the count and the arguments, checks what all operations share
//   triangle_clusters, instantiate, bottom_level, move_objects    make the products
//   destinations       gives each product its address, and writes addresses, sizes and records
#pragma once
#include "layer/device.h"
#include "layer/sizes.h"

#include <cstring>
#include <span>
#include <vector>

namespace tessera::layer
{

struct Operation
{
	const HostContext& context;
	const ClusterInput& input;
	VkClusterAccelerationStructureCommandsInfoNV info = {};  // with addresses that were given by address replaced by what stood there
	Sizes sizes;                                             // of the input's worst case
	uint32_t count = 0;
	std::vector<std::byte> arguments;  // `count` entries of infoBytes()

	Device& device() const { return context.device; }
	Report& report() const { return context.device.report; }
	const char* name() const { return nameOf(input.type()); }
	template <typename Info>
	Info argument(uint32_t index) const
	{
		Info value;
		std::memcpy(&value, arguments.data() + index * sizeof(value), sizeof(value));
		return value;
	}
};

// The place of [address, address + size), or nothing with a violation "WHAT-range" or "WHAT-usage". `usage` 0: any. `text` says whose it is.
std::optional<Place> placeOf(const Operation& operation, const char* what, VkDeviceAddress address, VkDeviceSize size, VkBufferUsageFlags usage,
							 const std::string& text);
// "WHAT-alignment" when it is not a multiple.
void checkAlignment(const Operation& operation, const char* what, VkDeviceAddress address, VkDeviceSize alignment, const std::string& text);

// What an operation makes of one argument.
struct Product
{
	VkDeviceSize bytes = 0;  // 0: nothing could be made (a violation said why)
	VkDeviceAddress address = 0;
};

// Gives every product its address, by the operation's mode, and writes the arrays of addresses and sizes. With mode compute sizes only the latter.
VkResult placeProducts(const Operation& operation, std::span<Product> products);
// Writes records to their addresses; structures of the layer that lay there are gone, unless they came there with these records.
VkResult writeRecords(const Operation& operation, std::span<const std::pair<VkDeviceAddress, std::vector<std::byte>>> records,
					  bool structures_placed = false);

// How violations of references are named.
struct ReferenceNames
{
	const char* alignment;  // without "-alignment"
	const char* wrong;      // it refers to nothing, or to something else
};
// What stands at addresses that should be records of a kind: whole records, nothing where there is none (a violation says so).
VkResult readRecords(const Operation& operation, std::span<const VkDeviceAddress> addresses, RecordKind kind, const ReferenceNames& names,
					 std::vector<std::optional<std::vector<std::byte>>>& records);

VkResult buildTriangleClusters(const Operation& operation);
VkResult instantiateClusters(const Operation& operation);
VkResult buildBottomLevels(const Operation& operation);
VkResult moveObjects(const Operation& operation);

// Vertices of a buffer, or the reason why they cannot be read. Shared by clusters, templates and instantiations.
struct VertexSource
{
	VkDeviceAddress address = 0;
	VkDeviceSize stride = 0;  // 0: tight
	uint32_t count = 0;
};
// Adds the read and returns its number.
// "total-triangles-above-max" and "total-vertices-above-max": those of all arguments together.
void checkTotals(const Operation& operation, uint64_t triangles, uint64_t vertices);
std::optional<size_t> addVertexRead(const Operation& operation, Reads& reads, const VertexSource& source, const std::string& text);
// The vertices as floats with their last bits taken away; names those that are not finite.
std::vector<Vertex> vertexValues(const Operation& operation, std::span<const std::byte> bytes, const VertexSource& source, uint32_t truncate_bits,
								 const std::string& text);

}  // namespace tessera::layer
