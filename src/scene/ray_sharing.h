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

// Base triangles of all instances that do not share in this view, of those meshes. Linear in the instances.
uint64_t trianglesNotShared(const BuiltScene& scene, const View& view, const RaySharing& sharing, const std::vector<uint8_t>& candidates);

// Triangles of a mesh; its clusters lie one after another, and so do their triangles.
uint32_t trianglesOf(const BuiltScene& scene, const MeshRecord& mesh);

}  // namespace tessera
