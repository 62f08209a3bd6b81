// A rasteriser in compute: vertices in shared memory, a lane per small triangle. lib/soft_raster_large.glsl takes what is not small.
//
// Positions snap to 1/256 pixel, edge functions are exact integers and the top-left rule decides ties, so neighbours leave
// no gap and cover no pixel twice. Depth and payload go into one 64-bit word per pixel by atomicMax: reverse z, nearer is
// larger. Source: Pineda, A Parallel Algorithm for Polygon Rasterization (1988).
#ifndef TESSERA_LIB_SOFT_RASTER
#define TESSERA_LIB_SOFT_RASTER
#include "lib/visibility_buffer.glsl"
#include "shared/lists.h"
#include "shared/view.h"
#include "shared/visibility.h"

const int SUBPIXELS = SCREEN_SUBPIXELS;
const float GUARD_PX = 16384.0;    // beyond this, positions would not fit the integers
const int SMALL_BOX_PX = 256;      // pixels of bounding box up to which one lane does it alone, or each of those that share its rows

struct ScreenVertex
{
	ivec2 position;  // 1/256 pixels, y down
	float depth;
};

// What is shared decides how many workgroups are resident, so vertices are held once and in three words: screen position and depth.
const uint MAX_RASTER_VERTICES = RASTER_BATCH_VERTICES;
shared uint raster_vertices[3u * MAX_RASTER_VERTICES];  // words: vectors of three would take four
shared uint raster_has_outside;                         // 1: a vertex lies outside the guard band, and was not stored

// 1 / w by a bit-trick start and Newton steps: the same bits in every shader, so neighbours in different passes agree.
precise float exactReciprocal(float w)
{
	precise float inverse = uintBitsToFloat(0x7ef311c7u - floatBitsToUint(w));
	for (int step = 0; step < 4; ++step)
	{
		precise float product = w * inverse;
		precise float correction = 2.0 - product;
		inverse = inverse * correction;
	}
	return inverse;
}

bool insideGuard(vec4 clip, View view)
{
	float limit = clip.w * (2.0 * GUARD_PX * float(SUBPIXELS));
	return clip.w > 0.0 && clip.z <= clip.w && abs(clip.x) * view.width_subpixels <= limit && abs(clip.y) * view.height_subpixels <= limit;
}

ScreenVertex toScreen(vec4 clip, View view)
{
	precise float inverse = exactReciprocal(clip.w);
	precise float x = clip.x * inverse * 0.5 + 0.5;
	precise float y = clip.y * inverse * 0.5 + 0.5;
	precise float x_subpixels = x * view.width_subpixels;
	precise float y_subpixels = y * view.height_subpixels;
	precise float depth = clip.z * inverse;
	return ScreenVertex(ivec2(floor(vec2(x_subpixels, y_subpixels) + 0.5)), depth);
}

void keepVertex(uint index, uvec3 words)
{
	raster_vertices[3u * index] = words.x;
	raster_vertices[3u * index + 1u] = words.y;
	raster_vertices[3u * index + 2u] = words.z;
}

uvec3 keptVertex(uint index) { return uvec3(raster_vertices[3u * index], raster_vertices[3u * index + 1u], raster_vertices[3u * index + 2u]); }

void storeScreenVertex(uint index, vec4 clip, View view)
{
	if (insideGuard(clip, view))
	{
		ScreenVertex screen = toScreen(clip, view);
		keepVertex(index, uvec3(uvec2(screen.position), floatBitsToUint(screen.depth)));
	}
	else
		raster_has_outside = 1u;
}

ScreenVertex keptScreenVertex(uint index)
{
	uvec3 stored = keptVertex(index);
	return ScreenVertex(ivec2(stored.xy), uintBitsToFloat(stored.z));
}

void writeVisibility(VisibilityRef target, ivec2 pixel, float depth, uint payload, View view)
{
	// Depth 0 is background: what is infinitely far is not seen.
	if (depth > 0.0)
		atomicMax(target.at[uint(pixel.y) * view.width_px + uint(pixel.x)], (uint64_t(floatBitsToUint(depth)) << 32) | uint64_t(payload));
}

// Pixels whose centres the box of three points spans, within the picture; empty when high < low.
struct PixelBox
{
	ivec2 low;
	ivec2 high;
};

PixelBox pixelBox(ivec2 a, ivec2 b, ivec2 c, View view)
{
	ivec2 low = min(a, min(b, c));
	ivec2 high = max(a, max(b, c));
	const int half_pixel = SUBPIXELS / 2;
	PixelBox box;
	box.low = max((low + (SUBPIXELS - 1 - half_pixel)) >> 8, ivec2(0));
	box.high = min((high - half_pixel) >> 8, ivec2(view.width_px, view.height_px) - 1);
	return box;
}

// 1 where a point exactly on the edge does not belong to the triangle (clockwise on screen, y down).
int edgeBias(ivec2 edge) { return edge.y < 0 || (edge.y == 0 && edge.x > 0) ? 0 : 1; }

// Sorts corners clockwise on screen, given the sign of their doubled area. False when the triangle has no area or shows
// its back and may not.
bool orient(inout ScreenVertex b, inout ScreenVertex c, int area_sign, bool two_sided)
{
	if (area_sign == 0 || (area_sign > 0 && !two_sided))
		return false;
	if (area_sign < 0)
	{
		ScreenVertex swapped = b;
		b = c;
		c = swapped;
	}
	return true;
}

// Depth over a triangle: linear in its edge functions. The same bits whoever takes the triangle, one lane, several or a workgroup: so each step is one
// operation that no compiler can round in two ways.
struct DepthPlane
{
	float base;
	float slope_b;
	float slope_c;
};

// `area`: doubled, positive, 1/256 pixels squared. Edge functions are lowered by their bias, which `base` makes up for.
DepthPlane depthPlane(ScreenVertex a, ScreenVertex b, ScreenVertex c, float area, int bias_b, int bias_c)
{
	precise float inverse_area = 1.0 / area;
	precise float slope_b = (b.depth - a.depth) * inverse_area;
	precise float slope_c = (c.depth - a.depth) * inverse_area;
	return DepthPlane(fma(float(bias_c), slope_c, fma(float(bias_b), slope_b, a.depth)), slope_b, slope_c);
}

float depthAt(DepthPlane plane, float edge_b, float edge_c) { return fma(edge_c, plane.slope_c, fma(edge_b, plane.slope_b, plane.base)); }

// A lane's rows of a triangle: every `count`-th, from the `index`-th on.
struct Rows
{
	int index;
	int count;
};

const Rows ALL_ROWS = Rows(0, 1);

// One lane rasterises its rows of a triangle of a small box: 32-bit integers suffice there.
void rasterSmall(VisibilityRef target, ScreenVertex a, ScreenVertex b, ScreenVertex c, PixelBox box, Rows rows, uint payload, bool two_sided,
                 View view)
{
	ivec2 side_b = b.position - a.position;
	ivec2 side_c = c.position - a.position;
	int area = side_b.x * side_c.y - side_b.y * side_c.x;
	if (!orient(b, c, area, two_sided))
		return;
	box.low.y += rows.index;
	ivec2 first = box.low * SUBPIXELS + SUBPIXELS / 2;
	ivec2 bc = c.position - b.position;
	ivec2 ca = a.position - c.position;
	ivec2 ab = b.position - a.position;
	ivec2 from_b = first - b.position;
	ivec2 from_a = first - a.position;
	int bias_b = edgeBias(ca);
	int bias_c = edgeBias(ab);
	int row_a = bc.x * from_b.y - bc.y * from_b.x - edgeBias(bc);
	int row_b = ca.x * from_a.y - ca.y * from_a.x - bias_b;
	int row_c = ab.x * from_a.y - ab.y * from_a.x - bias_c;
	DepthPlane plane = depthPlane(a, b, c, float(abs(area)), bias_b, bias_c);
	int row_step = SUBPIXELS * rows.count;
	for (int y = box.low.y; y <= box.high.y; y += rows.count)
	{
		int edge_a = row_a, edge_b = row_b, edge_c = row_c;
		for (int x = box.low.x; x <= box.high.x; ++x)
		{
			if ((edge_a | edge_b | edge_c) >= 0)
				writeVisibility(target, ivec2(x, y), depthAt(plane, float(edge_b), float(edge_c)), payload, view);
			edge_a -= bc.y * SUBPIXELS;
			edge_b -= ca.y * SUBPIXELS;
			edge_c -= ab.y * SUBPIXELS;
		}
		row_a += bc.x * row_step;
		row_b += ca.x * row_step;
		row_c += ab.x * row_step;
	}
}

ivec2 boxSize(PixelBox box) { return box.high - box.low + 1; }

// One lane rasterises its rows of a triangle, unless that is too large: then it does nothing and says so.
bool rasterUnlessLarge(VisibilityRef target, ScreenVertex a, ScreenVertex b, ScreenVertex c, Rows rows, uint payload, bool two_sided, View view)
{
	PixelBox box = pixelBox(a.position, b.position, c.position, view);
	if (any(greaterThan(box.low, box.high)))
		return true;
	ivec2 span = max(a.position, max(b.position, c.position)) - min(a.position, min(b.position, c.position));
	ivec2 size = boxSize(box);
	if (max(span.x, span.y) >= 64 * SUBPIXELS || size.x * size.y > SMALL_BOX_PX * rows.count)
		return false;
	rasterSmall(target, a, b, c, box, rows, payload, two_sided, view);
	return true;
}

#endif
