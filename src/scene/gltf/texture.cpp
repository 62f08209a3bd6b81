#include "scene/gltf/material.h"

#include "base/parallel.h"
#include "scene/gltf/uri.h"
#include "scene/image_decode.h"

#include <algorithm>
#include <map>

namespace tessera
{

static constexpr int kNearest = 9728;
static constexpr int kRepeat = 10497;
static constexpr int kClampToEdge = 33071;
static constexpr int kMirroredRepeat = 33648;

static Result<Wrap> wrapMode(const GltfDocument& document, const std::string& place, int mode)
{
	switch (mode)
	{
	case kRepeat:
		return Wrap::Repeat;
	case kClampToEdge:
		return Wrap::ClampToEdge;
	case kMirroredRepeat:
		return Wrap::MirroredRepeat;
	default:
		return document.bad(place, "is {}, but 10497 (repeat), 33071 (clamp) or 33648 (mirror) is right", mode);
	}
}

// The image of a texture; formats that only extensions allow are refused by the extension's name.
static Result<size_t> imageOfTexture(const GltfDocument& document, const std::string& place, const tinygltf::Texture& texture)
{
	if (texture.source >= 0)
		return static_cast<size_t>(texture.source);
	for (const char* name : { "KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds" })
		if (texture.extensions.contains(name))
			return document.bad(place, "its image exists only through {}, which is not supported; PNG, JPEG or EXR is right", name);
	return document.bad(place + ".source", "is missing, but a material uses the texture");
}

namespace
{

// Numbers textures and images in the order in which materials ask for them.
class TextureCollector
{
public:
	TextureCollector(const GltfDocument& document, const tinygltf::Model& model, ImportedScene& scene)
		: m_document(document), m_model(model), m_scene(scene)
	{}

	// Turns the file's texture index in `use` into the scene's.
	Status renumber(TextureUse& use)
	{
		const auto found = m_texture_of_source.find(use.texture);
		if (found != m_texture_of_source.end())
		{
			use.texture = found->second;
			return {};
		}
		TRY_ASSIGN(const Texture texture, convert(use.texture));
		const uint32_t number = static_cast<uint32_t>(m_scene.textures.size());
		m_scene.textures.push_back(texture);
		m_texture_of_source[use.texture] = number;
		use.texture = number;
		return {};
	}

	const std::vector<size_t>& imageSources() const { return m_image_sources; }

private:
	Result<Texture> convert(uint32_t source_index)
	{
		const tinygltf::Texture& source = m_model.textures[source_index];
		TRY_ASSIGN(const size_t image, imageOfTexture(m_document, fmt::format("textures[{}]", source_index), source));
		Texture texture;
		if (source.sampler >= 0)
		{
			const tinygltf::Sampler& sampler = m_model.samplers[static_cast<size_t>(source.sampler)];
			const std::string place = fmt::format("samplers[{}]", source.sampler);
			TRY_ASSIGN(texture.wrap_u, wrapMode(m_document, place + ".wrapS", sampler.wrapS));
			TRY_ASSIGN(texture.wrap_v, wrapMode(m_document, place + ".wrapT", sampler.wrapT));
			texture.nearest = sampler.magFilter == kNearest;
		}
		const auto [entry, inserted] = m_image_of_source.try_emplace(image, static_cast<uint32_t>(m_image_sources.size()));
		if (inserted)
			m_image_sources.push_back(image);
		texture.image = entry->second;
		return texture;
	}

	const GltfDocument& m_document;
	const tinygltf::Model& m_model;
	ImportedScene& m_scene;
	std::map<uint32_t, uint32_t> m_texture_of_source;
	std::map<size_t, uint32_t> m_image_of_source;
	std::vector<size_t> m_image_sources;
};

struct DecodedImage
{
	Result<Image> image = Image();
	std::vector<std::string> warnings;
};

}  // namespace

static Result<Image> loadImage(const GltfDocument& document, size_t index, std::vector<std::string>& warnings)
{
	const Json& source = document.json["images"][index];
	const std::string place = fmt::format("images[{}]", index);
	const std::string name = fmt::format("{}: {}", document.file, place);
	if (source.contains("bufferView") == source.contains("uri"))
		return document.bad(place, "exactly one of bufferView and uri is right");
	if (source.contains("bufferView"))
	{
		TRY_ASSIGN(const std::span<const std::byte> bytes, bufferViewBytes(document, source["bufferView"].get<size_t>()));
		return decodeImage(bytes, name, warnings);
	}
	const std::string& uri = source["uri"].get_ref<const std::string&>();
	Result<std::vector<std::byte>> content = readUri(document.folder, uri);
	if (!content)
		return document.bad(place + ".uri", "{}", content.error().message);
	return decodeImage(*content, uri.starts_with("data:") ? name : fmt::format("{} ({})", name, shownUri(uri)), warnings);
}

static Status loadImages(GltfDocument& document, const std::vector<size_t>& sources, ImportedScene& scene)
{
	std::vector<DecodedImage> decoded(sources.size());
	parallelFor(sources.size(), [&](size_t i) {
		try
		{
			decoded[i].image = loadImage(document, sources[i], decoded[i].warnings);
		}
		catch (const std::bad_alloc&)
		{
			decoded[i].image = document.bad(fmt::format("images[{}]", sources[i]), "does not fit into memory");
		}
	});
	for (size_t i = 0; i < sources.size(); ++i)
	{
		TRY_ASSIGN(Image image, decoded[i].image);
		scene.images.push_back(std::move(image));
		for (const std::string& warning : decoded[i].warnings)
			document.warnings.add(fmt::format("images[{}]", sources[i]), warning);
	}
	return {};
}

Status importTextures(GltfDocument& document, const tinygltf::Model& model, ImportedScene& scene)
{
	std::vector<bool> used(scene.materials.size(), false);
	for (const Mesh& mesh : scene.meshes)
		for (const Primitive& primitive : mesh.primitives)
			used[primitive.material] = true;

	TextureCollector collector(document, model, scene);
	for (size_t i = 0; i < scene.materials.size(); ++i)
	{
		Material& material = scene.materials[i];
		if (!used[i])
		{
			material.base_color_texture.reset();
			material.displacement.reset();
		}
		if (material.base_color_texture)
			TRY(collector.renumber(*material.base_color_texture));
		if (material.displacement)
			TRY(collector.renumber(material.displacement->height));
	}
	return loadImages(document, collector.imageSources(), scene);
}

}  // namespace tessera
