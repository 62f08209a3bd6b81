// How the layer's host code reads and writes device memory: copies on command buffers of its own, submitted and waited for.
#pragma once
#include "layer/address_map.h"
#include "layer/hazards.h"
#include "layer/memory.h"

#include <cstring>
#include <functional>
#include <span>
#include <vector>

namespace tessera::layer
{

// A piece of device memory, and where its bytes stand among those of all pieces.
struct Piece
{
	Place place;
	size_t size, at;
};

// Pieces of device memory to be read together.
class Reads
{
public:
	// Returns the number under which at() has the bytes once they are read.
	size_t add(const Place& place, VkDeviceSize size);
	bool empty() const { return pieces_.empty(); }
	std::span<const std::byte> at(size_t number) const { return std::span(bytes_).subspan(pieces_[number].at, pieces_[number].size); }
	template <typename Type>
	Type as(size_t number) const
	{
		Type value;
		std::memcpy(&value, at(number).data(), sizeof(value));
		return value;
	}

private:
	friend class HostLink;
	std::vector<Piece> pieces_;
	std::vector<std::byte> bytes_;
	size_t total_ = 0;
};

// Pieces of device memory to be written together.
class Writes
{
public:
	void add(const Place& place, std::span<const std::byte> bytes);
	template <typename Type>
	void addValue(const Place& place, const Type& value)
	{
		add(place, std::as_bytes(std::span(&value, 1)));
	}

private:
	friend class HostLink;
	std::vector<Piece> pieces_;
	std::vector<std::byte> bytes_;
};

// One queue family's. Every function waits until the device is done, and sees and is seen by everything before and after it on the queue.
class HostLink
{
public:
	HostLink(Device& device, uint32_t family);
	~HostLink();
	HostLink(const HostLink&) = delete;
	HostLink& operator=(const HostLink&) = delete;

	VkResult run(VkQueue queue, const std::function<void(VkCommandBuffer)>& record);
	VkResult read(VkQueue queue, Reads& reads);
	VkResult write(VkQueue queue, const Writes& writes);
	VkResult submitAndWait(VkQueue queue, VkCommandBuffer commands);

private:
	bool reserveStaging(VkDeviceSize size);

	Device& device_;
	VkCommandPool pool_ = VK_NULL_HANDLE;
	VkCommandBuffer commands_ = VK_NULL_HANDLE;
	VkFence fence_ = VK_NULL_HANDLE;
	std::shared_ptr<OwnBuffer> staging_;
};

// What a command that the host executes runs with.
struct HostContext
{
	Device& device;
	HostLink& link;
	VkQueue queue;
	Hazards& hazards;  // of the command buffer

	VkResult read(Reads& reads) const { return link.read(queue, reads); }
	VkResult write(const Writes& writes) const { return link.write(queue, writes); }
};

}  // namespace tessera::layer
