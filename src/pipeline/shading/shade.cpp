#include "shading/shade.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr auto kUses = joinUses(surfaceUses(Access::ComputeRead), partUses(Access::ComputeRead),
									   std::array<Use, 13>{ {
										   { "shading", Access::ComputeRead },
										   { "materials", Access::ComputeRead },
										   { "normals", Access::ComputeRead, &kNormals },
										   { "color_uvs", Access::ComputeRead, &kColorTextures },
										   { "color_textures", Access::ComputeRead, &kColorTextures },
										   { "colors", Access::ComputeRead, &kVertexColors },
										   { "visibility_depth", Access::ComputeRead, &kDraws },
										   { "visibility_payload", Access::ComputeRead, &kDraws },
										   { "visibility_buffer", Access::ComputeRead, &kBuffered },
										   { "visibility_buffer", Access::ComputeWrite, &kBuffered },
										   { "sun_visibility", Access::ComputeRead, &kShadows },
										   { "ambient_visibility", Access::ComputeRead, &kAmbientOcclusion },
										   { "counts", Access::ComputeWrite },
									   } },
									   std::array<Use, 1>{ { { "picture", Access::ComputeWrite } } });

constexpr uint32_t kTilePx = 16;  // side of a workgroup

static void record(PassContext& pass)
{
	ShadeArgs args = {};
	args.inputs = rasterInputs(pass);
	args.shading = pass.address("shading");
	args.picture = pass.address("picture");
	args.counts = pass.address("counts");
	args.view_mode = static_cast<uint32_t>(pass.input().options.view) | (pass.input().options.wireframe ? VIEW_WITH_WIREFRAME : 0);
	args.visibility = pass.address("visibility_buffer");
	args.rounds = pass.round() | pass.input().view.rounds << 16;
	args.sun_visibility = pass.address("sun_visibility");
	args.ambient_visibility = pass.address("ambient_visibility");
	pass.dispatch(args, (pass.input().options.width_px + kTilePx - 1) / kTilePx, (pass.input().options.height_px + kTilePx - 1) / kTilePx);
}

static constexpr std::string_view kShaders[] = { "shading/shade.comp" };

const PassDesc kShade = { "shade", kUses, {}, kShaders, nullptr, record };

}  // namespace tessera
