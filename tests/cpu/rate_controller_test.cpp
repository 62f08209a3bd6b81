// Where a frame starts and when it is done (contract C2), and the candidates that the device chooses from.
#include "frame/rate_controller.h"

#include "frame/rate_steps.h"
#include "scene/build.h"
#include "scene/builtin.h"
#include "scene/factor_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tessera::test
{

namespace
{

constexpr uint32_t kMost = RateController::kMostCoarsening;

// A device whose lists hold what a round wants from this j on. kMost + 1: at no rate.
struct FakeDevice
{
	std::vector<uint32_t> smallest;  // per round, as many as there are rounds at most

	AttemptOutcome draw(const Attempt& attempt) const
	{
		AttemptOutcome outcome = { true, true, attempt.coarsening };
		for (uint32_t round = 0; round < attempt.rounds && outcome.fits && outcome.coarsening == attempt.coarsening; ++round)
		{
			const uint32_t j = std::max(attempt.coarsening, smallest.at(round % smallest.size()));
			outcome.fits = j <= kMost;
			outcome.rate_can_help = outcome.fits;
			outcome.coarsening = std::min(j, kMost);
		}
		return outcome;
	}
};

uint32_t attemptsOf(RateController& controller, const FakeDevice& device)
{
	for (uint32_t attempts = 1;; ++attempts)
		if (controller.accept(device.draw(controller.next())))
			return attempts;
}

}  // namespace

TEST(rateController, whatTheDeviceGrantsIsTheFrameAtOnce)
{
	for (const uint32_t j : { 0u, 1u, 30u, kMost })
	{
		RateController controller;
		controller.beginFrame(false);
		EXPECT_EQ(attemptsOf(controller, { { j } }), 1u);
		EXPECT_EQ(controller.next().coarsening, j);
		EXPECT_EQ(controller.next().rounds, 1u);
	}
}

TEST(rateController, aStillCameraStartsWithItsJAndAMovedOneAnew)
{
	RateController controller;
	controller.beginFrame(false);
	attemptsOf(controller, { { 45 } });
	for (int frame = 0; frame < 3; ++frame)
	{
		controller.beginFrame(true);
		EXPECT_EQ(controller.next().coarsening, 45u);
		EXPECT_EQ(attemptsOf(controller, { { 45 } }), 1u);
	}
	controller.beginFrame(false);
	EXPECT_EQ(controller.next().coarsening, 0u);
}

TEST(rateController, whereNoRateHelpsThereAreMoreRoundsAtTheAskedRate)
{
	RateController controller;
	controller.beginFrame(false);
	for (uint32_t rounds = 1; rounds < 8; rounds *= 2)
	{
		EXPECT_EQ(controller.next().rounds, rounds);
		EXPECT_EQ(controller.next().coarsening, 0u);
		EXPECT_FALSE(controller.accept({ false, false, 17 }));
	}
	EXPECT_EQ(controller.next().rounds, 8u);
	EXPECT_TRUE(controller.accept({ true, true, 0 }));
	controller.beginFrame(false);
	EXPECT_EQ(controller.next().rounds, 1u);
}

TEST(rateController, everyRoundOfAFrameHasTheSameRate)
{
	RateController controller;
	controller.beginFrame(false);
	EXPECT_FALSE(controller.accept({ false, false, 0 }));
	EXPECT_FALSE(controller.accept({ false, false, 0 }));
	const FakeDevice device = { { 3, 0, 12, 5 } };
	EXPECT_EQ(attemptsOf(controller, device), 3u) << "at 0, at 3, at 12";
	EXPECT_EQ(controller.next().coarsening, 12u);
	EXPECT_EQ(controller.next().rounds, 4u);
}

TEST(rateController, listsThatAreOverfullAllTheSameMakeTheNextRateTheStart)
{
	RateController controller;
	controller.beginFrame(false);
	EXPECT_FALSE(controller.accept({ false, true, 20 }));
	EXPECT_EQ(controller.next().coarsening, 21u);
	EXPECT_EQ(controller.next().rounds, 1u);
	EXPECT_FALSE(controller.accept({ false, true, kMost })) << "nothing is coarser";
	EXPECT_EQ(controller.next().rounds, 2u);
}

// --- candidates ------------------------------------------------------------------------------------------------------------------

namespace
{

struct Steps
{
	ViewRequest request;
	View view;
	FactorBound bound;
	std::vector<RateStep> steps;
};

Steps stepsOf(const BuiltScene& scene, const Camera& camera, double rate, uint32_t first)
{
	Steps made;
	made.request.rate_px = coarsenedRate(rate, first);
	made.view = *makeView(camera, scene, made.request);
	made.bound = boundFactors(camera, scene, made.request, 11, 8);
	made.steps = rateSteps(camera, made.view, made.request, first, made.bound.largest_factor, 11, 8);
	return made;
}

std::vector<Camera> cameras(const BuiltScene& scene)
{
	Camera framed = framingCamera(scene), close = framed, flat = framed;
	close.eye = close.target + (close.eye - close.target) * 0.4;
	flat.orthographic = true;
	flat.height_world = boundingRadius(scene);
	return { framed, close, flat };
}

}  // namespace

TEST(rateSteps, areTheViewsOfFramesAskedForAtThoseRates)
{
	const BuiltScene scene = *buildScene(*makeBuiltinScene("cube"));
	for (const Camera& camera : cameras(scene))
		for (const uint32_t first : { 0u, 9u })
		{
			const Steps made = stepsOf(scene, camera, 4, first);
			for (size_t k = 0; k + 1 < made.steps.size(); ++k)
			{
				ViewRequest asked = made.request;
				asked.rate_px = coarsenedRate(4, first + uint32_t(k));
				const View view = *makeView(camera, scene, asked);
				const FactorRule rule = factorRule(view, 11, 8);
				ASSERT_EQ(made.steps[k].rate_over_focal_squared, view.rate_over_focal_squared) << k;
				ASSERT_EQ(made.steps[k].sample_over_focal_squared, view.sample_over_focal_squared) << k;
				ASSERT_EQ(made.steps[k].rule.table_size, rule.table_size) << k;
				ASSERT_EQ(made.steps[k].rule.max_split, rule.max_split) << k;
			}
		}
}

TEST(rateSteps, endWhereEveryFactorIsOneAndNotBefore)
{
	const BuiltScene scene = *buildScene(*makeBuiltinScene("cube"));
	for (const Camera& camera : cameras(scene))
		for (const double rate : { 0.01, 4.0, 300.0 })
		{
			const Steps made = stepsOf(scene, camera, rate, 0);
			ASSERT_GE(made.steps.size(), 2u);
			ASSERT_LE(made.steps.size(), kMost + 1);
			EXPECT_TRUE(std::isinf(made.steps.back().rate_over_focal_squared));
			for (size_t k = 1; k < made.steps.size(); ++k)
				EXPECT_GE(made.steps[k].rate_over_focal_squared, made.steps[k - 1].rate_over_focal_squared) << "a full cluster stays full";
			for (size_t k = 1; k + 1 < made.steps.size(); ++k)
				EXPECT_FALSE(std::isinf(made.steps[k].rate_over_focal_squared)) << k;
		}
}

TEST(rateSteps, neverExceedTheirBuffer)
{
	const BuiltScene scene = *buildScene(*makeBuiltinScene("quad"));
	Camera flat = framingCamera(scene);
	flat.orthographic = true;
	flat.height_world = 1e-12;
	EXPECT_EQ(stepsOf(scene, flat, 1e-3, 0).steps.size(), kMost + 1);
	EXPECT_EQ(stepsOf(scene, flat, 1e-3, kMost - 1).steps.size(), 2u);
}

}  // namespace tessera::test
