// Acceleration structures: what rays are traced through, how large they are, and how building them is recorded.
#pragma once
#include "gpu/resources.h"

namespace tessera
{

// Triangles of one bottom-level structure, or instances of a top-level one, as a build reads them. A build on the device takes counts from the
// host: entries that a frame does not need get no area, or no structure.
struct TriangleInput
{
	uint64_t vertices = 0;  // address of float x, y, z
	uint32_t vertex_stride_bytes = 0, most_vertex = 0;
	uint64_t indices = 0;  // address of three 32-bit indices per triangle
	uint32_t triangle_count = 0;
	bool opaque = true;  // false: any-hit shaders look at every hit
};
struct InstanceInput
{
	uint64_t instances = 0;  // address of VkAccelerationStructureInstanceKHR
	uint32_t instance_count = 0;
};

enum class BuildMode
{
	Build,
	Update,  // of the same triangles, with vertices elsewhere
};

struct BuildFlags
{
	bool fast_trace = false;  // else fast build
	bool can_update = false;
	bool can_compact = false;
};

// What one build is made of.
class StructureBuild
{
public:
	StructureBuild(const TriangleInput& input, const BuildFlags& flags);
	StructureBuild(const InstanceInput& input, const BuildFlags& flags);

	struct Sizes
	{
		uint64_t structure_bytes = 0, build_scratch_bytes = 0, update_scratch_bytes = 0;
	};
	// What the device asks for, for `count` entries or, by default, those of the input.
	Sizes sizes(const Device& device) const { return sizes(device, count_); }
	Sizes sizes(const Device& device, uint32_t count) const;

	VkAccelerationStructureTypeKHR type() const { return type_; }
	uint32_t count() const { return count_; }

	// Records it. `scratch`: address, aligned as the device wants it (scratchAddress).
	void record(const Device& device, VkCommandBuffer commands, VkAccelerationStructureKHR structure, uint64_t scratch, BuildMode mode) const;

private:
	VkAccelerationStructureBuildGeometryInfoKHR info(const VkAccelerationStructureGeometryKHR& geometry) const;

	VkAccelerationStructureTypeKHR type_;
	VkAccelerationStructureGeometryKHR geometry_ = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR };
	VkBuildAccelerationStructureFlagsKHR flags_ = 0;
	uint32_t count_ = 0;
};

// Records a copy into a structure of the compacted size. Accesses before and after it are ordered by the caller.
void recordCompaction(const Device& device, VkCommandBuffer commands, VkAccelerationStructureKHR from, VkAccelerationStructureKHR to);

// Bytes of a buffer for scratch memory of this size, and the address within it that a build may use.
uint64_t scratchBytes(const Device& device, uint64_t bytes);
uint64_t scratchAddress(const Device& device, const Buffer& scratch);

// A structure in a buffer of its own.
class AccelerationStructure
{
public:
	// Errors: BadInput (out of memory).
	static Result<AccelerationStructure> create(Device& device, VkAccelerationStructureTypeKHR type, uint64_t bytes, const std::string& name);
	AccelerationStructure() = default;
	AccelerationStructure(AccelerationStructure&& other) noexcept { swap(other); }
	AccelerationStructure& operator=(AccelerationStructure&& other) noexcept
	{
		swap(other);
		return *this;
	}
	~AccelerationStructure();

	explicit operator bool() const { return handle_; }
	VkAccelerationStructureKHR handle() const { return handle_; }
	uint64_t address() const { return address_; }
	uint64_t bytes() const { return buffer_.bytes(); }

private:
	void swap(AccelerationStructure& other) noexcept;
	Device* device_ = nullptr;
	Buffer buffer_;
	VkAccelerationStructureKHR handle_ = VK_NULL_HANDLE;
	uint64_t address_ = 0;
};

}  // namespace tessera
