// What every kind of pipeline is made of: shader modules, their stages, and the values of their specialisation constants.
#pragma once
#include "gpu/pipeline.h"

namespace tessera
{

// Specialisation data as Vulkan wants it; keeps what it points to alive.
class Specialization
{
public:
	explicit Specialization(const Constants& constants)
	{
		for (const auto& [id, value] : constants)
		{
			entries_.push_back({ id, static_cast<uint32_t>(values_.size() * sizeof(uint32_t)), sizeof(uint32_t) });
			values_.push_back(value);
		}
		info_ = { static_cast<uint32_t>(entries_.size()), entries_.data(), values_.size() * sizeof(uint32_t), values_.data() };
	}
	const VkSpecializationInfo* info() const { return &info_; }

private:
	std::vector<VkSpecializationMapEntry> entries_;
	std::vector<uint32_t> values_;
	VkSpecializationInfo info_ = {};
};

inline Result<VkShaderModule> makeModule(Device& device, const Shader& shader)
{
	VkShaderModuleCreateInfo info = { VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO };
	info.codeSize = shader.words.size() * sizeof(uint32_t);
	info.pCode = shader.words.data();
	VkShaderModule shader_module = VK_NULL_HANDLE;
	VK_TRY(vkCreateShaderModule(device.handle, &info, nullptr, &shader_module), "loading shader {} ({} bytes of SPIR-V)", shader.name, info.codeSize);
	return shader_module;
}

inline VkPipelineShaderStageCreateInfo stageInfo(const Shader& shader, VkShaderModule shader_module, const Specialization& specialization)
{
	VkPipelineShaderStageCreateInfo info = { VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO };
	info.stage = shader.stage;
	info.module = shader_module;
	info.pName = "main";
	info.pSpecializationInfo = specialization.info();
	return info;
}

}  // namespace tessera
