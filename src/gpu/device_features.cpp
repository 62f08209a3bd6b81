#include "gpu/device_features.h"

#include "gpu/device.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tessera
{

// What the frame's transient clusters need of a cluster (raytracing/cluster_lists.h), and those of the scene and the table.
constexpr uint32_t kLeastMostVertices = 192, kLeastMostTriangles = 128;

bool DeviceFeatures::has(const char* extension) const
{
	return std::any_of(available_.begin(), available_.end(), [&](const auto& p) { return std::strcmp(p.extensionName, extension) == 0; });
}

Status DeviceFeatures::query(VkPhysicalDevice physical, const std::string& device_name)
{
	VkPhysicalDeviceProperties properties;
	vkGetPhysicalDeviceProperties(physical, &properties);
	if (properties.apiVersion < VK_API_VERSION_1_3)
		return fail(ExitCode::DeviceCannot, "{}: offers Vulkan {}.{}, 1.3 is needed", device_name, VK_API_VERSION_MAJOR(properties.apiVersion),
					VK_API_VERSION_MINOR(properties.apiVersion));
	uint32_t count = 0;
	vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
	available_.resize(count);
	vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, available_.data());

	core_.pNext = &vulkan11_;
	vulkan11_.pNext = &vulkan12_;
	vulkan12_.pNext = &vulkan13_;
	vulkan13_.pNext = has(VK_EXT_MESH_SHADER_EXTENSION_NAME) ? &mesh_ : nullptr;
	if (has(VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME) && has(VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME))
	{
		structures_.pNext = std::exchange(vulkan13_.pNext, &structures_);
		if (has(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME))
			rays_.pNext = std::exchange(vulkan13_.pNext, &rays_);
	}
#ifdef VK_NV_cluster_acceleration_structure
	if (has(VK_NV_CLUSTER_ACCELERATION_STRUCTURE_EXTENSION_NAME))
		clusters_.pNext = std::exchange(vulkan13_.pNext, &clusters_);
#endif
	vkGetPhysicalDeviceFeatures2(physical, &core_);
	VkPhysicalDeviceFloatControlsProperties floats = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES };
	VkPhysicalDeviceProperties2 properties2 = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &floats };
	vkGetPhysicalDeviceProperties2(physical, &properties2);

	const std::pair<const char*, VkBool32> required[] = {
		{ "shaderInt64", core_.features.shaderInt64 },
		{ "scalarBlockLayout", vulkan12_.scalarBlockLayout },
		{ "bufferDeviceAddress", vulkan12_.bufferDeviceAddress },
		{ "runtimeDescriptorArray", vulkan12_.runtimeDescriptorArray },
		{ "descriptorBindingPartiallyBound", vulkan12_.descriptorBindingPartiallyBound },
		{ "shaderSampledImageArrayNonUniformIndexing", vulkan12_.shaderSampledImageArrayNonUniformIndexing },
		{ "hostQueryReset", vulkan12_.hostQueryReset },
		{ "synchronization2", vulkan13_.synchronization2 },
		{ "dynamicRendering", vulkan13_.dynamicRendering },
		{ "maintenance4", vulkan13_.maintenance4 },
		{ "shaderRoundingModeRTEFloat32", floats.shaderRoundingModeRTEFloat32 },
		{ "shaderSignedZeroInfNanPreserveFloat32", floats.shaderSignedZeroInfNanPreserveFloat32 },
	};
	std::string missing;
	for (const auto& [name, offered] : required)
		if (!offered)
			missing += fmt::format("{}{}", missing.empty() ? "" : ", ", name);
	if (!missing.empty())
		return fail(ExitCode::DeviceCannot, "{}: lacks {}", device_name, missing);
	openGates();
	gates_.why_no_clusters = whyNoClusters(physical);
	gates_.cluster_acceleration_structure = gates_.why_no_clusters.empty();
	return {};
}

#ifdef VK_NV_cluster_acceleration_structure

std::string_view DeviceFeatures::whyNoClusters(VkPhysicalDevice physical) const
{
	if (!has(VK_NV_CLUSTER_ACCELERATION_STRUCTURE_EXTENSION_NAME))
		return "the device lacks VK_NV_cluster_acceleration_structure";
	if (!clusters_.clusterAccelerationStructure)
		return "the driver knows VK_NV_cluster_acceleration_structure, but this device cannot do it";
	if (!gates_.rays())
		return "the device lacks VK_KHR_ray_tracing_pipeline";
	const ClusterLimits limits = clusterLimitsOf(physical);
	if (limits.vertices < kLeastMostVertices || limits.triangles < kLeastMostTriangles)
		return "the device's clusters are too small: 192 vertices and 128 triangles are needed";
	return {};
}

ClusterLimits clusterLimitsOf(VkPhysicalDevice physical)
{
	VkPhysicalDeviceClusterAccelerationStructurePropertiesNV clusters = {
		VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CLUSTER_ACCELERATION_STRUCTURE_PROPERTIES_NV
	};
	VkPhysicalDeviceProperties2 properties = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &clusters };
	vkGetPhysicalDeviceProperties2(physical, &properties);
	return { clusters.maxVerticesPerCluster, clusters.maxTrianglesPerCluster,       clusters.clusterScratchByteAlignment,
			 clusters.clusterByteAlignment,  clusters.clusterTemplateByteAlignment, clusters.clusterBottomLevelByteAlignment };
}

#else

std::string_view DeviceFeatures::whyNoClusters(VkPhysicalDevice) const
{
	return "tessera was built with Vulkan headers that do not know VK_NV_cluster_acceleration_structure";
}

ClusterLimits clusterLimitsOf(VkPhysicalDevice)
{
	return {};
}

#endif

void DeviceFeatures::openGates()
{
	gates_.mesh_shader = mesh_.meshShader;
	gates_.fragment_primitive_id = core_.features.geometryShader && core_.features.fullDrawIndexUint32;
	gates_.buffer_atomics_64 = vulkan12_.shaderBufferInt64Atomics;
	gates_.image_atomics_64 = has("VK_EXT_shader_image_atomic_int64");
	gates_.acceleration_structure = structures_.accelerationStructure;
	gates_.ray_tracing_pipeline = rays_.rayTracingPipeline;
	gates_.ray_query = has(VK_KHR_RAY_QUERY_EXTENSION_NAME);
	gates_.fragment_barycentric = has("VK_KHR_fragment_shader_barycentric");
	gates_.pipeline_statistics = has(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
	gates_.conditional_rendering = has(VK_EXT_CONDITIONAL_RENDERING_EXTENSION_NAME);
}

const void* DeviceFeatures::enabledChain(bool pipeline_statistics)
{
	enabled_core_.features.shaderInt64 = VK_TRUE;
	enabled_core_.features.geometryShader = gates_.fragment_primitive_id;
	enabled_core_.features.fullDrawIndexUint32 = gates_.fragment_primitive_id;
	enabled12_.scalarBlockLayout = VK_TRUE;
	enabled12_.bufferDeviceAddress = VK_TRUE;
	enabled12_.runtimeDescriptorArray = VK_TRUE;
	enabled12_.descriptorBindingPartiallyBound = VK_TRUE;
	enabled12_.shaderSampledImageArrayNonUniformIndexing = VK_TRUE;
	enabled12_.hostQueryReset = VK_TRUE;
	enabled12_.shaderBufferInt64Atomics = gates_.buffer_atomics_64;
	enabled13_.synchronization2 = VK_TRUE;
	enabled13_.dynamicRendering = VK_TRUE;
	enabled13_.maintenance4 = VK_TRUE;
	enabled_core_.pNext = &enabled12_;
	enabled12_.pNext = &enabled13_;
	if (gates_.mesh_shader)
	{
		enabled_mesh_.meshShader = VK_TRUE;
		enabled13_.pNext = &enabled_mesh_;
		extensions_.push_back(VK_EXT_MESH_SHADER_EXTENSION_NAME);
	}
	if (gates_.rays())
		enableRays();
#ifdef VK_NV_cluster_acceleration_structure
	if (gates_.cluster_acceleration_structure)
	{
		enabled_clusters_.clusterAccelerationStructure = VK_TRUE;
		enabled_clusters_.pNext = std::exchange(enabled13_.pNext, &enabled_clusters_);
		extensions_.push_back(VK_NV_CLUSTER_ACCELERATION_STRUCTURE_EXTENSION_NAME);
	}
#endif
	if (pipeline_statistics && gates_.pipeline_statistics)
	{
		enabled_statistics_.pipelineExecutableInfo = VK_TRUE;
		enabled_statistics_.pNext = enabled13_.pNext;
		enabled13_.pNext = &enabled_statistics_;
		extensions_.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
	}
	return &enabled_core_;
}

void DeviceFeatures::enableRays()
{
	enabled_structures_.accelerationStructure = VK_TRUE;
	enabled_structures_.pNext = std::exchange(enabled13_.pNext, &enabled_structures_);
	enabled_rays_.rayTracingPipeline = VK_TRUE;
	enabled_rays_.pNext = std::exchange(enabled13_.pNext, &enabled_rays_);
	for (const char* extension :
		 { VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME })
		extensions_.push_back(extension);
}

static std::string versionText(uint32_t version)
{
	return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version), VK_API_VERSION_PATCH(version));
}

void describeDevice(Device& device)
{
	VkPhysicalDeviceRayTracingPipelinePropertiesKHR rays = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR };
	VkPhysicalDeviceAccelerationStructurePropertiesKHR structures = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR,
																	  &rays };
	VkPhysicalDeviceMeshShaderPropertiesEXT mesh = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_PROPERTIES_EXT, &structures };
	VkPhysicalDeviceVulkan11Properties vulkan11 = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES, &mesh };
	VkPhysicalDeviceVulkan13Properties vulkan13 = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES, &vulkan11 };
	VkPhysicalDeviceDriverProperties driver = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES, &vulkan13 };
	VkPhysicalDeviceProperties2 properties2 = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver };
	vkGetPhysicalDeviceProperties2(device.physical, &properties2);
	const VkPhysicalDeviceProperties& properties = properties2.properties;

	device.name = properties.deviceName;
	device.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
	device.api = versionText(properties.apiVersion);
	device.is_cpu = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
	DeviceLimits& limits = device.limits;
	limits.subgroup_size = vulkan11.subgroupSize;
	limits.max_workgroup_threads = properties.limits.maxComputeWorkGroupInvocations;
	limits.max_buffer_bytes = vulkan13.maxBufferSize;
	limits.max_image_extent = std::min(properties.limits.maxImageDimension2D, properties.limits.maxFramebufferWidth);
	limits.timestamp_ns = properties.limits.timestampComputeAndGraphics ? double(properties.limits.timestampPeriod) : 0;
	limits.scratch_alignment = std::max(256u, structures.minAccelerationStructureScratchOffsetAlignment);
	limits.most_structure_triangles = structures.maxPrimitiveCount;
	limits.most_structure_instances = structures.maxInstanceCount;
	limits.shader_group_handle_bytes = rays.shaderGroupHandleSize;
	limits.shader_group_alignment = std::max(rays.shaderGroupBaseAlignment, rays.shaderGroupHandleAlignment);
	// Enough workgroups to fill any GPU; a processor needs only some per core.
	if (device.is_cpu)
		limits.most_small_rate_px = 0;
	limits.loop_workgroups = device.is_cpu ? 64 : 4096;
	if (mesh.maxMeshWorkGroupInvocations > 0)
	{
		const uint32_t preferred = std::clamp(mesh.maxPreferredMeshWorkGroupInvocations, 32u, 128u);
		limits.mesh_workgroup_threads = std::min(preferred, mesh.maxMeshWorkGroupInvocations);
		limits.max_mesh_rows = std::min(mesh.maxMeshWorkGroupCount[1], 65535u);
	}
}

}  // namespace tessera
