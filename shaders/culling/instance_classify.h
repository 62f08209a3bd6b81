// Arguments of instance_classify.
#ifndef TESSERA_CULLING_INSTANCE_CLASSIFY_H
#define TESSERA_CULLING_INSTANCE_CLASSIFY_H
#include "shared/bounds.h"
#include "shared/geometry.h"
#include "shared/lists.h"

SHARED_BEGIN

struct InstanceClassifyArgs
{
	GPU_PTR(InstanceRecord) instances;
	GPU_PTR(MeshRecord) meshes;
	GPU_PTR(DisplacedBounds) mesh_bounds;  // 0 without frustum culling
	GPU_PTR(ListHead) heads;
	GPU_PTR(ClusterGroup) cluster_groups;
	uint instance_count;
	uint round;  // a frame in several rounds takes every round_count-th group in each
	uint round_count;
	uint groups_per_mesh;  // most groups that any mesh has: numbers all groups of the scene one after another
};
SHARED_LAYOUT(InstanceClassifyArgs, 56, groups_per_mesh, 52)

SHARED_END

#endif
