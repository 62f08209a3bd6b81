// trace_visibility: a primary ray that meets nothing. Test: tests/gpu/raytracing/primary_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "shared/lang.h"
#include "lib/traced_scene.glsl"

layout(location = 0) rayPayloadInEXT TracedHit hit;

void main() { hit.along = 0.0; }
