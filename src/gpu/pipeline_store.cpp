#include "gpu/pipeline_store.h"

#include <algorithm>
#include <iterator>

namespace tessera
{

namespace
{

// FNV-1a.
uint64_t hashOf(std::span<const uint32_t> words)
{
	uint64_t hash = 0xcbf29ce484222325ull;
	for (const uint32_t word : words)
		hash = (hash ^ word) * 0x100000001b3ull;
	return hash;
}

// What BindlessSet fills.
std::vector<VkDescriptorSetLayoutBinding> bindings(const Device& device)
{
	std::vector<VkDescriptorSetLayoutBinding> all = {
		{ 0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kMaxTextures, VK_SHADER_STAGE_ALL, nullptr },
		{ 1, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_ALL, nullptr },
		{ 2, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_ALL, nullptr },
		{ 3, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr },
		{ 4, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr },
		{ 5, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr },
		{ 6, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr },
	};
	if (device.gates.rays())
		all.push_back({ 7, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1, VK_SHADER_STAGE_ALL, nullptr });
	return all;
}

}  // namespace

Result<std::unique_ptr<PipelineStore>> PipelineStore::create(Device& device)
{
	std::unique_ptr<PipelineStore> store(new PipelineStore(device));
	const std::vector<VkDescriptorSetLayoutBinding> all = bindings(device);
	const std::vector<VkDescriptorBindingFlags> flags(all.size(), VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT);
	VkDescriptorSetLayoutBindingFlagsCreateInfo flags_info = { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO };
	flags_info.bindingCount = static_cast<uint32_t>(flags.size());
	flags_info.pBindingFlags = flags.data();
	VkDescriptorSetLayoutCreateInfo layout_info = { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, &flags_info };
	layout_info.bindingCount = static_cast<uint32_t>(all.size());
	layout_info.pBindings = all.data();
	VK_TRY(vkCreateDescriptorSetLayout(device.handle, &layout_info, nullptr, &store->set_layout_), "creating the descriptor set layout");

	const VkPushConstantRange range = { VK_SHADER_STAGE_ALL, 0, kPushConstantBytes };
	VkPipelineLayoutCreateInfo pipeline_info = { VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO };
	pipeline_info.setLayoutCount = 1;
	pipeline_info.pSetLayouts = &store->set_layout_;
	pipeline_info.pushConstantRangeCount = 1;
	pipeline_info.pPushConstantRanges = &range;
	VK_TRY(vkCreatePipelineLayout(device.handle, &pipeline_info, nullptr, &store->pipeline_layout_), "creating the pipeline layout");
	return store;
}

PipelineStore::~PipelineStore()
{
	entries_.clear();
	vkDestroyPipelineLayout(device_.handle, pipeline_layout_, nullptr);
	vkDestroyDescriptorSetLayout(device_.handle, set_layout_, nullptr);
}

PipelineStore::Key PipelineStore::keyOf(std::span<const Shader> shaders, const Constants& constants, const DrawState& state)
{
	Key key = { {}, constants, state };
	for (const Shader& shader : shaders)
		key.shaders.emplace_back(shader.name, hashOf(shader.words));
	return key;
}

Result<Pipeline> PipelineStore::make(CommandRecorder* commands, std::span<const Shader> shaders, const Constants& constants, const DrawState& state)
{
	if (shaders.front().stage == VK_SHADER_STAGE_RAYGEN_BIT_KHR)
		return makeRayPipeline(device_, *commands, pipeline_layout_, shaders, constants);
	if (shaders.size() == 1)
		return makeComputePipeline(device_, pipeline_layout_, shaders.front(), constants);
	return makeDrawPipeline(device_, pipeline_layout_, shaders, constants, state);
}

void PipelineStore::forgetUnused()
{
	size_t unused = 0;
	for (auto entry = entries_.begin(); entry != entries_.end();)
	{
		unused += entry->pipeline.use_count() == 1;
		entry = unused > kMostUnused && entry->pipeline.use_count() == 1 ? entries_.erase(entry) : std::next(entry);
	}
}

Result<PipelineStore::Shared> PipelineStore::find(CommandRecorder* commands, std::span<const Shader> shaders, const Constants& constants,
												  const DrawState& state)
{
	const Key key = keyOf(shaders, constants, state);
	const std::lock_guard guard(lock_);
	const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.key == key; });
	if (found != entries_.end())
	{
		entries_.splice(entries_.begin(), entries_, found);
		return found->pipeline;
	}
	TRY_ASSIGN(Pipeline made, make(commands, shaders, constants, state));
	Shared shared = std::make_shared<const Pipeline>(std::move(made));
	entries_.push_front({ key, shared });
	forgetUnused();
	return shared;
}

Result<PipelineStore::Shared> PipelineStore::get(CommandRecorder& commands, std::span<const Shader> shaders, const Constants& constants,
												 const DrawState& state)
{
	return find(&commands, shaders, constants, state);
}

Result<PipelineStore::Shared> PipelineStore::get(const Shader& shader, const Constants& constants)
{
	return find(nullptr, { &shader, 1 }, constants, {});
}

}  // namespace tessera
