// keep_clock: arithmetic without a result, which fills the time between two measured frames. A GPU that waits for the host half of the time lowers its
// clock, and then measures the waiting.
//
//   out  result   uint   so that the arithmetic is not left out
//
// Host: src/frame/clock_load.cpp   Test: tests/gpu/clock_load_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "measuring/keep_clock.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Args { KeepClockArgs args; };

void main()
{
	float value = float(gl_GlobalInvocationID.x) * 1e-6;
	for (uint i = 0u; i < args.turns; ++i)
		value = value * 0.999 + 0.001;
	if (value > 2.0)  // never
		args.result.at[0] = floatBitsToUint(value);
}
