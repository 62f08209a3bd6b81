// The surface and the factors again, in double precision and from their definitions (DESIGN.md, sections 5 and 7) instead of the shared
// headers: what the float results are held against.
#pragma once
#include "reference/host_scene.h"

namespace tessera::reference
{

// The log2 of the mip level: the true one, or linear between powers of two as the definition of the float code has it. The latter
// leaves nothing but rounding between the two evaluations.
enum class MipLog
{
	True,
	PiecewiseLinear,
};

struct DoublePoint
{
	dvec3 base = dvec3(0);       // mesh units
	dvec3 displaced = dvec3(0);  // mesh units
	double displacement = 0;     // along the direction, mesh units
	double level = 0;            // mip level, 0..level count - 1
	// No component of the float result differs by more than this, mesh units. Derived, not measured: see the .cpp.
	double base_bound = 0;
	double displaced_bound = 0;
};

class DoubleSurface
{
public:
	// Kept by reference: both must outlive this object.
	DoubleSurface(const HostScene& scene, const View& view, MipLog log = MipLog::PiecewiseLinear);

	DoublePoint at(ClusterRef ref, uint32_t triangle, DomainPoint p) const;

	// The displaced point on mip 0, whatever the view, in mesh units: the surface that error is measured against. `weights` are those of
	// the three corners; their sum is 1.
	dvec3 onFinestMip(const BaseTriangle& base, dvec3 weights) const;

	// Length of the undisplaced edge over the wanted segment length at its nearer end: L * focal_px / (rate * max(near, d)), before it
	// is rounded and limited. The tess factor is clamp(floor(this + 1/2), 1, limit); within 1e-5 of a half (relative; farther when the eye
	// lies on the mesh to a few ulps) the float comparison may fall either way.
	double realFactor(ClusterRef ref, uint32_t triangle, DomainPoint p, DomainPoint q) const;

private:
	struct Height
	{
		double value, level, bound;
	};
	struct Source;

	dvec3 fromEye(uint32_t instance, dvec3 mesh_point) const;
	double rateDistance(dvec3 from_eye) const;
	dvec3 basePoint(const BaseTriangle& base, dvec3 weights) const;
	dvec3 flatPoint(const BaseTriangle& base, DomainPoint p) const;
	double baseBound(const BaseTriangle& base) const;
	Source ownSource(const BaseTriangle& base, dvec3 weights) const;
	Source sourceAt(const BaseTriangle& base, dvec3 weights) const;
	double levelOf(double footprint_squared) const;
	Height heightAt(const Source& source, uint32_t instance, dvec3 base_point, double base_bound) const;

	const HostScene& scene_;
	const View& view_;
	MipLog log_;
	dvec3 eye_;
	std::vector<double> map_ranges_;  // per height map: largest minus smallest texel
	std::vector<double> map_peaks_;   // and the largest magnitude
};

}  // namespace tessera::reference
