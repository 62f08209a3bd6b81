// The generators behind builtinScenes(): one function per scene; `count` instances where the scene takes one.
#pragma once
#include "scene/imported_scene.h"

namespace tessera::builtin
{

ImportedScene makePlanet(uint32_t count);
ImportedScene makeShowcase(uint32_t count);
ImportedScene makeTerrain(uint32_t count);
ImportedScene makeBricks(uint32_t count);
ImportedScene makeInstances(uint32_t count);
ImportedScene makeQuad(uint32_t count);
ImportedScene makeCube(uint32_t count);
ImportedScene makeMaterials(uint32_t count);

// Meshes that several scenes use: each appends its images, textures, material and mesh, and returns the mesh's index.
uint32_t addPlanetMesh(ImportedScene& scene);               // radius 1 at sea level, mountains up to 1.09
uint32_t addMoonMesh(ImportedScene& scene);                 // radius about 1, cratered
uint32_t addRockMesh(ImportedScene& scene, uint32_t grid);  // a boulder within radius 1; 12 * grid * grid triangles

}  // namespace tessera::builtin
