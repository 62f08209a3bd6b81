#include "frame/frame_outcome.h"

#include <algorithm>

namespace tessera
{

void addTimes(const PassRunner& runner, const FramePlan& plan, FrameResult& result)
{
	result.gpu_ms += runner.totalMs();
	for (size_t i = 0; i < plan.steps.size(); ++i)
	{
		const std::string_view name = plan.steps[i].pass->name;
		auto found = std::find_if(result.passes.begin(), result.passes.end(), [&](const PassTime& time) { return time.name == name; });
		if (found == result.passes.end())
			found = result.passes.insert(result.passes.end(), { std::string(name), 0 });
		found->gpu_ms += runner.stepMs()[i];
	}
}

void addCounts(const FrameResources& resources, FrameCountsRead& sum)
{
	const FrameCounts counts = resources.counts();
	sum.visible_clusters += resources.head(LIST_VISIBLE_CLUSTERS).wanted;
	sum.full_clusters += resources.head(LIST_FULL_CLUSTERS).wanted;
	sum.part_triangles += resources.head(LIST_PART_TRIANGLES).wanted;
	sum.split_triangles += resources.head(LIST_SPLIT_TRIANGLES).wanted;
	sum.micro_triangles += (uint64_t(counts.micro_high) << 32 | counts.micro_low) + counts.full_cluster_triangles;
	sum.hidden_parts += counts.hidden_parts;
	sum.revealed_parts += counts.revealed_parts;
	sum.hidden_clusters += counts.hidden_clusters;
	sum.revealed_clusters += counts.revealed_clusters;
	sum.hidden_instances += counts.hidden_instances;
	sum.covered_pixels = counts.covered_pixels;  // of the whole depth image, so the last round's count is the frame's
}

void fillLists(const FrameResources& resources, FrameResult& result)
{
	for (const ListDesc& list : listDescs())
	{
		if (!resources.has(list.name))
			continue;
		const ListHead head = resources.head(list.index);
		result.lists.push_back({ std::string(list.name), head.wanted, head.capacity, head.peak, head.peak_used, listBytes(list, head.capacity) });
	}
	result.rays = resources.rays().stats(resources.head(LIST_EXPANDED_TRIANGLES).wanted);
	if (resources.clusters().exists())
		resources.clusters().addStats(result.rays, resources.head(LIST_MICRO_VERTICES).wanted);
	else if (result.rays.traced)
	{
		resources.sharedStructures().addStats(result.rays, resources.counts().shared_instances);
		result.lists.push_back(result.rays.triangles);
	}
	result.lists.insert(result.lists.end(), result.rays.clusters.lists.begin(), result.rays.clusters.lists.end());
}

void growNearlyFull(FrameResources& resources, const PlanInput& input)
{
	for (const ListDesc& list : listDescs())
	{
		if (!growsOnDemand(list) || !resources.has(list.name))
			continue;
		const ListHead head = resources.head(list.index);
		if (head.wanted <= head.capacity && uint64_t(head.wanted) * 10 > uint64_t(resources.capacity(list.name)) * 9)
			resources.grow(list, head.wanted, input);
	}
}

OverfullLists growOverfull(FrameResources& resources, const PlanInput& input)
{
	OverfullLists found;
	for (const ListDesc& list : listDescs())
	{
		const ListHead head = resources.head(list.index);
		if (head.wanted <= head.capacity)
			continue;
		found.grew |= resources.grow(list, head.wanted, input);
		found.of_clusters |= list.index == LIST_CLUSTER_GROUPS || list.index == LIST_VISIBLE_CLUSTERS || list.index == LIST_FULL_CLUSTERS;
	}
	return found;
}

OcclusionOutcome occlusionOutcome(const FrameResult& result)
{
	const auto took = [&](std::string_view pass) {
		const auto found = std::find_if(result.passes.begin(), result.passes.end(), [&](const PassTime& time) { return time.name == pass; });
		return found == result.passes.end() ? 0 : found->gpu_ms;
	};
	OcclusionOutcome outcome;
	const FrameCountsRead& counts = result.counts;
	outcome.items = counts.part_triangles + counts.full_clusters;
	const uint64_t hidden = counts.hidden_parts + counts.hidden_clusters;
	outcome.left_out = hidden - std::min(hidden, counts.revealed_parts + counts.revealed_clusters);
	outcome.raster_ms = took("raster_small") + took("raster_micro");
	outcome.looking_ms = took("depth_pyramid") + took("retest_parts") + took("raster_revealed");
	return outcome;
}

}  // namespace tessera
