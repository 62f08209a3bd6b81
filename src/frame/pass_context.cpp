#include "frame/pass_context.h"

#include "base/check.h"
#include "frame/frame_resources.h"
#include "plan/conditions.h"
#include "scene/factor_rule.h"

#include <algorithm>
#include <array>

namespace tessera
{

uint64_t PassContext::address(std::string_view resource) const
{
	const auto& uses = step_.pass->uses;
	const auto use = std::find_if(uses.begin(), uses.end(), [&](const Use& u) { return u.resource == resource; });
	CHECK(use != uses.end(), "pass {} uses '{}' without declaring it", step_.pass->name, resource);
	return use->when && !use->when->holds(input_) ? 0 : resources_.address(resource);
}

uint32_t PassContext::round() const
{
	return resources_.round();
}

FactorRule PassContext::factorRule() const
{
	return tessera::factorRule(resources_.view(), resources_.tableSize(), std::min(input_.options.max_split, resources_.tableSize()));
}

uint32_t PassContext::rateStepCount() const
{
	return resources_.rateStepCount();
}

uint32_t PassContext::tracedTriangles() const
{
	return resources_.rays().reserved();
}

uint64_t PassContext::tracedGeometry() const
{
	return resources_.rays().geometryAddress();
}

const RayClusters& PassContext::clusters() const
{
	return resources_.clusters();
}

const SharedStructures& PassContext::sharedStructures() const
{
	return resources_.sharedStructures();
}

RaySharing PassContext::raySharing() const
{
	return tessera::raySharing(resources_.view(), kTessellates.holds(input_));
}

void PassContext::build(std::string_view structure) const
{
	const auto& uses = step_.pass->uses;
	CHECK(std::any_of(uses.begin(), uses.end(), [&](const Use& use) { return use.resource == structure && use.access == Access::BuildWrite; }),
		  "pass {} builds '{}' without declaring it", step_.pass->name, structure);
	if (structure == "ray_geometry")
		resources_.rays().recordGeometry(commands_);
	else
		resources_.rays().recordScene(commands_);
}

void PassContext::tracePixels() const
{
	const RayTable& table = pipeline_.rayTable();
	const VkStridedDeviceAddressRegionKHR callable = {};
	device_.functions.trace_rays(commands_, &table.raygen, &table.miss, &table.hit, &callable, input_.options.width_px, input_.options.height_px, 1);
}

uint32_t PassContext::decidingLists() const
{
	return resources_.decidingLists(input_);
}

uint32_t PassContext::capacity(std::string_view list) const
{
	return resources_.capacity(list);
}

uint64_t PassContext::bytes(std::string_view buffer) const
{
	return resources_.buffer(buffer).bytes();
}

void PassContext::pushBytes(const void* bytes, size_t count) const
{
	vkCmdBindPipeline(commands_, pipeline_.bindPoint(), pipeline_.handle());
	vkCmdPushConstants(commands_, layout_, VK_SHADER_STAGE_ALL, 0, static_cast<uint32_t>(count), bytes);
}

void PassContext::dispatchGroups(uint32_t groups_x, uint32_t groups_y) const
{
	vkCmdDispatch(commands_, groups_x, groups_y, 1);
}

uint32_t PassContext::loopGroups(uint64_t most, uint32_t items_per_group) const
{
	const uint64_t groups = (most + items_per_group - 1) / items_per_group;
	return static_cast<uint32_t>(std::clamp<uint64_t>(groups, 1, device_.limits.loop_workgroups));
}

void PassContext::beginDraw() const
{
	VkRenderingAttachmentInfo color = { VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO };
	color.imageView = resources_.image("visibility_payload").view();
	color.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
	// Depth 0 is background, so payloads need clearing only where a round must tell its own pixels from an earlier one's.
	const bool clears_payload = step_.clears_depth && input_.view.rounds > 1;
	color.loadOp = clears_payload ? VK_ATTACHMENT_LOAD_OP_CLEAR : step_.clears_depth ? VK_ATTACHMENT_LOAD_OP_DONT_CARE : VK_ATTACHMENT_LOAD_OP_LOAD;
	color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
	color.clearValue.color.uint32[0] = NO_INDEX;
	VkRenderingAttachmentInfo depth = color;
	depth.imageView = resources_.image("visibility_depth").view();
	depth.loadOp = step_.clears_depth && resources_.round() == 0 ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
	depth.clearValue.depthStencil = { 0, 0 };

	const VkRect2D area = { { 0, 0 }, { input_.options.width_px, input_.options.height_px } };
	VkRenderingInfo rendering = { VK_STRUCTURE_TYPE_RENDERING_INFO };
	rendering.renderArea = area;
	rendering.layerCount = 1;
	rendering.colorAttachmentCount = 1;
	rendering.pColorAttachments = &color;
	rendering.pDepthAttachment = &depth;
	vkCmdBeginRendering(commands_, &rendering);
	const VkViewport viewport = { 0, 0, float(area.extent.width), float(area.extent.height), 0, 1 };
	vkCmdSetViewport(commands_, 0, 1, &viewport);
	vkCmdSetScissor(commands_, 0, 1, &area);
}

void PassContext::drawListRows(std::string_view list) const
{
	const uint64_t offset = resources_.headOffset(list);
	device_.functions.draw_mesh_tasks_indirect(commands_, resources_.buffer("heads").handle(), offset, 1, sizeof(VkDrawMeshTasksIndirectCommandEXT));
}

void PassContext::drawIndirect(std::string_view indices, std::string_view arguments) const
{
	vkCmdBindIndexBuffer(commands_, resources_.buffer(indices).handle(), 0, VK_INDEX_TYPE_UINT32);
	vkCmdDrawIndexedIndirect(commands_, resources_.buffer(arguments).handle(), 0, 1, sizeof(VkDrawIndexedIndirectCommand));
}

void PassContext::endDraw() const
{
	vkCmdEndRendering(commands_);
}

}  // namespace tessera
