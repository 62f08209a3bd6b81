#include "app/export_mesh.h"

#include "shared/surface.h"

namespace tessera
{

namespace
{

const std::vector<vec2>& uvsOf(const BuiltScene& scene)
{
	return scene.color_uvs.empty() ? scene.uvs : scene.color_uvs;
}

// An instance's transforms, from mesh to world.
struct InstancePlace
{
	dmat4 points;
	dmat3 normals;  // cofactors, which no flat instance makes singular; outward stays outward in mirrored ones

	explicit InstancePlace(const dmat4& world) : points(world)
	{
		const dvec3 x(world[0]), y(world[1]), z(world[2]);
		const double sign = glm::determinant(dmat3(world)) < 0 ? -1 : 1;
		normals = dmat3(glm::cross(y, z) * sign, glm::cross(z, x) * sign, glm::cross(x, y) * sign);
	}

	vec3 normal(vec3 mesh_normal) const
	{
		const dvec3 turned = normals * dvec3(mesh_normal);
		const double length = glm::length(turned);
		return length > 0 && std::isfinite(length) ? vec3(turned / length) : vec3(0, 0, 1);
	}
};

vec2 uvAt(const BuiltScene& scene, const ClusterRecord& cluster, const DomainPiece& part, const DumpVertex& vertex)
{
	const std::vector<vec2>& uvs = uvsOf(scene);
	const uint32_t triangle = scene.triangles[cluster.first_triangle + part.triangle];
	const vec3 weights = domainWeights({ vertex.u, vertex.v });
	const auto corner = [&](uint32_t i) {
		return uvs[cluster.first_vertex + triangleVertex(triangle, i)];
	};
	return corner(0) * weights.x + corner(1) * weights.y + corner(2) * weights.z;
}

// Welds the vertices of one item.
class ItemAdder
{
public:
	ItemAdder(const BuiltScene& scene, const FrameDump& dump, MeshWelder& mesh) : scene_(scene), dump_(dump), mesh_(mesh)
	{
		places_.reserve(scene.instances.size());
		for (const Instance& instance : scene.instances)
			places_.emplace_back(instance.world);
	}

	void add(size_t index)
	{
		vertices_.clear();
		for (const DumpVertex& vertex : dump_.verticesOf(index))
			vertices_.push_back(addVertex(vertex, dump_.isBatch(index)));
		for (const DumpTriangle& triangle : dump_.trianglesOf(index))
			mesh_.addTriangle(vertices_[cornerOf(triangle, 0)], vertices_[cornerOf(triangle, 1)], vertices_[cornerOf(triangle, 2)]);
	}

private:
	uint32_t addVertex(const DumpVertex& vertex, bool in_batch)
	{
		const ClusterRef ref = dump_.visible[in_batch ? dump_.parts[vertex.owner].visible_cluster : vertex.owner];
		const ClusterRecord& cluster = scene_.clusters[ref.cluster];
		const InstancePlace& place = places_[ref.instance];
		WeldVertex welded = { vec3(dvec3(place.points * dvec4(vertex.displaced, 1))), place.normal(vertex.normal), vec2(0) };
		if (hasUvs(scene_))
			welded.uv = in_batch ? uvAt(scene_, cluster, dump_.parts[vertex.owner], vertex) : uvsOf(scene_)[cluster.first_vertex + vertex.u];
		return mesh_.add(ref.instance, vertex.displaced, welded);
	}

	const BuiltScene& scene_;
	const FrameDump& dump_;
	MeshWelder& mesh_;
	std::vector<InstancePlace> places_;
	std::vector<uint32_t> vertices_;  // of the item, in the mesh
};

}  // namespace

bool hasUvs(const BuiltScene& scene)
{
	return !uvsOf(scene).empty();
}

void addToMesh(const BuiltScene& scene, const FrameDump& dump, MeshWelder& mesh)
{
	ItemAdder adder(scene, dump, mesh);
	for (size_t item = 0; item < dump.items.size(); ++item)
		adder.add(item);
}

}  // namespace tessera
