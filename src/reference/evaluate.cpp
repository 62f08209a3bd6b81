#include "reference/evaluate.h"

namespace tessera::reference
{

namespace
{

MicroVertex microVertex(const SurfacePoint& point, DomainPoint domain, const Placement& placement, const View& view)
{
	return { domain, point.base, point.displaced, clipPosition(placed(placement, point.displaced), view) };
}

}  // namespace

MicroVertex evaluatePoint(const HostScene& scene, const View& view, ClusterRef ref, uint32_t triangle, DomainPoint point)
{
	const Placement placement = scene.placement(ref, view);
	return microVertex(surfacePoint(scene.surface(), scene.base(ref, triangle), point, placement, view), point, placement, view);
}

void evaluateDomain(const HostScene& scene, const ReferencePiece& part, DomainMesh& mesh)
{
	const DomainPiece& piece = part.piece;
	const PatternRange pattern = scene.pattern(piece);
	const uint32_t flags = AT(uint32_t, scene.surface().triangles, scene.cluster(part.cluster).first_triangle + piece.triangle);
	mesh.points.clear();
	mesh.triangles.clear();
	for (uint32_t v = 0; v < patternVertices(pattern); ++v)
		mesh.points.push_back(patternPoint(piece, v, pattern, scene.table(), triangleEdgeFlags(flags)));
	for (uint32_t t = 0; t < patternTriangles(pattern); ++t)
		mesh.triangles.push_back(patternTriangle(t, pattern, scene.table(), piece.mirror));
}

Evaluated evaluatePart(const HostScene& scene, const View& view, const ReferencePiece& part)
{
	DomainMesh mesh;
	evaluateDomain(scene, part, mesh);
	const BaseTriangle base = scene.base(part.cluster, part.piece.triangle);
	const Placement placement = scene.placement(part.cluster, view);
	Evaluated result;
	for (const DomainPoint point : mesh.points)
		result.vertices.push_back(microVertex(surfacePoint(scene.surface(), base, point, placement, view), point, placement, view));
	result.triangles = std::move(mesh.triangles);
	return result;
}

Evaluated evaluateFullCluster(const HostScene& scene, const View& view, ClusterRef ref)
{
	const ClusterRecord& cluster = scene.cluster(ref);
	const Surface& surface = scene.surface();
	const uint32_t height_map = AT(uint32_t, surface.material_height_maps, cluster.material);
	const Placement placement = scene.placement(ref, view);
	Evaluated result;
	for (uint32_t v = 0; v < clusterVertices(cluster); ++v)
		result.vertices.push_back(microVertex(surfaceVertex(surface, cluster.first_vertex + v, height_map, placement, view), {}, placement, view));
	for (uint32_t t = 0; t < clusterTriangles(cluster); ++t)
	{
		const uint32_t triangle = AT(uint32_t, surface.triangles, cluster.first_triangle + t);
		result.triangles.emplace_back(triangleVertex(triangle, 0), triangleVertex(triangle, 1), triangleVertex(triangle, 2));
	}
	return result;
}

}  // namespace tessera::reference
