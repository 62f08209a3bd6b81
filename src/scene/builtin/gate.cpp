// The bricks scene: a gate in a wall, two columns, and a yard of cobblestones.
#include "scene/builtin/bricks.h"
#include "scene/builtin/noise.h"
#include "scene/builtin/parts.h"
#include "scene/builtin/scenes.h"

#include <algorithm>
#include <cmath>

namespace tessera::builtin
{

// Outline of the gate, in mesh units (sums of powers of two, so that steps between them are exact). The wall is as wide to each side as it is high
// above the arch's springing, so that a ray at 45 degrees from the arch's centre meets the corner.
static constexpr double kOpening = 0.8125;  // radius of the opening
static constexpr double kArch = 1.125;      // outer radius of the arch
static constexpr double kSpring = 1.5;      // height at which the arch begins
static constexpr double kHalfWidth = 2.0;
static constexpr double kHalfDepth = 0.25;
static constexpr uint32_t kArcSteps = 24;  // divisible by 4
static constexpr uint32_t kPierSteps = 6;  // across a pier, from the arch outward
static constexpr uint32_t kRiseSteps = 9;  // up a pier
static constexpr uint32_t kDepthSteps = 4;
static constexpr double kTile = 1.5;  // mesh units per tile of the brick map: bricks of 0.25 x 0.083

// Rounds to a multiple of 2^-20: parts of the outline that are computed in two ways become equal to the bit.
static double snapped(double x)
{
	return double(int64_t(x * 1048576.0 + (x < 0 ? -0.5 : 0.5))) / 1048576.0;
}

static dvec2 snapped(dvec2 p)
{
	return { snapped(p.x), snapped(p.y) };
}

// Point k of kArcSteps on a half circle around the arch's centre, from the right (+x) over the top to the left.
static dvec2 arcPoint(uint32_t k, double radius)
{
	const double turns = 0.5 * double(k) / kArcSteps;
	return snapped(dvec2(radius * cosineOfTurns(turns), kSpring + radius * sineOfTurns(turns)));
}

// Where the ray from the arch's centre through arc point k leaves the wall.
static dvec2 rimPoint(uint32_t k)
{
	const double turns = 0.5 * double(k) / kArcSteps;
	const double s = sineOfTurns(turns), c = cosineOfTurns(turns);
	const double larger = std::max(s, c < 0 ? -c : c);
	return snapped(dvec2(kHalfWidth * c / larger, kSpring + kHalfWidth * s / larger));
}

// Adds (nx + 1) x (ny + 1) vertices and the triangles between them; x to the right and y upward as seen from the front.
template <typename VertexAt>
static void addPatch(Primitive& primitive, uint32_t nx, uint32_t ny, const VertexAt& vertex_at)
{
	const uint32_t first = uint32_t(primitive.positions.size());
	for (uint32_t j = 0; j <= ny; ++j)
		for (uint32_t i = 0; i <= nx; ++i)
		{
			const auto [position, normal, uv] = vertex_at(i, j);
			primitive.positions.push_back(vec3(position) + vec3(0));
			primitive.normals.push_back(vec3(normal) + vec3(0));
			primitive.texcoords[0].push_back(vec2(uv) + vec2(0));
		}
	for (uint32_t j = 0; j < ny; ++j)
		for (uint32_t i = 0; i < nx; ++i)
		{
			const uint32_t a = first + j * (nx + 1) + i, b = a + 1, c = a + nx + 2, d = a + nx + 1;
			primitive.indices.insert(primitive.indices.end(), { a, b, c });
			// At the tip of a column the far side is one point.
			if (primitive.positions[c] != primitive.positions[d])
				primitive.indices.insert(primitive.indices.end(), { a, c, d });
		}
}

struct PatchVertex
{
	dvec3 position, normal;
	dvec2 uv;
};

// Adds a patch of the wall to the front and, mirrored through the middle plane, to the back. point(i, j) is in the wall's plane.
template <typename PointAt, typename UvAt>
static void addFrontAndBack(Primitive& wall, uint32_t nx, uint32_t ny, const PointAt& point, const UvAt& uv)
{
	addPatch(wall, nx, ny, [&](uint32_t i, uint32_t j) { return PatchVertex{ dvec3(point(i, j), kHalfDepth), { 0, 0, 1 }, uv(i, j) }; });
	addPatch(wall, nx, ny, [&](uint32_t i, uint32_t j) {
		return PatchVertex{ dvec3(point(nx - i, j), -kHalfDepth), { 0, 0, -1 }, uv(nx - i, j) * dvec2(-1, 1) };
	});
}

static dvec2 wallUv(dvec2 p)
{
	return dvec2(p.x, -p.y) / kTile;
}

// The k-th of n points from a to b.
static dvec2 between(dvec2 a, dvec2 b, uint32_t k, uint32_t n)
{
	return snapped(a + (b - a) * (double(k) / double(n)));
}

static void addFaces(Primitive& wall)
{
	// Piers: outside the arch's width, and under the arch.
	const auto addPier = [&](double left, double right, uint32_t steps) {
		const auto point = [=](uint32_t i, uint32_t j) {
			const double x = between({ left, 0 }, { right, 0 }, i, steps).x;
			return dvec2(x, between({ 0, 0 }, { 0, kSpring }, j, kRiseSteps).y);
		};
		addFrontAndBack(wall, steps, kRiseSteps, point, [&](uint32_t i, uint32_t j) { return wallUv(point(i, j)); });
	};
	addPier(-kHalfWidth, -kArch, kPierSteps);
	addPier(-kArch, -kOpening, 2);
	addPier(kOpening, kArch, 2);
	addPier(kArch, kHalfWidth, kPierSteps);

	// The arch: bricks stand on end, so u runs outward through one brick and v along the arc.
	const double brick = 1.0 / kBricksAcross;
	addFrontAndBack(
		wall, kArcSteps, 2, [&](uint32_t i, uint32_t j) { return between(arcPoint(kArcSteps - i, kOpening), arcPoint(kArcSteps - i, kArch), j, 2); },
		[&](uint32_t i, uint32_t j) { return dvec2(0.5 * j * brick, 2.0 * i / kArcSteps); });

	// From the arch to the rim of the wall.
	const auto spandrel = [](uint32_t i, uint32_t j) {
		return between(arcPoint(kArcSteps - i, kArch), rimPoint(kArcSteps - i), j, kPierSteps);
	};
	addFrontAndBack(wall, kArcSteps, kPierSteps, spandrel, [&](uint32_t i, uint32_t j) { return wallUv(spandrel(i, j)); });
}

// Adds the strip between front and back along a path whose right side is outside; u runs through the wall, v along the path, or the other
// way round where the path is level.
static void addEdgeStrip(Primitive& wall, const std::vector<dvec2>& path, bool level, bool smooth)
{
	const auto normalOf = [&](size_t a, size_t b) {
		const dvec2 way = path[b] - path[a];
		return glm::normalize(dvec3(way.y, -way.x, 0));
	};
	std::vector<double> lengths = { 0 };
	for (size_t i = 1; i < path.size(); ++i)
		lengths.push_back(lengths.back() + glm::length(path[i] - path[i - 1]));
	const uint32_t steps = uint32_t(path.size() - 1);
	addPatch(wall, steps, kDepthSteps, [&](uint32_t i, uint32_t j) {
		const double z = kHalfDepth * (2.0 * j / kDepthSteps - 1);
		const bool inside = i > 0 && i < steps;
		const dvec3 radial = glm::normalize(dvec3(dvec2(0, kSpring) - path[i], 0));
		const dvec3 normal = smooth ? radial : normalOf(inside ? i - 1 : (i == 0 ? 0 : i - 1), inside ? i + 1 : (i == 0 ? 1 : i));
		const dvec2 uv = dvec2(z + kHalfDepth, lengths[i]) / kTile;
		return PatchVertex{ dvec3(path[i], z), normal, level ? dvec2(uv.y, uv.x) : uv };
	});
}

static void addEdges(Primitive& wall)
{
	const auto addLine = [&](dvec2 a, dvec2 b, uint32_t steps, bool level) {
		std::vector<dvec2> path;
		for (uint32_t k = 0; k <= steps; ++k)
			path.push_back(between(a, b, k, steps));
		addEdgeStrip(wall, path, level, false);
	};
	const auto addRim = [&](uint32_t first, uint32_t last, bool level) {
		std::vector<dvec2> path;
		for (uint32_t k = first; k <= last; ++k)
			path.push_back(rimPoint(k));
		addEdgeStrip(wall, path, level, false);
	};
	addLine({ kOpening, 0 }, { kArch, 0 }, 2, true);
	addLine({ kArch, 0 }, { kHalfWidth, 0 }, kPierSteps, true);
	addLine({ kHalfWidth, 0 }, { kHalfWidth, kSpring }, kRiseSteps, false);
	addRim(0, kArcSteps / 4, false);
	addRim(kArcSteps / 4, 3 * kArcSteps / 4, true);
	addRim(3 * kArcSteps / 4, kArcSteps, false);
	addLine({ -kHalfWidth, kSpring }, { -kHalfWidth, 0 }, kRiseSteps, false);
	addLine({ -kHalfWidth, 0 }, { -kArch, 0 }, kPierSteps, true);
	addLine({ -kArch, 0 }, { -kOpening, 0 }, 2, true);
	addLine({ -kOpening, 0 }, { -kOpening, kSpring }, kRiseSteps, false);
	std::vector<dvec2> arc;
	for (uint32_t k = 0; k <= kArcSteps; ++k)
		arc.push_back(arcPoint(kArcSteps - k, kOpening));
	addEdgeStrip(wall, arc, false, true);
	addLine({ kOpening, kSpring }, { kOpening, 0 }, kRiseSteps, false);
}

// A round column turned from (radius, height) points, from the foot up; the map goes once around.
static Primitive makeColumn()
{
	static constexpr dvec2 kProfile[] = { { 0.24, 0 },    { 0.24, 0.25 }, { 0.24, 0.5 },  { 0.24, 0.75 }, { 0.24, 1.0 },
										  { 0.24, 1.25 }, { 0.24, 1.5 },  { 0.24, 1.75 }, { 0.32, 1.83 }, { 0.36, 1.92 },
										  { 0.36, 2.0 },  { 0.30, 2.1 },  { 0.16, 2.2 },  { 0, 2.25 } };
	constexpr uint32_t kSteps = 16, kLast = uint32_t(std::size(kProfile) - 1);
	Primitive column;
	column.texcoords.resize(1);
	double length = 0;
	addPatch(column, kSteps, kLast, [&](uint32_t i, uint32_t j) {
		const dvec2 at = kProfile[j], below = kProfile[j > 0 ? j - 1 : 0], above = kProfile[j < kLast ? j + 1 : kLast];
		if (i == 0)
			length += glm::length(at - below);
		const double s = sineOfTurns(double(i % kSteps) / kSteps), c = cosineOfTurns(double(i % kSteps) / kSteps);
		const dvec2 out = at.x > 0 ? glm::normalize(dvec2(above.y - below.y, below.x - above.x)) : dvec2(0, 1);
		return PatchVertex{ { at.x * s, at.y, at.x * c }, { out.x * s, out.y, out.x * c }, { double(i) / kSteps, -length / kTile } };
	});
	return column;
}

ImportedScene makeBricks(uint32_t)
{
	ImportedScene scene;
	const uint32_t bricks = addBrickMaterial(scene, 2048, 0.030f, -0.022f);
	const uint32_t cobbles = addCobbleMaterial(scene, 1024, 0.085f, -0.060f);

	Primitive wall;
	wall.texcoords.resize(1);
	addFaces(wall);
	addEdges(wall);
	wall.material = bricks;
	scene.instances.push_back({ addMesh(scene, "gate", { std::move(wall) }), dmat4(1) });

	Primitive column = makeColumn();
	column.material = bricks;
	const uint32_t column_mesh = addMesh(scene, "column", { std::move(column) });
	for (const double x : { -1.55, 1.55 })
	{
		dmat4 world(1);
		world[3] = dvec4(x, 0, 0.95, 1);
		scene.instances.push_back({ column_mesh, world });
	}

	Primitive yard;
	addGrid(yard, { -6, 0, 6 }, { 12, 0, 0 }, { 0, 0, -12 }, 24, 24, { 0, 6 }, { 6, 0 });
	yard.material = cobbles;
	scene.instances.push_back({ addMesh(scene, "yard", { std::move(yard) }), dmat4(1) });
	scene.cameras.push_back(lookAtCamera({ -2.6, 1.75, 5.9 }, { -0.05, 1.55, 0 }, 42));
	return scene;
}

}  // namespace tessera::builtin
