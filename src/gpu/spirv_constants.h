// Which specialisation constants a shader reads.
#pragma once
#include <cstdint>
#include <set>
#include <span>

namespace tessera
{

// Ids of the specialisation constants that anything in the module refers to. Never misses one; may name one too many, where a literal number happens
// to equal an id. A module that is cut short gives those found until then.
std::set<uint32_t> usedConstants(std::span<const uint32_t> spirv);

}  // namespace tessera
