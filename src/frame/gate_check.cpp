#include "frame/gate_check.h"

#include "plan/conditions.h"

#include <algorithm>

namespace tessera
{

Status checkGates(const Device& device, const PlanInput& input)
{
	const RenderOptions& options = input.options;
	const Raster raster = chosenRaster(input);
	if (raster == Raster::Soft && !device.gates.buffer_atomics_64)
		return fail(ExitCode::DeviceCannot, "--raster soft: {} lacks 64-bit buffer atomics; --raster mesh or indexed needs none", device.name);
	if (raster == Raster::Mesh && !device.gates.mesh_shader)
		return fail(ExitCode::DeviceCannot, "--raster mesh: {} lacks VK_EXT_mesh_shader; --raster indexed needs no mesh shaders", device.name);
	if (raster == Raster::Indexed && !device.gates.fragment_primitive_id)
		return fail(ExitCode::DeviceCannot, "--raster indexed: {} lacks primitive ids in fragment shaders (geometryShader) or 32-bit indices",
					device.name);
	for (const auto& [asked, option] :
		 { std::pair(raster == Raster::Rt, "--raster rt"), std::pair(options.shadows, "--shadows"), std::pair(options.ao_samples > 0, "--ao") })
		if (asked && !device.gates.rays())
			return fail(ExitCode::DeviceCannot, "{}: {} lacks {}; without rays, --raster auto draws everything else", option, device.name,
						device.gates.acceleration_structure ? "VK_KHR_ray_tracing_pipeline" : "VK_KHR_acceleration_structure");
	if (options.ray_path == RayPath::Clusters && !device.gates.cluster_acceleration_structure)
		return fail(ExitCode::DeviceCannot, "--rays clusters: {}: {}; --rays khr needs no clusters", device.name, device.gates.why_no_clusters);
	if (options.width_px == 0 || options.height_px == 0 || std::max(options.width_px, options.height_px) > device.limits.max_image_extent)
		return fail(ExitCode::Usage, "--size {}x{}: {} can draw from 1x1 to {}x{}", options.width_px, options.height_px, device.name,
					device.limits.max_image_extent, device.limits.max_image_extent);
	return {};
}

}  // namespace tessera
