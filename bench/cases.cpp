#include "bench/cases.h"

#include "app/option_text.h"
#include "base/check.h"

#include <algorithm>
#include <cmath>

namespace tessera::bench
{

namespace
{

// A scene of bench/scenes and how it is looked at; bench/scenes/README.md says more.
struct BenchScene
{
	std::string_view name, file;
	dvec3 eye, target;
	uint32_t columns = 1, rows = 1;
	dvec3 u = dvec3(0), v = dvec3(0);  // copy (i, j) is moved by i * u + j * v
};

constexpr double kFovDegrees = 60;

const BenchScene kScenes[] = {
	{ "sphere", "sphere.gltf", { 1.4, 0.9, 1.6 }, { 0, 0, 0 } },
	{ "sphere", "sphere.gltf", { -3, 3, 8.2 }, { -3, 3, 0 }, 4, 4, { -2, 0, 0 }, { 0, 2, 0 } },
	{ "terrain", "terrain.gltf", { 0, 4.6, 9 }, { 0, -0.6, 0.6 } },
	{ "terrain", "terrain.gltf", { -15, 18.4, 21 }, { -15, -2.4, -12.6 }, 4, 4, { -10, 0, 0 }, { 0, 0, -10 } },
};

const BenchScene& kSphere = kScenes[0];
const BenchScene& kTerrain = kScenes[2];

// "sphere-x16"
std::string optionName(const BenchScene& scene)
{
	return fmt::format("{}-x{}", scene.name, scene.columns * scene.rows);
}

Result<std::vector<const BenchScene*>> chosenScenes(const Settings& settings)
{
	std::vector<const BenchScene*> chosen;
	if (settings.scene_names.empty())
		for (const BenchScene& scene : kScenes)
			chosen.push_back(&scene);
	for (const std::string& name : settings.scene_names)
	{
		const size_t before = chosen.size();
		for (const BenchScene& scene : kScenes)
			if (name == scene.name || name == optionName(scene))
				chosen.push_back(&scene);
		if (chosen.size() == before)
			return fail(ExitCode::Usage, "--scene {}: sphere, terrain, sphere-x1, sphere-x16, terrain-x1, terrain-x16 are right", name);
	}
	return chosen;
}

void setOrDie(std::string_view option, std::string_view value, AppOptions& options)
{
	const Status status = setOption(*findOption(option), value, options);
	CHECK(status, "--{} {}: {}", option, value, status.error().message);
}

// The four corners that every row has: who rasters, culling, size, rate.
Case makeCase(const Settings& settings, std::string_view series, const std::string& raster, bool cull, std::array<uint32_t, 2> size_px, float rate)
{
	Case row;
	row.series = series;
	row.raster = raster;
	row.cull = cull;
	row.options = settings.base;
	setOrDie("raster", raster, row.options);
	setOrDie("cull", cull ? "on" : "off", row.options);
	row.options.width_px = size_px[0];
	row.options.height_px = size_px[1];
	row.options.rate = rate;
	return row;
}

void lookAt(Case& row, const BenchScene& scene)
{
	row.scene = scene.name;
	row.path = scene.file;
	row.copies = uint64_t(scene.columns) * scene.rows;
	row.options.eye = scene.eye;
	row.options.target = scene.target;
	row.options.fov_deg = kFovDegrees;
	row.options.grid_columns = scene.columns;
	row.options.grid_rows = scene.rows;
	row.options.grid_u = scene.u;
	row.options.grid_v = scene.v;
}

// One step of a sweep, for every raster path and culling.
template <typename Aim>
void addStep(const Settings& settings, std::string_view series, std::array<uint32_t, 2> size_px, float rate, Aim aim, std::vector<Case>& cases)
{
	for (const std::string& raster : settings.rasters)
		for (const bool cull : settings.culls)
		{
			Case row = makeCase(settings, series, raster, cull, size_px, rate);
			aim(row);
			cases.push_back(std::move(row));
		}
}

constexpr std::array<uint32_t, 2> kFullHd = { 1920, 1080 }, kSmall = { 640, 360 };
constexpr float kSweepRate = 3.46f;

// At 1920x1080 the terrain gives about 2.2 million micro-triangles / rate^2: half decades from 1e4 to 1e9.
void addTriangleSweep(const Settings& settings, std::vector<Case>& cases)
{
	const int steps = settings.quick ? 3 : 11;
	const double first_rate = settings.quick ? 14.0 / 3 : 14.0;
	for (int i = 0; i < steps; ++i)
	{
		// Three digits, so that a row reads as one could type it.
		const float rate = static_cast<float>(*readNumber(fmt::format("{:.3g}", first_rate * std::pow(10, -i / 4.0))));
		addStep(
			settings, "triangles", settings.quick ? kSmall : kFullHd, rate, [](Case& row) { lookAt(row, kTerrain); }, cases);
	}
}

// The same terrain, shadowed: 1e4 to 1e7 micro-triangles built into what rays are traced through, whoever finds visibility.
void addRaySweep(const Settings& settings, std::vector<Case>& cases)
{
	const int steps = settings.quick ? 2 : 7;
	for (int i = 0; i < steps; ++i)
	{
		const float rate = static_cast<float>(*readNumber(fmt::format("{:.3g}", 14.0 * std::pow(10, -i / 4.0))));
		const auto aim = [](Case& row) {
			lookAt(row, kTerrain);
			row.options.shadows = true;
			row.options.ao_samples = std::max(1u, row.options.ao_samples);
		};
		addStep(settings, "rays", settings.quick ? kSmall : kFullHd, rate, aim, cases);
	}
}

void addInstanceSweep(const Settings& settings, std::vector<Case>& cases)
{
	const uint32_t most = settings.quick ? 1000 : 1'000'000;
	for (uint32_t count = 1; count <= most; count *= 10)
	{
		const auto aim = [count](Case& row) {
			row.scene = "builtin:instances";
			row.path = fmt::format("builtin:instances:{}", count);
			row.copies = count;
		};
		addStep(settings, "instances", settings.quick ? kSmall : kFullHd, kSweepRate, aim, cases);
	}
}

// A denser and denser mesh of the same terrain: half decades from 1e3 base triangles on. From 1e6 on most have one segment per edge.
void addBaseSweep(const Settings& settings, std::vector<Case>& cases)
{
	for (const uint32_t quads : settings.quick ? std::vector<uint32_t>{ 22, 71, 224 } : std::vector<uint32_t>{ 22, 71, 224, 707, 2236 })
	{
		const auto aim = [quads](Case& row) {
			row.scene = row.path = fmt::format("builtin:terrain:{}", quads);
			row.base_triangles = 2ull * quads * quads;
		};
		addStep(settings, "base", settings.quick ? kSmall : kFullHd, kSweepRate, aim, cases);
	}
}

void addSizeSweep(const Settings& settings, std::vector<Case>& cases)
{
	const uint32_t most = settings.quick ? 360 : 4320;
	for (uint32_t height = settings.quick ? 90 : 270; height <= most; height *= 2)
		addStep(
			settings, "size", { height * 16 / 9, height }, kSweepRate, [](Case& row) { lookAt(row, kSphere); }, cases);
}

}  // namespace

std::string Case::sceneLabel() const
{
	return fmt::format("{} x{}", scene, copies);
}

std::string Case::label() const
{
	return fmt::format("{} {}x{} {} cull {} rate {}", sceneLabel(), options.width_px, options.height_px, raster, cull ? "on" : "off", options.rate);
}

Result<std::vector<Case>> tableCases(const Settings& settings)
{
	TRY_ASSIGN(const std::vector<const BenchScene*> scenes, chosenScenes(settings));
	std::vector<Case> cases;
	for (const BenchScene* scene : scenes)
		for (const std::string& raster : settings.rasters)
			for (const bool cull : settings.culls)
				for (const std::array<uint32_t, 2> size_px : settings.sizes_px)
					for (const float rate : settings.rates)
					{
						Case row = makeCase(settings, kTableSeries, raster, cull, size_px, rate);
						lookAt(row, *scene);
						cases.push_back(std::move(row));
					}
	return cases;
}

std::vector<Case> scalingCases(const Settings& settings)
{
	std::vector<Case> cases;
	for (const std::string& name : settings.scaling)
	{
		if (name == "triangles")
			addTriangleSweep(settings, cases);
		else if (name == "rays")
			addRaySweep(settings, cases);
		else if (name == "base")
			addBaseSweep(settings, cases);
		else if (name == "instances")
			addInstanceSweep(settings, cases);
		else
			addSizeSweep(settings, cases);
	}
	return cases;
}

}  // namespace tessera::bench
