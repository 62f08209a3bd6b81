#include "gpu/vulkan.h"

#include "base/check.h"

namespace tessera
{

std::string_view vulkanResultName(VkResult result)
{
	switch (result)
	{
	case VK_SUCCESS:
		return "success";
	case VK_NOT_READY:
		return "not ready";
	case VK_TIMEOUT:
		return "timeout";
	case VK_INCOMPLETE:
		return "incomplete";
	case VK_ERROR_OUT_OF_HOST_MEMORY:
		return "out of host memory";
	case VK_ERROR_OUT_OF_DEVICE_MEMORY:
		return "out of device memory";
	case VK_ERROR_INITIALIZATION_FAILED:
		return "initialisation failed";
	case VK_ERROR_DEVICE_LOST:
		return "device lost";
	case VK_ERROR_LAYER_NOT_PRESENT:
		return "layer not present";
	case VK_ERROR_EXTENSION_NOT_PRESENT:
		return "extension not present";
	case VK_ERROR_FEATURE_NOT_PRESENT:
		return "feature not present";
	case VK_ERROR_INCOMPATIBLE_DRIVER:
		return "incompatible driver";
	case VK_ERROR_TOO_MANY_OBJECTS:
		return "too many objects";
	case VK_ERROR_FORMAT_NOT_SUPPORTED:
		return "format not supported";
	case VK_ERROR_FRAGMENTED_POOL:
		return "fragmented pool";
	case VK_ERROR_OUT_OF_POOL_MEMORY:
		return "out of pool memory";
	default:
		return "unknown error";
	}
}

ExitCode exitCodeOf(VkResult result)
{
	switch (result)
	{
	case VK_ERROR_DEVICE_LOST:
		return ExitCode::DeviceLost;
	case VK_ERROR_OUT_OF_HOST_MEMORY:
	case VK_ERROR_OUT_OF_DEVICE_MEMORY:
		return ExitCode::BadInput;
	default:
		return ExitCode::DeviceCannot;
	}
}

Error vulkanError(VkResult result, const std::string& what)
{
	const std::string where = result == VK_ERROR_DEVICE_LOST ? fmt::format(" (last worked on: {})", workingOn()) : "";
	return { exitCodeOf(result), fmt::format("{}: {} ({}){}", what, vulkanResultName(result), static_cast<int>(result), where) };
}

}  // namespace tessera
