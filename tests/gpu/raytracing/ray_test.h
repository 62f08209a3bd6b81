// What tests of rays share: they skip where the device traces none.
#pragma once
#include "gpu/gpu_test.h"

namespace tessera::test
{

class RayTest : public GpuTest
{
protected:
	void SetUp() override
	{
		GpuTest::SetUp();
		if (!IsSkipped() && !gpu().gates.rays())
			GTEST_SKIP() << "the device cannot trace rays";
	}
};

// 96 x 54, nothing culled: small enough for a software driver.
inline RenderOptions rayOptions(float rate, Raster raster)
{
	RenderOptions options;
	options.rate = rate;
	options.width_px = 96;
	options.height_px = 54;
	options.raster = raster;
	options.cull = { false, false, false };
	return options;
}

}  // namespace tessera::test
