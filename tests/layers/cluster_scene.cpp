#include "layers/cluster_scene.h"

#include <cmath>
#include <numeric>

namespace tessera::test
{

namespace
{

// Buffers begin anywhere: room to move up to what the extension asks for.
constexpr VkDeviceSize kMostAlignment = 256;

VkClusterAccelerationStructureTriangleClusterInputNV patchInput(uint32_t count)
{
	VkClusterAccelerationStructureTriangleClusterInputNV input = { VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_TRIANGLE_CLUSTER_INPUT_NV };
	input.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
	input.maxGeometryIndexValue = 100;
	input.maxClusterUniqueGeometryCount = 1;
	input.maxClusterTriangleCount = kPatchTriangles;
	input.maxClusterVertexCount = kPatchVertices;
	input.maxTotalTriangleCount = count * kPatchTriangles;
	input.maxTotalVertexCount = count * kPatchVertices;
	return input;
}

std::vector<Position> allVertices(uint32_t columns, uint32_t rows)
{
	std::vector<Position> vertices;
	for (uint32_t y = 0; y < rows; ++y)
		for (uint32_t x = 0; x < columns; ++x)
		{
			const auto patch = patchVertices(x, y);
			vertices.insert(vertices.end(), patch.begin(), patch.end());
		}
	return vertices;
}

}  // namespace

VkDeviceAddress alignedStart(const Buffer& buffer)
{
	return (buffer.address + kMostAlignment - 1) / kMostAlignment * kMostAlignment;
}

std::vector<Position> patchVertices(uint32_t x, uint32_t y)
{
	std::vector<Position> vertices;
	for (uint32_t j = 0; j <= kQuads; ++j)
		for (uint32_t i = 0; i <= kQuads; ++i)
		{
			const float at_x = float(x) + float(i) / kQuads, at_y = float(y) + float(j) / kQuads;
			vertices.push_back({ at_x, at_y, 0.3f * std::sin(2.1f * at_x + 0.4f) * std::cos(1.7f * at_y) });
		}
	return vertices;
}

std::vector<uint8_t> patchIndices()
{
	std::vector<uint8_t> indices;
	const auto at = [](uint32_t i, uint32_t j) {
		return static_cast<uint8_t>(j * (kQuads + 1) + i);
	};
	for (uint32_t j = 0; j < kQuads; ++j)
		for (uint32_t i = 0; i < kQuads; ++i)
			indices.insert(indices.end(), { at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1) });
	return indices;
}

PatchData::PatchData(Gpu& gpu, uint32_t columns, uint32_t rows)
	: count(columns * rows), vertex_buffer(gpu, allVertices(columns, rows)), index_buffer(gpu, patchIndices())
{}

void ClusterCommand::setType(VkClusterAccelerationStructureOpTypeNV type, VkClusterAccelerationStructureOpModeNV mode)
{
	info.input = { VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_INPUT_INFO_NV };
	info.input.opType = type;
	info.input.opMode = mode;
}

void ClusterCommand::pointToInput(VkClusterAccelerationStructureInputInfoNV& input)
{
	if (input.opType == VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_MOVE_OBJECTS_NV)
		input.opInput.pMoveObjects = &move;
	else if (input.opType == VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_CLUSTERS_BOTTOM_LEVEL_NV)
		input.opInput.pClustersBottomLevel = &bottom_level;
	else
		input.opInput.pTriangleClusters = &triangles;
}

void ClusterCommand::record(VkCommandBuffer commands)
{
	pointToInput(info.input);
	gpu.CmdBuildClusterAccelerationStructureIndirectNV(commands, &info);
}

void ClusterCommand::prepare()
{
	auto& input = info.input;
	input.maxAccelerationStructureCount = argument_count;
	input.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
	pointToInput(input);
	VkAccelerationStructureBuildSizesInfoKHR needs = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR };
	gpu.GetClusterAccelerationStructureBuildSizesNV(gpu.device, &input, &needs);
	scratch = std::make_unique<Buffer>(gpu, needs.buildScratchSize + kMostAlignment);
	results = std::make_unique<Buffer>(gpu, needs.accelerationStructureSize + kMostAlignment);
	addresses = std::make_unique<Buffer>(gpu, VkDeviceSize(8) * argument_count);
	sizes = std::make_unique<Buffer>(gpu, VkDeviceSize(4) * argument_count);
	count = std::make_unique<Buffer>(gpu, std::vector<uint32_t>{ argument_count });
	info.scratchData = alignedStart(*scratch);
	info.srcInfosCount = count->address;
	info.dstAddressesArray = { addresses->address, 8, addresses->size };
	info.dstSizesArray = { sizes->address, 4, sizes->size };
	if (input.opMode == kImplicit)
		info.dstImplicitData = alignedStart(*results);
	if (input.opMode == kExplicit)
		info.dstSizesArray = {};
}

void ClusterCommand::makeRoom()
{
	results = std::make_unique<Buffer>(gpu, 1 << 16);
	scratch = std::make_unique<Buffer>(gpu, 1 << 18);
	info.dstImplicitData = alignedStart(*results);
	info.scratchData = alignedStart(*scratch);
}

void ClusterCommand::makeExplicit()
{
	makeRoom();
	info.input.opMode = kExplicit;
	info.dstImplicitData = 0;
	info.dstSizesArray = {};
	for (uint32_t i = 0; i < argument_count; ++i)
		destination(i) = alignedStart(*results) + kExplicitStep * i;
}

void ClusterCommand::run()
{
	gpu.run([&](VkCommandBuffer commands) { record(commands); });
}

ClusterInfo clusterInfo(const PatchData& data, uint32_t patch, uint32_t id)
{
	ClusterInfo info = {};
	info.clusterID = id;
	info.triangleCount = kPatchTriangles;
	info.vertexCount = kPatchVertices;
	info.indexType = VK_CLUSTER_ACCELERATION_STRUCTURE_INDEX_FORMAT_8BIT_NV;
	info.baseGeometryIndexAndGeometryFlags.geometryIndex = (id % 7) & 0xffffffu;
	info.baseGeometryIndexAndGeometryFlags.geometryFlags = VK_CLUSTER_ACCELERATION_STRUCTURE_GEOMETRY_OPAQUE_BIT_NV;
	info.indexBufferStride = 1;
	info.vertexBufferStride = sizeof(Position);
	info.indexBuffer = data.index_buffer.address;
	info.vertexBuffer = data.vertices(patch);
	return info;
}

TemplateInfo templateInfo(const PatchData& data, uint32_t id)
{
	TemplateInfo info = {};
	const ClusterInfo cluster = clusterInfo(data, 0, id);
	std::memcpy(&info, &cluster, sizeof(cluster));
	info.baseGeometryIndexAndGeometryFlags.geometryIndex = 3;
	info.vertexBuffer = 0;
	return info;
}

ClusterCommand buildClusters(Gpu& gpu, const PatchData& data, uint32_t first, uint32_t count, uint32_t first_id)
{
	ClusterCommand command(gpu);
	command.triangles = patchInput(count);
	command.setType(VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_NV, kImplicit);
	std::vector<ClusterInfo> infos;
	for (uint32_t i = 0; i < count; ++i)
		infos.push_back(clusterInfo(data, first + i, first_id + i));
	command.setArguments(infos);
	command.prepare();
	return command;
}

ClusterCommand buildTemplate(Gpu& gpu, const PatchData& data, uint32_t id)
{
	ClusterCommand command(gpu);
	command.triangles = patchInput(1);
	command.setType(VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_TEMPLATE_NV, kImplicit);
	command.setArguments(std::vector{ templateInfo(data, id) });
	command.prepare();
	return command;
}

ClusterCommand instantiate(Gpu& gpu, const PatchData& data, VkDeviceAddress from, uint32_t first, uint32_t count, uint32_t first_offset)
{
	ClusterCommand command(gpu);
	command.triangles = patchInput(count);
	command.setType(VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_INSTANTIATE_TRIANGLE_CLUSTER_NV, kImplicit);
	std::vector<InstantiateInfo> infos(count, InstantiateInfo{});
	for (uint32_t i = 0; i < count; ++i)
	{
		infos[i].clusterIdOffset = first_offset + i;
		infos[i].geometryIndexOffset = i & 0xffffffu;
		infos[i].clusterTemplateAddress = from;
		infos[i].vertexBuffer = { data.vertices(first + i), sizeof(Position) };
	}
	command.setArguments(infos);
	command.prepare();
	return command;
}

ClusterCommand buildBottomLevels(Gpu& gpu, const Buffer& lists, const std::vector<uint32_t>& counts)
{
	ClusterCommand command(gpu);
	command.setType(VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_CLUSTERS_BOTTOM_LEVEL_NV, kImplicit);
	std::vector<BottomLevelInfo> infos;
	VkDeviceAddress next = lists.address;
	for (const uint32_t count : counts)
	{
		infos.push_back({ count, 8, next });
		next += VkDeviceSize(8) * count;
		command.bottom_level.maxClusterCountPerAccelerationStructure = std::max(command.bottom_level.maxClusterCountPerAccelerationStructure, count);
		command.bottom_level.maxTotalClusterCount += count;
	}
	command.setArguments(infos);
	command.prepare();
	return command;
}

VkAccelerationStructureInstanceKHR placed(VkDeviceAddress structure, float x, float y, uint32_t custom)
{
	VkAccelerationStructureInstanceKHR instance = {};
	instance.transform.matrix[0][0] = instance.transform.matrix[1][1] = instance.transform.matrix[2][2] = 1.0f;
	instance.transform.matrix[0][3] = x;
	instance.transform.matrix[1][3] = y;
	instance.mask = 0xff;
	instance.instanceCustomIndex = custom & 0xffffffu;
	instance.accelerationStructureReference = structure;
	return instance;
}

}  // namespace tessera::test
