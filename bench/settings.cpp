#include "bench/settings.h"

#include "app/option_text.h"

#include <algorithm>
#include <array>

namespace tessera::bench
{

namespace
{

constexpr std::string_view kScalingNames[] = { "triangles", "base", "instances", "size", "rays" };

// Shared options that the bench sets itself, row by row.
constexpr std::string_view kSwept[] = {
	"size", "rate", "raster", "cull", "grid", "grid-u", "grid-v", "eye", "target", "up", "fov", "camera", "strict"
};

// An option of the bench alone. `parse` says what would be right, without the option's name.
struct BenchOption
{
	std::string_view name, value, help;  // value in [brackets]: may be left out, and follows a '='
	Status (*parse)(Settings& settings, std::string_view text);
};

template <std::string Settings::*field>
Status parseText(Settings& settings, std::string_view text)
{
	if (text.empty())
		return fail(ExitCode::Usage, "a path is right");
	settings.*field = text;
	return {};
}

Status parseNames(std::span<const std::string_view> known, std::string_view text, std::vector<std::string>& names)
{
	names.clear();
	for (std::string_view name : splitAt(text, ','))
	{
		if (std::find(known.begin(), known.end(), name) == known.end())
			return fail(ExitCode::Usage, "some of {} is right, with commas between", joinNames(known));
		names.emplace_back(name);
	}
	return {};
}

Status parseScenes(Settings& settings, std::string_view text)
{
	settings.scene_names.clear();
	for (std::string_view name : splitAt(text, ','))
		settings.scene_names.emplace_back(name);
	return {};
}

Status parseRates(Settings& settings, std::string_view text)
{
	settings.rates.clear();
	for (std::string_view part : splitAt(text, ','))
	{
		const std::optional<double> rate = readNumber(part);
		if (!rate || *rate <= 0 || *rate > 1e6)
			return fail(ExitCode::Usage, "numbers above 0 and up to 1000000 are right, such as 3.46,1.73");
		settings.rates.push_back(static_cast<float>(*rate));
	}
	return {};
}

Status parseSizes(Settings& settings, std::string_view text)
{
	settings.sizes_px.clear();
	for (std::string_view part : splitAt(text, ','))
	{
		const auto size = readPair(part, 1, 65536);
		if (!size)
			return fail(ExitCode::Usage, "WIDTHxHEIGHT is right, with commas between, such as 1920x1080,3840x2160");
		settings.sizes_px.push_back(*size);
	}
	return {};
}

// The names of --raster: new ones appear by themselves.
std::vector<std::string_view> rasterNames()
{
	const Choice& choice = std::get<Choice>(findOption("raster")->field);
	std::vector<std::string_view> names(choice.names.begin(), choice.names.end());
	std::erase(names, "auto");
	return names;
}

Status parseRasters(Settings& settings, std::string_view text)
{
	return parseNames(rasterNames(), text, settings.rasters);
}

Status parseCull(Settings& settings, std::string_view text)
{
	if (text != "on" && text != "off" && text != "both")
		return fail(ExitCode::Usage, "on, off or both is right");
	settings.culls = text == "both" ? std::vector<bool>{ false, true } : std::vector<bool>{ text == "on" };
	return {};
}

Status parseScaling(Settings& settings, std::string_view text)
{
	if (!text.empty())
		return parseNames(kScalingNames, text, settings.scaling);
	// Rays only when asked for: not every device can trace any.
	for (std::string_view name : kScalingNames)
		if (name != "rays")
			settings.scaling.emplace_back(name);
	return {};
}

Status parseRowSeconds(Settings& settings, std::string_view text)
{
	const std::optional<double> seconds = readNumber(text);
	if (!seconds || *seconds <= 0)
		return fail(ExitCode::Usage, "a number above 0 is right");
	settings.row_seconds = *seconds;
	return {};
}

// Takes effect before every other option, so that those can change what it sets.
Status parseQuick(Settings& settings, std::string_view text)
{
	if (!text.empty())
		return fail(ExitCode::Usage, "takes no value");
	settings.quick = true;
	return {};
}

constexpr BenchOption kOptions[] = {
	{ "out", "FOLDER", "where tables go (default out/bench)", parseText<&Settings::out> },
	{ "scenes", "FOLDER", "the scenes; default: bench/scenes of a folder around the program", parseText<&Settings::scenes> },
	{ "peer", "FILE", "the peer's times; default: peer_h100.csv beside the scenes' folder, peer_lavapipe.csv for a processor",
	  parseText<&Settings::peer> },
	{ "compare", "FILE", "a table of an earlier run: ratios, and which rows got more than 10 % slower", parseText<&Settings::compare> },
	{ "scene", "LIST", "sphere,terrain or some of sphere-x1,sphere-x16,terrain-x1,terrain-x16 (default all)", parseScenes },
	{ "rates", "LIST", "pixels per segment (default 6.93,3.46,1.73,0.866,0.433: the peer's 8,4,2,1,0.5)", parseRates },
	{ "sizes", "LIST", "pictures (default 1920x1080,3840x2160)", parseSizes },
	{ "raster", "LIST", "who finds visibility (default all)", parseRasters },
	{ "cull", "on|off|both", "culling (default both)", parseCull },
	{ "scaling", "[LIST]", "instead of the table: time against some of triangles,base,instances,size,rays, each a table of its own", parseScaling },
	{ "row-seconds", "SECONDS", "a row that takes longer stops at the frames it has (default 30)", parseRowSeconds },
	{ "quick", "", "for slow devices: 640x360, rates 6.93 and 1.73, 8 frames after 2", parseQuick },
};

bool isSwept(std::string_view name)
{
	return std::find(std::begin(kSwept), std::end(kSwept), name) != std::end(kSwept);
}

std::string helpText()
{
	std::string text = "tessera_bench measures GPU time per frame: scenes x rates x sizes x raster paths x culling.\n\n"
					   "Usage: tessera_bench [OPTIONS]\n\n";
	const auto addLine = [&](std::string_view name, std::string_view value, std::string_view help) {
		const bool optional = value.starts_with('[');
		text += fmt::format("  {:<34}  {}\n", fmt::format("--{}{}{}", name, optional || value.empty() ? "" : " ", value), help);
	};
	for (const BenchOption& option : kOptions)
		addLine(option.name, option.value, option.help);
	text += "\nOptions that every row shares, as of tessera render (frames: 64, warmup: 16)\n";
	for (const OptionDesc& option : optionTable())
		if (!isSwept(option.name))
			addLine(option.name, option.value, option.help);
	return text;
}

// What a configuration without options measures.
Settings defaults(bool quick)
{
	Settings settings;
	settings.quick = quick;
	settings.rates = quick ? std::vector<float>{ 6.93f, 1.73f } : std::vector<float>{ 6.93f, 3.46f, 1.73f, 0.866f, 0.433f };
	using Sizes = std::vector<std::array<uint32_t, 2>>;
	settings.sizes_px = quick ? Sizes{ { 640, 360 } } : Sizes{ { 1920, 1080 }, { 3840, 2160 } };
	for (std::string_view name : rasterNames())
		settings.rasters.emplace_back(name);
	settings.culls = { false, true };
	settings.base.frames = quick ? 8 : 64;
	settings.base.warmup = quick ? 2 : 16;
	// Enough for every row of the table at the rate it asks for.
	settings.base.capacities = { { "part_triangles", 4'000'000 }, { "split_triangles", 1'000'000 } };
	return settings;
}

struct Argument
{
	std::string_view name, value;  // value: what follows '=', if any
	bool has_value = false;
};

Result<Argument> splitArgument(std::string_view text)
{
	if (!text.starts_with("--") || text.size() == 2)
		return fail(ExitCode::Usage, "{}: options start with --; `tessera_bench --help` lists them", text);
	text.remove_prefix(2);
	const size_t equals = text.find('=');
	if (equals == std::string_view::npos)
		return Argument{ text, {}, false };
	return Argument{ text.substr(0, equals), text.substr(equals + 1), true };
}

// Sets the option at arguments[i]; moves i to the value where that is an argument of its own.
Status parseArgument(const std::vector<std::string>& arguments, size_t& i, Settings& settings)
{
	TRY_ASSIGN(Argument argument, splitArgument(arguments[i]));
	const auto own = std::find_if(std::begin(kOptions), std::end(kOptions), [&](const BenchOption& o) { return o.name == argument.name; });
	const bool is_own = own != std::end(kOptions);
	const OptionDesc* shared = is_own || isSwept(argument.name) ? nullptr : findOption(argument.name);
	if (!is_own && !shared)
		return fail(ExitCode::Usage, "--{}: no such option; `tessera_bench --help` lists them", argument.name);
	const std::string_view value_name = is_own ? own->value : shared->value;
	if (!argument.has_value && !value_name.empty() && !value_name.starts_with('['))
	{
		if (i + 1 == arguments.size())
			return fail(ExitCode::Usage, "--{}: {} is missing", argument.name, value_name);
		argument.value = arguments[++i];
	}
	if (shared)
		return setOption(*shared, argument.value, settings.base);
	if (const Status status = own->parse(settings, argument.value); !status)
		return fail(status.error().code, "--{} {}: {}", argument.name, argument.value, status.error().message);
	return {};
}

}  // namespace

std::span<const std::string_view> scalingNames()
{
	return kScalingNames;
}

Result<Settings> parseSettings(const std::vector<std::string>& arguments)
{
	const auto given = [&](std::string_view argument) {
		return std::find(arguments.begin(), arguments.end(), argument) != arguments.end();
	};
	Settings settings = defaults(given("--quick"));
	if (given("--help") || given("-h"))
	{
		settings.help = helpText();
		return settings;
	}
	for (size_t i = 0; i < arguments.size(); ++i)
		TRY(parseArgument(arguments, i, settings));
	return settings;
}

}  // namespace tessera::bench
