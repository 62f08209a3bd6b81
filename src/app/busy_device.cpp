#include "app/busy_device.h"

namespace tessera
{

BusyDevice::BusyDevice(Renderer& renderer, const Camera& camera)
{
	if (renderer.planInput().device.is_cpu)
		return;
	// A frame that fails ends it; whoever uses the renderer next is told why.
	thread_ = std::thread([this, &renderer, camera] {
		while (!ends_ && renderer.renderFrame(camera))
		{}
	});
}

BusyDevice::~BusyDevice()
{
	ends_ = true;
	if (thread_.joinable())
		thread_.join();
}

}  // namespace tessera
