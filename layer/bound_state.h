// What a command buffer has set for the commands that follow, kept so that it can be set again in the next segment of the same recording.
#pragma once
#include "layer/functions.h"

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace tessera::layer
{

class BoundState
{
public:
	void bindPipeline(VkPipelineBindPoint point, VkPipeline pipeline) { pipelines_[point] = pipeline; }
	void bindDescriptorSets(VkPipelineBindPoint point, VkPipelineLayout layout, uint32_t first, uint32_t count, const VkDescriptorSet* sets,
							uint32_t offset_count, const uint32_t* offsets);
	void pushConstants(VkPipelineLayout layout, VkShaderStageFlags stages, uint32_t offset, uint32_t size, const void* values);
	void setViewports(uint32_t first, uint32_t count, const VkViewport* viewports);
	void setScissors(uint32_t first, uint32_t count, const VkRect2D* scissors);
	void bindIndexBuffer(VkBuffer buffer, VkDeviceSize offset, VkIndexType type);
	void bindVertexBuffers(uint32_t first, uint32_t count, const VkBuffer* buffers, const VkDeviceSize* offsets);
	void beginLabel(const VkDebugUtilsLabelEXT* label);
	void endLabel();
	// Dynamic state of numbers only: the call itself is kept.
	void setNumbers(Command command, std::function<void(VkCommandBuffer)> call) { numbers_[command] = std::move(call); }
	// State that is not kept: named when a segment would have needed it.
	void setUnkept(Command command) { unkept_ = kCommandNames[size_t(command)]; }

	VkPipeline pipeline(VkPipelineBindPoint point) const;
	// The command, without "vkCmd", whose state cannot be set again; empty when everything can.
	const std::string& unkept() const { return unkept_; }
	void replay(const DeviceFunctions& next, VkCommandBuffer commands) const;
	// Labels that are open end with a segment, and begin again with the next: drivers keep them per command buffer.
	void endLabels(const DeviceFunctions& next, VkCommandBuffer commands) const;

private:
	struct Label
	{
		std::string name;
		std::array<float, 4> color;
	};
	struct Sets
	{
		VkPipelineBindPoint point;
		VkPipelineLayout layout;
		uint32_t first;
		std::vector<VkDescriptorSet> sets;
		std::vector<uint32_t> offsets;
	};
	struct Push
	{
		VkPipelineLayout layout;
		VkShaderStageFlags stages;
		uint32_t offset;
		std::vector<std::byte> values;
	};
	struct VertexBuffer
	{
		VkBuffer buffer;
		VkDeviceSize offset;
	};

	std::map<VkPipelineBindPoint, VkPipeline> pipelines_;
	std::vector<Sets> sets_;    // in the order of the calls: a later one may disturb what an earlier one bound
	std::vector<Push> pushes_;  // likewise
	std::map<uint32_t, VkViewport> viewports_;
	std::map<uint32_t, VkRect2D> scissors_;
	std::map<uint32_t, VertexBuffer> vertex_buffers_;
	VkBuffer index_buffer_ = VK_NULL_HANDLE;
	VkDeviceSize index_offset_ = 0;
	VkIndexType index_type_ = VK_INDEX_TYPE_UINT32;
	std::vector<Label> labels_;  // begun and not ended
	std::map<Command, std::function<void(VkCommandBuffer)>> numbers_;
	std::string unkept_;
};

}  // namespace tessera::layer
