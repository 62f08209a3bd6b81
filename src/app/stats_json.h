// What --stats writes: the schema of DESIGN.md, section 9, and more keys.
#pragma once
#include "app/options.h"
#include "frame/stats.h"
#include "gpu/device.h"
#include "plan/plan.h"
#include "scene/camera.h"
#include "scene/scene.h"

#include <filesystem>
#include <map>

namespace tessera
{

// Times of one thing over the frames that count.
struct TimeSeries
{
	std::vector<double> gpu_ms;

	double median() const;  // 0 when empty, as are least and most
	double least() const;
	double most() const;
};

// The frames of a run: times of all, everything else of the last.
struct FrameSeries
{
	TimeSeries frame;
	std::map<std::string, TimeSeries> passes;
	FrameResult last;
	uint64_t hidden_redraws = 0;  // of all frames

	void add(const FrameResult& result);
};

struct RunFacts
{
	const Device& device;
	const BuiltScene& scene;
	const AppOptions& options;
	const Camera& camera;
	const FramePlan& plan;
	const PlanInput& input;
	const FrameSeries& series;
	MemoryStats memory;
};

nlohmann::ordered_json statsJson(const RunFacts& facts);

nlohmann::ordered_json deviceJson(const Device& device);
nlohmann::ordered_json sceneJson(const BuiltScene& scene);

// Writes JSON to a file, or to standard output when `path` is "-". Errors: those of writeFile.
Status writeJson(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace tessera
