#include "frame/color_mips.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tessera
{

namespace
{

VkSamplerAddressMode addressMode(Wrap wrap)
{
	switch (wrap)
	{
	case Wrap::ClampToEdge:
		return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
	case Wrap::MirroredRepeat:
		return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
	default:
		return VK_SAMPLER_ADDRESS_MODE_REPEAT;
	}
}

// Halves level by level, linear filter: sRGB formats are filtered in linear light.
void blitLevels(VkCommandBuffer commands, const ImageResource& image)
{
	for (uint32_t level = 1; level < image.desc().levels; ++level)
	{
		const auto extent = [&](uint32_t l) {
			return VkOffset3D{ static_cast<int32_t>(std::max(image.desc().width >> l, 1u)),
							   static_cast<int32_t>(std::max(image.desc().height >> l, 1u)), 1 };
		};
		VkImageBlit blit = {};
		blit.srcSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, level - 1, 0, 1 };
		blit.srcOffsets[1] = extent(level - 1);
		blit.dstSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1 };
		blit.dstOffsets[1] = extent(level);
		vkCmdBlitImage(commands, image.handle(), VK_IMAGE_LAYOUT_GENERAL, image.handle(), VK_IMAGE_LAYOUT_GENERAL, 1, &blit, VK_FILTER_LINEAR);
		fullBarrier(commands);
	}
}

}  // namespace

Result<ImageResource> uploadColorTexture(Device& device, CommandRecorder& commands, const ColorTexture& texture)
{
	ImageDesc desc = { texture.name, VK_FORMAT_R8G8B8A8_SRGB, texture.width, texture.height };
	desc.levels = static_cast<uint32_t>(std::bit_width(std::max(texture.width, texture.height)));
	desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
	TRY_ASSIGN(ImageResource image, ImageResource::create(device, desc));
	TRY_ASSIGN(const Buffer staging, Buffer::create(device, texture.rgba.size(), MemoryKind::Upload, texture.name + " staging"));
	std::memcpy(staging.mapped(), texture.rgba.data(), texture.rgba.size());
	staging.flushMapped();
	TRY(commands.begin());
	toGeneralLayout(commands.buffer(), image);
	VkBufferImageCopy copy = {};
	copy.imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 };
	copy.imageExtent = { texture.width, texture.height, 1 };
	vkCmdCopyBufferToImage(commands.buffer(), staging.handle(), image.handle(), VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
	fullBarrier(commands.buffer());
	blitLevels(commands.buffer(), image);
	TRY(commands.submitAndWait());
	return image;
}

Result<VkSampler> makeColorSampler(Device& device, const ColorTexture& texture)
{
	VkSamplerCreateInfo info = { VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO };
	info.magFilter = texture.nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
	info.minFilter = VK_FILTER_LINEAR;
	info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
	info.addressModeU = addressMode(texture.wrap_u);
	info.addressModeV = addressMode(texture.wrap_v);
	info.maxLod = VK_LOD_CLAMP_NONE;
	VkSampler sampler = VK_NULL_HANDLE;
	VK_TRY(vkCreateSampler(device.handle, &info, nullptr, &sampler), "creating the sampler of {}", texture.name);
	return sampler;
}

}  // namespace tessera
