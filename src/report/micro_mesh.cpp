#include "report/micro_mesh.h"

#include "reference/evaluate.h"
#include "reference/piece_groups.h"
#include "scene/factor_rule.h"

#include <algorithm>

namespace tessera::report
{

using reference::HostScene;
using reference::ReferencePiece;

namespace
{

void addTriangle(MicroMesh& mesh, uvec3 triangle)
{
	mesh.triangles.push_back(triangle);
	mesh.base_index.push_back(static_cast<uint32_t>(mesh.bases.size() - 1));
}

// All parts of one base triangle.
void addGroup(const HostScene& scene, const View& view, std::span<const ReferencePiece> group, MicroMesh& mesh)
{
	mesh.bases.push_back({ group[0].cluster.cluster, group[0].piece.triangle });
	for (const ReferencePiece& part : group)
	{
		const reference::Evaluated evaluated = reference::evaluatePart(scene, view, part);
		const auto first = static_cast<uint32_t>(mesh.positions.size());
		for (const reference::MicroVertex& vertex : evaluated.vertices)
		{
			mesh.positions.push_back(vertex.displaced);
			mesh.domain.push_back(vertex.domain);
		}
		for (const uvec3 triangle : evaluated.triangles)
			addTriangle(mesh, triangle + first);
	}
}

// Its vertices belong to several base triangles: every triangle gets its own, with their domain points.
void addFullCluster(const HostScene& scene, const View& view, ClusterRef ref, MicroMesh& mesh)
{
	const reference::Evaluated evaluated = reference::evaluateFullCluster(scene, view, ref);
	for (uint32_t t = 0; t < evaluated.triangles.size(); ++t)
	{
		mesh.bases.push_back({ ref.cluster, t });
		const auto first = static_cast<uint32_t>(mesh.positions.size());
		for (uint32_t corner = 0; corner < 3; ++corner)
		{
			mesh.positions.push_back(evaluated.vertices[evaluated.triangles[t][int(corner)]].displaced);
			mesh.domain.push_back(domainCorner(corner));
		}
		addTriangle(mesh, uvec3(first, first + 1, first + 2));
	}
}

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from)
{
	to.insert(to.end(), from.begin(), from.end());
}

void append(MicroMesh& to, const MicroMesh& from)
{
	const auto first_vertex = static_cast<uint32_t>(to.positions.size()), first_base = static_cast<uint32_t>(to.bases.size());
	append(to.positions, from.positions);
	append(to.domain, from.domain);
	append(to.bases, from.bases);
	for (const uvec3 triangle : from.triangles)
		to.triangles.push_back(triangle + first_vertex);
	for (const uint32_t base : from.base_index)
		to.base_index.push_back(base + first_base);
}

// What one instance is made of: runs in the classified lists, which are ordered by instance.
struct InstancePieces
{
	std::vector<std::span<const ReferencePiece>> groups;
	std::vector<ClusterRef> full_clusters;
};

MicroMesh meshOf(const HostScene& scene, const View& view, const InstancePieces& pieces)
{
	const size_t group_count = pieces.groups.size();
	std::vector<MicroMesh> chunks =
		reference::inChunks<MicroMesh>(group_count + pieces.full_clusters.size(), 64, [&](MicroMesh& chunk, size_t first, size_t end) {
			for (size_t i = first; i < end; ++i)
				if (i < group_count)
					addGroup(scene, view, pieces.groups[i], chunk);
				else
					addFullCluster(scene, view, pieces.full_clusters[i - group_count], chunk);
		});
	MicroMesh mesh;
	for (MicroMesh& chunk : chunks)
	{
		append(mesh, chunk);
		chunk = {};
	}
	return mesh;
}

}  // namespace

uint64_t MicroScene::triangleCount() const
{
	uint64_t count = 0;
	for (const MicroMesh& mesh : instances)
		count += mesh.triangles.size();
	return count;
}

Result<MicroScene> tessellate(const HostScene& scene, const View& view, uint32_t max_split, uint64_t most_triangles)
{
	MicroScene result;
	const FactorRule rule = factorRule(view, scene.tableSize(), std::min(max_split, scene.tableSize()));
	result.pieces = reference::classify(scene, view, rule, reference::allClusters(scene));
	if (result.pieces.microTriangles() > most_triangles)
		return badInput("the surface is made of {} micro-triangles, more than the {} that are measured; a larger rate has fewer",
						result.pieces.microTriangles(), most_triangles);
	result.pieces.splits = {};  // only their counts are of use here
	std::vector<InstancePieces> pieces(scene.instances().size());
	for (const auto& group : reference::groupsOf(result.pieces.parts))
		pieces[group[0].cluster.instance].groups.push_back(group);
	for (const ClusterRef ref : result.pieces.full_clusters)
		pieces[ref.instance].full_clusters.push_back(ref);
	for (const InstancePieces& instance : pieces)
		result.instances.push_back(meshOf(scene, view, instance));
	return result;
}

}  // namespace tessera::report
