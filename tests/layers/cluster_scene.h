// Patches of a bumpy ground as clusters: what the tests of the cluster layer build and trace.
#pragma once
#include "layers/cluster_harness.h"

#include <array>

namespace tessera::test
{

using Position = std::array<float, 3>;

// kQuads x kQuads quads on a unit square of the ground.
inline constexpr uint32_t kQuads = 4;
inline constexpr uint32_t kPatchTriangles = 2 * kQuads * kQuads;
inline constexpr uint32_t kPatchVertices = (kQuads + 1) * (kQuads + 1);

std::vector<Position> patchVertices(uint32_t x, uint32_t y);
std::vector<uint8_t> patchIndices();

// One cluster command and all memory that it needs. prepare() makes it right; what a test changes between prepare() and run() is what it is about.
struct ClusterCommand
{
	explicit ClusterCommand(Gpu& device) : gpu(device) {}

	Gpu& gpu;
	VkClusterAccelerationStructureTriangleClusterInputNV triangles = { VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_TRIANGLE_CLUSTER_INPUT_NV };
	VkClusterAccelerationStructureClustersBottomLevelInputNV bottom_level = {
		VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_CLUSTERS_BOTTOM_LEVEL_INPUT_NV
	};
	VkClusterAccelerationStructureMoveObjectsInputNV move = { VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_MOVE_OBJECTS_INPUT_NV };
	VkClusterAccelerationStructureCommandsInfoNV info = { VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_COMMANDS_INFO_NV };
	std::unique_ptr<Buffer> arguments, count, scratch, results, addresses, sizes;
	uint32_t argument_count = 0;

	void setType(VkClusterAccelerationStructureOpTypeNV type, VkClusterAccelerationStructureOpModeNV mode);
	template <typename Info>
	void setArguments(const std::vector<Info>& infos)
	{
		arguments = std::make_unique<Buffer>(gpu, infos);
		argument_count = static_cast<uint32_t>(infos.size());
		info.srcInfosArray = { arguments->address, sizeof(Info), infos.size() * sizeof(Info) };
	}
	// Asks for sizes and reserves memory for `argument_count` results.
	void prepare();
	// After prepare(): more memory than any of these tests needs, so that a limit can be changed alone.
	void makeRoom();
	// After prepare(): explicit destinations in more room, kExplicitStep bytes apart.
	void makeExplicit();
	VkDeviceAddress& destination(size_t index) { return reinterpret_cast<VkDeviceAddress*>(addresses->data)[index]; }
	void setCount(uint32_t value) { std::memcpy(count->data, &value, sizeof(value)); }
	void record(VkCommandBuffer commands);
	void run();
	std::vector<VkDeviceAddress> resultAddresses() const { return addresses->read<VkDeviceAddress>(argument_count); }
	std::vector<uint32_t> resultSizes() const { return sizes->read<uint32_t>(argument_count); }

private:
	void pointToInput(VkClusterAccelerationStructureInputInfoNV& input);
};

// The patches' vertices and indices on the device.
struct PatchData
{
	explicit PatchData(Gpu& gpu, uint32_t columns, uint32_t rows);
	VkDeviceAddress vertices(uint32_t patch) const { return vertex_buffer.address + VkDeviceSize(patch) * kPatchVertices * sizeof(Position); }

	uint32_t count;
	Buffer vertex_buffer, index_buffer;
};

inline constexpr VkDeviceSize kExplicitStep = 4096;

// Buffers begin anywhere; this is where results and scratch may.
VkDeviceAddress alignedStart(const Buffer& buffer);

using ClusterInfo = VkClusterAccelerationStructureBuildTriangleClusterInfoNV;
using TemplateInfo = VkClusterAccelerationStructureBuildTriangleClusterTemplateInfoNV;
using InstantiateInfo = VkClusterAccelerationStructureInstantiateClusterInfoNV;
using BottomLevelInfo = VkClusterAccelerationStructureBuildClustersBottomLevelInfoNV;

inline constexpr auto kImplicit = VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_IMPLICIT_DESTINATIONS_NV;
inline constexpr auto kExplicit = VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_EXPLICIT_DESTINATIONS_NV;
inline constexpr auto kComputeSizes = VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_COMPUTE_SIZES_NV;

ClusterInfo clusterInfo(const PatchData& data, uint32_t patch, uint32_t id);
TemplateInfo templateInfo(const PatchData& data, uint32_t id);
// Prepared: clusters of patches [first, first + count) with ids from `first_id`.
ClusterCommand buildClusters(Gpu& gpu, const PatchData& data, uint32_t first, uint32_t count, uint32_t first_id);
// Prepared: one template of all patches' triangles, without vertices.
ClusterCommand buildTemplate(Gpu& gpu, const PatchData& data, uint32_t id);
ClusterCommand instantiate(Gpu& gpu, const PatchData& data, VkDeviceAddress from, uint32_t first, uint32_t count, uint32_t first_offset);
// Prepared: bottom-level structures of lists of clusters, which `lists` must outlive.
ClusterCommand buildBottomLevels(Gpu& gpu, const Buffer& lists, const std::vector<uint32_t>& counts);

VkAccelerationStructureInstanceKHR placed(VkDeviceAddress structure, float x, float y, uint32_t custom);

}  // namespace tessera::test
