// None, one and very many: triangles, instances, list entries.
#include "verify/suite/case.h"
#include "verify/suite/parts.h"

#include "frame/lists.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace tessera::verify
{

namespace
{

// A square of copies of a mesh.
ImportedScene field(ImportedScene scene, uint32_t count, double step)
{
	scene.instances.clear();
	const auto side = static_cast<uint32_t>(std::ceil(std::sqrt(double(count))));
	for (uint32_t i = 0; i < count; ++i)
		scene.instances.push_back({ 0, glm::translate(dmat4(1), dvec3(i % side, 0, -double(i / side)) * step) });
	return scene;
}

std::vector<NamedCamera> framingOnly(const BuiltScene& scene)
{
	return { { "framing", framingCamera(scene) } };
}

std::function<std::string(const CaseRun&)> hasTriangles(uint64_t triangles)
{
	return [triangles](const CaseRun& run) {
		if (run.scene.traits.instanced_triangles != triangles)
			return fmt::format("{} triangles were built, not {}", run.scene.traits.instanced_triangles, triangles);
		for (const FrameLine& frame : run.report.frames)
			if (frame.micro_triangles < triangles)
				return fmt::format("{} micro-triangles are fewer than the {} triangles", frame.micro_triangles, triangles);
		return std::string();
	};
}

ImportedScene oneTriangle()
{
	ImportedScene scene = parts::sheet(1, 1, 0.2f);
	scene.meshes[0].primitives[0].indices.resize(3);
	return scene;
}

void addNone(std::vector<Case>& cases)
{
	Case instances = { "counts", "no_instances", "a mesh that nothing places" };
	instances.scene = [] {
		ImportedScene scene = parts::ball(1);
		scene.instances.clear();
		return scene;
	};
	instances.expected = refused(ExitCode::BadInput, "has nothing to draw");
	cases.push_back(instances);

	Case triangles = { "counts", "no_triangles", "a primitive of two indices" };
	triangles.scene = [] {
		ImportedScene scene = parts::sheet(1, 1);
		scene.meshes[0].primitives[0].indices.resize(2);
		return scene;
	};
	triangles.expected = refused(ExitCode::BadInput, "has nothing to draw");
	cases.push_back(triangles);
}

void addOne(std::vector<Case>& cases)
{
	Case one = { "counts", "one_triangle", "one triangle, from coarse to fine" };
	one.scene = oneTriangle;
	one.rates = { 1000, 16, 2, 0 };
	one.also = hasTriangles(1);
	cases.push_back(one);
}

void addMany(std::vector<Case>& cases)
{
	Case thousand = { "counts", "instances_1000", "a thousand instances" };
	thousand.scene = [] {
		return field(parts::ball(1), 1000, 2.5);
	};
	thousand.cameras = [](const BuiltScene& scene) {
		return std::vector<NamedCamera>{ { "framing", framingCamera(scene) },
										 { "among them", parts::lookingAt({ 30, 1.5, -30 }, { 40, 0, -45 }, 70) } };
	};
	thousand.rates = { 8 };
	thousand.also = hasTriangles(12'000);
	cases.push_back(thousand);

	Case million = { "counts", "instances_1e6", "a million instances of one triangle" };
	million.quick = false;
	million.needs = { 2ull << 30, 12ull << 30, true };
	million.scene = [] {
		return field(oneTriangle(), 1'000'000, 3);
	};
	million.cameras = [](const BuiltScene& scene) {
		return std::vector<NamedCamera>{ { "framing", framingCamera(scene) },
										 { "among them", parts::lookingAt({ 1500, 2, -1500 }, { 1510, 0, -1520 }, 70) } };
	};
	million.rates = { 8 };
	million.also = hasTriangles(1'000'000);
	cases.push_back(million);

	Case triangles = { "counts", "triangles_1e7", "ten million triangles in one mesh" };
	triangles.quick = false;
	triangles.needs = { 8ull << 30, 48ull << 30, true };
	triangles.scene = [] {
		return parts::sheet(2500, 2000, 0.01f);
	};
	triangles.cameras = framingOnly;
	triangles.rates = { 8 };
	triangles.also = hasTriangles(10'000'000);
	cases.push_back(triangles);
}

// Lists of the smallest legal sizes: one at a time, and all together.
void addSmallLists(std::vector<Case>& cases)
{
	for (const char* name : { "part_triangles", "split_triangles", "visible_clusters", "full_clusters", "all" })
	{
		Case one = { "counts", fmt::format("least_{}", name), "a list of the smallest legal size, far too small for the frame" };
		one.scene = [] {
			return field(parts::ball(3), 4, 2.5);
		};
		one.cameras = framingOnly;
		one.rates = { 1 };
		for (const ListDesc& list : listDescs())
			if (list.name == name || (std::string_view(name) == "all" && !growsOnDemand(list)))
				one.options.capacities[std::string(list.name)] = list.least_capacity;
		one.also = hasTriangles(4 * 108);
		cases.push_back(one);
	}
}

}  // namespace

void addCountCases(std::vector<Case>& cases)
{
	addNone(cases);
	addOne(cases);
	addMany(cases);
	addSmallLists(cases);
}

}  // namespace tessera::verify
