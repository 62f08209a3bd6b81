// From what a frame draws to a mesh in world space.
#pragma once
#include "frame/frame_dump.h"
#include "output/mesh_weld.h"

namespace tessera
{

// True when vertices of the scene have texture coordinates: those of the colour texture, else those of the height map.
bool hasUvs(const BuiltScene& scene);

// Adds the micro-triangles of one round. Instances are placed in double precision, so equal points stay equal and nothing but
// the last rounding to float is lost. Normals are those of the displaced surface.
void addToMesh(const BuiltScene& scene, const FrameDump& dump, MeshWelder& mesh);

}  // namespace tessera
