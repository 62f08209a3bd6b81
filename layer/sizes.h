// What memory a cluster command needs: the layer's own records are what is reserved and written.
#pragma once
#include "layer/host_commands.h"
#include "layer/record.h"

#include <optional>

namespace tessera::layer
{

struct Sizes
{
	VkDeviceSize structures = 0;  // all of a command's, with each aligned
	VkDeviceSize scratch = 0;
};

// Worst case of an input.
Sizes sizesOf(const ClusterInput& input);

// Of what an operation makes.
RecordKind kindOf(const ClusterInput& input);
VkDeviceSize alignmentOf(RecordKind kind);
const char* nameOf(VkClusterAccelerationStructureOpTypeNV type);

// Bytes of an entry of srcInfosArray.
size_t infoBytes(VkClusterAccelerationStructureOpTypeNV type);

// Bytes of a vertex and of one of its numbers; nothing for formats that the layer does not read.
struct VertexLayout
{
	uint32_t bytes = 0, component_bytes = 0, components = 0;
};
std::optional<VertexLayout> vertexLayout(VkFormat format);

inline VkDeviceSize alignUp(VkDeviceSize value, VkDeviceSize alignment)
{
	return (value + alignment - 1) / alignment * alignment;
}

// Names what is wrong with an input by itself. `where`: the command.
void checkInput(Device& device, const ClusterInput& input, const char* where);

}  // namespace tessera::layer
