// The rays of trace.rgen by ray queries, which have the cluster's id by an instruction: 5345 is OpRayQueryGetIntersectionClusterIdNV, 5437 its capability.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_query : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_spirv_intrinsics : require
#include "hit.glsl"

spirv_instruction(extensions = ["SPV_NV_cluster_acceleration_structure"], capabilities = [5437], id = 5345) int clusterOf(
	spirv_by_reference rayQueryEXT query, int committed);

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Hits { Hit at[]; };
layout(push_constant, scalar) uniform Args
{
	Hits hits;
	float extent;
};
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;

void main()
{
	vec2 at = (vec2(gl_WorkGroupID.xy) + vec2(0.37, 0.61)) / vec2(gl_NumWorkGroups.xy) * extent;
	rayQueryEXT query;
	rayQueryInitializeEXT(query, scene, gl_RayFlagsOpaqueEXT, 0xffu, vec3(at, 10.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0);
	while (rayQueryProceedEXT(query))
	{
	}
	Hit hit = Hit(-1.0, 0.0, 0.0, 0u, 0u, 0u, 0u, 0u);
	if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT)
	{
		vec2 corner = rayQueryGetIntersectionBarycentricsEXT(query, true);
		hit = Hit(rayQueryGetIntersectionTEXT(query, true), corner.x, corner.y, clusterOf(query, 1), rayQueryGetIntersectionGeometryIndexEXT(query, true),
				  rayQueryGetIntersectionPrimitiveIndexEXT(query, true), rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),
				  rayQueryGetIntersectionInstanceIdEXT(query, true));
	}
	hits.at[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = hit;
}
