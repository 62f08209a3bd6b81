// trace_light: nothing is in the way of a shadow or ambient ray. Test: tests/gpu/raytracing/light_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "shared/lang.h"

layout(location = 0) rayPayloadInEXT float arrives;

void main() { arrives = 1.0; }
