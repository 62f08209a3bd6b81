// Every buffer and image that a plan keeps, by the name that passes use; scene arrays are uploaded when first kept.
#pragma once
#include "frame/dump_layout.h"
#include "frame/lists.h"
#include "frame/rate_controller.h"
#include "frame/ray_clusters.h"
#include "frame/ray_structures.h"
#include "frame/shared_structures.h"
#include "frame/stats.h"
#include "gpu/commands.h"
#include "gpu/pipeline.h"
#include "scene/camera.h"
#include "shared/history.h"
#include "tables/table.h"
#include "tessellation/rate_search.h"

#include <map>

namespace tessera
{

// Names and sizes of all resources, for the planner.
std::span<const ResourceDesc> resourceDescs();

class FrameResources
{
public:
	static Result<std::unique_ptr<FrameResources>> create(Device& device, const BuiltScene& scene, const TessellationTable& table,
														  const PlanInput& input);

	// Makes and fills what the plan keeps and does not exist yet.
	Status prepare(const FramePlan& plan, const PlanInput& input);
	// Lets go of what other options make stale: lists of other capacities, pictures of another size, and, with the next plan, what that
	// does not keep. Nothing of it may be in use. Errors: those of listCapacities; then nothing has changed.
	Status refit(const PlanInput& before, const PlanInput& after);
	// Makes a list that grows on demand hold `wanted`. True when its capacity has changed, or cannot any more and decides the rate from now
	// on (decidingLists): the frame can be drawn again. False when nothing has changed.
	bool grow(const ListDesc& list, uint32_t wanted, const PlanInput& input);
	// Makes micro_dump, where it is kept, hold all of the last submitted frame. True when it was too small: the frame
	// must be drawn again. Errors: BadInput (out of memory).
	Result<bool> growDump();
	const DumpLayout& dumpLayout() const { return dump_; }
	// The same for what rays are traced through: true when the last submitted frame had more micro-triangles, or clusters, than that was reserved
	// for. Errors: BadInput (the clusters of even the coarsest frame exceed what they may take).
	Result<bool> raysAreTooSmall(const PlanInput& input);
	// Records the uploads of a round. `makes_pyramid`: it writes a depth pyramid. `steps`: candidates of rate_search, empty where the plan has none.
	Status writeView(const View& view, uint32_t round, bool makes_pyramid, std::span<const RateStep> steps = {});
	// A frame is drawn that measured what is hidden: what follows goes by that. True when an instance that had grown coarser because it was hidden
	// may be seen: the frame must be drawn again, in which it has not.
	bool takeHidden();
	// The next frame is as the first: nothing is taken for hidden.
	void dropHidden() { hidden_source_ = HiddenSource::Nothing; }
	// Records that what follows draws from another camera (drawnFrom).
	void recordDrawView(const View& view) const;
	// Records that nothing has been seen yet: after rounds that were not drawn to the end.
	void clearVisibility();

	uint64_t address(std::string_view name) const;
	const Buffer& buffer(std::string_view name) const;
	const ImageResource& image(std::string_view name) const;
	bool has(std::string_view name) const { return buffers_.count(std::string(name)) > 0; }
	uint64_t headOffset(std::string_view list) const;
	uint32_t capacity(std::string_view list) const;
	uint32_t round() const { return round_; }
	const View& view() const { return view_; }
	// Whether the last frame could look at the depth pyramid of the one before it.
	bool hadHistory() const { return had_history_; }
	uint32_t rateStepCount() const { return static_cast<uint32_t>(steps_.size()); }
	// Bit per list whose capacity limits the rate: all but batches, which follow from parts, and those that can grow.
	uint32_t decidingLists(const PlanInput& input) const;
	uint32_t tableSize() const { return table_.max_edge_segments; }
	const BindlessSet& bindless() const { return *bindless_; }
	BindlessSet& bindless() { return *bindless_; }
	CommandRecorder& commands() { return *commands_; }
	MemoryStats memory() const;
	const RayStructures& rays() const { return rays_; }
	const RayClusters& clusters() const { return clusters_; }
	const SharedStructures& sharedStructures() const { return shared_; }
	SharedStructures& sharedStructures() { return shared_; }

	// Heads and counts of the last submitted frame; valid after readCounts was recorded and waited for.
	void recordCountsReadback(VkCommandBuffer commands) const;
	ListHead head(uint32_t list) const;
	FrameCounts counts() const;
	// Copies a buffer to the host, waiting for it.
	Result<std::vector<std::byte>> read(std::string_view name, uint64_t bytes);

private:
	FrameResources(Device& device, const BuiltScene& scene, const TessellationTable& table)
		: device_(device), scene_(scene), table_(table), rays_(device), clusters_(device), shared_(device, scene)
	{}
	// Which of the two pyramids is this frame's, and what the frame before it saw.
	void writeHistory(const View& view, bool makes_pyramid);
	void writeHidden();
	void dropUnkept(const FramePlan& plan);
	Status prepareRays(const FramePlan& plan, const PlanInput& input);
	uint64_t rayInstanceBytes(const PlanInput& input) const;
	// Fewer micro-vertices from now on, so that the rate is coarsened until clusters fit into their memory.
	Status limitVertices(double overload);
	Status make(std::string_view name, const PlanInput& input);
	Status upload(std::string_view name, std::span<const std::byte> bytes);
	Status allocate(std::string_view name, uint64_t bytes);
	Status allocateEmpty(std::string_view name, uint64_t bytes);
	Status makeHeads();
	Status makeDump(const DumpLayout& layout);
	Status makeSurface(const FramePlan& plan);
	Status makeShadingData(const FramePlan& plan);
	Status makeHeightMaps(const PlanInput& input);
	Status makeTextures();
	Status makeImage(const ImageDesc& desc, uint32_t binding);
	bool makesSceneArray(std::string_view name, const PlanInput& input, Status& status);

	Device& device_;
	const BuiltScene& scene_;
	const TessellationTable& table_;
	std::unique_ptr<CommandRecorder> commands_;
	std::unique_ptr<BindlessSet> bindless_;
	std::map<std::string, Buffer> buffers_;
	std::map<std::string, ImageResource> images_;
	std::vector<ImageResource> textures_;
	std::vector<VkSampler> samplers_;
	std::vector<Buffer> height_texels_;
	RayStructures rays_;
	RayClusters clusters_;
	SharedStructures shared_;
	Buffer readback_;
	DumpLayout dump_ = kFirstDump;
	std::array<uint32_t, LIST_COUNT> capacities_ = {};
	uint32_t round_ = 0;
	View view_ = {};
	bool pyramid_is_second_ = false;  // where the last frame's depth pyramid lies
	bool has_pyramid_ = false;        // the last frame made one
	bool had_history_ = false;        // and the frame before it had too
	// Where hidden_instances is taken from before the next round: it stays, what measure_hidden wrote, or nothing is hidden.
	enum class HiddenSource : uint8_t
	{
		Kept,
		Measured,
		Nothing,
	};
	HiddenSource hidden_source_ = HiddenSource::Kept;
	std::vector<RateStep> steps_;  // as uploaded
	uint32_t fixed_lists_ = 0;     // bit per list that grows no more
	bool is_refitted_ = false;     // the next plan says what is kept of what there is

public:
	~FrameResources();
	FrameResources(const FrameResources&) = delete;
	FrameResources& operator=(const FrameResources&) = delete;
};

}  // namespace tessera
