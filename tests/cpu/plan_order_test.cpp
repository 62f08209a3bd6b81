// That every access of a plan comes after those it needs, with a barrier between.
#include "plan_checks.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tessera::test
{

TEST(framePlan, everyAccessOfRaysIsOrderedToo)
{
	for (uint32_t i = 0; i < 4096; ++i)
	{
		const auto bit = [&](uint32_t b) {
			return (i >> b & 1u) != 0;
		};
		PlanInput input = fullInput();
		input.device.rays = input.device.buffer_atomics_64 = true;
		constexpr Raster kRasters[] = { Raster::Soft, Raster::Mesh, Raster::Indexed, Raster::Rt };
		input.options.raster = kRasters[i % 4];
		input.options.shadows = bit(2);
		input.options.ao_samples = bit(3) ? 4 : 0;
		input.options.rate = bit(4) ? 4.0f : 0.0f;
		input.scene.has_double_sided = bit(5);
		input.view.split_levels = bit(6) ? 3 : 0;
		input.options.view = bit(7) ? ViewMode::Shaded : ViewMode::Clusters;
		input.device.clusters = bit(8);
		input.options.transient_units = input.options.transient_groups = bit(9);
		input.device.most_structure_instances = 1000;
		input.view.shares_structures = bit(10);
		input.view.makes_structures = bit(11);
		const FramePlan plan = planOf(input);
		ASSERT_TRUE(plan.everyReadHasAnEarlierWriteAndABarrier(input)) << i;
		ASSERT_TRUE(everyConflictIsOrdered(plan, input)) << i;
		ASSERT_EQ(readBeforeWritten(plan, input), "") << i;
		for (const PassDesc* pass : framePasses())
			ASSERT_EQ(plan.has(pass->name), plan.reason(pass->name).empty()) << pass->name;
		for (const PlannedResource& resource : plan.resources)
			ASSERT_EQ(resource.kept, resource.reason.empty()) << resource.name;
	}
}

TEST(framePlan, onlyTheFirstDrawClearsDepth)
{
	const FramePlan plan = planOf(fullInput());
	EXPECT_EQ(std::count_if(plan.steps.begin(), plan.steps.end(), [](const PlanStep& step) { return step.clears_depth; }), 1);
	const auto first = std::find_if(plan.steps.begin(), plan.steps.end(), [](const PlanStep& step) { return step.clears_depth; });
	ASSERT_NE(first, plan.steps.end());
	EXPECT_EQ(first->pass->name, "draw_clusters");
}

TEST(framePlan, everyAccessIsOrderedWhateverIsAsked)
{
	uint32_t planned = 0;
	forEveryInput([&](const PlanInput& input) {
		const Result<FramePlan> plan = planFrame(framePasses(), resourceDescs(), kWanted, input);
		const bool can_mesh = input.device.mesh_shader && input.options.raster != Raster::Indexed;
		const bool can_index = input.device.fragment_primitive_id &&
							   (input.options.raster == Raster::Indexed || (input.options.raster == Raster::Auto && !input.device.mesh_shader));
		if (!plan || (!can_mesh && !can_index))
		{
			EXPECT_FALSE(can_mesh || can_index) << plan.error().message;
			return;
		}
		++planned;
		ASSERT_TRUE(plan->everyReadHasAnEarlierWriteAndABarrier(input));
		ASSERT_TRUE(everyConflictIsOrdered(*plan, input));
		ASSERT_EQ(readBeforeWritten(*plan, input), "");
		for (const PassDesc* pass : framePasses())
			ASSERT_EQ(plan->has(pass->name), plan->reason(pass->name).empty()) << pass->name;
		for (const PlannedResource& resource : plan->resources)
			ASSERT_EQ(resource.kept, resource.reason.empty()) << resource.name;
	});
	EXPECT_GT(planned, 3000u);
}

TEST(framePlan, everyResourceThatPassesNameIsKnown)
{
	for (const PassDesc* pass : framePasses())
		for (const Use& use : pass->uses)
			EXPECT_TRUE(std::any_of(resourceDescs().begin(), resourceDescs().end(), [&](const ResourceDesc& r) { return r.name == use.resource; }))
				<< pass->name << ": " << use.resource;
}

TEST(framePlan, aBarrierTooFewIsNoticed)
{
	const PlanInput input = fullInput();
	const FramePlan plan = planOf(input);
	for (size_t i = 0; i < plan.steps.size(); ++i)
	{
		if (plan.steps[i].wait_for.empty())
			continue;
		FramePlan broken = plan;
		broken.steps[i].wait_for = broken.steps[i].then = {};
		EXPECT_FALSE(everyConflictIsOrdered(broken, input)) << plan.steps[i].pass->name << ": its barrier is not needed";
	}
	FramePlan broken = plan;
	for (PlanStep& step : broken.steps)
		step.wait_for = step.then = {};
	EXPECT_FALSE(broken.everyReadHasAnEarlierWriteAndABarrier(input));
}

TEST(framePlan, aReaderBeforeItsWriterIsNoticed)
{
	const PlanInput input = fullInput();
	FramePlan plan = planOf(input);
	std::reverse(plan.steps.begin(), plan.steps.end());
	EXPECT_FALSE(plan.everyReadHasAnEarlierWriteAndABarrier(input));
	EXPECT_NE(readBeforeWritten(plan, input), "");
}

TEST(framePlan, aMissingWriterIsNoticed)
{
	const PlanInput input = fullInput();
	for (const std::string_view missing : { "instance_classify", "cluster_cull", "cluster_classify", "batch_parts", "shade" })
	{
		std::vector<const PassDesc*> passes(framePasses().begin(), framePasses().end());
		std::erase_if(passes, [&](const PassDesc* pass) { return pass->name == missing; });
		const Result<FramePlan> plan = planFrame(passes, resourceDescs(), kWanted, input);
		ASSERT_FALSE(plan) << missing;
		EXPECT_EQ(plan.error().code, ExitCode::DeviceCannot) << missing;
	}
}

}  // namespace tessera::test
