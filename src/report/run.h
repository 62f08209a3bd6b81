// What a report is made from: settings that were tried and what came of each. Read from and written to JSON, one line per run.
#pragma once
#include "base/result.h"
#include "report/geometry_error.h"
#include "report/image_error.h"
#include "report/numerics.h"
#include "report/original_error.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tessera::report
{

// GPU times over frames, milliseconds.
struct TimeFigures
{
	double median = 0, min = 0, max = 0;
	double lower_quartile = 0, upper_quartile = 0;  // half of the frames lie between them: the spread
};
// All 0 without values.
TimeFigures timeFigures(std::vector<double> gpu_ms);

struct Setting
{
	double rate = 0;  // wanted, pixels per segment
	std::string raster;
	std::string metric = "edge";
	uint32_t width = 0, height = 0;
	std::string forced;  // what was kept though nothing needed it (--force), joined by '+'

	bool operator==(const Setting&) const = default;
	std::string label() const;  // "rate 4, soft, 1920x1080"
};

struct PassFigures
{
	std::string name;
	TimeFigures gpu_ms;
};

struct RunCounts
{
	uint64_t micro_triangles = 0, part_triangles = 0, split_triangles = 0, full_clusters = 0, visible_clusters = 0, covered_pixels = 0;
};

// The picture that a run's is compared with.
struct ReferencePicture
{
	double rate_wanted = 0, rate_granted = 0;
	uint64_t micro_triangles = 0;
	std::string picture;  // file, relative to the report

	bool operator==(const ReferencePicture&) const = default;
};

struct RunBytes
{
	uint64_t lists = 0, geometry = 0, textures = 0, images = 0;
	uint64_t total() const { return lists + geometry + textures + images; }
};

// Errors of the tessellated surface: they depend on rate and picture height, not on who draws it.
struct SurfaceErrors
{
	RegionError whole, visible;
	Numerics numerics;
	std::optional<AgainstOriginal> original;  // with --original
	uint64_t micro_triangles = 0;             // of the whole surface, nothing culled
	uint64_t reference_mesh_triangles = 0;    // of the mesh from which searches for nearest points start
};

struct Run
{
	Setting setting;
	std::string failure;  // why there is nothing else; empty: it was drawn
	double rate_granted = 0;
	bool every_factor_one = false;
	uint32_t rounds = 1;
	uint32_t cameras = 1;  // of a camera path: its keys; counts are their mean
	uint32_t frames = 0, warmup = 0;
	TimeFigures gpu_ms;
	std::vector<PassFigures> passes;  // in the frame's order
	RunCounts counts;
	RunBytes bytes;
	std::optional<SurfaceErrors> surface;  // none: too many micro-triangles to measure
	std::optional<ImageError> image;
	ReferencePicture reference;  // of `image`
	std::string picture, heat;   // PNG files, relative to the report

	bool isCoarsened() const { return every_factor_one || rate_granted > setting.rate; }
};

// What the errors along a camera path come to: of figures the largest `max`, the mean `p99` and the root mean square; the rest as of the worst
// camera. `cameras` is not empty.
SurfaceErrors alongPath(std::span<const SurfaceErrors> cameras);

nlohmann::json originalErrorJson(const OriginalError& error);
nlohmann::json runJson(const Run& run);
// Errors: BadInput (not such an object; `where` names it).
Result<Run> runFromJson(const nlohmann::json& json, const std::string& where);

}  // namespace tessera::report
