// Very small, very large, very far: positions, instances and matrices.
#include "verify/suite/case.h"
#include "verify/suite/parts.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace tessera::verify
{

namespace
{

dmat4 scaled(dvec3 scale, dvec3 at = dvec3(0))
{
	return glm::scale(glm::translate(dmat4(1), at), scale);
}

ImportedScene placed(ImportedScene scene, std::initializer_list<dmat4> worlds)
{
	scene.instances.clear();
	for (const dmat4& world : worlds)
		scene.instances.push_back({ 0, world });
	return scene;
}

// Three sizes side by side, each seen from two of its own diameters.
std::vector<NamedCamera> besideEach(const BuiltScene& scene)
{
	std::vector<NamedCamera> cameras;
	for (const Instance& instance : scene.instances)
	{
		const dvec3 at = dvec3(instance.world[3]);
		const double size = glm::length(dvec3(instance.world[0]));
		cameras.push_back({ fmt::format("beside {:g}", size), parts::lookingAt(at + dvec3(1.5, 1, 3) * size, at, 50, size * 1e-3) });
	}
	return cameras;
}

// Two triangles of 10 km, from one metre above a corner: the nearest segments are pixels, the farthest kilometres.
ImportedScene tenKilometres()
{
	ImportedScene scene;
	Primitive quad;
	builtin::addGrid(quad, { 0, 0, 0 }, { 1e4f, 0, 0 }, { 0, 0, -1e4f }, 1, 1, { 0, 0 }, { 1000, 1000 });
	quad.material = parts::addDisplaced(scene, parts::noise(64, 64, TexelFormat::U8, 3), 0.05f);
	parts::addPlaced(scene, std::move(quad));
	return scene;
}

std::vector<NamedCamera> oneMetreAbove(const BuiltScene&)
{
	return { { "above a corner", parts::lookingAt({ 0.1, 1, -0.1 }, { 2, 0, -2 }, 60, 1e-2) },
			 { "above the middle", parts::lookingAt({ 5000, 1, -5000 }, { 5002, 0, -5002 }, 60, 1e-2) },
			 { "along an edge", parts::lookingAt({ -1, 1, 0 }, { 5000, 0, 0 }, 20, 1e-2) } };
}

std::string reachesFarDown(const CaseRun& run)
{
	uint64_t most = 0;
	for (const FrameLine& frame : run.report.frames)
		most = std::max(most, frame.micro_triangles);
	return most > 3000 ? "" : fmt::format("only {} micro-triangles: the quad was not split as its distance asks for", most);
}

void addSizes(std::vector<Case>& cases)
{
	for (const float size : { 1e-6f, 1e-3f, 1e3f, 1e6f })
	{
		Case one = { "scale", fmt::format("size_{:g}", size), fmt::format("a displaced ball of radius {:g}", size) };
		one.scene = [size] {
			return parts::ball(2, size, 0.1f * size);
		};
		one.cameras = [size](const BuiltScene& scene) {
			std::vector<NamedCamera> cameras = randomCameras(scene, 11, 6);
			for (NamedCamera& camera : cameras)
				camera.camera.near_world = double(size) * 1e-3;
			return cameras;
		};
		one.quick = size == 1e-6f || size == 1e6f;
		cases.push_back(std::move(one));
	}
	Case node = { "scale", "node_1e-6", "the same ball, made a millionth of its size by its node" };
	node.scene = [] {
		return placed(parts::ball(2), { scaled(dvec3(1e-6)) });
	};
	node.cameras = besideEach;
	cases.push_back(node);
}

constexpr dvec3 kFar = { 1e7, -1e7, 1e7 };

// What a camera sees of a scene, `at` from the origin as the scene is.
Result<Capture> seenFrom(const SuiteDevice& suite, const Case& one, const BuiltScene& scene, Camera camera, dvec3 at)
{
	const reference::HostScene truth(scene, suite.table, one.options.metric);
	RenderOptions options = one.options;
	options.rate = one.rates.front();
	options.width_px = one.width_px;
	options.height_px = one.height_px;
	options.raster = suite.paths.front();
	TRY_ASSIGN(const auto source, FrameSource::create(suite.device, truth, scene, suite.table, options, false, {}, suite.seed));
	camera.eye += at;
	camera.target += at;
	return source->capture(camera, options.rate);
}

// Does the model far away look as it does at the origin? The share of pixels that see something else.
Result<Measured> compareWithOrigin(const SuiteDevice& suite, const Case& one, const BuiltScene& far)
{
	BuiltScene near = far;
	near.instances[0].world = dmat4(1);
	near.world_low -= kFar;
	near.world_high -= kFar;
	Measured measured;
	for (const NamedCamera& camera : randomCameras(near, suite.seed, 6))
	{
		TRY_ASSIGN(const Capture here, seenFrom(suite, one, near, camera.camera, dvec3(0)));
		TRY_ASSIGN(const Capture there, seenFrom(suite, one, far, camera.camera, kFar));
		uint64_t differing = 0;
		for (size_t i = 0; i < here.visible.pixels.size(); ++i)
			differing += here.visible.pixels[i].identity != there.visible.pixels[i].identity;
		measured.checks += 2;
		measured.worst = std::max(measured.worst, double(differing) / double(here.visible.pixels.size()));
		const auto a = double(here.result.counts.micro_triangles), b = double(there.result.counts.micro_triangles);
		if (std::abs(a - b) <= 1e-3 * a)
			continue;
		++measured.violations;
		measured.what = fmt::format("camera {}: {} micro-triangles at the origin, {} far from it", camera.name, a, b);
	}
	return measured;
}

void addDistances(std::vector<Case>& cases)
{
	Case far = { "scale", "far_1e7", "a ball of radius 1 that its node puts 1e7 units from the origin, with cameras beside it" };
	far.scene = [] {
		return placed(parts::ball(2), { scaled(dvec3(1), kFar) });
	};
	far.expected = within("error, pixels", 0.01);
	cases.push_back(far);

	Case same = far;
	same.name = "far_1e7_as_at_origin";
	same.what = "the same, compared with the model at the origin: counts within 0.1 %";
	same.expected = within("share of pixels that see something else", 0.005);
	same.measure = compareWithOrigin;
	cases.push_back(same);

	Case baked = { "scale", "far_1e7_baked", "a ball of radius 1000 whose positions themselves lie 1e7 units from the origin" };
	baked.scene = [] {
		return parts::ball(2, 1000, 100, vec3(1e7f, 0, -1e7f));
	};
	// A unit in the last place is 1 there, a thousandth of the radius: what float positions can say.
	baked.expected = within("error, ulp of the largest coordinate", 2);
	cases.push_back(baked);
}

void addMatrices(std::vector<Case>& cases)
{
	Case sizes = { "scale", "instances_1000_to_1", "instances of one mesh at scales 1000, 1 and 0.001" };
	sizes.scene = [] {
		return placed(parts::ball(2), { scaled(dvec3(1000), dvec3(3000, 0, 0)), scaled(dvec3(1)), scaled(dvec3(1e-3), dvec3(-2, 0, 0)) });
	};
	sizes.cameras = besideEach;
	cases.push_back(sizes);

	Case stretched = { "scale", "stretched_1000_to_1", "axes scaled by 1000, 1 and 0.001" };
	stretched.scene = [] {
		return placed(parts::ball(2), { scaled(dvec3(1000, 1, 1e-3)) });
	};
	cases.push_back(stretched);

	Case mirrored = { "scale", "mirrored", "instances mirrored in one axis and in all three, and sheared" };
	mirrored.scene = [] {
		dmat4 sheared = scaled(dvec3(1, 2, -1), dvec3(0, 4, 0));
		sheared[1] += dvec4(0.8, 0, 0.2, 0);
		return placed(parts::ball(2), { scaled(dvec3(-1, 1, 1)), scaled(dvec3(-1), dvec3(3, 0, 0)), sheared });
	};
	cases.push_back(mirrored);

	Case singular = { "scale", "singular", "instances flattened to a disc, to a line, to a point and nearly to a point, beside a whole one" };
	singular.scene = [] {
		return placed(parts::ball(2), { scaled(dvec3(1, 0, 1)), scaled(dvec3(1, 0, 0), dvec3(3, 0, 0)), scaled(dvec3(0), dvec3(-3, 0, 0)),
										scaled(dvec3(1), dvec3(0, 3, 0)) });
	};
	cases.push_back(singular);
}

void addLongQuad(std::vector<Case>& cases)
{
	Case quad = { "scale", "ten_kilometres", "one quad of 10 km from 1 m: an edge is 4e5 segments of the nearest size, as deep as splitting goes" };
	quad.scene = tenKilometres;
	quad.cameras = oneMetreAbove;
	quad.rates = { 4 };
	quad.also = reachesFarDown;
	cases.push_back(quad);

	Case deepest = quad;
	deepest.name = "ten_kilometres_by_halves";
	deepest.what = "the same with two pieces per split, the deepest recursion there is";
	deepest.options.max_split = 2;
	deepest.quick = false;
	cases.push_back(deepest);
}

}  // namespace

void addScaleCases(std::vector<Case>& cases)
{
	addSizes(cases);
	addDistances(cases);
	addMatrices(cases);
	addLongQuad(cases);
}

}  // namespace tessera::verify
