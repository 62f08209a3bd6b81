// Tracing a grid of rays: by a ray tracing pipeline, or by ray queries.
#pragma once
#include "layers/cluster_harness.h"

namespace tessera::test
{

// As shaders/hit.glsl.
struct Hit
{
	float t, u, v;
	uint32_t cluster, geometry, primitive, custom, instance;
};

struct TraceOptions
{
	// Records into the same command buffer, when everything is bound and before the rays.
	std::function<void(VkCommandBuffer)> between;
	bool allow_clusters = true;  // the pipeline says that it meets clusters
	bool say_capability = true;  // shaders say that they read a cluster's id
};

// side x side rays straight down on [0, extent]^2. `closest_hit`: a file of the shaders here, without ".spv".
std::vector<Hit> trace(Gpu& gpu, const Structure& scene, const char* closest_hit, float extent, uint32_t side, const TraceOptions& options = {});
// The same rays by ray queries in a compute shader.
std::vector<Hit> traceByQueries(Gpu& gpu, const Structure& scene, float extent, uint32_t side);

}  // namespace tessera::test
