// Everything optional that a device may offer, asked for by feature and never by vendor (DESIGN.md, contract C6).
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace tessera
{

struct Gate
{
	std::string_view name;  // key in the stats
	bool open = false;
	std::string_view instead;   // what is done while it is closed
	std::string_view why = {};  // it is closed, where that is not plain from its name
};

// What a device offers beyond the requirements.
struct DeviceGates
{
	bool mesh_shader = false;
	bool fragment_primitive_id = false;  // geometryShader: gl_PrimitiveID in fragment shaders
	bool buffer_atomics_64 = false;
	bool image_atomics_64 = false;
	bool acceleration_structure = false;
	bool ray_tracing_pipeline = false;
	bool ray_query = false;
	bool cluster_acceleration_structure = false;
	std::string_view why_no_clusters = "the device lacks VK_NV_cluster_acceleration_structure";  // while that is closed
	bool fragment_barycentric = false;
	bool conditional_rendering = false;
	bool pipeline_statistics = false;  // registers and shared memory of a pipeline, as the driver compiled it
	bool debug_names = false;

	// Rays can be traced: through acceleration structures, by ray tracing pipelines.
	bool rays() const { return acceleration_structure && ray_tracing_pipeline; }

	std::vector<Gate> table() const;
};

}  // namespace tessera
