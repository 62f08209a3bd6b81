// `tessera verify --leaks N`: does the background shine through a closed surface, from very many places?
#pragma once
#include "verify/verify.h"

namespace tessera::verify
{

// Only the check no_leaks (leak_check.h), of frames with culling and without, for every camera, rate and raster path of the request: fast
// enough for ten thousand views. Errors: those of drawing.
Result<Report> runLeaks(const Request& request);

}  // namespace tessera::verify
