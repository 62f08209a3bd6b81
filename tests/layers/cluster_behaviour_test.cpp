// What clusters do besides being met by rays: explicit destinations, sizes, moves, geometry indices, commands between others.
#include "layers/cluster_mistakes.h"
#include "layers/cluster_tracer.h"
#include "layers/layer_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::test
{

namespace
{

constexpr uint32_t kSide = 40;
constexpr float kExtent = float(kMistakePatches);

void onACleanDevice(const std::function<void(Stage&)>& use)
{
	const LayerReport report = underTheLayer([&](Gpu& gpu) {
		Stage stage(gpu);
		use(stage);
	});
	if (!report.device)
		GTEST_SKIP() << "the device cannot trace rays";
	for (const auto& [name, text] : report.texts)
		ADD_FAILURE() << name << ": " << text;
	EXPECT_TRUE(report.limits.empty());
}

// What rays meet in a scene of one structure of these clusters.
std::vector<Hit> hitsOf(Stage& stage, const std::vector<VkDeviceAddress>& clusters, const std::function<void(VkCommandBuffer)>& between = nullptr)
{
	ClusterCommand bottom = stage.bottomLevels(clusters);
	bottom.run();
	const auto scene = topLevel(stage.gpu, std::vector{ placed(bottom.resultAddresses()[0], 0.0f, 0.0f, 1) });
	return trace(stage.gpu, *scene, "cluster.rchit", kExtent, kSide, { between });
}

bool same(const Hit& a, const Hit& b)
{
	return std::memcmp(&a, &b, sizeof(Hit)) == 0;
}

void expectSame(const std::vector<Hit>& a, const std::vector<Hit>& b)
{
	EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end(), same));
	EXPECT_GT(std::count_if(a.begin(), a.end(), [](const Hit& hit) { return hit.t > 0.0f; }), int(kSide));
}

}  // namespace

TEST(clusterLayer, explicitDestinationsHoldWhatImplicitOnesDo)
{
	onACleanDevice([](Stage& stage) {
		const auto implicit = hitsOf(stage, stage.built());
		ClusterCommand command = stage.clusters();
		command.makeExplicit();
		command.run();
		expectSame(implicit, hitsOf(stage, command.resultAddresses()));
	});
}

TEST(clusterLayer, computedSizesAreThoseOfTheBuild)
{
	onACleanDevice([](Stage& stage) {
		ClusterCommand command = stage.clusters();
		command.run();
		const auto built = command.resultSizes();
		ClusterCommand sizes = stage.clusters();
		sizes.info.input.opMode = kComputeSizes;
		sizes.info.dstAddressesArray = {};
		sizes.info.dstImplicitData = 0;
		sizes.run();
		const auto computed = sizes.resultSizes();
		for (uint32_t i = 0; i < kMistakePatches; ++i)
		{
			EXPECT_GE(computed[i], built[i]);
			EXPECT_LT(computed[i], built[i] + 128u);
		}
		// A template without vertices has the size of its instances, whatever theirs will be.
		ClusterCommand instances = stage.instances(stage.madeTemplate());
		for (uint32_t i = 0; i < kMistakePatches; ++i)
			argument<InstantiateInfo>(instances, i).vertexBuffer = {};
		instances.info.input.opMode = kComputeSizes;
		instances.run();
		EXPECT_EQ(instances.resultSizes(), computed);
	});
}

TEST(clusterLayer, aCountOnTheDeviceDecidesHowMuchIsBuilt)
{
	onACleanDevice([](Stage& stage) {
		ClusterCommand command = stage.clusters();
		command.setCount(2);
		command.run();
		const auto addresses = command.resultAddresses();
		EXPECT_TRUE(addresses[0] && addresses[1] && !addresses[2] && !addresses[3]);
	});
}

TEST(clusterLayer, addressesMayBeGivenByAddress)
{
	onACleanDevice([](Stage& stage) {
		const auto direct = hitsOf(stage, stage.built());
		ClusterCommand command = stage.clusters();
		const Buffer where(stage.gpu,
						   std::vector<VkDeviceAddress>{ command.info.dstImplicitData, command.info.scratchData,
														 command.info.dstAddressesArray.deviceAddress, command.info.dstSizesArray.deviceAddress,
														 command.info.srcInfosArray.deviceAddress, command.info.srcInfosCount });
		VkDeviceAddress* const fields[] = { &command.info.dstImplicitData,
											&command.info.scratchData,
											&command.info.dstAddressesArray.deviceAddress,
											&command.info.dstSizesArray.deviceAddress,
											&command.info.srcInfosArray.deviceAddress,
											&command.info.srcInfosCount };
		for (size_t i = 0; i < 6; ++i)
			*fields[i] = where.address + 8 * i;
		command.info.addressResolutionFlags = 0x3f;
		command.run();
		expectSame(direct, hitsOf(stage, command.resultAddresses()));
	});
}

TEST(clusterLayer, movedClustersAndStructuresAreTheSame)
{
	onACleanDevice([](Stage& stage) {
		const auto built = stage.built();
		const auto before = hitsOf(stage, built);
		const auto move = [&](VkClusterAccelerationStructureTypeNV type, const std::vector<VkDeviceAddress>& sources, VkBool32 copy) {
			stage.kept.push_back(std::make_unique<ClusterCommand>(stage.gpu));
			ClusterCommand& command = *stage.kept.back();
			command.setType(VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_MOVE_OBJECTS_NV, kImplicit);
			command.move.type = type;
			command.move.noMoveOverlap = copy;
			command.move.maxMovedBytes = 1 << 14;
			command.setArguments(sources);
			command.prepare();
			command.run();
			return command.resultAddresses();
		};
		const auto moved = move(VK_CLUSTER_ACCELERATION_STRUCTURE_TYPE_TRIANGLE_CLUSTER_NV, built, VK_TRUE);
		EXPECT_NE(moved, built);
		ClusterCommand bottom = stage.bottomLevels(moved);
		bottom.run();
		for (const VkBool32 copy : { VK_TRUE, VK_FALSE })
		{
			const auto structures = move(VK_CLUSTER_ACCELERATION_STRUCTURE_TYPE_CLUSTERS_BOTTOM_LEVEL_NV, bottom.resultAddresses(), copy);
			const auto scene = topLevel(stage.gpu, std::vector{ placed(structures[0], 0.0f, 0.0f, 1) });
			expectSame(before, trace(stage.gpu, *scene, "cluster.rchit", kExtent, kSide));
		}
	});
}

TEST(clusterLayer, eachTriangleMayHaveAGeometryIndexAndFlagsOfItsOwn)
{
	onACleanDevice([](Stage& stage) {
		std::vector<uint32_t> own(kPatchTriangles);
		for (uint32_t i = 0; i < kPatchTriangles; ++i)
			own[i] = i | (i % 3 == 0 ? 2u << 29 : 0u);
		const Buffer geometry(stage.gpu, own);
		ClusterCommand command = stage.clusters();
		command.triangles.maxClusterUniqueGeometryCount = kPatchTriangles;
		for (uint32_t i = 0; i < kMistakePatches; ++i)
		{
			argument<ClusterInfo>(command, i).geometryIndexAndFlagsBuffer = geometry.address;
			argument<ClusterInfo>(command, i).baseGeometryIndexAndGeometryFlags.geometryIndex = 10;
		}
		command.makeRoom();
		command.run();
		const auto plain = hitsOf(stage, stage.built());
		const auto hits = hitsOf(stage, command.resultAddresses());
		for (size_t i = 0; i < hits.size(); ++i)
		{
			EXPECT_EQ(hits[i].t, plain[i].t);
			EXPECT_EQ(hits[i].primitive, plain[i].primitive);
			EXPECT_EQ(hits[i].cluster, plain[i].cluster);
			EXPECT_EQ(hits[i].geometry, hits[i].t > 0.0f ? 10 + hits[i].primitive : 0u);
		}
	});
}

TEST(clusterLayer, whatWasBoundBeforeAClusterCommandIsBoundAfterIt)
{
	onACleanDevice([](Stage& stage) {
		const auto plain = hitsOf(stage, stage.built());
		ClusterCommand other = stage.clusters();
		expectSame(plain, hitsOf(stage, stage.built(), [&](VkCommandBuffer commands) {
					   fullBarrier(commands);
					   other.record(commands);
					   fullBarrier(commands);
				   }));
		EXPECT_NE(other.resultAddresses()[0], 0u);
	});
}

TEST(clusterLayer, lastBitsOfPositionsAreTruncated)
{
	onACleanDevice([](Stage& stage) {
		const auto exact = hitsOf(stage, stage.built());
		ClusterCommand command = stage.clusters();
		command.triangles.minPositionTruncateBitCount = 12;
		for (uint32_t i = 0; i < kMistakePatches; ++i)
			argument<ClusterInfo>(command, i).positionTruncateBitCount = 12;
		command.run();
		const auto truncated = hitsOf(stage, command.resultAddresses());
		size_t moved = 0;
		for (size_t i = 0; i < exact.size(); ++i)
			if (exact[i].t > 0.0f && truncated[i].t > 0.0f)
			{
				moved += exact[i].t != truncated[i].t;
				// Eleven bits of the mantissa are left, of heights below 1 and slopes below 1.
				EXPECT_NEAR(exact[i].t, truncated[i].t, 4.0f * std::exp2(-11.0f) * kExtent);
			}
		EXPECT_GT(moved, exact.size() / 8);  // a quarter of the rays meets anything
	});
}

TEST(clusterLayer, aTriangleWithACornerThatIsNotANumberIsMetByNoRay)
{
	onACleanDevice([](Stage& stage) {
		const auto whole = hitsOf(stage, stage.built());
		auto* vertices = reinterpret_cast<Position*>(stage.data.vertex_buffer.data);
		vertices[kQuads + 2][0] = std::numeric_limits<float>::quiet_NaN();  // inside the first patch: six triangles meet there
		const auto without = hitsOf(stage, stage.built());
		size_t gone = 0;
		for (size_t i = 0; i < whole.size(); ++i)
		{
			const bool is_gone = without[i].t < 0.0f && whole[i].t > 0.0f;
			gone += is_gone;
			EXPECT_TRUE(is_gone || same(whole[i], without[i]));
		}
		EXPECT_GT(gone, 0u);
		EXPECT_LT(gone, whole.size() / 8);
	});
}

}  // namespace tessera::test
