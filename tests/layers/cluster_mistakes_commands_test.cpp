// Seeded mistakes in what all cluster commands share: arrays, counts, scratch, destinations, moves.
#include "layers/cluster_mistakes.h"

#include <gtest/gtest.h>

namespace tessera::test
{

// What all commands share.

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

TEST(clusterLayerNames, noPlaceForResults)
{
	expectNamed("dst-implicit-range", wrongCluster([](auto& c) { c.info.dstImplicitData = 0x100; }));
}

TEST(clusterLayerNames, resultsBeyondTheirBuffer)
{
	expectNamed("dst-implicit-range", wrongCluster([](auto& c) { c.info.dstImplicitData += 512; }));
}

TEST(clusterLayerNames, resultsNotAligned)
{
	expectNamed("dst-implicit-alignment", wrongCluster([](auto& c) {
					c.makeRoom();
					c.info.dstImplicitData += 64;
				}));
}

TEST(clusterLayerNames, resultsInABufferOfOtherUse)
{
	expectNamed("dst-implicit-usage", wrongCluster([](auto& c) {
					replace(c.results, c.gpu, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
					c.info.dstImplicitData = alignedStart(*c.results);
				}));
}

TEST(clusterLayerNames, addressesTooClose)
{
	expectNamed("dst-addresses-stride", wrongCluster([](auto& c) { c.info.dstAddressesArray.stride = 4; }));
}

TEST(clusterLayerNames, addressesBeyondTheirArray)
{
	expectNamed("dst-addresses-size", wrongCluster([](auto& c) { c.info.dstAddressesArray.size = 8; }));
}

TEST(clusterLayerNames, addressesInABufferOfOtherUse)
{
	expectNamed("dst-addresses-usage", wrongCluster([](auto& c) {
					replace(c.addresses, c.gpu, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
					c.info.dstAddressesArray.deviceAddress = c.addresses->address;
				}));
}

TEST(clusterLayerNames, sizesTooClose)
{
	expectNamed("dst-sizes-stride", wrongCluster([](auto& c) { c.info.dstSizesArray.stride = 2; }));
}

TEST(clusterLayerNames, sizesInNoBuffer)
{
	expectNamed("dst-sizes-range", wrongCluster([](auto& c) { c.info.dstSizesArray.deviceAddress = 0x20; }));
}

TEST(clusterLayerNames, noPlaceForSizes)
{
	expectNamed("dst-sizes-null", wrongCluster([](auto& c) {
					c.info.input.opMode = kComputeSizes;
					c.info.dstSizesArray = {};
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

// Explicit destinations.

TEST(clusterLayerNames, aDestinationNotAligned)
{
	expectNamed("destination-alignment", wrongCluster([](auto& c) {
					c.makeExplicit();
					c.destination(2) += 64;
				}));
}

TEST(clusterLayerNames, destinationsThatOverlap)
{
	expectNamed("destinations-overlap", wrongCluster([](auto& c) {
					c.makeExplicit();
					c.destination(3) = c.destination(2) + 128;
				}));
}

TEST(clusterLayerNames, aDestinationInNoBuffer)
{
	expectNamed("destination-range", wrongCluster([](auto& c) {
					c.makeExplicit();
					c.destination(1) = 0;
				}));
}

TEST(clusterLayerNames, aDestinationSmallerThanTheResult)
{
	expectNamed("destination-too-small", wrongCluster([](auto& c) {
					c.makeExplicit();
					c.sizes = std::make_unique<Buffer>(c.gpu, std::vector<uint32_t>{ 4096, 100, 4096, 4096 });
					c.info.dstSizesArray = { c.sizes->address, 4, 16 };
				}));
}

TEST(clusterLayerNames, noDestinations)
{
	expectNamed("dst-addresses-null", wrongCluster([](auto& c) {
					c.makeExplicit();
					c.info.dstAddressesArray = {};
				}));
}

// Moves.

namespace
{

ClusterCommand moveClusters(Gpu& gpu, const std::vector<VkDeviceAddress>& sources, VkClusterAccelerationStructureOpModeNV mode)
{
	ClusterCommand command(gpu);
	command.setType(VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_MOVE_OBJECTS_NV, mode);
	command.move.type = VK_CLUSTER_ACCELERATION_STRUCTURE_TYPE_TRIANGLE_CLUSTER_NV;
	command.move.maxMovedBytes = 1 << 14;
	command.setArguments(sources);
	command.prepare();
	return command;
}

}  // namespace

TEST(clusterLayerNames, aMoveOfNothing)
{
	expectNamed("move-source", [](Stage& stage) { moveClusters(stage.gpu, { stage.data.vertex_buffer.address }, kImplicit).run(); });
}

TEST(clusterLayerNames, aMoveOfMoreThanDeclared)
{
	expectNamed("max-moved-bytes", [](Stage& stage) {
		ClusterCommand command = moveClusters(stage.gpu, stage.built(), kImplicit);
		command.move.maxMovedBytes = 100;
		command.run();
	});
}

TEST(clusterLayerNames, aMoveOntoItsSourceThatIsSaidNotToBe)
{
	expectNamed("move-overlap", [](Stage& stage) {
		const auto built = stage.built();
		ClusterCommand command = moveClusters(stage.gpu, { built[1] }, kExplicit);
		command.move.noMoveOverlap = VK_TRUE;
		command.destination(0) = built[1] - 128;
		command.run();
	});
}

}  // namespace tessera::test
