// trace_visibility: the nearest micro-triangle on a primary ray. Test: tests/gpu/raytracing/primary_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raytracing/trace_visibility.h"
#include "lib/traced_scene.glsl"

layout(push_constant, scalar) uniform Args { TraceVisibilityArgs args; };
layout(location = 0) rayPayloadInEXT TracedHit hit;

#include "lib/shared_hit.glsl"

void main()
{
	if (isSharedHit())
		hit = TracedHit(gl_HitTEXT, sharedPayload());
	else
		hit = TracedHit(gl_HitTEXT, args.payloads.at[args.first_payload + gl_PrimitiveID]);
}
