// What the host says of instances that may share structures that rays are traced through (shared/ray_sharing.h).
#pragma once
#include "scene/scene.h"
#include "shared/ray_sharing.h"

namespace tessera
{

// The limits of a view. `tessellates`: some edge of the scene may get two segments.
RaySharing raySharing(const View& view, bool tessellates);

// Per mesh, 1: its clusters have no height map, so that their vertices are those of the file at any rate.
std::vector<uint8_t> undisplacedMeshes(const BuiltScene& scene);

// Goes through the instances whose meshes have `candidate` 1; gives, per mesh, 1 when one of its instances may share in this view. Instances of
// meshes that are found already are not looked at. Linear in the instances.
std::vector<uint8_t> sharingMeshes(const BuiltScene& scene, const View& view, const RaySharing& sharing, std::vector<uint8_t> candidates);

}  // namespace tessera
