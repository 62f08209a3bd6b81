#include "output/mesh_weld.h"

#include <bit>
#include <cstring>

namespace tessera
{

namespace
{

constexpr float kSameNormal = 0.9999f;  // cosine
constexpr float kSameUv = 1e-5f;

bool sameUv(vec2 a, vec2 b)
{
	const vec2 room = kSameUv * glm::max(vec2(1), glm::abs(a));
	return std::abs(a.x - b.x) <= room.x && std::abs(a.y - b.y) <= room.y;
}

bool sameNormal(vec3 a, vec3 b)
{
	return a == b || glm::dot(a, b) >= kSameNormal;
}

}  // namespace

bool MeshWelder::Place::operator==(const Place& other) const
{
	return group == other.group && std::memcmp(&point, &other.point, sizeof(vec3)) == 0;
}

size_t MeshWelder::PlaceHash::operator()(const Place& place) const
{
	uint64_t hash = place.group;
	for (const float value : { place.point.x, place.point.y, place.point.z })
	{
		hash = (hash ^ std::bit_cast<uint32_t>(value)) * 0x9e3779b97f4a7c15ull;
		hash ^= hash >> 29;
	}
	return hash;
}

uint32_t MeshWelder::add(uint32_t group, vec3 place, const WeldVertex& vertex)
{
	const auto [found, is_new] = first_.try_emplace({ group, place }, kNone);
	for (uint32_t i = found->second; i != kNone; i = next_[i])
		if (sameNormal(normals_[i], vertex.normal) && sameUv(uvs_[i], vertex.uv))
			return i;
	const auto index = static_cast<uint32_t>(positions_.size());
	positions_.push_back(vertex.position);
	normals_.push_back(vertex.normal);
	uvs_.push_back(vertex.uv);
	next_.push_back(found->second);
	found->second = index;
	return index;
}

void MeshWelder::addTriangle(uint32_t a, uint32_t b, uint32_t c)
{
	if (a == b || b == c || c == a)
	{
		++collapsed_;
		return;
	}
	indices_.insert(indices_.end(), { a, b, c });
}

MeshView MeshWelder::view(bool with_uvs) const
{
	return { positions_, normals_, with_uvs ? std::span(uvs_) : std::span<const vec2>(), indices_ };
}

}  // namespace tessera
