#include "import_check.h"

#include "scene/build.h"
#include "scene/gltf_import.h"

#include <cmath>

namespace tessera::test
{

namespace
{

// Beyond these a scene is not built: it would only make the search slower.
constexpr size_t kMostTriangles = 4000, kMostInstances = 1000, kMostTexels = 1u << 18;

bool isGood(float value)
{
	return std::isfinite(value) && !(value == 0 && std::signbit(value)) && (value == 0 || std::fabs(value) >= 0x1p-60f);
}

std::string checkPrimitive(const Primitive& primitive, const ImportedScene& scene)
{
	const size_t count = primitive.positions.size();
	if (primitive.indices.empty() || primitive.indices.size() % 3 != 0)
		return fmt::format("a primitive has {} indices", primitive.indices.size());
	for (const uint32_t index : primitive.indices)
		if (index >= count)
			return fmt::format("index {} of {} vertices", index, count);
	for (const vec3& p : primitive.positions)
		if (!isGood(p.x) || !isGood(p.y) || !isGood(p.z))
			return fmt::format("position {} {} {}", p.x, p.y, p.z);
	if (!primitive.normals.empty() && primitive.normals.size() != count)
		return "normals are not as many as positions";
	for (const vec3& n : primitive.normals)
		if (n != vec3(0) && !(std::fabs(glm::length(n) - 1) < 1e-5f))
			return fmt::format("normal {} {} {}", n.x, n.y, n.z);
	if (!primitive.colors.empty() && primitive.colors.size() != count)
		return "colours are not as many as positions";
	for (const std::vector<vec2>& set : primitive.texcoords)
	{
		if (!set.empty() && set.size() != count)
			return "texture coordinates are not as many as positions";
		for (const vec2& uv : set)
			if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
				return "a texture coordinate is not finite";
	}
	if (primitive.material >= scene.materials.size())
		return "a primitive has a material that does not exist";
	const Material& material = scene.materials[primitive.material];
	const auto lacks = [&](const TextureUse& use) {
		return use.texcoord >= primitive.texcoords.size() || primitive.texcoords[use.texcoord].empty();
	};
	if ((material.base_color_texture && lacks(*material.base_color_texture)) || (material.displacement && lacks(material.displacement->height)))
		return "a primitive lacks the texture coordinates of its material";
	return "";
}

std::string checkImage(const Image& image)
{
	const size_t texel = image.format == TexelFormat::U8 ? 1 : image.format == TexelFormat::U16 ? 2 : 4;
	if (image.width < 1 || image.width > 16384 || image.height < 1 || image.height > 16384 || image.channels < 1 || image.channels > 4)
		return fmt::format("an image of {} x {}, {} channels", image.width, image.height, image.channels);
	if (image.texels.size() != size_t(image.width) * image.height * image.channels * texel)
		return "an image has another size than it says";
	return "";
}

std::string checkMaterial(const Material& material, const ImportedScene& scene)
{
	if (material.base_color_texture && material.base_color_texture->texture >= scene.textures.size())
		return "a material has a colour texture that does not exist";
	if (!material.displacement)
		return "";
	if (material.displacement->height.texture >= scene.textures.size())
		return "a material has a height texture that does not exist";
	if (!std::isfinite(material.displacement->factor) || !std::isfinite(material.displacement->offset))
		return "a displacement is not finite";
	return "";
}

// The promises of imported_scene.h.
std::string checkPromises(const ImportedScene& scene)
{
	if (scene.materials.empty() || scene.instances.empty())
		return "no material or no instance";
	for (const Instance& instance : scene.instances)
	{
		if (instance.mesh >= scene.meshes.size())
			return "an instance has a mesh that does not exist";
		for (int i = 0; i < 16; ++i)
			if (!std::isfinite(static_cast<float>(instance.world[i / 4][i % 4])))
				return "a matrix is not finite";
	}
	for (const Texture& texture : scene.textures)
		if (texture.image >= scene.images.size())
			return "a texture has an image that does not exist";
	std::string wrong;
	for (const Image& image : scene.images)
		wrong = wrong.empty() ? checkImage(image) : wrong;
	for (const Material& material : scene.materials)
		wrong = wrong.empty() ? checkMaterial(material, scene) : wrong;
	for (const Mesh& mesh : scene.meshes)
		for (const Primitive& primitive : mesh.primitives)
			wrong = wrong.empty() ? checkPrimitive(primitive, scene) : wrong;
	for (const std::string& warning : scene.warnings)
		if (warning.find('\n') != std::string::npos)
			return "a warning has several lines: " + warning;
	return wrong;
}

std::string checkRefusal(const Error& error)
{
	if (error.code != ExitCode::BadInput)
		return fmt::format("refused with exit code {}", int(error.code));
	if (error.message.empty() || error.message.find('\n') != std::string::npos)
		return "refused with a message that is not one line: " + error.message;
	return "";
}

bool isSmall(const ImportedScene& scene)
{
	size_t triangles = 0, texels = 0;
	for (const Mesh& mesh : scene.meshes)
		for (const Primitive& primitive : mesh.primitives)
			triangles += primitive.indices.size() / 3;
	for (const Image& image : scene.images)
		texels += size_t(image.width) * image.height;
	return triangles <= kMostTriangles && texels <= kMostTexels && scene.instances.size() <= kMostInstances;
}

// The builder's own promise here: everything stays finite and every triangle is there once.
std::string checkBuilt(const ImportedScene& imported, const BuiltScene& scene)
{
	uint64_t triangles = 0;
	for (const Instance& instance : imported.instances)
		for (const Primitive& primitive : imported.meshes[instance.mesh].primitives)
			triangles += primitive.indices.size() / 3;
	if (scene.traits.instanced_triangles != triangles)
		return fmt::format("built {} triangles of {}", scene.traits.instanced_triangles, triangles);
	for (const auto* vectors : { &scene.positions, &scene.normals, &scene.directions })
		for (const vec3& v : *vectors)
			if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
				return "a vertex of the built scene is not finite";
	for (const auto* coordinates : { &scene.uvs, &scene.color_uvs })
		for (const vec2& uv : *coordinates)
			if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
				return "a texture coordinate of the built scene is not finite";
	for (const float density : scene.densities)
		if (!std::isfinite(density) || density < 0)
			return fmt::format("a texel density is {}", density);
	for (const DisplacedBounds& bounds : scene.cluster_bounds)
		for (int c = 0; c < 3; ++c)
			if (!(bounds.low[c] <= bounds.high[c]) || !(bounds.reach_low <= bounds.reach_high))
				return "bounds are empty or not finite";
	return "";
}

}  // namespace

std::string checkImport(std::span<const std::byte> bytes)
{
	const Result<ImportedScene> imported = importGltf("no-such-folder/input.gltf", { bytes.begin(), bytes.end() });
	if (!imported)
		return checkRefusal(imported.error());
	if (const std::string wrong = checkPromises(*imported); !wrong.empty() || !isSmall(*imported))
		return wrong;
	const Result<BuiltScene> built = buildScene(*imported);
	return built ? checkBuilt(*imported, *built) : checkRefusal(built.error());
}

}  // namespace tessera::test
