// Pipelines: one layout for all (push constants and one bindless set), specialised by feature constants.
#pragma once
#include "gpu/resources.h"

#include <filesystem>
#include <map>
#include <span>

namespace tessera
{

constexpr uint32_t kPushConstantBytes = 128;
constexpr uint32_t kMaxTextures = 1024;

// Specialisation constants by id; a shader uses those it declares.
using Constants = std::map<uint32_t, uint32_t>;

// The bindless set: binding 0 colour textures, 1 visibility payload, 2 visibility depth, 3 View, 4 Surface, 5 height maps, 6 FrameHistory,
// 7 what rays are traced through (only where the device can trace any).
class BindlessSet
{
public:
	static Result<std::unique_ptr<BindlessSet>> create(Device& device);
	~BindlessSet();
	BindlessSet(const BindlessSet&) = delete;
	BindlessSet& operator=(const BindlessSet&) = delete;

	void writeTexture(uint32_t index, VkImageView view, VkSampler sampler);
	void writeImage(uint32_t binding, VkImageView view);
	void writeUniform(uint32_t binding, VkBuffer buffer);
	void writeStructure(VkAccelerationStructureKHR structure);
	VkPipelineLayout layout() const;
	VkDescriptorSet set() const { return set_; }

private:
	explicit BindlessSet(Device& device) : device_(device) {}
	Device& device_;
	VkDescriptorPool pool_ = VK_NULL_HANDLE;
	VkDescriptorSet set_ = VK_NULL_HANDLE;
};

// Where a ray tracing pipeline's shaders are found: its shader binding table.
struct RayTable
{
	Buffer buffer;
	VkStridedDeviceAddressRegionKHR raygen = {}, miss = {}, hit = {};
};

class Pipeline
{
public:
	Pipeline() = default;
	Pipeline(Device& device, VkPipeline handle, VkPipelineBindPoint bind_point) : device_(&device), handle_(handle), bind_point_(bind_point) {}
	Pipeline(Pipeline&& other) noexcept { swap(other); }
	Pipeline& operator=(Pipeline&& other) noexcept
	{
		swap(other);
		return *this;
	}
	~Pipeline();
	VkPipeline handle() const { return handle_; }
	VkPipelineBindPoint bindPoint() const { return bind_point_; }
	const RayTable& rayTable() const { return ray_table_; }
	void setRayTable(RayTable&& table) { ray_table_ = std::move(table); }

private:
	void swap(Pipeline& other) noexcept;
	Device* device_ = nullptr;
	VkPipeline handle_ = VK_NULL_HANDLE;
	VkPipelineBindPoint bind_point_ = VK_PIPELINE_BIND_POINT_COMPUTE;
	RayTable ray_table_;
};

// A SPIR-V module and the stage that its file name tells (.comp, .mesh, .vert, .frag, .rgen, .rmiss, .rchit, .rahit).
struct Shader
{
	std::string name;
	VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;
	std::vector<uint32_t> words;
};

// The stage that a shader's file name tells.
VkShaderStageFlagBits stageOfName(std::string_view name);

// The folder of the SPIR-V files: beside the program in a build, ../share/tessera/shaders in an installation.
std::filesystem::path shaderFolder();
// Errors: DeviceCannot when the file is missing or no SPIR-V.
Result<Shader> loadShader(std::string_view name);

// Pipelines as the device's store makes them (pipeline_store.h). Errors: DeviceCannot, out of memory.
Result<Pipeline> makeComputePipeline(Device& device, VkPipelineLayout layout, const Shader& shader, const Constants& constants);

struct DrawState
{
	VkFormat color = VK_FORMAT_R32_UINT;
	VkFormat depth = VK_FORMAT_D32_SFLOAT;
	VkCullModeFlags cull = VK_CULL_MODE_NONE;
	bool operator==(const DrawState&) const = default;
};
// A vertex or mesh shader and a fragment shader, drawing with reverse depth; viewport and scissor are dynamic.
Result<Pipeline> makeDrawPipeline(Device& device, VkPipelineLayout layout, std::span<const Shader> shaders, const Constants& constants,
								  const DrawState& state);

class CommandRecorder;
// A ray tracing pipeline of one ray generation and one miss shader and up to one closest-hit and one any-hit shader of triangles, told apart by
// their stages, the ray generation shader first. Its table is uploaded by `commands`, which must be free. Rays are not traced from hits.
Result<Pipeline> makeRayPipeline(Device& device, CommandRecorder& commands, VkPipelineLayout layout, std::span<const Shader> shaders,
								 const Constants& constants);

}  // namespace tessera
