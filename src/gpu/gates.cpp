#include "gpu/gates.h"

namespace tessera
{

std::vector<Gate> DeviceGates::table() const
{
	return {
		{ "mesh_shader", mesh_shader, "--raster indexed: micro-triangles are expanded by compute and drawn indexed" },
		{ "fragment_primitive_id", fragment_primitive_id, "--raster indexed is closed" },
		{ "buffer_atomics_64", buffer_atomics_64, "--raster soft is closed" },
		{ "image_atomics_64", image_atomics_64, "buffers are used, at the same speed" },
		{ "acceleration_structure", acceleration_structure, "--raster rt, --shadows and --ao are closed" },
		{ "ray_tracing_pipeline", ray_tracing_pipeline, "--raster rt, --shadows and --ao are closed" },
		{ "ray_query", ray_query, "nothing is missing: ray tracing pipelines do it all" },
		{ "cluster_acceleration_structure", cluster_acceleration_structure, "one acceleration structure of all micro-triangles",
		  cluster_acceleration_structure ? std::string_view() : why_no_clusters },
		{ "fragment_barycentric", fragment_barycentric, "shade computes barycentrics itself" },
		{ "conditional_rendering", conditional_rendering, "indirect arguments of zero" },
		{ "pipeline_statistics", pipeline_statistics, "what a pipeline was compiled to is not shown" },
		{ "debug_names", debug_names, "objects have no names in validation messages" },
	};
}

}  // namespace tessera
