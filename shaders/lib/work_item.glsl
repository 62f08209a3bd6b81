// A workgroup's work: a full cluster or a batch of part triangles, behind one set of functions, so that heights, which are
// most of a stage's code, are compiled in once.
#ifndef TESSERA_LIB_WORK_ITEM
#define TESSERA_LIB_WORK_ITEM
#include "lib/frame_data.glsl"
#include "lib/batch_vertices.glsl"
#include "lib/cluster_geometry.glsl"

struct WorkItem
{
	bool is_batch;
	uint parts;            // packBatch; of a batch
	uint visible_cluster;  // of a full cluster
	uint first_vertex;
	uint vertex_count;
	uint triangle_count;
	ClusterRecord cluster;  // of a full cluster
	InstanceRecord instance;
};

WorkItem clusterItem(RasterInputs inputs, FullCluster full)
{
	ClusterRef ref = inputs.visible_clusters.at[full.visible_cluster];
	WorkItem item;
	item.is_batch = false;
	item.parts = 0u;
	item.visible_cluster = full.visible_cluster;
	item.first_vertex = full.first_vertex;
	item.cluster = inputs.clusters.at[ref.cluster];
	item.instance = inputs.instances.at[ref.instance];
	item.vertex_count = clusterVertices(item.cluster);
	item.triangle_count = clusterTriangles(item.cluster);
	return item;
}

// All lanes together: the parts go into shared memory.
WorkItem batchItem(RasterInputs inputs, Batch batch)
{
	loadBatchParts(inputs, batch.parts);
	WorkItem item;
	item.is_batch = true;
	item.parts = batch.parts;
	item.first_vertex = batch.first_vertex;
	item.vertex_count = batchVertices(batch);
	item.triangle_count = batchTriangles(batch);
	return item;
}

// Entry `index` of full_clusters and, after those, of batches.
WorkItem workItem(RasterInputs inputs, FullClusterRef full_clusters, BatchRef batches, uint index, uint cluster_count)
{
	if (!HAS_TESSELLATION || index < cluster_count)
		return clusterItem(inputs, full_clusters.at[index]);
	return batchItem(inputs, batches.at[index - cluster_count]);
}

// Micro-vertex `index` of the item, clip coordinates.
vec4 itemVertex(RasterInputs inputs, WorkItem item, uint index)
{
	View view = frame_view;
	Placement placement;
	SurfaceSample at;
	if (HAS_TESSELLATION && item.is_batch)
	{
		uint owner = owningPart(index, 0u);
		placement = partPlacement(owner);
		at = batchSample(inputs, index, owner);
	}
	else
	{
		placement = placementOf(item.instance, view);
		at = clusterSample(inputs, item.cluster, index);
	}
	return clipPosition(placed(placement, displaced(frame_surface, at, placement, view).displaced), view);
}

MicroTriangle itemTriangle(RasterInputs inputs, WorkItem item, uint index)
{
	if (HAS_TESSELLATION && item.is_batch)
		return batchTriangle(inputs, index, owningPart(index, 16u));
	return MicroTriangle(clusterTriangle(inputs, item.cluster, item.instance, index), packPayload(KIND_FULL_CLUSTER, item.visible_cluster, index));
}

uint itemMaterial(WorkItem item, uint triangle)
{
	return HAS_TESSELLATION && item.is_batch ? part_materials[owningPart(triangle, 16u)] : item.cluster.material;
}

#endif
