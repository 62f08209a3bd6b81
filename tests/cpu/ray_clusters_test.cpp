// Clusters for rays, as far as no device is needed: ids, records, reservations, and the triangles of templates.
#include "frame/cluster_reserve.h"
#include "frame/cluster_templates.h"
#include "shared/lists.h"
#include "shared/pattern.h"
#include "shared/visibility.h"

#include "build_test_scenes.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

namespace tessera::test
{

TEST(clusterId, kindAndIndexComeBack)
{
	for (uint32_t kind = 0; kind < CLUSTER_KINDS; ++kind)
		for (const uint32_t index : { 0u, 1u, 0xffffffu, 0x20000000u, 0x3ffffffeu })
		{
			const uint32_t id = packClusterId(kind, index);
			EXPECT_EQ(clusterKind(id), kind);
			EXPECT_EQ(clusterIndex(id), index);
			EXPECT_NE(id, 0xffffffffu) << "that is no cluster";
		}
}

#ifdef VK_NV_cluster_acceleration_structure

TEST(clusterRecords, bitsLieWhereTheDriverReadsThem)
{
	VkClusterAccelerationStructureBuildTriangleClusterInfoNV driver = {};
	driver.clusterID = packClusterId(CLUSTER_OF_GROUP, 77);
	driver.triangleCount = 128;
	driver.vertexCount = 192;
	driver.positionTruncateBitCount = 22;
	driver.indexType = VK_CLUSTER_ACCELERATION_STRUCTURE_INDEX_FORMAT_32BIT_NV;
	driver.baseGeometryIndexAndGeometryFlags.geometryFlags = VK_CLUSTER_ACCELERATION_STRUCTURE_GEOMETRY_OPAQUE_BIT_NV;
	driver.indexBufferStride = 4;
	driver.vertexBufferStride = 16;
	driver.indexBuffer = 0x123456789abcull;
	driver.vertexBuffer = 0xcba987654321ull;
	TransientInfo ours = {};
	ours.id = packClusterId(CLUSTER_OF_GROUP, 77);
	ours.counts = packTransientCounts(128, 192, 22);
	ours.geometry = CLUSTER_GEOMETRY_OPAQUE << 29;
	ours.strides = 4u | (16u << 16);
	ours.indices = 0x123456789abcull;
	ours.vertices = 0xcba987654321ull;
	EXPECT_EQ(std::memcmp(&driver, &ours, sizeof ours), 0);
}

#endif

TEST(clusterReserve, anEighthMoreWhenNearlyFullAndLessWhenHalfEmpty)
{
	EXPECT_EQ(reservedAfter(4096, 0, UINT32_MAX), 4096u) << "nothing was drawn since";
	EXPECT_EQ(reservedAfter(4096, 3000, UINT32_MAX), 4096u);
	EXPECT_EQ(reservedAfter(4096, 3900, UINT32_MAX), 5120u);
	EXPECT_EQ(reservedAfter(4096, 100000, UINT32_MAX), 112640u);
	EXPECT_EQ(reservedAfter(112640, 4000, UINT32_MAX), 5120u);
	EXPECT_EQ(reservedAfter(4096, 100000, 50000), 50000u) << "no more than there may be";
	EXPECT_EQ(reservedAfter(UINT32_MAX, UINT32_MAX, UINT32_MAX), UINT32_MAX);
}

TEST(clusterReserve, whatDoesNotFitIsReservedForTheNextAttempt)
{
	ClusterReserve reserve;
	ReserveCounts least = {}, most, wanted = {};
	most.fill(UINT32_MAX);
	most[RESERVED_DATA] = 6000;
	least[RESERVED_TRANSIENTS] = 2000;
	reserve.follow(least, most);
	EXPECT_EQ(reserve.reserved()[RESERVED_TRANSIENTS], 2048u);
	EXPECT_EQ(reserve.reserved()[RESERVED_INSTANTIATIONS], 1024u) << "never nothing";
	wanted[RESERVED_TRANSIENTS] = 5000;
	EXPECT_TRUE(reserve.isTooSmallFor(wanted, true));
	EXPECT_EQ(reserve.peak()[RESERVED_TRANSIENTS], 5000u);
	EXPECT_EQ(reserve.peakUsed()[RESERVED_TRANSIENTS], 0u) << "nothing of it was built";
	reserve.follow(least, most);
	EXPECT_GE(reserve.reserved()[RESERVED_TRANSIENTS], 5000u);
	EXPECT_EQ(reserve.peak()[RESERVED_TRANSIENTS], 0u) << "of the new one";
	EXPECT_FALSE(reserve.isTooSmallFor(wanted, true));
	EXPECT_EQ(reserve.peakUsed()[RESERVED_TRANSIENTS], 5000u);
	wanted[RESERVED_DATA] = 9000;
	EXPECT_TRUE(reserve.isTooSmallFor(wanted, true));
	reserve.follow(least, most);
	EXPECT_EQ(reserve.reserved()[RESERVED_DATA], 6000u);
	EXPECT_TRUE(reserve.isTooSmallFor(wanted, true)) << "and stays so: the frame has to be coarser";
}

// The rounds of one frame want different things: the next reservation holds the most of each.
TEST(clusterReserve, roundsAddUpToTheirMost)
{
	ClusterReserve reserve;
	ReserveCounts most, wanted = {};
	most.fill(UINT32_MAX);
	reserve.follow({}, most);
	wanted[RESERVED_LARGEST] = 50000;
	reserve.isTooSmallFor(wanted, true);
	wanted[RESERVED_LARGEST] = 10;
	wanted[RESERVED_TRANSIENT_VERTICES] = 70000;
	reserve.isTooSmallFor(wanted, true);
	reserve.follow({}, most);
	EXPECT_GE(reserve.reserved()[RESERVED_LARGEST], 50000u);
	EXPECT_GE(reserve.reserved()[RESERVED_TRANSIENT_VERTICES], 70000u);
}

TEST(arrayPlaces, arraysLieSideBySideOnTheirBoundaries)
{
	ArrayPlaces places;
	EXPECT_EQ(places.add(3, 32), 0u);
	EXPECT_EQ(places.add(0, 8), 256u);
	EXPECT_EQ(places.add(33, 8), 256u);
	EXPECT_EQ(places.add(1, 1), 768u);
	EXPECT_EQ(places.bytes(), 1024u);
}

// Templates have the triangles that hits are told: those of clusters in their order, those of patterns as shade finds them again.
TEST(templateShapes, haveTheTrianglesThatPayloadsName)
{
	const auto built = buildScene(sphereScene(24, 40, TexelFormat::U8, Wrap::Repeat));
	ASSERT_TRUE(built);
	const BuiltScene& scene = *built;
	const TessellationTable& table = defaultTable();
	const TemplateShapes shapes = templateShapes(scene, table);
	ASSERT_EQ(shapes.shapes.size(), scene.clusters.size() + 2 * table.configs.size());
	const auto corners = [&](size_t shape, uint32_t triangle) {
		const uint8_t* first = &shapes.indices[shapes.shapes[shape].first_index + 3 * triangle];
		return uvec3(first[0], first[1], first[2]);
	};
	for (size_t i = 0; i < scene.clusters.size(); ++i)
	{
		ASSERT_EQ(shapes.shapes[i].triangle_count, clusterTriangles(scene.clusters[i]));
		ASSERT_EQ(shapes.shapes[i].vertex_count, clusterVertices(scene.clusters[i]));
		for (uint32_t t = 0; t < shapes.shapes[i].triangle_count; ++t)
		{
			const uint32_t triangle = scene.triangles[scene.clusters[i].first_triangle + t];
			ASSERT_EQ(corners(i, t), uvec3(triangleVertex(triangle, 0), triangleVertex(triangle, 1), triangleVertex(triangle, 2)));
		}
	}
	const TableView view = { 0, reinterpret_cast<uint64_t>(table.vertices.data()), reinterpret_cast<uint64_t>(table.triangles.data()) };
	for (size_t i = 0; i < table.configs.size(); ++i)
		for (const uint32_t mirror : { 0u, 1u })
		{
			const TableConfig& config = table.configs[i];
			const PatternRange range = { config.first_triangle, config.first_vertex, config.triangle_count | uint32_t(config.vertex_count) << 16, 0 };
			const size_t shape = scene.clusters.size() + 2 * i + mirror;
			ASSERT_EQ(shapes.shapes[shape].triangle_count, config.triangle_count);
			for (uint32_t t = 0; t < config.triangle_count; ++t)
				ASSERT_EQ(corners(shape, t), patternTriangle(t, range, view, mirror)) << "pattern " << i;
		}
	EXPECT_EQ(shapes.pattern_positions.size(), table.vertices.size());
}

// A part of factors up to 2 has at most four triangles and six vertices, so that a group of them stays within a cluster.
TEST(templateShapes, smallPatternsFitIntoGroups)
{
	const TessellationTable& table = defaultTable();
	uint32_t triangles = 0, vertices = 0;
	for (const uint32_t index : { patternIndex(1, 1, 1), patternIndex(2, 1, 1), patternIndex(2, 2, 1), patternIndex(2, 2, 2) })
	{
		triangles = std::max<uint32_t>(triangles, table.configs[index].triangle_count);
		vertices = std::max<uint32_t>(vertices, table.configs[index].vertex_count);
	}
	EXPECT_LE(GROUP_PARTS * triangles, TRANSIENT_MOST_TRIANGLES);
	EXPECT_LE(GROUP_PARTS * vertices, TRANSIENT_MOST_VERTICES);
	EXPECT_LE(UNITS_PER_CLUSTER, TRANSIENT_MOST_TRIANGLES);
	EXPECT_LE(UNITS_PER_CLUSTER * 3, TRANSIENT_MOST_VERTICES);
	EXPECT_EQ(BATCH_WINDOW % UNITS_PER_CLUSTER, 0u);
	EXPECT_EQ(BATCH_WINDOW % GROUP_PARTS, 0u);
}

}  // namespace tessera::test
