#include "reference_test_scenes.h"

#include "base/check.h"
#include "scene/builtin.h"
#include "scene/factor_rule.h"

namespace tessera::test
{

namespace
{

BuiltScene builtOrDie(const ImportedScene& imported, const BuildOptions& options)
{
	Result<BuiltScene> built = buildScene(imported, options);
	CHECK(built.has_value(), "{}", built.error().message);
	return std::move(*built);
}

// The metric whose table was asked for.
Metric metricOf(MetricTables tables)
{
	return tables.details ? Metric::Detail : tables.roughness ? Metric::Displaced : Metric::Edge;
}

}  // namespace

ReferenceScene::ReferenceScene(const ImportedScene& imported, const TessellationTable& table, const BuildOptions& options)
	: built(builtOrDie(imported, options)), host(built, table, metricOf(options.tables))
{}

std::unique_ptr<ReferenceScene> builtinScene(std::string_view name, const BuildOptions& options)
{
	const Result<ImportedScene> imported = makeBuiltinScene(name);
	CHECK(imported.has_value(), "{}", imported.error().message);
	return std::make_unique<ReferenceScene>(*imported, defaultTable(), options);
}

ImportedScene triangleScene(const std::vector<vec3>& corners, const dmat4& world)
{
	ImportedScene scene;
	Primitive primitive;
	primitive.material = addPlain(scene, "plain");
	for (uint32_t i = 0; i < corners.size(); ++i)
	{
		const size_t first = i / 3 * 3;
		const vec3 normal = glm::normalize(glm::cross(corners[first + 1] - corners[first], corners[first + 2] - corners[first]));
		addVertex(primitive, corners[i], normal, vec2(0));
		primitive.indices.push_back(i);
	}
	addPlacedMesh(scene, { primitive });
	scene.instances[0].world = world;
	return scene;
}

Camera cameraAt(dvec3 eye, dvec3 target)
{
	Camera camera;
	camera.eye = eye;
	camera.target = target;
	const dvec3 forward = glm::normalize(target - eye);
	camera.up = std::abs(forward.y) > 0.9 ? dvec3(0, 0, 1) : dvec3(0, 1, 0);
	camera.fov_y_rad = 1.57079632679489662;
	camera.near_world = 1e-3;
	return camera;
}

ViewRequest request(double focal_px, double rate_px)
{
	ViewRequest result;
	result.width_px = result.height_px = static_cast<uint32_t>(2 * focal_px);
	result.rate_px = rate_px;
	return result;
}

View viewOf(const ReferenceScene& scene, const Camera& camera, const ViewRequest& request)
{
	const Result<View> view = makeView(camera, scene.built, request);
	CHECK(view.has_value(), "{}", view.error().message);
	return *view;
}

reference::Classified classifyAll(const ReferenceScene& scene, const View& view, uint32_t max_split)
{
	return reference::classify(scene.host, view, factorRule(view, scene.host.tableSize(), max_split), reference::allClusters(scene.host));
}

}  // namespace tessera::test
