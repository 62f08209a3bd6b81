#include "viewer/swapchain.h"

#include <algorithm>

namespace tessera::view
{

Result<std::unique_ptr<Swapchain>> Swapchain::create(Device& device, VkSurfaceKHR surface, uvec2 size_px, bool vsync)
{
	std::unique_ptr<Swapchain> swapchain(new Swapchain(device, surface));
	TRY(swapchain->chooseFormat());
	TRY(swapchain->makeRenderPass());
	TRY(swapchain->resize(size_px, vsync));
	return swapchain;
}

Swapchain::~Swapchain()
{
	destroyImages();
	vkDestroySwapchainKHR(device_.handle, swapchain_, nullptr);
	vkDestroyRenderPass(device_.handle, render_pass_, nullptr);
	vkDestroySurfaceKHR(device_.instance, surface_, nullptr);
}

// Pictures are sRGB-encoded already: a format that would encode them again is no use.
Status Swapchain::chooseFormat()
{
	uint32_t count = 0;
	VK_TRY(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical, surface_, &count, nullptr), "view: asking for the window's formats");
	std::vector<VkSurfaceFormatKHR> formats(count);
	VK_TRY(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical, surface_, &count, formats.data()), "view: asking for the window's formats");
	for (const VkFormat wanted : { VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM })
		for (const VkSurfaceFormatKHR& format : formats)
			if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR)
			{
				format_ = format;
				return {};
			}
	return fail(ExitCode::DeviceCannot, "view: {} shows no 8-bit RGBA or BGRA pictures in this window", device_.name);
}

// Keeps what was copied there, and leaves it ready to be shown.
Status Swapchain::makeRenderPass()
{
	VkAttachmentDescription color = {};
	color.format = format_.format;
	color.samples = VK_SAMPLE_COUNT_1_BIT;
	color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
	color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
	color.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
	color.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
	color.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
	color.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
	const VkAttachmentReference reference = { 0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL };
	VkSubpassDescription subpass = {};
	subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
	subpass.colorAttachmentCount = 1;
	subpass.pColorAttachments = &reference;
	VkRenderPassCreateInfo info = { VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO };
	info.attachmentCount = 1;
	info.pAttachments = &color;
	info.subpassCount = 1;
	info.pSubpasses = &subpass;
	VK_TRY(vkCreateRenderPass(device_.handle, &info, nullptr, &render_pass_), "view: making the render pass of the user interface");
	return {};
}

Status Swapchain::resize(uvec2 size_px, bool vsync)
{
	destroyImages();
	size_px_ = { 0, 0 };
	vsync_ = vsync;
	if (size_px.x == 0 || size_px.y == 0)
		return {};
	VkSurfaceCapabilitiesKHR can = {};
	VK_TRY(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical, surface_, &can), "view: asking what the window can show");
	constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
	if ((can.supportedUsageFlags & kUsage) != kUsage)
		return fail(ExitCode::DeviceCannot, "view: {} cannot copy pictures into this window", device_.name);
	uint32_t count = 0;
	VK_TRY(vkGetPhysicalDeviceSurfacePresentModesKHR(device_.physical, surface_, &count, nullptr), "view: asking how the window shows");
	std::vector<VkPresentModeKHR> modes(count);
	VK_TRY(vkGetPhysicalDeviceSurfacePresentModesKHR(device_.physical, surface_, &count, modes.data()), "view: asking how the window shows");
	const auto has = [&](VkPresentModeKHR mode) {
		return std::find(modes.begin(), modes.end(), mode) != modes.end();
	};
	can_switch_vsync_ = has(VK_PRESENT_MODE_IMMEDIATE_KHR) || has(VK_PRESENT_MODE_MAILBOX_KHR);

	VkSwapchainCreateInfoKHR info = { VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR };
	info.surface = surface_;
	info.minImageCount = std::max(can.minImageCount, can.maxImageCount > 0 ? std::min(3u, can.maxImageCount) : 3u);
	info.imageFormat = format_.format;
	info.imageColorSpace = format_.colorSpace;
	const bool window_decides = can.currentExtent.width == UINT32_MAX;
	info.imageExtent = { window_decides ? std::clamp(size_px.x, can.minImageExtent.width, can.maxImageExtent.width) : can.currentExtent.width,
						 window_decides ? std::clamp(size_px.y, can.minImageExtent.height, can.maxImageExtent.height) : can.currentExtent.height };
	info.imageArrayLayers = 1;
	info.imageUsage = kUsage;
	info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
	info.preTransform = can.currentTransform;
	info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
	info.presentMode = vsync                                ? VK_PRESENT_MODE_FIFO_KHR
					   : has(VK_PRESENT_MODE_IMMEDIATE_KHR) ? VK_PRESENT_MODE_IMMEDIATE_KHR
					   : has(VK_PRESENT_MODE_MAILBOX_KHR)   ? VK_PRESENT_MODE_MAILBOX_KHR
															: VK_PRESENT_MODE_FIFO_KHR;
	info.clipped = VK_TRUE;
	info.oldSwapchain = swapchain_;
	if (info.imageExtent.width == 0 || info.imageExtent.height == 0)
		return {};
	VkSwapchainKHR made = VK_NULL_HANDLE;
	const VkResult result = vkCreateSwapchainKHR(device_.handle, &info, nullptr, &made);
	vkDestroySwapchainKHR(device_.handle, swapchain_, nullptr);
	swapchain_ = made;
	VK_TRY(result, "view: making {} x {} pictures for the window", info.imageExtent.width, info.imageExtent.height);
	size_px_ = { info.imageExtent.width, info.imageExtent.height };
	return makeImages();
}

Status Swapchain::makeImages()
{
	uint32_t count = 0;
	VK_TRY(vkGetSwapchainImagesKHR(device_.handle, swapchain_, &count, nullptr), "view: asking for the window's pictures");
	std::vector<VkImage> handles(count);
	VK_TRY(vkGetSwapchainImagesKHR(device_.handle, swapchain_, &count, handles.data()), "view: asking for the window's pictures");
	for (VkImage handle : handles)
	{
		Image& image = images_.emplace_back();
		image.image = handle;
		VkImageViewCreateInfo view = { VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO };
		view.image = handle;
		view.viewType = VK_IMAGE_VIEW_TYPE_2D;
		view.format = format_.format;
		view.subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 };
		VK_TRY(vkCreateImageView(device_.handle, &view, nullptr, &image.view), "view: making a view of the window's picture");
		VkFramebufferCreateInfo framebuffer = { VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO };
		framebuffer.renderPass = render_pass_;
		framebuffer.attachmentCount = 1;
		framebuffer.pAttachments = &image.view;
		framebuffer.width = size_px_.x;
		framebuffer.height = size_px_.y;
		framebuffer.layers = 1;
		VK_TRY(vkCreateFramebuffer(device_.handle, &framebuffer, nullptr, &image.framebuffer), "view: making the window's framebuffer");
		const VkSemaphoreCreateInfo semaphore = { VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO };
		VK_TRY(vkCreateSemaphore(device_.handle, &semaphore, nullptr, &image.drawn), "view: making a semaphore");
	}
	return {};
}

void Swapchain::destroyImages()
{
	for (const Image& image : images_)
	{
		vkDestroySemaphore(device_.handle, image.drawn, nullptr);
		vkDestroyFramebuffer(device_.handle, image.framebuffer, nullptr);
		vkDestroyImageView(device_.handle, image.view, nullptr);
	}
	images_.clear();
}

Result<std::optional<uint32_t>> Swapchain::acquire(VkSemaphore signal)
{
	if (images_.empty())
		return std::optional<uint32_t>();
	uint32_t index = 0;
	const VkResult result = vkAcquireNextImageKHR(device_.handle, swapchain_, UINT64_MAX, signal, VK_NULL_HANDLE, &index);
	if (result == VK_ERROR_OUT_OF_DATE_KHR)
		return std::optional<uint32_t>();
	if (result != VK_SUBOPTIMAL_KHR)
		VK_TRY(result, "view: asking for a picture of the window");
	return std::optional<uint32_t>(index);
}

Result<bool> Swapchain::present(uint32_t image, VkSemaphore wait)
{
	VkPresentInfoKHR info = { VK_STRUCTURE_TYPE_PRESENT_INFO_KHR };
	info.waitSemaphoreCount = 1;
	info.pWaitSemaphores = &wait;
	info.swapchainCount = 1;
	info.pSwapchains = &swapchain_;
	info.pImageIndices = &image;
	const VkResult result = vkQueuePresentKHR(device_.queue, &info);
	if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
		return true;
	VK_TRY(result, "view: showing a picture");
	return false;
}

}  // namespace tessera::view
