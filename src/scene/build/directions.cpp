#include "scene/build/directions.h"

#include <cmath>
#include <cstring>

namespace tessera
{

namespace
{

constexpr double kShortestMean = 1e-6;

vec3 cleanVec3(dvec3 v)
{
	return vec3(cleanFloat(v.x), cleanFloat(v.y), cleanFloat(v.z));
}

bool isZero(vec3 v)
{
	return v.x == 0 && v.y == 0 && v.z == 0;
}

// What a triangle's shape says: its unit normal (zero without area) and the angles at its corners.
struct Facet
{
	dvec3 normal;
	double angles[3];
};

Facet facetOf(const MeshCorners& corners, uint32_t triangle)
{
	const dvec3 p[3] = { dvec3(corners.positions[3 * triangle]), dvec3(corners.positions[3 * triangle + 1]),
						 dvec3(corners.positions[3 * triangle + 2]) };
	Facet facet;
	for (int i = 0; i < 3; ++i)
	{
		const dvec3 a = p[(i + 1) % 3] - p[i];
		const dvec3 b = p[(i + 2) % 3] - p[i];
		const double sine = glm::length(glm::cross(a, b));
		facet.angles[i] = sine == 0 ? 0.0 : std::atan2(sine, glm::dot(a, b));
	}
	const dvec3 area = glm::cross(p[1] - p[0], p[2] - p[0]);
	const double length = glm::length(area);
	facet.normal = length > 0 ? area / length : dvec3(0);
	return facet;
}

// A weighted mean that knows whether everything that entered it was the same to the bit.
struct Mean
{
	dvec3 sum = dvec3(0);
	double weight = 0;
	vec3 first = vec3(0);
	bool uniform = true;

	void add(vec3 v, double w)
	{
		if (weight == 0)
			first = v;
		uniform = uniform && std::memcmp(&first, &v, sizeof v) == 0;
		sum += dvec3(v) * w;
		weight += w;
	}

	vec3 direction() const
	{
		if (uniform)
			return first;
		const double length = glm::length(sum);
		return length < kShortestMean * weight ? vec3(0) : cleanVec3(sum / length);
	}
};

// The authored normal at each corner; zero where there is none.
std::vector<vec3> authoredNormals(const Mesh& mesh, const MeshCorners& corners)
{
	std::vector<vec3> normals;
	normals.reserve(corners.positions.size());
	for (const Primitive& primitive : mesh.primitives)
		for (const uint32_t index : primitive.indices)
			normals.push_back(primitive.normals.empty() ? vec3(0) : cleanVec3(dvec3(primitive.normals[index])));
	return normals;
}

// Fills in the normals that are missing.
void computeMissing(const std::vector<Facet>& facets, const MeshWeld& weld, std::vector<vec3>& normals)
{
	struct Sum
	{
		dvec3 normal = dvec3(0);
		double weight = 0;
	};
	std::vector<Sum> sums(weld.first_corners.size());
	for (uint32_t corner = 0; corner < normals.size(); ++corner)
	{
		const double angle = facets[corner / 3].angles[corner % 3];
		sums[weld.corner_welds[corner]].normal += facets[corner / 3].normal * angle;
		sums[weld.corner_welds[corner]].weight += angle;
	}
	for (uint32_t corner = 0; corner < normals.size(); ++corner)
	{
		if (!isZero(normals[corner]))
			continue;
		const Sum& sum = sums[weld.corner_welds[corner]];
		const double length = glm::length(sum.normal);
		normals[corner] = cleanVec3(length > kShortestMean * sum.weight ? sum.normal / length : facets[corner / 3].normal);
		if (isZero(normals[corner]))
			normals[corner] = vec3(0, 0, 1);
	}
}

void meanDirections(const std::vector<Facet>& facets, const MeshWeld& weld, MeshNormals& result)
{
	std::vector<Mean> means(weld.first_corners.size());
	const auto count = uint32_t(result.corner_normals.size());
	for (uint32_t corner = 0; corner < count; ++corner)
		if (const double angle = facets[corner / 3].angles[corner % 3]; angle > 0)
			means[weld.corner_welds[corner]].add(result.corner_normals[corner], angle);

	// Fans of triangles without area: every corner counts the same.
	std::vector<bool> flat(means.size());
	for (size_t i = 0; i < means.size(); ++i)
		flat[i] = means[i].weight == 0;
	for (uint32_t corner = 0; corner < count; ++corner)
		if (flat[weld.corner_welds[corner]])
			means[weld.corner_welds[corner]].add(result.corner_normals[corner], 1);

	for (const Mean& mean : means)
	{
		result.weld_directions.push_back(mean.direction());
		result.zero_directions += isZero(result.weld_directions.back());
	}
}

}  // namespace

float cleanFloat(double value)
{
	const auto rounded = float(value);
	return std::isfinite(rounded) && std::fabs(rounded) >= 0x1p-60f ? rounded : 0.0f;
}

MeshNormals buildNormals(const Mesh& mesh, const MeshCorners& corners, const MeshWeld& weld, bool with_directions)
{
	MeshNormals result;
	std::vector<Facet> facets(corners.triangleCount());
	for (uint32_t triangle = 0; triangle < facets.size(); ++triangle)
	{
		facets[triangle] = facetOf(corners, triangle);
		result.degenerate_triangles += facets[triangle].normal == dvec3(0);
	}
	result.corner_normals = authoredNormals(mesh, corners);
	computeMissing(facets, weld, result.corner_normals);
	if (with_directions)
		meanDirections(facets, weld, result);
	return result;
}

}  // namespace tessera
