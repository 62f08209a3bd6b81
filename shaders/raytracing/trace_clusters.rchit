// trace_clusters: the nearest micro-triangle on a primary ray, found by its cluster. Test: tests/gpu/raytracing/clusters_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raytracing/trace_visibility.h"
#include "lib/cluster_hit.glsl"
#include "lib/traced_scene.glsl"

layout(push_constant, scalar) uniform Args { TraceVisibilityArgs args; };
layout(location = 0) rayPayloadInEXT TracedHit hit;

void main() { hit = TracedHit(gl_HitTEXT, clusterPayload(args.payloads, uint(hit_cluster), gl_PrimitiveID)); }
