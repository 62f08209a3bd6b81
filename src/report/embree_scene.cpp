#include "report/embree_scene.h"

#include "base/check.h"

#if TESSERA_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace tessera::report
{

namespace
{

// One for the process: devices hold threads. Lives as long as any scene does.
RTCDevice sharedDevice()
{
	static const RTCDevice device = [] {
		const RTCDevice created = rtcNewDevice(nullptr);
		CHECK(created != nullptr, "Embree: no device, error {}", static_cast<int>(rtcGetDeviceError(nullptr)));
		return created;
	}();
	return device;
}

// Embree searches in float: a ball that surely holds the one of radius r around q, given once rounded.
float searchRadius(double r, dvec3 q)
{
	const double magnitude = std::max({ std::abs(q.x), std::abs(q.y), std::abs(q.z) });
	return static_cast<float>(std::min(r * (1 + 1e-6) + magnitude * 1e-6 + 1e-30, double(std::numeric_limits<float>::max())));
}

}  // namespace

dvec2 nearestWeights(dvec3 q, dvec3 a, dvec3 b, dvec3 c)
{
	const dvec3 ab = b - a, ac = c - a, aq = q - a;
	const double d1 = glm::dot(ab, aq), d2 = glm::dot(ac, aq);
	if (d1 <= 0 && d2 <= 0)
		return { 1, 0 };
	const dvec3 bq = q - b;
	const double d3 = glm::dot(ab, bq), d4 = glm::dot(ac, bq);
	if (d3 >= 0 && d4 <= d3)
		return { 0, 1 };
	const double vc = d1 * d4 - d3 * d2;
	if (vc <= 0 && d1 >= 0 && d3 <= 0)
		return { 1 - d1 / (d1 - d3), d1 / (d1 - d3) };
	const dvec3 cq = q - c;
	const double d5 = glm::dot(ab, cq), d6 = glm::dot(ac, cq);
	if (d6 >= 0 && d5 <= d6)
		return { 0, 0 };
	const double vb = d5 * d2 - d1 * d6;
	if (vb <= 0 && d2 >= 0 && d6 <= 0)
		return { 1 - d2 / (d2 - d6), 0 };
	const double va = d3 * d6 - d5 * d4;
	if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
		return { 0, 1 - (d4 - d3) / ((d4 - d3) + (d5 - d6)) };
	const double sum = va + vb + vc;
	return { va / sum, vb / sum };
}

struct TriangleSet::Data
{
	std::vector<vec3> positions;  // Embree reads 4 bytes past the last: one more is held
	std::vector<uvec3> triangles;
	RTCScene scene = nullptr;

	~Data()
	{
		if (scene)
			rtcReleaseScene(scene);
	}

	NearestTriangle candidate(dvec3 q, uint32_t triangle) const
	{
		const uvec3 corners = triangles[triangle];
		const dvec3 a = positions[corners.x], b = positions[corners.y], c = positions[corners.z];
		const dvec2 w = nearestWeights(q, a, b, c);
		return { triangle, w, glm::length(a * w.x + b * w.y + c * (1 - w.x - w.y) - q) };
	}
};

TriangleSet::TriangleSet(std::span<const vec3> positions, std::span<const uvec3> triangles) : data_(std::make_unique<Data>())
{
	Data& data = *data_;
	data.positions.reserve(positions.size() + 1);
	data.positions.assign(positions.begin(), positions.end());
	data.positions.emplace_back(0);
	data.triangles.assign(triangles.begin(), triangles.end());

	const RTCDevice device = sharedDevice();
	data.scene = rtcNewScene(device);
	rtcSetSceneFlags(data.scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_COMPACT | RTC_SCENE_FLAG_ROBUST));
	const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
	rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, data.positions.data(), 0, sizeof(vec3), positions.size());
	rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, data.triangles.data(), 0, sizeof(uvec3), triangles.size());
	rtcCommitGeometry(geometry);
	rtcAttachGeometry(data.scene, geometry);
	rtcReleaseGeometry(geometry);
	rtcCommitScene(data.scene);
	const RTCError error = rtcGetDeviceError(device);
	CHECK(error == RTC_ERROR_NONE, "Embree: error {} on {} triangles", static_cast<int>(error), triangles.size());
}

TriangleSet::~TriangleSet() = default;
TriangleSet::TriangleSet(TriangleSet&&) noexcept = default;
TriangleSet& TriangleSet::operator=(TriangleSet&&) noexcept = default;

std::span<const vec3> TriangleSet::positions() const
{
	return { data_->positions.data(), data_->positions.size() - 1 };
}

std::span<const uvec3> TriangleSet::triangles() const
{
	return data_->triangles;
}

namespace
{

// What a point query looks for: the nearest triangle of the nearest groups.
struct Search
{
	const TriangleSet::Data& data;
	dvec3 q;
	double most;   // nothing farther counts
	double slack;  // beyond the nearest, for other groups
	std::span<const uint32_t> group_of;
	std::array<NearestTriangle, 4> found = {};
	size_t count = 0;

	uint32_t groupOf(uint32_t triangle) const { return group_of.empty() ? 0 : group_of[triangle]; }

	// How far a triangle may be and still matter.
	double reach() const { return count == 0 ? most : std::min(most, found[0].distance + slack); }

	void add(const NearestTriangle& candidate)
	{
		if (!(candidate.distance <= reach()))
			return;
		size_t place = 0;
		while (place < count && groupOf(found[place].triangle) != groupOf(candidate.triangle))
			++place;
		if (place == found.size())
			place = found.size() - 1;  // all taken: the farthest goes
		if (place < count && found[place].distance <= candidate.distance)
			return;
		found[place] = candidate;
		count = std::max(count, place + 1);
		for (; place > 0 && found[place].distance < found[place - 1].distance; --place)
			std::swap(found[place], found[place - 1]);
		while (count > 1 && found[count - 1].distance > reach())
			--count;
	}

	static bool visit(RTCPointQueryFunctionArguments* args)
	{
		Search& search = *static_cast<Search*>(args->userPtr);
		const double before = search.reach();
		search.add(search.data.candidate(search.q, args->primID));
		if (search.reach() >= before)
			return false;
		args->query->radius = searchRadius(search.reach(), search.q);
		return true;
	}

	void run()
	{
		RTCPointQuery query = {};
		const vec3 rounded = q;
		query.x = rounded.x, query.y = rounded.y, query.z = rounded.z;
		query.radius = searchRadius(most, q);
		RTCPointQueryContext context;
		rtcInitPointQueryContext(&context);
		rtcPointQuery(data.scene, &query, &context, visit, this);
	}
};

}  // namespace

std::optional<NearestTriangle> TriangleSet::nearest(dvec3 q, double most) const
{
	Search search = { *data_, q, most, 0, {} };
	search.run();
	return search.count > 0 ? std::optional(search.found[0]) : std::nullopt;
}

std::vector<NearestTriangle> TriangleSet::nearestOfGroups(dvec3 q, double slack, std::span<const uint32_t> group_of) const
{
	Search search = { *data_, q, std::numeric_limits<double>::infinity(), slack, group_of };
	search.run();
	return { search.found.begin(), search.found.begin() + static_cast<ptrdiff_t>(search.count) };
}

struct PlacedSets::Data
{
	RTCScene scene = nullptr;
	~Data() { rtcReleaseScene(scene); }
};

PlacedSets::PlacedSets(std::span<const TriangleSet> sets, std::span<const dmat4> placements) : data_(std::make_unique<Data>())
{
	const RTCDevice device = sharedDevice();
	data_->scene = rtcNewScene(device);
	rtcSetSceneFlags(data_->scene, RTC_SCENE_FLAG_ROBUST);
	for (size_t i = 0; i < sets.size(); ++i)
	{
		const RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
		rtcSetGeometryInstancedScene(instance, sets[i].data().scene);
		float columns[16];
		for (int k = 0; k < 16; ++k)
			columns[k] = static_cast<float>(placements[i][k / 4][k % 4]);
		rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, columns);
		rtcCommitGeometry(instance);
		rtcAttachGeometryByID(data_->scene, instance, static_cast<unsigned>(i));
		rtcReleaseGeometry(instance);
	}
	rtcCommitScene(data_->scene);
	const RTCError error = rtcGetDeviceError(device);
	CHECK(error == RTC_ERROR_NONE, "Embree: error {} on {} instances", static_cast<int>(error), sets.size());
}

PlacedSets::~PlacedSets() = default;

std::optional<RayHit> PlacedSets::firstHit(dvec3 origin, dvec3 direction, double nearest, const std::function<bool(const RayHit&)>& accepts) const
{
	constexpr int kMostLayers = 64;  // of triangles that are not accepted
	RTCRayHit ray = {};
	const vec3 o = origin, d = direction;
	float from = static_cast<float>(nearest);
	for (int layer = 0; layer < kMostLayers; ++layer)
	{
		ray.ray = {};
		ray.ray.org_x = o.x, ray.ray.org_y = o.y, ray.ray.org_z = o.z;
		ray.ray.dir_x = d.x, ray.ray.dir_y = d.y, ray.ray.dir_z = d.z;
		ray.ray.tnear = from;
		ray.ray.tfar = std::numeric_limits<float>::infinity();
		ray.ray.mask = ~0u;
		ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if TESSERA_EMBREE_MAJOR >= 4
		rtcIntersect1(data_->scene, &ray);
#else
		RTCIntersectContext context;
		rtcInitIntersectContext(&context);
		rtcIntersect1(data_->scene, &context, &ray);
#endif
		if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
			return std::nullopt;
		// Embree's u and v belong to the second and third corner.
		const dvec2 weights(1 - double(ray.hit.u) - double(ray.hit.v), ray.hit.u);
		const RayHit hit = { ray.hit.instID[0], ray.hit.primID, weights, double(ray.ray.tfar) };
		if (accepts(hit))
			return hit;
		from = std::nextafter(ray.ray.tfar * (1 + 1e-6f), std::numeric_limits<float>::infinity());
	}
	return std::nullopt;
}

}  // namespace tessera::report
