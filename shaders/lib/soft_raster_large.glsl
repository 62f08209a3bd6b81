// Triangles of any size and place for the rasteriser in compute: what one lane does not do alone (lib/soft_raster.glsl) the whole
// workgroup does. Triangles that cross the near plane or leave the guard band are clipped first. All lanes of the workgroup call
// these functions together.
#ifndef TESSERA_LIB_SOFT_RASTER_LARGE
#define TESSERA_LIB_SOFT_RASTER_LARGE
#include "lib/soft_raster.glsl"

const uint MAX_RASTER_TRIANGLES = RASTER_BATCH_TRIANGLES;

// Where a vertex lies outside the guard band, which is rare, all are stored again as they are before projection (clip x and y, depth along
// the view), and every triangle places its corners itself.
shared uint raster_wide[MAX_RASTER_TRIANGLES / 32u];  // bits: triangles that one lane left to all
shared uint raster_any_wide;                          // 1: there are some
shared vec4 raster_polygon[2][9];
shared uint raster_polygon_size;

// Before an item's first vertex is stored, and, for what is wide, after the last item's triangles are done: there is a barrier between.
void beginRaster()
{
	for (uint i = gl_LocalInvocationIndex; i < MAX_RASTER_TRIANGLES / 32u; i += gl_WorkGroupSize.x)
		raster_wide[i] = 0u;
	if (gl_LocalInvocationIndex == 0u)
	{
		raster_has_outside = 0u;
		raster_any_wide = 0u;
	}
}

// `relative`: to the eye, scaled. `projects`: first time; else the vertices are kept as they are before projection.
void storeRasterVertex(uint index, vec3 relative, bool projects, View view)
{
	vec4 clip = clipPosition(relative, view);
	if (projects)
		storeScreenVertex(index, clip, view);
	else
		keepVertex(index, floatBitsToUint(vec3(clip.xy, viewDepth(relative, view))));
}

vec4 clipVertex(uint index)
{
	vec3 stored = uintBitsToFloat(keptVertex(index));
	return clipAt(stored.xy, stored.z, frame_view);
}

// A vertex that is inside the guard band. `projected`, here and below: no vertex of the item lies outside it, so that all are kept projected.
ScreenVertex screenVertex(uint index, bool projected, View view)
{
	return projected ? keptScreenVertex(index) : toScreen(clipVertex(index), view);
}

bool allInside(uvec3 corners, bool projected, View view)
{
	return projected || (insideGuard(clipVertex(corners.x), view) && insideGuard(clipVertex(corners.y), view) &&
	                                    insideGuard(clipVertex(corners.z), view));
}

int64_t edgeAt(ivec2 from, ivec2 edge, ivec2 point)
{
	ivec2 offset = point - from;
	return int64_t(edge.x) * int64_t(offset.y) - int64_t(edge.y) * int64_t(offset.x) - int64_t(edgeBias(edge));
}

// The workgroup rasterises one triangle of any size: lanes stride over the pixels of its box, 8 columns at a time.
void rasterWide(VisibilityRef target, ScreenVertex a, ScreenVertex b, ScreenVertex c, PixelBox box, uint payload, View view)
{
	ivec2 bc = c.position - b.position;
	ivec2 ca = a.position - c.position;
	ivec2 ab = b.position - a.position;
	ivec2 ac = c.position - a.position;
	float area = float(int64_t(ab.x) * int64_t(ac.y) - int64_t(ab.y) * int64_t(ac.x));
	DepthPlane plane = depthPlane(a, b, c, area, edgeBias(ca), edgeBias(ab));
	ivec2 lane = ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
	int rows = int(gl_WorkGroupSize.x >> 3);
	for (int y = box.low.y + lane.y; y <= box.high.y; y += rows)
		for (int x = box.low.x + lane.x; x <= box.high.x; x += 8)
		{
			ivec2 point = ivec2(x, y) * SUBPIXELS + SUBPIXELS / 2;
			int64_t edge_a = edgeAt(b.position, bc, point);
			int64_t edge_b = edgeAt(c.position, ca, point);
			int64_t edge_c = edgeAt(a.position, ab, point);
			if ((edge_a | edge_b | edge_c) < 0l)
				continue;
			writeVisibility(target, ivec2(x, y), depthAt(plane, float(edge_b), float(edge_c)), payload, view);
		}
}

// How far a point lies inside the sides of the view; negative outside, whatever the sign of w.
vec4 insideSides(vec4 clip) { return vec4(clip.w + clip.x, clip.w - clip.x, clip.w + clip.y, clip.w - clip.y); }

bool isBeyondOneSide(vec4 a, vec4 b, vec4 c)
{
	vec4 sides = max(insideSides(a), max(insideSides(b), insideSides(c)));
	float before_near = max(a.w - a.z, max(b.w - b.z, c.w - c.z));
	return any(lessThan(sides, vec4(0.0))) || before_near < 0.0;
}

void leaveWide(uint triangle)
{
	atomicOr(raster_wide[triangle >> 5], 1u << (triangle & 31u));
	raster_any_wide = 1u;
}

// One lane takes its rows of triangle `triangle` of its workgroup, when it is small; leaves it to rasterLeft otherwise.
void rasterTriangle(VisibilityRef target, uint triangle, uvec3 corners, Rows rows, uint payload, bool two_sided, bool projected, View view)
{
	if (!allInside(corners, projected, view))
	{
		if (!isBeyondOneSide(clipVertex(corners.x), clipVertex(corners.y), clipVertex(corners.z)))
			leaveWide(triangle);
		return;
	}
	ScreenVertex a = screenVertex(corners.x, projected, view), b = screenVertex(corners.y, projected, view), c = screenVertex(corners.z, projected, view);
	if (!rasterUnlessLarge(target, a, b, c, rows, payload, two_sided, view))
		leaveWide(triangle);
}

// Distance to clip plane `plane` (near, then the guard band's sides); inside when not negative.
float clipDistance(vec4 clip, uint plane, View view)
{
	float limit_x = GUARD_PX * 2.0 / float(view.width_px);
	float limit_y = GUARD_PX * 2.0 / float(view.height_px);
	switch (plane)
	{
	case 0u: return clip.w - clip.z;
	case 1u: return clip.w * limit_x - clip.x;
	case 2u: return clip.w * limit_x + clip.x;
	case 3u: return clip.w * limit_y - clip.y;
	default: return clip.w * limit_y + clip.y;
	}
}

// Sutherland and Hodgman (1974), by one lane. A new point is always computed from the inside end to the outside one, so
// that both neighbours of an edge get the same.
void clipPolygon(vec4 a, vec4 b, vec4 c, View view)
{
	raster_polygon[0][0] = a;
	raster_polygon[0][1] = b;
	raster_polygon[0][2] = c;
	uint count = 3u;
	for (uint plane = 0u; plane < 5u; ++plane)
	{
		uint from = plane & 1u, to = from ^ 1u, kept = 0u;
		for (uint i = 0u; i < count; ++i)
		{
			vec4 p = raster_polygon[from][i];
			vec4 q = raster_polygon[from][i + 1u == count ? 0u : i + 1u];
			precise float p_distance = clipDistance(p, plane, view);
			precise float q_distance = clipDistance(q, plane, view);
			if (p_distance >= 0.0)
				raster_polygon[to][kept++] = p;
			if ((p_distance >= 0.0) == (q_distance >= 0.0))
				continue;
			bool p_inside = p_distance >= 0.0;
			precise vec4 inside = p_inside ? p : q;
			precise vec4 outside = p_inside ? q : p;
			precise float inside_distance = p_inside ? p_distance : q_distance;
			precise float outside_distance = p_inside ? q_distance : p_distance;
			precise float along = inside_distance * exactReciprocal(inside_distance - outside_distance);
			precise vec4 step = outside - inside;
			precise vec4 crossing = inside + step * along;
			raster_polygon[to][kept++] = crossing;
		}
		count = kept;
		if (count == 0u)
			break;
	}
	raster_polygon_size = count;
}

void rasterWideCorners(VisibilityRef target, ScreenVertex a, ScreenVertex b, ScreenVertex c, uint payload, bool two_sided, View view)
{
	ivec2 side_b = b.position - a.position;
	ivec2 side_c = c.position - a.position;
	int64_t area = int64_t(side_b.x) * int64_t(side_c.y) - int64_t(side_b.y) * int64_t(side_c.x);
	if (!orient(b, c, area > 0l ? 1 : (area < 0l ? -1 : 0), two_sided))
		return;
	rasterWide(target, a, b, c, pixelBox(a.position, b.position, c.position, view), payload, view);
}

// The whole workgroup does one triangle that a single lane left.
void rasterLeft(VisibilityRef target, uvec3 corners, uint payload, bool two_sided, bool projected, View view)
{
	if (allInside(corners, projected, view))
	{
		rasterWideCorners(target, screenVertex(corners.x, projected, view), screenVertex(corners.y, projected, view),
		                  screenVertex(corners.z, projected, view), payload, two_sided, view);
		return;
	}
	if (gl_LocalInvocationIndex == 0u)
		clipPolygon(clipVertex(corners.x), clipVertex(corners.y), clipVertex(corners.z), view);
	barrier();
	// Five planes: the clipped polygon lies in the second array.
	for (uint corner = 2u; corner < raster_polygon_size; ++corner)
		rasterWideCorners(target, toScreen(raster_polygon[1][0], view), toScreen(raster_polygon[1][corner - 1u], view),
		                  toScreen(raster_polygon[1][corner], view), payload, two_sided, view);
	barrier();
}

#endif
