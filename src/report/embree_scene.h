// Triangle meshes to ask for nearest points and for what a ray meets. Embree finds the candidates; distances are computed in double.
#pragma once
#include "base/vec.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tessera::report
{

// The point nearest to q on triangle abc, as weights of a and b; c has the rest. Source: Ericson, Real-Time Collision Detection,
// section 5.1.5. A triangle without area gives a point of it that may not be the nearest, but is not farther than its nearest corner.
dvec2 nearestWeights(dvec3 q, dvec3 a, dvec3 b, dvec3 c);

struct NearestTriangle
{
	uint32_t triangle = 0;
	dvec2 weights = dvec2(0);  // of its first two corners
	double distance = 0;       // exact but for the rounding of double
};

struct RayHit
{
	uint32_t mesh = 0;  // which of the placed meshes
	uint32_t triangle = 0;
	dvec2 weights = dvec2(0);  // of its first two corners
	double distance = 0;       // along the ray, in lengths of its direction
};

// One mesh. Copies what it needs; positions that are not finite make their triangles unseen.
class TriangleSet
{
public:
	TriangleSet(std::span<const vec3> positions, std::span<const uvec3> triangles);
	~TriangleSet();
	TriangleSet(TriangleSet&&) noexcept;
	TriangleSet& operator=(TriangleSet&&) noexcept;

	// The nearest triangle within `most`. May be called from several threads.
	std::optional<NearestTriangle> nearest(dvec3 q, double most) const;

	// As `nearest`; and the nearest triangles of up to three other groups (group_of[triangle]) that lie not much farther: within
	// `slack` of the nearest. The nearest comes first; none when the set is empty.
	std::vector<NearestTriangle> nearestOfGroups(dvec3 q, double slack, std::span<const uint32_t> group_of) const;

	std::span<const vec3> positions() const;
	std::span<const uvec3> triangles() const;

	struct Data;
	const Data& data() const { return *data_; }

private:
	std::unique_ptr<Data> data_;
};

// Meshes placed in a space of their own: instance i is set i by placements[i]. The sets must outlive it.
class PlacedSets
{
public:
	PlacedSets(std::span<const TriangleSet> sets, std::span<const dmat4> placements);
	~PlacedSets();
	PlacedSets(const PlacedSets&) = delete;
	PlacedSets& operator=(const PlacedSets&) = delete;

	// The first triangle that the ray meets at least `nearest` lengths of its direction away and that `accepts` takes. May be called
	// from several threads.
	std::optional<RayHit> firstHit(dvec3 origin, dvec3 direction, double nearest, const std::function<bool(const RayHit&)>& accepts) const;

private:
	struct Data;
	std::unique_ptr<Data> data_;
};

}  // namespace tessera::report
