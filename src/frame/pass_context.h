// What a pass records with: addresses of the resources it declared, its arguments, dispatches and draws.
#pragma once
#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "plan/plan.h"
#include "shared/edge_factor.h"
#include "shared/ray_sharing.h"

#include <type_traits>

namespace tessera
{

class FrameResources;
class RayClusters;
class SharedStructures;

class PassContext
{
public:
	PassContext(const Device& device, VkCommandBuffer commands, const FrameResources& resources, const Pipeline& pipeline, VkPipelineLayout layout,
				const PlanStep& step, const PlanInput& input)
		: device_(device), commands_(commands), resources_(resources), pipeline_(pipeline), layout_(layout), step_(step), input_(input)
	{}

	// Device address of a resource this pass declared; 0 when it is not kept. Asking for an undeclared one is our bug.
	uint64_t address(std::string_view resource) const;
	uint64_t addressOr0(std::string_view resource, bool wanted) const { return wanted ? address(resource) : 0; }

	const PlanInput& input() const { return input_; }
	uint32_t repeat() const { return step_.repeat; }
	uint32_t round() const;
	FactorRule factorRule() const;
	uint32_t rateStepCount() const;
	uint32_t tracedTriangles() const;  // that the frame's structure is built of, inactive ones included
	uint64_t tracedGeometry() const;   // device address of that structure
	const RayClusters& clusters() const;
	const SharedStructures& sharedStructures() const;
	RaySharing raySharing() const;  // which instances may share
	VkCommandBuffer commands() const { return commands_; }
	uint32_t decidingLists() const;  // bit per list whose capacity limits the rate

	// Arguments go into the push constants of every stage.
	template <typename Args>
	void dispatch(const Args& args, uint32_t groups_x, uint32_t groups_y = 1) const
	{
		push(args);
		dispatchGroups(groups_x, groups_y);
	}
	// Workgroups that loop over up to `most` items, one (or `items_per_group`) at a time.
	template <typename Args>
	void dispatchLoop(const Args& args, uint64_t most, uint32_t items_per_group = 1) const
	{
		dispatch(args, loopGroups(most, items_per_group));
	}
	uint32_t capacity(std::string_view list) const;
	uint64_t bytes(std::string_view buffer) const;

	// Builds the structure of this name, declared as BuildWrite with the scratch memory.
	void build(std::string_view structure) const;
	// One ray generation thread per pixel.
	template <typename Args>
	void traceRays(const Args& args) const
	{
		push(args);
		tracePixels();
	}

	// Draws into the visibility attachments. Rows of mesh workgroups come from the head of `list`.
	template <typename Args>
	void drawMeshTasks(const Args& args, std::string_view list) const
	{
		beginDraw();
		push(args);
		drawListRows(list);
		endDraw();
	}
	template <typename Args>
	void drawIndexed(const Args& args, std::string_view indices, std::string_view arguments) const
	{
		beginDraw();
		push(args);
		drawIndirect(indices, arguments);
		endDraw();
	}

private:
	template <typename Args>
	void push(const Args& args) const
	{
		static_assert(sizeof(Args) <= kPushConstantBytes && std::is_trivially_copyable_v<Args>);
		pushBytes(&args, sizeof(Args));
	}
	void pushBytes(const void* bytes, size_t count) const;
	void dispatchGroups(uint32_t groups_x, uint32_t groups_y) const;
	uint32_t loopGroups(uint64_t most, uint32_t items_per_group) const;
	void tracePixels() const;
	void beginDraw() const;
	void drawListRows(std::string_view list) const;
	void drawIndirect(std::string_view indices, std::string_view arguments) const;
	void endDraw() const;

	const Device& device_;
	VkCommandBuffer commands_;
	const FrameResources& resources_;
	const Pipeline& pipeline_;
	VkPipelineLayout layout_;
	const PlanStep& step_;
	const PlanInput& input_;
};

}  // namespace tessera
