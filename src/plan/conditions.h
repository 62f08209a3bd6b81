// The conditions that passes and uses are kept under, each with what is said when it does not hold.
#pragma once
#include "plan/pass.h"
#include "shared/geometry.h"
#include "shared/ray_sharing.h"

namespace tessera
{

// The producer of visibility and why it is that one.
struct RasterChoice
{
	Raster raster;
	std::string_view reason;
};

// What was asked for or, for `auto`, what measured fastest (docs/performance.md): compute where it can be, unless triangles are so large that
// one workgroup each is too few.
constexpr float kLargestSoftRate = 32;
inline RasterChoice rasterChoice(const PlanInput& input)
{
	if (input.options.raster != Raster::Auto)
		return { input.options.raster, "asked for" };
	const DeviceTraits& device = input.device;
	if (device.buffer_atomics_64 && !device.mesh_shader && !device.fragment_primitive_id)
		return { Raster::Soft, "the device can do nothing else" };
	const Raster drawn = device.mesh_shader ? Raster::Mesh : Raster::Indexed;
	if (!device.buffer_atomics_64)
		return { drawn, device.mesh_shader ? "the device lacks 64-bit buffer atomics" : "the device lacks 64-bit buffer atomics and mesh shaders" };
	if (input.options.rate <= 0)
		return { drawn, "nothing is tessellated: triangles may be large" };
	if (input.options.rate > kLargestSoftRate)
		return { drawn, "segments of more than 32 pixels: triangles are large" };
	return { Raster::Soft, "triangles are small, and compute rasterises those fastest" };
}
inline Raster chosenRaster(const PlanInput& input)
{
	return rasterChoice(input).raster;
}
inline bool usesSoft(const PlanInput& input)
{
	return chosenRaster(input) == Raster::Soft;
}
inline bool usesMesh(const PlanInput& input)
{
	return chosenRaster(input) == Raster::Mesh;
}
inline bool usesIndexed(const PlanInput& input)
{
	return chosenRaster(input) == Raster::Indexed;
}

inline bool usesRt(const PlanInput& input)
{
	return chosenRaster(input) == Raster::Rt;
}

// The other views show no light.
inline bool showsLight(const PlanInput& input)
{
	return input.options.view == ViewMode::Shaded || input.options.view == ViewMode::Facets;
}
inline bool tracesShadows(const PlanInput& input)
{
	return input.options.shadows && showsLight(input);
}
inline bool tracesAmbient(const PlanInput& input)
{
	return input.options.ao_samples > 0 && showsLight(input);
}
// Rays that start at visible surfaces: what they may meet need not be in view.
inline bool tracesLight(const PlanInput& input)
{
	return tracesShadows(input) || tracesAmbient(input);
}
inline bool tracesRays(const PlanInput& input)
{
	return usesRt(input) || tracesLight(input);
}

// What rays are traced through is built from, and why.
struct RayPathChoice
{
	bool clusters;
	std::string_view reason;
};
inline RayPathChoice rayPathChoice(const PlanInput& input)
{
	if (input.options.ray_path == RayPath::Triangles)
		return { false, "asked for" };
	if (!input.device.clusters)
		return { false, input.device.why_no_clusters };
	return { true, input.options.ray_path == RayPath::Clusters ? "asked for" : "the device builds from clusters and templates" };
}
inline bool buildsClusters(const PlanInput& input)
{
	return tracesRays(input) && input.device.rays && rayPathChoice(input).clusters;
}

// Culling that is possible beside the rays of this frame. A caster out of view must be there, whatever side it shows to the eye; what rays are
// traced through is built once, before anything is seen.
inline CullOptions culling(const PlanInput& input)
{
	CullOptions cull = input.options.cull;
	if (tracesLight(input))
		cull = { false, false, false };
	if (tracesRays(input))
		cull.occlusion = false;
	return cull;
}

// Why --force may not make a condition hold.
inline constexpr std::string_view kIsAnAlternative = "it stands for what is done now, not beside it: --raster compares them";
inline constexpr std::string_view kIsLessCode = "it is what is known where the general code is left out: force that";
inline constexpr std::string_view kNeedsDisplacement = "nothing is displaced: force HAS_DISPLACEMENT with it";
inline constexpr std::string_view kTracesNothing = "no ray would be traced: --raster rt, --shadows and --ao show what rays cost";
inline constexpr std::string_view kChoosesTriangles = "options decide which triangles there are";
// Nothing but time depends on it.
inline bool always(const PlanInput&)
{
	return true;
}

inline constexpr Condition kDisplaced = {
	[](const PlanInput& input) { return input.scene.has_displacement && input.options.displacement_scale != 0; }, "no material displaces",
	[](const PlanInput& input) { return !input.scene.has_displacement; }, "--displacement-scale is 0, and normals would be those of displacement"
};
inline constexpr Condition kPn = { [](const PlanInput& input) { return input.scene.has_pn && input.options.rate > 0; },
								   "--pn is off, nothing is tessellated, or no triangle is curved" };
// What a surface that is not flat needs.
inline constexpr Condition kUneven = { [](const PlanInput& input) { return kDisplaced.holds(input) || kPn.holds(input); },
									   "no material displaces, and triangles are flat" };
inline constexpr Condition kHeightFootprints = {
	[](const PlanInput& input) { return kDisplaced.holds(input) && input.sizes.height_footprint_bytes <= input.device.most_footprint_bytes; },
	"nothing is displaced, or the height maps are too large to be kept with each texel's neighbours", nullptr,
	"the device has no room for it, or nothing is displaced"
};
inline constexpr Condition kSeams = {
	[](const PlanInput& input) { return kDisplaced.holds(input) && input.scene.seam_edges + input.scene.seam_corners > 0; },
	"no displaced edge or corner lies on a seam", [](const PlanInput& input) { return kDisplaced.holds(input); }, kNeedsDisplacement
};
inline constexpr Condition kDetail = { [](const PlanInput& input) { return input.options.metric == Metric::Detail && kUneven.holds(input); },
									   "another metric is chosen, or the surface is flat", nullptr, kChoosesTriangles };
inline constexpr Condition kDisplacedEdges = { [](const PlanInput& input) {
												  return input.options.metric == Metric::Displaced && kUneven.holds(input);
											  },
											   "another metric is chosen, or the surface is flat", nullptr, kChoosesTriangles };
inline constexpr Condition kMetricTables = { [](const PlanInput& input) { return kDetail.holds(input) || kDisplacedEdges.holds(input); },
											 "the metric needs no tables", nullptr, kChoosesTriangles };
// Where the surface is flat, the metric `detail` has every factor 1.
inline constexpr Condition kTessellates = { [](const PlanInput& input) {
											   return input.options.rate > 0 && input.view.factors_above_one &&
													  (input.options.metric != Metric::Detail || kUneven.holds(input));
										   },
											"no edge can get more than one segment at this rate and camera",
											[](const PlanInput& input) { return input.options.rate > 0; }, "--rate 0 asks for no tessellation" };
inline constexpr Condition kDoesNotTessellate = { [](const PlanInput& input) { return !kTessellates.holds(input); }, "cluster_classify writes it",
												  nullptr, kIsAnAlternative };
inline constexpr Condition kSplits = { [](const PlanInput& input) { return kTessellates.holds(input) && input.view.split_levels > 0; },
									   "no edge can exceed the table at this rate and camera",
									   [](const PlanInput& input) { return kTessellates.holds(input); },
									   "nothing is tessellated: force cluster_classify with it" };
inline constexpr Condition kCulls = { [](const PlanInput& input) { return culling(input).any(); },
									  "culling is off, or rays may meet what it would remove" };
inline constexpr Condition kFrustumCulls = { [](const PlanInput& input) { return culling(input).frustum; },
											 "frustum culling is off, or rays may meet what it would remove" };
inline constexpr Condition kSoft = { [](const PlanInput& input) { return usesSoft(input) && input.device.buffer_atomics_64; },
									 "another producer of visibility is chosen, or the device lacks 64-bit buffer atomics", nullptr,
									 kIsAnAlternative };
// The metric `detail` leaves large triangles beside small ones in most items: a second pass over them takes longer than the first one saves.
inline constexpr Condition kSmallFirst = { [](const PlanInput& input) {
											  return kSoft.holds(input) && kTessellates.holds(input) &&
													 input.view.rate_px <= input.device.most_small_rate_px && input.options.metric != Metric::Detail;
										  },
										   "raster_micro takes all: nothing is tessellated, segments are long, or the device is a processor, where "
										   "two kernels cost more than they save",
										   [](const PlanInput& input) { return kSoft.holds(input) && kTessellates.holds(input); },
										   "only raster_micro's work can be shared" };
inline constexpr Condition kMayHide = { [](const PlanInput& input) { return culling(input).occlusion && kSoft.holds(input); },
										"occlusion culling is off, attachments hold depth, or rays are traced" };
inline constexpr Condition kLooksForHidden = { [](const PlanInput& input) { return kMayHide.holds(input) && input.view.looks_for_hidden; },
											   "occlusion culling is off, attachments hold depth, or the last frames hid too little for its cost",
											   [](const PlanInput& input) { return kMayHide.holds(input) && !input.view.is_seen_elsewhere; },
											   "--cull, --raster or rays decide it" };
inline constexpr Condition kPartsMayHide = { [](const PlanInput& input) { return kMayHide.holds(input) && kTessellates.holds(input); },
											 "occlusion culling is off, or nothing is tessellated" };
inline constexpr Condition kDisplacedPartsMayHide = { [](const PlanInput& input) { return kPartsMayHide.holds(input) && kDisplaced.holds(input); },
													  "no part is displaced, or none is tested for being hidden" };
inline constexpr Condition kMesh = { [](const PlanInput& input) { return usesMesh(input) && input.device.mesh_shader; },
									 "another producer of visibility is chosen, or the device lacks VK_EXT_mesh_shader", nullptr, kIsAnAlternative };
inline constexpr Condition kIndexed = { usesIndexed, "another producer of visibility is chosen", nullptr, kIsAnAlternative };
inline constexpr Condition kDraws = { [](const PlanInput& input) { return usesMesh(input) || usesIndexed(input); },
									  "compute or rays find visibility and write a buffer", nullptr, kIsAnAlternative };
inline constexpr Condition kBuffered = { [](const PlanInput& input) { return !kDraws.holds(input); }, "attachments hold depth and payloads", nullptr,
										 kIsAnAlternative };
inline constexpr Condition kMixedSides = { [](const PlanInput& input) { return input.scene.has_single_sided && input.scene.has_double_sided; },
										   "all materials show the same sides", always };
// Drivers on a processor cull mesh shaders' triangles by corners that are not rounded yet, and cover pixels by corners that are: what is thinner than
// the rounding, as slivers along a silhouette are, then turns to the eye and is not drawn, and the background shows. Fragments know the rounded side.
inline constexpr Condition kSidesInFragments = {
	[](const PlanInput& input) { return kMesh.holds(input) && input.device.is_cpu && input.scene.has_single_sided && !input.scene.has_double_sided; },
	"fixed-function culling leaves out back faces, or materials differ in the sides that they show, or both sides show", nullptr, kIsAnAlternative
};
// Rays.
inline constexpr Condition kRays = { [](const PlanInput& input) { return tracesRays(input) && input.device.rays; },
									 "no rays are traced, or the device lacks acceleration structures or ray tracing pipelines", nullptr,
									 kTracesNothing };
// What they are traced through: one or the other.
inline constexpr Condition kClusters = { buildsClusters, "no rays are traced, the device lacks VK_NV_cluster_acceleration_structure, or --rays khr",
										 nullptr, kTracesNothing };
inline constexpr Condition kRayTriangles = { [](const PlanInput& input) { return kRays.holds(input) && !buildsClusters(input); },
											 "no rays are traced, or what they are traced through is built from clusters", nullptr, kTracesNothing };
inline constexpr Condition kClusterParts = { [](const PlanInput& input) { return buildsClusters(input) && kTessellates.holds(input); },
											 "nothing is built from clusters, or nothing is tessellated", nullptr, kTracesNothing };
inline constexpr Condition kTransients = {
	[](const PlanInput& input) { return kClusterParts.holds(input) && (input.options.transient_units || input.options.transient_groups); },
	"nothing is built from clusters, nothing is tessellated, or --transient-1x1x1 and --transient-2x2x2 are off", nullptr, kTracesNothing
};
inline constexpr Condition kTransientUnits = { [](const PlanInput& input) { return kClusterParts.holds(input) && input.options.transient_units; },
											   "nothing is built from clusters, or --transient-1x1x1 is off", nullptr, kTracesNothing };
inline constexpr Condition kTransientGroups = { [](const PlanInput& input) { return kClusterParts.holds(input) && input.options.transient_groups; },
												"nothing is built from clusters, or --transient-2x2x2 is off", nullptr, kTracesNothing };
inline constexpr Condition kRt = { [](const PlanInput& input) { return usesRt(input) && input.device.rays; },
								   "another producer of visibility is chosen, or the device lacks acceleration structures or ray tracing pipelines",
								   nullptr, kTracesNothing };
inline constexpr Condition kRtTriangles = {
	[](const PlanInput& input) { return kRt.holds(input) && !buildsClusters(input); },
	"another producer of visibility is chosen, the device lacks acceleration structures or ray tracing pipelines, or rays are "
	"traced through clusters",
	nullptr, kTracesNothing
};
inline constexpr Condition kRtClusters = {
	[](const PlanInput& input) { return kRt.holds(input) && buildsClusters(input); },
	"another producer of visibility is chosen, the device lacks VK_NV_cluster_acceleration_structure, or --rays khr", nullptr, kTracesNothing
};
inline constexpr Condition kShadows = { [](const PlanInput& input) { return tracesShadows(input) && input.device.rays; },
										"--shadows is off, the view shows no light, or the device cannot trace rays" };
inline constexpr Condition kAmbientOcclusion = { [](const PlanInput& input) { return tracesAmbient(input) && input.device.rays; },
												 "--ao is 0, the view shows no light, or the device cannot trace rays" };
// What no pixel shows but rays of light meet is cut more coarsely the farther out of view it lies.
inline constexpr Condition kRayFalloff = {
	[](const PlanInput& input) { return tracesLight(input) && input.device.rays && input.options.ray_falloff > 0 && input.options.rate > 0; },
	"no shadows or ambient occlusion are traced, --ray-falloff is 0, or nothing is tessellated", nullptr, kChoosesTriangles
};
// So is what something hides, over some frames; which instances those are is read from words of depth and payload.
inline constexpr Condition kHiddenFalloff = { [](const PlanInput& input) {
												 return kRayFalloff.holds(input) && input.options.ray_hidden && input.sizes.instances > 1 &&
														kBuffered.holds(input);
											 },
											  "nothing falls off out of view, --ray-hidden is off, there is one instance, or attachments hold depth",
											  nullptr, kChoosesTriangles };
inline constexpr Condition kMeasuresHidden = {
	[](const PlanInput& input) { return kHiddenFalloff.holds(input) && kTessellates.holds(input) && !input.view.is_seen_elsewhere; },
	"segments of what is hidden do not grow, nothing is tessellated, or the picture is seen from elsewhere", nullptr, kChoosesTriangles
};
inline constexpr Condition kMakesPyramid = {
	[](const PlanInput& input) { return kLooksForHidden.holds(input) || kMeasuresHidden.holds(input); },
	"occlusion culling is off, attachments hold depth, or the last frames hid too little for its cost; and no rays of light meet what is hidden",
	kLooksForHidden.can_be_forced, kLooksForHidden.why_not_forced
};
// What factors of edges are read from beside their ends.
inline constexpr Condition kEdgeTables = { [](const PlanInput& input) { return kMetricTables.holds(input) || kHiddenFalloff.holds(input); },
										   "the metric needs no tables, and segments of what is hidden do not grow", nullptr, kChoosesTriangles };
inline constexpr Condition kRtMixedSides = { [](const PlanInput& input) { return kRt.holds(input) && kMixedSides.holds(input); },
											 "all materials show the same sides", nullptr, kTracesNothing };
inline constexpr Condition kRtMixedSidesOfParts = { [](const PlanInput& input) { return kRtMixedSides.holds(input) && kTessellates.holds(input); },
													"all materials show the same sides, or nothing is tessellated", nullptr, kTracesNothing };
// Structures of meshes that instances share, whatever is seen from where. An indexed draw expands everything anyway.
inline bool mayShareStructures(const PlanInput& input)
{
	return tracesRays(input) && input.device.rays && !buildsClusters(input) && input.options.ray_sharing && !usesIndexed(input) &&
		   input.sizes.instances < input.device.most_structure_instances && input.sizes.instances < OWN_STRUCTURE;
}
inline constexpr Condition kSharesStructures = {
	[](const PlanInput& input) {
		return mayShareStructures(input) && input.view.shares_structures && input.view.rounds == 1 && !input.view.is_seen_elsewhere;
	},
	"no rays are traced, or through clusters, --ray-sharing is off, vertices are drawn by indices, the frame is drawn in rounds, or every instance "
	"is tessellated, displaced by distance or too near",
	nullptr, kTracesNothing
};
inline constexpr Condition kMakesStructures = { [](const PlanInput& input) { return kSharesStructures.holds(input) && input.view.makes_structures; },
												"every structure that instances share is there already, or none do", nullptr, kTracesNothing };
inline constexpr Condition kRtShares = { [](const PlanInput& input) { return kRt.holds(input) && kSharesStructures.holds(input); },
										 "no primary ray goes through structures that instances share", nullptr, kTracesNothing };
inline constexpr Condition kRtFindsClusters = { [](const PlanInput& input) { return kRtMixedSides.holds(input) || kRtShares.holds(input); },
												"no primary ray asks for its cluster's material or place", nullptr, kTracesNothing };
inline constexpr Condition kBoundsMeshes = { [](const PlanInput& input) { return kFrustumCulls.holds(input) || kSharesStructures.holds(input); },
											 "nothing is culled by the frustum, and no instances share structures" };
inline constexpr Condition kPlacesInstances = { [](const PlanInput& input) { return kClusters.holds(input) || kSharesStructures.holds(input); },
												"one structure holds all that rays meet", nullptr, kTracesNothing };
// Micro-vertices and indices in memory: for those who do not evaluate their own.
inline constexpr Condition kKeepsVertices = { [](const PlanInput& input) { return kDraws.holds(input) || kRays.holds(input); },
											  "raster_micro evaluates its own vertices, and nothing else needs any", nullptr, kIsAnAlternative };
inline constexpr Condition kExpands = { [](const PlanInput& input) { return usesIndexed(input) || kRayTriangles.holds(input); },
										"nothing is drawn by indices, and no rays are traced, or through clusters", nullptr, kIsAnAlternative };
// Every cluster of the scene is drawn as stored: then each has a place of its own in what is expanded, and what rays are traced through can be
// refitted. (Mesh shaders find clusters at the places that they took when they were listed.)
inline constexpr Condition kKeepsPlaces = { [](const PlanInput& input) {
											   return kRayTriangles.holds(input) && !kTessellates.holds(input) && !culling(input).any() &&
													  input.view.rounds == 1 && !usesMesh(input) && !kSharesStructures.holds(input);
										   },
											"no rays are traced, or through clusters, something is tessellated, culled or drawn in rounds, mesh "
											"shaders draw, or instances share structures",
											nullptr, kTracesNothing };
inline constexpr Condition kPrimitiveId = { [](const PlanInput& input) { return input.device.fragment_primitive_id; },
											"the device lacks primitive ids in fragment shaders (geometryShader) or 32-bit indices" };
inline constexpr Condition kColorTextures = { [](const PlanInput& input) { return input.scene.has_color_textures; },
											  "no material has a base colour texture", always };
inline constexpr Condition kVertexColors = { [](const PlanInput& input) { return input.scene.has_vertex_colors; }, "no primitive has COLOR_0",
											 always };
inline constexpr Condition kMirroredInstances = { [](const PlanInput& input) { return input.scene.has_mirrored_instances; },
												  "no instance is mirrored", always };
inline constexpr Condition kSingleSided = { [](const PlanInput& input) { return input.scene.has_single_sided; }, "every material is double-sided",
											nullptr, kIsLessCode };
inline constexpr Condition kAsksForTessellation = { [](const PlanInput& input) { return input.options.rate > 0; }, "the rate is 0" };
inline constexpr Condition kShadedView = { [](const PlanInput& input) { return input.options.view == ViewMode::Shaded && !input.options.wireframe; },
										   "a debug view or the wireframe is chosen" };
// Height maps: the code for each kind of texel and wrapping.
inline bool isDisplaced(const PlanInput& input)
{
	return kDisplaced.holds(input);
}
inline constexpr Condition kHeightU8 = { [](const PlanInput& input) { return input.scene.has_height_u8; }, "no height map has 8-bit texels",
										 isDisplaced, kNeedsDisplacement };
inline constexpr Condition kHeightU16 = { [](const PlanInput& input) { return input.scene.has_height_u16; }, "no height map has 16-bit texels",
										  isDisplaced, kNeedsDisplacement };
inline constexpr Condition kHeightF32 = { [](const PlanInput& input) { return input.scene.has_height_f32; }, "no height map has float texels",
										  isDisplaced, kNeedsDisplacement };
inline constexpr Condition kWrapRepeat = { [](const PlanInput& input) { return input.scene.has_wrap_repeat; }, "no height map repeats", isDisplaced,
										   kNeedsDisplacement };
inline constexpr Condition kWrapClamp = { [](const PlanInput& input) { return input.scene.has_wrap_clamp; }, "no height map is clamped", isDisplaced,
										  kNeedsDisplacement };
inline constexpr Condition kWrapMirror = { [](const PlanInput& input) { return input.scene.has_wrap_mirror; }, "no height map repeats mirrored",
										   isDisplaced, kNeedsDisplacement };
inline constexpr Condition kManyHeightMaps = { [](const PlanInput& input) { return input.sizes.height_maps > UNIFORM_HEIGHT_MAPS; },
											   "the height maps fit into a uniform buffer", isDisplaced, kNeedsDisplacement };
// Directions that are the normals bit for bit are not held twice.
inline constexpr Condition kOwnDirections = { [](const PlanInput& input) { return kUneven.holds(input) && !input.scene.directions_are_normals; },
											  "nothing needs directions, or every one equals the normal",
											  [](const PlanInput& input) { return kUneven.holds(input); }, kNeedsDisplacement };
inline constexpr Condition kDirectionsAreNormals = { [](const PlanInput& input) {
														return input.scene.directions_are_normals && !input.forces(kOwnDirections);
													},
													 "some direction differs from the normal", nullptr, kIsLessCode };
inline constexpr Condition kNormalsAsDirections = { [](const PlanInput& input) { return kUneven.holds(input) && kDirectionsAreNormals.holds(input); },
													"no direction is read from the normals", nullptr, kIsLessCode };
inline constexpr Condition kDetailMetric = { [](const PlanInput& input) { return input.options.metric == Metric::Detail; },
											 "another metric is chosen", nullptr, kChoosesTriangles };
inline constexpr Condition kDisplacedMetric = { [](const PlanInput& input) { return input.options.metric == Metric::Displaced; },
												"another metric is chosen", nullptr, kChoosesTriangles };
inline constexpr Condition kNormals = { [](const PlanInput& input) { return input.options.smooth_normals; }, "faceted shading needs no normals" };

// Levels of triangle_split that are recorded; forced on, there is one.
inline uint32_t splitLevels(const PlanInput& input)
{
	return kSplits.holds(input) ? std::max(input.view.split_levels, 1u) : 0;
}

}  // namespace tessera
