#include "gltf_file.h"
#include "scene/displacement_option.h"

namespace tessera
{

static std::string height()
{
	return dataFile("height16.png").string();
}

// Two primitives with the materials "paint" and "metal", and one with "paint" that has no texture coordinates.
static ImportedScene twoMaterials()
{
	GltfFile file = squareFile();
	file.json["materials"].push_back({ { "name", "metal" } });
	file.addPrimitive({ { "POSITION", 0 }, { "TEXCOORD_0", 2 } }, 5)["material"] = 1;
	file.addPrimitive({ { "POSITION", 0 } }, 5)["material"] = 0;
	Result<ImportedScene> scene = file.import();
	EXPECT_TRUE(scene) << scene.error().message;
	return std::move(*scene);
}

static const Material& materialOf(const ImportedScene& scene, size_t primitive)
{
	return scene.materials[scene.meshes[0].primitives[primitive].material];
}

TEST(displacementOption, defaultsAreFactorOneOffsetZeroAndAllMaterials)
{
	ImportedScene scene = twoMaterials();
	const Status status = attachDisplacement(scene, height());
	ASSERT_TRUE(status) << status.error().message;
	expectPromisesKept(scene);
	for (size_t i = 0; i < 2; ++i)
	{
		ASSERT_TRUE(materialOf(scene, i).displacement);
		EXPECT_EQ(materialOf(scene, i).displacement->factor, 1);
		EXPECT_EQ(materialOf(scene, i).displacement->offset, 0);
		EXPECT_EQ(materialOf(scene, i).displacement->height.texcoord, 0u);
	}
	EXPECT_EQ(scene.images.size(), 1u);
	EXPECT_EQ(scene.images[0].format, TexelFormat::U16);
}

TEST(displacementOption, aPrimitiveWithoutTexcoordsStaysUndisplacedWithAWarning)
{
	ImportedScene scene = twoMaterials();
	ASSERT_TRUE(attachDisplacement(scene, height()));
	EXPECT_FALSE(materialOf(scene, 2).displacement);
	EXPECT_TRUE(hasWarning(scene, "primitive 2: has no TEXCOORD_0: drawn without displacement"));
}

TEST(displacementOption, factorOffsetAndMaterialAreRead)
{
	for (const std::string& material : { std::string("metal"), std::string("1") })
	{
		ImportedScene scene = twoMaterials();
		const Status status = attachDisplacement(scene, height() + ":0.25:-1.5e-1:" + material);
		ASSERT_TRUE(status) << status.error().message;
		EXPECT_FALSE(materialOf(scene, 0).displacement);
		ASSERT_TRUE(materialOf(scene, 1).displacement);
		EXPECT_EQ(materialOf(scene, 1).displacement->factor, 0.25f);
		EXPECT_EQ(materialOf(scene, 1).displacement->offset, -0.15f);
		EXPECT_TRUE(scene.warnings.empty()) << "primitive 2 has another material";
	}
}

TEST(displacementOption, emptyPartsMeanTheirDefaults)
{
	ImportedScene scene = twoMaterials();
	ASSERT_TRUE(attachDisplacement(scene, height() + "::0.5:"));
	EXPECT_EQ(materialOf(scene, 1).displacement->factor, 1);
	EXPECT_EQ(materialOf(scene, 1).displacement->offset, 0.5f);
}

TEST(displacementOption, theImagesNameMayContainColons)
{
	const TemporaryFolder folder;
	const std::filesystem::path odd = folder.path / "a:2:b.png";
	std::filesystem::copy_file(height(), odd);
	ImportedScene scene = twoMaterials();
	const Status status = attachDisplacement(scene, odd.string() + ":3");
	ASSERT_TRUE(status) << status.error().message;
	EXPECT_EQ(materialOf(scene, 0).displacement->factor, 3);
}

TEST(displacementOption, itReplacesWhatTheFileHadAndFreesTheOldImage)
{
	Result<ImportedScene> scene = importGltf(dataFile("displaced_quad.glb"));
	ASSERT_TRUE(scene);
	ASSERT_TRUE(attachDisplacement(*scene, dataFile("height_float.exr").string() + ":2"));
	expectPromisesKept(*scene);
	EXPECT_EQ(scene->images.size(), 2u);
	const Displacement& displacement = *scene->materials[0].displacement;
	EXPECT_EQ(displacement.factor, 2);
	EXPECT_EQ(scene->images[scene->textures[displacement.height.texture].image].format, TexelFormat::F32);
}

TEST(displacementOption, samplesThatAreNotFiniteAreWarnedAbout)
{
	ImportedScene scene = twoMaterials();
	ASSERT_TRUE(attachDisplacement(scene, dataFile("height_not_finite.exr").string() + ":1:0:metal"));
	EXPECT_TRUE(hasWarning(scene, "3 samples are NaN or infinite"));
}

TEST(displacementOption, wrongOptionsAreRefusedAndLeaveTheSceneAlone)
{
	const std::pair<std::string, ExitCode> wrong[] = {
		{ "", ExitCode::Usage },
		{ ":1", ExitCode::Usage },
		{ height() + ":high", ExitCode::Usage },
		{ height() + ":1:2x", ExitCode::Usage },
		{ height() + ":nan", ExitCode::Usage },
		{ height() + ":1e99", ExitCode::Usage },
		{ height() + ":1:0:wood", ExitCode::BadInput },
		{ height() + ":1:0:7", ExitCode::BadInput },
		{ "no such image.png:1", ExitCode::BadInput },
		{ dataFile("hierarchy.gltf").string(), ExitCode::BadInput },
	};
	for (const auto& [option, code] : wrong)
	{
		ImportedScene scene = twoMaterials();
		const Status status = attachDisplacement(scene, option);
		ASSERT_FALSE(status) << option;
		EXPECT_EQ(status.error().code, code) << status.error().message;
		EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
		EXPECT_TRUE(scene.images.empty());
		EXPECT_FALSE(materialOf(scene, 0).displacement);
	}
}

}  // namespace tessera
