// Keeps a GPU from clocking down while a processor works on what it drew.
#pragma once
#include "frame/renderer.h"

#include <atomic>
#include <thread>

namespace tessera
{

// Draws frames of `camera` on a thread of its own until it ends; nothing on a device that is a processor itself. Meanwhile nobody else may use the
// renderer or its device.
class BusyDevice
{
public:
	BusyDevice(Renderer& renderer, const Camera& camera);
	~BusyDevice();
	BusyDevice(const BusyDevice&) = delete;
	BusyDevice& operator=(const BusyDevice&) = delete;

private:
	std::atomic<bool> ends_ = false;
	std::thread thread_;
};

}  // namespace tessera
