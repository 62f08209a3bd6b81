// Triangles and attributes at odds: slivers, degenerate, non-manifold, wrongly wound, without normals or coordinates.
#include "verify/suite/case.h"
#include "verify/suite/parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::verify
{

namespace
{

constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

Primitive& onlyPrimitive(ImportedScene& scene)
{
	return scene.meshes[0].primitives[0];
}

uint32_t addVertex(Primitive& primitive, vec3 position, vec3 normal, vec2 uv)
{
	primitive.texcoords.resize(1);
	primitive.positions.push_back(position);
	primitive.normals.push_back(normal);
	primitive.texcoords[0].push_back(uv);
	return uint32_t(primitive.positions.size() - 1);
}

void addTriangle(Primitive& primitive, uint32_t a, uint32_t b, uint32_t c)
{
	primitive.indices.insert(primitive.indices.end(), { a, b, c });
}

ImportedScene displacedMesh(const std::function<void(Primitive&)>& fill)
{
	ImportedScene scene;
	Primitive primitive;
	fill(primitive);
	primitive.material = parts::addDisplaced(scene, parts::noise(16, 16, TexelFormat::U8, 2), 0.05f);
	scene.materials[primitive.material].double_sided = true;
	parts::addPlaced(scene, std::move(primitive));
	return scene;
}

// Strips of triangles a millionth as wide as long, side by side.
ImportedScene slivers()
{
	return displacedMesh([](Primitive& p) {
		for (int strip = 0; strip < 8; ++strip)
			for (int end = 0; end < 2; ++end)
				addVertex(p, vec3(float(end) * 2 - 1, float(strip) * 2e-6f, 0.1f * float(strip % 2)), vec3(0, 0, 1), vec2(end, float(strip) / 8));
		for (uint32_t strip = 0; strip < 7; ++strip)
		{
			addTriangle(p, 2 * strip, 2 * strip + 1, 2 * strip + 2);
			addTriangle(p, 2 * strip + 2, 2 * strip + 1, 2 * strip + 3);
		}
	});
}

// A sheet with triangles of no area (a corner twice, all corners alike, corners in line) and some triangles twice.
ImportedScene degenerate()
{
	ImportedScene scene = parts::sheet(3, 3);
	Primitive& p = onlyPrimitive(scene);
	addTriangle(p, 0, 0, 1);
	addTriangle(p, 2, 2, 2);
	addTriangle(p, 0, 1, 2);
	for (int i = 0; i < 12; ++i)
		p.indices.push_back(p.indices[size_t(i)]);
	return scene;
}

// Two rows of quads, one twice as fine: every second vertex lies on the middle of the neighbour's edge.
ImportedScene tJunctions()
{
	ImportedScene scene;
	Primitive quads;
	builtin::addGrid(quads, { -1, 0, 0 }, { 2, 0, 0 }, { 0, 1, 0 }, 2, 1, { 0, 0.5f }, { 1, 0 });
	builtin::addGrid(quads, { -1, -1, 0 }, { 2, 0, 0 }, { 0, 1, 0 }, 4, 2, { 0, 1 }, { 1, 0.5f });
	quads.material = parts::addDisplaced(scene, parts::noise(16, 16, TexelFormat::U8, 5), 0.1f);
	parts::addPlaced(scene, std::move(quads));
	return scene;
}

// Five sheets on one edge, and two that touch in a point only.
ImportedScene nonManifold()
{
	return displacedMesh([](Primitive& p) {
		for (int fin = 0; fin < 5; ++fin)
		{
			const float angle = 1.2566371f * float(fin);
			const vec3 out(std::cos(angle), std::sin(angle), 0), normal(-std::sin(angle), std::cos(angle), 0);
			const uint32_t low = addVertex(p, vec3(0), normal, { 0.1f * float(fin), 0 }), high = addVertex(p, vec3(0, 0, 1), normal, { 0.2f, 1 });
			const uint32_t far = addVertex(p, out + vec3(0, 0, 0.5f), normal, { 1, 0.3f * float(fin) });
			if (fin % 2)
				addTriangle(p, low, far, high);
			else
				addTriangle(p, high, far, low);
		}
		const uint32_t tip = addVertex(p, vec3(2, 0, 0), vec3(0, 0, 1), vec2(0.5f));
		for (int i = 0; i < 2; ++i)
		{
			const float side = i ? 1.0f : -1.0f;
			const uint32_t a = addVertex(p, vec3(2 + side, -0.5f, 0), vec3(0, 0, 1), vec2(0)),
						   b = addVertex(p, vec3(2 + side, 0.5f, 0.2f), vec3(0, 0, 1), vec2(1));
			addTriangle(p, tip, i ? a : b, i ? b : a);
		}
	});
}

// A ball of which every third triangle is turned inside out.
ImportedScene wrongWinding()
{
	ImportedScene scene = parts::ball(2);
	Primitive& p = onlyPrimitive(scene);
	for (size_t i = 0; i + 2 < p.indices.size(); i += 9)
		std::swap(p.indices[i], p.indices[i + 1]);
	return scene;
}

// A closed cone whose tip, and whose bottom's middle, are corners of `spokes` triangles.
ImportedScene hub(uint32_t spokes)
{
	ImportedScene scene;
	Primitive p;
	const uint32_t tip = addVertex(p, { 0, 1, 0 }, { 0, 1, 0 }, { 0.5f, 0.5f }), bottom = addVertex(p, { 0, -0.2f, 0 }, { 0, -1, 0 }, { 0.5f, 0.5f });
	for (uint32_t i = 0; i < spokes; ++i)
	{
		const double angle = 6.283185307179586 * i / spokes;
		const vec3 out(float(std::cos(angle)), 0, float(std::sin(angle)));
		addVertex(p, out, out, vec2(0.5f) + 0.5f * vec2(out.x, out.z));
	}
	for (uint32_t i = 0; i < spokes; ++i)
	{
		const uint32_t a = 2 + i, b = 2 + (i + 1) % spokes;
		addTriangle(p, tip, b, a);
		addTriangle(p, bottom, a, b);
	}
	p.material = parts::addDisplaced(scene, parts::noise(16, 16, TexelFormat::U8, 6), 0.02f);
	parts::addPlaced(scene, std::move(p));
	return scene;
}

ImportedScene withCoordinates(const std::function<vec2(vec2)>& change)
{
	ImportedScene scene = parts::ball(2);
	for (vec2& uv : onlyPrimitive(scene).texcoords[0])
		uv = change(uv);
	return scene;
}

ImportedScene withNormals(vec3 normal)
{
	ImportedScene scene = parts::ball(2);
	for (size_t i = 0; i < onlyPrimitive(scene).normals.size(); i += 3)
		onlyPrimitive(scene).normals[i] = normal;
	return scene;
}

// Both sides of a sheet in one mesh, with opposite normals: directions cancel out.
ImportedScene cancelling()
{
	ImportedScene scene;
	Primitive quads;
	builtin::addGrid(quads, { -1, -1, 0 }, { 2, 0, 0 }, { 0, 2, 0 }, 2, 2, { 0, 1 }, { 1, 0 });
	builtin::addGrid(quads, { -1, 1, 0 }, { 2, 0, 0 }, { 0, -2, 0 }, 2, 2, { 0, 1 }, { 1, 0 });
	quads.material = parts::addDisplaced(scene, parts::noise(16, 16, TexelFormat::U8, 7), 0.1f);
	parts::addPlaced(scene, std::move(quads));
	return scene;
}

ImportedScene withOnePosition(float value)
{
	ImportedScene scene = parts::ball(2);
	onlyPrimitive(scene).positions[5].y = value;
	return scene;
}

std::string warns(const CaseRun& run, std::string_view text)
{
	for (const std::string& warning : run.scene.warnings)
		if (warning.find(text) != std::string::npos)
			return "";
	return fmt::format("no warning says '{}'", text);
}

Case drawn(std::string name, std::string what, std::function<ImportedScene()> scene)
{
	Case one = { "geometry", std::move(name), std::move(what) };
	one.scene = std::move(scene);
	return one;
}

void addShapes(std::vector<Case>& cases)
{
	cases.push_back(drawn("slivers_1e6", "triangles a millionth as wide as long", slivers));
	cases.push_back(drawn("degenerate", "triangles of no area, and some twice", degenerate));
	cases.push_back(drawn("t_junctions", "rows of quads that meet two to one", tJunctions));
	cases.push_back(drawn("non_manifold", "five sheets on an edge, two that touch in a point", nonManifold));
	cases.push_back(drawn("wrong_winding", "a ball with every third triangle inside out", wrongWinding));
	cases.push_back(drawn("cancelling_normals", "two sheets in one place, back to back: directions cancel out", cancelling));
	Case spokes = drawn("hub_10000", "a vertex that 10,000 triangles share", [] { return hub(10'000); });
	spokes.cameras = [](const BuiltScene& scene) {
		return std::vector<NamedCamera>{ { "framing", framingCamera(scene) },
										 { "at the hub", parts::lookingAt({ 0.05, 1.1, 0.05 }, { 0, 1, 0 }, 60) } };
	};
	spokes.rates = { 8 };
	cases.push_back(spokes);
}

void addPositions(std::vector<Case>& cases)
{
	for (const auto& [name, value] : { std::pair("nan_position", kNan), std::pair("infinite_position", kInfinity) })
	{
		Case one = drawn(name, "a position that is no number", [] { return withOnePosition(parts::kMarker); });
		one.damage = parts::replacing(parts::kMarker, value);
		one.expected = refused(ExitCode::BadInput, "is not finite");
		cases.push_back(one);
	}
	Case huge = drawn("position_1e30", "a position too far away for squares of floats", [] { return withOnePosition(1e30f); });
	huge.expected = refused(ExitCode::BadInput, "at most 2^60");
	cases.push_back(huge);
	Case large = drawn("size_1e17", "a displaced ball of radius 1e17", [] { return parts::ball(2, 1e17f, 1e16f); });
	cases.push_back(large);
	Case spike = drawn("vertex_1e12_away", "a ball of radius 1 with a vertex 1e12 away", [] { return withOnePosition(1e12f); });
	cases.push_back(spike);
	Case denormal =
		drawn("denormal_position", "a position below the smallest normal float, which counts as 0", [] { return withOnePosition(1e-40f); });
	cases.push_back(denormal);
}

void addAttributes(std::vector<Case>& cases)
{
	cases.push_back(drawn("zero_normals", "every third normal has no length", [] { return withNormals(vec3(0)); }));
	Case nan = drawn("nan_normals", "every third normal is no number", [] { return withNormals(vec3(parts::kMarker)); });
	nan.damage = parts::replacing(parts::kMarker, kNan);
	nan.also = [](const CaseRun& run) {
		return warns(run, "normals are not finite");
	};
	cases.push_back(nan);
	Case none = drawn("no_uvs", "a displaced material on a mesh without texture coordinates: drawn undisplaced, with a warning", [] {
		ImportedScene scene = parts::ball(2);
		onlyPrimitive(scene).texcoords.clear();
		return scene;
	});
	none.also = [](const CaseRun& run) {
		return warns(run, "TEXCOORD_0");
	};
	cases.push_back(none);
	cases.push_back(drawn("equal_uvs", "all texture coordinates are one", [] { return withCoordinates([](vec2) { return vec2(0.3f, 0.6f); }); }));
	cases.push_back(
		drawn("uvs_1e6", "texture coordinates at a million", [] { return withCoordinates([](vec2 uv) { return uv + vec2(1e6f, -1e6f); }); }));
	cases.push_back(
		drawn("uvs_1e30", "texture coordinates that no integer can hold", [] { return withCoordinates([](vec2 uv) { return uv * 1e30f; }); }));
	cases.push_back(drawn("mirrored_uvs", "texture coordinates that run backwards on every other vertex", [] {
		int i = 0;
		return withCoordinates([&i](vec2 uv) { return i++ % 2 ? vec2(1 - uv.x, uv.y) : uv; });
	}));
	Case broken = drawn("nan_uvs", "texture coordinates that are no numbers, which count as 0",
						[] { return withCoordinates([](vec2 uv) { return uv.x < 0.2f ? vec2(parts::kMarker) : uv; }); });
	broken.damage = parts::replacing(parts::kMarker, kNan);
	broken.also = [](const CaseRun& run) {
		return warns(run, "coordinates are not finite");
	};
	cases.push_back(broken);
}

}  // namespace

void addGeometryCases(std::vector<Case>& cases)
{
	addShapes(cases);
	addPositions(cases);
	addAttributes(cases);
}

}  // namespace tessera::verify
