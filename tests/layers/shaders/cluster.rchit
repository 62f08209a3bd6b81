// Of structures with clusters. glslang 12 has no gl_ClusterIDNV: 11 is BuiltIn, 5436 ClusterIDNV, 5437 the capability.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_spirv_intrinsics : require
#include "hit.glsl"

spirv_decorate(extensions = ["SPV_NV_cluster_acceleration_structure"], capabilities = [5437], 11, 5436) in int cluster_id;
layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec2 corner;

void main()
{
	hit = Hit(gl_HitTEXT, corner.x, corner.y, cluster_id, gl_GeometryIndexEXT, gl_PrimitiveID, gl_InstanceCustomIndexEXT, gl_InstanceID);
}
