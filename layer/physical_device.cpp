// What a physical device offers: the driver's answers with the extension added.
#include "layer/chain.h"
#include "layer/device.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace tessera::layer
{

namespace
{

std::vector<VkExtensionProperties> driverExtensions(const Instance& instance, VkPhysicalDevice physical)
{
	uint32_t count = 0;
	instance.next.EnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
	std::vector<VkExtensionProperties> all(count);
	instance.next.EnumerateDeviceExtensionProperties(physical, nullptr, &count, all.data());
	all.resize(count);
	return all;
}

bool has(const std::vector<VkExtensionProperties>& all, const char* name)
{
	return std::any_of(all.begin(), all.end(), [&](const VkExtensionProperties& one) { return std::strcmp(one.extensionName, name) == 0; });
}

VkExtensionProperties clusterExtension()
{
	VkExtensionProperties extension = {};
	std::strcpy(extension.extensionName, VK_NV_CLUSTER_ACCELERATION_STRUCTURE_EXTENSION_NAME);
	extension.specVersion = VK_NV_CLUSTER_ACCELERATION_STRUCTURE_SPEC_VERSION;
	return extension;
}

VkResult listExtensions(const std::vector<VkExtensionProperties>& all, uint32_t* count, VkExtensionProperties* properties)
{
	if (!properties)
	{
		*count = static_cast<uint32_t>(all.size());
		return VK_SUCCESS;
	}
	const auto listed = std::min(size_t(*count), all.size());
	std::copy_n(all.begin(), listed, properties);
	*count = static_cast<uint32_t>(listed);
	return listed < all.size() ? VK_INCOMPLETE : VK_SUCCESS;
}

}  // namespace

VkPhysicalDeviceClusterAccelerationStructurePropertiesNV clusterProperties()
{
	VkPhysicalDeviceClusterAccelerationStructurePropertiesNV properties = {};
	properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CLUSTER_ACCELERATION_STRUCTURE_PROPERTIES_NV;
	properties.maxVerticesPerCluster = 256;
	properties.maxTrianglesPerCluster = 256;
	properties.clusterScratchByteAlignment = 256;
	properties.clusterByteAlignment = 128;
	properties.clusterTemplateByteAlignment = 32;
	properties.clusterBottomLevelByteAlignment = 256;
	properties.clusterTemplateBoundsByteAlignment = 32;
	properties.maxClusterGeometryIndex = (1u << 24) - 1u;
	return properties;
}

bool canEmulate(const Instance& instance, VkPhysicalDevice physical)
{
	const auto all = driverExtensions(instance, physical);
	return has(all, VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME);
}

VKAPI_ATTR VkResult VKAPI_CALL enumerateDeviceExtensionProperties(VkPhysicalDevice physical, const char* layer, uint32_t* count,
																  VkExtensionProperties* properties)
{
	if (layer && std::strcmp(layer, "VK_LAYER_TESSERA_cluster_emulation") == 0)
		return listExtensions({ clusterExtension() }, count, properties);
	const Instance& instance = instanceOf(physical);
	if (layer)
		return instance.next.EnumerateDeviceExtensionProperties(physical, layer, count, properties);
	std::vector<VkExtensionProperties> all = driverExtensions(instance, physical);
	std::erase_if(all, [](const VkExtensionProperties& one) {
		return std::strcmp(one.extensionName, VK_NV_CLUSTER_ACCELERATION_STRUCTURE_EXTENSION_NAME) == 0;
	});
	if (has(all, VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME))
		all.push_back(clusterExtension());
	return listExtensions(all, count, properties);
}

VKAPI_ATTR void VKAPI_CALL getPhysicalDeviceFeatures2(VkPhysicalDevice physical, VkPhysicalDeviceFeatures2* features)
{
	const Instance& instance = instanceOf(physical);
	{
		const TakenOut ours(features, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CLUSTER_ACCELERATION_STRUCTURE_FEATURES_NV);
		instance.next.GetPhysicalDeviceFeatures2(physical, features);
	}
	if (auto* ours = findInChain<VkPhysicalDeviceClusterAccelerationStructureFeaturesNV>(
			features->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CLUSTER_ACCELERATION_STRUCTURE_FEATURES_NV))
		ours->clusterAccelerationStructure = canEmulate(instance, physical);
}

VKAPI_ATTR void VKAPI_CALL getPhysicalDeviceProperties2(VkPhysicalDevice physical, VkPhysicalDeviceProperties2* properties)
{
	{
		const TakenOut ours(properties, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CLUSTER_ACCELERATION_STRUCTURE_PROPERTIES_NV);
		instanceOf(physical).next.GetPhysicalDeviceProperties2(physical, properties);
	}
	if (auto* ours = findInChain<VkPhysicalDeviceClusterAccelerationStructurePropertiesNV>(
			properties->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CLUSTER_ACCELERATION_STRUCTURE_PROPERTIES_NV))
	{
		auto values = clusterProperties();
		values.pNext = ours->pNext;
		*ours = values;
	}
}

}  // namespace tessera::layer
