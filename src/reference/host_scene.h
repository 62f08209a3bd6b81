// A built scene and a table as the shared headers see them on the host: every address is one of host memory.
#pragma once
#include "scene/metric.h"
#include "scene/scene.h"
#include "shared/edge_detail.h"
#include "shared/pattern.h"
#include "shared/surface.h"
#include "tables/table.h"

#include <span>
#include <vector>

namespace tessera::reference
{

// Holds what a BuiltScene does not: records with addresses, and stand-ins for arrays that the scene does not need. They make the
// shared code, which on the host has every path, give the very bits that a shader without the path gives.
class HostScene
{
public:
	// Both must outlive this object and stay unchanged.
	// The scene must have been built with the metric's tables.
	HostScene(const BuiltScene& scene, const TessellationTable& table, Metric metric = Metric::Edge);
	// The two are kept by reference.
	HostScene(BuiltScene&&, const TessellationTable&, Metric = Metric::Edge) = delete;
	HostScene(const HostScene&) = delete;
	HostScene& operator=(const HostScene&) = delete;

	const BuiltScene& built() const { return built_; }
	const Surface& surface() const { return surface_; }
	const TableView& table() const { return table_; }
	uint32_t tableSize() const { return table_size_; }
	std::span<const InstanceRecord> instances() const { return instances_; }
	std::span<const vec3> directions() const { return directions_; }  // per vertex, also where the scene keeps none

	// What of a frame's instances is taken for hidden, as the device has it (hidden_instances); empty: nothing. Errors of size are our bug.
	void setHidden(std::vector<HiddenInstance> hidden);

	const ClusterRecord& cluster(ClusterRef ref) const { return built_.clusters[ref.cluster]; }
	Placement placement(ClusterRef ref, const View& view) const { return placementForEdges(instances_[ref.instance], ref.instance, surface_, view); }
	BaseTriangle base(ClusterRef ref, uint32_t triangle) const { return baseTriangle(surface_, cluster(ref), triangle); }

	// a, b, c: 1..tableSize(), in pattern order.
	const PatternRange& pattern(uint32_t a, uint32_t b, uint32_t c) const { return patterns_[patternIndex(a, b, c)]; }
	const PatternRange& pattern(const DomainPiece& piece) const { return pattern(piece.a, piece.b, piece.c); }

private:
	void fillStandIns();
	void giveTables(Metric metric);

	const BuiltScene& built_;
	uint32_t table_size_;
	std::span<const vec3> directions_;
	std::vector<vec2> no_uvs_;
	std::vector<float> no_densities_;
	std::vector<uint32_t> no_seam_corners_, no_height_maps_;
	std::vector<TriangleDetail> no_details_;
	std::vector<vec3> no_roughness_;
	std::vector<HeightMap> height_maps_;
	std::vector<InstanceRecord> instances_;
	std::vector<HiddenInstance> hidden_;
	std::vector<PatternRange> patterns_;
	Surface surface_ = {};
	TableView table_ = {};
};

// Every cluster of every instance, by instance, then cluster: what a frame without culling takes.
std::vector<ClusterRef> allClusters(const HostScene& scene);

// The same without the instances and clusters whose displaced bounds lie outside the view's frustum. Host and device may round
// this test differently: neither loses a cluster that can touch a pixel, but their lists need not be equal.
std::vector<ClusterRef> clustersInFrustum(const HostScene& scene, const View& view);

}  // namespace tessera::reference
