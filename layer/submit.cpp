// Submission: a batch whose command buffers have work for the host is taken apart, and its pieces are run one after the other.
#include "layer/device.h"
#include "layer/sizes.h"

#include <algorithm>

namespace tessera::layer
{

namespace
{

VkCommandBuffer bufferOf(VkCommandBuffer buffer)
{
	return buffer;
}
VkCommandBuffer bufferOf(const VkCommandBufferSubmitInfo& info)
{
	return info.commandBuffer;
}

std::span<const VkCommandBuffer> buffersOf(const VkSubmitInfo& submit)
{
	return { submit.pCommandBuffers, submit.commandBufferCount };
}
std::span<const VkCommandBufferSubmitInfo> buffersOf(const VkSubmitInfo2& submit)
{
	return { submit.pCommandBufferInfos, submit.commandBufferInfoCount };
}

// The batch's waits alone, and its signals alone.
VkSubmitInfo waitsOf(VkSubmitInfo submit)
{
	submit.commandBufferCount = submit.signalSemaphoreCount = 0;
	return submit;
}
VkSubmitInfo signalsOf(VkSubmitInfo submit)
{
	submit.commandBufferCount = submit.waitSemaphoreCount = 0;
	return submit;
}
VkSubmitInfo2 waitsOf(VkSubmitInfo2 submit)
{
	submit.commandBufferInfoCount = submit.signalSemaphoreInfoCount = 0;
	return submit;
}
VkSubmitInfo2 signalsOf(VkSubmitInfo2 submit)
{
	submit.commandBufferInfoCount = submit.waitSemaphoreInfoCount = 0;
	return submit;
}

VkResult submitNext(const Device& device, VkQueue queue, uint32_t count, const VkSubmitInfo* submits, VkFence fence)
{
	return device.next.QueueSubmit(queue, count, submits, fence);
}
VkResult submitNext(const Device& device, VkQueue queue, uint32_t count, const VkSubmitInfo2* submits, VkFence fence)
{
	return device.next.QueueSubmit2(queue, count, submits, fence);
}

template <typename Submit>
bool hasHostCommands(Device& device, const Submit& submit)
{
	for (const auto& entry : buffersOf(submit))
		if (const Recording* recording = device.recordings.find(bufferOf(entry)); recording && !recording->steps.empty())
			return true;
	return false;
}

HostLink& linkOf(Device& device, VkQueue queue)
{
	uint32_t family = 0;
	{
		const std::lock_guard guard(device.object_lock);
		const auto found = device.queue_families.find(queue);
		family = found == device.queue_families.end() ? 0 : found->second;
	}
	std::unique_ptr<HostLink>& link = device.links[family];
	if (!link)
		link = std::make_unique<HostLink>(device, family);
	return *link;
}

const char* commandName(const HostCommand& command)
{
	const auto* cluster = std::get_if<ClusterCommand>(&command);
	return cluster ? nameOf(cluster->input.type()) : std::holds_alternative<TopLevelBuild>(command) ? "top-level build" : "copy of a structure";
}

// Rays that can only meet clusters, by a pipeline that must not. Where there are other scenes as well, these may be what it traces.
void checkTraces(Device& device, VkCommandBuffer buffer)
{
	const Recording* recording = device.recordings.find(buffer);
	if (recording && recording->traces_without_clusters && device.structures.onlyClusters())
		device.report.violation(
			"trace-without-clusters",
			"vkCmdTraceRaysKHR: the bound pipeline has no VkRayTracingPipelineClusterAccelerationStructureCreateInfoNV that allows "
			"clusters, and all top-level structures have clusters");
}

VkResult runBuffer(const HostContext& context, VkCommandBuffer buffer)
{
	const Recording* recording = context.device.recordings.find(buffer);
	context.hazards = {};
	if (recording)
		for (const Step& step : recording->steps)
		{
			VkResult result = context.link.submitAndWait(context.queue, step.segment);
			context.hazards.begin(step.epoch, commandName(step.command));
			if (result == VK_SUCCESS)
				result = std::visit([&](const auto& command) { return execute(context, command); }, step.command);
			context.hazards.end(context.device.report);
			if (result != VK_SUCCESS)
				return result;
		}
	checkTraces(context.device, buffer);
	const VkCommandBuffer last = recording ? recording->current : buffer;
	VkSubmitInfo submit = { VK_STRUCTURE_TYPE_SUBMIT_INFO };
	submit.commandBufferCount = 1;
	submit.pCommandBuffers = &last;
	return context.device.next.QueueSubmit(context.queue, 1, &submit, VK_NULL_HANDLE);
}

template <typename Submit>
VkResult runBatch(const HostContext& context, const Submit& submit)
{
	const Submit waits = waitsOf(submit), signals = signalsOf(submit);
	VkResult result = submitNext(context.device, context.queue, 1, &waits, VK_NULL_HANDLE);
	for (const auto& entry : buffersOf(submit))
		if (result == VK_SUCCESS)
			result = runBuffer(context, bufferOf(entry));
	return result == VK_SUCCESS ? submitNext(context.device, context.queue, 1, &signals, VK_NULL_HANDLE) : result;
}

template <typename Submit>
VkResult submitAll(VkQueue queue, uint32_t count, const Submit* submits, VkFence fence)
{
	Device& device = deviceOf(queue);
	if (!device.active || std::none_of(submits, submits + count, [&](const Submit& submit) { return hasHostCommands(device, submit); }))
	{
		for (uint32_t i = 0; device.active && i < count; ++i)
			for (const auto& entry : buffersOf(submits[i]))
				checkTraces(device, bufferOf(entry));
		return submitNext(device, queue, count, submits, fence);
	}
	const std::lock_guard guard(device.submit_lock);
	Hazards hazards;
	const HostContext context = { device, linkOf(device, queue), queue, hazards };
	for (uint32_t i = 0; i < count; ++i)
	{
		const VkResult result =
			hasHostCommands(device, submits[i]) ? runBatch(context, submits[i]) : submitNext(device, queue, 1, submits + i, VK_NULL_HANDLE);
		if (result != VK_SUCCESS)
			return result;
	}
	return fence ? submitNext(device, queue, 0, static_cast<const Submit*>(nullptr), fence) : VK_SUCCESS;
}

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL queueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo* submits, VkFence fence)
{
	return submitAll(queue, count, submits, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL queueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2* submits, VkFence fence)
{
	return submitAll(queue, count, submits, fence);
}

}  // namespace tessera::layer
