// A case of the extreme suite: a scene that is made in code, written as a file, imported, built and drawn, and what must come of it.
#pragma once
#include "verify/verify.h"

#include <functional>

namespace tessera::verify
{

// What a device and its host must have for a case.
struct Needs
{
	uint64_t device_bytes = 0;  // of device memory
	uint64_t host_bytes = 0;
	bool hardware = false;  // not a software device: it would take hours there
};

// What must come of a case. Every promise of `verify` must hold besides.
struct Expected
{
	enum class Kind : uint8_t
	{
		Exact,    // no violation; the largest error is within its derived bound (docs/numerics.md)
		Within,   // no violation; `measure` is at most `bound`
		Refused,  // the file is refused with `code`, in one line that contains `says`
	};
	Kind kind = Kind::Exact;
	std::string measure = "error over its bound";
	double bound = 1;
	ExitCode code = ExitCode::Fine;
	std::string says = {};
};

inline Expected within(std::string measure, double bound)
{
	return { Expected::Kind::Within, std::move(measure), bound };
}
inline Expected refused(ExitCode code, std::string says)
{
	return { Expected::Kind::Refused, "exit code", double(code), code, std::move(says) };
}

// One drawing of a case's scene, checked.
struct CaseRun
{
	BuiltScene scene;
	Report report;
};

// What cases are run on.
struct SuiteDevice
{
	Device& device;
	const TessellationTable& table;
	std::vector<Raster> paths;
	uint64_t seed = 1;
	bool usual_way = false;
	Fault fault = Fault::None;
};

// What a case measures itself, instead of being verified.
struct Measured
{
	uint64_t checks = 0, violations = 0;
	double worst = 0;       // in Expected::measure
	std::string what = {};  // the worst violation
};

struct Case
{
	std::string family;
	std::string name;
	std::string what;   // one line
	bool quick = true;  // part of extreme-quick
	Needs needs = {};
	Expected expected = {};
	std::function<ImportedScene()> scene = {};
	std::function<void(std::vector<std::byte>& file)> damage = {};                  // of the written file
	std::function<std::vector<NamedCamera>(const BuiltScene& scene)> cameras = {};  // empty: the framing one and five random ones
	std::vector<float> rates = { 4 };
	uint32_t width_px = 96, height_px = 64;
	RenderOptions options = {};  // capacities, displacement scale, pieces of a split
	// More that must hold of what was drawn; returns what is wrong, or nothing.
	std::function<std::string(const CaseRun& run)> also = {};
	// Instead of verify: of the built scene.
	std::function<Result<Measured>(const SuiteDevice& suite, const Case& one, const BuiltScene& scene)> measure = {};
};

// --- families, each in a file of its own ---
void addScaleCases(std::vector<Case>& cases);
void addGeometryCases(std::vector<Case>& cases);
void addDisplacementCases(std::vector<Case>& cases);
void addViewCases(std::vector<Case>& cases);
void addCountCases(std::vector<Case>& cases);
void addAnimationCases(std::vector<Case>& cases);

}  // namespace tessera::verify
