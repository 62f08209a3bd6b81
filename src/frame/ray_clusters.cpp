#include "frame/ray_clusters.h"

#include "frame/ray_structures.h"
#include "plan/conditions.h"

#include <algorithm>
#include <cstring>
#include <memory>

namespace tessera
{

#ifdef VK_NV_cluster_acceleration_structure
// The records that shaders write are the driver's.
static_assert(sizeof(InstantiationInfo) == sizeof(VkClusterAccelerationStructureInstantiateClusterInfoNV));
static_assert(offsetof(InstantiationInfo, source) == offsetof(VkClusterAccelerationStructureInstantiateClusterInfoNV, clusterTemplateAddress));
static_assert(offsetof(InstantiationInfo, vertices) == offsetof(VkClusterAccelerationStructureInstantiateClusterInfoNV, vertexBuffer));
static_assert(sizeof(TransientInfo) == sizeof(VkClusterAccelerationStructureBuildTriangleClusterInfoNV));
static_assert(offsetof(TransientInfo, geometry) ==
			  offsetof(VkClusterAccelerationStructureBuildTriangleClusterInfoNV, baseGeometryIndexAndGeometryFlags));
static_assert(offsetof(TransientInfo, strides) == offsetof(VkClusterAccelerationStructureBuildTriangleClusterInfoNV, indexBufferStride));
static_assert(offsetof(TransientInfo, indices) == offsetof(VkClusterAccelerationStructureBuildTriangleClusterInfoNV, indexBuffer));
static_assert(offsetof(TransientInfo, micromap_indices) ==
			  offsetof(VkClusterAccelerationStructureBuildTriangleClusterInfoNV, opacityMicromapIndexBuffer));
static_assert(sizeof(StructureInfo) == sizeof(VkClusterAccelerationStructureBuildClustersBottomLevelInfoNV));
static_assert(offsetof(StructureInfo, clusters) == offsetof(VkClusterAccelerationStructureBuildClustersBottomLevelInfoNV, clusterReferences));
static_assert(CLUSTER_INDEX_BITS_32 == VK_CLUSTER_ACCELERATION_STRUCTURE_INDEX_FORMAT_32BIT_NV);
static_assert(CLUSTER_GEOMETRY_OPAQUE == VK_CLUSTER_ACCELERATION_STRUCTURE_GEOMETRY_OPAQUE_BIT_NV);
#endif

namespace
{

constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR;
constexpr uint32_t kMostPayloads = 1u << 29;  // an id has 30 bits for where they begin, and none is all ones

VkBuildAccelerationStructureFlagsKHR flagsOf(BuildPreference preference)
{
	switch (preference)
	{
	case BuildPreference::Default:
		break;
	case BuildPreference::FastBuild:
		return VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR;
	case BuildPreference::FastTrace:
		return VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
	}
	return 0;
}

// Makes the buffer hold so much, when it holds less or more than twice as much.
Status fit(Device& device, Buffer& buffer, uint64_t bytes, const char* name)
{
	if (buffer && buffer.bytes() >= bytes && buffer.bytes() <= 2 * std::max<uint64_t>(bytes, 4096))
		return {};
	buffer = {};
	TRY_ASSIGN(buffer, Buffer::create(device, bytes, MemoryKind::Device, name, kStorage));
	return {};
}

}  // namespace

Status RayClusters::prepare(const BuiltScene& scene, const TessellationTable& table, const PlanInput& input, uint64_t positions,
							CommandRecorder& commands)
{
	const TemplateOptions options = { positions, !kMixedSides.holds(input), input.options.truncated_bits };
	TRY(makeTemplates(scene, table, options, commands));
	reserve_.follow(firstReserve(input), mostReserve(input));
	record_.scene_clusters = static_cast<uint32_t>(scene.clusters.size());
	record_.scene_instances = static_cast<uint32_t>(scene.instances.size());
	record_.unit_bytes = device_.limits.clusters.cluster_alignment;
	record_.truncated_bits = options.truncated_bits;
	record_.geometry = options.opaque ? CLUSTER_GEOMETRY_OPAQUE << 29 : 0;
	std::copy(reserve_.reserved().begin(), reserve_.reserved().end(), record_.reserved);
	describeBuilds(input);
	if (!transient_units_ || transient_build_ != input.options.transient_build)
		TRY(makeTransientUnits(commands));
	transient_build_ = input.options.transient_build;
	TRY(makeMemory());
	if (work_ && std::memcmp(&record_, &uploaded_, sizeof(record_)) == 0)
		return {};
	uploaded_ = record_;
	TRY_ASSIGN(work_, uploadBuffer(device_, commands, std::as_bytes(std::span(&record_, 1)), "cluster_work"));
	return {};
}

void RayClusters::drop()
{
	Device& device = device_;
	std::destroy_at(this);
	std::construct_at(this, device);
}

Status RayClusters::makeTemplates(const BuiltScene& scene, const TessellationTable& table, const TemplateOptions& options, CommandRecorder& commands)
{
	if (template_options_ == options)
		return {};
	templates_ = {};
	template_options_.reset();
	transient_units_ = {};
	TRY_ASSIGN(templates_, ClusterTemplates::create(device_, commands, templateShapes(scene, table), options));
	template_options_ = options;
	record_.templates = templates_.records();
	return {};
}

// Before a frame has shown what it wants: one cluster in view of every instance, and some parts.
ReserveCounts RayClusters::firstReserve(const PlanInput& input) const
{
	const auto clusters = static_cast<uint32_t>(std::min<uint64_t>(input.sizes.instanced_clusters, kFirstTriangles / 64));
	const uint32_t parts = kClusterParts.holds(input) ? kFirstTriangles / 32 : 0;
	ReserveCounts counts = {};
	counts[RESERVED_INSTANTIATIONS] = clusters + parts;
	counts[RESERVED_INSTANTIATED_TRIANGLES] = counts[RESERVED_INSTANTIATED_VERTICES] = 32 * counts[RESERVED_INSTANTIATIONS];
	counts[RESERVED_TRANSIENTS] = kTransients.holds(input) ? parts / 8 : 0;
	counts[RESERVED_TRANSIENT_TRIANGLES] = counts[RESERVED_TRANSIENT_VERTICES] = 32 * counts[RESERVED_TRANSIENTS];
	counts[RESERVED_DATA] = 16 * (counts[RESERVED_INSTANTIATIONS] + counts[RESERVED_TRANSIENTS]);
	counts[RESERVED_LARGEST] = counts[RESERVED_INSTANTIATIONS] + counts[RESERVED_TRANSIENTS];
	return counts;
}

ReserveCounts RayClusters::mostReserve(const PlanInput& input) const
{
	ReserveCounts most;
	most.fill(UINT32_MAX);
	most[RESERVED_TRANSIENT_TRIANGLES] = kMostPayloads;
	const uint64_t bytes = std::min(uint64_t(input.options.most_cluster_mib) << 20, device_.limits.max_buffer_bytes);
	most[RESERVED_DATA] = static_cast<uint32_t>(std::clamp<uint64_t>(bytes / device_.limits.clusters.cluster_alignment, 1, UINT32_MAX));
	return most;
}

ClusterBuild RayClusters::transientOf(uint32_t triangles) const
{
	ClusterBuild build = transients_;
	build.count = 1;
	build.triangles_each = build.triangles = triangles;
	build.vertices_each = build.vertices = std::min(3 * triangles, TRANSIENT_MOST_VERTICES);
	return build;
}

// The most memory that a cluster of so many triangles can take, for every number of them.
Status RayClusters::makeTransientUnits(CommandRecorder& commands)
{
	const uint32_t unit_bytes = record_.unit_bytes;
	std::vector<uint32_t> units = { 0 };
	for (uint32_t triangles = 1; triangles <= TRANSIENT_MOST_TRIANGLES; ++triangles)
	{
		const uint64_t bytes = clusterBuildSizes(device_, transientOf(triangles)).bytes;
		units.push_back(std::max(units.back(), static_cast<uint32_t>((bytes + unit_bytes - 1) / unit_bytes)));
	}
	TRY_ASSIGN(transient_units_, uploadBuffer(device_, commands, std::as_bytes(std::span(units)), "transient_units"));
	record_.transient_units = transient_units_.address();
	return {};
}

void RayClusters::describeBuilds(const PlanInput& input)
{
	const uint32_t* reserved = record_.reserved;
	instantiations_.operation = ClusterOperation::Instantiate;
	instantiations_.count = reserved[RESERVED_INSTANTIATIONS];
	instantiations_.triangles_each = templates_.mostTriangles();
	instantiations_.vertices_each = templates_.mostVertices();
	instantiations_.triangles = reserved[RESERVED_INSTANTIATED_TRIANGLES];
	instantiations_.vertices = reserved[RESERVED_INSTANTIATED_VERTICES];
	instantiations_.truncated_bits = record_.truncated_bits;
	transients_.operation = ClusterOperation::BuildClusters;
	transients_.flags = flagsOf(input.options.transient_build);
	transients_.count = reserved[RESERVED_TRANSIENTS];
	transients_.triangles_each = TRANSIENT_MOST_TRIANGLES;
	transients_.vertices_each = TRANSIENT_MOST_VERTICES;
	transients_.triangles = reserved[RESERVED_TRANSIENT_TRIANGLES];
	transients_.vertices = reserved[RESERVED_TRANSIENT_VERTICES];
	transients_.truncated_bits = record_.truncated_bits;
	structures_.operation = ClusterOperation::BuildStructures;
	structures_.destination = ClusterDestination::Implicit;
	structures_.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR;
	structures_.count = std::max(1u, std::min(record_.scene_instances, mostClusters()));
	structures_.clusters = mostClusters();
	structures_.clusters_each = std::min(reserved[RESERVED_LARGEST], mostClusters());
}

uint32_t RayClusters::mostClusters() const
{
	return record_.reserved[RESERVED_INSTANTIATIONS] + record_.reserved[RESERVED_TRANSIENTS];
}

Status RayClusters::makeMemory()
{
	structure_bytes_ = clusterBuildSizes(device_, structures_).bytes;
	placeInputs();
	placeLists();
	const uint64_t alignment = device_.limits.clusters.structure_alignment;
	TRY(fit(device_, data_, uint64_t(record_.reserved[RESERVED_DATA]) * record_.unit_bytes + record_.unit_bytes, "ray_clusters"));
	TRY(fit(device_, inputs_, std::max(input_bytes_, structure_bytes_ + alignment), "ray_inputs"));
	TRY(fit(device_, instances_, uint64_t(record_.scene_instances) * sizeof(InstanceClusters), "instance_clusters"));
	TRY(fit(device_, counts_, sizeof(ClusterCounts), "cluster_counts"));
	if (!readback_)
	{
		TRY_ASSIGN(readback_, Buffer::create(device_, sizeof(ClusterCounts), MemoryKind::Readback, "cluster counts readback"));
	}
	TRY(fit(device_, lists_, lists_bytes_, "ray_references"));
	// Once more, now that addresses are known.
	placeInputs();
	placeLists();
	record_.data = alignedUp(data_.address(), record_.unit_bytes);
	record_.instances = instances_.address();
	record_.counts = counts_.address();
	return makeScratch();
}

// Infos, destinations and places of clusters, and what transients are built of: all done with when bottom-level structures are built.
void RayClusters::placeInputs()
{
	const uint32_t* reserved = record_.reserved;
	const uint64_t base = inputs_ ? inputs_.address() : 0;
	ArrayPlaces places;
	const auto place = [&](uint64_t& address, uint64_t count, uint64_t bytes) {
		address = base + places.add(count, bytes);
	};
	place(record_.instantiations, reserved[RESERVED_INSTANTIATIONS], sizeof(InstantiationInfo));
	place(record_.instantiation_destinations, reserved[RESERVED_INSTANTIATIONS], sizeof(DeviceAddress));
	place(record_.instantiation_places, reserved[RESERVED_INSTANTIATIONS], sizeof(ClusterPlace));
	place(record_.transients, reserved[RESERVED_TRANSIENTS], sizeof(TransientInfo));
	place(record_.transient_destinations, reserved[RESERVED_TRANSIENTS], sizeof(DeviceAddress));
	place(record_.transient_places, reserved[RESERVED_TRANSIENTS], sizeof(ClusterPlace));
	place(record_.vertices, reserved[RESERVED_TRANSIENT_VERTICES], sizeof(vec4));
	place(record_.indices, reserved[RESERVED_TRANSIENT_TRIANGLES], 3 * sizeof(uint32_t));
	input_bytes_ = places.bytes();
}

void RayClusters::placeLists()
{
	const uint64_t base = lists_ ? lists_.address() : 0;
	ArrayPlaces places;
	const auto place = [&](uint64_t& address, uint64_t count, uint64_t bytes) {
		address = base + places.add(count, bytes);
	};
	place(record_.payloads, record_.reserved[RESERVED_TRANSIENT_TRIANGLES], sizeof(uint32_t));
	place(record_.references, mostClusters(), sizeof(DeviceAddress));
	place(record_.structures, structures_.count, sizeof(StructureInfo));
	place(record_.structure_addresses, structures_.count, sizeof(DeviceAddress));
	place(record_.structure_bytes, structures_.count, sizeof(uint32_t));
	lists_bytes_ = places.bytes();
}

// One for all, which barriers part.
Status RayClusters::makeScratch()
{
	uint64_t bytes = 0;
	for (const ClusterBuild& build : { instantiations_, transients_, structures_ })
		bytes = std::max(bytes, clusterBuildSizes(device_, build).scratch_bytes);
	return fit(device_, scratch_, bytes + device_.limits.clusters.scratch_alignment, "cluster_scratch");
}

ClusterBuildAddresses RayClusters::addresses(uint64_t infos, uint64_t count, uint64_t destinations) const
{
	ClusterBuildAddresses all;
	all.infos = infos;
	all.count = counts_.address() + count;
	all.destinations = destinations;
	all.scratch = alignedUp(scratch_.address(), device_.limits.clusters.scratch_alignment);
	return all;
}

void RayClusters::recordInstantiations(VkCommandBuffer commands) const
{
	recordClusterBuild(device_, commands, instantiations_,
					   addresses(record_.instantiations, offsetof(ClusterCounts, built_instantiations), record_.instantiation_destinations));
}

void RayClusters::recordTransients(VkCommandBuffer commands) const
{
	recordClusterBuild(device_, commands, transients_,
					   addresses(record_.transients, offsetof(ClusterCounts, built_transients), record_.transient_destinations));
}

void RayClusters::recordStructures(VkCommandBuffer commands) const
{
	ClusterBuildAddresses at = addresses(record_.structures, offsetof(ClusterCounts, structures), record_.structure_addresses);
	at.sizes = record_.structure_bytes;
	at.implicit = alignedUp(inputs_.address(), device_.limits.clusters.structure_alignment);
	recordClusterBuild(device_, commands, structures_, at);
}

void RayClusters::recordCountsReadback(VkCommandBuffer commands) const
{
	const VkBufferCopy copy = { 0, 0, sizeof(ClusterCounts) };
	vkCmdCopyBuffer(commands, counts_.handle(), readback_.handle(), 1, &copy);
}

ClusterCounts RayClusters::counts() const
{
	readback_.invalidateMapped();
	ClusterCounts counts;
	std::memcpy(&counts, readback_.mapped(), sizeof(counts));
	return counts;
}

bool RayClusters::isTooSmall(bool fits)
{
	const ClusterCounts read = counts();
	ReserveCounts wanted;
	std::copy_n(read.wanted, RESERVED_KINDS, wanted.begin());
	return reserve_.isTooSmallFor(wanted, fits);
}

double RayClusters::dataOverload(const PlanInput& input) const
{
	return double(counts().wanted[RESERVED_DATA]) / double(mostReserve(input)[RESERVED_DATA]);
}

}  // namespace tessera
