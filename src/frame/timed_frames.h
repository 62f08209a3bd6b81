// Frames drawn to be timed: the device is kept busy between them, and says when their times can be trusted.
#pragma once
#include "frame/clock_load.h"
#include "frame/renderer.h"
#include "frame/settle.h"

#include <chrono>

namespace tessera
{

class TimedFrames
{
public:
	// Both must outlive this.
	TimedFrames(Renderer& renderer, ClockLoad& load) : renderer_(renderer), load_(load), settling_(renderer.planInput().device) {}

	// Errors: those of Renderer::renderFrame.
	Result<FrameResult> draw(const Camera& camera)
	{
		TRY_ASSIGN(FrameResult result, renderer_.renderFrame(camera));
		TRY(load_.submit());
		settling_.add(result.gpu_ms, seconds());
		return result;
	}

	// Whether frames drawn from now on run at the clock the device keeps (settle.h).
	bool isSettled() const { return settling_.isSettled(); }

	// Since this was made.
	double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
	Renderer& renderer_;
	ClockLoad& load_;
	SettleWatch settling_;
	std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace tessera
