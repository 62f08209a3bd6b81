#include "plan/conditions.h"
#include "plan/plan.h"

namespace tessera
{

// Constant ids are those of shaders/lib/features.glsl.
std::vector<Feature> shaderFeatures(const PlanInput& input)
{
	struct Constant
	{
		std::string_view name;
		uint32_t id;
		const Condition* condition;
	};
	static constexpr Constant kConstants[] = {
		{ "HAS_DISPLACEMENT", 1, &kDisplaced },
		{ "HAS_SEAMS", 2, &kSeams },
		{ "HAS_PN", 28, &kPn },
		{ "HAS_TESSELLATION", 3, &kAsksForTessellation },
		{ "HAS_COLOR_TEXTURES", 4, &kColorTextures },
		{ "HAS_VERTEX_COLORS", 5, &kVertexColors },
		{ "HAS_SMOOTH_NORMALS", 6, &kNormals },
		{ "HAS_CULLING", 7, &kCulls },
		{ "HAS_MIXED_SIDES", 8, &kMixedSides },
		{ "SIDES_IN_FRAGMENTS", 42, &kSidesInFragments },
		{ "HAS_MIRRORED_INSTANCES", 9, &kMirroredInstances },
		{ "HAS_SINGLE_SIDED", 10, &kSingleSided },
		{ "IS_SHADED_VIEW", 11, &kShadedView },
		{ "KEEPS_VERTICES", 12, &kKeepsVertices },
		{ "EXPANDS_TRIANGLES", 13, &kExpands },
		{ "READS_BUFFER", 14, &kBuffered },
		{ "HAS_HEIGHT_U8", 15, &kHeightU8 },
		{ "HAS_HEIGHT_U16", 16, &kHeightU16 },
		{ "HAS_HEIGHT_F32", 17, &kHeightF32 },
		{ "HAS_WRAP_REPEAT", 18, &kWrapRepeat },
		{ "HAS_WRAP_CLAMP", 19, &kWrapClamp },
		{ "HAS_WRAP_MIRROR", 20, &kWrapMirror },
		{ "HAS_MANY_HEIGHT_MAPS", 21, &kManyHeightMaps },
		{ "HAS_HEIGHT_FOOTPRINTS", 40, &kHeightFootprints },
		{ "SMALL_FIRST", 41, &kSmallFirst },
		{ "HAS_OCCLUSION", 23, &kMayHide },
		{ "HAS_RAYS", 24, &kRays },
		{ "KEEPS_PLACES", 27, &kKeepsPlaces },
		{ "SHARES_STRUCTURES", 55, &kSharesStructures },
		{ "BUILDS_CLUSTERS", 50, &kClusters },
		{ "HAS_TRANSIENT_UNITS", 51, &kTransientUnits },
		{ "HAS_TRANSIENT_GROUPS", 52, &kTransientGroups },
		{ "HAS_SHADOWS", 25, &kShadows },
		{ "HAS_AMBIENT_OCCLUSION", 26, &kAmbientOcclusion },
		{ "HAS_DETAIL", 30, &kDetailMetric },
		{ "HAS_DISPLACED_EDGES", 31, &kDisplacedMetric },
		{ "HAS_RAY_FALLOFF", 53, &kRayFalloff },
		{ "HAS_HIDDEN_FALLOFF", 54, &kHiddenFalloff },
		{ "DIRECTIONS_ARE_NORMALS", 22, &kDirectionsAreNormals },
	};
	std::vector<Feature> features;
	for (const Constant& constant : kConstants)
	{
		const bool on = constant.condition->holds(input);
		features.push_back({ constant.name, constant.id, on, on ? std::string_view() : constant.condition->reason_if_not, constant.condition });
	}
	return features;
}

}  // namespace tessera
