#include "scene/build.h"

#include "scene/build/bounds.h"
#include "scene/build/cluster_build.h"
#include "scene/build/edge_detail.h"
#include "scene/build/pn_patch.h"
#include "scene/build/traits.h"

#include <algorithm>

namespace tessera
{

namespace
{

Status checkOptions(const BuildOptions& options)
{
	if (options.cluster_vertices < 3 || options.cluster_vertices > 128)
		return fail(ExitCode::Usage, "{} vertices per cluster: 3 to 128 are possible", options.cluster_vertices);
	if (options.cluster_triangles < 4 || options.cluster_triangles > 128 || options.cluster_triangles % 4 != 0)
		return fail(ExitCode::Usage, "{} triangles per cluster: 4 to 128 are possible, in steps of 4", options.cluster_triangles);
	return {};
}

// Corners of a cluster's vertices are numbered over the scene in 32 bits; three per triangle bound all other counts.
Status checkSize(const ImportedScene& imported, const MaterialUses& uses)
{
	uint64_t corners = 0;
	for (size_t mesh = 0; mesh < imported.meshes.size(); ++mesh)
		for (size_t i = 0; i < imported.meshes[mesh].primitives.size(); ++i)
			if (uses.materials[mesh][i] != MaterialUses::kSkipped)
				corners += imported.meshes[mesh].primitives[i].indices.size();
	if (corners >= NO_INDEX)
		return badInput("{}: {} triangles: at most {} are possible", imported.path, corners / 3, NO_INDEX / 3);
	return {};
}

// Squares of lengths, and their ratios, must stay within a 32-bit float.
constexpr double kFarthest = 0x1p60;

double largestOf(dvec3 p)
{
	return std::max({ std::abs(p.x), std::abs(p.y), std::abs(p.z) });
}

Status checkReach(const BuiltScene& scene)
{
	for (size_t i = 0; i < scene.meshes.size(); ++i)
	{
		if (scene.meshes[i].cluster_count == 0)
			continue;
		const Box box = displacedBox(scene.mesh_bounds[i], 1.0f, 0.0f);
		const double reach = std::max(largestOf(box.low), largestOf(box.high));
		if (!(reach <= kFarthest))
			return badInput("{}: mesh {} reaches {:.3g} mesh units from its origin, displaced; at most 2^60 (1.15e18) is right", scene.path, i,
							reach);
	}
	const double reach = std::max(largestOf(scene.world_low), largestOf(scene.world_high));
	if (!(reach <= kFarthest))
		return badInput("{}: an instance reaches {:.3g} world units from the origin; at most 2^60 (1.15e18) is right", scene.path, reach);
	return {};
}

VertexArrays arraysOf(const ImportedScene& imported, const MaterialUses& uses, bool pn)
{
	VertexArrays arrays;
	arrays.displacement = uses.anyHeights();
	arrays.directions = arrays.displacement || pn;
	arrays.color_uvs = uses.anyColors();
	for (size_t mesh = 0; mesh < imported.meshes.size(); ++mesh)
		for (size_t i = 0; i < imported.meshes[mesh].primitives.size(); ++i)
			if (uses.materials[mesh][i] != MaterialUses::kSkipped && !imported.meshes[mesh].primitives[i].colors.empty())
				arrays.colors = true;
	return arrays;
}

void buildMesh(const Mesh& mesh, const std::vector<uint32_t>& materials, const MaterialUses& uses, const VertexArrays& arrays,
			   const BuildOptions& options, uint32_t& next_weld_id, BuiltScene& scene)
{
	MeshParts parts;
	parts.materials = materials;
	parts.first_weld_id = next_weld_id;
	parts.corners = layOutCorners(mesh);
	parts.weld = weldMesh(parts.corners);
	parts.normals = buildNormals(mesh, parts.corners, parts.weld, arrays.directions);
	parts.vertices = buildVertices(mesh, parts.corners, parts.weld, parts.normals, materials, uses, scene, arrays.colors);
	if (arrays.displacement)
	{
		buildDensities(parts.corners, parts.weld, scene.height_maps, parts.vertices);
		parts.seams = findSeams(parts.corners, parts.weld, parts.vertices);
	}
	appendClusters(parts, options, arrays, scene);
	next_weld_id += uint32_t(parts.weld.first_corners.size());

	scene.traits.degenerate_triangles += parts.normals.degenerate_triangles;
	scene.traits.zero_directions += parts.normals.zero_directions;
	scene.traits.seam_edges += parts.seams.seam_edges;
	scene.traits.seam_corners += parts.seams.seam_corners;
	scene.traits.boundary_edges += parts.weld.boundary_edges;
	scene.traits.nonmanifold_edges += parts.weld.nonmanifold_edges;
}

}  // namespace

Result<BuiltScene> buildScene(const ImportedScene& imported, const BuildOptions& options)
{
	TRY(checkOptions(options));
	BuiltScene scene;
	scene.path = imported.path;
	scene.instances = imported.instances;
	scene.cameras = imported.cameras;
	scene.warnings = imported.warnings;
	const MaterialUses uses = buildMaterials(imported, scene);
	TRY(checkSize(imported, uses));

	const VertexArrays arrays = arraysOf(imported, uses, options.pn);
	uint32_t next_weld_id = 0;
	for (size_t i = 0; i < imported.meshes.size(); ++i)
	{
		const std::vector<uint32_t>& materials = uses.materials[i];
		const bool skipped = std::all_of(materials.begin(), materials.end(), [](uint32_t m) { return m == MaterialUses::kSkipped; });
		if (skipped)
			scene.meshes.push_back({ uint32_t(scene.clusters.size()), 0 });
		else
			buildMesh(imported.meshes[i], materials, uses, arrays, options, next_weld_id, scene);
	}
	if (scene.seam_edges.empty() && scene.seam_corners.empty())
	{
		scene.first_seam_edges = {};
		scene.seam_corner_indices = {};
	}
	scene.traits.has_pn = options.pn && anyCurved(scene);
	if (!scene.traits.has_pn && !arrays.displacement)
		scene.directions = {};
	buildBounds(scene);
	TRY(checkReach(scene));
	if (options.tables.details)
		buildEdgeDetails(scene);
	if (options.tables.roughness)
		buildEdgeRoughness(scene);
	findTraits(scene);
	return scene;
}

}  // namespace tessera
