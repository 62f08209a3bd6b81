// Everything there is to know of what one pixel of a frame sees: read back once, when it is asked for, and found again by the CPU reference.
#pragma once
#include "frame/renderer.h"
#include "reference/host_scene.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tessera::view
{

// A domain triangle on the way from the base triangle to the part that was seen.
struct SplitStep
{
	std::array<DomainPoint, 3> corners;
	std::array<uint32_t, 3> pieces;  // per edge
};

struct InspectedVertex
{
	DomainPoint domain;
	dvec3 position_world = dvec3(0);  // displaced
	vec3 normal_world = vec3(0);      // of the displaced surface's facet there
	float displacement = 0;           // mesh units along the direction
};

struct Inspection
{
	uvec2 pixel = { 0, 0 };
	bool covered = false;
	std::string why_not;  // nothing can be said of the pixel
	ClusterRef cluster = {};
	uint32_t mesh = 0, triangle = 0, source_triangle = 0, material = 0, micro = 0;
	std::string material_name;
	bool is_part = false;                           // else a triangle of a full cluster
	std::array<uint32_t, 3> factors = { 1, 1, 1 };  // in pattern order
	uint32_t config = 0;                            // of the table
	bool mirrored = false;
	std::array<DomainPoint, 3> part = {};
	std::vector<SplitStep> splits;  // from the base triangle down
	uint32_t batch = 0, batch_parts = 0, batch_vertices = 0, batch_triangles = 0;
	uint32_t most_batch_vertices = 0, most_batch_triangles = 0;
	std::array<InspectedVertex, 3> vertices = {};
	double depth_world = 0;  // of the pixel, along the view
	// The pattern, for drawing: points as weights of the part's first two corners, and triangles.
	std::vector<vec2> pattern_points;
	std::vector<uvec3> pattern_triangles;
};

// What a frame must be asked for with (FrameRequest::more_outputs).
inline constexpr std::string_view kInspectionOutputs[] = { "kept_visibility" };

// Of the last frame, which was asked for with kInspectionOutputs and drawn in one round; `view`: that it was tessellated for, `drawn_view`: that it
// was drawn from. Waits for the copies. Errors: those of readLists; the pixel outside the picture.
Result<Inspection> inspectPixel(Renderer& renderer, const reference::HostScene& scene, const FrameResult& result, uvec2 pixel);

}  // namespace tessera::view
