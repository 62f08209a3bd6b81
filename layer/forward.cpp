// Every recorded command goes to the current segment of its command buffer. What a command sets for later ones is noted on the way.
#include "layer/device.h"

#include <type_traits>

namespace tessera::layer
{

namespace
{

constexpr bool startsWith(std::string_view text, std::string_view start)
{
	return text.substr(0, start.size()) == start;
}

constexpr bool isOneOf(Command command, std::initializer_list<Command> list)
{
	for (const Command one : list)
		if (one == command)
			return true;
	return false;
}

// Begin something that must end in the same command buffer.
constexpr bool opens(Command command)
{
	return isOneOf(command, { Command::BeginRenderPass, Command::BeginRenderPass2, Command::BeginRenderPass2KHR, Command::BeginRendering,
							  Command::BeginRenderingKHR, Command::BeginQuery, Command::BeginQueryIndexedEXT, Command::BeginConditionalRenderingEXT,
							  Command::BeginTransformFeedbackEXT, Command::BeginVideoCodingKHR });
}

constexpr bool closes(Command command)
{
	return isOneOf(command, { Command::EndRenderPass, Command::EndRenderPass2, Command::EndRenderPass2KHR, Command::EndRendering,
							  Command::EndRenderingKHR, Command::EndQuery, Command::EndQueryIndexedEXT, Command::EndConditionalRenderingEXT,
							  Command::EndTransformFeedbackEXT, Command::EndVideoCodingKHR });
}

// Set state by pointers that BoundState does not copy.
constexpr bool isUnkept(Command command)
{
	return isOneOf(command, { Command::PushDescriptorSet,
							  Command::PushDescriptorSetKHR,
							  Command::PushDescriptorSet2,
							  Command::PushDescriptorSet2KHR,
							  Command::PushDescriptorSetWithTemplate,
							  Command::PushDescriptorSetWithTemplateKHR,
							  Command::PushDescriptorSetWithTemplate2,
							  Command::PushDescriptorSetWithTemplate2KHR,
							  Command::BindDescriptorSets2,
							  Command::BindDescriptorSets2KHR,
							  Command::PushConstants2,
							  Command::PushConstants2KHR,
							  Command::BindDescriptorBuffersEXT,
							  Command::BindShadersEXT,
							  Command::BindIndexBuffer2,
							  Command::BindIndexBuffer2KHR,
							  Command::BindVertexBuffers2,
							  Command::BindVertexBuffers2EXT,
							  Command::SetViewportWithCount,
							  Command::SetViewportWithCountEXT,
							  Command::SetScissorWithCount,
							  Command::SetScissorWithCountEXT,
							  Command::SetVertexInputEXT,
							  Command::BindTransformFeedbackBuffersEXT,
							  Command::SetSampleLocationsEXT,
							  Command::SetFragmentShadingRateKHR });
}

template <typename... Args>
constexpr bool allNumbers()
{
	return ((std::is_arithmetic_v<Args> || std::is_enum_v<Args>)&&...);
}

void noteBarrier(Recording& recording, VkPipelineStageFlags from, VkPipelineStageFlags to, VkDependencyFlags, uint32_t count,
				 const VkMemoryBarrier* barriers, uint32_t buffer_count, const VkBufferMemoryBarrier* buffers, uint32_t, const VkImageMemoryBarrier*)
{
	recording.epoch += ordersBuilds(from, to, count, barriers, buffer_count, buffers);
}

void noteTrace(Device& device, Recording& recording)
{
	const std::lock_guard guard(device.object_lock);
	const VkPipeline pipeline = recording.state.pipeline(VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR);
	recording.traces_without_clusters = recording.traces_without_clusters || device.pipelines_without_clusters.contains(pipeline);
}

void noteBarrier2(Recording& recording, const VkDependencyInfo* dependency)
{
	recording.epoch += ordersBuilds(*dependency);
}

template <Command kCommand, typename... Args>
void note([[maybe_unused]] Device& device, [[maybe_unused]] Recording& recording, [[maybe_unused]] PFN_vkVoidFunction next,
		  [[maybe_unused]] Args... args)
{
	if constexpr (isOneOf(kCommand, { Command::TraceRaysKHR, Command::TraceRaysIndirectKHR, Command::TraceRaysIndirect2KHR }))
		noteTrace(device, recording);
	else if constexpr (opens(kCommand))
		recording.opened_by = kCommandNames[size_t(kCommand)], ++recording.open;
	else if constexpr (closes(kCommand))
		--recording.open;
	else if constexpr (kCommand == Command::PipelineBarrier)
		noteBarrier(recording, args...);
	else if constexpr (isOneOf(kCommand, { Command::PipelineBarrier2, Command::PipelineBarrier2KHR }))
		noteBarrier2(recording, args...);
	else if constexpr (isOneOf(kCommand, { Command::WaitEvents, Command::WaitEvents2, Command::WaitEvents2KHR }))
		++recording.epoch;  // events are not looked into
	else if constexpr (kCommand == Command::BindPipeline)
		recording.state.bindPipeline(args...);
	else if constexpr (kCommand == Command::BindDescriptorSets)
		recording.state.bindDescriptorSets(args...);
	else if constexpr (kCommand == Command::PushConstants)
		recording.state.pushConstants(args...);
	else if constexpr (kCommand == Command::SetViewport)
		recording.state.setViewports(args...);
	else if constexpr (kCommand == Command::SetScissor)
		recording.state.setScissors(args...);
	else if constexpr (kCommand == Command::BindIndexBuffer)
		recording.state.bindIndexBuffer(args...);
	else if constexpr (kCommand == Command::BindVertexBuffers)
		recording.state.bindVertexBuffers(args...);
	else if constexpr (kCommand == Command::BeginDebugUtilsLabelEXT)
		recording.state.beginLabel(args...);
	else if constexpr (kCommand == Command::EndDebugUtilsLabelEXT)
		recording.state.endLabel();
	else if constexpr (isUnkept(kCommand))
		recording.state.setUnkept(kCommand);
	else if constexpr (startsWith(kCommandNames[size_t(kCommand)], "Set") && kCommand != Command::SetDeviceMask && allNumbers<Args...>())
		recording.state.setNumbers(
			kCommand, [=](VkCommandBuffer commands) { reinterpret_cast<void(VKAPI_PTR*)(VkCommandBuffer, Args...)>(next)(commands, args...); });
}

template <Command kCommand, typename Function>
struct Forward;

template <Command kCommand, typename Returned, typename... Args>
struct Forward<kCommand, Returned(VKAPI_PTR*)(VkCommandBuffer, Args...)>
{
	static VKAPI_ATTR Returned VKAPI_CALL call(VkCommandBuffer buffer, Args... args)
	{
		Device& device = deviceOf(buffer);
		const PFN_vkVoidFunction next = device.next.commands[size_t(kCommand)];
		VkCommandBuffer segment = buffer;
		if (device.active)
			if (Recording* recording = device.recordings.find(buffer))
			{
				note<kCommand>(device, *recording, next, args...);
				segment = recording->current;
			}
		return reinterpret_cast<Returned(VKAPI_PTR*)(VkCommandBuffer, Args...)>(next)(segment, args...);
	}
};

}  // namespace

PFN_vkVoidFunction commandEntry(std::string_view name)
{
	static const std::unordered_map<std::string_view, PFN_vkVoidFunction> kEntries = {
#define LAYER_COMMAND(command) { #command, reinterpret_cast<PFN_vkVoidFunction>(Forward<Command::command, PFN_vkCmd##command>::call) },
#include "recorded_commands.inc"
#undef LAYER_COMMAND
	};
	if (!startsWith(name, "vkCmd"))
		return nullptr;
	const auto found = kEntries.find(name.substr(5));
	return found == kEntries.end() ? nullptr : found->second;
}

}  // namespace tessera::layer
