// What the driver compiled a pipeline to: registers, shared memory, spills. For finding out why a pass is slow.
#pragma once
#include "gpu/device.h"

#include <string_view>

namespace tessera
{

// One line on stderr, "NAME: statistic value, ...". Nothing unless the device was created with pipeline_statistics and offers
// VK_KHR_pipeline_executable_properties; `pipeline` must have been created with the capture flag.
void printPipelineStatistics(const Device& device, VkPipeline pipeline, std::string_view name);

}  // namespace tessera
