// The search for the coarsening j of a frame, over made-up demands (contract C2).
#include "frame/rate_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>

namespace tessera::test
{

namespace
{

// Wanted over capacity at coarsening j; more than 1 does not fit.
using Demand = std::function<double(uint32_t j)>;

struct Search
{
	Attempt accepted;
	uint32_t attempts = 0;
	std::set<uint32_t> fitted, refused;
};

Search run(RateController& controller, const Demand& demand, double demand_at_one = 0)
{
	Search search;
	while (search.attempts < 2000)
	{
		const Attempt attempt = controller.next();
		++search.attempts;
		const double ratio = attempt.every_factor_one ? demand_at_one : demand(attempt.coarsening);
		AttemptOutcome outcome;
		outcome.fits = ratio <= 1;
		outcome.worst_ratio = std::max(ratio, 1.0);
		(outcome.fits ? search.fitted : search.refused).insert(attempt.coarsening);
		if (controller.accept(outcome))
		{
			search.accepted = attempt;
			return search;
		}
	}
	ADD_FAILURE() << "the search does not end";
	return search;
}

Search runNew(const Demand& demand)
{
	RateController controller;
	controller.beginFrame(false);
	return run(controller, demand);
}

// Falls with the square of the rate from `start`, but never below `floor` before `floor_end`.
Demand plateau(double start, double floor, uint32_t floor_end)
{
	return [=](uint32_t j) {
		return j < floor_end ? std::max(floor, start * std::exp2(-double(j) / 8)) : 0.5;
	};
}

Demand randomMonotone(std::mt19937& random)
{
	const double start = std::exp2(std::uniform_real_distribution(-2.0, 20.0)(random));
	std::vector<double> steps(RateController::kMostCoarsening + 1);
	std::exponential_distribution step(1.0 / std::uniform_real_distribution(0.02, 0.3)(random));
	double ratio = start;
	for (double& value : steps)
	{
		value = ratio;
		ratio *= std::exp2(-step(random));
	}
	return [steps](uint32_t j) {
		return steps.at(j);
	};
}

}  // namespace

TEST(rateController, whatFitsAtOnceIsTakenAtOnce)
{
	const Search search = runNew([](uint32_t) { return 0.9; });
	EXPECT_EQ(search.attempts, 1u);
	EXPECT_EQ(search.accepted.coarsening, 0u);
	EXPECT_EQ(search.accepted.rounds, 1u);
	EXPECT_FALSE(search.accepted.every_factor_one);
}

TEST(rateController, aDemandThatFallsWithTheSquareIsMetInFewAttempts)
{
	for (double start = 1.01; start < 1e6; start *= 1.7)
	{
		const Demand demand = [=](uint32_t j) {
			return start * std::exp2(-double(j) / 8);
		};
		const Search search = runNew(demand);
		EXPECT_LE(search.attempts, 12u) << start;
		EXPECT_LE(demand(search.accepted.coarsening), 1);
		EXPECT_GT(demand(search.accepted.coarsening - 1), 1);
	}
}

TEST(rateController, forAMonotoneDemandTheSmallestFittingJIsFound)
{
	std::mt19937 random(7);
	for (int i = 0; i < 500; ++i)
	{
		const Demand demand = randomMonotone(random);
		const Search search = runNew(demand);
		if (search.accepted.every_factor_one)
			continue;
		ASSERT_LE(demand(search.accepted.coarsening), 1);
		if (search.accepted.coarsening > 0)
		{
			ASSERT_GT(demand(search.accepted.coarsening - 1), 1);
		}
		ASSERT_LE(search.attempts, 24u);
	}
}

TEST(rateController, forAnyDemandTheAcceptedJFitsAndIsTheSmallestFoundToFit)
{
	std::mt19937 random(11);
	std::uniform_real_distribution noise(0.7, 1.4);
	for (int i = 0; i < 500; ++i)
	{
		const Demand falling = randomMonotone(random);
		std::vector<double> factors(RateController::kMostCoarsening + 1);
		std::generate(factors.begin(), factors.end(), [&] { return noise(random); });
		const Search search = runNew([&](uint32_t j) { return falling(j) * factors.at(j); });
		if (search.accepted.every_factor_one)
			continue;
		const uint32_t j = search.accepted.coarsening;
		ASSERT_TRUE(search.fitted.count(j));
		ASSERT_EQ(*search.fitted.begin(), j);
		ASSERT_TRUE(j == 0 || search.refused.count(j - 1));
		ASSERT_LE(search.attempts, 24u);
	}
}

TEST(rateController, aDemandThatHardlyFallsDoesNotTakeForever)
{
	for (const uint32_t end : { 20u, 60u, 120u, 300u, 639u })
	{
		const Search search = runNew(plateau(1.02, 1.01, end));
		EXPECT_EQ(search.accepted.coarsening, end);
		EXPECT_LE(search.attempts, 24u) << end;
	}
}

TEST(rateController, whatNoRateRelievesEndsWithEveryFactorOne)
{
	RateController controller;
	controller.beginFrame(false);
	const Search search = run(
		controller, [](uint32_t) { return 1000.0; }, 0.5);
	EXPECT_TRUE(search.accepted.every_factor_one);
	EXPECT_TRUE(search.refused.count(RateController::kMostCoarsening - 1)) << "every j comes before that";
	EXPECT_EQ(search.accepted.rounds, 1u);
	EXPECT_LE(search.attempts, 24u);
}

TEST(rateController, aStillCameraKeepsItsJAndDrawsOnce)
{
	RateController controller;
	controller.beginFrame(false);
	const Demand demand = [](uint32_t j) {
		return 50 * std::exp2(-double(j) / 8);
	};
	const Search first = run(controller, demand);
	for (int frame = 0; frame < 3; ++frame)
	{
		controller.beginFrame(true);
		const Search again = run(controller, demand);
		EXPECT_EQ(again.attempts, 1u);
		EXPECT_EQ(again.accepted.coarsening, first.accepted.coarsening);
	}
}

TEST(rateController, aCameraThatMovesStartsAnew)
{
	RateController controller;
	controller.beginFrame(false);
	run(controller, [](uint32_t j) { return 50 * std::exp2(-double(j) / 8); });
	controller.beginFrame(false);
	EXPECT_EQ(run(controller, [](uint32_t) { return 0.5; }).accepted.coarsening, 0u);
}

TEST(rateController, clustersThatOverflowAreDrawnInMoreRounds)
{
	RateController controller;
	controller.beginFrame(false);
	uint32_t rounds = 1;
	for (; rounds < 8; rounds *= 2)
	{
		EXPECT_EQ(controller.next().rounds, rounds);
		EXPECT_FALSE(controller.accept({ false, 1, true }));
	}
	EXPECT_EQ(controller.next().rounds, 8u);
	EXPECT_EQ(controller.next().coarsening, 0u) << "no rate relieves a list of clusters";
	EXPECT_TRUE(controller.accept({ true, 1, false }));
}

}  // namespace tessera::test
