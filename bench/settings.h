// The bench's command line.
#pragma once
#include "app/options.h"

namespace tessera::bench
{

struct Settings
{
	std::string out = "out/bench";  // folder
	std::string scenes;             // folder; empty: found from where the program lies
	std::string peer;               // file; empty: beside the scenes, by the kind of device
	std::string compare;            // file; empty: nothing is compared
	std::vector<std::string> scene_names;
	std::vector<float> rates;  // pixels per segment
	std::vector<std::array<uint32_t, 2>> sizes_px;
	std::vector<std::string> rasters;  // names of --raster, never "auto"
	std::vector<bool> culls;           // on and off, as --cull
	std::vector<std::string> scaling;  // empty: the table; else which sweeps
	double row_seconds = 30;           // a row that takes longer stops at the frames it has
	bool quick = false;
	AppOptions base;  // shared options that are not swept; frames and warm-up

	std::string help;  // not empty: print this and stop
};

// Names that --scaling knows.
std::span<const std::string_view> scalingNames();

// `arguments` without the program's name. Errors: Usage, one line that names the argument and says what would be right.
Result<Settings> parseSettings(const std::vector<std::string>& arguments);

}  // namespace tessera::bench
