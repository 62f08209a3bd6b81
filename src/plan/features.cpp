#include "plan/conditions.h"
#include "plan/plan.h"
#include "shared/geometry.h"

namespace tessera
{

// Constant ids are those of shaders/lib/features.glsl.
std::vector<Feature> shaderFeatures(const PlanInput& input)
{
	const auto feature = [&](std::string_view name, uint32_t id, bool on, std::string_view reason) {
		return Feature{ name, id, on, on ? std::string_view{} : reason };
	};
	const auto conditional = [&](std::string_view name, uint32_t id, const Condition& condition) {
		return feature(name, id, condition.holds(input), condition.reason_if_not);
	};
	const bool mixed_sides = input.scene.has_single_sided && input.scene.has_double_sided;
	return {
		conditional("HAS_DISPLACEMENT", 1, kDisplaced),
		conditional("HAS_SEAMS", 2, kSeams),
		conditional("HAS_PN", 28, kPn),
		feature("HAS_TESSELLATION", 3, input.options.rate > 0, "the rate is 0"),
		conditional("HAS_COLOR_TEXTURES", 4, kColorTextures),
		conditional("HAS_VERTEX_COLORS", 5, kVertexColors),
		conditional("HAS_SMOOTH_NORMALS", 6, kNormals),
		conditional("HAS_CULLING", 7, kCulls),
		feature("HAS_MIXED_SIDES", 8, mixed_sides, "all materials show the same sides"),
		feature("HAS_MIRRORED_INSTANCES", 9, input.scene.has_mirrored_instances, "no instance is mirrored"),
		feature("HAS_SINGLE_SIDED", 10, input.scene.has_single_sided, "every material is double-sided"),
		feature("IS_SHADED_VIEW", 11, input.options.view == ViewMode::Shaded && !input.options.wireframe, "a debug view or the wireframe is chosen"),
		conditional("KEEPS_VERTICES", 12, kKeepsVertices),
		conditional("EXPANDS_TRIANGLES", 13, kExpands),
		conditional("READS_BUFFER", 14, kBuffered),
		feature("HAS_HEIGHT_U8", 15, input.scene.has_height_u8, "no height map has 8-bit texels"),
		feature("HAS_HEIGHT_U16", 16, input.scene.has_height_u16, "no height map has 16-bit texels"),
		feature("HAS_HEIGHT_F32", 17, input.scene.has_height_f32, "no height map has float texels"),
		feature("HAS_WRAP_REPEAT", 18, input.scene.has_wrap_repeat, "no height map repeats"),
		feature("HAS_WRAP_CLAMP", 19, input.scene.has_wrap_clamp, "no height map is clamped"),
		feature("HAS_WRAP_MIRROR", 20, input.scene.has_wrap_mirror, "no height map repeats mirrored"),
		feature("HAS_MANY_HEIGHT_MAPS", 21, input.sizes.height_maps > UNIFORM_HEIGHT_MAPS, "the height maps fit into a uniform buffer"),
		conditional("HAS_HEIGHT_FOOTPRINTS", 40, kHeightFootprints),
		conditional("SMALL_FIRST", 41, kSmallFirst),
		conditional("HAS_OCCLUSION", 23, kMayHide),
		conditional("HAS_RAYS", 24, kRays),
		conditional("KEEPS_PLACES", 27, kKeepsPlaces),
		conditional("HAS_SHADOWS", 25, kShadows),
		conditional("HAS_AMBIENT_OCCLUSION", 26, kAmbientOcclusion),
		feature("HAS_DETAIL", 30, input.options.metric == Metric::Detail, "another metric is chosen"),
		feature("HAS_DISPLACED_EDGES", 31, input.options.metric == Metric::Displaced, "another metric is chosen"),
		feature("DIRECTIONS_ARE_NORMALS", 22, input.scene.directions_are_normals, "some direction differs from the normal"),
	};
}

}  // namespace tessera
