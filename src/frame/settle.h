// How long a device is drawn on before its times are taken.
#pragma once
#include "plan/pass.h"

namespace tessera
{

// Seconds after which times can be trusted: a GPU that was idle, while a scene was loaded or errors were measured, clocks up slowly
// (docs/performance.md). 0 on a processor.
constexpr double settleSeconds(const DeviceTraits& device)
{
	return device.is_cpu ? 0 : 0.4;
}

}  // namespace tessera
