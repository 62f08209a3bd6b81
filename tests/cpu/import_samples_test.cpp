// Whole folders of files: our own samples cut short at every length, and the malformed ones that Debian packages.
#include "gltf_file.h"

#include <algorithm>
#include <cstdio>

namespace tessera
{

namespace fs = std::filesystem;

static bool isGltf(const fs::path& path)
{
	return path.extension() == ".gltf" || path.extension() == ".glb";
}

static std::string outcome(const Result<ImportedScene>& result)
{
	if (!result)
		return "refused: " + result.error().message;
	size_t triangles = 0;
	for (const Mesh& mesh : result->meshes)
		for (const Primitive& primitive : mesh.primitives)
			triangles += primitive.indices.size() / 3;
	return fmt::format("{} triangles, {} instances, {} images, {} warnings", triangles, result->instances.size(), result->images.size(),
					   result->warnings.size());
}

TEST(importSamples, everyPackagedSampleIsLoadedOrRefusedInOneLine)
{
	const fs::path folder = TESSERA_GLTF_SAMPLES;
	if (!fs::is_directory(folder))
		GTEST_SKIP() << "no sample folder " << folder << " (Debian package assimp-testmodels, or -DTESSERA_GLTF_SAMPLES=folder)";
	std::vector<fs::path> paths;
	for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
		if (isGltf(entry.path()))
			paths.push_back(entry.path());
	std::sort(paths.begin(), paths.end());
	ASSERT_FALSE(paths.empty());

	size_t loaded = 0;
	for (const fs::path& path : paths)
	{
		const Result<ImportedScene> result = importGltf(path);
		std::printf("%-90s %s\n", fs::relative(path, folder).c_str(), outcome(result).c_str());
		if (result)
		{
			expectPromisesKept(*result);
			++loaded;
			continue;
		}
		EXPECT_EQ(result.error().code, ExitCode::BadInput);
		EXPECT_TRUE(result.error().message.starts_with(path.string())) << result.error().message;
		EXPECT_EQ(result.error().message.find('\n'), std::string::npos) << result.error().message;
	}
	std::printf("%zu of %zu loaded\n", loaded, paths.size());
	EXPECT_GT(loaded, 0u);
}

TEST(importSamples, everyOwnSampleLoadsWithItsPromisesKept)
{
	size_t count = 0;
	for (const fs::directory_entry& entry : fs::directory_iterator(dataFile("")))
		if (isGltf(entry.path()))
		{
			IMPORTED(scene, importGltf(entry.path()));
			EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
			++count;
		}
	EXPECT_EQ(count, 4u);
}

// Copies the sample folder, then imports `name` with `cut` shortened to every length. A cut may leave padding or white space
// out and still load; anything else must be refused with one line.
static void expectPrefixesSurvive(const std::string& name, const std::string& cut)
{
	const TemporaryFolder folder;
	fs::copy(dataFile(""), folder.path, fs::copy_options::recursive);
	const std::vector<std::byte> whole = readBytes(dataFile(cut));
	for (size_t length = 0; length < whole.size(); length += length < 64 || whole.size() - length < 64 ? 1 : 13)
	{
		writeBytes(folder.path / cut, { whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length) });
		const Result<ImportedScene> result = importGltf(folder.path / name);
		if (!result)
		{
			EXPECT_EQ(result.error().code, ExitCode::BadInput);
			EXPECT_EQ(result.error().message.find('\n'), std::string::npos) << result.error().message;
			continue;
		}
		expectPromisesKept(*result);
		EXPECT_LT(whole.size() - length, 8u) << name << " loads although " << cut << " is cut to " << length << " of " << whole.size();
	}
}

TEST(importSamples, everyTruncatedPrefixOfADescriptionIsRefused)
{
	for (const char* name : { "displaced_quad.glb", "hierarchy.gltf", "embedded.gltf", "draco_grid.gltf" })
		expectPrefixesSurvive(name, name);
}

TEST(importSamples, everyTruncatedPrefixOfABufferIsRefused)
{
	expectPrefixesSurvive("hierarchy.gltf", "hierarchy.bin");
	expectPrefixesSurvive("draco_grid.gltf", "draco_grid.bin");
}

// Every byte of a .glb and of a Draco stream, one at a time, gets a wrong value: refused or loaded with all promises kept.
TEST(importSamples, noFlippedByteBreaksAPromise)
{
	for (const auto& [name, flipped] : { std::pair("displaced_quad.glb", "displaced_quad.glb"), std::pair("draco_grid.gltf", "draco_grid.bin") })
	{
		const TemporaryFolder folder;
		fs::copy(dataFile(""), folder.path, fs::copy_options::recursive);
		const std::vector<std::byte> whole = readBytes(dataFile(flipped));
		for (size_t at = 0; at < whole.size(); ++at)
		{
			std::vector<std::byte> bytes = whole;
			bytes[at] ^= at % 2 == 0 ? std::byte(0x01) : std::byte(0xff);
			writeBytes(folder.path / flipped, bytes);
			const Result<ImportedScene> result = importGltf(folder.path / name);
			if (result)
				expectPromisesKept(*result);
			else
				EXPECT_EQ(result.error().message.find('\n'), std::string::npos) << result.error().message;
		}
	}
}

}  // namespace tessera
