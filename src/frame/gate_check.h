// Whether a device can draw with these options.
#pragma once
#include "gpu/device.h"
#include "plan/pass.h"

namespace tessera
{

// Errors: DeviceCannot (a gate that the raster path needs is closed), Usage (a picture that the device cannot draw).
Status checkGates(const Device& device, const PlanInput& input);

}  // namespace tessera
