// Seeded mistakes in limits and in clusters.
#include "layers/cluster_mistakes.h"

#include <gtest/gtest.h>

#include <limits>

namespace tessera::test
{

// Limits of the input.

TEST(clusterLayerNames, moreTrianglesThanTheDevice)
{
	expectNamed("max-triangles-per-cluster", wrongCluster([](auto& c) {
					c.triangles.maxClusterTriangleCount = 257;
					c.makeRoom();
				}));
}

TEST(clusterLayerNames, moreVerticesThanTheDevice)
{
	expectNamed("max-vertices-per-cluster", wrongCluster([](auto& c) {
					c.triangles.maxClusterVertexCount = 300;
					c.makeRoom();
				}));
}

TEST(clusterLayerNames, moreBitsThanAFloat)
{
	expectNamed("min-truncate-bits", [](Stage& stage) {
		ClusterCommand command = stage.clusters();
		command.triangles.minPositionTruncateBitCount = 33;
		command.prepare();
	});
}

TEST(clusterLayerNames, aGeometryIndexAboveTheDevices)
{
	expectNamed("max-geometry-index", wrongCluster([](auto& c) { c.triangles.maxGeometryIndexValue = 1u << 24; }));
}

TEST(clusterLayerNames, aFormatThatIsNoPosition)
{
	expectNamed("vertex-format", [](Stage& stage) {
		ClusterCommand command = stage.clusters();
		command.triangles.vertexFormat = VK_FORMAT_R32_UINT;
		command.prepare();
	});
}

// Clusters.

TEST(clusterLayerNames, theIdThatStandsForNone)
{
	expectNamed("cluster-id-reserved", wrongCluster([](auto& c) { argument<ClusterInfo>(c).clusterID = ~0u; }));
}

TEST(clusterLayerNames, unknownClusterFlags)
{
	expectNamed("cluster-flags", wrongCluster([](auto& c) { argument<ClusterInfo>(c).clusterFlags = 2; }));
}

TEST(clusterLayerNames, moreTrianglesThanDeclared)
{
	expectNamed("triangles-above-max", wrongCluster([](auto& c) {
					c.triangles.maxClusterTriangleCount = kPatchTriangles - 1;
					c.triangles.maxTotalTriangleCount = 4096;
					c.makeRoom();
				}));
}

TEST(clusterLayerNames, moreVerticesThanDeclared)
{
	expectNamed("vertices-above-max", wrongCluster([](auto& c) {
					c.triangles.maxClusterVertexCount = kPatchVertices - 1;
					c.makeRoom();
				}));
}

TEST(clusterLayerNames, moreTrianglesInAllThanDeclared)
{
	expectNamed("total-triangles-above-max", wrongCluster([](auto& c) { c.triangles.maxTotalTriangleCount = 4 * kPatchTriangles - 1; }));
}

TEST(clusterLayerNames, moreVerticesInAllThanDeclared)
{
	expectNamed("total-vertices-above-max", wrongCluster([](auto& c) { c.triangles.maxTotalVertexCount = 4 * kPatchVertices - 1; }));
}

TEST(clusterLayerNames, fewerTruncatedBitsThanDeclared)
{
	expectNamed("truncate-bits", wrongCluster([](auto& c) { c.triangles.minPositionTruncateBitCount = 4; }));
}

TEST(clusterLayerNames, twoIndexTypes)
{
	expectNamed("index-type", wrongCluster([](auto& c) { argument<ClusterInfo>(c).indexType = 3; }));
}

TEST(clusterLayerNames, anIndexStrideBetweenIndices)
{
	expectNamed("index-stride", wrongCluster([](auto& c) {
					argument<ClusterInfo>(c).indexType = 2;
					argument<ClusterInfo>(c).indexBufferStride = 3;
					argument<ClusterInfo>(c).triangleCount = 0;
				}));
}

TEST(clusterLayerNames, anIndexBeyondTheVertices)
{
	expectNamed("index-out-of-range", wrongCluster([](auto& c) { argument<ClusterInfo>(c).vertexCount = kPatchVertices - 1; }));
}

TEST(clusterLayerNames, indicesInNoBuffer)
{
	expectNamed("index-buffer-range", wrongCluster([](auto& c) { argument<ClusterInfo>(c).indexBuffer = 0x1000; }));
}

TEST(clusterLayerNames, verticesInNoBuffer)
{
	expectNamed("vertex-buffer-range", wrongCluster([](auto& c) { argument<ClusterInfo>(c, 2).vertexBuffer = 0; }));
}

TEST(clusterLayerNames, verticesBeyondTheirBuffer)
{
	expectNamed("vertex-buffer-range", wrongCluster([](auto& c) { argument<ClusterInfo>(c, 3).vertexBuffer += 12; }));
}

TEST(clusterLayerNames, verticesNotAligned)
{
	expectNamed("vertex-buffer-alignment", wrongCluster([](auto& c) {
					argument<ClusterInfo>(c).vertexBuffer += 2;
					argument<ClusterInfo>(c).vertexBufferStride = 12;
					argument<ClusterInfo>(c).positionTruncateBitCount = 32;
				}));
}

TEST(clusterLayerNames, aVertexStrideBelowTheVertex)
{
	expectNamed("vertex-stride", wrongCluster([](auto& c) { argument<ClusterInfo>(c).vertexBufferStride = 8; }));
}

TEST(clusterLayerNames, aVertexThatIsNotFinite)
{
	expectNamed("vertex-not-finite", [](Stage& stage) {
		reinterpret_cast<Position*>(stage.data.vertex_buffer.data)[3][2] = std::numeric_limits<float>::infinity();
		stage.clusters().run();
	});
}

TEST(clusterLayerNames, reservedBitsOfAGeometry)
{
	expectNamed("geometry-reserved-bits", wrongCluster([](auto& c) { argument<ClusterInfo>(c).baseGeometryIndexAndGeometryFlags.reserved = 1; }));
}

TEST(clusterLayerNames, aGeometryIndexAboveTheDeclared)
{
	expectNamed("geometry-index-above-max",
				wrongCluster([](auto& c) { argument<ClusterInfo>(c).baseGeometryIndexAndGeometryFlags.geometryIndex = 101; }));
}

TEST(clusterLayerNames, moreGeometriesThanDeclared)
{
	expectNamed("geometries-above-max", [](Stage& stage) {
		std::vector<uint32_t> indices(kPatchTriangles);
		indices[5] = 2;
		const Buffer geometry(stage.gpu, indices);
		ClusterCommand command = stage.clusters();
		command.setCount(1);
		argument<ClusterInfo>(command).geometryIndexAndFlagsBuffer = geometry.address;
		command.run();
	});
}

TEST(clusterLayerNames, aGeometryBufferThatIsNone)
{
	expectNamed("geometry-buffer-range", wrongCluster([](auto& c) { argument<ClusterInfo>(c).geometryIndexAndFlagsBuffer = 0x2000; }));
}

TEST(clusterLayerNames, aGeometryBufferNotAligned)
{
	expectNamed("geometry-buffer-alignment", [](Stage& stage) {
		const Buffer geometry(stage.gpu, std::vector<uint32_t>(kPatchTriangles + 1));
		ClusterCommand command = stage.clusters();
		argument<ClusterInfo>(command).geometryIndexAndFlagsBuffer = geometry.address + 2;
		argument<ClusterInfo>(command).baseGeometryIndexAndGeometryFlags.geometryIndex = 0;
		command.run();
	});
}

TEST(clusterLayerNames, aGeometryStrideBetweenIndices)
{
	expectNamed("geometry-stride", wrongCluster([](auto& c) { argument<ClusterInfo>(c).geometryIndexAndFlagsBufferStride = 6; }));
}

TEST(clusterLayerNames, indicesNotAligned)
{
	expectNamed("index-buffer-alignment", [](Stage& stage) {
		const Buffer indices(stage.gpu, std::vector<uint16_t>(3 * kPatchTriangles + 1));
		ClusterCommand command = stage.clusters();
		argument<ClusterInfo>(command).indexType = 2;
		argument<ClusterInfo>(command).indexBufferStride = 2;
		argument<ClusterInfo>(command).indexBuffer = indices.address + 1;
		command.run();
	});
}

}  // namespace tessera::test
