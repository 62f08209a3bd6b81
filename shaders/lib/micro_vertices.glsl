// What evaluate_vertices leaves of a micro-vertex: clip coordinates, or, where rays are traced through the same vertices, its place relative to
// the eye, scaled, which those who draw then project themselves.
#ifndef TESSERA_LIB_MICRO_VERTICES
#define TESSERA_LIB_MICRO_VERTICES
#include "lib/frame_data.glsl"

vec4 keptVertex(vec3 relative) { return HAS_RAYS ? vec4(relative, 1.0) : clipPosition(relative, frame_view); }

vec4 clipOfKept(vec4 kept) { return HAS_RAYS ? clipPosition(kept.xyz, frame_view) : kept; }

#endif
