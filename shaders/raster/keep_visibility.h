// Arguments of keep_visibility.
#ifndef TESSERA_RASTER_KEEP_VISIBILITY_H
#define TESSERA_RASTER_KEEP_VISIBILITY_H
#include "shared/lang.h"

SHARED_BEGIN

struct KeepVisibilityArgs
{
	uint64_t visibility;  // address of a 64-bit word per pixel; 0 when attachments hold depth and payload
	uint64_t kept;
};
SHARED_LAYOUT(KeepVisibilityArgs, 16, kept, 8)

SHARED_END

#endif
