// shade: colour every pixel from the visibility image, whoever produced it.
//
//   in   visibility_depth, visibility_payload   from drawing passes; depth 0 is background
//   in   visibility_buffer                      from raster_micro; emptied here for the next frame
//   in   part_triangles, visible_clusters, surface, shading data
//   in   sun_visibility, ambient_visibility     from trace_shadows and trace_ambient, where those run
//   out  picture   RGBA8, sRGB-encoded
//   out  counts    covered_pixels
//
// The payload names a micro-triangle, depth the point on it. For the picture, that point tells the place on the base
// triangle (lib/surface_place.glsl), and normals come from the height map there; debug views and facets evaluate the
// micro-triangle's corners again. One workgroup a tile; as many rows of threads as the device likes, each thread takes pixels of its column.
// Host: src/pipeline/shading/shade.cpp   Test: tests/gpu/picture_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_nonuniform_qualifier : require
// Before every include: glslang takes a workgroup size that is used before it is declared for 1.
layout(local_size_x = 16, local_size_y_id = 0) in;
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "shading/shade.h"
#include "lib/visibility_buffer.glsl"
#include "lib/debug_colors.glsl"
#include "lib/lighting.glsl"
#include "lib/pixel_ray.glsl"
#include "lib/shading_normal.glsl"
#include "lib/surface_place.glsl"
#include "lib/visible_triangle.glsl"

layout(push_constant, scalar) uniform Args { ShadeArgs args; };
layout(set = 0, binding = 0) uniform sampler2D color_textures[];
layout(set = 0, binding = 1) uniform utexture2D visibility_payload;
layout(set = 0, binding = 2) uniform texture2D visibility_depth;

const uint TILE_ROWS = 16u;

shared uint covered;

// A pixel's place on the surface.
struct SurfacePixel
{
	VisibleTriangle visible;
	vec3 weights;       // within the base triangle
	vec3 normal;        // world space, unit, towards the eye
	vec3 to_eye;        // world space, unit
	float displacement;
	vec3 weights_x;     // change of the weights to the pixel at the right, and below
	vec3 weights_y;
};

vec3 weightsAt(VisibleTriangle visible, vec3 barycentrics)
{
	return domainWeights(visible.corners[0]) * barycentrics.x + domainWeights(visible.corners[1]) * barycentrics.y +
	       domainWeights(visible.corners[2]) * barycentrics.z;
}

vec3 barycentricsAt(VisibleTriangle visible, vec2 pixel, View view)
{
	return planeBarycentrics(pixelRay(pixel, view), visible.relative[0], visible.relative[1], visible.relative[2]);
}

vec3 facetNormal(VisibleTriangle visible)
{
	return cross(visible.relative[1] - visible.relative[0], visible.relative[2] - visible.relative[0]);
}

// Mesh to world for normals: the cofactors of the linear part, which no scale can make singular by dividing.
vec3 worldNormal(vec3 normal, Placement placement)
{
	mat3 cofactors = mat3(cross(placement.row1, placement.row2), cross(placement.row2, placement.row0), cross(placement.row0, placement.row1));
	return vec3(dot(cofactors[0], normal), dot(cofactors[1], normal), dot(cofactors[2], normal));
}

vec3 smoothNormal(inout SurfacePixel pixel, View view)
{
	BaseTriangle base = pixel.visible.base;
	// Read once, as directions, where they are the same.
	vec3Ref normals = HAS_DIRECTIONS && DIRECTIONS_ARE_NORMALS ? frame_surface.directions : args.shading.at[0].normals;
	vec3 authored[3] = vec3[3](normals.at[base.v0], normals.at[base.v1], normals.at[base.v2]);
	ShadingSurface surface = displacedNormal(frame_surface, base, pixel.weights, authored, pixel.visible.placement, view);
	pixel.displacement = surface.displacement;
	return worldNormal(surface.normal, pixel.visible.placement);
}

// The same at a place that depth told: in world space, from how that place's point moves, so that little is held while heights are read.
vec3 smoothNormalAt(inout SurfacePixel pixel, TriangleCorners corners, SurfacePlace place, vec3 point, View view)
{
	BaseTriangle base = pixel.visible.base;
	Placement placement = pixel.visible.placement;
	vec3 weights = pixel.weights;
	vec3 normals[3];
	if (HAS_DIRECTIONS && DIRECTIONS_ARE_NORMALS)
		normals = vec3[3](corners.direction0, corners.direction1, corners.direction2);
	else
	{
		vec3Ref of_vertices = args.shading.at[0].normals;
		normals = vec3[3](of_vertices.at[base.v0], of_vertices.at[base.v1], of_vertices.at[base.v2]);
	}
	vec3 authored = authoredNormal(corners, normals, weights);
	vec3 normal = worldNormal(authored, placement);
	normal = pixel.visible.mirrored != 0u ? -normal : normal;
	if (!HAS_DISPLACEMENT || base.height_map == NO_INDEX || dot(normal, normal) == 0.0)
		return normal;
	vec3 direction = placedDirection(normalize(authored), placement);
	HeightSource source = ownHeightSource(corners, base.height_map, weights);
	float level = pixelHeightLevel(point, placement, source.density, HEIGHT_MAP(frame_surface, base.height_map, level_count), view);
	HeightSlope height = displacementSlope(frame_surface, base.height_map, source.uv, level);
	pixel.displacement = (height.height + view.displacement_offset) * view.displacement_scale;
	vec2 slope = height.slope * view.displacement_scale;
	return turnedNormal(normalize(normal), place.by_u, place.by_v, direction, dot(slope, corners.uv0 - corners.uv2), dot(slope, corners.uv1 - corners.uv2));
}

bool showsBothSides(uint material)
{
	if (!HAS_MIXED_SIDES)
		return !HAS_SINGLE_SIDED;
	return (args.inputs.material_flags.at[material] & MATERIAL_DOUBLE_SIDED) != 0u;
}

// The corners again, read once the place is known and not before: what is held while it is searched decides how many threads are resident. No
// weight is that large.
TriangleCorners cornersAfter(BaseTriangle base, SurfacePlace place)
{
	uint none = place.weights.x > 1e6 ? 1u : 0u;
	base.v0 += none;
	base.v1 += none;
	base.v2 += none;
	return triangleCorners(frame_surface, base);
}

// The place and normal from where the pixel's depth lies.
void placeByDepth(inout SurfacePixel pixel, float depth, vec2 centre, View view)
{
	VisibleTriangle visible = pixel.visible;
	vec3 start = (domainWeights(visible.piece.c0) + domainWeights(visible.piece.c1) + domainWeights(visible.piece.c2)) / 3.0;
	TriangleCorners corners = triangleCorners(frame_surface, visible.base);
	vec3 point = visiblePoint(pixelRay(centre, view), depth, view);
	SurfacePlace place = placeOf(point, corners, visible.placement, start);
	pixel.weights = insideBarycentrics(place.weights);
	vec3 normal = smoothNormalAt(pixel, cornersAfter(visible.base, place), place, point, view);
	pixel.normal = normalize(dot(normal, normal) > 0.0 ? normal : pixel.to_eye);
	if (dot(pixel.normal, pixel.to_eye) < 0.0 && showsBothSides(visible.material))
		pixel.normal = -pixel.normal;
	if (HAS_COLOR_TEXTURES)
	{
		pixel.weights_x = placeChange(place, point, pixel.normal, pixelRay(centre + vec2(1.0, 0.0), view));
		pixel.weights_y = placeChange(place, point, pixel.normal, pixelRay(centre + vec2(0.0, 1.0), view));
	}
}

// The same by the micro-triangle's own corners.
void placeByCorners(inout SurfacePixel pixel, vec2 centre, View view)
{
	vec3 here = barycentricsAt(pixel.visible, centre, view);
	pixel.weights = weightsAt(pixel.visible, insideBarycentrics(here));
	if (HAS_COLOR_TEXTURES)
	{
		pixel.weights_x = weightsAt(pixel.visible, barycentricsAt(pixel.visible, centre + vec2(1.0, 0.0), view)) - weightsAt(pixel.visible, here);
		pixel.weights_y = weightsAt(pixel.visible, barycentricsAt(pixel.visible, centre + vec2(0.0, 1.0), view)) - weightsAt(pixel.visible, here);
	}
	vec3 facet = facetNormal(pixel.visible);
	vec3 normal = HAS_SMOOTH_NORMALS && (args.view_mode & ~VIEW_WITH_WIREFRAME) != VIEW_FACETS ? smoothNormal(pixel, view) : facet;
	pixel.normal = normalize(dot(normal, normal) > 0.0 ? normal : pixel.to_eye);
	// Faceted normals and double-sided materials face the eye; smooth ones may lean a little behind the horizon.
	bool back = dot(facet, pixel.to_eye) < 0.0;
	if (back == (dot(pixel.normal, facet) > 0.0))
		pixel.normal = -pixel.normal;
}

SurfacePixel surfacePixel(uint payload, float depth, vec2 centre, View view)
{
	SurfacePixel pixel;
	pixel.visible = visibleTriangle(args.inputs, payload);
	pixel.displacement = 0.0;
	pixel.to_eye = -normalize(pixelRay(centre, view).direction);
	if (EXACT_PLACES)
		placeByCorners(pixel, centre, view);
	else
		placeByDepth(pixel, depth, centre, view);
	return pixel;
}

vec2 colorUvAt(BaseTriangle base, vec3 weights)
{
	ShadingData shading = args.shading.at[0];
	return shading.color_uvs.at[base.v0] * weights.x + shading.color_uvs.at[base.v1] * weights.y + shading.color_uvs.at[base.v2] * weights.z;
}

// Base colour texture, filtered over the pixel.
vec3 texturedColor(SurfacePixel pixel, uint texture_index)
{
	BaseTriangle base = pixel.visible.base;
	return textureGrad(color_textures[nonuniformEXT(texture_index)], colorUvAt(base, pixel.weights), colorUvAt(base, pixel.weights_x),
	                   colorUvAt(base, pixel.weights_y)).rgb;
}

SurfaceColor materialColor(SurfacePixel pixel)
{
	ShadingData shading = args.shading.at[0];
	MaterialRecord material = shading.materials.at[pixel.visible.material];
	SurfaceColor color = SurfaceColor(material.base_color.rgb, material.emissive, material.metallic, material.roughness);
	if (HAS_COLOR_TEXTURES && material.color_texture != NO_INDEX)
		color.base *= texturedColor(pixel, material.color_texture);
	if (HAS_VERTEX_COLORS)
	{
		BaseTriangle base = pixel.visible.base;
		color.base *= unpackUnorm4x8(shading.colors.at[base.v0]).rgb * pixel.weights.x + unpackUnorm4x8(shading.colors.at[base.v1]).rgb * pixel.weights.y +
		              unpackUnorm4x8(shading.colors.at[base.v2]).rgb * pixel.weights.z;
	}
	return color;
}

// Distance, in pixels, to the nearest side of the micro-triangle (or of the base triangle).
float sideDistance(vec3 at, vec3 at_x, vec3 at_y)
{
	vec3 per_pixel = max(sqrt((at_x - at) * (at_x - at) + (at_y - at) * (at_y - at)), vec3(1e-20));
	vec3 distances = abs(at) / per_pixel;
	return min(distances.x, min(distances.y, distances.z));
}

vec3 wireframe(vec3 color, SurfacePixel pixel, vec2 centre, View view)
{
	vec3 b = barycentricsAt(pixel.visible, centre, view);
	vec3 b_x = barycentricsAt(pixel.visible, centre + vec2(1.0, 0.0), view);
	vec3 b_y = barycentricsAt(pixel.visible, centre + vec2(0.0, 1.0), view);
	float micro = sideDistance(b, b_x, b_y);
	float base = sideDistance(weightsAt(pixel.visible, b), weightsAt(pixel.visible, b_x), weightsAt(pixel.visible, b_y));
	color = mix(color * 0.15, color, smoothstep(0.3, 0.9, micro));
	return mix(vec3(0.9, 0.45, 0.05), color, smoothstep(0.5, 1.1, base));
}

// Half-Lambert light from the eye, so that debug colours keep the shape visible.
vec3 shaped(vec3 color, SurfacePixel pixel) { return color * (0.55 + 0.45 * max(dot(pixel.normal, pixel.to_eye), 0.0)); }

vec2 pixelOf(vec3 relative, View view)
{
	vec4 clip = clipPosition(relative, view);
	return (clip.xy / clip.w * 0.5 + 0.5) * vec2(view.width_px, view.height_px);
}

// Area of the micro-triangle in the picture, square pixels.
float areaPx(VisibleTriangle visible, View view)
{
	vec2 at = pixelOf(visible.relative[0], view);
	vec2 along = pixelOf(visible.relative[1], view) - at;
	vec2 across = pixelOf(visible.relative[2], view) - at;
	return abs(along.x * across.y - along.y * across.x) * 0.5;
}

// How far the micro-triangle is from the surface that it stands for, in pixels at this distance: the same place of the base triangle on
// the surface as a rate eight times finer would sample it.
float errorPx(SurfacePixel pixel, vec2 centre, View view)
{
	VisibleTriangle visible = pixel.visible;
	vec3 b = insideBarycentrics(barycentricsAt(visible, centre, view));
	vec3 seen = visible.relative[0] * b.x + visible.relative[1] * b.y + visible.relative[2] * b.z;
	View finer = view;
	finer.sample_over_focal_squared /= 64.0;
	DomainPoint at;
	at.u = uint(clamp(pixel.weights.x, 0.0, 1.0) * float(DOMAIN_SIZE));
	at.v = min(uint(clamp(pixel.weights.y, 0.0, 1.0) * float(DOMAIN_SIZE)), DOMAIN_SIZE - at.u);
	vec3 surface = placed(visible.placement, surfacePoint(frame_surface, visible.base, at, visible.placement, finer).displaced);
	float per_unit = view.focal_y * float(view.height_px) * 0.5 / abs(clipPosition(seen, view).w);
	return length(surface - seen) * per_unit;
}

LightVisibility lightAt(vec2 centre, View view)
{
	uint index = uint(centre.y) * view.width_px + uint(centre.x);
	return LightVisibility(HAS_SHADOWS ? args.sun_visibility.at[index] : 1.0, HAS_AMBIENT_OCCLUSION ? args.ambient_visibility.at[index] : 1.0);
}

vec3 debugColor(SurfacePixel pixel, float depth, vec2 centre, View view)
{
	VisibleTriangle visible = pixel.visible;
	switch (args.view_mode & ~VIEW_WITH_WIREFRAME)
	{
	case VIEW_CLUSTERS: return shaped(hashColor(clusterHash(visible)), pixel);
	case VIEW_PARTS: return shaped(hashColor(partHash(visible)), pixel);
	case VIEW_TRIANGLES: return shaped(hashColor(microHash(visible)), pixel);
	case VIEW_FACTORS: return shaped(ramp(float(visible.largest_factor - 1u) / 10.0), pixel);
	case VIEW_DEPTH: return vec3(clamp(log2(depth) / 12.0 + 1.0, 0.0, 1.0));
	case VIEW_NORMALS: return pow(pixel.normal * 0.5 + 0.5, vec3(2.2));
	case VIEW_HEIGHT: return ramp(0.5 + 0.5 * tanh(pixel.displacement * inversesqrt(pixel.visible.placement.inverse_scale_squared) * 12.0));
	case VIEW_INSTANCES: return shaped(hashColor(hashNext(17u, visible.instance)), pixel);
	case VIEW_MATERIALS: return shaped(hashColor(hashNext(29u, visible.material)), pixel);
	case VIEW_PRIMITIVES: return shaped(hashColor(hashNext(clusterHash(visible), visible.triangle)), pixel);
	case VIEW_AREA: return shaped(ramp((log2(max(areaPx(visible, view), 1e-6)) + 4.0) / 12.0), pixel);
	case VIEW_ERROR: return ramp((log2(max(errorPx(pixel, centre, view), 1e-6)) + 6.0) / 10.0);
	case VIEW_WIREFRAME: return wireframe(vec3(0.55) * (0.3 + 0.7 * max(dot(pixel.normal, pixel.to_eye), 0.0)), pixel, centre, view);
	default: return litColor(materialColor(pixel), pixel.normal, pixel.to_eye, lightAt(centre, view));
	}
}

// What a pixel sees.
struct Visibility
{
	float depth;
	uint payload;  // NO_INDEX: seen in an earlier round and shaded there
};

uint roundIndex() { return args.rounds & 0xffffu; }
uint roundCount() { return args.rounds >> 16; }

// Reads a word of the buffer and leaves it empty, or, between rounds, with its depth only.
Visibility takeFromBuffer(uint index)
{
	VisibilityRef buffer_words = VisibilityRef(args.visibility);
	uint64_t word = buffer_words.at[index];
	if (word != 0ul)
		buffer_words.at[index] = roundIndex() + 1u == roundCount() ? 0ul : word | 0xfffffffful;
	return Visibility(uintBitsToFloat(uint(word >> 32)), uint(word));
}

Visibility visibilityAt(uvec2 place, uint index)
{
	if (READS_BUFFER)
		return takeFromBuffer(index);
	return Visibility(texelFetch(visibility_depth, ivec2(place), 0).x, texelFetch(visibility_payload, ivec2(place), 0).x);
}

// True when something is seen there.
bool shadePlace(uvec2 place, View view)
{
	uint target = place.y * view.width_px + place.x;
	vec2 centre = vec2(place) + 0.5;
	Visibility visibility = visibilityAt(place, target);
	if (visibility.depth == 0.0)
	{
		if (roundIndex() == 0u)
			args.picture.at[target] = background(pixelRay(centre, view).direction);
		return false;
	}
	if (roundCount() > 1u && visibility.payload == NO_INDEX)
		return true;
	SurfacePixel pixel = surfacePixel(visibility.payload, visibility.depth, centre, view);
	if (IS_SHADED_VIEW)
		args.picture.at[target] = encodePicture(litColor(materialColor(pixel), pixel.normal, pixel.to_eye, lightAt(centre, view)), true);
	else
	{
		vec3 color = debugColor(pixel, visibility.depth, centre, view);
		uint mode = args.view_mode & ~VIEW_WITH_WIREFRAME;
		if ((args.view_mode & VIEW_WITH_WIREFRAME) != 0u)
			color = wireframe(color, pixel, centre, view);
		args.picture.at[target] = encodePicture(color, mode == VIEW_FACETS || mode == VIEW_SHADED);
	}
	return true;
}

// Pixels of the thread's part of its column that see something.
uint shadeColumn()
{
	View view = frame_view;
	uint count = 0u;
	for (uint row = gl_LocalInvocationID.y; row < TILE_ROWS; row += gl_WorkGroupSize.y)
	{
		uvec2 place = uvec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y * TILE_ROWS + row);
		if (place.x < view.width_px && place.y < view.height_px && shadePlace(place, view))
			++count;
	}
	return count;
}

void main()
{
	// A processor counts on its own: barriers cost it more than atomics.
	if (gl_WorkGroupSize.y == 1u)
	{
		uint count = shadeColumn();
		if (count > 0u)
			atomicAdd(args.counts.at[0].covered_pixels, count);
		return;
	}
	if (gl_LocalInvocationIndex == 0u)
		covered = 0u;
	barrier();
	uint count = shadeColumn();
	if (count > 0u)
		atomicAdd(covered, count);
	barrier();
	if (gl_LocalInvocationIndex == 0u && covered > 0u)
		atomicAdd(args.counts.at[0].covered_pixels, covered);
}
