// The micro-vertices of a batch: what each part's evaluation needs is loaded once per workgroup, one lane a corner.
#ifndef TESSERA_LIB_BATCH_VERTICES
#define TESSERA_LIB_BATCH_VERTICES
#include "lib/frame_data.glsl"
#include "lib/batch.glsl"

shared DomainTriangle part_records[BATCH_MAX_PARTS];
shared BaseTriangle part_bases[BATCH_MAX_PARTS];
shared uint part_materials[BATCH_MAX_PARTS];
shared uint part_instances[BATCH_MAX_PARTS];
// 1: a vertex of the base triangle, or an edge, takes its height from another triangle.
shared uint part_on_seam[BATCH_MAX_PARTS];
// Per corner: position and texel density; direction and u; v.
shared vec4 part_points[3u * BATCH_MAX_PARTS];
shared vec4 part_directions[3u * BATCH_MAX_PARTS];
shared float part_v[3u * BATCH_MAX_PARTS];
// Rows of the placement with the translation; its scale.
shared vec4 part_rows[3u * BATCH_MAX_PARTS];
shared float part_scales[BATCH_MAX_PARTS];

void loadPartBase(RasterInputs inputs, uint lane, uint first)
{
	PartPlace place = inputs.part_places.at[first + lane];
	DomainTriangle record = inputs.part_triangles.at[place.part];
	DomainPiece piece = unpackTriangle(record);
	ClusterRef ref = inputs.visible_clusters.at[piece.visible_cluster];
	ClusterRecord cluster = inputs.clusters.at[ref.cluster];
	BaseTriangle base = baseTriangle(frame_surface, cluster, piece.triangle);
	part_records[lane] = record;
	part_bases[lane] = base;
	part_materials[lane] = cluster.material;
	part_instances[lane] = ref.instance;
	part_on_seam[lane] = HAS_SEAMS && triangleSeamFlags(base.flags) != 0u ? 1u : 0u;
	loadPart(inputs, lane, place, inputs.part_places.at[first].offsets, piece);
}

void loadPartCorner(RasterInputs inputs, uint part, uint corner)
{
	BaseTriangle base = part_bases[part];
	uint vertex = corner == 0u ? base.v0 : (corner == 1u ? base.v1 : base.v2);
	uint slot = 3u * part + corner;
	part_points[slot].xyz = frame_surface.positions.at[vertex];
	if (HAS_DISPLACEMENT)
	{
		vec2 uv = frame_surface.uvs.at[vertex];
		part_points[slot].w = frame_surface.densities.at[vertex];
		part_directions[slot] = vec4(frame_surface.directions.at[vertex], uv.x);
		part_v[slot] = uv.y;
	}
	if (HAS_SEAMS && frame_surface.seam_corner_indices.at[vertex] != NO_INDEX)
		part_on_seam[part] = 1u;
	InstanceRecord instance = inputs.instances.at[part_instances[part]];
	Placement placement = placementOf(instance, frame_view);
	vec3 row = corner == 0u ? placement.row0 : (corner == 1u ? placement.row1 : placement.row2);
	float translation = corner == 0u ? placement.translation.x : (corner == 1u ? placement.translation.y : placement.translation.z);
	part_rows[slot] = vec4(row, translation);
	if (corner == 0u)
		part_scales[part] = placement.inverse_scale_squared;
}

// Loads the batch and what batchSample reads. Ends with a barrier.
void loadBatchParts(RasterInputs inputs, uint batch)
{
	uint lane = gl_LocalInvocationIndex;
	uint first = batchFirst(batch), count = batchCount(batch);
	if (lane < BATCH_MAX_PARTS)
		part_sums[lane] = 0xffffffffu;
	if (lane < count)
		loadPartBase(inputs, lane, first);
	barrier();
	for (uint i = lane; i < 3u * count; i += gl_WorkGroupSize.x)
		loadPartCorner(inputs, i / 3u, i % 3u);
	barrier();
}

Placement partPlacement(uint owner)
{
	vec4 x = part_rows[3u * owner], y = part_rows[3u * owner + 1u], z = part_rows[3u * owner + 2u];
	return Placement(x.xyz, y.xyz, z.xyz, vec3(x.w, y.w, z.w), part_scales[owner]);
}

TriangleCorners partCorners(uint owner)
{
	vec4 p0 = part_points[3u * owner], p1 = part_points[3u * owner + 1u], p2 = part_points[3u * owner + 2u];
	TriangleCorners corners;
	corners.position0 = p0.xyz;
	corners.position1 = p1.xyz;
	corners.position2 = p2.xyz;
	if (HAS_DISPLACEMENT)
	{
		vec4 d0 = part_directions[3u * owner], d1 = part_directions[3u * owner + 1u], d2 = part_directions[3u * owner + 2u];
		corners.direction0 = d0.xyz;
		corners.direction1 = d1.xyz;
		corners.direction2 = d2.xyz;
		corners.uv0 = vec2(d0.w, part_v[3u * owner]);
		corners.uv1 = vec2(d1.w, part_v[3u * owner + 1u]);
		corners.uv2 = vec2(d2.w, part_v[3u * owner + 2u]);
		corners.densities = vec3(p0.w, p1.w, p2.w);
	}
	return corners;
}

// What micro-vertex `index` of the batch, of part `owner`, is made of.
SurfaceSample batchSample(RasterInputs inputs, uint index, uint owner)
{
	DomainPiece piece = unpackTriangle(part_records[owner]);
	BaseTriangle base = part_bases[owner];
	DomainPoint point = patternPoint(piece, index - (part_sums[owner] & 0xffffu), part_patterns[owner], inputs.table, triangleEdgeFlags(base.flags));
	return sampleAtCorners(frame_surface, base, partCorners(owner), part_on_seam[owner] != 0u, point);
}

#endif
