// What is forced on although the scene does not need it.
#include "plan_checks.h"

#include "plan/forced.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tessera::test
{

namespace
{

bool featureOnIfAny(const FramePlan& plan, std::string_view name)
{
	return std::any_of(plan.features.begin(), plan.features.end(), [&](const Feature& feature) { return feature.name == name && feature.on; });
}

}  // namespace

// Everything that is left out is either kept when it is forced, and said to be, or cannot be and why is said.
TEST(framePlan, whateverIsLeftOutIsForcedOrSaidWhyNot)
{
	size_t forced_count = 0, refused_count = 0, inputs = 0;
	forEveryInput([&](const PlanInput& input) {
		// A spread of them: this plans many times for each.
		if (++inputs % 97 != 0 || !planFrame(framePasses(), resourceDescs(), kWanted, input))
			return;
		for (const std::string_view name : forceNames(framePasses(), resourceDescs()))
		{
			const std::string names[] = { std::string(name) };
			const auto forced = forcedBy(names, framePasses(), resourceDescs(), kWanted, input);
			if (!forced)
			{
				EXPECT_EQ(forced.error().code, ExitCode::Usage);
				EXPECT_NE(forced.error().message.find("cannot be forced: "), std::string::npos) << forced.error().message;
				++refused_count;
				continue;
			}
			PlanInput with = input;
			with.forced = *forced;
			const FramePlan plan = planOf(with), before = planOf(input);
			const auto feature = std::find_if(plan.features.begin(), plan.features.end(), [&](const Feature& f) { return f.name == name; });
			const bool is_there = plan.has(name) || plan.keeps(name) || (feature != plan.features.end() && feature->on);
			const bool was_there = before.has(name) || before.keeps(name) || featureOnIfAny(before, name);
			EXPECT_TRUE(is_there) << name << ", " << fmt::format("{}", fmt::join(forced->outputs, " ")) << ", conditions "
								  << forced->conditions.size();
			EXPECT_TRUE(plan.everyReadHasAnEarlierWriteAndABarrier(with)) << name;
			EXPECT_EQ(readBeforeWritten(plan, with), "") << name;
			if (is_there && !was_there)
			{
				const bool marked = (feature != plan.features.end() && feature->forced) || (plan.keeps(name) && resourceOf(plan, name).forced) ||
									std::any_of(plan.forced.begin(), plan.forced.end(), [&](const DroppedPass& pass) { return pass.name == name; });
				EXPECT_TRUE(marked) << name;
				++forced_count;
			}
		}
	});
	EXPECT_GT(forced_count, 500u);
	EXPECT_GT(refused_count, 500u);
}

TEST(framePlan, unknownNamesToForceAreRefusedWithThoseThereAre)
{
	const std::string names[] = { "raster_macro" };
	const auto forced = forcedBy(names, framePasses(), resourceDescs(), kWanted, fullInput());
	ASSERT_FALSE(forced);
	EXPECT_EQ(forced.error().code, ExitCode::Usage);
	EXPECT_NE(forced.error().message.find("raster_micro"), std::string::npos);
	EXPECT_EQ(forced.error().message.find('\n'), std::string::npos);
}

TEST(framePlan, oneForcedThingMayNeedAnotherInAnyOrder)
{
	PlanInput input = fullInput();
	input.scene.has_displacement = false;
	const std::string seams_alone[] = { "HAS_SEAMS" }, both[] = { "HAS_SEAMS", "HAS_DISPLACEMENT" };
	EXPECT_FALSE(forcedBy(seams_alone, framePasses(), resourceDescs(), kWanted, input));
	const auto forced = forcedBy(both, framePasses(), resourceDescs(), kWanted, input);
	ASSERT_TRUE(forced);
	input.forced = *forced;
	EXPECT_TRUE(featureOn(planOf(input), "HAS_SEAMS"));
}

}  // namespace tessera::test
