#include "reference/host_scene.h"

#include "base/check.h"
#include "scene/build/height_map.h"
#include "scene/camera.h"

namespace tessera::reference
{

namespace
{

template <typename T>
uint64_t addressOf(std::span<const T> values)
{
	return reinterpret_cast<uint64_t>(values.data());
}

template <typename T>
std::span<const T> orElse(const std::vector<T>& values, const std::vector<T>& stand_in)
{
	return values.empty() ? std::span<const T>(stand_in) : std::span<const T>(values);
}

template <typename Keep>
std::vector<ClusterRef> clustersThat(const HostScene& scene, const Keep& keep)
{
	std::vector<ClusterRef> refs;
	for (uint32_t i = 0; i < scene.instances().size(); ++i)
	{
		const InstanceRecord& instance = scene.instances()[i];
		const MeshRecord& mesh = scene.built().meshes[instance.mesh];
		if (!keep(instance, scene.built().mesh_bounds[instance.mesh]))
			continue;
		for (uint32_t c = mesh.first_cluster; c < mesh.first_cluster + mesh.cluster_count; ++c)
			if (keep(instance, scene.built().cluster_bounds[c]))
				refs.push_back({ i, c });
	}
	return refs;
}

}  // namespace

HostScene::HostScene(const BuiltScene& scene, const TessellationTable& table, Metric metric) : built_(scene), table_size_(table.max_edge_segments)
{
	for (const HeightMapData& map : scene.height_maps)
		height_maps_.push_back(hostRecord(map));
	for (const Instance& instance : scene.instances)
		instances_.push_back(instanceRecord(instance, scene.mesh_bounds[instance.mesh]));
	for (const TableConfig& config : table.configs)
		patterns_.push_back({ config.first_triangle, config.first_vertex, config.triangle_count | uint32_t(config.vertex_count) << 16 });
	fillStandIns();

	surface_.positions = addressOf<vec3>(scene.positions);
	surface_.directions = addressOf<vec3>(directions_);
	surface_.uvs = addressOf<vec2>(orElse(scene.uvs, no_uvs_));
	surface_.densities = addressOf<float>(orElse(scene.densities, no_densities_));
	surface_.triangles = addressOf<uint32_t>(scene.triangles);
	surface_.first_seam_edges = addressOf<uint32_t>(scene.first_seam_edges);
	surface_.seam_edges = addressOf<SeamEdge>(scene.seam_edges);
	surface_.seam_corner_indices = addressOf<uint32_t>(orElse(scene.seam_corner_indices, no_seam_corners_));
	surface_.seam_corners = addressOf<SeamCorner>(scene.seam_corners);
	surface_.material_height_maps = addressOf<uint32_t>(orElse(scene.material_height_maps, no_height_maps_));
	surface_.height_maps = addressOf<HeightMap>(height_maps_);
	surface_.pn_directions = scene.traits.has_pn ? surface_.directions : 0;
	giveTables(metric);
	table_.patterns = addressOf<PatternRange>(patterns_);
	table_.vertices = addressOf<uint32_t>(table.vertices);
	table_.triangles = addressOf<uint32_t>(table.triangles);
}

// The shared code goes by the metric whose tables it is given.
void HostScene::giveTables(Metric metric)
{
	const size_t triangles = built_.triangles.size();
	if (metric == Metric::Detail)
	{
		if (built_.uvs.empty() && !built_.traits.has_pn)
			no_details_.assign(triangles, {});
		surface_.triangle_details = addressOf<TriangleDetail>(orElse(built_.triangle_details, no_details_));
		CHECK(triangles == 0 || surface_.triangle_details != 0, "{}: built without the tables of metric detail", built_.path);
	}
	if (metric == Metric::Displaced)
	{
		if (built_.uvs.empty() && !built_.traits.has_pn)
			no_roughness_.assign(triangles, vec3(0));
		surface_.edge_roughness = addressOf<vec3>(orElse(built_.edge_roughness, no_roughness_));
		CHECK(triangles == 0 || surface_.edge_roughness != 0, "{}: built without the table of metric displaced", built_.path);
	}
}

void HostScene::setHidden(std::vector<HiddenInstance> hidden)
{
	CHECK(hidden.empty() || hidden.size() == instances_.size(), "{} hidden instances of {}", hidden.size(), instances_.size());
	hidden_ = std::move(hidden);
	surface_.hidden_instances = addressOf<HiddenInstance>(hidden_);
}

void HostScene::fillStandIns()
{
	const size_t vertices = built_.positions.size();
	// An undisplaced point adds 0 times its direction: any finite direction gives the same bits.
	directions_ = orElse(built_.directions, built_.normals);
	CHECK(directions_.size() == vertices, "{} directions for {} vertices", directions_.size(), vertices);
	if (built_.uvs.empty())
		no_uvs_.assign(vertices, vec2(0));
	if (built_.densities.empty())
		no_densities_.assign(vertices, 0.0f);
	if (built_.seam_corner_indices.empty())
		no_seam_corners_.assign(vertices, NO_INDEX);
	if (built_.material_height_maps.empty())
		no_height_maps_.assign(built_.materials.size(), NO_INDEX);
}

std::vector<ClusterRef> allClusters(const HostScene& scene)
{
	return clustersThat(scene, [](const InstanceRecord&, const DisplacedBounds&) { return true; });
}

std::vector<ClusterRef> clustersInFrustum(const HostScene& scene, const View& view)
{
	return clustersThat(scene, [&](const InstanceRecord& instance, const DisplacedBounds& bounds) {
		return boxMayBeVisible(displacedBox(bounds, view.displacement_scale, view.displacement_offset), placementOf(instance, view), view);
	});
}

}  // namespace tessera::reference
