// The features that the project requires of a device and those it uses where they exist. The only place that names them.
#pragma once
#include "gpu/gates.h"
#include "gpu/vulkan.h"

#include <vector>

namespace tessera
{

class Device;
struct ClusterLimits;

class DeviceFeatures
{
public:
	// Reads what the device offers and checks the requirements. Errors: DeviceCannot, naming all that is missing.
	Status query(VkPhysicalDevice physical, const std::string& device_name);

	DeviceGates gates() const { return gates_; }

	// pNext chain for vkCreateDevice with exactly the features that are required or whose gate is open.
	const void* enabledChain(bool pipeline_statistics);
	const std::vector<const char*>& extensions() const { return extensions_; }

private:
	bool has(const char* extension) const;
	void openGates();
	void enableRays();
	// Why rays' structures cannot be built from clusters; empty when they can.
	std::string_view whyNoClusters(VkPhysicalDevice physical) const;

	std::vector<VkExtensionProperties> available_;
	std::vector<const char*> extensions_;
	DeviceGates gates_;
	VkPhysicalDeviceFeatures2 core_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2 };
	VkPhysicalDeviceVulkan11Features vulkan11_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES };
	VkPhysicalDeviceVulkan12Features vulkan12_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES };
	VkPhysicalDeviceVulkan13Features vulkan13_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES };
	VkPhysicalDeviceMeshShaderFeaturesEXT mesh_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT };
	VkPhysicalDeviceAccelerationStructureFeaturesKHR structures_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR };
	VkPhysicalDeviceRayTracingPipelineFeaturesKHR rays_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR };
#ifdef VK_NV_cluster_acceleration_structure
	VkPhysicalDeviceClusterAccelerationStructureFeaturesNV clusters_ = {
		VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CLUSTER_ACCELERATION_STRUCTURE_FEATURES_NV
	};
	VkPhysicalDeviceClusterAccelerationStructureFeaturesNV enabled_clusters_ = {
		VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CLUSTER_ACCELERATION_STRUCTURE_FEATURES_NV
	};
#endif
	VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR enabled_statistics_ = {
		VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR
	};
	VkPhysicalDeviceFeatures2 enabled_core_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2 };
	VkPhysicalDeviceVulkan12Features enabled12_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES };
	VkPhysicalDeviceVulkan13Features enabled13_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES };
	VkPhysicalDeviceMeshShaderFeaturesEXT enabled_mesh_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT };
	VkPhysicalDeviceAccelerationStructureFeaturesKHR enabled_structures_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR };
	VkPhysicalDeviceRayTracingPipelineFeaturesKHR enabled_rays_ = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR };
};

// What the device allows of clusters; all 0 where it has none.
ClusterLimits clusterLimitsOf(VkPhysicalDevice physical);

// Fills in name, driver, API version and limits of a chosen physical device.
void describeDevice(Device& device);

}  // namespace tessera
