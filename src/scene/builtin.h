// Scenes made by the program itself: no file, no download, and the same bits on every platform.
#pragma once
#include "base/result.h"
#include "scene/imported_scene.h"

#include <span>
#include <string_view>

namespace tessera
{

struct BuiltinScene
{
	std::string_view name;
	std::string_view help;       // one line
	uint32_t default_count = 0;  // when `name:count` is not given; 0: the scene takes no count
	uint32_t most_count = 1'000'000;
};

// All of them, the default one first.
std::span<const BuiltinScene> builtinScenes();

// Makes the scene `name` or `name:count` (count 1..most_count of what its help says; only where default_count > 0); a leading "builtin:" is
// allowed. path is "builtin:" and the name; cameras[0] shows the scene well. At their default counts it takes up to about two seconds, on all
// threads.
// Errors: BadInput (unknown name, count not a number, out of range or not taken by this scene).
Result<ImportedScene> makeBuiltinScene(std::string_view name);

}  // namespace tessera
