#include "output/mesh_ply.h"

#include "base/check.h"
#include "base/file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace tessera
{

static_assert(std::endian::native == std::endian::little, "mesh files are written in the host's byte order, which must be little endian");

void checkMesh(const MeshView& mesh)
{
	const size_t count = mesh.positions.size();
	CHECK(mesh.normals.empty() || mesh.normals.size() == count, "{} normals for {} positions", mesh.normals.size(), count);
	CHECK(mesh.uvs.empty() || mesh.uvs.size() == count, "{} uvs for {} positions", mesh.uvs.size(), count);
	CHECK(mesh.indices.size() % 3 == 0, "{} indices are no whole triangles", mesh.indices.size());
	for (const uint32_t index : mesh.indices)
		CHECK(index < count, "index {} of {} vertices", index, count);
}

static std::string plyHeader(const MeshView& mesh)
{
	std::string text = "ply\nformat binary_little_endian 1.0\n";
	text += fmt::format("element vertex {}\n", mesh.positions.size());
	text += "property float x\nproperty float y\nproperty float z\n";
	if (!mesh.normals.empty())
		text += "property float nx\nproperty float ny\nproperty float nz\n";
	if (!mesh.uvs.empty())
		text += "property float s\nproperty float t\n";
	text += fmt::format("element face {}\n", mesh.indices.size() / 3);
	return text + "property list uchar uint vertex_indices\nend_header\n";
}

template <typename T>
static std::byte* put(std::byte* to, const T& value)
{
	std::memcpy(to, &value, sizeof(T));
	return to + sizeof(T);
}

Status writePly(const std::filesystem::path& path, const MeshView& mesh)
{
	checkMesh(mesh);
	constexpr size_t kMost = size_t(std::numeric_limits<int32_t>::max());
	if (mesh.positions.size() > kMost || mesh.indices.size() / 3 > kMost)
		return badInput("{}: {} vertices and {} triangles are too many, PLY counts to 2147483647", path.string(), mesh.positions.size(),
						mesh.indices.size() / 3);
	const std::string header = plyHeader(mesh);
	const size_t vertex_bytes = 12 + (mesh.normals.empty() ? 0 : 12) + (mesh.uvs.empty() ? 0 : 8);
	std::vector<std::byte> file(header.size() + mesh.positions.size() * vertex_bytes + mesh.indices.size() / 3 * 13);
	std::memcpy(file.data(), header.data(), header.size());
	std::byte* at = file.data() + header.size();
	for (size_t i = 0; i < mesh.positions.size(); ++i)
	{
		at = put(at, mesh.positions[i]);
		if (!mesh.normals.empty())
			at = put(at, mesh.normals[i]);
		if (!mesh.uvs.empty())
			at = put(at, vec2(mesh.uvs[i].x, 1.0f - mesh.uvs[i].y));
	}
	for (size_t i = 0; i < mesh.indices.size(); i += 3)
	{
		at = put(at, uint8_t(3));
		at = put(at, uvec3(mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]));
	}
	return writeFile(path, file);
}

}  // namespace tessera
