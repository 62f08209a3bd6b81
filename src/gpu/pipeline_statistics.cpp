#include "gpu/pipeline_statistics.h"

namespace tessera
{

static std::string valueText(const VkPipelineExecutableStatisticKHR& statistic)
{
	switch (statistic.format)
	{
	case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
		return statistic.value.b32 ? "yes" : "no";
	case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
		return fmt::format("{}", statistic.value.i64);
	case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
		return fmt::format("{}", statistic.value.u64);
	default:
		return fmt::format("{:g}", statistic.value.f64);
	}
}

void printPipelineStatistics(const Device& device, VkPipeline pipeline, std::string_view name)
{
	if (!device.pipeline_statistics)
		return;
	VkPipelineInfoKHR pipeline_info = { VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, nullptr, pipeline };
	uint32_t executable_count = 0;
	if (device.functions.executable_properties(device.handle, &pipeline_info, &executable_count, nullptr) < 0)
		return;
	for (uint32_t index = 0; index < executable_count; ++index)
	{
		VkPipelineExecutableInfoKHR info = { VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, nullptr, pipeline, index };
		uint32_t count = 0;
		if (device.functions.executable_statistics(device.handle, &info, &count, nullptr) < 0)
			return;
		std::vector<VkPipelineExecutableStatisticKHR> statistics(count, { VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR });
		if (device.functions.executable_statistics(device.handle, &info, &count, statistics.data()) < 0)
			return;
		std::string line(name);
		for (const VkPipelineExecutableStatisticKHR& statistic : statistics)
			line += fmt::format("{} {} {}", line.size() == name.size() ? ":" : ",", statistic.name, valueText(statistic));
		fmt::print(stderr, "{}\n", line);
	}
}

}  // namespace tessera
