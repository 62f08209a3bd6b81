// Seeded mistakes in what all cluster commands share: arguments, counts, scratch, types and modes.
#include "layers/cluster_mistakes.h"

#include <gtest/gtest.h>

namespace tessera::test
{

TEST(clusterLayerNames, aStrideBelowTheStructure)
{
	expectNamed("src-infos-stride", wrongCluster([](auto& c) {
					c.info.srcInfosArray.stride = 56;
					c.setCount(1);
				}));
}

TEST(clusterLayerNames, aStrideThatIsNoMultipleOfEight)
{
	expectNamed("src-infos-stride", wrongCluster([](auto& c) {
					c.info.srcInfosArray.stride = 68;
					c.setCount(1);
				}));
}

TEST(clusterLayerNames, argumentsInNoBuffer)
{
	expectNamed("src-infos-range", wrongCluster([](auto& c) { c.info.srcInfosArray.deviceAddress = 0x10; }));
}

TEST(clusterLayerNames, argumentsBeyondTheirBuffer)
{
	expectNamed("src-infos-range", wrongCluster([](auto& c) { c.info.srcInfosArray.deviceAddress += 8; }));
}

TEST(clusterLayerNames, argumentsNotAligned)
{
	expectNamed("src-infos-alignment", wrongCluster([](auto& c) {
					c.info.srcInfosArray.deviceAddress += 4;
					std::memmove(c.arguments->data + 4, c.arguments->data, sizeof(ClusterInfo));
					c.setCount(1);
				}));
}

TEST(clusterLayerNames, moreArgumentsThanTheArrayHas)
{
	expectNamed("src-infos-size", wrongCluster([](auto& c) { c.info.srcInfosArray.size = 64; }));
}

TEST(clusterLayerNames, argumentsInABufferOfOtherUse)
{
	expectNamed("src-infos-usage", wrongCluster([](auto& c) {
					replace(c.arguments, c.gpu, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
					c.info.srcInfosArray.deviceAddress = c.arguments->address;
				}));
}

TEST(clusterLayerNames, aCountAboveTheDeclared)
{
	expectNamed("src-count-above-max", wrongCluster([](auto& c) { c.setCount(5); }));
}

TEST(clusterLayerNames, aCountInNoBuffer)
{
	expectNamed("src-count-range", wrongCluster([](auto& c) { c.info.srcInfosCount = 0x40; }));
}

TEST(clusterLayerNames, aCountNotAligned)
{
	expectNamed("src-count-alignment", wrongCluster([](auto& c) {
					c.count = std::make_unique<Buffer>(c.gpu, 8);
					c.count->data[2] = std::byte(kMistakePatches);
					c.info.srcInfosCount = c.count->address + 2;
				}));
}

TEST(clusterLayerNames, aCountInABufferOfOtherUse)
{
	expectNamed("src-count-usage", wrongCluster([](auto& c) {
					replace(c.count, c.gpu, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
					c.info.srcInfosCount = c.count->address;
				}));
}

TEST(clusterLayerNames, scratchTooSmall)
{
	expectNamed("scratch-range", wrongCluster([](auto& c) {
					c.scratch = std::make_unique<Buffer>(c.gpu, 4096);
					c.info.scratchData = c.scratch->address + 256 - c.scratch->address % 256;
				}));
}

TEST(clusterLayerNames, scratchNotAligned)
{
	expectNamed("scratch-alignment", wrongCluster([](auto& c) {
					c.makeRoom();
					c.info.scratchData += 128;
				}));
}

TEST(clusterLayerNames, scratchOfOtherUse)
{
	expectNamed("scratch-usage", wrongCluster([](auto& c) {
					replace(c.scratch, c.gpu, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
					c.info.scratchData = alignedStart(*c.scratch);
				}));
}

TEST(clusterLayerNames, scratchWithinTheResults)
{
	expectNamed("scratch-overlap", wrongCluster([](auto& c) {
					c.makeRoom();
					c.info.scratchData = c.info.dstImplicitData;
				}));
}

TEST(clusterLayerNames, aStructureOfAnotherType)
{
	expectNamed("struct-type", wrongCluster([](auto& c) { c.info.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO; }));
}

TEST(clusterLayerNames, aChainWhereThereIsNone)
{
	expectNamed("struct-chain", wrongCluster([](auto& c) { c.triangles.pNext = &c.move; }));
}

TEST(clusterLayerNames, flagsThatContradict)
{
	expectNamed("build-flags", wrongCluster([](auto& c) { c.info.input.flags = 12; }));
}

TEST(clusterLayerNames, anUnknownResolution)
{
	expectNamed("resolution-flags", wrongCluster([](auto& c) { c.info.addressResolutionFlags = 0x40; }));
}

TEST(clusterLayerNames, anAddressByAWrongAddress)
{
	expectNamed("resolution-range", wrongCluster([](auto& c) {
					c.info.addressResolutionFlags = VK_CLUSTER_ACCELERATION_STRUCTURE_ADDRESS_RESOLUTION_INDIRECTED_SRC_INFOS_COUNT_BIT_NV;
					c.info.srcInfosCount = 0x80;
				}));
}

TEST(clusterLayerNames, anAddressByAnAddressNotAligned)
{
	expectNamed("resolution-alignment", wrongCluster([](auto& c) {
					const Buffer where(c.gpu, std::vector<uint32_t>{ 0, uint32_t(c.info.srcInfosCount), uint32_t(c.info.srcInfosCount >> 32) });
					c.info.addressResolutionFlags = VK_CLUSTER_ACCELERATION_STRUCTURE_ADDRESS_RESOLUTION_INDIRECTED_SRC_INFOS_COUNT_BIT_NV;
					c.info.srcInfosCount = where.address + 4;
					c.run();
					c.info.addressResolutionFlags = 0;
					c.info.srcInfosCount = c.count->address;
				}));
}

TEST(clusterLayerNames, anOperationThatIsNone)
{
	expectNamed("op-type", [](Stage& stage) {
		ClusterCommand command = stage.clusters();
		command.info.input.opType = static_cast<VkClusterAccelerationStructureOpTypeNV>(17);
		command.run();
	});
}

TEST(clusterLayerNames, aModeThatIsNone)
{
	expectNamed("op-mode", wrongCluster([](auto& c) { c.info.input.opMode = static_cast<VkClusterAccelerationStructureOpModeNV>(3); }));
}

TEST(clusterLayerNames, aCommandInsideARenderPass)
{
	expectNamed("inside-render-pass", [](Stage& stage) {
		ClusterCommand command = stage.clusters();
		stage.gpu.run([&](VkCommandBuffer commands) {
			VkRenderingInfo rendering = { VK_STRUCTURE_TYPE_RENDERING_INFO };
			rendering.renderArea.extent = { 4, 4 };
			rendering.layerCount = 1;
			vkCmdBeginRendering(commands, &rendering);
			command.record(commands);
			vkCmdEndRendering(commands);
		});
	});
}

}  // namespace tessera::test
