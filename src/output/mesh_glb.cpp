#include "output/mesh_glb.h"

#include "base/check.h"
#include "base/file.h"
#include "output/exr.h"
#include "output/png.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <vector>

namespace tessera
{

using nlohmann::json;

// Numbers that the format prescribes.
enum : int
{
	kFloat = 5126,
	kUnsignedInt = 5125,
	kArrayBuffer = 34962,
	kElementArrayBuffer = 34963,
	kNearest = 9728,
	kLinear = 9729,
	kNoTarget = 0,
};

static int wrapNumber(Wrap wrap)
{
	switch (wrap)
	{
	case Wrap::Repeat:
		return 10497;
	case Wrap::ClampToEdge:
		return 33071;
	case Wrap::MirroredRepeat:
		return 33648;
	}
	CHECK(false, "wrap {}", int(wrap));
}

template <typename V>
static json jsonArray(const V& vector)
{
	json array = json::array();
	for (int i = 0; i < V::length(); ++i)
		array.push_back(double(vector[i]));
	return array;
}

static json jsonMatrix(const dmat4& matrix)
{
	json array = json::array();
	for (int column = 0; column < 4; ++column)
		for (int row = 0; row < 4; ++row)
			array.push_back(matrix[column][row]);
	return array;
}

// The two halves of a .glb while they grow.
class GlbFile
{
public:
	explicit GlbFile(std::string path) : path_(std::move(path))
	{
		document = { { "asset", { { "version", "2.0" }, { "generator", "tessera" } } }, { "scene", 0 } };
		document["scenes"] = json::array({ { { "nodes", json::array() } } });
	}

	json document;

	const std::string& path() const { return path_; }

	size_t addView(std::span<const std::byte> bytes, int target)
	{
		json view = { { "buffer", 0 }, { "byteOffset", binary_.size() }, { "byteLength", bytes.size() } };
		if (target != kNoTarget)
			view["target"] = target;
		binary_.insert(binary_.end(), bytes.begin(), bytes.end());
		binary_.resize((binary_.size() + 3) / 4 * 4);
		return append("bufferViews", std::move(view));
	}

	template <typename T>
	size_t addAccessor(std::span<const T> values, const char* type, int component, int target)
	{
		json accessor = { { "bufferView", addView(std::as_bytes(values), target) }, { "componentType", component }, { "count", values.size() } };
		accessor["type"] = type;
		return append("accessors", std::move(accessor));
	}

	void addNode(json node) { document["scenes"][0]["nodes"].push_back(append("nodes", std::move(node))); }

	// Adds an element to one of the document's arrays and returns its index.
	size_t append(const char* array, json element)
	{
		document[array].push_back(std::move(element));
		return document[array].size() - 1;
	}

	void useExtension(const char* name) { extensions_.insert(name); }

	// The finished file.
	Result<std::vector<std::byte>> bytes();

private:
	std::string path_;
	std::vector<std::byte> binary_;
	std::set<std::string> extensions_;
};

static void appendWord(std::vector<std::byte>& bytes, uint32_t word)
{
	const auto* data = reinterpret_cast<const std::byte*>(&word);
	bytes.insert(bytes.end(), data, data + 4);
}

Result<std::vector<std::byte>> GlbFile::bytes()
{
	if (!extensions_.empty())
		document["extensionsUsed"] = extensions_;
	if (!binary_.empty())
		document["buffers"] = json::array({ { { "byteLength", binary_.size() } } });
	std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
	text.resize((text.size() + 3) / 4 * 4, ' ');
	const uint64_t length = 12 + 8 + text.size() + (binary_.empty() ? 0 : 8 + binary_.size());
	if (length > std::numeric_limits<uint32_t>::max())
		return badInput("{}: {} bytes are too many, a .glb file holds at most 4 GiB", path_, length);

	constexpr uint32_t kMagic = 0x46546c67, kVersion = 2, kJson = 0x4e4f534a, kBinary = 0x004e4942;
	std::vector<std::byte> file;
	file.reserve(length);
	for (const uint32_t word : { kMagic, kVersion, uint32_t(length), uint32_t(text.size()), kJson })
		appendWord(file, word);
	const auto text_bytes = std::as_bytes(std::span(text.data(), text.size()));
	file.insert(file.end(), text_bytes.begin(), text_bytes.end());
	if (!binary_.empty())
	{
		appendWord(file, uint32_t(binary_.size()));
		appendWord(file, kBinary);
		file.insert(file.end(), binary_.begin(), binary_.end());
	}
	return file;
}

// --- meshes --------------------------------------------------------------------------------------------------------------------------

static size_t addPositions(GlbFile& file, std::span<const vec3> positions)
{
	CHECK(!positions.empty(), "a mesh without vertices cannot be written as glTF");
	vec3 low = positions[0], high = positions[0];
	for (const vec3& position : positions)
	{
		low = glm::min(low, position);
		high = glm::max(high, position);
	}
	const size_t accessor = file.addAccessor(positions, "VEC3", kFloat, kArrayBuffer);
	file.document["accessors"][accessor]["min"] = jsonArray(low);
	file.document["accessors"][accessor]["max"] = jsonArray(high);
	return accessor;
}

static json primitiveJson(GlbFile& file, const Primitive& primitive)
{
	json attributes = { { "POSITION", addPositions(file, primitive.positions) } };
	if (!primitive.normals.empty())
		attributes["NORMAL"] = file.addAccessor(std::span(primitive.normals), "VEC3", kFloat, kArrayBuffer);
	for (size_t set = 0; set < primitive.texcoords.size(); ++set)
		if (!primitive.texcoords[set].empty())
			attributes[fmt::format("TEXCOORD_{}", set)] = file.addAccessor(std::span(primitive.texcoords[set]), "VEC2", kFloat, kArrayBuffer);
	if (!primitive.colors.empty())
		attributes["COLOR_0"] = file.addAccessor(std::span(primitive.colors), "VEC4", kFloat, kArrayBuffer);
	const size_t indices = file.addAccessor(std::span(primitive.indices), "SCALAR", kUnsignedInt, kElementArrayBuffer);
	return { { "attributes", std::move(attributes) }, { "indices", indices }, { "material", primitive.material } };
}

static void addMeshes(GlbFile& file, const ImportedScene& scene)
{
	for (const Mesh& mesh : scene.meshes)
	{
		json primitives = json::array();
		for (const Primitive& primitive : mesh.primitives)
			primitives.push_back(primitiveJson(file, primitive));
		file.append("meshes", { { "name", mesh.name }, { "primitives", std::move(primitives) } });
	}
}

// --- materials -----------------------------------------------------------------------------------------------------------------------

// KHR_texture_transform of uv' = (row0 . (u, v, 1), row1 . (u, v, 1)), which is offset + turn(scale * uv).
static Result<json> transformJson(const GlbFile& file, const TextureUse& use)
{
	json transform = { { "offset", { use.row0.z, use.row1.z } } };
	if (use.row0.y == 0 && use.row1.x == 0)
	{
		transform["scale"] = { use.row0.x, use.row1.y };
		return transform;
	}
	const double turn = std::atan2(-use.row1.x, use.row0.x);
	const double s = std::sin(turn), c = std::cos(turn);
	const double scale_u = std::hypot(use.row0.x, use.row1.x), scale_v = s * use.row0.y + c * use.row1.y;
	const double shear = std::abs(c * use.row0.y - s * use.row1.y);
	if (!(shear <= 1e-9 * (scale_u + std::abs(scale_v))))
		return badInput("{}: a texture transform shears, which KHR_texture_transform cannot say", file.path());
	transform["rotation"] = turn;
	transform["scale"] = { scale_u, scale_v };
	return transform;
}

static Result<json> textureUseJson(GlbFile& file, const TextureUse& use)
{
	json info = { { "index", use.texture }, { "texCoord", use.texcoord } };
	if (use.row0 != dvec3(1, 0, 0) || use.row1 != dvec3(0, 1, 0))
	{
		TRY_ASSIGN(info["extensions"]["KHR_texture_transform"], transformJson(file, use));
		file.useExtension("KHR_texture_transform");
	}
	return info;
}

static Result<json> materialJson(GlbFile& file, const Material& material)
{
	json surface = { { "baseColorFactor", jsonArray(material.base_color) } };
	surface["metallicFactor"] = double(material.metallic);
	surface["roughnessFactor"] = double(material.roughness);
	if (material.base_color_texture)
	{
		TRY_ASSIGN(surface["baseColorTexture"], textureUseJson(file, *material.base_color_texture));
	}
	json result = { { "name", material.name }, { "pbrMetallicRoughness", std::move(surface) } };
	result["emissiveFactor"] = jsonArray(material.emissive);
	result["doubleSided"] = material.double_sided;
	if (!material.displacement)
		return result;
	json displacement;
	TRY_ASSIGN(displacement["displacementGeometryTexture"], textureUseJson(file, material.displacement->height));
	displacement["displacementGeometryFactor"] = double(material.displacement->factor);
	displacement["displacementGeometryOffset"] = double(material.displacement->offset);
	result["extensions"]["KHR_materials_displacement"] = std::move(displacement);
	file.useExtension("KHR_materials_displacement");
	return result;
}

static Result<std::vector<std::byte>> encodeImage(const Image& image)
{
	if (image.format != TexelFormat::F32)
		return encodePng({ image.width, image.height, image.channels, image.format == TexelFormat::U16 ? 16u : 8u, image.texels });
	std::vector<float> texels(image.texels.size() / sizeof(float));
	std::memcpy(texels.data(), image.texels.data(), texels.size() * sizeof(float));
	return encodeExr(image.width, image.height, image.channels, texels);
}

static Status addTextures(GlbFile& file, const ImportedScene& scene)
{
	for (const Image& image : scene.images)
	{
		TRY_ASSIGN(const std::vector<std::byte> bytes, encodeImage(image));
		const char* type = image.format == TexelFormat::F32 ? "image/x-exr" : "image/png";
		file.append("images", { { "name", image.name }, { "mimeType", type }, { "bufferView", file.addView(bytes, kNoTarget) } });
	}
	for (const Texture& texture : scene.textures)
	{
		json sampler = { { "wrapS", wrapNumber(texture.wrap_u) }, { "wrapT", wrapNumber(texture.wrap_v) } };
		sampler["magFilter"] = texture.nearest ? kNearest : kLinear;
		const size_t index = file.append("samplers", std::move(sampler));
		file.append("textures", { { "source", texture.image }, { "sampler", index } });
	}
	return {};
}

// --- nodes ---------------------------------------------------------------------------------------------------------------------------

static void addNodes(GlbFile& file, const ImportedScene& scene)
{
	for (const Instance& instance : scene.instances)
	{
		json node = { { "mesh", instance.mesh } };
		if (instance.world != dmat4(1))
			node["matrix"] = jsonMatrix(instance.world);
		file.addNode(std::move(node));
	}
}

static json cameraJson(const FileCamera& camera)
{
	if (camera.orthographic)
	{
		// The format wants a width and a far plane, which we have not: square, and far away.
		const double half = camera.height_world / 2;
		json view = { { "xmag", half }, { "ymag", half }, { "znear", camera.near_world }, { "zfar", camera.near_world + 1e6 * half } };
		return { { "name", camera.name }, { "type", "orthographic" }, { "orthographic", std::move(view) } };
	}
	// A near distance is required; one that was not given becomes small.
	json view = { { "yfov", camera.fov_y_rad }, { "znear", camera.near_world > 0 ? camera.near_world : 1e-3 } };
	return { { "name", camera.name }, { "type", "perspective" }, { "perspective", std::move(view) } };
}

static void addCameras(GlbFile& file, const ImportedScene& scene)
{
	for (const FileCamera& camera : scene.cameras)
	{
		const size_t index = file.append("cameras", cameraJson(camera));
		file.addNode({ { "name", camera.name }, { "camera", index }, { "matrix", jsonMatrix(camera.world) } });
	}
}

Result<std::vector<std::byte>> encodeSceneGlb(const std::string& name, const ImportedScene& scene)
{
	GlbFile file(name);
	addMeshes(file, scene);
	TRY(addTextures(file, scene));
	for (const Material& material : scene.materials)
	{
		TRY_ASSIGN(json element, materialJson(file, material));
		file.append("materials", std::move(element));
	}
	addNodes(file, scene);
	addCameras(file, scene);
	return file.bytes();
}

Status writeSceneGlb(const std::filesystem::path& path, const ImportedScene& scene)
{
	TRY_ASSIGN(const std::vector<std::byte> bytes, encodeSceneGlb(path.string(), scene));
	return writeFile(path, bytes);
}

Status writeMeshGlb(const std::filesystem::path& path, const MeshView& mesh)
{
	checkMesh(mesh);
	GlbFile file(path.string());
	json attributes = { { "POSITION", addPositions(file, mesh.positions) } };
	if (!mesh.normals.empty())
		attributes["NORMAL"] = file.addAccessor(mesh.normals, "VEC3", kFloat, kArrayBuffer);
	if (!mesh.uvs.empty())
		attributes["TEXCOORD_0"] = file.addAccessor(mesh.uvs, "VEC2", kFloat, kArrayBuffer);
	json primitive = { { "attributes", std::move(attributes) } };
	primitive["indices"] = file.addAccessor(mesh.indices, "SCALAR", kUnsignedInt, kElementArrayBuffer);
	file.append("meshes", { { "primitives", json::array({ std::move(primitive) }) } });
	file.addNode({ { "mesh", 0 } });
	TRY_ASSIGN(const std::vector<std::byte> bytes, file.bytes());
	return writeFile(path, bytes);
}

}  // namespace tessera
