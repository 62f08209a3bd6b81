#include "base/keep_loaded.h"

#if defined(__SANITIZE_ADDRESS__)
#include <dlfcn.h>
#endif

namespace tessera
{

void keepLoadedForLeakReports([[maybe_unused]] const char* library)
{
#if defined(__SANITIZE_ADDRESS__)
	dlopen(library, RTLD_NOW | RTLD_NODELETE);
#endif
}

}  // namespace tessera
