// What is measured: one case per row of the tables.
#pragma once
#include "bench/settings.h"

namespace tessera::bench
{

// The series of the rows that are compared with the peer; the others are named by scalingNames().
inline constexpr std::string_view kTableSeries = "table";

struct Case
{
	std::string series;
	std::string scene;            // "sphere", "builtin:instances"
	uint64_t copies = 1;          // instances of it
	uint64_t base_triangles = 0;  // of one, where the sweep is over them
	std::string path;             // what loadScene takes; files relative to the folder of the scenes
	std::string raster;           // name of --raster
	bool cull = false;
	AppOptions options;  // everything the frame is drawn with

	std::string sceneLabel() const;  // "sphere x16", as the peer's table says
	std::string label() const;       // for progress and messages
};

// In an order that loads each scene once per stretch of rows. Errors: Usage (--scene names no scene).
Result<std::vector<Case>> tableCases(const Settings& settings);

// Sweeps of settings.scaling: rates until 1e8 micro-triangles, the same with rays until 1e7, instances up to 1e6, pictures up to 7680x4320; less with
// --quick.
std::vector<Case> scalingCases(const Settings& settings);

}  // namespace tessera::bench
