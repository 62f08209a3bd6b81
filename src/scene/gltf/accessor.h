// Typed, bounds-checked reading of glTF accessors.
#pragma once
#include "base/result.h"
#include "scene/gltf/document.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tinygltf
{
class Model;
}

namespace tessera
{

// componentType of glTF.
enum GltfComponent : int
{
	kGltfByte = 5120,
	kGltfUnsignedByte = 5121,
	kGltfShort = 5122,
	kGltfUnsignedShort = 5123,
	kGltfUnsignedInt = 5125,
	kGltfFloat = 5126,
};

// Bytes of one component; 0 for a type that glTF does not have.
size_t componentSize(int component_type);

// Components of "SCALAR", "VEC2", ... "MAT4"; 0 for any other text.
int componentCount(const std::string& type);

// An accessor whose elements are known to lie inside its buffer.
struct GltfAccessor
{
	std::span<const std::byte> data;  // from its first element on; empty: every element is zero before `sparse_*` apply
	size_t stride = 0;                // bytes from element to element
	size_t count = 0;                 // elements, at least 1, at most 2^31 - 1
	int components = 0;
	int component_type = 0;
	bool normalized = false;
	std::vector<uint32_t> sparse_indices;      // strictly increasing, each < count
	std::span<const std::byte> sparse_values;  // tightly packed, one per sparse index

	bool isFloat() const { return component_type == kGltfFloat; }
	std::string shown() const;  // "VEC3 of UNSIGNED_BYTE, normalized"
};

// Checks every accessor of the model against its views. The result is as long as model.accessors and points into the document.
// Errors: BadInput naming the accessor (unknown type, elements beyond the view, stride below the element size, bad sparse
// data, more than 2^22 elements without a buffer view).
Result<std::vector<GltfAccessor>> checkAccessors(const GltfDocument& document, const tinygltf::Model& model);

// Elements [first, first + count) as floats, accessor.components each; normalized integers become [0, 1] or [-1, 1].
// The range must be inside the accessor and the type one of 8-bit, 16-bit or float.
std::vector<float> readFloats(const GltfAccessor& accessor, size_t first, size_t count);

// All elements of a SCALAR accessor of an unsigned integer type.
std::vector<uint32_t> readIndices(const GltfAccessor& accessor);

}  // namespace tessera
