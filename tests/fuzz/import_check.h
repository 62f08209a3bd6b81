// What every file must come to, whatever is in it: a scene that keeps its promises and can be built, or a refusal in one line.
#pragma once
#include <cstddef>
#include <span>
#include <string>

namespace tessera::test
{

// Imports the bytes of a .gltf or .glb file and builds the scene, unless it is large enough to take long. Returns what is wrong; empty: nothing.
// Files that it refers to are looked for in a folder that does not exist.
std::string checkImport(std::span<const std::byte> bytes);

}  // namespace tessera::test
