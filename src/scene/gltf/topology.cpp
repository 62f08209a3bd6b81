#include "scene/gltf/topology.h"

namespace tessera
{

std::vector<uint32_t> triangleList(int mode, std::vector<uint32_t> indices)
{
	if (mode == kGltfTriangles)
	{
		indices.resize(indices.size() / 3 * 3);
		return indices;
	}
	std::vector<uint32_t> triangles;
	if (indices.size() < 3)
		return triangles;
	triangles.reserve((indices.size() - 2) * 3);
	for (size_t i = 0; i + 2 < indices.size(); ++i)
	{
		// glTF 2.0, section 3.7.2.1: a strip swaps the last two corners of every odd triangle; a fan starts at its second corner.
		const size_t odd = i % 2;
		if (mode == kGltfTriangleStrip)
			triangles.insert(triangles.end(), { indices[i], indices[i + 1 + odd], indices[i + 2 - odd] });
		else
			triangles.insert(triangles.end(), { indices[i + 1], indices[i + 2], indices[0] });
	}
	return triangles;
}

}  // namespace tessera
