// Seeded mistakes in where results go: implicit and explicit destinations, arrays of addresses and sizes, moves.
#include "layers/cluster_mistakes.h"

#include <gtest/gtest.h>

namespace tessera::test
{

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

TEST(clusterLayerNames, noResults)
{
	expectNamed("dst-implicit-null", wrongCluster([](auto& c) { c.info.dstImplicitData = 0; }));
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

TEST(clusterLayerNames, addressesInNoBuffer)
{
	expectNamed("dst-addresses-range", wrongCluster([](auto& c) { c.info.dstAddressesArray.deviceAddress = 0x40; }));
}

TEST(clusterLayerNames, addressesNotAligned)
{
	expectNamed("dst-addresses-alignment", wrongCluster([](auto& c) {
					c.info.dstAddressesArray.deviceAddress += 4;
					c.setCount(2);
				}));
}

TEST(clusterLayerNames, sizesNotAligned)
{
	expectNamed("dst-sizes-alignment", wrongCluster([](auto& c) {
					c.info.dstSizesArray.deviceAddress += 2;
					c.setCount(2);
				}));
}

TEST(clusterLayerNames, sizesBeyondTheirArray)
{
	expectNamed("dst-sizes-size", wrongCluster([](auto& c) { c.info.dstSizesArray.size = 8; }));
}

TEST(clusterLayerNames, noPlaceForSizes)
{
	expectNamed("dst-sizes-null", wrongCluster([](auto& c) {
					c.info.input.opMode = kComputeSizes;
					c.info.dstSizesArray = {};
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

TEST(clusterLayerNames, aDestinationInABufferOfOtherUse)
{
	expectNamed("destination-usage", wrongCluster([](auto& c) {
					c.makeExplicit();
					replace(c.results, c.gpu, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
					for (uint32_t i = 0; i < kMistakePatches; ++i)
						c.destination(i) = alignedStart(*c.results) + kExplicitStep * i;
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

TEST(clusterLayerNames, aMoveOfAKindThatIsNone)
{
	expectNamed("move-type", [](Stage& stage) {
		ClusterCommand command = moveClusters(stage.gpu, {}, kImplicit);
		command.move.type = static_cast<VkClusterAccelerationStructureTypeNV>(3);
		command.prepare();
	});
}

TEST(clusterLayerNames, aMoveFromANotAlignedAddress)
{
	expectNamed("move-source-alignment", [](Stage& stage) { moveClusters(stage.gpu, { stage.built()[0] + 32 }, kImplicit).run(); });
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
