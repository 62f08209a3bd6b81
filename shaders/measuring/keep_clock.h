// Arguments of keep_clock.
#ifndef TESSERA_MEASURING_KEEP_CLOCK_H
#define TESSERA_MEASURING_KEEP_CLOCK_H
#include "shared/lang.h"

SHARED_BEGIN

struct KeepClockArgs
{
	GPU_PTR(uint) result;  // one word, never read
	uint turns;            // dependent multiply-adds of each thread
	uint unused;
};
SHARED_LAYOUT(KeepClockArgs, 16, unused, 12)

SHARED_END

#endif
