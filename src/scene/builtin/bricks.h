// Height and colour maps of brickwork and of cobblestones; both tile in u and v.
#pragma once
#include "scene/imported_scene.h"

namespace tessera::builtin
{

inline constexpr uint32_t kBricksAcross = 6;  // per tile of the brick map
inline constexpr uint32_t kCourses = 18;      // per tile

// Append colour and height textures of `size` x `size` texels and a material with heights over [offset, offset + factor]; return its index.
uint32_t addBrickMaterial(ImportedScene& scene, uint32_t size, float factor, float offset);
uint32_t addCobbleMaterial(ImportedScene& scene, uint32_t size, float factor, float offset);

}  // namespace tessera::builtin
