// What planFrame and the sizes of lists are asked with.
#pragma once
#include "plan/pass.h"

namespace tessera::test
{

// A scene that needs everything, drawn by mesh shaders.
inline PlanInput fullInput()
{
	PlanInput input;
	input.device.mesh_shader = input.device.fragment_primitive_id = true;
	input.options.raster = Raster::Mesh;
	SceneTraits& traits = input.scene;
	traits.has_displacement = traits.has_color_textures = traits.has_vertex_colors = true;
	traits.has_single_sided = traits.has_double_sided = traits.has_mirrored_instances = true;
	traits.seam_edges = 10;
	traits.seam_corners = 5;
	input.sizes = { 1000, 2000, 40, 2, 3, 2, 60, 4096, 4096, 10, 5, 1 };
	input.view.factors_above_one = true;
	input.view.split_levels = 3;
	return input;
}

}  // namespace tessera::test
