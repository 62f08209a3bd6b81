#include "app/options.h"

#include "app/list_options.h"
#include "app/option_text.h"
#include "frame/frame_resources.h"
#include "frame/lists.h"
#include "pipeline/passes.h"
#include "plan/forced.h"

#include <algorithm>
#include <array>

namespace tessera
{

using nlohmann::ordered_json;

namespace
{

constexpr uint32_t kMostExtent = 65536;  // of a picture; the device may take less
constexpr uint32_t kMostCopies = 4096;   // of the scene, per direction
constexpr double kMostLength = 1e30;     // world units
constexpr double kMostShown = 1e9;       // ranges that end higher are left out of --help

constexpr std::string_view kOffOnNames[] = { "off", "on" };
constexpr std::string_view kShadingNames[] = { "smooth", "flat" };
constexpr std::string_view kViewNames[] = { "shaded", "clusters", "parts",     "triangles", "factors",    "depth", "normals", "wireframe",
											"facets", "height",   "instances", "materials", "primitives", "area",  "error" };

template <auto field>
constexpr Choice choiceOf(std::span<const std::string_view> names)
{
	using Enum = std::remove_cvref_t<decltype(std::declval<AppOptions>().*field)>;
	return { names, [](const AppOptions& options) { return static_cast<size_t>(options.*field); },
			 [](AppOptions& options, size_t index) {
				 options.*field = static_cast<Enum>(index);
			 } };
}

template <auto first, auto second>
std::vector<std::string> printPair(const AppOptions& options)
{
	return { fmt::format("{}x{}", options.*first, options.*second) };
}

template <auto first, auto second>
ordered_json pairJson(const AppOptions& options)
{
	return { options.*first, options.*second };
}

template <auto first, auto second, uint32_t most>
Status parsePair(AppOptions& options, std::string_view text)
{
	const auto pair = readPair(text, 1, most);
	if (!pair)
		return fail(ExitCode::Usage, "two numbers from 1 to {} are right, such as {}", most, printPair<first, second>({})[0]);
	options.*first = (*pair)[0];
	options.*second = (*pair)[1];
	return {};
}

template <auto first, auto second, uint32_t most>
constexpr Custom pairOf()
{
	return { parsePair<first, second, most>, printPair<first, second>, pairJson<first, second> };
}

Status parseClusterSize(AppOptions& options, std::string_view text)
{
	const auto size = readPair(text, 3, 128);
	if (!size || (*size)[1] % 4 != 0)
		return fail(ExitCode::Usage, "VERTICESxTRIANGLES is right: 3 to 128 vertices, 4 to 128 triangles, a multiple of 4, such as 64x64");
	options.cluster_vertices = (*size)[0];
	options.cluster_triangles = (*size)[1];
	return {};
}

struct CullKind
{
	std::string_view name;
	bool CullOptions::*field;
};
constexpr CullKind kCullKinds[] = { { "frustum", &CullOptions::frustum },
									{ "backface", &CullOptions::backface },
									{ "occlusion", &CullOptions::occlusion } };

Status parseCull(AppOptions& options, std::string_view text)
{
	CullOptions cull = { text == "on", text == "on", text == "on" };
	if (text != "on" && text != "off")
		for (std::string_view part : splitAt(text, ','))
		{
			const auto kind = std::find_if(std::begin(kCullKinds), std::end(kCullKinds), [&](const CullKind& k) { return k.name == part; });
			if (kind == std::end(kCullKinds))
				return fail(ExitCode::Usage, "on, off, or some of frustum,backface,occlusion is right");
			cull.*kind->field = true;
		}
	options.cull = cull;
	return {};
}

std::vector<std::string> cullKinds(const AppOptions& options)
{
	std::vector<std::string> kinds;
	for (const CullKind& kind : kCullKinds)
		if (options.cull.*kind.field)
			kinds.emplace_back(kind.name);
	return kinds;
}

std::vector<std::string> printCull(const AppOptions& options)
{
	const std::vector<std::string> kinds = cullKinds(options);
	if (kinds.size() == std::size(kCullKinds))
		return { "on" };
	return { kinds.empty() ? "off" : fmt::format("{}", fmt::join(kinds, ",")) };
}

Status parseCapacity(AppOptions& options, std::string_view text)
{
	const size_t equals = text.find('=');
	const ListDesc* list = findList(text.substr(0, equals));
	if (equals == std::string_view::npos || !list)
	{
		std::vector<std::string_view> names;
		for (const ListDesc& desc : listDescs())
			names.push_back(desc.name);
		return fail(ExitCode::Usage, "NAME=COUNT is right, NAME one of {}", joinNames(names));
	}
	const std::optional<uint32_t> count = readCount(text.substr(equals + 1), list->least_capacity, mostEntries(*list));
	if (!count)
		return fail(ExitCode::Usage, "{} can hold from {} to {} entries", list->name, list->least_capacity, mostEntries(*list));
	options.capacities[std::string(list->name)] = *count;
	return {};
}

std::vector<std::string> printCapacities(const AppOptions& options)
{
	std::vector<std::string> values;
	for (const auto& [name, count] : options.capacities)
		values.push_back(fmt::format("{}={}", name, count));
	return values;
}

ordered_json capacitiesJson(const AppOptions& options)
{
	ordered_json json = ordered_json::object();
	for (const auto& [name, count] : options.capacities)
		json[name] = count;
	return json;
}

Status parseBudget(AppOptions& options, std::string_view text)
{
	const std::optional<uint64_t> bytes = readBytes(text);
	if (!bytes)
		return fail(ExitCode::Usage, "a number of bytes is right, such as 64MB or 1.5GiB");
	options.lists_bytes = *bytes;
	return {};
}

std::vector<std::string> printBudget(const AppOptions& options)
{
	return options.lists_bytes > 0 ? std::vector{ printBytes(options.lists_bytes) } : std::vector<std::string>();
}

ordered_json budgetJson(const AppOptions& options)
{
	return options.lists_bytes > 0 ? ordered_json(options.lists_bytes) : ordered_json();
}

Status parseForced(AppOptions& options, std::string_view text)
{
	const std::vector<std::string_view> names = forceNames(framePasses(), resourceDescs());
	for (const std::string_view name : splitAt(text, ','))
	{
		if (std::find(names.begin(), names.end(), name) == names.end())
			return fail(ExitCode::Usage, "the name of a pass, a shader feature or a resource is right: {}", joinNames(names));
		options.forced.emplace_back(name);
	}
	return {};
}

const std::array kTable = {
	OptionDesc{ "size", "WxH", "picture, in pixels", pairOf<&AppOptions::width_px, &AppOptions::height_px, kMostExtent>(), 0, 0, Rebuild::Buffers },
	OptionDesc{ "eye", "X,Y,Z", "where the camera is, in world units", &AppOptions::eye },
	OptionDesc{ "target", "X,Y,Z", "what the camera looks at; default with --eye: the middle of the scene", &AppOptions::target },
	OptionDesc{ "up", "X,Y,Z", "what is up in the picture", &AppOptions::up },
	OptionDesc{ "fov", "DEGREES", "vertical field of view", &AppOptions::fov_deg, 0.01, 179 },
	OptionDesc{ "ortho", "HEIGHT", "orthographic view of this height, in world units; default: perspective, or as the camera of the file is",
				&AppOptions::ortho_world, 1e-30, kMostLength },
	OptionDesc{ "near", "DISTANCE", "nothing nearer is drawn; default: radius of the scene / 1000", &AppOptions::near_world, 1e-6, kMostLength },
	OptionDesc{ "camera", "N", "the scene's N-th camera, from 0; default: frame the scene, built-in scenes use their own", &AppOptions::camera, 0,
				4e9 },
	OptionDesc{ "grid", "COLUMNSxROWS", "copies of the scene; geometry is shared",
				pairOf<&AppOptions::grid_columns, &AppOptions::grid_rows, kMostCopies>(), 0, 0, Rebuild::Scene },
	OptionDesc{ "grid-u", "X,Y,Z", "step from column to column; default: a little more than the scene's width along x", &AppOptions::grid_u, 0, 0,
				Rebuild::Scene },
	OptionDesc{ "grid-v", "X,Y,Z", "step from row to row; default: a little more than the scene's depth along -z", &AppOptions::grid_v, 0, 0,
				Rebuild::Scene },
	OptionDesc{ "rate", "PIXELS", "tessellation rate: wanted segment length; 0 = do not tessellate", &AppOptions::rate, 0, 1e6, Rebuild::Pipelines },
	OptionDesc{
		"metric", "NAME",
		"what decides the segments of an edge: its length over its distance; the displaced length as it is seen; or length over distance, and "
		"fewer where the displaced surface is straight",
		choiceOf<&AppOptions::metric>(kMetricNames), 0, 0, Rebuild::Scene },
	OptionDesc{ "raster", "NAME", "who finds visibility; auto takes what measured fastest for the device and the rate",
				choiceOf<&AppOptions::raster>(kRasterNames), 0, 0, Rebuild::Buffers },
	OptionDesc{ "cull", "on|off|LIST", "kinds of culling: frustum,backface,occlusion",
				Custom{ parseCull, printCull,
						[](const AppOptions& options) {
							return ordered_json(cullKinds(options));
						} },
				0, 0, Rebuild::Pipelines },
	OptionDesc{ "max-split", "PIECES", "most pieces per edge in one split", &AppOptions::max_split, 2, 11, Rebuild::Pipelines },
	OptionDesc{ "capacity", "NAME=COUNT", "entries that one list holds (for tests and memory limits)",
				Custom{ parseCapacity, printCapacities, capacitiesJson }, 0, 0, Rebuild::Buffers, true },
	OptionDesc{ "budget", "BYTES", "memory of all lists together, such as 64MB; they then have fixed sizes within it",
				Custom{ parseBudget, printBudget, budgetJson }, 0, 0, Rebuild::Buffers },
	OptionDesc{ "force", "NAME,...",
				"run, compile in or upload what the scene does not need (see info --print-plan): passes, shader features, resources. The picture "
				"stays as it is; stats and reports show what it costs",
				Custom{ parseForced, [](const AppOptions& options) { return options.forced; },
						[](const AppOptions& options) {
							return ordered_json(options.forced);
						} },
				0, 0, Rebuild::Buffers, true },
	OptionDesc{ "displacement", "IMAGE[:FACTOR[:OFFSET[:MATERIAL]]]", "height map for a material, or for all", &AppOptions::displacements, 0, 0,
				Rebuild::Scene, true },
	OptionDesc{ "displacement-scale", "SCALE", "scales every displacement; 0 = none", &AppOptions::displacement_scale, -1e6, 1e6,
				Rebuild::Pipelines },
	OptionDesc{ "displacement-offset", "X", "added to every displacement before it is scaled, in mesh units", &AppOptions::displacement_offset, -1e6,
				1e6 },
	OptionDesc{ "pn", "on|off", "PN triangles: the base surface is curved between the directions of its vertices; hard edges become round",
				choiceOf<&AppOptions::pn>(kOffOnNames), 0, 0, Rebuild::Scene },
	OptionDesc{ "view", "NAME", "what the picture shows", choiceOf<&AppOptions::view>(kViewNames), 0, 0, Rebuild::Pipelines },
	OptionDesc{ "wireframe", "", "sides of micro-triangles, and of base triangles in orange, over whatever the view shows", &AppOptions::wireframe, 0,
				0, Rebuild::Pipelines },
	OptionDesc{ "shading", "NAME", "normals of the shaded view: smooth under any rate, or flat per micro-triangle",
				Choice{ kShadingNames, [](const AppOptions& options) { return size_t(options.smooth_normals ? 0 : 1); },
						[](AppOptions& options, size_t index) {
							options.smooth_normals = index == 0;
						} },
				0, 0, Rebuild::Pipelines },
	OptionDesc{ "shadows", "on|off", "the sun's light is traced by rays (needs a device with ray tracing pipelines)",
				choiceOf<&AppOptions::shadows>(kOffOnNames), 0, 0, Rebuild::Buffers },
	OptionDesc{ "ao", "SAMPLES", "ambient occlusion: rays per pixel; 0 = none", &AppOptions::ao_samples, 0, 4096, Rebuild::Buffers },
	OptionDesc{ "ao-radius", "DISTANCE", "what is farther does not occlude, in world units; 0 = a tenth of the scene's radius",
				&AppOptions::ao_radius_world, 0, kMostLength },
	OptionDesc{ "ray-falloff", "X",
				"with shadows or ambient occlusion: how fast segments grow with how far out of view they lie; 0 = as fine there as in view",
				&AppOptions::ray_falloff, 0, 1000, Rebuild::Pipelines },
	OptionDesc{ "ray-hidden", "on|off", "and so, over some frames, on instances that something hides; off = every frame is as the first",
				choiceOf<&AppOptions::ray_hidden>(kOffOnNames), 0, 0, Rebuild::Pipelines },
	OptionDesc{ "rays", "NAME",
				"what rays' structures are built from: clusters and templates, all triangles at once (khr), or clusters where the device can (auto)",
				choiceOf<&AppOptions::ray_path>(kRayPathNames), 0, 0, Rebuild::Buffers },
	OptionDesc{ "ray-sharing", "on|off",
				"rays meet untessellated instances in one structure per mesh, made once; off: all triangles of a frame in one structure of its own",
				choiceOf<&AppOptions::ray_sharing>(kOffOnNames), 0, 0, Rebuild::Buffers },
	OptionDesc{ "transient-1x1x1", "on|off",
				"rays' clusters: triangles of factor 1 in a cluster that is tessellated elsewhere are built together, else each from its pattern",
				choiceOf<&AppOptions::transient_units>(kOffOnNames), 0, 0, Rebuild::Pipelines },
	OptionDesc{ "transient-2x2x2", "on|off", "rays' clusters: triangles of factors up to 2 are built in groups, else each from its pattern",
				choiceOf<&AppOptions::transient_groups>(kOffOnNames), 0, 0, Rebuild::Pipelines },
	OptionDesc{ "transient-build", "NAME", "rays' clusters: what the driver is told of those two",
				choiceOf<&AppOptions::transient_build>(kBuildPreferenceNames), 0, 0, Rebuild::Buffers },
	OptionDesc{ "position-truncation", "BITS", "rays' clusters: bits that positions may lose, for memory; only 0 is exact",
				&AppOptions::truncated_bits, 0, kMostTruncatedBits, Rebuild::Buffers },
	OptionDesc{ "max-cluster-data", "MB", "rays' clusters: memory of a frame's; a frame that needs more is drawn coarser",
				&AppOptions::most_cluster_mib, 1, 1u << 20, Rebuild::Buffers },
	OptionDesc{ "max-cluster-vertices", "COUNT", "rays' clusters: vertices of a frame's; a frame that needs more is drawn coarser",
				&AppOptions::most_cluster_vertices, kLeastClusterVertices, 0x0fffffff, Rebuild::Buffers },
	OptionDesc{ "cluster-size", "VERTICESxTRIANGLES", "most of each in a cluster, up to 128x128",
				Custom{ parseClusterSize, printPair<&AppOptions::cluster_vertices, &AppOptions::cluster_triangles>,
						pairJson<&AppOptions::cluster_vertices, &AppOptions::cluster_triangles> },
				0, 0, Rebuild::Scene },
	OptionDesc{ "table", "FILE", "tessellation table; default: the built-in one", &AppOptions::table, 0, 0, Rebuild::Buffers },
	OptionDesc{ "camera-path", "FILE",
				"cameras over time (JSON): render spreads --frames over it and writes one picture each where -o has ####, view plays it",
				&AppOptions::camera_path },
	OptionDesc{ "frames", "N", "frames to draw and time", &AppOptions::frames, 1, 1e6 },
	OptionDesc{ "warmup", "N", "frames to draw before those; on a GPU more, until its clock rests", &AppOptions::warmup, 0, 1e6 },
	OptionDesc{ "rates", "LIST", "rates that report tries (default: 16,8,4,2,1,0.5) and verify checks (default: that of --rate)", kRatesOption },
	OptionDesc{ "rasters", "LIST", "report: raster paths to try; default: that of --raster", kRastersOption },
	OptionDesc{ "metrics", "LIST", "report: metrics to try; default: that of --metric", kMetricsOption, 0, 0, Rebuild::Scene },
	OptionDesc{ "sizes", "LIST", "report: pictures to try; default: that of --size", kSizesOption },
	OptionDesc{ "reference-rate", "PIXELS", "report: rate of the picture that the others are compared with; default: half the finest of --rates",
				&AppOptions::reference_rate, 1e-3, 1e6 },
	OptionDesc{
		"original", "FILE",
		"report: measure against this model, too: the one that the height maps were made from (glTF, not displaced, in the place of the scene)",
		&AppOptions::original },
	OptionDesc{ "max-error-px", "PIXELS",
				"render: take the coarsest rate whose largest error seen is at most this; report: recommend the cheapest such setting",
				&AppOptions::max_error_px, 0, 1e6 },
	OptionDesc{ "max-ms", "MS",
				"render: keep each frame's GPU time at or below this at the finest rate that does; report: recommend the most exact setting that "
				"takes at most this",
				&AppOptions::max_ms, 1e-3, 1e6 },
	OptionDesc{ "measure-left-out", "on|off",
				"report: measure what leaving out saves, by drawing with everything forced on (--force) that the scene does not need, one after the "
				"other",
				choiceOf<&AppOptions::measure_left_out>(kOffOnNames) },
	OptionDesc{ "resume", "", "report: go on with an interrupted one; runs that are there are not done again", &AppOptions::resume },
	OptionDesc{ "device", "NAME|N", "part of a device's name, or its number; default: the fastest kind there is", &AppOptions::device, 0, 0,
				Rebuild::Device },
	OptionDesc{ "pipelines", "", "print what the driver compiled each compute pipeline to: registers, shared memory",
				&AppOptions::pipeline_statistics, 0, 0, Rebuild::Device },
	OptionDesc{ "validate", "", "run under the Vulkan validation layer; any message: exit code 6", &AppOptions::validate, 0, 0, Rebuild::Device },
	OptionDesc{ "strict", "", "do not coarsen a frame whose lists would overflow: exit code 5", &AppOptions::strict },
	OptionDesc{ "quiet", "", "warnings and errors only", &AppOptions::quiet },
};

template <typename... Cases>
struct Overload : Cases...
{
	using Cases::operator()...;
};
template <typename... Cases>
Overload(Cases...) -> Overload<Cases...>;  // Clang deduces no aggregates before version 17

template <typename... Args>
Status wrong(const OptionDesc& option, std::string_view text, fmt::format_string<Args...> format, Args&&... args)
{
	return fail(ExitCode::Usage, "--{} {}: {}", option.name, text, fmt::format(format, std::forward<Args>(args)...));
}

Status setCount(const OptionDesc& option, std::string_view text, uint32_t& value)
{
	const auto least = static_cast<uint32_t>(option.least), most = static_cast<uint32_t>(option.most);
	const std::optional<uint32_t> count = readCount(text, least, most);
	if (!count)
		return wrong(option, text, "a whole number from {} to {} is right", least, most);
	value = *count;
	return {};
}

Result<double> numberFor(const OptionDesc& option, std::string_view text)
{
	const std::optional<double> number = readNumber(text);
	if (!number || *number < option.least || *number > option.most)
		TRY(wrong(option, text, "a number from {} to {} is right", option.least, option.most));
	return *number;
}

Status setChoice(const OptionDesc& option, std::string_view text, const Choice& choice, AppOptions& options)
{
	const auto found = std::find(choice.names.begin(), choice.names.end(), text);
	if (found == choice.names.end())
		return wrong(option, text, "{}{} is right", choice.names.size() > 1 ? "one of " : "", joinNames(choice.names));
	choice.set(options, static_cast<size_t>(found - choice.names.begin()));
	return {};
}

ordered_json optionJson(const OptionDesc& option, const AppOptions& options)
{
	return std::visit(
		Overload{
			[&](float AppOptions::*field) { return ordered_json(shortest(options.*field)); },
			[&](const Choice& choice) { return ordered_json(choice.names[choice.get(options)]); },
			[&](const Custom& custom) { return custom.json(options); },
			[&](std::optional<dvec3> AppOptions::*field) {
				const std::optional<dvec3>& vector = options.*field;
				return vector ? ordered_json{ vector->x, vector->y, vector->z } : ordered_json();
			},
			[&]<typename T>(std::optional<T> AppOptions::*field) { return options.*field ? ordered_json(*(options.*field)) : ordered_json(); },
			[&](auto field) { return ordered_json(options.*field); },
		},
		option.field);
}

std::string jsonKey(std::string_view name)
{
	std::string key(name);
	std::replace(key.begin(), key.end(), '-', '_');
	return key;
}

// " (default 4; 0 to 1000000)"; choices are listed.
std::string remarks(const OptionDesc& option)
{
	std::vector<std::string> parts;
	if (const Choice* choice = std::get_if<Choice>(&option.field); choice && choice->names.size() > 1)
		parts.push_back(joinNames(choice->names));
	if (option.most > option.least && option.most < kMostShown)
		parts.push_back(fmt::format("{} to {}", option.least, option.most));
	const std::vector<std::string> values = printOption(option, {});
	if (values.size() == 1 && !values[0].empty())
		parts.push_back("default " + values[0]);
	if (option.repeatable)
		parts.emplace_back("repeatable");
	return parts.empty() ? "" : fmt::format(" ({})", fmt::join(parts, "; "));
}

// Cuts at blanks into lines of at most `width`; at least one line.
std::vector<std::string> wrap(std::string_view text, size_t width)
{
	std::vector<std::string> lines = { "" };
	for (std::string_view word : splitAt(text, ' '))
	{
		if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width)
			lines.emplace_back();
		else if (!lines.back().empty())
			lines.back() += ' ';
		lines.back() += word;
	}
	return lines;
}

}  // namespace

std::span<const OptionDesc> optionTable()
{
	return kTable;
}

const OptionDesc* findOption(std::string_view name)
{
	const auto found = std::find_if(kTable.begin(), kTable.end(), [&](const OptionDesc& option) { return option.name == name; });
	return found == kTable.end() ? nullptr : &*found;
}

Status setOption(const OptionDesc& option, std::string_view text, AppOptions& options)
{
	return std::visit(Overload{
						  [&](bool AppOptions::*field) -> Status {
							  options.*field = true;
							  return {};
						  },
						  [&](uint32_t AppOptions::*field) { return setCount(option, text, options.*field); },
						  [&](std::optional<uint32_t> AppOptions::*field) { return setCount(option, text, (options.*field).emplace()); },
						  [&](float AppOptions::*field) -> Status {
							  TRY_ASSIGN(const double number, numberFor(option, text));
							  options.*field = static_cast<float>(number);
							  return {};
						  },
						  [&](std::optional<double> AppOptions::*field) -> Status {
							  TRY_ASSIGN(options.*field, numberFor(option, text));
							  return {};
						  },
						  [&](std::optional<dvec3> AppOptions::*field) -> Status {
							  options.*field = readVector(text);
							  return options.*field ? Status() : wrong(option, text, "three numbers are right, such as 0,1.5,-2");
						  },
						  [&](std::string AppOptions::*field) -> Status {
							  options.*field = text;
							  return text.empty() ? wrong(option, "\"\"", "{} is right", option.value) : Status();
						  },
						  [&](std::vector<std::string> AppOptions::*field) -> Status {
							  (options.*field).emplace_back(text);
							  return text.empty() ? wrong(option, "\"\"", "{} is right", option.value) : Status();
						  },
						  [&](const Choice& choice) { return setChoice(option, text, choice, options); },
						  [&](const Custom& custom) -> Status {
							  const Status status = custom.parse(options, text);
							  return status ? status : wrong(option, text, "{}", status.error().message);
						  },
					  },
					  option.field);
}

std::vector<std::string> printOption(const OptionDesc& option, const AppOptions& options)
{
	using Values = std::vector<std::string>;
	return std::visit(
		Overload{
			[&](bool AppOptions::*field) { return options.*field ? Values{ "" } : Values{}; },
			[&](const Choice& choice) { return Values{ std::string(choice.names[choice.get(options)]) }; },
			[&](const Custom& custom) { return custom.print(options); },
			[&](std::vector<std::string> AppOptions::*field) { return options.*field; },
			[&](std::string AppOptions::*field) { return (options.*field).empty() ? Values{} : Values{ options.*field }; },
			[&](std::optional<dvec3> AppOptions::*field) { return options.*field ? Values{ printVector(*(options.*field)) } : Values{}; },
			[&]<typename T>(std::optional<T> AppOptions::*field) {
				return options.*field ? Values{ fmt::format("{}", *(options.*field)) } : Values{};
			},
			[&](auto field) { return Values{ fmt::format("{}", options.*field) }; },
		},
		option.field);
}

ordered_json optionsJson(const AppOptions& options)
{
	ordered_json json;
	for (const OptionDesc& option : kTable)
		json[jsonKey(option.name)] = optionJson(option, options);
	return json;
}

std::string optionsHelp()
{
	constexpr size_t kColumn = 32, kWidth = 88;  // where the help starts, and its width
	std::string text;
	for (const OptionDesc& option : kTable)
	{
		const std::string head = fmt::format("  --{} {}", option.name, option.value);
		const std::vector<std::string> lines = wrap(fmt::format("{}{}", option.help, remarks(option)), kWidth);
		text += head.size() + 2 > kColumn ? fmt::format("{}\n{:<{}}{}\n", head, "", kColumn, lines[0])
										  : fmt::format("{:<{}}{}\n", head, kColumn, lines[0]);
		for (size_t i = 1; i < lines.size(); ++i)
			text += fmt::format("{:<{}}{}\n", "", kColumn, lines[i]);
	}
	return text;
}

Rebuild staleAfter(const AppOptions& before, const AppOptions& after)
{
	Rebuild most = Rebuild::Nothing;
	for (const OptionDesc& option : kTable)
		if (optionJson(option, before) != optionJson(option, after))
			most = std::max(most, option.rebuild);
	return most;
}

}  // namespace tessera
