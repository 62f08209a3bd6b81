// Writes the seeds of the corpus: small files that together use everything the importer reads. `make_corpus FOLDER`
#include "../cpu/gltf_file.h"

#include "output/png.h"

#include <cstdio>
#include <cstring>

namespace tessera::test
{

namespace
{

namespace fs = std::filesystem;

std::vector<std::byte> png(uint32_t width, uint32_t height, uint32_t channels, uint32_t bits)
{
	std::vector<std::byte> texels(size_t(width) * height * channels * bits / 8);
	for (size_t i = 0; i < texels.size(); ++i)
		texels[i] = static_cast<std::byte>(i * 37 % 251);
	return *encodePng({ width, height, channels, bits, texels });
}

void displace(GltfFile& file, const std::vector<std::byte>& image, const char* mime)
{
	const size_t view = file.addView(image.data(), image.size());
	file.json["images"] = Json::array({ { { "bufferView", view }, { "mimeType", mime } } });
	file.json["samplers"] = Json::array({ { { "wrapS", 33071 }, { "wrapT", 33648 }, { "magFilter", 9728 } } });
	file.json["textures"] = Json::array({ { { "source", 0 }, { "sampler", 0 } } });
	file.json["extensionsUsed"] = { "KHR_materials_displacement", "KHR_texture_transform" };
	file.json["materials"][0]["extensions"]["KHR_materials_displacement"] = {
		{ "displacementGeometryTexture",
		  { { "index", 0 },
			{ "texCoord", 0 },
			{ "extensions", { { "KHR_texture_transform", { { "offset", { 0.25, 0.5 } }, { "rotation", 0.5 }, { "scale", { 2, 3 } } } } } } } },
		{ "displacementGeometryFactor", 0.25 },
		{ "displacementGeometryOffset", -0.125 }
	};
}

GltfFile displaced(const std::vector<std::byte>& image, const char* mime)
{
	GltfFile file = squareFile();
	displace(file, image, mime);
	return file;
}

GltfFile coloured()
{
	GltfFile file = squareFile();
	const size_t colors = file.add(std::vector<uint8_t>{ 255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 128, 128, 128, 64 }, "VEC4", 5121, true);
	const size_t second = file.add(std::vector<uint16_t>{ 0, 0, 65535, 0, 65535, 65535, 0, 65535 }, "VEC2", 5123, true);
	Json& primitive = file.json["meshes"][0]["primitives"][0];
	primitive["attributes"]["COLOR_0"] = colors;
	primitive["attributes"]["TEXCOORD_1"] = second;
	const std::vector<std::byte> image = png(4, 2, 3, 8);
	const size_t view = file.addView(image.data(), image.size());
	file.json["images"] = Json::array({ { { "bufferView", view }, { "mimeType", "image/png" } } });
	file.json["textures"] = Json::array({ { { "source", 0 } } });
	file.json["materials"][0]["pbrMetallicRoughness"] = { { "baseColorFactor", { 1, 0.5, 0.25, 1 } },
														  { "metallicFactor", 0.5 },
														  { "roughnessFactor", 0.75 },
														  { "baseColorTexture", { { "index", 0 }, { "texCoord", 1 } } } };
	file.json["materials"][0]["doubleSided"] = true;
	file.json["materials"][0]["emissiveFactor"] = { 0.1, 0.2, 0.3 };
	return file;
}

// One vertex buffer as list, strip, fan and without indices; with narrow indices.
GltfFile topologies()
{
	GltfFile file;
	const size_t positions = file.addFloats({ 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5f, 2, 0, 2, 2, 1 }, "VEC3");
	const size_t narrow = file.add(std::vector<uint8_t>{ 0, 1, 2, 2, 3, 0 }, "SCALAR", 5121);
	const size_t medium = file.add(std::vector<uint16_t>{ 0, 1, 3, 2, 4, 5 }, "SCALAR", 5123);
	file.addPrimitive({ { "POSITION", positions } })["indices"] = narrow;
	file.addPrimitive({ { "POSITION", positions } }, 5)["indices"] = medium;
	file.addPrimitive({ { "POSITION", positions } }, 6)["indices"] = medium;
	file.addPrimitive({ { "POSITION", positions } });
	file.addPrimitive({ { "POSITION", positions } }, 1);
	return file;
}

GltfFile sparse()
{
	GltfFile file = squareFile();
	const std::vector<uint16_t> indices = { 1, 3 };
	const std::vector<float> values = { 1.5f, 0, 0.5f, 0, 1.5f, 0.5f };
	const size_t index_view = file.addView(indices.data(), indices.size() * 2), value_view = file.addView(values.data(), values.size() * 4);
	file.json["accessors"][0]["sparse"] = { { "count", 2 },
											{ "indices", { { "bufferView", index_view }, { "componentType", 5123 } } },
											{ "values", { { "bufferView", value_view } } } };
	return file;
}

GltfFile hierarchy()
{
	GltfFile file = squareFile();
	const size_t translations = file.addFloats({ 0, 0, 0, 2, 0, 0, 4, 0, 0 }, "VEC3");
	const size_t rotations = file.add(std::vector<int16_t>{ 0, 0, 0, 32767, 0, 32767, 0, 0, 23170, 0, 0, 23170 }, "VEC4", 5122, true);
	const size_t scales = file.addFloats({ 1, 1, 1, -1, 1, 1, 1, 2, 3 }, "VEC3");
	file.json["extensionsUsed"] = { "EXT_mesh_gpu_instancing" };
	file.json["nodes"] =
		Json::array({ { { "children", { 1, 2, 3 } }, { "translation", { 1, 2, 3 } }, { "rotation", { 0, 0, 0.6, 0.8 } }, { "scale", { 1, 1, 2 } } },
					  { { "mesh", 0 }, { "matrix", { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1 } } },
					  { { "mesh", 0 },
						{ "extensions",
						  { { "EXT_mesh_gpu_instancing",
							  { { "attributes", { { "TRANSLATION", translations }, { "ROTATION", rotations }, { "SCALE", scales } } } } } } } },
					  { { "camera", 0 }, { "children", { 4 } } },
					  { { "camera", 1 } } });
	file.json["cameras"] =
		Json::array({ { { "type", "perspective" }, { "perspective", { { "yfov", 0.8 }, { "znear", 0.1 } } } },
					  { { "type", "orthographic" }, { "orthographic", { { "xmag", 1 }, { "ymag", 2 }, { "zfar", 100 }, { "znear", 0.1 } } } } });
	return file;
}

GltfFile interleaved()
{
	GltfFile file;
	std::vector<float> vertices;
	for (int i = 0; i < 9; ++i)
		for (const float value : { float(i % 3), float(i / 3), 0.0f, 0.0f, 0.0f, 1.0f, float(i % 3) / 2, float(i / 3) / 2 })
			vertices.push_back(value);
	const size_t view = file.addView(vertices.data(), vertices.size() * 4, 32);
	const auto accessor = [&](size_t offset, const char* type) {
		file.json["accessors"].push_back(
			{ { "bufferView", view }, { "byteOffset", offset }, { "componentType", 5126 }, { "type", type }, { "count", 9 } });
		return file.json["accessors"].size() - 1;
	};
	const size_t positions = accessor(0, "VEC3"), normals = accessor(12, "VEC3"), coordinates = accessor(24, "VEC2");
	Json& primitive = file.addPrimitive({ { "POSITION", positions }, { "NORMAL", normals }, { "TEXCOORD_0", coordinates } });
	primitive["indices"] = file.addIndices({ 0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 3, 4, 7, 3, 7, 6, 4, 5, 8, 4, 8, 7 });
	return file;
}

// A description and its external data from tests/data as one .glb.
void writeCompressed(const fs::path& folder)
{
	GltfFile file;
	const std::vector<std::byte> text = readBytes(dataFile("draco_grid.gltf"));
	file.json = Json::parse(reinterpret_cast<const char*>(text.data()), reinterpret_cast<const char*>(text.data()) + text.size());
	file.binary = readBytes(dataFile("draco_grid.bin"));
	file.json["buffers"] = Json::array({ { { "byteLength", file.binary.size() } } });
	fs::rename(file.writeGlb(folder), folder / "draco.glb");
}

void writeAll(const fs::path& folder)
{
	const auto put = [&](const GltfFile& file, const char* name) {
		fs::rename(file.writeGlb(folder), folder / name);
	};
	put(squareFile(), "square.glb");
	put(coloured(), "coloured.glb");
	put(topologies(), "topologies.glb");
	put(sparse(), "sparse.glb");
	put(hierarchy(), "hierarchy.glb");
	put(interleaved(), "interleaved.glb");
	put(displaced(png(8, 8, 1, 8), "image/png"), "height_u8.glb");
	put(displaced(png(5, 3, 1, 16), "image/png"), "height_u16.glb");
	put(displaced(png(1, 7, 4, 16), "image/png"), "height_rgba16.glb");
	put(displaced(readBytes(dataFile("color.jpg")), "image/jpeg"), "height_jpeg.glb");
	for (const char* exr : { "height_float", "height_half", "height_not_finite", "height_piz", "height_rle", "height_zips" })
		put(displaced(readBytes(dataFile(fmt::format("{}.exr", exr))), "image/x-exr"), fmt::format("{}.glb", exr).c_str());
	writeCompressed(folder);
	squareFile().write(folder, "square.gltf");
	displaced(png(3, 3, 1, 8), "image/png").write(folder, "height_u8.gltf");
}

}  // namespace

}  // namespace tessera::test

int main(int argc, char** argv)
{
	if (argc != 2)
	{
		std::fprintf(stderr, "usage: make_corpus FOLDER\n");
		return 2;
	}
	std::filesystem::create_directories(argv[1]);
	tessera::test::writeAll(argv[1]);
	return 0;
}
