// The rules for the input of a cluster command by itself: structure types, limits of the device, modes.
#include "layer/device.h"
#include "layer/sizes.h"

namespace tessera::layer
{

namespace
{

void checkType(Report& report, const char* where, const char* what, VkStructureType is, VkStructureType right, const void* chain)
{
	if (is != right)
		report.violation("struct-type", "{}: {} has sType {}, right is {}", where, what, int(is), int(right));
	if (chain)
		report.violation("struct-chain", "{}: {} has a pNext, right is null", where, what);
}

void checkTriangles(Device& device, const ClusterInput& input, const char* where)
{
	Report& report = device.report;
	const auto& limits = input.triangles;
	const auto properties = clusterProperties();
	checkType(report, where, "pTriangleClusters", limits.sType, VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_TRIANGLE_CLUSTER_INPUT_NV,
			  limits.pNext);
	const auto atMost = [&](const char* name, const char* field, uint32_t value, uint32_t most) {
		if (value > most)
			report.violation(name, "{}: {} is {}, the device takes at most {}", where, field, value, most);
	};
	atMost("max-triangles-per-cluster", "maxClusterTriangleCount", limits.maxClusterTriangleCount, properties.maxTrianglesPerCluster);
	atMost("max-vertices-per-cluster", "maxClusterVertexCount", limits.maxClusterVertexCount, properties.maxVerticesPerCluster);
	atMost("max-geometry-index", "maxGeometryIndexValue", limits.maxGeometryIndexValue, properties.maxClusterGeometryIndex);
	atMost("min-truncate-bits", "minPositionTruncateBitCount", limits.minPositionTruncateBitCount, 32);
	VkFormatProperties format = {};
	device.instance->next.GetPhysicalDeviceFormatProperties(device.physical, limits.vertexFormat, &format);
	if (!(format.bufferFeatures & VK_FORMAT_FEATURE_ACCELERATION_STRUCTURE_VERTEX_BUFFER_BIT_KHR))
		report.violation("vertex-format", "{}: vertexFormat {} cannot be a vertex of an acceleration structure on this device", where,
						 int(limits.vertexFormat));
	else if (!vertexLayout(limits.vertexFormat))
		report.limit("limit-vertex-format", "{}: vertexFormat {} is not read by this layer", where, int(limits.vertexFormat));
}

void checkMode(Report& report, const ClusterInput& input, const char* where)
{
	if (input.type() < VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_MOVE_OBJECTS_NV ||
		input.type() > VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_INSTANTIATE_TRIANGLE_CLUSTER_NV)
		report.violation("op-type", "{}: opType {} is none that this layer knows (0 to 4)", where, int(input.type()));
	if (input.mode() < VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_IMPLICIT_DESTINATIONS_NV ||
		input.mode() > VK_CLUSTER_ACCELERATION_STRUCTURE_OP_MODE_COMPUTE_SIZES_NV)
		report.violation("op-mode", "{}: opMode {} is none (0 to 2)", where, int(input.mode()));
	constexpr VkFlags kKnown = 0x3fff;  // all bits of VkBuildAccelerationStructureFlagBitsKHR
	if (input.info.flags & ~kKnown)
		report.violation("build-flags", "{}: flags {:#x} have bits that are none of VkBuildAccelerationStructureFlagBitsKHR", where,
						 input.info.flags);
	constexpr VkFlags kEither = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR | VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR;
	if ((input.info.flags & kEither) == kEither)
		report.violation("build-flags", "{}: flags prefer both a fast trace and a fast build, right is one of them", where);
}

}  // namespace

void checkInput(Device& device, const ClusterInput& input, const char* where)
{
	Report& report = device.report;
	if (!device.feature_on)
		report.violation("feature-off", "{}: the feature clusterAccelerationStructure is not enabled at the device's creation", where);
	checkType(report, where, "the input", input.info.sType, VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_INPUT_INFO_NV, input.info.pNext);
	checkMode(report, input, where);
	switch (input.type())
	{
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_MOVE_OBJECTS_NV:
		checkType(report, where, "pMoveObjects", input.move.sType, VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_MOVE_OBJECTS_INPUT_NV,
				  input.move.pNext);
		if (input.move.type < VK_CLUSTER_ACCELERATION_STRUCTURE_TYPE_CLUSTERS_BOTTOM_LEVEL_NV ||
			input.move.type > VK_CLUSTER_ACCELERATION_STRUCTURE_TYPE_TRIANGLE_CLUSTER_TEMPLATE_NV)
			report.violation("move-type", "{}: type {} of the objects to move is none (0 to 2)", where, int(input.move.type));
		break;
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_CLUSTERS_BOTTOM_LEVEL_NV:
		checkType(report, where, "pClustersBottomLevel", input.bottom_level.sType,
				  VK_STRUCTURE_TYPE_CLUSTER_ACCELERATION_STRUCTURE_CLUSTERS_BOTTOM_LEVEL_INPUT_NV, input.bottom_level.pNext);
		break;
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_NV:
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_BUILD_TRIANGLE_CLUSTER_TEMPLATE_NV:
	case VK_CLUSTER_ACCELERATION_STRUCTURE_OP_TYPE_INSTANTIATE_TRIANGLE_CLUSTER_NV:
		checkTriangles(device, input, where);
		break;
	default:
		break;  // named already
	}
}

}  // namespace tessera::layer
