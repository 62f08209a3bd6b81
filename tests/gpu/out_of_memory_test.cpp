// Out of memory on the device: one line, whichever buffer it is that does not fit.
#include "gpu_test.h"

#include "frame/frame_dump.h"
#include "pipeline/passes.h"

namespace tessera::test
{

namespace
{

using outOfDeviceMemory = GpuTest;

// The device with less room for a buffer, until the end of the scope.
class SmallBuffers
{
public:
	explicit SmallBuffers(uint64_t bytes) : before_(gpu().limits.max_buffer_bytes) { gpu().limits.max_buffer_bytes = bytes; }
	~SmallBuffers() { gpu().limits.max_buffer_bytes = before_; }
	SmallBuffers(const SmallBuffers&) = delete;
	SmallBuffers& operator=(const SmallBuffers&) = delete;

private:
	uint64_t before_;
};

Result<FrameResult> drawWithin(const GpuScene& scene, uint64_t bytes, Raster path)
{
	const SmallBuffers small(bytes);
	RenderOptions options = smallOptions(8);
	options.raster = path;
	TRY_ASSIGN(const auto renderer, Renderer::create(gpu(), scene.built, scene.table, framePasses(), options, kDumpAndVisibilityOutputs));
	return renderer->renderFrame(scene.camera);
}

}  // namespace

TEST_F(outOfDeviceMemory, whicheverBufferDoesNotFitIsNamedInOneLine)
{
	const auto scene = gpuScene("quad");
	for (const Raster path : rasterPaths())
	{
		size_t refused = 0, drawn = 0;
		for (uint64_t bytes = 64; bytes <= uint64_t(1) << 27; bytes *= 8)
		{
			const Result<FrameResult> frame = drawWithin(*scene, bytes, path);
			drawn += frame.has_value();
			if (frame)
				continue;
			++refused;
			EXPECT_EQ(frame.error().code, ExitCode::BadInput) << frame.error().message;
			EXPECT_NE(frame.error().message.find("too many for one buffer"), std::string::npos) << frame.error().message;
			EXPECT_EQ(frame.error().message.find('\n'), std::string::npos);
		}
		EXPECT_GT(refused, 2u) << rasterName(path);
		EXPECT_GT(drawn, 0u) << rasterName(path);
	}
}

}  // namespace tessera::test
