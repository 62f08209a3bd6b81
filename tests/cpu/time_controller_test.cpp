// The controller of --max-ms, and when times can be trusted, on frames whose time a formula gives.
#include "frame/settle.h"
#include "frame/time_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace tessera::test
{

namespace
{

// Time of a frame: what it always takes, and what falls with the square of the rate.
struct Cost
{
	double fixed_ms = 0.1, at_one_px_ms = 1;

	double operator()(double rate_px) const { return fixed_ms + at_one_px_ms / (rate_px * rate_px); }
};

struct Drive
{
	std::vector<double> ms, rates;
	uint32_t changes = 0;

	double mostAfter(size_t first) const { return *std::max_element(ms.begin() + ptrdiff_t(first), ms.end()); }
	double leastAfter(size_t first) const { return *std::min_element(ms.begin() + ptrdiff_t(first), ms.end()); }
};

Drive driven(TimeController& controller, uint32_t frames, const std::function<double(uint32_t, double)>& msOf)
{
	Drive run;
	for (uint32_t i = 0; i < frames; ++i)
	{
		const double rate = controller.rate(), ms = msOf(i, rate);
		run.ms.push_back(ms);
		run.rates.push_back(rate);
		controller.endFrame(rate, ms);
		run.changes += controller.rate() != rate;
	}
	return run;
}

}  // namespace

TEST(timeController, findsTheFinestRateThatFitsAndRestsThere)
{
	for (const Cost cost : { Cost{ 0.1, 1 }, Cost{ 1.5, 0.4 }, Cost{ 0.01, 30 }, Cost{ 1.7, 5 } })
		for (const double start : { 0.1, 4.0, 100.0 })
		{
			TimeController controller(2, start);
			const Drive run = driven(controller, 120, [&](uint32_t, double rate) { return cost(rate); });
			EXPECT_TRUE(controller.isSettled()) << cost.fixed_ms << " " << start;
			EXPECT_LE(run.mostAfter(60), 2.0) << cost.fixed_ms << " " << cost.at_one_px_ms << " " << start;
			EXPECT_GE(run.leastAfter(60), 2.0 * TimeController::kRoom) << cost.fixed_ms << " " << cost.at_one_px_ms << " " << start;
			EXPECT_EQ(run.rates[60], run.rates.back()) << "the rate moves although nothing else does";
		}
}

TEST(timeController, holdsItsBudgetWithinATenthWhileTheCostOfTheViewChanges)
{
	TimeController controller(2, 4);
	std::mt19937 random(1);
	std::uniform_real_distribution<double> noise(0.985, 1.015);
	const Drive run = driven(controller, 400, [&](uint32_t frame, double rate) {
		// Eight times as much and back, twice.
		const Cost cost = { 0.2, 3 * std::exp2(1.5 * std::sin(frame * 0.031)) };
		return cost(rate) * noise(random);
	});
	EXPECT_LE(run.mostAfter(100), 2.2);
	EXPECT_GE(run.leastAfter(100), 1.0);
}

TEST(timeController, noiseWithinTheRoomMovesNothing)
{
	TimeController controller(2, 1);
	const Cost cost = { 0.1, 1.75 };
	std::mt19937 random(2);
	std::uniform_real_distribution<double> noise(0.96, 1.04);
	const Drive run = driven(controller, 200, [&](uint32_t, double rate) { return cost(rate) * noise(random); });
	EXPECT_EQ(run.changes, 0u);
}

TEST(timeController, whatNoRateCanHelpEndsAtTheCoarsestAndTheFinest)
{
	TimeController tight(1, 4), roomy(1, 4);
	driven(tight, 60, [](uint32_t, double) { return 5.0; });
	driven(roomy, 200, [](uint32_t, double) { return 0.01; });
	EXPECT_EQ(tight.rate(), TimeController::kCoarsest_px);
	EXPECT_EQ(roomy.rate(), TimeController::kFinest_px);
	EXPECT_TRUE(tight.isSettled());
	EXPECT_TRUE(roomy.isSettled());
}

TEST(timeController, framesOfAnOlderRateDoNotCorrectTheNewOne)
{
	TimeController controller(2, 1);
	controller.endFrame(1, 4);
	const double corrected = controller.rate();
	EXPECT_GT(corrected, 1);
	controller.endFrame(1, 4);
	controller.endFrame(1, 4);
	EXPECT_EQ(controller.rate(), corrected);
}

// --- When a device has settled ---------------------------------------------------------------------------------------------------------------

namespace
{

// Seconds after which frames count as settled, when one that ends at `seconds` takes `ms(seconds)`.
double settledAfter(const std::function<double(double)>& ms, bool is_cpu = false)
{
	DeviceTraits device;
	device.is_cpu = is_cpu;
	SettleWatch watch(device);
	double seconds = 0;
	while (!watch.isSettled() && seconds < 100)
	{
		seconds += 1e-3 * ms(seconds) + 1e-4;
		watch.add(ms(seconds), seconds);
	}
	return seconds;
}

}  // namespace

TEST(settleWatch, waitsWhileFramesGetFaster)
{
	// Twice as fast within 1.5 seconds, then at rest.
	const auto ramp = [](double seconds) {
		return 0.2 - 0.1 * std::min(seconds / 1.5, 1.0);
	};
	EXPECT_GE(settledAfter(ramp), 1.5);
	EXPECT_LE(settledAfter(ramp), 2.5);
}

TEST(settleWatch, steadyFramesTakeThreeWindows)
{
	std::mt19937 random(5);
	std::normal_distribution<double> noise(0.3, 0.01);
	EXPECT_NEAR(settledAfter([&](double) { return noise(random); }), 0.6, 0.25);
}

TEST(settleWatch, givesUpAndNeverWaitsOnAProcessor)
{
	EXPECT_NEAR(settledAfter([](double seconds) { return std::exp(-seconds); }), 3, 0.1) << "faster for ever";
	EXPECT_LE(settledAfter([](double) { return 5000.0; }), 6) << "slow frames";
	EXPECT_EQ(settledAfter([](double) { return 1.0; }, true), 0);
}

}  // namespace tessera::test
