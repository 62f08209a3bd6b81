#include "layer/bound_state.h"

#include <algorithm>
#include <cstring>

namespace tessera::layer
{

void BoundState::bindDescriptorSets(VkPipelineBindPoint point, VkPipelineLayout layout, uint32_t first, uint32_t count, const VkDescriptorSet* sets,
									uint32_t offset_count, const uint32_t* offsets)
{
	// A call that binds at least as much replaces an earlier one, unless dynamic offsets make their split between sets unknown.
	std::erase_if(sets_, [&](const Sets& old) { return old.point == point && old.first >= first && old.first + old.sets.size() <= first + count; });
	sets_.push_back({ point, layout, first, { sets, sets + count }, { offsets, offsets + offset_count } });
}

void BoundState::pushConstants(VkPipelineLayout layout, VkShaderStageFlags stages, uint32_t offset, uint32_t size, const void* values)
{
	std::erase_if(pushes_, [&](const Push& old) {
		return (old.stages & ~stages) == 0 && old.offset >= offset && old.offset + old.values.size() <= offset + size;
	});
	const auto* bytes = static_cast<const std::byte*>(values);
	pushes_.push_back({ layout, stages, offset, { bytes, bytes + size } });
}

void BoundState::setViewports(uint32_t first, uint32_t count, const VkViewport* viewports)
{
	for (uint32_t i = 0; i < count; ++i)
		viewports_[first + i] = viewports[i];
}

void BoundState::setScissors(uint32_t first, uint32_t count, const VkRect2D* scissors)
{
	for (uint32_t i = 0; i < count; ++i)
		scissors_[first + i] = scissors[i];
}

void BoundState::bindIndexBuffer(VkBuffer buffer, VkDeviceSize offset, VkIndexType type)
{
	index_buffer_ = buffer;
	index_offset_ = offset;
	index_type_ = type;
}

void BoundState::bindVertexBuffers(uint32_t first, uint32_t count, const VkBuffer* buffers, const VkDeviceSize* offsets)
{
	for (uint32_t i = 0; i < count; ++i)
		vertex_buffers_[first + i] = { buffers[i], offsets[i] };
}

VkPipeline BoundState::pipeline(VkPipelineBindPoint point) const
{
	const auto found = pipelines_.find(point);
	return found == pipelines_.end() ? VK_NULL_HANDLE : found->second;
}

void BoundState::beginLabel(const VkDebugUtilsLabelEXT* label)
{
	labels_.push_back({ label->pLabelName, { label->color[0], label->color[1], label->color[2], label->color[3] } });
}

void BoundState::endLabel()
{
	if (!labels_.empty())
		labels_.pop_back();
}

void BoundState::endLabels(const DeviceFunctions& next, VkCommandBuffer commands) const
{
	const auto end = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(next.commands[size_t(Command::EndDebugUtilsLabelEXT)]);
	for (size_t i = 0; i < labels_.size(); ++i)
		end(commands);
}

void BoundState::replay(const DeviceFunctions& next, VkCommandBuffer commands) const
{
	for (const auto& [point, pipeline] : pipelines_)
		next.CmdBindPipeline(commands, point, pipeline);
	for (const Sets& bound : sets_)
		next.CmdBindDescriptorSets(commands, bound.point, bound.layout, bound.first, static_cast<uint32_t>(bound.sets.size()), bound.sets.data(),
								   static_cast<uint32_t>(bound.offsets.size()), bound.offsets.data());
	for (const Push& push : pushes_)
		next.CmdPushConstants(commands, push.layout, push.stages, push.offset, static_cast<uint32_t>(push.values.size()), push.values.data());
	for (const auto& [index, viewport] : viewports_)
		next.CmdSetViewport(commands, index, 1, &viewport);
	for (const auto& [index, scissor] : scissors_)
		next.CmdSetScissor(commands, index, 1, &scissor);
	for (const auto& [index, bound] : vertex_buffers_)
		next.CmdBindVertexBuffers(commands, index, 1, &bound.buffer, &bound.offset);
	if (index_buffer_)
		next.CmdBindIndexBuffer(commands, index_buffer_, index_offset_, index_type_);
	for (const auto& [command, call] : numbers_)
		call(commands);
	const auto begin = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(next.commands[size_t(Command::BeginDebugUtilsLabelEXT)]);
	for (const Label& label : labels_)
	{
		VkDebugUtilsLabelEXT info = { VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT };
		info.pLabelName = label.name.c_str();
		std::copy(label.color.begin(), label.color.end(), info.color);
		begin(commands, &info);
	}
}

}  // namespace tessera::layer
