// Seeded mistakes in templates, their instances, bottom-level structures and instances of those.
#include "layers/cluster_mistakes.h"

#include <gtest/gtest.h>

namespace tessera::test
{

// Templates and their instances.

TEST(clusterLayerNames, limitsOfATemplateNotAligned)
{
	expectNamed("bounds-alignment", [](Stage& stage) {
		const Buffer box(stage.gpu, std::vector<float>(32, 1.0f));
		stage.madeTemplate([&](TemplateInfo& info) { info.instantiationBoundingBoxLimit = (box.address + 31) / 32 * 32 + 4; });
	});
}

TEST(clusterLayerNames, limitsOfATemplateInNoBuffer)
{
	expectNamed("bounds-range", wrongTemplate([](TemplateInfo& info) { info.instantiationBoundingBoxLimit = 0x20; }));
}

TEST(clusterLayerNames, limitsOfATemplateTheWrongWayRound)
{
	expectNamed("bounds-order", [](Stage& stage) {
		const Buffer box(stage.gpu, std::vector<float>{ 1, 1, 1, 0, 1, 1 });
		ASSERT_EQ(box.address % 32, 0u);
		stage.madeTemplate([&](TemplateInfo& info) { info.instantiationBoundingBoxLimit = box.address; });
	});
}

TEST(clusterLayerNames, aTemplateWithFewerVerticesThanItsIndices)
{
	expectNamed("index-out-of-range", wrongTemplate([](TemplateInfo& info) { info.vertexCount = 7; }));
}

TEST(clusterLayerNames, aVertexOutsideTheTemplatesLimits)
{
	expectNamed("instantiation-bounds", [](Stage& stage) {
		Buffer box(stage.gpu, std::vector<float>(32));
		const VkDeviceAddress at = (box.address + 31) / 32 * 32;
		const float limits[] = { 0.0f, 0.0f, -1.0f, 1.0f, 1.0f, 1.0f };
		std::memcpy(box.data + (at - box.address), limits, sizeof(limits));
		stage.instances(stage.madeTemplate([&](TemplateInfo& info) { info.instantiationBoundingBoxLimit = at; })).run();
	});
}

TEST(clusterLayerNames, aTemplateWhereThereIsNone)
{
	expectNamed("not-a-template", wrongInstance([](auto& c) { argument<InstantiateInfo>(c, 1).clusterTemplateAddress += 32; }));
}

TEST(clusterLayerNames, aClusterForATemplate)
{
	expectNamed("not-a-template", [](Stage& stage) { stage.instances(stage.built()[0]).run(); });
}

TEST(clusterLayerNames, aTemplateInNoBuffer)
{
	expectNamed("not-a-template", wrongInstance([](auto& c) { argument<InstantiateInfo>(c, 1).clusterTemplateAddress = 0x40; }));
}

TEST(clusterLayerNames, aTemplateNotAligned)
{
	expectNamed("template-alignment", [](Stage& stage) {
		const VkDeviceAddress from = stage.madeTemplate();
		ClusterCommand command = stage.instances(from);
		argument<InstantiateInfo>(command, 1).clusterTemplateAddress = from + 4;
		command.run();
	});
}

TEST(clusterLayerNames, aTemplateThatWasOverwritten)
{
	expectNamed("not-a-template", [](Stage& stage) {
		const VkDeviceAddress from = stage.madeTemplate();
		stage.kept.back()->results->data[from - stage.kept.back()->results->address + 100] ^= std::byte(1);
		stage.instances(from).run();
	});
}

TEST(clusterLayerNames, noVerticesAtAll)
{
	expectNamed("template-without-vertices", wrongInstance([](auto& c) { argument<InstantiateInfo>(c).vertexBuffer = {}; }));
}

TEST(clusterLayerNames, fewerVerticesThanTheTemplate)
{
	expectNamed("vertex-buffer-range", wrongInstance([](auto& c) { argument<InstantiateInfo>(c, 3).vertexBuffer.startAddress += 12; }));
}

TEST(clusterLayerNames, verticesOfAnotherFormat)
{
	expectNamed("template-vertex-format", wrongInstance([](auto& c) { c.triangles.vertexFormat = VK_FORMAT_R32G32_SFLOAT; }));
}

TEST(clusterLayerNames, reservedBitsOfAnInstance)
{
	expectNamed("instantiate-reserved-bits", wrongInstance([](auto& c) { argument<InstantiateInfo>(c).reserved = 3; }));
}

TEST(clusterLayerNames, anOffsetToTheIdThatStandsForNone)
{
	expectNamed("cluster-id-reserved", wrongInstance([](auto& c) { argument<InstantiateInfo>(c).clusterIdOffset = ~0u - 100; }));
}

TEST(clusterLayerNames, anOffsetBeyondTheDeclaredGeometries)
{
	expectNamed("geometry-index-above-max", wrongInstance([](auto& c) { argument<InstantiateInfo>(c).geometryIndexOffset = 98; }));
}

TEST(clusterLayerNames, anOffsetBelowZero)
{
	expectNamed("geometry-index-above-max", wrongInstance([](auto& c) { argument<InstantiateInfo>(c).geometryIndexOffset = 0xfffffc; }));
}

TEST(clusterLayerNames, aTemplateAboveTheDeclaredTriangles)
{
	expectNamed("total-triangles-above-max", wrongInstance([](auto& c) {
					c.triangles.maxTotalTriangleCount = 1;
					c.makeRoom();
				}));
}

// Bottom-level structures.

TEST(clusterLayerNames, moreClustersThanDeclared)
{
	expectNamed("references-above-max", wrongBottomLevel([](auto& c) { c.bottom_level.maxClusterCountPerAccelerationStructure = 3; }));
}

TEST(clusterLayerNames, moreClustersInAllThanDeclared)
{
	expectNamed("total-references-above-max", wrongBottomLevel([](auto& c) { c.bottom_level.maxTotalClusterCount = 3; }));
}

TEST(clusterLayerNames, referencesTooClose)
{
	expectNamed("references-stride", wrongBottomLevel([](auto& c) {
					argument<BottomLevelInfo>(c).clusterReferencesStride = 4;
					argument<BottomLevelInfo>(c).clusterReferencesCount = 1;
				}));
}

TEST(clusterLayerNames, referencesInNoBuffer)
{
	expectNamed("references-range", wrongBottomLevel([](auto& c) { argument<BottomLevelInfo>(c).clusterReferences = 0x8; }));
}

TEST(clusterLayerNames, aClusterTwice)
{
	expectNamed("reference-twice", [](Stage& stage) {
		const auto built = stage.built();
		stage.bottomLevels({ built[0], built[1], built[0] }).run();
	});
}

TEST(clusterLayerNames, aTemplateForACluster)
{
	expectNamed("not-a-cluster", [](Stage& stage) { stage.bottomLevels({ stage.madeTemplate() }).run(); });
}

TEST(clusterLayerNames, aClusterThatWasOverwritten)
{
	expectNamed("not-a-cluster", [](Stage& stage) {
		const auto built = stage.built();
		stage.kept.back()->results->data[built[2] - stage.kept.back()->results->address + 200] ^= std::byte(1);
		stage.bottomLevels(built).run();
	});
}

TEST(clusterLayerNames, aReferenceNotAligned)
{
	expectNamed("reference-alignment", [](Stage& stage) { stage.bottomLevels({ stage.built()[0] + 64 }).run(); });
}

TEST(clusterLayerNames, referencesNotAligned)
{
	expectNamed("references-alignment", [](Stage& stage) {
		const auto built = stage.built();
		ClusterCommand command = stage.bottomLevels({ built[0], built[1] });
		std::memmove(stage.lists->data + 4, stage.lists->data, 8);
		argument<BottomLevelInfo>(command) = { 1, 8, stage.lists->address + 4 };
		command.run();
	});
}

// Instances.

TEST(clusterLayerNames, instancesInNoBuffer)
{
	expectNamed("instances-range", [](Stage& stage) { topLevel(stage.gpu, std::vector{ placed(0, 0, 0, 0) }, 0x100); });
}

TEST(clusterLayerNames, anInstanceOfACluster)
{
	expectNamed("instance-reference", [](Stage& stage) { topLevel(stage.gpu, std::vector{ placed(stage.built()[0], 0, 0, 0) }); });
}

TEST(clusterLayerNames, anInstanceOfAStructureThatWasOverwritten)
{
	expectNamed("structure-overwritten", [](Stage& stage) {
		ClusterCommand command = stage.bottomLevels(stage.built());
		command.run();
		const VkDeviceAddress structure = command.resultAddresses()[0];
		command.results->data[structure - command.results->address + 70] ^= std::byte(1);
		topLevel(stage.gpu, std::vector{ placed(structure, 0, 0, 0) });
	});
}

}  // namespace tessera::test
