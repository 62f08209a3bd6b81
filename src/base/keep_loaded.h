// Libraries that a leak report must be able to name.
#pragma once

namespace tessera
{

// In a build with the address sanitizer: keeps a shared library in the process to its end, so that what the library itself leaks
// is reported under its name and can be suppressed (tests/lsan.supp). Does nothing in other builds or when there is no such library.
void keepLoadedForLeakReports(const char* library);

}  // namespace tessera
