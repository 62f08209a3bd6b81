// The micro-triangles of part triangles and full clusters: what the rasterising stages draw, bit for bit.
#pragma once
#include "reference/host_scene.h"
#include "reference/pieces.h"

namespace tessera::reference
{

struct MicroVertex
{
	DomainPoint domain;  // unused (0, 0) in full clusters, whose vertices belong to several base triangles
	vec3 base;           // mesh units
	vec3 displaced;      // mesh units
	vec4 clip;
};

// Micro-vertices in the pattern's (or the cluster's) order, micro-triangles as the visibility payload numbers them. Winding is that
// of the base triangle in the mesh: the picture of a mirrored instance shows it turned over.
struct Evaluated
{
	std::vector<MicroVertex> vertices;
	std::vector<uvec3> triangles;
};

MicroVertex evaluatePoint(const HostScene& scene, const View& view, ClusterRef ref, uint32_t triangle, DomainPoint point);

Evaluated evaluatePart(const HostScene& scene, const View& view, const ReferencePiece& part);
Evaluated evaluateFullCluster(const HostScene& scene, const View& view, ClusterRef ref);

// Domain points and micro-triangles alone.
struct DomainMesh
{
	std::vector<DomainPoint> points;
	std::vector<uvec3> triangles;
};

// Replaces what `mesh` holds; keeps its memory.
void evaluateDomain(const HostScene& scene, const ReferencePiece& part, DomainMesh& mesh);

}  // namespace tessera::reference
