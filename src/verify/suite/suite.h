// `tessera verify --suite extreme`: the promises on stiff and extreme input. Every case is a scene made in code, written as a .glb, imported,
// built and drawn, with an outcome that is stated before.
#pragma once
#include "verify/verify.h"

namespace tessera::verify
{

struct SuiteRequest
{
	Device* device = nullptr;
	const TessellationTable* table = nullptr;
	std::vector<Raster> paths;  // that the device has; never auto
	bool quick = false;         // extreme-quick: what takes minutes on two cores
	std::string only;           // a family or a case; empty: all
	uint64_t seed = 1;
	bool usual_way = false;
	Fault fault = Fault::None;  // into every scene that is verified: its case must fail
};

struct SuiteLine
{
	std::string family, name, what;
	std::string skipped;  // why; empty: it was run
	bool passed = false;
	std::string expected;  // in words
	uint64_t checks = 0;   // comparisons of frames, or drawings
	uint64_t violations = 0;
	std::string measure;  // of `worst`
	double worst = 0, bound = 0;
	std::string wrong;                   // what did not come out as expected; empty when passed
	double error_ulp = 0, error_px = 0;  // against the surface in double precision; 0 when nothing was drawn
	double seconds = 0;
	UsualWay usual_way;
};

struct SuiteReport
{
	std::string suite;
	std::vector<SuiteLine> lines;

	size_t failed() const;
	size_t skipped() const;
};

// Runs the cases one after another; says how far it is. Files stay in memory. Errors: Usage (no case is called `only`), DeviceLost. A case
// that fails is a line, no error.
Result<SuiteReport> runSuite(const SuiteRequest& request);

// Families of cases, in the order in which they are run.
std::vector<std::string> suiteFamilies();

}  // namespace tessera::verify
