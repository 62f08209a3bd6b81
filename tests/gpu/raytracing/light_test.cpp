// Shadows and ambient occlusion against what geometry says they must be.
#include "ray_test.h"

#include "pipeline/passes.h"

#include <numbers>

namespace tessera::test
{

namespace
{

using light = RayTest;

const dvec3 kSun(0.4867, 0.6489, 0.5849);  // shaders/lib/lighting.glsl

// A rectangle from `corner` along two sides; its front is where cross(along, across) points.
void addRectangle(ImportedScene& scene, dvec3 corner, dvec3 along, dvec3 across)
{
	if (scene.materials.empty())
		addPlain(scene, "plain");
	scene.materials[0].double_sided = true;
	Primitive primitive;
	primitive.material = 0;
	const vec3 normal = vec3(glm::normalize(glm::cross(along, across)));
	for (const dvec2 at : { dvec2(0, 0), dvec2(1, 0), dvec2(1, 1), dvec2(0, 1) })
		addVertex(primitive, vec3(corner + along * at.x + across * at.y), normal, vec2(at));
	addTriangle(primitive, 0, 1, 2);
	addTriangle(primitive, 0, 2, 3);
	addPlacedMesh(scene, { primitive });
}

struct Lit
{
	GpuFrame frame;
	std::vector<float> sun, ambient;
	std::vector<uint64_t> seen;  // 0: background
};

Lit lit(const GpuScene& scene, RenderOptions options, const Camera& camera)
{
	auto renderer = Renderer::create(gpu(), scene.built, scene.table, framePasses(), options, { { "kept_visibility" } });
	EXPECT_TRUE(renderer) << (renderer ? "" : renderer.error().message);
	Lit result = { { scene, renderer ? std::move(*renderer) : nullptr, {}, {}, {}, {}, {} }, {}, {}, {} };
	if (!renderer)
		return result;
	auto frame = result.frame.renderer->renderFrame(camera);
	EXPECT_TRUE(frame) << (frame ? "" : frame.error().message);
	if (!frame)
		return result;
	result.frame.result = std::move(*frame);
	result.sun = result.frame.read<float>("sun_visibility");
	result.ambient = result.frame.read<float>("ambient_visibility");
	result.seen = result.frame.read<uint64_t>("kept_visibility");
	return result;
}

// Where the ray of a pixel's centre meets the plane of points p with p[axis] = value; nothing when it does not.
std::optional<dvec3> onPlane(const View& view, size_t pixel, int axis, double value)
{
	const dvec2 centre(double(pixel % view.width_px) + 0.5, double(pixel / view.width_px) + 0.5);
	const dvec3 eye = dvec3(view.eye_high) + dvec3(view.eye_low);
	const dvec3 direction = dvec3(view.forward) + dvec3(view.ray_first) + dvec3(view.ray_x) * centre.x + dvec3(view.ray_y) * centre.y;
	const double along = (value - eye[axis]) / direction[axis];
	return along > 0 ? std::optional(eye + direction * along) : std::nullopt;
}

}  // namespace

// A square one unit above a floor: its shadow is the square, moved along the sun's direction.
TEST_F(light, theShadowOfASquareLandsWhereTheSunSays)
{
	ImportedScene imported;
	addRectangle(imported, dvec3(-6, 0, 6), dvec3(12, 0, 0), dvec3(0, 0, -12));
	addRectangle(imported, dvec3(-0.5, 1, 0.5), dvec3(1, 0, 0), dvec3(0, 0, -1));
	const GpuScene scene(imported);
	const Camera camera = squareCamera(dvec3(-2.5, 3.5, -1), dvec3(-0.7, 0, -0.8));
	for (const Raster raster : everyPath())
		for (const float rate : { 0.0f, 6.0f })
		{
			RenderOptions options = rayOptions(rate, raster);
			options.shadows = true;
			const Lit frame = lit(scene, options, camera);
			const std::string what = fmt::format("--raster {} at rate {}", rasterName(raster), rate);
			ASSERT_EQ(frame.sun.size(), size_t(96 * 54)) << what;
			size_t dark = 0, bright = 0, wrong = 0;
			for (size_t pixel = 0; pixel < frame.sun.size(); ++pixel)
			{
				const auto floor = onPlane(frame.frame.view(), pixel, 1, 0), above = onPlane(frame.frame.view(), pixel, 1, 1);
				const auto inSquare = [](dvec3 p) {
					return 0.5 - std::max(std::abs(p.x), std::abs(p.z));  // above 0: within
				};
				// What sees the square itself is no shadow; neither is what is off the floor.
				if (frame.seen[pixel] == 0 || !floor || (above && inSquare(*above) > -0.01))
					continue;
				const double inside = inSquare(*floor + kSun / kSun.y);
				if (std::abs(inside) < 1e-4)
					continue;
				wrong += (frame.sun[pixel] == 0) != (inside > 0);
				dark += inside > 0;
				bright += inside < 0;
			}
			EXPECT_EQ(wrong, 0u) << what;
			EXPECT_GT(dark, 30u) << what;
			EXPECT_GT(bright, 500u) << what;
		}
}

// A closed box whose walls are bumpy: not one pixel inside is reached by the sun, at no border of parts and clusters.
TEST_F(light, noLightLeaksIntoAClosedBox)
{
	ImportedScene imported = cubeScene(4);
	for (Material& material : imported.materials)
		material.double_sided = true;
	const GpuScene scene(imported, defaultTable(), { 24, 16 });
	const dvec3 middle = (scene.built.world_low + scene.built.world_high) / 2.0;
	size_t seen = 0, lit_pixels = 0;
	for (const float rate : { 0.0f, 12.0f, 3.0f })
		for (const dvec3 way : { dvec3(1, 0.9, 1.1), dvec3(-1, -0.8, 0.3), dvec3(0.2, 1, -0.9) })
		{
			RenderOptions options = rayOptions(rate, rate == 3 ? Raster::Rt : Raster::Soft);
			options.shadows = true;
			const Lit frame = lit(scene, options, squareCamera(middle, middle + way));
			for (size_t pixel = 0; pixel < frame.sun.size(); ++pixel)
			{
				seen += frame.seen[pixel] != 0;
				lit_pixels += frame.seen[pixel] != 0 && frame.sun[pixel] != 0;
			}
		}
	EXPECT_EQ(lit_pixels, 0u);
	EXPECT_GT(seen, 9u * 96 * 54 * 99 / 100) << "the box is not closed";
}

// A convex body shadows nothing of itself but what faces away: no speckles on the bright side.
TEST_F(light, aConvexBodyDoesNotShadowItself)
{
	ImportedScene imported = sphereScene(24, 48, TexelFormat::U8, Wrap::Repeat);
	imported.materials[0].displacement.reset();
	const GpuScene scene(imported);
	const double radius = boundingRadius(scene.built);
	const dvec3 middle = (scene.built.world_low + scene.built.world_high) / 2.0;
	for (const double distance : { 2.0, 40.0 })
	{
		// Seen from the sun's direction all that is in view is lit.
		Camera camera = squareCamera(middle + kSun * (radius * distance), middle);
		camera.fov_y_rad = 2 * std::atan(1.2 / distance);
		RenderOptions options = rayOptions(3, Raster::Soft);
		options.shadows = true;
		options.ao_samples = 4;
		const Lit frame = lit(scene, options, camera);
		size_t seen = 0, dark = 0, occluded = 0;
		for (size_t pixel = 0; pixel < frame.sun.size(); ++pixel)
		{
			seen += frame.seen[pixel] != 0;
			dark += frame.seen[pixel] != 0 && frame.sun[pixel] == 0;
			occluded += frame.seen[pixel] != 0 && frame.ambient[pixel] != 1;
		}
		EXPECT_GT(seen, 500u);
		EXPECT_EQ(dark, 0u) << "from " << distance << " radii";
		EXPECT_EQ(occluded, 0u) << "from " << distance << " radii";
	}
}

// A floor that meets a wall. At a distance d from it, occluders up to R away fill the part of the cosine-weighted hemisphere whose directions go
// more than d / R towards the wall: seen from above (Malley), the cap of a disk.
TEST_F(light, ambientOcclusionBeforeAWallIsTheCapOfADisk)
{
	ImportedScene imported;
	addRectangle(imported, dvec3(0, 0, 10), dvec3(20, 0, 0), dvec3(0, 0, -20));
	addRectangle(imported, dvec3(0, 0, 10), dvec3(0, 0, -20), dvec3(0, 20, 0));
	const GpuScene scene(imported);
	constexpr double kRadius = 2;
	RenderOptions options = rayOptions(8, Raster::Soft);
	options.ao_samples = 64;
	options.ao_radius_world = float(kRadius);
	const Lit frame = lit(scene, options, squareCamera(dvec3(3, 4, 1), dvec3(1.5, 0, 0)));
	ASSERT_EQ(frame.ambient.size(), size_t(96 * 54));
	double error = 0, worst = 0;
	size_t near_wall = 0, compared = 0;
	for (size_t pixel = 0; pixel < frame.ambient.size(); ++pixel)
	{
		const auto floor = onPlane(frame.frame.view(), pixel, 1, 0);
		if (frame.seen[pixel] == 0 || !floor || floor->x < 0.01 || floor->x > 6 || std::abs(floor->z) > 6)
			continue;
		const double c = std::min(floor->x / kRadius, 1.0);
		const double expected = 1 - (std::acos(c) - c * std::sqrt(1 - c * c)) / std::numbers::pi;
		const double difference = double(frame.ambient[pixel]) - expected;
		error += difference;
		worst = std::max(worst, std::abs(difference));
		++compared;
		near_wall += c < 0.5;
	}
	EXPECT_GT(compared, 1000u);
	EXPECT_GT(near_wall, 100u);
	EXPECT_LT(std::abs(error) / double(compared), 0.004);
	EXPECT_LT(worst, 0.1) << "64 even samples of a pixel";
}

// Casters out of view, and back faces that the eye does not see, throw shadows as well: culling removes none.
TEST_F(light, whatIsOutOfViewCastsShadows)
{
	ImportedScene imported;
	addRectangle(imported, dvec3(-6, 0, 6), dvec3(12, 0, 0), dvec3(0, 0, -12));
	addRectangle(imported, dvec3(2, 4, 5), dvec3(2, 0, 0), dvec3(0, 0, -2));
	const GpuScene scene(imported);
	const Camera camera = squareCamera(dvec3(0.3, 1.2, 0.9), dvec3(0, 0, 0.4));
	RenderOptions options = rayOptions(6, Raster::Soft);
	options.shadows = true;
	const Lit whole = lit(scene, options, camera);
	options.cull = { true, true, true };
	const Lit culled = lit(scene, options, camera);
	EXPECT_GT(std::count_if(whole.sun.begin(), whole.sun.end(), [](float sun) { return sun == 0; }), 100) << "no shadow falls into the view";
	EXPECT_EQ(whole.sun, culled.sun);
	EXPECT_EQ(differingPixels(whole.frame.picture(), culled.frame.picture()), 0u);
}

// Without rays nothing of them runs or is held; with them, light is what changes and nothing else.
TEST_F(light, nothingOfRaysIsThereUntilAsked)
{
	const auto scene = gpuScene("bricks");
	const GpuFrame plain = drawFrame(*scene, rayOptions(6, Raster::Soft));
	EXPECT_EQ(plain.renderer->memory().rays, 0u);
	EXPECT_FALSE(plain.result.rays.traced);
	RenderOptions options = rayOptions(6, Raster::Soft);
	options.shadows = true;
	const GpuFrame shadowed = drawFrame(*scene, options);
	EXPECT_GT(shadowed.renderer->memory().rays, 0u);
	EXPECT_EQ(shadowed.result.counts.covered_pixels, plain.result.counts.covered_pixels);
	const std::vector<uint8_t> with = shadowed.picture(), without = plain.picture();
	size_t darker = 0, lighter = 0;
	for (size_t i = 0; i < with.size(); ++i)
	{
		darker += with[i] < without[i];
		lighter += with[i] > without[i];
	}
	EXPECT_GT(darker, 1000u);
	EXPECT_EQ(lighter, 0u);
}

}  // namespace tessera::test
