// Derives everything that rendering needs from an imported scene. Runs once per load, on the CPU.
#pragma once
#include "base/result.h"
#include "scene/metric.h"
#include "scene/scene.h"

namespace tessera
{

struct BuildOptions
{
	uint32_t cluster_vertices = 64;   // most vertices per cluster, 3..128
	uint32_t cluster_triangles = 64;  // most triangles per cluster, 4..128, a multiple of 4
	MetricTables tables = {};         // which are made
	bool pn = false;                  // base triangles are PN triangles (shared/pn.h)
};

// import → weld → normals and directions → vertices → seams → clusters → bounds → tables of metrics → traits (DESIGN.md, section 3).
// Only meshes that an instance places are built; the others get an empty MeshRecord. The result depends on the input alone.
// Errors: Usage (options out of range), BadInput (a mesh or the scene is too large for 32-bit indices, or reaches farther than 2^60 from
// its origin, displaced).
// Time is linear in triangles and height texels; memory about 300 bytes per triangle at the peak.
Result<BuiltScene> buildScene(const ImportedScene& imported, const BuildOptions& options = {});

}  // namespace tessera
