// What FrameResources holds for rays: made before a frame, judged after it.
#include "frame/frame_resources.h"
#include "plan/conditions.h"
#include "raytracing/place_instances.h"

namespace tessera
{

uint64_t FrameResources::rayInstanceBytes(const PlanInput& input) const
{
	const uint64_t own = kClusters.holds(input) ? 0 : 1;
	const uint64_t of_scene = kClusters.holds(input) || kSharesStructures.holds(input) ? scene_.instances.size() : 0;
	return (own + of_scene) * sizeof(RayInstance);
}

Status FrameResources::prepareRays(const FramePlan& plan, const PlanInput& input)
{
	TRY(shared_.prepare(plan, input, *commands_));
	if (!plan.keeps("ray_scene"))
	{
		rays_.drop();
		clusters_.drop();
		return {};
	}
	if (buffer("ray_instances").bytes() < rayInstanceBytes(input))
	{
		buffers_.erase("ray_instances");
		TRY(allocate("ray_instances", rayInstanceBytes(input)));
	}
	RayInputs inputs;
	inputs.instances = address("ray_instances");
	inputs.micro_vertices = address("micro_vertices");
	if (kClusters.holds(input))
	{
		TRY(clusters_.prepare(scene_, table_, input, address("positions"), *commands_));
		inputs.instance_count = clusters_.sceneInstances();
		return rays_.prepare(inputs, input, *bindless_);
	}
	clusters_.drop();
	inputs.expanded_triangles = address("expanded_triangles");
	inputs.vertex_capacity = capacities_[LIST_MICRO_VERTICES];
	inputs.triangle_capacity = capacities_[LIST_EXPANDED_TRIANGLES];
	inputs.instance_count = static_cast<uint32_t>(rayInstanceBytes(input) / sizeof(RayInstance));
	return rays_.prepare(inputs, input, *bindless_);
}

Result<bool> FrameResources::raysAreTooSmall(const PlanInput& input)
{
	TRY(shared_.endFrame());
	const bool fits = counts().overflow == 0;
	if (!rays_.exists())
		return false;
	if (!clusters_.exists())
		return rays_.isTooSmallFor(head(LIST_EXPANDED_TRIANGLES).wanted, fits);
	const bool is_too_small = clusters_.isTooSmall(fits);
	if (is_too_small && clusters_.dataOverload(input) > 1)
		TRY(limitVertices(clusters_.dataOverload(input)));
	return is_too_small;
}

// Clusters take about as much memory per vertex at every rate; a little less is asked for, so that few turns are taken.
Status FrameResources::limitVertices(double overload)
{
	const ListDesc& list = *findList("micro_vertices");
	const uint32_t wanted = std::min(head(LIST_MICRO_VERTICES).wanted, capacities_[LIST_MICRO_VERTICES]);
	const auto capacity = static_cast<uint32_t>(double(wanted) / overload * 15 / 16);
	if (capacity < list.least_capacity)
		return badInput("{}: rays' clusters need {:.1f} times the memory that they may take; --max-cluster-data larger, or --rays khr", scene_.path,
						overload);
	buffers_.erase("micro_vertices");
	TRY(allocate("micro_vertices", listBufferBytes(list, capacity)));
	capacities_[LIST_MICRO_VERTICES] = capacity;
	fixed_lists_ |= 1u << LIST_MICRO_VERTICES;
	return makeHeads();
}

}  // namespace tessera
