#include "scene/gltf/schema.h"

#include "scene/gltf/accessor.h"

#include <array>
#include <limits>

namespace tessera
{

enum class Kind
{
	Bool,
	Text,
	Number,
	Count,     // an integer in [lo, hi]
	Index,     // into the top-level array `target`
	Numbers,   // an array of `length` numbers; any length when 0
	Indices,   // an array of indices
	Texts,     // an array of strings
	IndexMap,  // an object whose values are indices
	CountMap,  // an object whose values are counts
	Object,
	Objects,  // an array of objects
};

struct Field
{
	const char* name;
	Kind kind;
	bool required = false;
	const char* target = nullptr;
	size_t length = 0;
	uint64_t lo = 0;
	uint64_t hi = uint64_t(1) << 53;
	std::span<const Field> fields = {};
};

static constexpr uint64_t kMaxTexcoord = 31;
static constexpr uint64_t kMaxInt = std::numeric_limits<int>::max();

static constexpr Field plain(const char* name, Kind kind)
{
	return { .name = name, .kind = kind };
}
static constexpr Field count(const char* name, uint64_t lo = 0, uint64_t hi = uint64_t(1) << 53)
{
	return { .name = name, .kind = Kind::Count, .lo = lo, .hi = hi };
}
static constexpr Field index(const char* name, const char* target, Kind kind = Kind::Index)
{
	return { .name = name, .kind = kind, .target = target };
}
static constexpr Field numbers(const char* name, size_t length)
{
	return { .name = name, .kind = Kind::Numbers, .length = length };
}
static constexpr Field object(const char* name, std::span<const Field> fields, Kind kind = Kind::Object)
{
	return { .name = name, .kind = kind, .fields = fields };
}
static constexpr Field required(Field field)
{
	field.required = true;
	return field;
}

static constexpr std::array kTextureTransform = { numbers("offset", 2), plain("rotation", Kind::Number), numbers("scale", 2),
												  count("texCoord", 0, kMaxTexcoord) };
static constexpr std::array kTextureInfoExtensions = { object("KHR_texture_transform", kTextureTransform) };
static constexpr std::array kTextureInfo = { required(index("index", "textures")), count("texCoord", 0, kMaxTexcoord),
											 object("extensions", kTextureInfoExtensions) };
static constexpr std::array kDisplacement = { object("displacementGeometryTexture", kTextureInfo), plain("displacementGeometryFactor", Kind::Number),
											  plain("displacementGeometryOffset", Kind::Number) };
static constexpr std::array kMaterialExtensions = { object("KHR_materials_displacement", kDisplacement) };
static constexpr std::array kPbr = { numbers("baseColorFactor", 4), object("baseColorTexture", kTextureInfo), plain("metallicFactor", Kind::Number),
									 plain("roughnessFactor", Kind::Number), object("metallicRoughnessTexture", kTextureInfo) };
static constexpr std::array kMaterial = {
	plain("name", Kind::Text),
	object("pbrMetallicRoughness", kPbr),
	object("normalTexture", kTextureInfo),
	object("occlusionTexture", kTextureInfo),
	object("emissiveTexture", kTextureInfo),
	numbers("emissiveFactor", 3),
	plain("alphaMode", Kind::Text),
	plain("alphaCutoff", Kind::Number),
	plain("doubleSided", Kind::Bool),
	object("extensions", kMaterialExtensions),
};

static constexpr std::array kDraco = { required(index("bufferView", "bufferViews")), required(plain("attributes", Kind::CountMap)) };
static constexpr std::array kPrimitiveExtensions = { object("KHR_draco_mesh_compression", kDraco) };
static constexpr std::array kPrimitive = { required(index("attributes", "accessors", Kind::IndexMap)),
										   index("indices", "accessors"),
										   index("material", "materials"),
										   count("mode", 0, 6),
										   object("targets", {}, Kind::Objects),
										   object("extensions", kPrimitiveExtensions) };
static constexpr std::array kMesh = { plain("name", Kind::Text), required(object("primitives", kPrimitive, Kind::Objects)), numbers("weights", 0) };

static constexpr std::array kInstancing = { required(index("attributes", "accessors", Kind::IndexMap)) };
static constexpr std::array kNodeExtensions = { object("EXT_mesh_gpu_instancing", kInstancing) };
static constexpr std::array kNode = {
	plain("name", Kind::Text),
	index("camera", "cameras"),
	index("children", "nodes", Kind::Indices),
	index("skin", "skins"),
	index("mesh", "meshes"),
	numbers("matrix", 16),
	numbers("rotation", 4),
	numbers("scale", 3),
	numbers("translation", 3),
	numbers("weights", 0),
	object("extensions", kNodeExtensions),
};
static constexpr std::array kScene = { plain("name", Kind::Text), index("nodes", "nodes", Kind::Indices) };

static constexpr std::array kBuffer = { plain("uri", Kind::Text), required(count("byteLength", 1)) };
static constexpr std::array kBufferView = { required(index("buffer", "buffers")), count("byteOffset"), required(count("byteLength", 1)),
											count("byteStride", 0, 252), count("target", 0, kMaxInt) };
static constexpr std::array kSparseIndices = { required(index("bufferView", "bufferViews")), count("byteOffset", 0, kMaxInt),
											   required(count("componentType", 0, kMaxInt)) };
static constexpr std::array kSparseValues = { required(index("bufferView", "bufferViews")), count("byteOffset", 0, kMaxInt) };
static constexpr std::array kSparse = { required(count("count", 1, kMaxInt)), required(object("indices", kSparseIndices)),
										required(object("values", kSparseValues)) };
static constexpr std::array kAccessor = {
	index("bufferView", "bufferViews"),
	count("byteOffset"),
	required(count("componentType", 5120, 5126)),
	plain("normalized", Kind::Bool),
	required(count("count", 1, kMaxInt)),
	required(plain("type", Kind::Text)),
	numbers("min", 0),
	numbers("max", 0),
	object("sparse", kSparse),
};

static constexpr std::array kTexture = { index("sampler", "samplers"), index("source", "images") };
static constexpr std::array kSampler = { count("magFilter", 0, kMaxInt), count("minFilter", 0, kMaxInt), count("wrapS", 0, kMaxInt),
										 count("wrapT", 0, kMaxInt) };
static constexpr std::array kImage = { plain("name", Kind::Text), plain("uri", Kind::Text), plain("mimeType", Kind::Text),
									   index("bufferView", "bufferViews") };

static constexpr std::array kPerspective = { required(plain("yfov", Kind::Number)), required(plain("znear", Kind::Number)),
											 plain("aspectRatio", Kind::Number), plain("zfar", Kind::Number) };
static constexpr std::array kOrthographic = { required(plain("xmag", Kind::Number)), required(plain("ymag", Kind::Number)),
											  required(plain("znear", Kind::Number)), required(plain("zfar", Kind::Number)) };
static constexpr std::array kCamera = { plain("name", Kind::Text), required(plain("type", Kind::Text)), object("perspective", kPerspective),
										object("orthographic", kOrthographic) };

static constexpr std::array kAsset = { required(plain("version", Kind::Text)), plain("minVersion", Kind::Text) };
static constexpr std::array kRoot = {
	required(object("asset", kAsset)),
	index("scene", "scenes"),
	plain("extensionsUsed", Kind::Texts),
	plain("extensionsRequired", Kind::Texts),
	object("scenes", kScene, Kind::Objects),
	object("nodes", kNode, Kind::Objects),
	object("meshes", kMesh, Kind::Objects),
	object("materials", kMaterial, Kind::Objects),
	object("textures", kTexture, Kind::Objects),
	object("samplers", kSampler, Kind::Objects),
	object("images", kImage, Kind::Objects),
	object("accessors", kAccessor, Kind::Objects),
	object("bufferViews", kBufferView, Kind::Objects),
	object("buffers", kBuffer, Kind::Objects),
	object("cameras", kCamera, Kind::Objects),
};

namespace
{

// Where in the document a check is; spelled out only when it fails.
struct Place
{
	const Place* parent = nullptr;
	std::string_view name = {};
	size_t entry = 0;

	std::string text() const
	{
		const std::string head = parent ? parent->text() : "";
		if (name.empty())
			return parent ? fmt::format("{}[{}]", head, entry) : "";
		return head.empty() ? std::string(name) : fmt::format("{}.{}", head, name);
	}
};

class SchemaCheck
{
public:
	explicit SchemaCheck(const GltfDocument& document) : m_document(document) {}

	Status objectFields(const Json& value, std::span<const Field> fields, const Place& place) const
	{
		for (const Field& field : fields)
		{
			const auto found = value.find(field.name);
			const Place inner = { &place, field.name };
			if (found != value.end())
				TRY(one(*found, field, inner));
			else if (field.required)
				return m_document.bad(inner.text(), "is missing, but required");
		}
		return {};
	}

private:
	Status one(const Json& value, const Field& field, const Place& place) const
	{
		switch (field.kind)
		{
		case Kind::Bool:
			return value.is_boolean() ? Status() : wrongType(value, "true or false", place);
		case Kind::Text:
			return value.is_string() ? Status() : wrongType(value, "a string", place);
		case Kind::Number:
			return value.is_number() ? Status() : wrongType(value, "a number", place);
		case Kind::Count:
			return countValue(value, field, place);
		case Kind::Index:
			return indexValue(value, field, place);
		case Kind::Object:
			return value.is_object() ? objectFields(value, field.fields, place) : wrongType(value, "an object", place);
		case Kind::IndexMap:
		case Kind::CountMap:
			return mapValues(value, field, place);
		case Kind::Numbers:
		case Kind::Indices:
		case Kind::Texts:
		case Kind::Objects:
			return entries(value, field, place);
		}
		return {};
	}

	Status entries(const Json& value, const Field& field, const Place& place) const
	{
		if (!value.is_array())
			return wrongType(value, "an array", place);
		if (field.kind == Kind::Numbers && field.length != 0 && value.size() != field.length)
			return m_document.bad(place.text(), "has {} entries, but {} are right", value.size(), field.length);
		Field entry = field;
		entry.kind = field.kind == Kind::Numbers   ? Kind::Number
					 : field.kind == Kind::Indices ? Kind::Index
					 : field.kind == Kind::Texts   ? Kind::Text
												   : Kind::Object;
		for (size_t i = 0; i < value.size(); ++i)
			TRY(one(value[i], entry, { &place, {}, i }));
		return {};
	}

	Status mapValues(const Json& value, const Field& field, const Place& place) const
	{
		if (!value.is_object())
			return wrongType(value, "an object", place);
		Field entry = field;
		entry.kind = field.kind == Kind::IndexMap ? Kind::Index : Kind::Count;
		entry.hi = kMaxInt;
		for (auto it = value.begin(); it != value.end(); ++it)
			TRY(one(it.value(), entry, { &place, it.key() }));
		return {};
	}

	Status countValue(const Json& value, const Field& field, const Place& place) const
	{
		if (!value.is_number_integer())
			return wrongType(value, "an integer", place);
		if (value.is_number_unsigned() && value.get<uint64_t>() >= field.lo && value.get<uint64_t>() <= field.hi)
			return {};
		return m_document.bad(place.text(), "is {}, but an integer from {} to {} is right", value.dump(), field.lo, field.hi);
	}

	Status indexValue(const Json& value, const Field& field, const Place& place) const
	{
		if (!value.is_number_integer())
			return wrongType(value, "an integer", place);
		const size_t size = entryCount(m_document.json, field.target);
		if (value.is_number_unsigned() && value.get<uint64_t>() < size)
			return {};
		if (size == 0)
			return m_document.bad(place.text(), "is {}, but the file has no {}", value.dump(), field.target);
		return m_document.bad(place.text(), "is {}, but the file has {} {}: an index from 0 to {} is right", value.dump(), size, field.target,
							  size - 1);
	}

	Status wrongType(const Json& value, const char* right, const Place& place) const
	{
		return m_document.bad(place.text(), "is of type {}, but {} is right", value.type_name(), right);
	}

	const GltfDocument& m_document;
};

}  // namespace

static Status checkCamera(const GltfDocument& document, size_t index)
{
	const Json& camera = document.json["cameras"][index];
	const std::string type = camera["type"].get<std::string>();
	const std::string place = fmt::format("cameras[{}]", index);
	if (type != "perspective" && type != "orthographic")
		return document.bad(place + ".type", "is neither perspective nor orthographic");
	if (!camera.contains(type))
		return document.bad(fmt::format("{}.{}", place, type), "is missing, but required");
	return {};
}

Status checkGltfSchema(const GltfDocument& document)
{
	if (!document.json.is_object())
		return document.bad("JSON", "is of type {}, but an object is right", document.json.type_name());
	TRY(SchemaCheck(document).objectFields(document.json, kRoot, {}));

	const std::string version = document.json["asset"].value("version", "");
	const std::string oldest = document.json["asset"].value("minVersion", "2.0");
	if (!version.starts_with("2."))
		return document.bad("asset.version", "is \"{}\", but this program reads glTF 2.x", version);
	if (oldest != "2.0")
		return document.bad("asset.minVersion", "is \"{}\", but this program reads glTF 2.0", oldest);
	for (size_t i = 0; i < entryCount(document.json, "bufferViews"); ++i)
	{
		const uint64_t stride = document.json["bufferViews"][i].value("byteStride", uint64_t(0));
		if (stride % 4 != 0)
			return document.bad(fmt::format("bufferViews[{}].byteStride", i), "is {}, but a multiple of 4 from 4 to 252 is right", stride);
	}
	for (size_t i = 0; i < entryCount(document.json, "accessors"); ++i)
		if (const std::string type = document.json["accessors"][i]["type"].get<std::string>(); componentCount(type) == 0)
			return document.bad(fmt::format("accessors[{}].type", i), "is \"{}\", but SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4 is right", type);
	for (size_t i = 0; i < entryCount(document.json, "cameras"); ++i)
		TRY(checkCamera(document, i));
	return {};
}

}  // namespace tessera
