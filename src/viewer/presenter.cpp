#include "viewer/presenter.h"

#include "base/check.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

#include <algorithm>

namespace tessera::view
{

namespace
{

constexpr VkClearColorValue kAround = { { 0.09f, 0.10f, 0.11f, 1.0f } };

void toLayout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to)
{
	VkImageMemoryBarrier2 barrier = { VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2 };
	barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
	barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
	barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
	barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
	barrier.oldLayout = from;
	barrier.newLayout = to;
	barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
	barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
	barrier.image = image;
	barrier.subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 };
	VkDependencyInfo info = { VK_STRUCTURE_TYPE_DEPENDENCY_INFO };
	info.imageMemoryBarrierCount = 1;
	info.pImageMemoryBarriers = &barrier;
	vkCmdPipelineBarrier2(commands, &info);
}

void onInterfaceResult(VkResult result)
{
	CHECK(result >= 0, "user interface: {}", vulkanResultName(result));
}

}  // namespace

Result<std::unique_ptr<Presenter>> Presenter::create(Device& device, Window& window, bool vsync)
{
	std::unique_ptr<Presenter> presenter(new Presenter(device, window));
	presenter->vsync_ = vsync;
	TRY_ASSIGN(const VkSurfaceKHR surface, window.makeSurface(device.instance));
	VkBool32 can_show = VK_FALSE;
	vkGetPhysicalDeviceSurfaceSupportKHR(device.physical, device.queue_family, surface, &can_show);
	TRY_ASSIGN(presenter->swapchain_, Swapchain::create(device, surface, window.sizePx(), vsync));
	if (!can_show)
		return fail(ExitCode::DeviceCannot, "view: {} cannot show pictures in this window", device.name);
	TRY_ASSIGN(presenter->once_, CommandRecorder::create(device));
	TRY(presenter->makeSlots());
	TRY(presenter->startInterface());
	return presenter;
}

Presenter::~Presenter()
{
	vkDeviceWaitIdle(device_.handle);
	if (has_interface_)
	{
		ImGui_ImplVulkan_Shutdown();
		ImGui_ImplGlfw_Shutdown();
	}
	for (const Slot& slot : slots_)
	{
		vkDestroySemaphore(device_.handle, slot.acquired, nullptr);
		vkDestroyFence(device_.handle, slot.finished, nullptr);
		vkDestroyCommandPool(device_.handle, slot.pool, nullptr);
	}
	vkDestroyDescriptorPool(device_.handle, interface_pool_, nullptr);
}

Status Presenter::makeSlots()
{
	for (Slot& slot : slots_)
	{
		VkCommandPoolCreateInfo pool = { VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO };
		pool.queueFamilyIndex = device_.queue_family;
		VK_TRY(vkCreateCommandPool(device_.handle, &pool, nullptr, &slot.pool), "view: making a command pool");
		VkCommandBufferAllocateInfo allocate = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO };
		allocate.commandPool = slot.pool;
		allocate.commandBufferCount = 1;
		VK_TRY(vkAllocateCommandBuffers(device_.handle, &allocate, &slot.commands), "view: making a command buffer");
		VkFenceCreateInfo fence = { VK_STRUCTURE_TYPE_FENCE_CREATE_INFO };
		fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
		VK_TRY(vkCreateFence(device_.handle, &fence, nullptr, &slot.finished), "view: making a fence");
		const VkSemaphoreCreateInfo semaphore = { VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO };
		VK_TRY(vkCreateSemaphore(device_.handle, &semaphore, nullptr, &slot.acquired), "view: making a semaphore");
	}
	return {};
}

Status Presenter::startInterface()
{
	const VkDescriptorPoolSize size = { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8 };
	VkDescriptorPoolCreateInfo pool = { VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO };
	pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
	pool.maxSets = 8;
	pool.poolSizeCount = 1;
	pool.pPoolSizes = &size;
	VK_TRY(vkCreateDescriptorPool(device_.handle, &pool, nullptr, &interface_pool_), "view: making the user interface's descriptors");
	ImGui_ImplGlfw_InitForVulkan(window_.handle(), true);
	ImGui_ImplVulkan_InitInfo info = {};
	info.Instance = device_.instance;
	info.PhysicalDevice = device_.physical;
	info.Device = device_.handle;
	info.QueueFamily = device_.queue_family;
	info.Queue = device_.queue;
	info.PipelineCache = device_.pipeline_cache;
	info.DescriptorPool = interface_pool_;
	info.MinImageCount = 2;
	info.ImageCount = std::max<uint32_t>(2, std::max<uint32_t>(swapchain_->imageCount(), static_cast<uint32_t>(slots_.size())));
	info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
	info.CheckVkResultFn = onInterfaceResult;
	ImGui_ImplVulkan_Init(&info, swapchain_->renderPass());
	has_interface_ = true;
	TRY(once_->begin());
	ImGui_ImplVulkan_CreateFontsTexture(once_->buffer());
	TRY(once_->submitAndWait());
	ImGui_ImplVulkan_DestroyFontUploadObjects();
	return {};
}

Status Presenter::fitSwapchain()
{
	const uvec2 size = window_.sizePx();
	if (!is_stale_ && size == swapchain_->sizePx() && vsync_ == swapchain_->isVsync())
		return {};
	vkDeviceWaitIdle(device_.handle);
	is_stale_ = false;
	return swapchain_->resize(size, vsync_);
}

Status Presenter::takePicture(VkCommandBuffer commands, const ScenePicture& picture)
{
	if (!picture_ || picture_.desc().width != picture.size_px.x || picture_.desc().height != picture.size_px.y)
	{
		vkDeviceWaitIdle(device_.handle);
		ImageDesc desc = { "shown picture", VK_FORMAT_R8G8B8A8_UNORM, picture.size_px.x, picture.size_px.y };
		desc.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
		TRY_ASSIGN(picture_, ImageResource::create(device_, desc));
		toGeneralLayout(commands, picture_);
	}
	fullBarrier(commands);
	VkBufferImageCopy copy = {};
	copy.imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 };
	copy.imageExtent = { picture.size_px.x, picture.size_px.y, 1 };
	vkCmdCopyBufferToImage(commands, picture.buffer, picture_.handle(), VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
	fullBarrier(commands);
	return {};
}

// As many pixels as lie within both, one to one: a copy that changes no bit but the order of channels.
void Presenter::copyToWindow(VkCommandBuffer commands, VkImage target, ivec2 place_px) const
{
	const VkImageSubresourceRange all = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 };
	vkCmdClearColorImage(commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &kAround, 1, &all);
	if (!picture_)
		return;
	const ivec2 window = ivec2(swapchain_->sizePx()), picture = ivec2(picture_.desc().width, picture_.desc().height);
	const ivec2 size = glm::min(picture, window - place_px);
	if (size.x <= 0 || size.y <= 0)
		return;
	toLayout(commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
	VkImageBlit blit = {};
	blit.srcSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 };
	blit.dstSubresource = blit.srcSubresource;
	blit.srcOffsets[1] = { size.x, size.y, 1 };
	blit.dstOffsets[0] = { place_px.x, place_px.y, 0 };
	blit.dstOffsets[1] = { place_px.x + size.x, place_px.y + size.y, 1 };
	vkCmdBlitImage(commands, picture_.handle(), VK_IMAGE_LAYOUT_GENERAL, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_NEAREST);
}

void Presenter::drawInterface(VkCommandBuffer commands, uint32_t image, ImDrawData* interface) const
{
	VkRenderPassBeginInfo begin = { VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO };
	begin.renderPass = swapchain_->renderPass();
	begin.framebuffer = swapchain_->framebuffer(image);
	begin.renderArea.extent = { swapchain_->sizePx().x, swapchain_->sizePx().y };
	vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
	if (interface)
		ImGui_ImplVulkan_RenderDrawData(interface, commands);
	vkCmdEndRenderPass(commands);
}

Status Presenter::record(VkCommandBuffer commands, uint32_t image, const std::optional<ScenePicture>& picture, ivec2 place_px, ImDrawData* interface)
{
	VkCommandBufferBeginInfo begin = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
	begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
	VK_TRY(vkBeginCommandBuffer(commands, &begin), "view: beginning commands");
	if (picture)
		TRY(takePicture(commands, *picture));
	const VkImage target = swapchain_->image(image);
	toLayout(commands, target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
	copyToWindow(commands, target, place_px);
	toLayout(commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
	drawInterface(commands, image, interface);
	VK_TRY(vkEndCommandBuffer(commands), "view: recording commands");
	return {};
}

Status Presenter::wait()
{
	for (const Slot& slot : slots_)
		VK_TRY(vkWaitForFences(device_.handle, 1, &slot.finished, VK_TRUE, UINT64_MAX), "view: waiting for a frame of the window");
	return {};
}

Result<bool> Presenter::draw(const std::optional<ScenePicture>& picture, ivec2 place_px, ImDrawData* interface)
{
	TRY(fitSwapchain());
	Slot& slot = slots_[slot_];
	VK_TRY(vkWaitForFences(device_.handle, 1, &slot.finished, VK_TRUE, UINT64_MAX), "view: waiting for a frame of the window");
	TRY_ASSIGN(std::optional<uint32_t> image, swapchain_->acquire(slot.acquired));
	is_stale_ = !image;
	if (!image)
		return false;
	VK_TRY(vkResetCommandPool(device_.handle, slot.pool, 0), "view: resetting commands");
	TRY(record(slot.commands, *image, picture, place_px, interface));

	VkSemaphoreSubmitInfo acquired = { VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO };
	acquired.semaphore = slot.acquired;
	acquired.stageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
	VkSemaphoreSubmitInfo drawn = acquired;
	drawn.semaphore = swapchain_->drawn(*image);
	drawn.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
	VkCommandBufferSubmitInfo command = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO };
	command.commandBuffer = slot.commands;
	VkSubmitInfo2 submit = { VK_STRUCTURE_TYPE_SUBMIT_INFO_2 };
	submit.waitSemaphoreInfoCount = 1;
	submit.pWaitSemaphoreInfos = &acquired;
	submit.commandBufferInfoCount = 1;
	submit.pCommandBufferInfos = &command;
	submit.signalSemaphoreInfoCount = 1;
	submit.pSignalSemaphoreInfos = &drawn;
	VK_TRY(vkResetFences(device_.handle, 1, &slot.finished), "view: resetting a fence");
	VK_TRY(vkQueueSubmit2(device_.queue, 1, &submit, slot.finished), "view: submitting a frame of the window");
	slot_ = (slot_ + 1) % slots_.size();
	TRY_ASSIGN(is_stale_, swapchain_->present(*image, drawn.semaphore));
	return true;
}

}  // namespace tessera::view
