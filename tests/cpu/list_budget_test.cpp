// Capacities of lists: within a budget, and as they are asked for.
#include "plan_inputs.h"

#include "frame/frame_resources.h"

#include <gtest/gtest.h>

namespace tessera::test
{

namespace
{

std::vector<PlanInput> budgetInputs()
{
	std::vector<PlanInput> inputs;
	for (const Raster raster : { Raster::Soft, Raster::Mesh, Raster::Indexed })
		for (const float rate : { 0.0f, 4.0f })
			for (const uint64_t clusters : { 1ull, 4096ull, 3'000'000ull })
			{
				PlanInput input = fullInput();
				input.device.buffer_atomics_64 = true;
				input.options.raster = raster;
				input.options.rate = rate;
				input.sizes.instanced_clusters = clusters;
				inputs.push_back(input);
			}
	return inputs;
}

uint64_t leastBudget(PlanInput input)
{
	input.options.lists_bytes = 1;
	const std::string message = listCapacities(input).error().message;
	return std::stoull(message.substr(message.rfind(' ') + 1));
}

}  // namespace

TEST(listBudget, isNeverExceededAndNearlyUsed)
{
	for (PlanInput input : budgetInputs())
		for (const uint64_t budget : { 1'000'000ull, 64'000'000ull, 1'000'000'000ull })
		{
			input.options.lists_bytes = budget;
			const auto capacities = listCapacities(input);
			ASSERT_TRUE(capacities) << capacities.error().message;
			const uint64_t bytes = bytesOfLists(*capacities, input);
			EXPECT_LE(bytes, budget);
			for (const ListDesc& list : listDescs())
			{
				EXPECT_GE((*capacities)[list.index], list.least_capacity) << list.name;
				EXPECT_LE((*capacities)[list.index], mostEntries(list)) << list.name;
			}
			const bool full = (*capacities)[LIST_PART_TRIANGLES] == mostEntries(*findList("part_triangles"));
			const bool uses_all = input.options.rate > 0 && !full;
			EXPECT_GE(bytes + (uses_all ? 2000 : budget), budget) << "a further part would fit";
		}
}

TEST(listBudget, moreMemoryNeverMakesAListSmaller)
{
	for (PlanInput input : budgetInputs())
	{
		std::array<uint32_t, LIST_COUNT> before = {};
		for (uint64_t budget = leastBudget(input); budget < 1'000'000'000; budget = budget * 5 / 4)
		{
			input.options.lists_bytes = budget;
			const auto capacities = listCapacities(input);
			ASSERT_TRUE(capacities);
			for (const ListDesc& list : listDescs())
				EXPECT_GE((*capacities)[list.index], before[list.index]) << list.name << " at " << budget;
			before = *capacities;
		}
	}
}

TEST(listBudget, theLeastIsNamedAndIsEnough)
{
	for (PlanInput input : budgetInputs())
	{
		const uint64_t least = leastBudget(input);
		input.options.lists_bytes = least;
		ASSERT_TRUE(listCapacities(input));
		EXPECT_EQ(bytesOfLists(*listCapacities(input), input), least);
		input.options.lists_bytes = least - 1;
		ASSERT_FALSE(listCapacities(input));
		EXPECT_EQ(listCapacities(input).error().code, ExitCode::Usage);
	}
}

TEST(listBudget, aCapacityThatIsAskedForIsKeptAndPaidFor)
{
	for (PlanInput input : budgetInputs())
	{
		input.options.lists_bytes = 64'000'000;
		input.options.capacities = { { "split_triangles", 1'000'000 }, { "visible_clusters", 777 } };
		const auto capacities = listCapacities(input);
		ASSERT_TRUE(capacities);
		EXPECT_EQ((*capacities)[LIST_SPLIT_TRIANGLES], 1'000'000u);
		EXPECT_EQ((*capacities)[LIST_VISIBLE_CLUSTERS], 777u);
		EXPECT_LE(bytesOfLists(*capacities, input), 64'000'000u);
	}
}

}  // namespace tessera::test
