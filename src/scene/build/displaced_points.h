// The displaced surface of a built scene at load: mip 0, displacement scale 1. As the shared headers evaluate it, but for rounding.
#pragma once
#include "scene/scene.h"
#include "shared/surface.h"

namespace tessera
{

// Of a scene that displaces something or has PN triangles. It must outlive this object and keep its arrays where they are.
class DisplacedPoints
{
public:
	explicit DisplacedPoints(const BuiltScene& scene);

	// What a base triangle is evaluated from; false in `moves` when its surface is flat: it is no curved PN triangle, its material does not displace
	// and no other triangle's does on its border.
	struct Triangle
	{
		BaseTriangle base;
		TriangleCorners corners;
		bool on_seam = false;
		bool moves = false;
		bool is_curved = false;
		float longest_texels = 0;  // of its edges, in height texels
	};
	Triangle triangle(const ClusterRecord& cluster, uint32_t index_in_cluster) const;

	vec3 at(const Triangle& triangle, DomainPoint p) const;

private:
	// The finest mip as floats: texels are read many times.
	struct Heights
	{
		uint32_t width, height, wrap_u, wrap_v;
		float factor, offset;
		std::vector<float> texels;
	};

	static float heightAt(const Heights& heights, vec2 uv);

	const BuiltScene& scene_;
	// Stand in for arrays that a scene without displacement does not have.
	std::vector<vec2> no_uvs_;
	std::vector<float> no_densities_;
	std::vector<uint32_t> no_height_maps_;
	std::vector<Heights> heights_;
	std::vector<HeightMap> height_maps_;
	Surface surface_ = {};
};

}  // namespace tessera
