// Clusters under the layer against a plain structure of the same triangles: rays see the same, and find which cluster it was.
#include "layers/cluster_scene.h"
#include "layers/cluster_tracer.h"
#include "layers/layer_report.h"

#include <gtest/gtest.h>

namespace tessera::test
{

namespace
{

constexpr uint32_t kColumns = 4, kRows = 3, kPatches = kColumns * kRows;
constexpr uint32_t kSide = 48;
constexpr float kExtent = 8.0f;
constexpr uint32_t kFirstBuilt = 40, kTemplateId = 1u << 30;

// Plain structures with a geometry per patch, in lists as the clusters'.
struct PlainPatches
{
	PlainPatches(Gpu& gpu, const PatchData& data, uint32_t first, uint32_t count)
	{
		const std::vector<uint8_t> small = patchIndices();
		indices = std::make_unique<Buffer>(gpu, std::vector<uint32_t>(small.begin(), small.end()));
		std::vector<VkAccelerationStructureGeometryKHR> geometries(count, { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR });
		for (uint32_t i = 0; i < count; ++i)
		{
			geometries[i].geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
			geometries[i].flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
			auto& triangles = geometries[i].geometry.triangles;
			triangles = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR };
			triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
			triangles.vertexData.deviceAddress = data.vertices(first + i);
			triangles.vertexStride = sizeof(Position);
			triangles.maxVertex = kPatchVertices - 1;
			triangles.indexType = VK_INDEX_TYPE_UINT32;
			triangles.indexData.deviceAddress = indices->address;
		}
		const std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges(count, { kPatchTriangles, 0, 0, 0 });
		structure = std::make_unique<Structure>(gpu, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, geometries, ranges);
	}
	std::unique_ptr<Buffer> indices;
	std::unique_ptr<Structure> structure;
};

// All patches, half of them built, half instantiated, in two bottom-level structures.
struct ClusterPatches
{
	ClusterPatches(Gpu& gpu, const PatchData& data)
		: built(buildClusters(gpu, data, 0, kPatches / 2, kFirstBuilt)), from(buildTemplate(gpu, data, kTemplateId))
	{
		built.run();
		from.run();
		made = std::make_unique<ClusterCommand>(instantiate(gpu, data, from.resultAddresses()[0], kPatches / 2, kPatches / 2, 0));
		made->run();
		std::vector<VkDeviceAddress> references = built.resultAddresses();
		for (const VkDeviceAddress address : made->resultAddresses())
			references.push_back(address);
		lists = std::make_unique<Buffer>(gpu, references);
		bottom = std::make_unique<ClusterCommand>(buildBottomLevels(gpu, *lists, { kPatches / 2, kPatches / 2 }));
		bottom->run();
	}
	ClusterCommand built, from;
	std::unique_ptr<ClusterCommand> made, bottom;
	std::unique_ptr<Buffer> lists;
};

// What rays meet in a scene of clusters must be what they meet in the plain one; `id` and `geometry` say what a plain hit's cluster is.
void expectSameHits(const std::vector<Hit>& plain, const std::vector<Hit>& clusters, uint32_t (*id)(const Hit&), uint32_t (*geometry)(const Hit&))
{
	ASSERT_EQ(plain.size(), clusters.size());
	size_t hits = 0, wrong = 0;
	for (size_t i = 0; i < plain.size(); ++i)
	{
		const Hit &a = plain[i], &b = clusters[i];
		hits += a.t >= 0.0f;
		bool same = a.t == b.t && a.u == b.u && a.v == b.v && a.primitive == b.primitive && a.custom == b.custom && a.instance == b.instance;
		if (a.t >= 0.0f)
			same = same && b.cluster == id(a) && b.geometry == geometry(a);
		if (!same && wrong++ < 4)
			ADD_FAILURE() << "ray " << i << ": t " << a.t << " and " << b.t << ", primitive " << a.primitive << " and " << b.primitive << ", cluster "
						  << id(a) << " and " << b.cluster << ", geometry " << geometry(a) << " and " << b.geometry << ", custom index " << a.custom
						  << " and " << b.custom;
	}
	EXPECT_EQ(wrong, 0u);
	EXPECT_GT(hits, plain.size() / 3);
	EXPECT_LT(hits, plain.size());
}

// Custom indices of the scene below: what each instance is.
enum Custom : uint32_t
{
	kBuiltPatches = 500,
	kInstantiatedPatches = 77,
	kBuiltAgain = 9,
	kPlainPatches = 1234,
};

uint32_t idOf(const Hit& hit)
{
	switch (hit.custom)
	{
	case kInstantiatedPatches:
		return kTemplateId + hit.geometry;
	case kPlainPatches:
		return UINT32_MAX;
	default:
		return kFirstBuilt + hit.geometry;
	}
}

uint32_t geometryOf(const Hit& hit)
{
	switch (hit.custom)
	{
	case kInstantiatedPatches:
		return 3 + hit.geometry;
	case kPlainPatches:
		return hit.geometry;
	default:
		return (kFirstBuilt + hit.geometry) % 7;
	}
}

std::vector<VkAccelerationStructureInstanceKHR> scene(VkDeviceAddress built, VkDeviceAddress instantiated, VkDeviceAddress plain)
{
	return { placed(built, 0.0f, 0.0f, kBuiltPatches), placed(instantiated, 0.25f, 0.0f, kInstantiatedPatches),
			 placed(built, 4.0f, 4.0f, kBuiltAgain), placed(plain, 0.0f, 4.5f, kPlainPatches) };
}

void expectClean(const LayerReport& report)
{
	for (const auto& [name, count] : report.violations)
		ADD_FAILURE() << count << " violations " << name << ": " << report.texts.at(name);
	for (const auto& [name, count] : report.limits)
		ADD_FAILURE() << count << " limits " << name;
}

}  // namespace

TEST(clusterLayer, raysMeetWhatTheyMeetInAPlainStructureAndFindTheCluster)
{
	const LayerReport report = underTheLayer([](Gpu& gpu) {
		const PatchData data(gpu, kColumns, kRows);
		const PlainPatches first(gpu, data, 0, kPatches / 2), second(gpu, data, kPatches / 2, kPatches / 2);
		const ClusterPatches clusters(gpu, data);
		const auto structures = clusters.bottom->resultAddresses();
		const auto plain_scene = topLevel(gpu, scene(first.structure->address, second.structure->address, first.structure->address));
		const auto cluster_scene = topLevel(gpu, scene(structures[0], structures[1], first.structure->address));
		// Both scenes stay alive: each instance finds its own cluster whatever else was built.
		const auto plain = trace(gpu, *plain_scene, "plain.rchit", kExtent, kSide);
		const auto with_clusters = trace(gpu, *cluster_scene, "cluster.rchit", kExtent, kSide);
		expectSameHits(plain, with_clusters, idOf, geometryOf);
		if (gpu.has_queries)
			expectSameHits(plain, traceByQueries(gpu, *cluster_scene, kExtent, kSide), idOf, geometryOf);
	});
	if (!report.device)
		GTEST_SKIP() << "the device cannot trace rays";
	expectClean(report);
	EXPECT_EQ(report.counts.at("build triangle cluster"), kPatches / 2);
	EXPECT_EQ(report.counts.at("instantiate triangle cluster"), kPatches / 2);
	EXPECT_EQ(report.counts.at("build triangle cluster template"), 1u);
	EXPECT_EQ(report.counts.at("build clusters bottom level"), 2u);
	EXPECT_EQ(report.counts.at("triangles in bottom levels"), kPatches * kPatchTriangles);
}

}  // namespace tessera::test
