// Normals to shade with and directions to displace along, which PN triangles are curved by.
#pragma once
#include "scene/build/weld.h"

namespace tessera
{

struct MeshNormals
{
	// Per corner, unit: the authored normal; where it is missing or zero, the angle-weighted mean of the face normals over the welded
	// fan (smooth, also where glTF asks for flat: a displaced surface has to stay in one piece); where that vanishes, the face normal.
	std::vector<vec3> corner_normals;
	// Per welded vertex: angle-weighted mean of the corner normals of its fan, unit; the normal itself, bit for bit, where all agree;
	// zero where the mean is shorter than 1e-6. Empty unless asked for.
	std::vector<vec3> weld_directions;
	uint32_t zero_directions = 0;
	uint32_t degenerate_triangles = 0;  // of zero area
};

// Sums are in double and in input order: the same input gives the same bits. No component is a negative zero or below 2^-60.
MeshNormals buildNormals(const Mesh& mesh, const MeshCorners& corners, const MeshWeld& weld, bool with_directions);

// Float as the shared maths wants it: negative zeros and magnitudes below 2^-60 become 0, what is not finite too.
float cleanFloat(double value);

}  // namespace tessera
