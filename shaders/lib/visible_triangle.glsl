// The micro-triangle that a visibility payload names. Where the place within it matters (EXACT_PLACES: debug views, facets)
// its corners are evaluated again by the function that its rasteriser used.
#ifndef TESSERA_LIB_VISIBLE_TRIANGLE
#define TESSERA_LIB_VISIBLE_TRIANGLE
#include "lib/frame_data.glsl"
#include "shared/raster_inputs.h"

#ifdef NEEDS_EXACT_PLACES  // the includer needs the corners in every view
const bool EXACT_PLACES = true;
#else
const bool EXACT_PLACES = !(IS_SHADED_VIEW && HAS_SMOOTH_NORMALS);
#endif

struct VisibleTriangle
{
	uint instance;
	uint cluster;   // global index
	uint triangle;  // of the cluster
	uint micro;     // of the part; 0 for full clusters
	uint material;
	uint largest_factor;
	BaseTriangle base;
	Placement placement;
	DomainPiece piece;      // part triangle; the whole base triangle for full clusters
	uint mirrored;          // 1: the instance turns triangles over
	DomainPoint corners[3]; // of the micro-triangle, in the base triangle's winding; with EXACT_PLACES only
	vec3 relative[3];       // the same, displaced and placed
};

DomainPiece wholeTriangle(uint visible, uint triangle)
{
	DomainPiece piece;
	piece.c0 = domainCorner(0u);
	piece.c1 = domainCorner(1u);
	piece.c2 = domainCorner(2u);
	piece.visible_cluster = visible;
	piece.triangle = triangle;
	piece.a = 1u;
	piece.b = 1u;
	piece.c = 1u;
	piece.mirror = 0u;
	return piece;
}

// Domain corners of the micro-triangle within its part.
void findCorners(RasterInputs inputs, uint payload, inout VisibleTriangle visible)
{
	visible.corners[0] = visible.piece.c0;
	visible.corners[1] = visible.piece.c1;
	visible.corners[2] = visible.piece.c2;
	visible.micro = 0u;
	if (!HAS_TESSELLATION || payloadKind(payload) == KIND_FULL_CLUSTER)
		return;
	visible.micro = payloadTriangle(payload);
	PatternRange pattern = inputs.table.patterns.at[patternIndex(visible.piece.a, visible.piece.b, visible.piece.c)];
	uvec3 indices = patternTriangle(visible.micro, pattern, inputs.table, visible.piece.mirror);
	uint edge_flags = triangleEdgeFlags(visible.base.flags);
	for (uint i = 0u; i < 3u; ++i)
		visible.corners[i] = patternPoint(visible.piece, indices[i], pattern, inputs.table, edge_flags);
}

VisibleTriangle visibleTriangle(RasterInputs inputs, uint payload)
{
	VisibleTriangle visible;
	uint index = payloadIndex(payload);
	bool is_part = HAS_TESSELLATION && payloadKind(payload) == KIND_PART_TRIANGLE;
	if (is_part)
		visible.piece = unpackTriangle(inputs.part_triangles.at[index]);
	else
		visible.piece = wholeTriangle(index, payloadTriangle(payload));
	ClusterRef ref = inputs.visible_clusters.at[visible.piece.visible_cluster];
	ClusterRecord cluster = inputs.clusters.at[ref.cluster];
	visible.instance = ref.instance;
	visible.cluster = ref.cluster;
	visible.triangle = visible.piece.triangle;
	visible.material = cluster.material;
	visible.largest_factor = visible.piece.a;
	visible.base = baseTriangle(frame_surface, cluster, visible.triangle);
	InstanceRecord instance = inputs.instances.at[ref.instance];
	visible.placement = placementOf(instance, frame_view);
	visible.mirrored = HAS_MIRRORED_INSTANCES ? instance.mirrored : 0u;
	if (!EXACT_PLACES)
		return visible;
	findCorners(inputs, payload, visible);
	for (uint i = 0u; i < 3u; ++i)
	{
		SurfacePoint point = surfacePoint(frame_surface, visible.base, visible.corners[i], visible.placement, frame_view);
		visible.relative[i] = placed(visible.placement, point.displaced);
	}
	return visible;
}

#endif
