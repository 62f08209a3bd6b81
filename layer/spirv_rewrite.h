// Shader modules for a driver that knows nothing of clusters.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tessera::layer
{

struct Rewritten
{
	std::vector<uint32_t> words;  // empty: the module can be used as it is
	bool reads_cluster_id = false;
	bool says_so = false;                                       // it has the capability, as it must
	std::vector<std::pair<std::string, std::string>> problems;  // what the layer cannot do, by name
};

// Replaces what a shader reads of gl_ClusterIDNV, gl_GeometryIndexEXT, gl_InstanceCustomIndexEXT and their like of ray queries by look-ups in the
// tables whose addresses stand at `root` (lookup_table.h).
Rewritten rewriteShader(std::span<const uint32_t> words, VkDeviceAddress root);

}  // namespace tessera::layer
