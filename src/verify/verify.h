// `tessera verify`: the promises of DESIGN.md, section 4, checked on any scene, over cameras, rates and raster paths.
#pragma once
#include "verify/cameras.h"
#include "verify/fault.h"
#include "verify/frame_source.h"
#include "verify/seam_jump.h"
#include "verify/usual_way.h"

namespace tessera::verify
{

struct Request
{
	Device* device = nullptr;
	Device* other_device = nullptr;  // nullptr: no second device
	const BuiltScene* scene = nullptr;
	const TessellationTable* table = nullptr;
	RenderOptions options;        // of frames with culling
	RenderOptions uncut_options;  // the same with culling off
	std::vector<Raster> paths;    // that the device has; never auto
	std::vector<NamedCamera> cameras;
	std::vector<float> rates;
	uint64_t seed = 1;
	Fault fault = Fault::None;
	bool usual_way = false;      // also measure what the usual way would crack
	bool one_variation = false;  // all that must not matter is varied at once: fewer pipelines, but less told of what mattered
	bool tells_progress = true;
	bool paints_violations = true;  // in the report's picture
};

struct FrameLine
{
	std::string camera;
	double rate_wanted = 0, rate_granted = 0;
	bool every_factor_one = false;
	uint64_t micro_triangles = 0, covered_pixels = 0;
	uint64_t violations = 0;
};

struct NamedCheck
{
	std::string_view name;
	std::string_view measure;  // what the size of a violation is
	CheckResult result;
};

struct Report
{
	std::vector<NamedCheck> checks;
	SeamJump seams;
	UsualWay usual_way;
	std::vector<FrameLine> frames;
	std::string injected;  // where the fault is; empty: none
	// The frame with most violations (the first, when there are none) with what is wrong marked (overlay.h).
	std::vector<uint8_t> picture;
	std::string picture_frame;

	uint64_t violations() const;
	CheckResult& check(std::string_view name);
};

// Draws and checks everything; says how far it is. Errors: those of drawing; violations are no error here. A device that names
// what does not exist ends it with CheckFailed.
Result<Report> run(const Request& request);

// The raster paths that a device has.
std::vector<Raster> rasterPaths(const Device& device);

}  // namespace tessera::verify
