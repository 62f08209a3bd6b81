// Points of the tessellated surface, chosen over its whole area or over what the camera sees, and the distances between the two
// surfaces there.
#pragma once
#include "report/reference_surface.h"

namespace tessera::report
{

// A point of a micro-triangle: weights of its first two corners.
struct MicroSpot
{
	uint32_t instance = 0;
	uint32_t triangle = 0;
	dvec2 weights = dvec2(0);
};

// What was measured at a spot. Lengths in mesh units.
struct Sample
{
	MicroSpot spot;
	double to_tessellated = 0;    // from the reference point with the same domain coordinates to the tessellated surface
	double to_reference = 0;      // from the tessellated point to the reference surface
	double area_ratio = 1;        // of the reference surface to the tessellated one, here
	double normal_deviation = 0;  // between the micro-triangle and the reference surface, degrees
	double world_per_mesh = 1;    // the mean over the axes of the instance's scale
	double px_per_world = 0;      // at this distance from the eye

	double largest() const { return to_tessellated > to_reference ? to_tessellated : to_reference; }
	double largestPx() const { return largest() * world_per_mesh * px_per_world; }
	double px(double mesh_length) const { return mesh_length * world_per_mesh * px_per_world; }
};

// Pixels that a world unit covers, seen face-on, at a point given relative to the eye (world units). What is nearer than the near distance counts as
// if it were there.
double pxPerWorld(const View& view, dvec3 from_eye);
dvec3 eyeOf(const View& view);  // world units

// Both surfaces of a scene for one view. All that it is given must outlive it.
class SurfacePair
{
public:
	SurfacePair(const reference::HostScene& scene, const View& view, const ReferenceSurface& surface, const MicroScene& micro);

	// The spot at `share` (0..1) of the whole area (world units squared), and within its triangle at two numbers of 0..1.
	MicroSpot spotAt(double share, dvec2 within) const;

	// The spot that the camera sees at a place of the picture (pixels, from its top left); none where nothing is drawn.
	std::optional<MicroSpot> spotSeenAt(dvec2 pixel) const;

	// None where a position is not finite, or the micro-triangle has no area.
	std::optional<Sample> measure(const MicroSpot& spot) const;

	double area() const { return areas_.empty() ? 0 : areas_.back(); }
	const View& view() const { return view_; }

private:
	struct Corners
	{
		dvec3 a, b, c;
	};
	Corners cornersOf(const MicroSpot& spot) const;
	SurfaceSpot referenceSpot(const MicroSpot& spot, double& domain_area) const;

	const reference::HostScene& scene_;
	View view_;
	const ReferenceSurface& surface_;
	const MicroScene& micro_;
	dvec3 eye_;
	std::vector<TriangleSet> sets_;  // per instance
	std::vector<dmat4> placements_;  // per instance: mesh to world relative to the eye
	std::vector<double> world_per_mesh_;
	std::vector<uint64_t> first_triangle_;  // per instance, into areas_
	std::vector<double> areas_;             // per micro-triangle: area up to and with it
	std::unique_ptr<PlacedSets> placed_;
};

}  // namespace tessera::report
