// What a frame's rays are traced through where it is built from clusters: lists that the driver builds from, and how they are counted.
// The records that the driver reads are those of VK_NV_cluster_acceleration_structure (src/frame/ray_clusters.cpp holds them to it).
#ifndef TESSERA_RAYTRACING_CLUSTER_LISTS_H
#define TESSERA_RAYTRACING_CLUSTER_LISTS_H
#include "shared/cluster_id.h"
#include "shared/lang.h"

SHARED_BEGIN

// VkClusterAccelerationStructureInstantiateClusterInfoNV: a template, with vertices of its own.
struct InstantiationInfo
{
	uint id;                // added to the template's, which is 0
	uint geometry;          // index offset, 24 bits: 0
	uint64_t source;        // address of the template
	uint64_t vertices;      // address
	uint64_t vertex_bytes;  // from one to the next
};
SHARED_LAYOUT(InstantiationInfo, 32, vertex_bytes, 24)

// VkClusterAccelerationStructureBuildTriangleClusterInfoNV: triangles of this frame alone.
struct TransientInfo
{
	uint id;
	uint flags;         // 0
	uint counts;        // packTransientCounts
	uint geometry;      // index, 24 bits: 0; flags << 29
	uint strides;       // bytes from index to index | from vertex to vertex << 16
	uint more_strides;  // 0
	uint64_t indices;   // addresses
	uint64_t vertices;
	uint64_t geometries;  // the rest is absent: 0
	uint64_t micromaps;
	uint64_t micromap_indices;
};
SHARED_LAYOUT(TransientInfo, 64, micromap_indices, 56)

#define CLUSTER_INDEX_BITS_32 4u    // VK_CLUSTER_ACCELERATION_STRUCTURE_INDEX_FORMAT_32BIT_NV
#define CLUSTER_GEOMETRY_OPAQUE 4u  // VK_CLUSTER_ACCELERATION_STRUCTURE_GEOMETRY_OPAQUE_BIT_NV

// Triangles and vertices of 9 bits each, bits that positions lose, kind of index.
SHARED_FN uint packTransientCounts(uint triangles, uint vertices, uint truncated_bits)
{
	return triangles | (vertices << 9) | (truncated_bits << 18) | (CLUSTER_INDEX_BITS_32 << 24);
}

// VkClusterAccelerationStructureBuildClustersBottomLevelInfoNV: clusters of one instance.
struct StructureInfo
{
	uint count;
	uint stride;        // bytes from one address to the next
	uint64_t clusters;  // address of their addresses
};
SHARED_LAYOUT(StructureInfo, 16, clusters, 8)

struct DeviceAddress
{
	uint64_t bytes;
};
SHARED_LAYOUT(DeviceAddress, 8, bytes, 0)

// Of every cluster of the scene, then of every pattern of the table as it is and mirrored: what rays' clusters are made from.
struct ClusterTemplate
{
	uint64_t address;
	uint units;   // of memory that a cluster made from it takes, whatever its vertices
	uint counts;  // triangles | vertices << 16
};
SHARED_LAYOUT(ClusterTemplate, 16, counts, 12)

// Where a cluster belongs: an instance, and its place among the instance's clusters.
struct ClusterPlace
{
	uint instance;
	uint place;
};
SHARED_LAYOUT(ClusterPlace, 8, place, 4)

// Per instance: how many clusters it has in this frame, where their addresses begin, and which of the frame's structures it gets.
struct InstanceClusters
{
	uint count;
	uint first;
	uint structure;  // NO_STRUCTURE: none
	uint unused;
};
SHARED_LAYOUT(InstanceClusters, 16, unused, 12)
#define NO_STRUCTURE 0xffffffffu

// What is counted, each reserved as much as the last frames wanted. More than that: nothing is built, and the frame is drawn again.
#define RESERVED_INSTANTIATIONS 0u
#define RESERVED_INSTANTIATED_TRIANGLES 1u
#define RESERVED_INSTANTIATED_VERTICES 2u
#define RESERVED_TRANSIENTS 3u
#define RESERVED_TRANSIENT_TRIANGLES 4u
#define RESERVED_TRANSIENT_VERTICES 5u
#define RESERVED_DATA 6u     // units of memory for clusters
#define RESERVED_LARGEST 7u  // clusters of one instance
#define RESERVED_KINDS 8u
// Counted beside, of each CLUSTER_OF_*.
#define COUNTED_OF_KIND 8u
#define COUNTED_KINDS 12u

struct ClusterCounts
{
	uint wanted[COUNTED_KINDS];
	uint built_instantiations;  // 0 when something does not fit
	uint built_transients;
	uint structures;
	uint references;       // clusters of all structures
	uint structure_units;  // memory that structures took, 16 bytes each
	uint unused[3];
};
SHARED_LAYOUT(ClusterCounts, 80, unused, 68)

// What one cluster of transients holds at most: UNITS_PER_CLUSTER triangles of one visible cluster, or GROUP_PARTS parts of up to four.
#define UNITS_PER_CLUSTER 64u
#define GROUP_PARTS 32u
#define TRANSIENT_MOST_TRIANGLES 128u
#define TRANSIENT_MOST_VERTICES 192u

// Everything by address.
struct ClusterWork
{
	GPU_PTR(ClusterCounts) counts;
	GPU_PTR(InstanceClusters) instances;
	GPU_PTR(ClusterTemplate) templates;
	GPU_PTR(uint) transient_units;  // units of memory of a transient cluster, by its triangles
	GPU_PTR(InstantiationInfo) instantiations;
	GPU_PTR(DeviceAddress) instantiation_destinations;
	GPU_PTR(ClusterPlace) instantiation_places;
	GPU_PTR(TransientInfo) transients;
	GPU_PTR(DeviceAddress) transient_destinations;
	GPU_PTR(ClusterPlace) transient_places;
	GPU_PTR(vec4) vertices;  // of transients
	GPU_PTR(uint) indices;   // three per triangle of transients, within the cluster
	GPU_PTR(uint) payloads;  // per triangle of transients
	GPU_PTR(DeviceAddress) references;
	GPU_PTR(StructureInfo) structures;
	GPU_PTR(DeviceAddress) structure_addresses;  // written by the driver
	GPU_PTR(uint) structure_bytes;
	uint64_t data;  // address of the memory for clusters
	uint reserved[RESERVED_KINDS];
	uint unit_bytes;
	uint scene_clusters;  // templates before those of patterns
	uint scene_instances;
	uint truncated_bits;
	uint geometry;  // of transients: flags << 29
	uint unused;
};
SHARED_LAYOUT(ClusterWork, 200, unused, 196)

// Of the passes that need no more.
struct ClusterWorkArgs
{
	GPU_PTR(ClusterWork) work;
};
SHARED_LAYOUT(ClusterWorkArgs, 8, work, 0)

SHARED_END

#endif
