// The micro-vertices of a batch: what each part's evaluation needs is loaded once per workgroup, in two steps with a barrier between:
// what names its base triangle, one lane a part; then the triangle's corners and the part's edges, one lane a corner, and who owns what.
#ifndef TESSERA_LIB_BATCH_VERTICES
#define TESSERA_LIB_BATCH_VERTICES
#include "lib/frame_data.glsl"
#include "lib/batch.glsl"

// Per part: its corners, and for the edge that begins at each the multiplier of its divisions.
shared DomainPoint part_corners[3u * STAGED_PARTS];
shared uint part_multipliers[3u * STAGED_PARTS];
// Factors of edges a, b, c, 4 bits each; from bit 12 on, a bit per edge: its points are counted from its first corner.
shared uint part_factors[STAGED_PARTS];
shared BaseTriangle part_bases[STAGED_PARTS];
shared uint part_materials[STAGED_PARTS];
shared uint part_instances[STAGED_PARTS];
// 1: a vertex of the base triangle, or an edge, takes its height from another triangle.
shared uint part_on_seam[STAGED_PARTS];
// Per corner: position and texel density; direction and u; v.
shared vec4 part_points[3u * STAGED_PARTS];
shared vec4 part_directions[3u * STAGED_PARTS];
shared float part_v[3u * STAGED_PARTS];
// Rows of the placement with the translation; its scale.
shared vec4 part_rows[3u * STAGED_PARTS];
shared float part_scales[STAGED_PARTS];

void loadPartBase(RasterInputs inputs, uint part, PartPlace place, uint first_offsets)
{
	DomainTriangle record = inputs.part_triangles.at[place.part];
	DomainPiece piece = unpackTriangle(record);
	ClusterRef ref = inputs.visible_clusters.at[piece.visible_cluster];
	ClusterRecord cluster = inputs.clusters.at[ref.cluster];
	part_corners[3u * part] = piece.c0;
	part_corners[3u * part + 1u] = piece.c1;
	part_corners[3u * part + 2u] = piece.c2;
	part_factors[part] = piece.a | (piece.b << 4) | (piece.c << 8);
	part_bases[part] = baseTriangle(frame_surface, cluster, piece.triangle);
	part_on_seam[part] = HAS_SEAMS && triangleSeamFlags(part_bases[part].flags) != 0u ? 1u : 0u;
	part_materials[part] = cluster.material;
	part_instances[part] = ref.instance;
	loadPart(inputs, part, place, first_offsets, piece);
}

// The first step.
void loadBatchBases(RasterInputs inputs, uint batch)
{
	uint lane = gl_LocalInvocationIndex;
	uint first = batchFirst(batch);
	if (lane < batchCount(batch))
		loadPartBase(inputs, lane, inputs.part_places.at[first + lane], inputs.part_places.at[first].offsets);
	else if (lane < STAGED_PARTS)
		part_sums[lane] = 0xffffffffu;
}

// One row of a placement; row 0 with the scale.
void loadPlacementRow(InstanceRecord instance, uint part, uint row)
{
	Placement placement = placementOf(instance, frame_view);
	vec3 linear = row == 0u ? placement.row0 : (row == 1u ? placement.row1 : placement.row2);
	float translation = row == 0u ? placement.translation.x : (row == 1u ? placement.translation.y : placement.translation.z);
	part_rows[3u * part + row] = vec4(linear, translation);
	if (row == 0u)
		part_scales[part] = placement.inverse_scale_squared;
}

// What all points of the edge that begins at a corner have in common.
void loadPartEdge(uint part, uint corner)
{
	DomainPoint from = part_corners[3u * part + corner];
	DomainPoint to = part_corners[3u * part + (corner == 2u ? 0u : corner + 1u)];
	part_multipliers[3u * part + corner] = divisionMultiplier((part_factors[part] >> (4u * corner)) & 15u);
	if (countsFromFirst(from, to, triangleEdgeFlags(part_bases[part].flags)))
		atomicOr(part_factors[part], 1u << (12u + corner));
}

void loadPartCorner(RasterInputs inputs, uint part, uint corner)
{
	BaseTriangle base = part_bases[part];
	uint vertex = corner == 0u ? base.v0 : (corner == 1u ? base.v1 : base.v2);
	uint slot = 3u * part + corner;
	part_points[slot].xyz = frame_surface.positions.at[vertex];
	if (HAS_DISPLACEMENT || HAS_PN)
		part_directions[slot].xyz = frame_surface.directions.at[vertex];
	if (HAS_DISPLACEMENT)
	{
		vec2 uv = frame_surface.uvs.at[vertex];
		part_points[slot].w = frame_surface.densities.at[vertex];
		part_directions[slot].w = uv.x;
		part_v[slot] = uv.y;
	}
	loadPlacementRow(inputs.instances.at[part_instances[part]], part, corner);
	loadPartEdge(part, corner);
	if (HAS_SEAMS && frame_surface.seam_corner_indices.at[vertex] != NO_INDEX)
		part_on_seam[part] = 1u;
}

// The second step.
void loadBatchCorners(RasterInputs inputs, uint count)
{
	for (uint i = gl_LocalInvocationIndex; i < 3u * count; i += gl_WorkGroupSize.x)
		loadPartCorner(inputs, i / 3u, i % 3u);
	loadOwners();
}

Placement partPlacement(uint part)
{
	uint row = 3u * part;
	vec4 x = part_rows[row], y = part_rows[row + 1u], z = part_rows[row + 2u];
	return Placement(x.xyz, y.xyz, z.xyz, vec3(x.w, y.w, z.w), part_scales[part], 0.0, 0.0);  // no edge is asked about any more
}

TriangleCorners partCorners(uint part)
{
	uint first = 3u * part;
	vec4 p0 = part_points[first], p1 = part_points[first + 1u], p2 = part_points[first + 2u];
	TriangleCorners corners;
	corners.position0 = p0.xyz;
	corners.position1 = p1.xyz;
	corners.position2 = p2.xyz;
	vec4 d0, d1, d2;
	if (HAS_DISPLACEMENT || HAS_PN)
	{
		d0 = part_directions[first];
		d1 = part_directions[first + 1u];
		d2 = part_directions[first + 2u];
		corners.direction0 = d0.xyz;
		corners.direction1 = d1.xyz;
		corners.direction2 = d2.xyz;
	}
	if (HAS_DISPLACEMENT)
	{
		corners.uv0 = vec2(d0.w, part_v[first]);
		corners.uv1 = vec2(d1.w, part_v[first + 1u]);
		corners.uv2 = vec2(d2.w, part_v[first + 2u]);
		corners.densities = vec3(p0.w, p1.w, p2.w);
	}
	return corners;
}

// Domain point of micro-vertex `index` of the batch, of part `owner`: as patternPoint says.
DomainPoint batchPoint(RasterInputs inputs, uint index, uint owner)
{
	uint within = index - (part_sums[owner] & 0xffffu);
	uint factors = part_factors[owner];
	PatternPlace place = patternPlace(within, factors & 15u, (factors >> 4) & 15u, (factors >> 8) & 15u);
	uint first = 3u * owner;
	if (place.edge == 3u)
		return interiorPoint(part_corners[first], part_corners[first + 1u], part_corners[first + 2u],
		                     inputs.table.vertices.at[(part_patterns[owner] >> 16) + within]);
	uint to = place.edge == 2u ? 0u : place.edge + 1u;
	bool from_first = (factors >> (12u + place.edge) & 1u) != 0u;
	return edgePointAlong(part_corners[first + place.edge], part_corners[first + to], place.k, place.segments, part_multipliers[first + place.edge],
	                      from_first);
}

// What it is made of.
SurfaceSample batchSample(RasterInputs inputs, uint index, uint owner)
{
	return sampleAtCorners(frame_surface, part_bases[owner], partCorners(owner), part_on_seam[owner] != 0u, batchPoint(inputs, index, owner));
}

#endif
