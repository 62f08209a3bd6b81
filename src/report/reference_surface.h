// The surface that error is measured against: the base surface (flat, or of PN triangles) displaced with the height map at mip 0, in double
// precision, and the nearest point of it. (DESIGN.md, section 8)
#pragma once
#include "reference/double_surface.h"
#include "report/embree_scene.h"
#include "report/micro_mesh.h"

namespace tessera::report
{

// A point of a base triangle: weights of its first two corners.
struct SurfaceSpot
{
	BaseRef base;
	dvec2 weights;
};

struct SurfaceFrame
{
	dvec3 point;    // mesh units
	dvec3 along_u;  // derivatives by the two weights
	dvec3 along_v;

	dvec3 normal() const { return glm::cross(along_u, along_v); }  // outward; not normalised: the area element of the weights
};

class ReferenceSurface
{
public:
	// Both must outlive it; of the view only the displacement scale counts. Starting points for nearest points come from a mesh of about
	// `most_triangles` for the whole scene, fine where the height maps are. About 100 bytes for each.
	ReferenceSurface(const reference::HostScene& scene, const View& view, uint32_t most_triangles = 1'500'000);

	dvec3 point(const SurfaceSpot& spot) const;
	SurfaceFrame frame(const SurfaceSpot& spot) const;

	// Distance in mesh units from `q` to the surface of mesh `mesh`. `start` is a spot that lies near the nearest point; the result is never
	// farther than it. Exact where the surface is smooth; where it has creases (between texels) the search may end a little beside
	// the nearest point. Source: Gauss-Newton with halved steps from each start, Nocedal and Wright, Numerical Optimization, chapter 10.
	double distance(uint32_t mesh, dvec3 q, const SurfaceSpot& start) const;

	// The surface of a mesh as the triangles that searches start from, their corners on it; null for a mesh without triangles.
	const TriangleSet* trianglesOf(uint32_t mesh) const { return coarse_[mesh].set.empty() ? nullptr : &coarse_[mesh].set[0]; }

	uint64_t triangleCount() const;

private:
	// The surface of one mesh as triangles between points of it.
	struct Coarse
	{
		std::vector<BaseRef> bases;
		std::vector<uint32_t> base_index;          // per triangle
		std::vector<std::array<vec2, 3>> weights;  // per triangle, of its corners
		std::vector<TriangleSet> set;              // one, or none for a mesh without triangles
		double slack = 0;                          // mesh units: how far it is from the surface, three times the mean
	};

	Coarse coarseOf(const MeshRecord& mesh, double cuts_per_texel) const;
	double meanDeviation(const Coarse& coarse, const std::vector<vec3>& positions, const std::vector<uvec3>& corners) const;
	double texelArea(BaseRef base) const;
	double descend(dvec3 q, SurfaceSpot& spot) const;
	BaseTriangle baseTriangle(BaseRef base) const { return scene_.base({ 0, base.cluster }, base.triangle); }

	const reference::HostScene& scene_;
	View view_;
	reference::DoubleSurface surface_;
	uint32_t least_cuts_ = 1;     // per edge of a base triangle
	std::vector<Coarse> coarse_;  // per mesh
};

}  // namespace tessera::report
