// Mutations that know what a glTF file is made of, so that most of what they make gets past the parsers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tessera::test
{

// Changes the bytes in place; may return more, up to `most`. Of libFuzzer: LLVMFuzzerMutate.
using ByteMutator = std::function<size_t(uint8_t* data, size_t size, size_t most)>;

// A changed file of at most `most` bytes: of a .glb one of its chunks, with lengths made right again; of a description one of its
// values, which becomes another number, goes away, is doubled, or is taken from elsewhere. Any other file: by `bytes` alone.
std::vector<uint8_t> mutateGltf(std::span<const uint8_t> file, size_t most, uint32_t seed, const ByteMutator& bytes);

}  // namespace tessera::test
