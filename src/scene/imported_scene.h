// What a file (or a built-in generator) says, validated and decoded, before anything is derived from it.
// Every index in here is in range, every float finite, every size consistent: later stages need not check again.
#pragma once
#include "base/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tessera
{

enum class TexelFormat : uint8_t
{
	U8,   // 0..255 stands for 0..1
	U16,  // 0..65535 stands for 0..1
	F32,  // as stored
};

enum class Wrap : uint8_t
{
	Repeat = 0,
	ClampToEdge = 1,
	MirroredRepeat = 2,
};

// A decoded image: rows top to bottom, channels interleaved.
struct Image
{
	std::string name;       // file, or place in the file, for messages
	uint32_t width = 0;     // 1..16384
	uint32_t height = 0;    // 1..16384
	uint32_t channels = 0;  // 1..4
	TexelFormat format = TexelFormat::U8;
	std::vector<std::byte> texels;  // width * height * channels * size of the format
};

struct Texture
{
	uint32_t image = 0;
	Wrap wrap_u = Wrap::Repeat;
	Wrap wrap_v = Wrap::Repeat;
	bool nearest = false;  // magnification filter (colour only; heights are always blended)
};

// A texture as a material uses it. uv' = (row0 . (u, v, 1), row1 . (u, v, 1)): KHR_texture_transform.
struct TextureUse
{
	uint32_t texture = 0;
	uint32_t texcoord = 0;  // which TEXCOORD_n
	dvec3 row0 = { 1, 0, 0 };
	dvec3 row1 = { 0, 1, 0 };
};

// KHR_materials_displacement: height = red channel * factor + offset, in mesh units along the normal.
struct Displacement
{
	TextureUse height;
	float factor = 1;
	float offset = 0;
};

struct Material
{
	std::string name;
	vec4 base_color = { 1, 1, 1, 1 };              // linear
	std::optional<TextureUse> base_color_texture;  // sRGB
	float metallic = 1;
	float roughness = 1;
	vec3 emissive = { 0, 0, 0 };
	bool double_sided = false;
	std::optional<Displacement> displacement;  // set only if all primitives with this material have the TEXCOORD set it reads
	std::optional<uint32_t> variant_of;        // a copy of that material, for primitives that lack texture coordinates for it
};

// Triangles of one material. Attribute arrays are empty or as long as positions.
struct Primitive
{
	std::vector<vec3> positions;               // mesh units, finite, no negative zeros, |x| >= 2^-60 or 0
	std::vector<vec3> normals;                 // authored; unit length or zero; empty when the file has none
	std::vector<std::vector<vec2>> texcoords;  // [set][vertex], finite; a set that the file lacks is empty
	std::vector<vec4> colors;                  // COLOR_0, linear; empty when the file has none
	std::vector<uint32_t> indices;             // 3 per triangle, counter-clockwise front
	uint32_t material = 0;
};

struct Mesh
{
	std::string name;
	std::vector<Primitive> primitives;
};

struct Instance
{
	uint32_t mesh = 0;
	dmat4 world = dmat4(1);  // mesh to world, affine
};

struct FileCamera
{
	std::string name;
	dmat4 world = dmat4(1);  // looks along its -z
	bool orthographic = false;
	double fov_y_rad = 1.0471975512;  // perspective: vertical field of view
	double height_world = 2;          // orthographic: height of the view
	double near_world = 0;            // 0: not given
};

struct ImportedScene
{
	std::string path;
	std::vector<Image> images;
	std::vector<Texture> textures;
	std::vector<Material> materials;  // at least one; a primitive without one uses a default appended by the importer
	std::vector<Mesh> meshes;
	std::vector<Instance> instances;
	std::vector<FileCamera> cameras;
	std::vector<std::string> warnings;  // what the file asks for and we leave out, by name
};

}  // namespace tessera
