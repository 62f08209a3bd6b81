#include "verify/finite_check.h"

#include "reference/double_surface.h"
#include "reference/piece_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tessera::verify
{

namespace
{

struct Vertex
{
	ClusterRef cluster;
	uint32_t triangle;
	DomainPoint domain;
	vec3 displaced;
};
static_assert(sizeof(Vertex) == 32);

// Every corner once, in an order that depends on nothing but the set.
std::vector<Vertex> distinctVertices(std::span<const MicroTriangle> set)
{
	std::vector<Vertex> vertices;
	vertices.reserve(set.size() * 3);
	for (const MicroTriangle& t : set)
		for (uint32_t i = 0; i < 3; ++i)
			if (t.domain[i].u != NO_INDEX)
				vertices.push_back({ t.cluster, t.triangle, t.domain[i], t.displaced[i] });
	std::sort(vertices.begin(), vertices.end(), [](const Vertex& a, const Vertex& b) { return std::memcmp(&a, &b, sizeof(Vertex)) < 0; });
	const auto same = [](const Vertex& a, const Vertex& b) {
		return std::memcmp(&a, &b, sizeof(Vertex)) == 0;
	};
	vertices.erase(std::unique(vertices.begin(), vertices.end(), same), vertices.end());
	return vertices;
}

bool isFinite(vec3 p)
{
	return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

// Distance from one float to the next at a point's largest coordinate.
double ulpAt(dvec3 p)
{
	const double largest = std::max({ std::abs(p.x), std::abs(p.y), std::abs(p.z), double(std::numeric_limits<float>::min()) });
	return std::exp2(std::floor(std::log2(largest)) - 23);
}

void compare(const Vertex& v, const reference::DoublePoint& right, const Screen& screen, double scale, CheckResult& result)
{
	const dvec3 error = glm::abs(dvec3(v.displaced) - right.displaced);
	const double largest = std::max({ error.x, error.y, error.z });
	result.measure("error, ulp of the largest coordinate", largest / ulpAt(right.displaced));
	result.measure("error over its bound", right.displaced_bound > 0 ? largest / right.displaced_bound : largest > 0 ? HUGE_VAL : 0);
	result.measure("error, pixels", glm::length(error) * scale * screen.pixelsPerUnit(v.cluster.instance, v.displaced));
	if (!(largest <= right.displaced_bound))
		result.violation(largest, { v.cluster,
									v.triangle,
									v.domain,
									fmt::format("{:.3g} mesh units from where it belongs, {:.3g} are allowed", largest, right.displaced_bound),
									{} });
}

// Most that an instance stretches a length.
double scaleOf(const dmat4& world)
{
	return std::sqrt(glm::dot(dvec3(world[0]), dvec3(world[0])) + glm::dot(dvec3(world[1]), dvec3(world[1])) +
					 glm::dot(dvec3(world[2]), dvec3(world[2])));
}

}  // namespace

CheckResult checkFinite(const reference::HostScene& scene, const View& view, const Screen& screen, std::span<const MicroTriangle> set, uint64_t most)
{
	const std::vector<Vertex> vertices = distinctVertices(set);
	const reference::DoubleSurface surface(scene, view);
	const size_t stride = std::max<size_t>(1, (vertices.size() + most - 1) / most);
	const auto chunks = reference::inChunks<CheckResult>(vertices.size(), 1024, [&](CheckResult& chunk, size_t first, size_t end) {
		for (size_t i = first; i < end; ++i)
		{
			const Vertex& v = vertices[i];
			++chunk.sums["micro-vertices"];
			if (!isFinite(v.displaced))
				chunk.violation(
					HUGE_VAL,
					{ v.cluster, v.triangle, v.domain, fmt::format("({}, {}, {}) is not finite", v.displaced.x, v.displaced.y, v.displaced.z), {} });
			else if (i % stride == 0)
			{
				++chunk.sums["compared in double"];
				compare(v, surface.at(v.cluster, v.triangle, v.domain), screen, scaleOf(scene.built().instances[v.cluster.instance].world), chunk);
			}
		}
	});
	CheckResult result;
	for (const CheckResult& chunk : chunks)
		result.merge(chunk);
	return result;
}

}  // namespace tessera::verify
