// Vertices of separate triangles made one indexed mesh.
#pragma once
#include "output/mesh_ply.h"

#include <unordered_map>
#include <vector>

namespace tessera
{

struct WeldVertex
{
	vec3 position;  // as written
	vec3 normal;    // unit; zero when there is none
	vec2 uv;
};

// Makes vertices one when they lie in one place and have about the same attributes: the two sides of a smooth edge compute
// normals and texture coordinates with different last bits. Normals within 0.8 degrees and texture coordinates within 1e-5 (relative
// above 1) are the same; hard edges and texture seams stay apart, with equal positions.
class MeshWelder
{
public:
	// `place` and `group`: vertices of one group whose places are equal bit for bit are in one place.
	uint32_t add(uint32_t group, vec3 place, const WeldVertex& vertex);

	// Leaves out a triangle of which two corners are one vertex.
	void addTriangle(uint32_t a, uint32_t b, uint32_t c);

	uint64_t collapsedTriangles() const { return collapsed_; }
	// Valid until something is added.
	MeshView view(bool with_uvs) const;

private:
	struct Place
	{
		uint32_t group;
		vec3 point;
		bool operator==(const Place& other) const;
	};
	struct PlaceHash
	{
		size_t operator()(const Place& place) const;
	};
	static constexpr uint32_t kNone = 0xffffffff;

	std::unordered_map<Place, uint32_t, PlaceHash> first_;  // vertex added last in a place
	std::vector<uint32_t> next_;                            // per vertex: another one in its place
	std::vector<vec3> positions_, normals_;
	std::vector<vec2> uvs_;
	std::vector<uint32_t> indices_;
	uint64_t collapsed_ = 0;
};

}  // namespace tessera
