// A surface as triangles in the world, all instances together: to take points of by area, and to ask for nearest points.
#pragma once
#include "base/result.h"
#include "report/embree_scene.h"
#include "report/reference_surface.h"
#include "scene/imported_scene.h"

namespace tessera::report
{

struct WorldSpot
{
	uint32_t triangle = 0;
	dvec2 weights = dvec2(0);  // of its first two corners
};

// Points are relative to `origin` (world units) and rounded to float there: 3e-8 of the largest distance from it.
class WorldSurface
{
public:
	WorldSurface(dvec3 origin, std::span<const vec3> positions, std::span<const uvec3> triangles);

	dvec3 origin() const { return origin_; }
	dvec3 low() const { return low_; }  // bounds, world units
	dvec3 high() const { return high_; }
	double area() const { return areas_.empty() ? 0 : areas_.back(); }  // world units squared
	uint64_t triangleCount() const { return areas_.size(); }

	// Of numbers of 0..1: where in the whole area, and within the triangle. The area must not be 0.
	WorldSpot spotAt(dvec3 numbers) const;
	dvec3 point(const WorldSpot& spot) const;
	// From `q`, relative to the origin; infinite where there is no triangle.
	double distance(dvec3 q) const;

private:
	dvec3 origin_;
	dvec3 low_ = dvec3(0), high_ = dvec3(0);
	TriangleSet set_;
	std::vector<double> areas_;  // per triangle: area up to and with it
};

inline constexpr uint64_t kMostWorldTriangles = uint64_t(1) << 26;  // of an original

// The triangles of a model as its file has them, not displaced, of all its instances; the origin is the middle of its bounds.
// Errors: BadInput (no triangle with an area, more than kMostWorldTriangles over all instances).
Result<WorldSurface> originalSurface(const ImportedScene& model);

// The micro-triangles of every instance.
WorldSurface drawnSurface(const reference::HostScene& scene, const MicroScene& micro, dvec3 origin);

// The surface that base, height maps and `view` describe, as triangles between points of it.
WorldSurface describedSurface(const reference::HostScene& scene, const ReferenceSurface& surface, dvec3 origin);

}  // namespace tessera::report
