// Tables in device memory by which a rewritten shader finds what a ray met: the instance's slot and the geometry's number give the cluster.
//
// The layer builds instances with a slot's number in place of the custom index; shaders read the program's index from the slot. A slot says where the
// rows of its bottom-level structure begin, one row per geometry; a row has the cluster's id, and where the geometry indices of its triangles stand.
// Nothing branches: a structure without clusters has row 0 for everything.
#pragma once
#include "layer/memory.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace tessera::layer
{

struct Slot
{
	uint32_t custom_index = 0;
	uint32_t first_row = 0;
	uint32_t row_step = 0;       // rows per geometry: 1, or 0 where there are no clusters
	uint32_t keep_geometry = 1;  // 1: the geometry's number is what the driver says; 0: it is the row's
};

struct Row
{
	uint32_t cluster_id = UINT32_MAX;
	uint32_t first_triangle = 0;
	uint32_t triangle_step = 0;  // geometry indices per triangle: 1, or 0 where all have the same
	uint32_t unused = 0;
};

// Numbers [first, first + count) out of a growing set.
class Ranges
{
public:
	uint32_t take(uint32_t count);
	void give(uint32_t first, uint32_t count);
	uint32_t end() const { return end_; }

private:
	std::map<uint32_t, uint32_t> free_;  // first, count; neighbours are merged
	uint32_t end_ = 0;
};

// Records of `stride` bytes, found through an address in the root buffer. Growing moves them; old copies stay for shaders that still read them.
class DeviceTable
{
public:
	DeviceTable(Device& device, size_t stride, std::byte* root) : device_(device), stride_(stride), root_(root) {}
	uint32_t take(uint32_t count);  // UINT32_MAX: out of memory
	void give(uint32_t first, uint32_t count) { ranges_.give(first, count); }
	void set(uint32_t index, const void* record);

private:
	Device& device_;
	size_t stride_;
	std::byte* root_;
	Ranges ranges_;
	std::vector<std::shared_ptr<OwnBuffer>> buffers_;  // the last is in use
};

class LookupTable
{
public:
	explicit LookupTable(Device& device);
	// Where the addresses of slots, rows and geometry indices stand; never changes, so that shaders can have it as a constant. 0: there is none.
	VkDeviceAddress root() const { return root_ ? root_->address() : 0; }

private:
	std::shared_ptr<OwnBuffer> root_;
	std::array<std::byte, 64> nowhere_ = {};

public:
	DeviceTable slots, rows, geometry_indices;
};

}  // namespace tessera::layer
