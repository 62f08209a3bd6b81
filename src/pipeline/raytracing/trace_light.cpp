// trace_shadows and trace_ambient: rays that leave what is seen.
#include "raytracing/trace_light.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"
#include "shared/ray_sharing.h"

#include <cmath>

namespace tessera
{

static constexpr std::array<Use, 6> kTracedUses = { {
	{ "ray_scene", Access::RayRead },
	{ "ray_geometry", Access::RayRead },
	{ "mesh_structures", Access::RayRead, &kSharesStructures },
	{ "visibility_depth", Access::RayRead, &kDraws },
	{ "visibility_payload", Access::RayRead, &kDraws },
	{ "visibility_buffer", Access::RayRead, &kBuffered },
} };
static constexpr auto kShadowUses =
	joinUses(surfaceUses(Access::RayRead), partUses(Access::RayRead), kTracedUses, std::array<Use, 1>{ { { "sun_visibility", Access::RayWrite } } });
static constexpr auto kAmbientUses = joinUses(surfaceUses(Access::RayRead), partUses(Access::RayRead), kTracedUses,
											  std::array<Use, 1>{ { { "ambient_visibility", Access::RayWrite } } });

// A position that loses bits of its mantissa moves by up to 2^(bits - 23) of each coordinate, so a triangle by less than twice that of its largest.
static float offsetOfTruncation(const PlanInput& input)
{
	const uint32_t bits = buildsClusters(input) ? input.options.truncated_bits : 0;
	return bits == 0 ? 0 : std::ldexp(2.0f, int(bits) - 23);
}

static TraceLightArgs argsFor(const PassContext& pass, std::string_view light)
{
	TraceLightArgs args = {};
	args.inputs = rasterInputs(pass);
	args.visibility = pass.address("visibility_buffer");
	args.light = pass.address(light);
	args.more_offset = offsetOfTruncation(pass.input()) + (kSharesStructures.holds(pass.input()) ? LIGHT_SHARING_OFFSET : 0);
	return args;
}

static void recordShadows(PassContext& pass)
{
	pass.traceRays(argsFor(pass, "sun_visibility"));
}

static void recordAmbient(PassContext& pass)
{
	const RenderOptions& options = pass.input().options;
	TraceLightArgs args = argsFor(pass, "ambient_visibility");
	args.samples = options.ao_samples;
	args.radius_world = static_cast<float>(options.ao_radius_world > 0 ? options.ao_radius_world : pass.input().sizes.world_radius / 10);
	pass.traceRays(args);
}

static constexpr const Condition* kShadowsNeeded[] = { &kShadows };
static constexpr const Condition* kAmbientNeeded[] = { &kAmbientOcclusion };
static constexpr std::string_view kShadowShaders[] = { "raytracing/trace_shadows.rgen", "raytracing/trace_light.rmiss" };
static constexpr std::string_view kAmbientShaders[] = { "raytracing/trace_ambient.rgen", "raytracing/trace_light.rmiss" };

const PassDesc kTraceShadows = { "trace_shadows", kShadowUses, kShadowsNeeded, kShadowShaders, nullptr, recordShadows };
const PassDesc kTraceAmbient = { "trace_ambient", kAmbientUses, kAmbientNeeded, kAmbientShaders, nullptr, recordAmbient };

}  // namespace tessera
