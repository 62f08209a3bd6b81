// All pipelines of a device and the one layout that they share. Renderers of one device that need the same shaders with the same constants get the
// same pipelines, and one made for a renderer that is gone is still there for the next: making them takes most of the time before a first frame.
#pragma once
#include "gpu/pipeline.h"

#include <list>
#include <memory>
#include <mutex>

namespace tessera
{

class PipelineStore
{
public:
	// Pipelines that nobody uses any more and that are kept nevertheless, at most; about as many as three renderers have.
	static constexpr size_t kMostUnused = 64;

	using Shared = std::shared_ptr<const Pipeline>;

	// Errors: out of memory.
	static Result<std::unique_ptr<PipelineStore>> create(Device& device);
	~PipelineStore();
	PipelineStore(const PipelineStore&) = delete;
	PipelineStore& operator=(const PipelineStore&) = delete;

	VkDescriptorSetLayout setLayout() const { return set_layout_; }
	VkPipelineLayout layout() const { return pipeline_layout_; }

	// A pipeline of these shaders, made if there is none. What kind it is the shaders' stages tell: compute (one), rays (a ray generation shader
	// first), or a draw with `state`. `commands` upload a ray pipeline's table and must be free. Errors: those of make...Pipeline.
	Result<Shared> get(CommandRecorder& commands, std::span<const Shader> shaders, const Constants& constants, const DrawState& state = {});
	// One compute shader.
	Result<Shared> get(const Shader& shader, const Constants& constants);

	size_t size() const { return entries_.size(); }

private:
	// Everything that makes two pipelines the same; code by its hash.
	struct Key
	{
		std::vector<std::pair<std::string, uint64_t>> shaders;
		Constants constants;
		DrawState state;
		bool operator==(const Key&) const = default;
	};
	struct Entry
	{
		Key key;
		Shared pipeline;
	};

	explicit PipelineStore(Device& device) : device_(device) {}
	static Key keyOf(std::span<const Shader> shaders, const Constants& constants, const DrawState& state);
	Result<Pipeline> make(CommandRecorder* commands, std::span<const Shader> shaders, const Constants& constants, const DrawState& state);
	Result<Shared> find(CommandRecorder* commands, std::span<const Shader> shaders, const Constants& constants, const DrawState& state);
	void forgetUnused();

	Device& device_;
	VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
	VkPipelineLayout pipeline_layout_ = VK_NULL_HANDLE;
	std::mutex lock_;           // loaders make renderers on threads of their own
	std::list<Entry> entries_;  // what was asked for last comes first
};

}  // namespace tessera
