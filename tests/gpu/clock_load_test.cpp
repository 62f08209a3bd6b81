// What keeps a GPU's clock up between measured frames. It does nothing on processors, so this test takes the device for a GPU.
#include "frame/clock_load.h"
#include "gpu_test.h"

namespace tessera::test
{

namespace
{

using clockLoad = GpuTest;

struct AsGpu
{
	AsGpu() { gpu().is_cpu = false; }
	~AsGpu() { gpu().is_cpu = before; }
	AsGpu(const AsGpu&) = delete;
	AsGpu& operator=(const AsGpu&) = delete;
	bool before = gpu().is_cpu;
};

}  // namespace

TEST_F(clockLoad, framesBetweenAreTheSame)
{
	const auto scene = gpuScene("quad");
	const RenderOptions options = smallOptions(8);
	const GpuFrame alone = drawFrame(*scene, options);
	std::unique_ptr<ClockLoad> load;
	{
		const AsGpu scope;
		auto made = ClockLoad::create(gpu(), 100);
		ASSERT_TRUE(made) << made.error().message;
		load = std::move(*made);
		for (int i = 0; i < 3; ++i)
			ASSERT_TRUE(load->submit());
	}
	EXPECT_EQ(drawFrame(*scene, options).picture(), alone.picture());
}

// The device may still be at it; the test's end finds any message of the validation layers.
TEST_F(clockLoad, mayEndWhileTheDeviceIsAtIt)
{
	const AsGpu scope;
	auto load = ClockLoad::create(gpu(), 20'000);
	ASSERT_TRUE(load) << load.error().message;
	ASSERT_TRUE((*load)->submit());
}

}  // namespace tessera::test
