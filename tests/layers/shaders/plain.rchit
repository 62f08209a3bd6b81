// Of structures without clusters; the geometry's number is in place of the cluster's id.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "hit.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec2 corner;

void main()
{
	hit = Hit(gl_HitTEXT, corner.x, corner.y, gl_GeometryIndexEXT, gl_GeometryIndexEXT, gl_PrimitiveID, gl_InstanceCustomIndexEXT, gl_InstanceID);
}
