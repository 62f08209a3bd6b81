#include "gpu/pipeline.h"

#include "base/file.h"
#include "gpu/pipeline_statistics.h"
#include "gpu/pipeline_store.h"
#include "gpu/shader_stages.h"

#include <cstring>
#include <utility>

namespace tessera
{

VkShaderStageFlagBits stageOfName(std::string_view name)
{
	if (name.ends_with(".mesh"))
		return VK_SHADER_STAGE_MESH_BIT_EXT;
	if (name.ends_with(".vert"))
		return VK_SHADER_STAGE_VERTEX_BIT;
	if (name.ends_with(".frag"))
		return VK_SHADER_STAGE_FRAGMENT_BIT;
	if (name.ends_with(".rgen"))
		return VK_SHADER_STAGE_RAYGEN_BIT_KHR;
	if (name.ends_with(".rmiss"))
		return VK_SHADER_STAGE_MISS_BIT_KHR;
	if (name.ends_with(".rchit"))
		return VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR;
	if (name.ends_with(".rahit"))
		return VK_SHADER_STAGE_ANY_HIT_BIT_KHR;
	return VK_SHADER_STAGE_COMPUTE_BIT;
}

Result<std::unique_ptr<BindlessSet>> BindlessSet::create(Device& device)
{
	std::unique_ptr<BindlessSet> set(new BindlessSet(device));
	std::vector<VkDescriptorPoolSize> sizes = { { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kMaxTextures },
												{ VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2 },
												{ VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 4 } };
	if (device.gates.rays())
		sizes.push_back({ VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1 });
	VkDescriptorPoolCreateInfo pool_info = { VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO };
	pool_info.maxSets = 1;
	pool_info.poolSizeCount = static_cast<uint32_t>(sizes.size());
	pool_info.pPoolSizes = sizes.data();
	VK_TRY(vkCreateDescriptorPool(device.handle, &pool_info, nullptr, &set->pool_), "creating the descriptor pool");
	VkDescriptorSetAllocateInfo allocate = { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO };
	allocate.descriptorPool = set->pool_;
	allocate.descriptorSetCount = 1;
	const VkDescriptorSetLayout layout = device.pipelines->setLayout();
	allocate.pSetLayouts = &layout;
	VK_TRY(vkAllocateDescriptorSets(device.handle, &allocate, &set->set_), "allocating the descriptor set");
	return set;
}

BindlessSet::~BindlessSet()
{
	vkDestroyDescriptorPool(device_.handle, pool_, nullptr);
}

VkPipelineLayout BindlessSet::layout() const
{
	return device_.pipelines->layout();
}

void BindlessSet::writeTexture(uint32_t index, VkImageView view, VkSampler sampler)
{
	const VkDescriptorImageInfo image = { sampler, view, VK_IMAGE_LAYOUT_GENERAL };
	VkWriteDescriptorSet write = { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET };
	write.dstSet = set_;
	write.dstArrayElement = index;
	write.descriptorCount = 1;
	write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
	write.pImageInfo = &image;
	vkUpdateDescriptorSets(device_.handle, 1, &write, 0, nullptr);
}

void BindlessSet::writeImage(uint32_t binding, VkImageView view)
{
	const VkDescriptorImageInfo image = { VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_GENERAL };
	VkWriteDescriptorSet write = { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET };
	write.dstSet = set_;
	write.dstBinding = binding;
	write.descriptorCount = 1;
	write.descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
	write.pImageInfo = &image;
	vkUpdateDescriptorSets(device_.handle, 1, &write, 0, nullptr);
}

void BindlessSet::writeUniform(uint32_t binding, VkBuffer buffer)
{
	const VkDescriptorBufferInfo info = { buffer, 0, VK_WHOLE_SIZE };
	VkWriteDescriptorSet write = { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET };
	write.dstSet = set_;
	write.dstBinding = binding;
	write.descriptorCount = 1;
	write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
	write.pBufferInfo = &info;
	vkUpdateDescriptorSets(device_.handle, 1, &write, 0, nullptr);
}

void BindlessSet::writeStructure(VkAccelerationStructureKHR structure)
{
	VkWriteDescriptorSetAccelerationStructureKHR structures = { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR };
	structures.accelerationStructureCount = 1;
	structures.pAccelerationStructures = &structure;
	VkWriteDescriptorSet write = { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, &structures };
	write.dstSet = set_;
	write.dstBinding = 7;
	write.descriptorCount = 1;
	write.descriptorType = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
	vkUpdateDescriptorSets(device_.handle, 1, &write, 0, nullptr);
}

Pipeline::~Pipeline()
{
	if (handle_)
		vkDestroyPipeline(device_->handle, handle_, nullptr);
}

void Pipeline::swap(Pipeline& other) noexcept
{
	std::swap(device_, other.device_);
	std::swap(handle_, other.handle_);
	std::swap(bind_point_, other.bind_point_);
	std::swap(ray_table_, other.ray_table_);
}

std::filesystem::path shaderFolder()
{
	const std::filesystem::path program = programFolder();
	const std::filesystem::path installed = program.parent_path() / "share/tessera/shaders";
	std::error_code code;
	return std::filesystem::is_directory(installed, code) ? installed : program / "shaders";
}

Result<Shader> loadShader(std::string_view name)
{
	const std::filesystem::path path = shaderFolder() / (std::string(name) + ".spv");
	auto bytes = readFile(path);
	if (!bytes)
		return fail(ExitCode::DeviceCannot, "{} (a shader of the installation)", bytes.error().message);
	if (bytes->empty() || bytes->size() % 4 != 0)
		return fail(ExitCode::DeviceCannot, "{}: is no SPIR-V", path.string());
	Shader shader = { std::string(name), stageOfName(name), {} };
	shader.words.resize(bytes->size() / 4);
	std::memcpy(shader.words.data(), bytes->data(), bytes->size());
	return shader;
}

Result<Pipeline> makeComputePipeline(Device& device, VkPipelineLayout layout, const Shader& shader, const Constants& constants)
{
	ShaderStages stages(device, constants);
	TRY(stages.add(shader));
	VkComputePipelineCreateInfo info = { VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO };
	info.stage = stages.infos().front();
	info.layout = layout;
	info.flags = device.pipeline_statistics ? VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR : 0;
	VkPipeline pipeline = VK_NULL_HANDLE;
	VK_TRY(vkCreateComputePipelines(device.handle, device.pipeline_cache, 1, &info, nullptr, &pipeline), "creating the pipeline of {}", shader.name);
	device.nameObject(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(pipeline), shader.name);
	printPipelineStatistics(device, pipeline, shader.name);
	return Pipeline(device, pipeline, VK_PIPELINE_BIND_POINT_COMPUTE);
}

namespace
{

// The fixed state of every draw: reverse depth, one colour attachment of payloads.
struct FixedState
{
	explicit FixedState(const DrawState& state) : color_format(state.color)
	{
		input_assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
		viewport.viewportCount = 1;
		viewport.scissorCount = 1;
		rasterization.cullMode = state.cull;
		rasterization.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
		rasterization.lineWidth = 1;
		multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
		depth.depthTestEnable = VK_TRUE;
		depth.depthWriteEnable = VK_TRUE;
		depth.depthCompareOp = VK_COMPARE_OP_GREATER;
		attachment.colorWriteMask = VK_COLOR_COMPONENT_R_BIT;
		blend.attachmentCount = 1;
		blend.pAttachments = &attachment;
		dynamic.dynamicStateCount = 2;
		dynamic.pDynamicStates = dynamic_states;
		rendering.colorAttachmentCount = 1;
		rendering.pColorAttachmentFormats = &color_format;
		rendering.depthAttachmentFormat = state.depth;
	}
	FixedState(const FixedState&) = delete;

	VkFormat color_format;
	VkDynamicState dynamic_states[2] = { VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR };
	VkPipelineColorBlendAttachmentState attachment = {};
	VkPipelineVertexInputStateCreateInfo vertex_input = { VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO };
	VkPipelineInputAssemblyStateCreateInfo input_assembly = { VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO };
	VkPipelineViewportStateCreateInfo viewport = { VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO };
	VkPipelineRasterizationStateCreateInfo rasterization = { VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO };
	VkPipelineMultisampleStateCreateInfo multisample = { VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO };
	VkPipelineDepthStencilStateCreateInfo depth = { VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO };
	VkPipelineColorBlendStateCreateInfo blend = { VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO };
	VkPipelineDynamicStateCreateInfo dynamic = { VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO };
	VkPipelineRenderingCreateInfo rendering = { VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO };
};

}  // namespace

Result<Pipeline> makeDrawPipeline(Device& device, VkPipelineLayout layout, std::span<const Shader> shaders, const Constants& constants,
								  const DrawState& state)
{
	const FixedState fixed(state);
	ShaderStages stages(device, constants);
	TRY(stages.add(shaders));
	VkGraphicsPipelineCreateInfo info = { VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &fixed.rendering };
	info.stageCount = static_cast<uint32_t>(stages.infos().size());
	info.pStages = stages.infos().data();
	info.pVertexInputState = &fixed.vertex_input;
	info.pInputAssemblyState = &fixed.input_assembly;
	info.pViewportState = &fixed.viewport;
	info.pRasterizationState = &fixed.rasterization;
	info.pMultisampleState = &fixed.multisample;
	info.pDepthStencilState = &fixed.depth;
	info.pColorBlendState = &fixed.blend;
	info.pDynamicState = &fixed.dynamic;
	info.layout = layout;
	VkPipeline pipeline = VK_NULL_HANDLE;
	VK_TRY(vkCreateGraphicsPipelines(device.handle, device.pipeline_cache, 1, &info, nullptr, &pipeline), "creating the pipeline of {}",
		   shaders.front().name);
	device.nameObject(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(pipeline), shaders.front().name);
	return Pipeline(device, pipeline, VK_PIPELINE_BIND_POINT_GRAPHICS);
}

}  // namespace tessera
