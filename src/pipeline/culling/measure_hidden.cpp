#include "culling/measure_hidden.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "view", Access::ComputeRead },
	{ "frame_history", Access::ComputeRead },
	{ "instances", Access::ComputeRead },
	{ "mesh_bounds", Access::ComputeRead },
	{ "visibility_buffer", Access::ComputeRead },
	{ "depth_pyramid", Access::ComputeRead },
	{ "hidden_instances", Access::ComputeRead },
	{ "hidden_instances_next", Access::ComputeWrite },
	{ "counts", Access::ComputeWrite },
};

static void record(PassContext& pass)
{
	MeasureHiddenArgs args = {};
	args.instances = pass.address("instances");
	args.mesh_bounds = pass.address("mesh_bounds");
	args.hidden_instances = pass.address("hidden_instances");
	args.hidden_instances_next = pass.address("hidden_instances_next");
	args.counts = pass.address("counts");
	args.visibility = pass.address("visibility_buffer");
	args.instance_count = static_cast<uint32_t>(pass.input().sizes.instances);
	pass.dispatchLoop(args, args.instance_count);
}

static constexpr const Condition* kNeeded[] = { &kMeasuresHidden };
static constexpr std::string_view kShaders[] = { "culling/measure_hidden.comp" };

const PassDesc kMeasureHidden = { "measure_hidden", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
