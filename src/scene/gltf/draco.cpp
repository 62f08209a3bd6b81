#include "scene/gltf/draco.h"

#include "scene/gltf/accessor.h"

#include <cstring>
#include <draco/compression/decode.h>
#include <memory>
#include <set>

namespace tessera
{

static constexpr const char* kExtension = "KHR_draco_mesh_compression";

// Appends `bytes` as a buffer with one view, and lets the accessor read `count` tightly packed elements from it.
static void redirectAccessor(GltfDocument& document, size_t accessor, std::vector<std::byte> bytes, size_t count)
{
	Json& root = document.json;
	const size_t length = bytes.size();
	root["buffers"].push_back({ { "byteLength", length } });
	root["bufferViews"].push_back({ { "buffer", root["buffers"].size() - 1 }, { "byteLength", length } });
	Json& target = root["accessors"][accessor];
	target["bufferView"] = root["bufferViews"].size() - 1;
	target["count"] = count;
	target.erase("byteOffset");
	target.erase("sparse");

	GltfBuffer buffer;
	buffer.owned = std::move(bytes);
	buffer.bytes = buffer.owned;
	document.buffers.push_back(std::move(buffer));
}

template <typename Component>
static bool convertPoints(const draco::Mesh& mesh, const draco::PointAttribute& attribute, std::vector<std::byte>& bytes)
{
	const int8_t components = static_cast<int8_t>(attribute.num_components());
	const size_t element_size = sizeof(Component) * static_cast<size_t>(components);
	bytes.resize(element_size * mesh.num_points());
	Component element[4] = {};
	for (uint32_t point = 0; point < mesh.num_points(); ++point)
	{
		if (!attribute.ConvertValue<Component>(attribute.mapped_index(draco::PointIndex(point)), components, element))
			return false;
		std::memcpy(bytes.data() + point * element_size, element, element_size);
	}
	return true;
}

static bool convertPoints(int component_type, const draco::Mesh& mesh, const draco::PointAttribute& attribute, std::vector<std::byte>& bytes)
{
	switch (component_type)
	{
	case kGltfByte:
		return convertPoints<int8_t>(mesh, attribute, bytes);
	case kGltfUnsignedByte:
		return convertPoints<uint8_t>(mesh, attribute, bytes);
	case kGltfShort:
		return convertPoints<int16_t>(mesh, attribute, bytes);
	case kGltfUnsignedShort:
		return convertPoints<uint16_t>(mesh, attribute, bytes);
	case kGltfUnsignedInt:
		return convertPoints<uint32_t>(mesh, attribute, bytes);
	default:
		return convertPoints<float>(mesh, attribute, bytes);
	}
}

static Status decodeAttribute(GltfDocument& document, const draco::Mesh& mesh, size_t accessor, uint32_t draco_id, const std::string& place)
{
	const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(draco_id);
	if (!attribute)
		return document.bad(place, "is {}, but the Draco stream has no attribute of that number", draco_id);
	const Json& description = document.json["accessors"][accessor];
	const std::string type = description["type"].get<std::string>();
	if (attribute->num_components() > 4 || componentCount(type) != attribute->num_components())
		return document.bad(place, "the Draco stream has {} components, but accessors[{}] is {}", static_cast<int>(attribute->num_components()),
							accessor, type);
	std::vector<std::byte> bytes;
	if (!convertPoints(description["componentType"].get<int>(), mesh, *attribute, bytes))
		return document.bad(place, "the Draco stream cannot be converted to the component type of accessors[{}]", accessor);
	redirectAccessor(document, accessor, std::move(bytes), mesh.num_points());
	return {};
}

static void decodeIndices(GltfDocument& document, const draco::Mesh& mesh, size_t accessor)
{
	std::vector<std::byte> bytes(size_t(12) * mesh.num_faces());
	for (uint32_t i = 0; i < mesh.num_faces(); ++i)
	{
		const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(i));
		const uint32_t corners[3] = { face[0].value(), face[1].value(), face[2].value() };
		std::memcpy(bytes.data() + size_t(12) * i, corners, sizeof(corners));
	}
	document.json["accessors"][accessor]["componentType"] = kGltfUnsignedInt;
	redirectAccessor(document, accessor, std::move(bytes), size_t(3) * mesh.num_faces());
}

static Result<std::unique_ptr<draco::Mesh>> decodeStream(const GltfDocument& document, size_t view, const std::string& place)
{
	TRY_ASSIGN(const std::span<const std::byte> bytes, bufferViewBytes(document, view));
	draco::DecoderBuffer stream;
	stream.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
	draco::Decoder decoder;
	auto decoded = decoder.DecodeMeshFromBuffer(&stream);
	if (!decoded.ok())
		return document.bad(place, "cannot be decoded: {}", decoded.status().error_msg_string());
	std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
	if (!mesh || mesh->num_faces() == 0 || mesh->num_points() == 0)
		return document.bad(place, "the Draco stream has no triangles");
	return mesh;
}

static Status decodePrimitive(GltfDocument& document, const Json& primitive, const std::string& primitive_place, std::set<size_t>& done)
{
	const std::string place = fmt::format("{}.extensions.{}", primitive_place, kExtension);
	const Json& extension = primitive["extensions"][kExtension];
	const size_t view = extension["bufferView"].get<size_t>();
	if (primitive.value("mode", 4) != 4 || !primitive.contains("indices"))
		return document.bad(place, "only indexed triangle lists (mode 4 with indices) may be Draco-compressed");
	if (!done.insert(view).second)
		return {};
	TRY_ASSIGN(const std::unique_ptr<draco::Mesh> mesh, decodeStream(document, view, place));
	decodeIndices(document, *mesh, primitive["indices"].get<size_t>());
	for (const auto& [name, id] : extension["attributes"].items())
	{
		const auto accessor = primitive["attributes"].find(name);
		const std::string attribute_place = fmt::format("{}.attributes.{}", place, name);
		if (accessor == primitive["attributes"].end())
			return document.bad(attribute_place, "the primitive has no attribute of that name");
		TRY(decodeAttribute(document, *mesh, accessor->get<size_t>(), id.get<uint32_t>(), attribute_place));
	}
	return {};
}

Status decodeDraco(GltfDocument& document)
{
	std::set<size_t> done;
	for (size_t i = 0; i < entryCount(document.json, "meshes"); ++i)
	{
		const size_t primitive_count = document.json["meshes"][i]["primitives"].size();
		for (size_t j = 0; j < primitive_count; ++j)
		{
			// Copied: decoding appends to the document.
			const Json primitive = document.json["meshes"][i]["primitives"][j];
			if (primitive.contains("extensions") && primitive["extensions"].contains(kExtension))
				TRY(decodePrimitive(document, primitive, fmt::format("meshes[{}].primitives[{}]", i, j), done));
		}
	}
	return {};
}

}  // namespace tessera
