// From the command line's scene to instances and a camera.
#include "app/scene_load.h"
#include "app/stats_json.h"
#include "base/log.h"

#include <gtest/gtest.h>

namespace tessera::test
{

namespace
{

class sceneLoad : public testing::Test
{
protected:
	void SetUp() override { setLogLevel(LogLevel::Quiet); }
};

BuiltScene built(const std::string& name, const AppOptions& options = {})
{
	Result<BuiltScene> scene = loadScene(name, options);
	EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
	return scene ? std::move(*scene) : BuiltScene();
}

Camera chosen(const BuiltScene& scene, const AppOptions& options)
{
	const Result<Camera> camera = chooseCamera(scene, options);
	EXPECT_TRUE(camera) << (camera ? "" : camera.error().message);
	return camera.value_or(Camera());
}

std::string refusal(const BuiltScene& scene, const AppOptions& options)
{
	const Result<Camera> camera = chooseCamera(scene, options);
	if (camera)
		return "accepted";
	EXPECT_EQ(camera.error().code, ExitCode::Usage);
	return camera.error().message;
}

}  // namespace

TEST_F(sceneLoad, copyIJIsMovedByIUPlusJV)
{
	AppOptions options;
	options.grid_columns = 3;
	options.grid_rows = 2;
	options.grid_u = dvec3(-2, 0, 0.5);
	options.grid_v = dvec3(0, 7, 0);
	const Result<ImportedScene> one = importScene("builtin:instances:3", {}), grid = importScene("builtin:instances:3", options);
	ASSERT_TRUE(one && grid);
	ASSERT_EQ(grid->instances.size(), 6 * one->instances.size());
	size_t next = 0;
	for (int i = 0; i < 3; ++i)
		for (int j = 0; j < 2; ++j)
			for (const Instance& instance : one->instances)
			{
				const Instance& copy = grid->instances[next++];
				EXPECT_EQ(copy.mesh, instance.mesh);
				for (int column = 0; column < 3; ++column)
					EXPECT_EQ(copy.world[column], instance.world[column]);
				EXPECT_EQ(dvec3(copy.world[3]), dvec3(instance.world[3]) + double(i) * *options.grid_u + double(j) * *options.grid_v);
			}
	EXPECT_EQ(grid->meshes.size(), one->meshes.size()) << "geometry is shared";
}

TEST_F(sceneLoad, copiesWithoutAStepDoNotOverlap)
{
	AppOptions options;
	options.grid_columns = options.grid_rows = 2;
	const Result<ImportedScene> grid = importScene("builtin:cube", options);
	ASSERT_TRUE(grid);
	ASSERT_EQ(grid->instances.size(), 4u);
	const BuiltScene one = built("builtin:cube");
	EXPECT_GT(grid->instances[2].world[3].x - grid->instances[0].world[3].x, (one.world_high.x - one.world_low.x));
	EXPECT_LT(grid->instances[1].world[3].z - grid->instances[0].world[3].z, -(one.world_high.z - one.world_low.z));
}

TEST_F(sceneLoad, tooManyCopiesAreRefused)
{
	AppOptions options;
	options.grid_columns = options.grid_rows = 4096;
	const Result<ImportedScene> grid = importScene("builtin:instances:64", options);
	ASSERT_FALSE(grid);
	EXPECT_EQ(grid.error().code, ExitCode::Usage);
	EXPECT_NE(grid.error().message.find("--grid 4096x4096"), std::string::npos);
}

TEST_F(sceneLoad, aScenesCameraComesBeforeFramingAndOptionsComeBeforeBoth)
{
	BuiltScene scene = built("builtin:quad");
	ASSERT_FALSE(scene.cameras.empty());
	EXPECT_EQ(chosen(scene, {}), cameraOf(scene.cameras[0], scene));

	AppOptions options;
	options.eye = dvec3(1, 2, 9);
	options.fov_deg = 90;
	options.near_world = 0.25;
	const Camera camera = chosen(scene, options);
	EXPECT_EQ(camera.eye, *options.eye);
	EXPECT_EQ(camera.target, (scene.world_low + scene.world_high) / 2.0) << "without a target the scene's middle is looked at";
	EXPECT_NEAR(camera.fov_y_rad, 1.5707963, 1e-6);
	EXPECT_EQ(camera.near_world, 0.25);

	scene.path = "a.glb";
	EXPECT_LT(glm::length(chosen(scene, {}).eye - framingCamera(scene).eye), 1e-9) << "files are framed";
	AppOptions first;
	first.camera = 0;
	EXPECT_EQ(chosen(scene, first), cameraOf(scene.cameras[0], scene));
}

TEST_F(sceneLoad, framingShowsTheWholeSceneInPicturesOfAnyShape)
{
	BuiltScene scene = built("builtin:cube");
	scene.path = "a.glb";
	const dvec3 middle = (scene.world_low + scene.world_high) / 2.0, half = scene.world_high - middle;
	for (const auto& [width, height, fov] :
		 { std::tuple(1920u, 1080u, 60.0), std::tuple(100u, 1000u, 60.0), std::tuple(400u, 400u, 120.0), std::tuple(300u, 200u, 5.0) })
	{
		AppOptions options;
		options.width_px = width;
		options.height_px = height;
		options.fov_deg = fov;
		const Result<View> view = makeView(chosen(scene, options), scene, { width, height });
		ASSERT_TRUE(view);
		for (int corner = 0; corner < 8; ++corner)
		{
			const dvec3 p = middle + half * dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1) - dvec3(view->eye_high);
			const double depth = glm::dot(p, dvec3(view->forward));
			ASSERT_GT(depth, 0);
			EXPECT_LE(std::abs(glm::dot(p, dvec3(view->right))) * double(view->focal_x), depth) << width << "x" << height << " " << fov;
			EXPECT_LE(std::abs(glm::dot(p, dvec3(view->up))) * double(view->focal_y), depth) << width << "x" << height << " " << fov;
		}
	}
}

TEST_F(sceneLoad, camerasThatCannotBeAreRefusedByName)
{
	const BuiltScene scene = built("builtin:quad");
	AppOptions options;
	options.camera = 7;
	EXPECT_NE(refusal(scene, options).find("--camera 7: builtin:quad has 1 camera"), std::string::npos);
	options = {};
	options.up = dvec3(0);
	EXPECT_NE(refusal(scene, options).find("--up 0,0,0"), std::string::npos);
	options = {};
	options.eye = options.target = dvec3(1, 2, 3);
	EXPECT_NE(refusal(scene, options).find("--eye 1,2,3"), std::string::npos);
}

TEST_F(sceneLoad, lookingStraightDownNeedsNoUp)
{
	const BuiltScene scene = built("builtin:quad");
	AppOptions options;
	options.eye = dvec3(0, 5, 0);
	options.target = dvec3(0);
	const BuiltScene framed = [&] {
		BuiltScene copy = scene;
		copy.path = "a.glb";
		return copy;
	}();
	EXPECT_TRUE(makeView(chosen(framed, options), framed, {}));
}

TEST(timeSeries, medianIsTheMiddleOrTheMeanOfTheTwoInTheMiddle)
{
	EXPECT_EQ(TimeSeries{}.median(), 0);
	EXPECT_EQ((TimeSeries{ { 3 } }).median(), 3);
	EXPECT_EQ((TimeSeries{ { 9, 1, 2 } }).median(), 2);
	EXPECT_EQ((TimeSeries{ { 9, 1, 2, 4 } }).median(), 3);
	EXPECT_EQ((TimeSeries{ { 9, 1, 2, 4 } }).least(), 1);
	EXPECT_EQ((TimeSeries{ { 9, 1, 2, 4 } }).most(), 9);
}

}  // namespace tessera::test
