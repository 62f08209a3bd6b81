// Every input that fuzzing started from or found, again: without sanitizers and on every push.
#include "import_check.h"
#include "mutate.h"

#include "base/file.h"
#include "scene/gltf_import.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tessera::test
{

namespace
{

namespace fs = std::filesystem;

std::vector<fs::path> corpus()
{
	std::vector<fs::path> files;
	for (const fs::directory_entry& entry : fs::directory_iterator(TESSERA_FUZZ_CORPUS))
		files.push_back(entry.path());
	std::sort(files.begin(), files.end());
	return files;
}

}  // namespace

TEST(fuzzCorpus, everyInputIsRefusedInOneLineOrKeepsAllPromises)
{
	const std::vector<fs::path> files = corpus();
	EXPECT_GT(files.size(), 15u);
	uint64_t bytes = 0;
	for (const fs::path& path : files)
	{
		const auto content = readFile(path);
		ASSERT_TRUE(content) << path;
		bytes += content->size();
		EXPECT_EQ(checkImport(*content), "") << path;
	}
	EXPECT_LE(bytes, 300'000u) << "the corpus is meant to stay small";
}

// What checkImport says is worth something only if most seeds get through.
TEST(fuzzCorpus, seedsLoad)
{
	for (const char* seed : { "square.glb", "coloured.glb", "topologies.glb", "sparse.glb", "hierarchy.glb", "interleaved.glb", "height_u8.glb",
							  "height_u16.glb", "height_jpeg.glb", "height_zips.glb", "draco.glb", "square.gltf" })
	{
		const auto scene = importGltf(fs::path(TESSERA_FUZZ_CORPUS) / seed);
		EXPECT_TRUE(scene) << seed << ": " << (scene ? "" : scene.error().message);
	}
}

// A fixed number of changes by the fuzzer's own mutator, so that every build tries what only clang can search.
TEST(fuzzCorpus, changedSeedsAreRefusedInOneLineOrKeepAllPromises)
{
	const auto flip = [](uint8_t* data, size_t size, size_t) {
		for (size_t i = 0; i < size; i += 1 + size / 3)
			data[i] = static_cast<uint8_t>(data[i] * 13 + 7);
		return size;
	};
	uint32_t seed = 0;
	for (const fs::path& path : corpus())
	{
		const auto content = readFile(path);
		ASSERT_TRUE(content) << path;
		const std::span<const uint8_t> file(reinterpret_cast<const uint8_t*>(content->data()), content->size());
		for (int i = 0; i < 60; ++i)
		{
			const std::vector<uint8_t> changed = mutateGltf(file, file.size() + 4096, ++seed, flip);
			EXPECT_EQ(checkImport(std::as_bytes(std::span(changed))), "") << path << ", seed " << seed;
		}
	}
}

}  // namespace tessera::test
