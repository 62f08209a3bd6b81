// Views that measure: their colours are read back as numbers.
#include "gpu/gpu_test.h"

#include <cmath>
#include <numbers>

namespace tessera::test
{

namespace
{

using viewModes = GpuTest;

double encodeSrgb(double linear)
{
	return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

// shaders/lib/debug_colors.glsl: ramp.
dvec3 rampColor(double t)
{
	const auto step = [&](double first) {
		return std::clamp(t * 3 - first, 0.0, 1.0);
	};
	const dvec3 low = glm::mix(dvec3(0.06, 0.10, 0.45), dvec3(0.05, 0.55, 0.55), step(0));
	return glm::mix(glm::mix(low, dvec3(0.85, 0.80, 0.15), step(1)), dvec3(0.80, 0.08, 0.05), step(2));
}

// Where on the ramp a pixel's colour lies, 0..1, whatever its brightness.
double rampPlace(const uint8_t* pixel)
{
	double best = 2, place = 0;
	for (int i = 0; i <= 400; ++i)
	{
		const dvec3 color = rampColor(i / 400.0);
		const dvec3 expected = { encodeSrgb(color.r), encodeSrgb(color.g), encodeSrgb(color.b) };
		const double distance = glm::length(expected - dvec3(pixel[0], pixel[1], pixel[2]) / 255.0);
		if (distance < best)
		{
			best = distance;
			place = i / 400.0;
		}
	}
	return place;
}

std::vector<double> rampPlaces(const GpuScene& scene, const RenderOptions& options, const Camera& camera)
{
	const GpuFrame frame = drawFrame(scene, options, camera);
	const std::vector<uint8_t> picture = frame.picture();
	RenderOptions depth = options;
	depth.view = ViewMode::Depth;
	const std::vector<uint8_t> covered = drawFrame(scene, depth, camera).picture();
	std::vector<double> places;
	for (size_t pixel = 0; pixel < picture.size() / 4; ++pixel)
		if (covered[4 * pixel] == covered[4 * pixel + 1] && covered[4 * pixel] == covered[4 * pixel + 2])  // depth is grey, the background is not
			places.push_back(rampPlace(picture.data() + 4 * pixel));
	return places;
}

double mean(const std::vector<double>& values)
{
	double sum = 0;
	for (double value : values)
		sum += value;
	return sum / double(std::max<size_t>(values.size(), 1));
}

}  // namespace

TEST_F(viewModes, areaIsThatOfTheTriangleInThePicture)
{
	const GpuScene scene(squareScene());
	for (double distance : { 4.0, 8.0 })
	{
		RenderOptions options = smallOptions(0);
		options.view = ViewMode::Area;
		const std::vector<double> places = rampPlaces(scene, options, squareCamera({ 0, 0, distance }, { 0, 0, 0 }));
		ASSERT_GT(places.size(), 20u);
		// Focal length 45 px: the square's side is 45 / distance, each of its triangles half of its square.
		const double area = std::pow(45 / distance, 2) / 2, expected = (std::log2(area) + 4) / 12;
		EXPECT_NEAR(mean(places), expected, 0.02) << distance;
	}
}

TEST_F(viewModes, errorIsNothingOnAFlatSquareAndFallsWithTheRate)
{
	RenderOptions options = smallOptions(8);
	options.view = ViewMode::Error;
	const GpuScene flat(squareScene());
	for (double place : rampPlaces(flat, options, squareCamera({ 0, 0, 1 }, { 0, 0, 0 })))
		EXPECT_LT(place, 0.02);
	const auto scene = gpuScene("builtin:planet");
	double before = 1;
	for (float rate : { 32.0f, 8.0f, 2.0f })
	{
		options.rate = rate;
		const double error = mean(rampPlaces(*scene, options, closeTo(*scene, 0.8)));
		EXPECT_LT(error, before - 0.05) << rate;
		before = error;
	}
}

TEST_F(viewModes, wireframeChangesOnlyThePixelsOfItsLines)
{
	const auto scene = gpuScene("builtin:planet");
	RenderOptions options = smallOptions(0);
	for (ViewMode view : { ViewMode::Shaded, ViewMode::Clusters, ViewMode::Normals })
	{
		options.view = view;
		options.wireframe = false;
		options.smooth_normals = false;  // shaded without lines finds places by depth
		const std::vector<uint8_t> plain = drawFrame(*scene, options, closeTo(*scene, 0.3)).picture();
		options.wireframe = true;
		const GpuFrame frame = drawFrame(*scene, options, closeTo(*scene, 0.3));
		const size_t changed = differingPixels(plain, frame.picture(), 2);
		EXPECT_GT(changed, 200u) << "view " << int(view);
		EXPECT_LT(changed, frame.result.counts.covered_pixels * 3 / 5) << "view " << int(view);
	}
}

}  // namespace tessera::test
