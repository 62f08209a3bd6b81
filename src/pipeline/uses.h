// Groups of uses that several passes share, and how to join them.
#pragma once
#include "frame/pass_context.h"
#include "plan/conditions.h"
#include "shared/raster_inputs.h"

#include <array>

namespace tessera
{

template <size_t... counts>
constexpr auto joinUses(const std::array<Use, counts>&... groups)
{
	std::array<Use, (counts + ...)> all = {};
	size_t next = 0;
	const auto add = [&](const auto& group) {
		for (const Use& use : group)
			all[next++] = use;
	};
	(add(groups), ...);
	return all;
}

// What a compute workgroup has at least, about: so many items of a loop keep each thread busy once.
constexpr uint32_t kThreadsOfAnyGroup = 32;

// What evaluating micro-vertices reads.
constexpr std::array<Use, 19> surfaceUses(Access access)
{
	return { {
		{ "view", access },
		{ "surface", access },
		{ "instances", access },
		{ "clusters", access },
		{ "visible_clusters", access },
		{ "positions", access },
		{ "triangles", access },
		{ "directions", access, &kOwnDirections },
		{ "normals", access, &kNormalsAsDirections },
		{ "uvs", access, &kDisplaced },
		{ "densities", access, &kDisplaced },
		{ "material_height_maps", access, &kDisplaced },
		{ "height_maps", access, &kDisplaced },
		{ "height_texels", access, &kDisplaced },
		{ "first_seam_edges", access, &kSeams },
		{ "seam_edges", access, &kSeams },
		{ "seam_corner_indices", access, &kSeams },
		{ "seam_corners", access, &kSeams },
		{ "material_flags", access },
	} };
}

// What expanding parts by the table reads.
constexpr std::array<Use, 5> partUses(Access access)
{
	return { {
		{ "part_triangles", access, &kTessellates },
		{ "part_places", access, &kTessellates },
		{ "patterns", access, &kTessellates },
		{ "table_vertices", access, &kTessellates },
		{ "table_triangles", access, &kTessellates },
	} };
}

inline TableView tableView(const PassContext& pass)
{
	return { pass.address("patterns"), pass.address("table_vertices"), pass.address("table_triangles") };
}

enum class ReadsParts : bool
{
	No,
	Yes,
};

// The addresses of what surfaceUses and, unless told otherwise, partUses name.
inline RasterInputs rasterInputs(const PassContext& pass, ReadsParts parts = ReadsParts::Yes)
{
	RasterInputs inputs = {};
	inputs.instances = pass.address("instances");
	inputs.clusters = pass.address("clusters");
	inputs.visible_clusters = pass.address("visible_clusters");
	inputs.material_flags = pass.address("material_flags");
	if (parts == ReadsParts::No)
		return inputs;
	inputs.part_triangles = pass.address("part_triangles");
	inputs.part_places = pass.address("part_places");
	inputs.table = tableView(pass);
	return inputs;
}

}  // namespace tessera
