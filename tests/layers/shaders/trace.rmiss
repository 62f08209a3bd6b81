#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "hit.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;

void main() { hit = Hit(-1.0, 0.0, 0.0, 0u, 0u, 0u, 0u, 0u); }
