// From a hit in a structure that instances share to the triangle in this frame's lists. Included after the args of trace_visibility.
#ifndef TESSERA_LIB_SHARED_HIT
#define TESSERA_LIB_SHARED_HIT

bool isSharedHit() { return SHARES_STRUCTURES && gl_InstanceCustomIndexEXT != OWN_STRUCTURE; }

// The triangle's number in the scene: a structure holds its mesh's triangles in their order.
uint sharedTriangle(MeshRecord mesh) { return args.inputs.clusters.at[mesh.first_cluster].first_triangle + gl_PrimitiveID; }

// The cluster that holds it: the last of its mesh that begins there or before.
uint sharedCluster(MeshRecord mesh, uint triangle)
{
	uint low = mesh.first_cluster;
	uint high = low + mesh.cluster_count - 1u;
	while (low < high)
	{
		uint middle = (low + high + 1u) / 2u;
		if (args.inputs.clusters.at[middle].first_triangle <= triangle)
			low = middle;
		else
			high = middle - 1u;
	}
	return low;
}

MeshRecord sharedMesh() { return args.meshes.at[args.inputs.instances.at[gl_InstanceCustomIndexEXT].mesh]; }

uint sharedPayload()
{
	MeshRecord mesh = sharedMesh();
	uint triangle = sharedTriangle(mesh);
	uint cluster = sharedCluster(mesh, triangle);
	uint place = args.shared_clusters.at[args.shared_instances.at[gl_InstanceCustomIndexEXT] + cluster - mesh.first_cluster];
	if (place == NO_INDEX)
		return LISTED_NOWHERE;
	return packPayload(KIND_FULL_CLUSTER, place, triangle - args.inputs.clusters.at[cluster].first_triangle);
}

#endif
