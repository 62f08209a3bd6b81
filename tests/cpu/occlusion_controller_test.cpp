// In which frames looking for what is hidden pays.
#include "frame/occlusion_controller.h"

#include <gtest/gtest.h>

namespace tessera::test
{

namespace
{

constexpr OcclusionOutcome kPays = { 1000, 400, 1.0, 0.05 };
constexpr OcclusionOutcome kInVain = { 1000, 10, 1.0, 0.05 };

// Frames until it rests (or `most`).
uint32_t framesUntilRest(OcclusionController& controller, const OcclusionOutcome& outcome, uint32_t most)
{
	uint32_t frames = 0;
	while (controller.looks() && frames < most)
	{
		controller.endFrame(&outcome);
		++frames;
	}
	return frames;
}

uint32_t framesOfRest(OcclusionController& controller)
{
	uint32_t frames = 0;
	for (; !controller.looks(); ++frames)
		controller.endFrame(nullptr);
	return frames;
}

}  // namespace

TEST(occlusionController, looksForEverWhileItPays)
{
	OcclusionController controller;
	EXPECT_EQ(framesUntilRest(controller, kPays, 1000), 1000u);
}

TEST(occlusionController, restsLongerEachTimeItWasInVainUpToALimit)
{
	OcclusionController controller;
	uint32_t rest = OcclusionController::kShortestRest;
	for (int times = 0; times < 8; ++times, rest = std::min(2 * rest, OcclusionController::kLongestRest))
	{
		EXPECT_EQ(framesUntilRest(controller, kInVain, 1000), OcclusionController::kPatience);
		EXPECT_EQ(framesOfRest(controller), rest);
	}
}

TEST(occlusionController, oneFrameThatPaysStartsAnew)
{
	OcclusionController controller;
	for (uint32_t i = 0; i + 1 < OcclusionController::kPatience; ++i)
		controller.endFrame(&kInVain);
	controller.endFrame(&kPays);
	EXPECT_EQ(framesUntilRest(controller, kInVain, 1000), OcclusionController::kPatience);
	EXPECT_EQ(framesOfRest(controller), OcclusionController::kShortestRest);
}

TEST(occlusionController, framesWithoutAFrameBeforeThemSayNothing)
{
	OcclusionController controller;
	for (int i = 0; i < 100; ++i)
		controller.endFrame(nullptr);
	EXPECT_TRUE(controller.looks());
}

TEST(occlusionController, withoutTimersAnEighthMustBeHidden)
{
	OcclusionController enough, few;
	const OcclusionOutcome eighth = { 800, 100, 0, 0 }, less = { 800, 99, 0, 0 };
	EXPECT_EQ(framesUntilRest(enough, eighth, 50), 50u);
	EXPECT_EQ(framesUntilRest(few, less, 50), OcclusionController::kPatience);
}

TEST(occlusionController, everythingHiddenPays)
{
	OcclusionController controller;
	const OcclusionOutcome all = { 1000, 1000, 0.01, 0.05 };
	EXPECT_EQ(framesUntilRest(controller, all, 50), 50u);
}

}  // namespace tessera::test
