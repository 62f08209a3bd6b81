#include "scene/gltf/accessor.h"

#include "base/check.h"

#include <algorithm>
#include <cstring>
#include <tiny_gltf.h>

namespace tessera
{

static constexpr size_t kMaxCountWithoutView = size_t(1) << 22;

size_t componentSize(int component_type)
{
	switch (component_type)
	{
	case kGltfByte:
	case kGltfUnsignedByte:
		return 1;
	case kGltfShort:
	case kGltfUnsignedShort:
		return 2;
	case kGltfUnsignedInt:
	case kGltfFloat:
		return 4;
	default:
		return 0;
	}
}

int componentCount(const std::string& type)
{
	constexpr std::pair<std::string_view, int> kCounts[] = { { "SCALAR", 1 }, { "VEC2", 2 }, { "VEC3", 3 }, { "VEC4", 4 },
															 { "MAT2", 4 },   { "MAT3", 9 }, { "MAT4", 16 } };
	for (const auto& [name, count] : kCounts)
		if (name == type)
			return count;
	return 0;
}

std::string GltfAccessor::shown() const
{
	constexpr const char* kTypes[] = { "BYTE", "UNSIGNED_BYTE", "SHORT", "UNSIGNED_SHORT", "?", "UNSIGNED_INT", "FLOAT" };
	const std::string shape = components == 1 ? "SCALAR" : components <= 4 ? fmt::format("VEC{}", components) : "MAT";
	return fmt::format("{} of {}{}", shape, kTypes[component_type - kGltfByte], normalized ? ", normalized" : "");
}

// True when `count` >= 1 elements of `size` bytes, `stride` >= 1 bytes apart, fit into `length` bytes from `offset` on.
// Written with divisions and differences only, so nothing can overflow.
static bool elementsFit(size_t count, size_t stride, size_t size, size_t offset, size_t length)
{
	if (offset > length || size > length - offset)
		return false;
	return count - 1 <= (length - offset - size) / stride;
}

// Bytes of one element. Columns of matrices start at multiples of 4 bytes.
static size_t elementSize(int type, int component_type)
{
	const size_t size = componentSize(component_type);
	if (type == TINYGLTF_TYPE_MAT2 && size == 1)
		return 8;
	if (type == TINYGLTF_TYPE_MAT3 && size < 4)
		return size == 1 ? 12 : 24;
	return size * static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type)));
}

static Status checkView(const GltfDocument& document, const tinygltf::Model& model, const std::string& place, const tinygltf::Accessor& source,
						GltfAccessor& accessor)
{
	const size_t element_size = elementSize(source.type, source.componentType);
	const size_t view = static_cast<size_t>(source.bufferView);
	const size_t stride = model.bufferViews[view].byteStride;
	TRY_ASSIGN(const std::span<const std::byte> bytes, bufferViewBytes(document, view));
	if (stride != 0 && stride < element_size)
		return document.bad(place, "byteStride of bufferViews[{}] is {}, but one element has {} bytes", view, stride, element_size);
	accessor.stride = stride != 0 ? stride : element_size;
	if (!elementsFit(source.count, accessor.stride, element_size, source.byteOffset, bytes.size()))
		return document.bad(place, "{} elements of {} bytes, {} bytes apart, from byteOffset {} on reach beyond bufferViews[{}], which has {} bytes",
							source.count, element_size, accessor.stride, source.byteOffset, view, bytes.size());
	accessor.data = bytes.subspan(source.byteOffset);
	return {};
}

static uint32_t readUnsigned(const std::byte* bytes, size_t size)
{
	uint32_t value = 0;
	for (size_t i = 0; i < size; ++i)
		value |= std::to_integer<uint32_t>(bytes[i]) << (8 * i);
	return value;
}

static Status checkSparse(const GltfDocument& document, const std::string& place, const tinygltf::Accessor& source, GltfAccessor& accessor)
{
	const auto& sparse = source.sparse;
	const size_t count = static_cast<size_t>(sparse.count);
	const int index_type = sparse.indices.componentType;
	if (index_type != kGltfUnsignedByte && index_type != kGltfUnsignedShort && index_type != kGltfUnsignedInt)
		return document.bad(place + ".sparse.indices.componentType", "is {}, but 5121, 5123 or 5125 is right", index_type);
	if (count > source.count)
		return document.bad(place + ".sparse.count", "is {}, but the accessor has only {} elements", count, source.count);
	TRY_ASSIGN(const std::span<const std::byte> indices, bufferViewBytes(document, static_cast<size_t>(sparse.indices.bufferView)));
	TRY_ASSIGN(const std::span<const std::byte> values, bufferViewBytes(document, static_cast<size_t>(sparse.values.bufferView)));
	const size_t index_size = componentSize(index_type);
	const size_t index_offset = static_cast<size_t>(sparse.indices.byteOffset);
	const size_t value_size = elementSize(source.type, source.componentType);
	const size_t value_offset = static_cast<size_t>(sparse.values.byteOffset);
	if (!elementsFit(count, index_size, index_size, index_offset, indices.size()))
		return document.bad(place + ".sparse.indices", "{} indices of {} bytes reach beyond bufferViews[{}]", count, index_size,
							sparse.indices.bufferView);
	if (!elementsFit(count, value_size, value_size, value_offset, values.size()))
		return document.bad(place + ".sparse.values", "{} values of {} bytes reach beyond bufferViews[{}]", count, value_size,
							sparse.values.bufferView);

	accessor.sparse_values = values.subspan(value_offset);
	for (size_t i = 0; i < count; ++i)
	{
		const uint32_t index = readUnsigned(indices.data() + index_offset + i * index_size, index_size);
		if (index >= source.count || (i > 0 && index <= accessor.sparse_indices.back()))
			return document.bad(place + ".sparse.indices", "index {} is {}, but strictly increasing values below {} are right", i, index,
								source.count);
		accessor.sparse_indices.push_back(index);
	}
	return {};
}

static Result<GltfAccessor> checkAccessor(const GltfDocument& document, const tinygltf::Model& model, size_t index)
{
	const tinygltf::Accessor& source = model.accessors[index];
	const std::string place = fmt::format("accessors[{}]", index);
	GltfAccessor accessor;
	accessor.count = source.count;
	accessor.components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(source.type));
	accessor.component_type = source.componentType;
	accessor.normalized = source.normalized;
	if (componentSize(source.componentType) == 0)
		return document.bad(place + ".componentType", "is {}, but 5120, 5121, 5122, 5123, 5125 or 5126 is right", source.componentType);
	if (source.bufferView >= 0)
		TRY(checkView(document, model, place, source, accessor));
	else if (source.count > kMaxCountWithoutView)
		return document.bad(place + ".count", "is {}, but an accessor without bufferView may have at most {} elements", source.count,
							kMaxCountWithoutView);
	if (source.sparse.isSparse)
		TRY(checkSparse(document, place, source, accessor));
	return accessor;
}

Result<std::vector<GltfAccessor>> checkAccessors(const GltfDocument& document, const tinygltf::Model& model)
{
	std::vector<GltfAccessor> accessors;
	accessors.reserve(model.accessors.size());
	for (size_t i = 0; i < model.accessors.size(); ++i)
	{
		TRY_ASSIGN(GltfAccessor accessor, checkAccessor(document, model, i));
		accessors.push_back(std::move(accessor));
	}
	return accessors;
}

// glTF's rule: c / max for unsigned, max(c / max, -1) for signed. A divisor of 1 keeps the integer.
template <typename Component>
static void convertElements(const std::byte* bytes, size_t stride, size_t count, size_t components, float divisor, float lowest, float* out)
{
	for (size_t i = 0; i < count; ++i)
		for (size_t c = 0; c < components; ++c)
		{
			Component value;
			std::memcpy(&value, bytes + i * stride + c * sizeof(Component), sizeof(Component));
			*out++ = std::max(static_cast<float>(value) / divisor, lowest);
		}
}

static void copyElements(const std::byte* bytes, size_t stride, size_t count, size_t components, float* out)
{
	const size_t size = components * sizeof(float);
	if (stride == size)
		std::memcpy(out, bytes, size * count);
	else
		for (size_t i = 0; i < count; ++i)
			std::memcpy(out + i * components, bytes + i * stride, size);
}

static void readElements(const GltfAccessor& accessor, const std::byte* bytes, size_t stride, size_t count, float* out)
{
	const size_t components = static_cast<size_t>(accessor.components);
	const bool normalized = accessor.normalized;
	switch (accessor.component_type)
	{
	case kGltfByte:
		return convertElements<int8_t>(bytes, stride, count, components, normalized ? 127.0f : 1.0f, normalized ? -1.0f : -128.0f, out);
	case kGltfUnsignedByte:
		return convertElements<uint8_t>(bytes, stride, count, components, normalized ? 255.0f : 1.0f, 0.0f, out);
	case kGltfShort:
		return convertElements<int16_t>(bytes, stride, count, components, normalized ? 32767.0f : 1.0f, normalized ? -1.0f : -32768.0f, out);
	case kGltfUnsignedShort:
		return convertElements<uint16_t>(bytes, stride, count, components, normalized ? 65535.0f : 1.0f, 0.0f, out);
	case kGltfFloat:
		return copyElements(bytes, stride, count, components, out);
	default:
		CHECK(false, "component type {} is not read as float", accessor.component_type);
	}
}

std::vector<float> readFloats(const GltfAccessor& accessor, size_t first, size_t count)
{
	CHECK(count <= accessor.count && first <= accessor.count - count, "elements {} + {} of {}", first, count, accessor.count);
	const size_t components = static_cast<size_t>(accessor.components);
	std::vector<float> values(count * components, 0.0f);
	if (!accessor.data.empty() && count > 0)
		readElements(accessor, accessor.data.data() + first * accessor.stride, accessor.stride, count, values.data());

	const size_t value_size = components * componentSize(accessor.component_type);
	const auto begin = std::lower_bound(accessor.sparse_indices.begin(), accessor.sparse_indices.end(), first);
	for (auto it = begin; it != accessor.sparse_indices.end() && *it < first + count; ++it)
	{
		const size_t entry = static_cast<size_t>(it - accessor.sparse_indices.begin());
		readElements(accessor, accessor.sparse_values.data() + entry * value_size, value_size, 1, values.data() + (*it - first) * components);
	}
	return values;
}

template <typename Component>
static void convertIndices(const std::byte* bytes, size_t stride, std::vector<uint32_t>& out)
{
	for (size_t i = 0; i < out.size(); ++i)
	{
		Component value;
		std::memcpy(&value, bytes + i * stride, sizeof(Component));
		out[i] = value;
	}
}

std::vector<uint32_t> readIndices(const GltfAccessor& accessor)
{
	std::vector<uint32_t> indices(accessor.count, 0);
	const size_t size = componentSize(accessor.component_type);
	if (!accessor.data.empty())
	{
		if (size == 1)
			convertIndices<uint8_t>(accessor.data.data(), accessor.stride, indices);
		else if (size == 2)
			convertIndices<uint16_t>(accessor.data.data(), accessor.stride, indices);
		else
			convertIndices<uint32_t>(accessor.data.data(), accessor.stride, indices);
	}
	for (size_t i = 0; i < accessor.sparse_indices.size(); ++i)
		indices[accessor.sparse_indices[i]] = readUnsigned(accessor.sparse_values.data() + i * size, size);
	return indices;
}

}  // namespace tessera
