// Arguments of instance_classify.
#ifndef TESSERA_CULLING_INSTANCE_CLASSIFY_H
#define TESSERA_CULLING_INSTANCE_CLASSIFY_H
#include "shared/bounds.h"
#include "shared/geometry.h"
#include "shared/lists.h"
#include "shared/ray_sharing.h"

SHARED_BEGIN

struct InstanceClassifyArgs
{
	GPU_PTR(InstanceRecord) instances;
	GPU_PTR(MeshRecord) meshes;
	GPU_PTR(DisplacedBounds) mesh_bounds;  // 0 without frustum culling and shared structures
	GPU_PTR(ListHead) heads;
	GPU_PTR(ClusterGroup) cluster_groups;
	GPU_PTR(FrameCounts) counts;     // this and the next two: with shared structures
	GPU_PTR(uint) shared_instances;  // per instance
	GPU_PTR(uvec2) mesh_structures;  // per mesh: the address of its structure, lower word first; 0: it has none
	RaySharing sharing;
	uint instance_count;
	uint round;  // a frame in several rounds takes every round_count-th group in each
	uint round_count;
	uint groups_per_mesh;  // most groups that any mesh has: numbers all groups of the scene one after another
	uint cull_frustum;
};
SHARED_LAYOUT(InstanceClassifyArgs, 96, cull_frustum, 92)

SHARED_END

#endif
