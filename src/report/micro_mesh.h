// The tessellated surface as triangle meshes: what a frame without culling draws.
#pragma once
#include "base/result.h"
#include "reference/classify.h"

namespace tessera::report
{

// A base triangle of a mesh: cluster and triangle within it.
struct BaseRef
{
	uint32_t cluster;
	uint32_t triangle;
};

// The micro-triangles of one instance, in mesh units. Vertices are shared within a part triangle only.
struct MicroMesh
{
	std::vector<vec3> positions;       // displaced
	std::vector<DomainPoint> domain;   // of each vertex, in the base triangle that it belongs to
	std::vector<uvec3> triangles;      // counter-clockwise as in the mesh
	std::vector<uint32_t> base_index;  // per triangle: into `bases`
	std::vector<BaseRef> bases;
};

struct MicroScene
{
	std::vector<MicroMesh> instances;
	reference::Classified pieces;  // what the meshes were made of

	uint64_t triangleCount() const;
};

// Classifies and evaluates every cluster of every instance on the CPU: the very positions that the device computes (the tests
// tessellation.* and raster.* hold that). On all threads; about 50 bytes per micro-triangle.
// Errors: BadInput (more micro-triangles than `most_triangles`, at most 2^31).
Result<MicroScene> tessellate(const reference::HostScene& scene, const View& view, uint32_t max_split, uint64_t most_triangles = uint64_t(1) << 31);

}  // namespace tessera::report
