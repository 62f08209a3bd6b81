// Seeded mistakes: what they start from, and the check that the layer names each by its name and no other.
#pragma once
#include "layers/cluster_scene.h"

#include <functional>

namespace tessera::test
{

inline constexpr uint32_t kMistakePatches = 4;

// What every mistake starts from. Commands that it ran are kept, as their results are used by later ones.
struct Stage
{
	explicit Stage(Gpu& device) : gpu(device), data(device, kMistakePatches, 1) {}

	ClusterCommand clusters() { return buildClusters(gpu, data, 0, kMistakePatches, 1); }
	// Addresses of clusters that were built rightly.
	std::vector<VkDeviceAddress> built();
	VkDeviceAddress madeTemplate(const std::function<void(TemplateInfo&)>& change = nullptr);
	ClusterCommand instances(VkDeviceAddress from) { return instantiate(gpu, data, from, 0, kMistakePatches, 0); }
	ClusterCommand bottomLevels(const std::vector<VkDeviceAddress>& references);

	Gpu& gpu;
	PatchData data;
	std::vector<std::unique_ptr<ClusterCommand>> kept;
	std::unique_ptr<Buffer> lists;
};

using Mistake = std::function<void(Stage&)>;
using Change = std::function<void(ClusterCommand&)>;

// A right command with one change, run.
Mistake wrongCluster(const Change& change);
Mistake wrongTemplate(const std::function<void(TemplateInfo&)>& change);
Mistake wrongInstance(const Change& change);
Mistake wrongBottomLevel(const Change& change);

template <typename Info>
Info& argument(ClusterCommand& command, size_t index = 0)
{
	return reinterpret_cast<Info*>(command.arguments->data)[index];
}

// Puts a buffer that lacks a usage in place of one that has it all.
void replace(std::unique_ptr<Buffer>& buffer, Gpu& gpu, VkBufferUsageFlags lacking);

// Runs the mistake on a device of its own; the layer must report `violation`, and nothing else.
void expectNamed(const char* violation, const Mistake& mistake);

}  // namespace tessera::test
