// What is said of rays' clusters.
#include "frame/ray_clusters.h"

namespace tessera
{

uint64_t RayClusters::bytes() const
{
	uint64_t bytes = templates_.bytes();
	for (const Buffer* buffer : { &transient_units_, &data_, &inputs_, &lists_, &instances_, &counts_, &scratch_, &work_ })
		bytes += buffer->bytes();
	return bytes;
}

void RayClusters::addStats(RayStats& stats, uint32_t generated_vertices) const
{
	const ClusterCounts read = counts();
	stats.clusters.built = true;
	stats.clusters.templates = templates_.count();
	stats.clusters.full = read.wanted[COUNTED_OF_KIND + CLUSTER_OF_FULL];
	stats.clusters.parts = read.wanted[COUNTED_OF_KIND + CLUSTER_OF_PART];
	stats.clusters.units = read.wanted[COUNTED_OF_KIND + CLUSTER_OF_UNITS];
	stats.clusters.groups = read.wanted[COUNTED_OF_KIND + CLUSTER_OF_GROUP];
	stats.clusters.structures = read.structures;
	stats.clusters.generated_vertices = generated_vertices;
	stats.clusters.template_bytes = templates_.bytes();
	stats.clusters.data_bytes = data_.bytes();
	stats.clusters.data_used_bytes = uint64_t(read.wanted[RESERVED_DATA]) * record_.unit_bytes;
	stats.clusters.structure_bytes = structure_bytes_;
	stats.clusters.structure_used_bytes = uint64_t(read.structure_units) * 16;
	stats.clusters.operation_bytes = bytes() - stats.clusters.template_bytes - data_.bytes();
	static constexpr const char* kNames[RESERVED_KINDS] = { "ray_instantiations", "ray_instantiated_triangles", "ray_instantiated_vertices",
															"ray_transients",     "ray_transient_triangles",    "ray_transient_vertices",
															"ray_cluster_units",  "ray_largest_structure" };
	const uint64_t element_bytes[RESERVED_KINDS] = { sizeof(InstantiationInfo) + sizeof(DeviceAddress) + sizeof(ClusterPlace),
													 0,
													 0,
													 sizeof(TransientInfo) + sizeof(DeviceAddress) + sizeof(ClusterPlace),
													 4 * sizeof(uint32_t),
													 sizeof(vec4),
													 record_.unit_bytes,
													 0 };
	for (uint32_t kind = 0; kind < RESERVED_KINDS; ++kind)
		stats.clusters.lists.push_back({ kNames[kind], read.wanted[kind], record_.reserved[kind], reserve_.peak()[kind], reserve_.peakUsed()[kind],
										 element_bytes[kind] * record_.reserved[kind] });
}

}  // namespace tessera
