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

// The stages of one pipeline while it is made: their modules go with this.
class ShaderStages
{
public:
	ShaderStages(const Device& device, const Constants& constants) : device_(device), specialization_(constants) {}
	~ShaderStages()
	{
		for (const auto& stage : infos_)
			vkDestroyShaderModule(device_.handle, stage.module, nullptr);
	}
	ShaderStages(const ShaderStages&) = delete;
	ShaderStages& operator=(const ShaderStages&) = delete;

	// Errors: out of memory, with the shader's name.
	Status add(const Shader& shader)
	{
		VkShaderModuleCreateInfo code = { VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO };
		code.codeSize = shader.words.size() * sizeof(uint32_t);
		code.pCode = shader.words.data();
		VkPipelineShaderStageCreateInfo info = { VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO };
		VK_TRY(vkCreateShaderModule(device_.handle, &code, nullptr, &info.module), "loading shader {} ({} bytes of SPIR-V)", shader.name,
			   code.codeSize);
		info.stage = shader.stage;
		info.pName = "main";
		info.pSpecializationInfo = specialization_.info();
		infos_.push_back(info);
		return {};
	}
	Status add(std::span<const Shader> shaders)
	{
		for (const Shader& shader : shaders)
			TRY(add(shader));
		return {};
	}

	std::span<const VkPipelineShaderStageCreateInfo> infos() const { return infos_; }

private:
	const Device& device_;
	Specialization specialization_;
	std::vector<VkPipelineShaderStageCreateInfo> infos_;
};

}  // namespace tessera
