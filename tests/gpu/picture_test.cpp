// Pictures: what must hold whatever the scene looks like, normals against an analytic surface, and small stored pictures.
#include "visibility.h"

#include "output/png.h"
#include "scene/image_decode.h"

#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

namespace tessera::test
{

namespace
{

using picture = GpuTest;

constexpr uint32_t kWidth = 160, kHeight = 90;

bool samePixel(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b, size_t pixel)
{
	return std::memcmp(a.data() + 4 * pixel, b.data() + 4 * pixel, 4) == 0;
}

// The world normal that the view of normals shows: the reverse of shade's 2.2 power and of the sRGB curve.
dvec3 normalAt(const std::vector<uint8_t>& texels, size_t pixel)
{
	dvec3 normal;
	for (int axis = 0; axis < 3; ++axis)
	{
		const double c = texels[4 * pixel + size_t(axis)] / 255.0;
		const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
		normal[axis] = std::pow(linear, 1 / 2.2) * 2 - 1;
	}
	return normal;
}

double degreesBetween(dvec3 a, dvec3 b)
{
	return std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)) * 180 / std::numbers::pi;
}

// Pixels with another colour than where nothing is.
std::vector<bool> coveredByColor(const GpuScene& scene, const GpuFrame& frame, const Camera& camera)
{
	RenderOptions options = frame.renderer->planInput().options;
	// The same directions, from behind everything: the background depends on the direction alone.
	Camera behind = camera;
	behind.eye = camera.eye + (camera.target - camera.eye) * 1e4;
	behind.target = behind.eye + (camera.target - camera.eye);
	const GpuFrame nothing = drawFrame(scene, options, behind);
	EXPECT_EQ(nothing.result.counts.covered_pixels, 0u);
	const std::vector<uint8_t> with = frame.picture(), without = nothing.picture();
	std::vector<bool> covered(with.size() / 4);
	for (size_t pixel = 0; pixel < covered.size(); ++pixel)
		covered[pixel] = !samePixel(with, without, pixel);
	return covered;
}

}  // namespace

// --- coverage --------------------------------------------------------------------------------------------------------------------

TEST_F(picture, aSquareFacingTheCameraCoversExactlyThePixelsComputedByHand)
{
	// Focal length 45 px, 1.5 away: side 1 has 30 px, in the middle of 160 x 90: columns 65 to 94, rows 30 to 59. No pixel centre is on
	// an edge.
	const GpuScene scene(squareScene());
	const Camera camera = squareCamera(dvec3(0, 0, 1.5), dvec3(0));
	for (const Raster path : rasterPaths())
		for (const float rate : { 0.0f, 7.0f, 1.0f })
		{
			RenderOptions options = smallOptions(rate);
			options.raster = path;
			const GpuFrame frame = drawFrame(scene, options, camera);
			EXPECT_EQ(frame.result.counts.covered_pixels, 900u);
			const std::vector<bool> covered = coveredByColor(scene, frame, camera);
			size_t wrong = 0;
			for (uint32_t y = 0; y < kHeight; ++y)
				for (uint32_t x = 0; x < kWidth; ++x)
					wrong += covered[y * kWidth + x] != (x >= 65 && x < 95 && y >= 30 && y < 60);
			EXPECT_EQ(wrong, 0u) << "rate " << rate;
		}
}

TEST_F(picture, anOrthographicSquareCoversExactlyThePixelsComputedByHand)
{
	// 90 px show 3 units: side 1 has 30 px again, at any distance.
	const GpuScene scene(squareScene());
	for (const double distance : { 1.0, 40.0 })
	{
		Camera camera = squareCamera(dvec3(0, 0, distance), dvec3(0));
		camera.orthographic = true;
		camera.height_world = 3;
		EXPECT_EQ(drawFrame(scene, smallOptions(4), camera).result.counts.covered_pixels, 900u) << distance;
	}
}

TEST_F(picture, theBackgroundIsWhereNothingIs)
{
	for (const char* name : { "planet", "bricks" })
	{
		const auto scene = gpuScene(name);
		const GpuFrame frame = drawFrame(*scene, smallOptions(6));
		const std::vector<bool> covered = coveredByColor(*scene, frame, scene->camera);
		const size_t count = size_t(std::count(covered.begin(), covered.end(), true));
		// A surface may happen to have the background's very colour.
		EXPECT_LE(count, frame.result.counts.covered_pixels) << name;
		EXPECT_GE(count * 200, frame.result.counts.covered_pixels * 197) << name;
	}
}

// --- determinism -----------------------------------------------------------------------------------------------------------------

namespace
{

struct Drawn
{
	std::vector<uint8_t> texels;
	FrameCountsRead counts;
};

Drawn drawn(const GpuFrame& frame)
{
	return { frame.picture(), frame.result.counts };
}

void expectSame(const Drawn& a, const Drawn& b, const std::string& what)
{
	EXPECT_EQ(a.counts.micro_triangles, b.counts.micro_triangles) << what;
	EXPECT_EQ(a.counts.part_triangles, b.counts.part_triangles) << what;
	EXPECT_EQ(a.counts.split_triangles, b.counts.split_triangles) << what;
	EXPECT_EQ(a.counts.full_clusters, b.counts.full_clusters) << what;
	EXPECT_EQ(a.counts.visible_clusters, b.counts.visible_clusters) << what;
	EXPECT_EQ(a.counts.covered_pixels, b.counts.covered_pixels) << what;
	// Exactly equal depths may fall either way.
	EXPECT_LE(differingPixels(a.texels, b.texels), a.counts.covered_pixels / 1000) << what;
}

// The device with other numbers of workgroups and threads, until the end of the scope.
struct OtherLimits
{
	OtherLimits(uint32_t loop_workgroups, uint32_t mesh_threads)
	{
		gpu().limits.loop_workgroups = loop_workgroups;
		gpu().limits.mesh_workgroup_threads = mesh_threads;
	}
	~OtherLimits() { gpu().limits = before; }
	OtherLimits(const OtherLimits&) = delete;
	OtherLimits& operator=(const OtherLimits&) = delete;
	DeviceLimits before = gpu().limits;
};

}  // namespace

TEST_F(picture, repeatedFramesOtherCapacitiesAndOtherWorkgroupsGiveTheSameBitsAndCounts)
{
	for (const char* name : { "cube", "instances:30", "planet" })
	{
		const auto scene = gpuScene(name);
		for (const Raster path : rasterPaths())
		{
			RenderOptions options = smallOptions(2.5f);
			options.raster = path;
			options.view = ViewMode::Triangles;
			GpuFrame frame = drawFrame(*scene, options);
			const Drawn first = drawn(frame);
			for (int repeat = 0; repeat < 3; ++repeat)
			{
				drawAgain(frame, scene->camera);
				expectSame(first, drawn(frame), fmt::format("{} again", name));
			}
			// Away and back: nothing of another view is left.
			drawAgain(frame, closeTo(*scene, 0.4));
			drawAgain(frame, scene->camera);
			expectSame(first, drawn(frame), fmt::format("{} after another view", name));
			for (const uint32_t groups : { 1u, 7u, 300u })
			{
				const OtherLimits other(groups, groups == 7 ? 64 : 32);
				expectSame(first, drawn(drawFrame(*scene, options)), fmt::format("{} with {} workgroups", name, groups));
			}
			options.capacities = { { "part_triangles", 300000 }, { "split_triangles", 50000 }, { "micro_vertices", 2000000 } };
			expectSame(first, drawn(drawFrame(*scene, options)), fmt::format("{} with other capacities", name));
		}
	}
}

// --- every view ------------------------------------------------------------------------------------------------------------------

TEST_F(picture, everyViewIsOpaqueAndShowsSomething)
{
	const auto scene = gpuScene("bricks");
	for (uint32_t view = 0; view <= uint32_t(ViewMode::Error); ++view)
	{
		RenderOptions options = smallOptions(5);
		options.view = ViewMode(view);
		const GpuFrame frame = drawFrame(*scene, options);
		const std::vector<uint8_t> texels = frame.picture();
		ASSERT_EQ(texels.size(), size_t(kWidth) * kHeight * 4);
		size_t clear = 0, other = 0;
		for (size_t pixel = 0; pixel < texels.size() / 4; ++pixel)
		{
			clear += texels[4 * pixel + 3] != 255;
			other += std::memcmp(&texels[4 * pixel], &texels[0], 4) != 0;
		}
		EXPECT_EQ(clear, 0u) << "view " << view;
		EXPECT_GT(other, texels.size() / 4 / 10) << "view " << view;
	}
}

TEST_F(picture, normalsAreUnitVectorsTowardsTheEye)
{
	for (const char* name : { "planet", "bricks", "materials", "cube" })
		for (const bool smooth : { true, false })
		{
			const auto scene = gpuScene(name);
			RenderOptions options = smallOptions(3);
			options.view = ViewMode::Normals;
			options.smooth_normals = smooth;
			const GpuFrame frame = drawFrame(*scene, options);
			const std::vector<uint8_t> texels = frame.picture();
			const std::vector<VisiblePixel> seen = visibilityOf(frame);
			size_t wrong = 0, checked = 0;
			for (size_t pixel = 0; pixel < seen.size(); ++pixel)
				if (seen[pixel].covered())
				{
					++checked;
					wrong += std::abs(glm::length(normalAt(texels, pixel)) - 1) > 0.05;
				}
			EXPECT_EQ(wrong, 0u) << name << (smooth ? " smooth" : " flat");
			EXPECT_EQ(checked, frame.result.counts.covered_pixels) << name;
		}
}

// --- shading normals -------------------------------------------------------------------------------------------------------------

namespace
{

constexpr double kAmplitude = 0.06, kWaves = 2;

// Height of the waves at texture coordinates, 0..1.
double waveHeight(double u, double v)
{
	return 0.5 + 0.25 * std::sin(2 * std::numbers::pi * kWaves * u) + 0.25 * std::cos(2 * std::numbers::pi * kWaves * v);
}

// The unit square, displaced by waves; u runs along x, v along y.
ImportedScene waveScene()
{
	constexpr uint32_t kSide = 256;
	Image image = constantImage(kSide, kSide, TexelFormat::F32, 0);
	for (uint32_t y = 0; y < kSide; ++y)
		for (uint32_t x = 0; x < kSide; ++x)
		{
			const auto height = float(waveHeight((x + 0.5) / kSide, (y + 0.5) / kSide));
			std::memcpy(image.texels.data() + (y * kSide + x) * sizeof height, &height, sizeof height);
		}
	ImportedScene scene = squareScene();
	const uint32_t material = addDisplaced(scene, std::move(image), float(kAmplitude), 0);
	scene.meshes[0].primitives[0].material = material;
	return scene;
}

dvec3 waveNormal(double x, double y)
{
	const double k = 2 * std::numbers::pi * kWaves, u = x + 0.5, v = y + 0.5;
	return glm::normalize(dvec3(-kAmplitude * 0.25 * k * std::cos(k * u), kAmplitude * 0.25 * k * std::sin(k * v), 1));
}

// Where the ray through a pixel meets the waves: fixed-point iteration on the height (slopes are below 1/2).
dvec3 waveHit(const Camera& camera, uint32_t x, uint32_t y)
{
	const double focal_px = kHeight / 2.0;
	const dvec3 direction((x + 0.5 - kWidth / 2.0) / focal_px, -(y + 0.5 - kHeight / 2.0) / focal_px, -1);
	double height = 0;
	dvec3 hit(0);
	for (int step = 0; step < 50; ++step)
	{
		hit = camera.eye + direction * (camera.eye.z - height);
		height = kAmplitude * waveHeight(hit.x + 0.5, hit.y + 0.5);
	}
	return hit;
}

}  // namespace

TEST_F(picture, smoothNormalsFollowTheAnalyticSurfaceUnderAnyRate)
{
	const GpuScene scene(waveScene());
	const Camera camera = squareCamera(dvec3(0, 0, 0.6), dvec3(0));
	for (const float rate : { 12.0f, 4.0f, 1.0f })
	{
		RenderOptions options = smallOptions(rate);
		options.view = ViewMode::Normals;
		const GpuFrame frame = drawFrame(scene, options, camera);
		const std::vector<uint8_t> texels = frame.picture();
		const std::vector<VisiblePixel> seen = visibilityOf(frame);
		double sum = 0, worst = 0;
		size_t count = 0;
		for (uint32_t y = 0; y < kHeight; ++y)
			for (uint32_t x = 0; x < kWidth; ++x)
			{
				const dvec3 hit = waveHit(camera, x, y);
				if (std::max(std::abs(hit.x), std::abs(hit.y)) > 0.46 || !(seen.empty() || seen[y * kWidth + x].covered()))
					continue;
				const double off = degreesBetween(normalAt(texels, y * kWidth + x), waveNormal(hit.x, hit.y));
				sum += off;
				worst = std::max(worst, off);
				++count;
			}
		ASSERT_GT(count, 3000u);
		// Coarse triangles stand a little off the surface, so a pixel reads the normal of a place near by.
		EXPECT_LT(sum / double(count), rate > 8 ? 2.0 : 1.0) << "mean degrees at rate " << rate;
		EXPECT_LT(worst, rate > 8 ? 8.0 : 3.0) << "worst degrees at rate " << rate;
	}
}

namespace
{

// Mean of the degrees between the normals that a picture of the unit sphere shows and the sphere's own where its pixels meet it.
double meanNormalError(const GpuScene& scene, const Camera& camera)
{
	RenderOptions options = smallOptions(3);
	options.view = ViewMode::Normals;
	const GpuFrame frame = drawFrame(scene, options, camera);
	const std::vector<uint8_t> texels = frame.picture();
	const std::vector<bool> covered = coveredByColor(scene, frame, camera);
	const dvec3 forward = glm::normalize(-camera.eye), right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
	double sum = 0;
	size_t count = 0;
	for (uint32_t y = 0; y < kHeight; ++y)
		for (uint32_t x = 0; x < kWidth; ++x)
		{
			const dvec3 ray = glm::normalize(forward + right * ((x + 0.5 - kWidth / 2.0) / 45) - up * ((y + 0.5 - kHeight / 2.0) / 45));
			const double along = -glm::dot(camera.eye, ray), squared = along * along - glm::dot(camera.eye, camera.eye) + 1;
			// Not where the sphere turns away: a pixel there is many degrees.
			if (squared < 0.1 || !covered[y * kWidth + x])
				continue;
			sum += degreesBetween(normalAt(texels, y * kWidth + x), camera.eye + ray * (along - std::sqrt(squared)));
			++count;
		}
	EXPECT_GT(count, 1000u);
	return sum / double(count);
}

}  // namespace

TEST_F(picture, smoothNormalsOfPnTrianglesFollowTheSphereThatTheyAreNear)
{
	const Camera camera = squareCamera(dvec3(0.3, 0.5, 2), dvec3(0));
	const double flat = meanNormalError(GpuScene(roundScene(3)), camera);
	const double curved = meanNormalError(GpuScene(roundScene(3), defaultTable(), { .pn = true }), camera);
	printf("degrees between normals and the sphere's: flat %.2f, PN triangles %.2f\n", flat, curved);
	EXPECT_LT(curved, 2.0);
	EXPECT_LT(curved * 2, flat);
}

// Places that depth tells: the picture itself.
TEST_F(picture, aCoarseSphereOfPnTrianglesIsShadedAsAFineOne)
{
	const Camera camera = squareCamera(dvec3(0.3, 0.5, 2), dvec3(0));
	const auto pictureOf = [&](uint32_t cuts, bool pn) {
		return drawFrame(GpuScene(roundScene(cuts), defaultTable(), { .pn = pn }), smallOptions(3), camera).picture();
	};
	const std::vector<uint8_t> fine = pictureOf(48, false), flat = pictureOf(3, false), curved = pictureOf(3, true);
	const size_t flat_differs = differingPixels(fine, flat, 6), curved_differs = differingPixels(fine, curved, 6);
	printf("pixels that differ from a fine sphere: flat %zu, PN triangles %zu\n", flat_differs, curved_differs);
	EXPECT_GT(flat_differs, 300u);
	EXPECT_LT(curved_differs * 4, flat_differs);
}

TEST_F(picture, flatNormalsAreThoseOfTheMicroTriangles)
{
	const GpuScene scene(waveScene());
	RenderOptions options = smallOptions(6);
	options.view = ViewMode::Normals;
	options.smooth_normals = false;
	const GpuFrame frame = drawFrame(scene, options, squareCamera(dvec3(0, 0, 0.6), dvec3(0)));
	const std::vector<uint8_t> texels = frame.picture();
	const std::vector<VisiblePixel> seen = visibilityOf(frame);
	double worst = 0;
	for (size_t pixel = 0; pixel < seen.size(); pixel += 7)
	{
		if (!seen[pixel].covered())
			continue;
		for (const reference::ReferencePiece& part : frame.parts)
		{
			const auto& w = seen[pixel].identity.words;
			if (part.piece.triangle != w[2] || part.piece.c0.u != w[3] || part.piece.c0.v != w[4] || part.piece.c1.u != w[5] ||
				part.piece.c1.v != w[6] || part.piece.c2.u != w[7])
				continue;
			const reference::Evaluated mesh = reference::evaluatePart(scene.host, frame.view(), part);
			const uvec3 t = mesh.triangles.at(w[9]);
			const dvec3 a(mesh.vertices[t.x].displaced), b(mesh.vertices[t.y].displaced), c(mesh.vertices[t.z].displaced);
			worst = std::max(worst, degreesBetween(normalAt(texels, pixel), glm::cross(b - a, c - a)));
		}
	}
	EXPECT_LT(worst, 1.5);
	EXPECT_GT(worst, 0) << "nothing was compared";
}

// --- stored pictures -------------------------------------------------------------------------------------------------------------

namespace
{

struct Tolerance
{
	std::string name;
	double rate = 0;
	double mean = 0;      // mean absolute difference of channels, 0..255
	double outliers = 0;  // most pixels, in percent, with a channel more than 24 off
};

std::vector<Tolerance> tolerances()
{
	std::ifstream file(std::filesystem::path(TESSERA_SOURCE_ROOT) / "tests/data/golden/tolerances.txt");
	std::vector<Tolerance> all;
	for (std::string line; std::getline(file, line);)
		if (Tolerance t; !line.starts_with('#') && std::istringstream(line) >> t.name >> t.rate >> t.mean >> t.outliers)
			all.push_back(t);
	return all;
}

double meanDifference(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b)
{
	double sum = 0;
	for (size_t i = 0; i < a.size(); ++i)
		sum += std::abs(double(a[i]) - double(b[i]));
	return sum / double(a.size()) * 4 / 3;  // the fourth channel is the same everywhere
}

std::vector<uint8_t> storedPicture(const std::filesystem::path& path)
{
	std::vector<std::string> warnings;
	const Result<Image> image = readImage(path, warnings);
	if (!image || image->channels != 4)
		return {};
	std::vector<uint8_t> texels(image->texels.size());
	std::memcpy(texels.data(), image->texels.data(), texels.size());
	return texels;
}

}  // namespace

// The place on the base triangle comes from depth alone: as well when one micro-triangle covers half of the picture as when each is a pixel.
TEST_F(picture, coloursAcrossATriangleDoNotDependOnHowItIsCut)
{
	ImportedScene square = squareScene();
	square.meshes[0].primitives[0].colors = { vec4(1, 0, 0, 1), vec4(0, 1, 0, 1), vec4(0, 0, 1, 1), vec4(1, 1, 1, 1) };
	const GpuScene scene(square);
	for (const dvec3 eye : { dvec3(0, 0, 0.6), dvec3(0.9, -0.4, 0.5) })
	{
		const Camera camera = squareCamera(eye, dvec3(0));
		const GpuFrame whole = drawFrame(scene, smallOptions(0), camera), cut = drawFrame(scene, smallOptions(2), camera);
		ASSERT_GT(cut.result.counts.micro_triangles, 100 * whole.result.counts.micro_triangles);
		EXPECT_EQ(differingPixels(whole.picture(), cut.picture(), 1), 0u);
		std::set<uint32_t> colours;
		const std::vector<uint8_t> texels = whole.picture();
		for (size_t i = 0; i < texels.size(); i += 4)
			colours.insert(texels[i] / 16u | texels[i + 1] / 16u << 8 | texels[i + 2] / 16u << 16);
		EXPECT_GT(colours.size(), 100u) << "the corners' colours are not interpolated";
	}
}

// TESSERA_WRITE_GOLDEN=FOLDER writes the pictures there instead: look at them before they replace the stored ones.
TEST_F(picture, storedPicturesAreMatched)
{
	const char* write_to = std::getenv("TESSERA_WRITE_GOLDEN");
	ASSERT_FALSE(tolerances().empty());
	for (const Tolerance& t : tolerances())
	{
		const auto scene = gpuScene(t.name);
		const std::vector<uint8_t> texels = drawFrame(*scene, smallOptions(float(t.rate))).picture();
		const std::filesystem::path stored = std::filesystem::path(TESSERA_SOURCE_ROOT) / "tests/data/golden" / (t.name + ".png");
		if (write_to)
		{
			EXPECT_TRUE(writePng(std::filesystem::path(write_to) / (t.name + ".png"), kWidth, kHeight, texels, 4).has_value());
			continue;
		}
		const std::vector<uint8_t> expected = storedPicture(stored);
		ASSERT_EQ(expected.size(), texels.size()) << stored;
		EXPECT_LE(meanDifference(texels, expected), t.mean) << t.name;
		EXPECT_LE(double(differingPixels(texels, expected, 24)), t.outliers / 100 * kWidth * kHeight) << t.name;
	}
}

}  // namespace tessera::test
