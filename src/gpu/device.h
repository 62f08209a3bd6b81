// A Vulkan device with one queue, its allocator and its gates.
#pragma once
#include "gpu/gates.h"
#include "gpu/vulkan.h"

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

struct VmaAllocator_T;

namespace tessera
{

struct DeviceRequest
{
	std::string name;                  // part of a device's name or its number in the system's order; empty: the fastest kind there is
	bool validate = false;             // core and synchronisation validation
	bool pipeline_statistics = false;  // print what each compute pipeline was compiled to (pipeline_statistics.h)
	// For a window: what its surface needs of the instance, and whether a queue family can show pictures in it. Without `can_present`
	// the device is not asked for a swapchain.
	std::vector<const char*> instance_extensions;
	std::function<bool(VkInstance, VkPhysicalDevice, uint32_t family)> can_present;
};

// Of cluster acceleration structures; all 0 where the device has none.
struct ClusterLimits
{
	uint32_t vertices = 0, triangles = 0;  // most of a cluster
	// Of addresses, bytes:
	uint32_t scratch_alignment = 0, cluster_alignment = 0, template_alignment = 0, structure_alignment = 0;
};

struct DeviceLimits
{
	uint32_t subgroup_size = 0;
	uint32_t max_workgroup_threads = 0;
	uint32_t mesh_workgroup_threads = 32;  // what the device prefers for mesh shaders, within its limits
	uint32_t max_mesh_rows = 65535;        // second dimension of a mesh draw
	uint32_t max_image_extent = 0;
	uint64_t max_buffer_bytes = 0;  // drivers crash beyond it
	uint32_t loop_workgroups = 0;   // workgroups of a dispatch whose threads loop over a list
	// Up to this rate triangles that one lane rasterises have a kernel of their own. At coarser ones more items have others besides, and are
	// evaluated twice. 0 on a processor, where a kernel more costs seconds to compile.
	float most_small_rate_px = 2;
	uint64_t most_footprint_bytes = 256u << 20;  // of height maps kept as footprints (frame/height_footprints.h); more: as texels
	uint32_t compute_workgroup_threads = 0;      // of every pass that takes it as a constant; 0: each pass's own
	// Of acceleration structures and ray tracing pipelines; 0 where the device has none.
	uint32_t scratch_alignment = 0;  // of a build's scratch memory
	uint64_t most_structure_triangles = 0, most_structure_instances = 0;
	ClusterLimits clusters;
	uint32_t shader_group_handle_bytes = 0;
	uint32_t shader_group_alignment = 0;  // of every region of a shader binding table
	double timestamp_ns = 0;              // per tick; 0: no timestamps
};

class PipelineStore;

class Device
{
public:
	// Errors: DeviceCannot, naming every required feature that is missing, or the devices there are.
	static Result<std::unique_ptr<Device>> create(const DeviceRequest& request);
	~Device();
	Device(const Device&) = delete;
	Device& operator=(const Device&) = delete;

	VkInstance instance = VK_NULL_HANDLE;
	VkPhysicalDevice physical = VK_NULL_HANDLE;
	VkDevice handle = VK_NULL_HANDLE;
	VkQueue queue = VK_NULL_HANDLE;
	uint32_t queue_family = 0;
	VmaAllocator_T* allocator = nullptr;
	VkPipelineCache pipeline_cache = VK_NULL_HANDLE;
	std::unique_ptr<PipelineStore> pipelines;
	ExtensionFunctions functions;
	DeviceGates gates;
	DeviceLimits limits;
	std::string name, driver, api;
	bool is_cpu = false;
	bool pipeline_statistics = false;  // asked for and offered

	// Validation messages since creation; 0 without --validate.
	uint32_t validationMessages() const { return validation_messages_; }
	std::atomic<uint32_t> validation_messages_ = 0;

	void nameObject(VkObjectType type, uint64_t object, const std::string& object_name) const;

private:
	Device();
	friend struct DeviceBuilder;
	VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

// A line per device of the system, for messages and `info`.
Result<std::vector<std::string>> listDevices();

}  // namespace tessera
