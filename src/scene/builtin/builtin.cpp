#include "scene/builtin.h"

#include "base/check.h"
#include "scene/builtin/scenes.h"

#include <array>
#include <charconv>

namespace tessera
{

struct Generator
{
	BuiltinScene scene;
	ImportedScene (*make)(uint32_t count);
};

static constexpr std::array kGenerators = {
	Generator{ { "planet", "a small world: seas, mountain ranges and ice on a closed sphere of 4,800 triangles" }, builtin::makePlanet },
	Generator{ { "showcase", "the planet with a cratered moon and a ring of boulders (count: boulders)", 900 }, builtin::makeShowcase },
	Generator{ { "terrain", "an eroded mountain valley of 32 x 32 quads (count: quads along a side)", 32, 8192 }, builtin::makeTerrain },
	Generator{ { "bricks", "a brick gate with columns on cobblestones: hard edges, two height maps" }, builtin::makeBricks },
	Generator{ { "instances", "a field of boulders that share one mesh (count: boulders)", 1024 }, builtin::makeInstances },
	Generator{ { "quad", "two triangles and a small height map" }, builtin::makeQuad },
	Generator{ { "cube", "a closed box with hard normals and a UV seam on every edge" }, builtin::makeCube },
	Generator{ { "materials", "two materials with different height maps that meet on one edge" }, builtin::makeMaterials },
};

static constexpr auto kScenes = [] {
	std::array<BuiltinScene, kGenerators.size()> scenes;
	for (size_t i = 0; i < scenes.size(); ++i)
		scenes[i] = kGenerators[i].scene;
	return scenes;
}();

std::span<const BuiltinScene> builtinScenes()
{
	return kScenes;
}

static Result<uint32_t> parseCount(std::string_view name, std::string_view text, uint32_t most)
{
	uint32_t count = 0;
	const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), count);
	if (code != std::errc() || end != text.data() + text.size() || count < 1 || count > most)
		return badInput("builtin:{}: the count '{}' is not a number from 1 to {}", name, text, most);
	return count;
}

static std::string allNames()
{
	std::string names;
	for (const BuiltinScene& scene : builtinScenes())
		names += (names.empty() ? "" : ", ") + std::string(scene.name);
	return names;
}

Result<ImportedScene> makeBuiltinScene(std::string_view name)
{
	constexpr std::string_view kPrefix = "builtin:";
	if (name.starts_with(kPrefix))
		name.remove_prefix(kPrefix.size());
	const size_t colon = name.find(':');
	const std::string_view stem = name.substr(0, colon);
	for (const Generator& generator : kGenerators)
	{
		if (generator.scene.name != stem)
			continue;
		uint32_t count = generator.scene.default_count;
		if (colon != std::string_view::npos)
		{
			if (count == 0)
				return badInput("builtin:{}: this scene takes no count, say builtin:{}", name, stem);
			TRY_ASSIGN(count, parseCount(name, name.substr(colon + 1), generator.scene.most_count));
		}
		ImportedScene scene = generator.make(count);
		scene.path = std::string(kPrefix) + std::string(name);
		return scene;
	}
	return badInput("builtin:{}: there is no such built-in scene; there are {}", name, allNames());
}

}  // namespace tessera
