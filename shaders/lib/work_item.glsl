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
	uint parts;  // of a batch: how many; of a full cluster: which visible cluster
	uint first_vertex;
	uint vertex_count;
	uint triangle_count;
};

// Of a full cluster, in shared memory with all else that belongs to an item: registers decide how many workgroups are resident. Its placement
// stands where part 0's would.
shared ClusterRecord item_cluster;

// All lanes together, as all below. Ends with a barrier.
WorkItem loadCluster(RasterInputs inputs, FullCluster full)
{
	ClusterRef ref = inputs.visible_clusters.at[full.visible_cluster];
	ClusterRecord cluster = inputs.clusters.at[ref.cluster];
	for (uint row = gl_LocalInvocationIndex; row < 3u; row += gl_WorkGroupSize.x)
		loadPlacementRow(inputs.instances.at[ref.instance], 0u, row);
	if (gl_LocalInvocationIndex == 0u)
	{
		item_cluster = cluster;
		part_turned[0] = HAS_MIRRORED_INSTANCES ? inputs.instances.at[ref.instance].mirrored : 0u;
	}
	barrier();
	return WorkItem(false, full.visible_cluster, full.first_vertex, clusterVertices(cluster), clusterTriangles(cluster));
}

WorkItem loadBatchItem(RasterInputs inputs, Batch batch)
{
	loadBatchBases(inputs, batch.parts);
	barrier();
	loadBatchCorners(inputs, batchCount(batch.parts));
	barrier();
	return WorkItem(true, batchCount(batch.parts), batch.first_vertex, batchVertices(batch), batchTriangles(batch));
}

// Entry `index` of full_clusters and, after those, of batches.
WorkItem workItem(RasterInputs inputs, FullClusterRef full_clusters, BatchRef batches, uint index, uint cluster_count)
{
	if (!HAS_TESSELLATION || index < cluster_count)
		return loadCluster(inputs, full_clusters.at[index]);
	return loadBatchItem(inputs, batches.at[index - cluster_count]);
}

// Micro-vertex `index` of the item, relative to the eye, scaled.
vec3 itemVertex(RasterInputs inputs, WorkItem item, uint index)
{
	bool is_batch = HAS_TESSELLATION && item.is_batch;
	uint owner = is_batch ? vertexOwner(index) : 0u;
	SurfaceSample at;
	if (is_batch)
		at = batchSample(inputs, index, owner);
	else
		at = clusterSample(inputs, item_cluster, index);
	Placement placement = partPlacement(owner);
	return placed(placement, displaced(frame_surface, at, placement, frame_view).displaced);
}

MicroTriangle itemTriangle(RasterInputs inputs, WorkItem item, uint index)
{
	if (HAS_TESSELLATION && item.is_batch)
		return batchTriangle(inputs, index, triangleOwner(index));
	return MicroTriangle(clusterTriangle(item_cluster, part_turned[0], index), packPayload(KIND_FULL_CLUSTER, item.parts, index));
}

uint itemMaterial(WorkItem item, uint triangle)
{
	if (HAS_TESSELLATION && item.is_batch)
		return part_materials[triangleOwner(triangle)];
	return item_cluster.material;
}

#endif
