// Every option that the commands share: one table drives the command line, --help, the options in the stats, and what a change
// makes stale.
#pragma once
#include "base/result.h"
#include "base/vec.h"
#include "plan/render_options.h"

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tessera
{

// What the user asked for: RenderOptions is what a frame needs to know, the rest concerns scene, camera, device and output.
struct AppOptions : RenderOptions
{
	std::optional<dvec3> eye, target, up;  // world units; over what --camera or framing gives
	std::optional<double> fov_deg;         // vertical
	std::optional<double> near_world;
	std::optional<double> ortho_world;  // height of an orthographic view
	std::optional<uint32_t> camera;     // index into the scene's cameras
	uint32_t grid_columns = 1, grid_rows = 1;
	std::optional<dvec3> grid_u, grid_v;  // world units; absent: a little more than the scene's size
	std::vector<std::string> displacements;
	bool pn = false;          // base triangles are PN triangles
	std::string camera_path;  // file; empty: one camera
	uint32_t frames = 1, warmup = 0;
	// What a report tries (verify shares the rates), and what it is to recommend.
	std::vector<double> rates;                   // empty: ratesOf (list_options.h) has the default
	std::vector<Raster> rasters;                 // empty: `raster` alone
	std::vector<Metric> metrics;                 // empty: `metric` alone
	std::vector<std::array<uint32_t, 2>> sizes;  // empty: width_px x height_px alone
	std::optional<double> reference_rate;        // of the picture that the others are compared with
	std::string original;                        // file; empty: none
	std::optional<double> max_error_px, max_ms;
	bool resume = false;
	bool measure_left_out = true;  // report: draw with each thing forced on that the scene does not need
	std::string device;
	bool pipeline_statistics = false;
	bool validate = false, strict = false, quiet = false;
	uint32_t cluster_vertices = 64, cluster_triangles = 64;
	std::string table;  // file; empty: the table that is built in
};

// What a change of an option makes stale; each includes those before it.
enum class Rebuild : uint8_t
{
	Nothing,    // the next frame shows it
	Pipelines,  // shaders are specialised by it
	Buffers,    // lists and images are sized by it
	Scene,      // clusters, bounds or height maps are derived from it
	Device,
};

// One of several names.
struct Choice
{
	std::span<const std::string_view> names;
	size_t (*get)(const AppOptions& options);
	void (*set)(AppOptions& options, size_t index);
};

// A value with a syntax of its own. `print` gives what the command line would say, once per value of a repeatable option.
struct Custom
{
	Result<void> (*parse)(AppOptions& options, std::string_view text);  // Errors: what would be right, without the option's name
	std::vector<std::string> (*print)(const AppOptions& options);
	nlohmann::ordered_json (*json)(const AppOptions& options);
};

using OptionField =
	std::variant<bool AppOptions::*, uint32_t AppOptions::*, float AppOptions::*, std::string AppOptions::*, std::vector<std::string> AppOptions::*,
				 std::optional<uint32_t> AppOptions::*, std::optional<double> AppOptions::*, std::optional<dvec3> AppOptions::*, Choice, Custom>;

struct OptionDesc
{
	std::string_view name;   // without the dashes
	std::string_view value;  // what stands for the value in --help, with its unit; empty for switches
	std::string_view help;
	OptionField field;
	double least = 0, most = 0;  // accepted range of numbers, both ends included
	Rebuild rebuild = Rebuild::Nothing;
	bool repeatable = false;
};

std::span<const OptionDesc> optionTable();
const OptionDesc* findOption(std::string_view name);

// Sets one option from the command line's text ("" for a switch). Errors: Usage; one line with option, value and what is right.
Status setOption(const OptionDesc& option, std::string_view text, AppOptions& options);

// The values that setOption would take to give the same: none when an optional value is absent or a switch is off.
std::vector<std::string> printOption(const OptionDesc& option, const AppOptions& options);

// All options by name, with '_' for '-'; null where an optional value is absent.
nlohmann::ordered_json optionsJson(const AppOptions& options);

// Two columns: option and value, help with range and default.
std::string optionsHelp();

// The most that any difference between the two makes stale.
Rebuild staleAfter(const AppOptions& before, const AppOptions& after);

}  // namespace tessera
