// Rates, fields of view, eyes where they should not be, and pictures of every size.
#include "pipeline/passes.h"
#include "verify/suite/case.h"
#include "verify/suite/parts.h"

namespace tessera::verify
{

namespace
{

Case onBall(std::string name, std::string what)
{
	Case one = { "views", std::move(name), std::move(what) };
	one.scene = [] {
		return parts::ball(2);
	};
	return one;
}

std::function<std::vector<NamedCamera>(const BuiltScene&)> only(std::vector<NamedCamera> cameras)
{
	return [cameras = std::move(cameras)](const BuiltScene&) {
		return cameras;
	};
}

std::string everyFactorIsOne(const CaseRun& run)
{
	for (const FrameLine& frame : run.report.frames)
		if (frame.micro_triangles != run.scene.traits.instanced_triangles)
			return fmt::format("{} micro-triangles, not the {} of the scene", frame.micro_triangles, run.scene.traits.instanced_triangles);
	return "";
}

std::string isCoarsened(const CaseRun& run)
{
	for (const FrameLine& frame : run.report.frames)
		if (!(frame.rate_granted > frame.rate_wanted) && !frame.every_factor_one)
			return fmt::format("a rate of {} was granted where {} was wanted and cannot fit", frame.rate_granted, frame.rate_wanted);
	return "";
}

void addRates(std::vector<Case>& cases)
{
	Case fine = onBall("rate_0.001", "a thousand segments per pixel: coarsened until the lists hold it");
	fine.rates = { 1e-3f };
	fine.options.capacities = { { "part_triangles", 600 }, { "split_triangles", 400 } };
	fine.also = isCoarsened;
	cases.push_back(fine);
	Case coarse = onBall("rate_1e6", "a million pixels per segment: nothing is tessellated");
	coarse.rates = { 1e6f };
	coarse.also = everyFactorIsOne;
	cases.push_back(coarse);
	Case off = onBall("rate_0", "tessellation off");
	off.rates = { 0 };
	off.also = everyFactorIsOne;
	cases.push_back(off);
}

Camera orthographic(dvec3 eye, double height)
{
	Camera camera = parts::lookingAt(eye, dvec3(0), 60);
	camera.orthographic = true;
	camera.height_world = height;
	return camera;
}

void addProjections(std::vector<Case>& cases)
{
	Case fields = onBall("fields_of_view", "1 and 170 degrees, and the least and most there are: 0.01 and 179");
	std::vector<NamedCamera> cameras;
	for (const double fov : { 0.01, 1.0, 170.0, 179.0 })
		cameras.push_back({ fmt::format("{} degrees", fov), parts::lookingAt({ 0.4, 0.6, fov < 2 ? 30.0 : 1.6 }, { 0.1, 0.8, 0.2 }, fov) });
	fields.cameras = only(cameras);
	fields.options.capacities = { { "part_triangles", 3000 }, { "split_triangles", 2000 } };
	cases.push_back(fields);

	Case parallel = onBall("orthographic", "views of 0.01, 3 and 1000 units' height");
	parallel.cameras =
		only({ { "0.01", orthographic({ 1, 2, 3 }, 0.01) }, { "3", orthographic({ 1, 2, 3 }, 3) }, { "1000", orthographic({ 3, 1, 2 }, 1000) } });
	parallel.options.capacities = { { "part_triangles", 3000 }, { "split_triangles", 2000 } };
	cases.push_back(parallel);
}

// A vertex of the scene, in the world; of the first instance.
dvec3 vertexOf(const BuiltScene& scene, size_t index)
{
	return dvec3(scene.instances[0].world * dvec4(scene.positions[index % scene.positions.size()], 1));
}

void addEyes(std::vector<Case>& cases)
{
	Case on = onBall("eye_on_surface", "the eye on a vertex, on the middle of an edge and in the plane of a triangle");
	on.cameras = [](const BuiltScene& scene) {
		const dvec3 a = vertexOf(scene, 3), b = vertexOf(scene, 4), c = vertexOf(scene, 9);
		return std::vector<NamedCamera>{ { "on a vertex", parts::lookingAt(a, b, 60) },
										 { "on an edge", parts::lookingAt((a + b) / 2.0, dvec3(0), 60) },
										 { "in a triangle", parts::lookingAt((a + b + c) / 3.0, a, 60) },
										 { "a hair from a vertex", parts::lookingAt(a * (1 + 1e-7), dvec3(0), 60, 1e-9) } };
	};
	on.rates = { 8 };
	on.options.capacities = { { "part_triangles", 20000 }, { "split_triangles", 10000 } };
	cases.push_back(on);

	Case inside = onBall("eye_inside", "the eye inside a closed mesh, front faces away, and with both sides shown");
	inside.scene = [] {
		ImportedScene scene = parts::ball(2);
		scene.materials[0].double_sided = true;
		return scene;
	};
	inside.cameras = only({ { "middle", parts::lookingAt({ 0, 0, 0 }, { 1, 0.2, 0 }, 90) },
							{ "off the middle", parts::lookingAt({ 0.7, 0.1, 0.2 }, { 1, 0.1, 0.4 }, 120) },
							{ "wide", parts::lookingAt({ 0, 0.5, 0 }, { 0, -1, 0.1 }, 170) } });
	cases.push_back(inside);
}

void addNear(std::vector<Case>& cases)
{
	Case floor = { "views", "near_plane", "triangles through the near plane and behind the eye: a floor of two triangles that begins behind" };
	floor.scene = [] {
		ImportedScene scene = parts::sheet(1, 1, 0.05f);
		scene.instances[0].world = dmat4(dvec4(50, 0, 0, 0), dvec4(0, 0, -50, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 0, 1));
		return scene;
	};
	floor.cameras = only({ { "standing", parts::lookingAt({ 1, 0.5, 2 }, { 3, 0.3, -4 }, 60, 0.4) },
						   { "lying", parts::lookingAt({ 1, 0.06, 2 }, { 3, 0.05, -4 }, 100, 0.05) },
						   { "within", parts::lookingAt({ 1, 0.01, 2 }, { 3, 0, -4 }, 60, 1) } });
	cases.push_back(floor);
}

void addPictures(std::vector<Case>& cases)
{
	for (const auto& [width, height] : { std::pair(1u, 1u), std::pair(1u, 80u), std::pair(120u, 1u), std::pair(33u, 17u) })
	{
		Case one = onBall(fmt::format("picture_{}x{}", width, height), "a picture of odd sides");
		one.width_px = width;
		one.height_px = height;
		one.cameras = [](const BuiltScene& scene) {
			return randomCameras(scene, 5, 3);
		};
		cases.push_back(one);
	}
}

Result<uint32_t> coveredPixels(const SuiteDevice& suite, const BuiltScene& scene, uint32_t side, float rate, CullOptions cull)
{
	RenderOptions options;
	options.rate = rate;
	options.raster = suite.paths.front();
	options.cull = cull;
	options.width_px = options.height_px = side;
	TRY_ASSIGN(auto renderer, Renderer::create(suite.device, scene, suite.table, framePasses(), options));
	TRY_ASSIGN(const FrameResult frame, renderer->renderFrame(framingCamera(scene)));
	return frame.counts.covered_pixels;
}

// A picture too large to read back with what each pixel sees. Culling must not change how many pixels are covered, and they must be the part of
// the picture that a small one of the same micro-triangles covers, but for its fewer pixels along the outline.
Result<Measured> drawLargest(const SuiteDevice& suite, const Case&, const BuiltScene& scene)
{
	Measured measured;
	const uint32_t side = suite.device.limits.max_image_extent, small = 1024;
	const float rate = 64;
	const CullOptions uncut = { false, false, false };
	TRY_ASSIGN(const uint32_t all, coveredPixels(suite, scene, side, rate, uncut));
	TRY_ASSIGN(const uint32_t culled, coveredPixels(suite, scene, side, rate, {}));
	TRY_ASSIGN(const uint32_t in_small, coveredPixels(suite, scene, small, rate * float(small) / float(side), uncut));
	const auto judge = [&](bool holds, const std::string& what) {
		++measured.checks;
		if (holds)
			return;
		++measured.violations;
		measured.what = what;
	};
	judge(culled == all, fmt::format("{} pixels are covered with culling, {} without", culled, all));
	const double part = all / (double(side) * side), expected = in_small / (double(small) * small);
	judge(expected > 0.01 && std::abs(part / expected - 1) < 0.01,
		  fmt::format("{:.4f} of {} x {} pixels are covered, {:.4f} of {} x {}", part, side, side, expected, small, small));
	measured.worst = double(measured.violations);
	return measured;
}

void addLargest(std::vector<Case>& cases)
{
	for (const bool wide : { true, false })
	{
		Case strip = onBall(wide ? "picture_16384x2" : "picture_2x16384", "the longest picture that every device allows");
		strip.width_px = wide ? 16384 : 2;
		strip.height_px = wide ? 2 : 16384;
		strip.rates = { 64 };
		strip.cameras = [](const BuiltScene& scene) {
			return std::vector<NamedCamera>{ { "framing", framingCamera(scene) } };
		};
		cases.push_back(strip);
	}
	Case largest = onBall("picture_largest", "the largest picture that the device allows");
	largest.quick = false;
	largest.needs = { 40ull << 30, 16ull << 30, true };
	largest.expected = within("pixels that differ with culling", 0);
	largest.measure = drawLargest;
	cases.push_back(largest);
}

}  // namespace

void addViewCases(std::vector<Case>& cases)
{
	addRates(cases);
	addProjections(cases);
	addEyes(cases);
	addNear(cases);
	addPictures(cases);
	addLargest(cases);
}

}  // namespace tessera::verify
