#include "reference/double_surface.h"

#include "scene/camera.h"

#include <algorithm>

namespace tessera::reference
{

namespace
{

constexpr double kEpsilon = 0x1p-24;           // a float operation errs by at most this, relative
constexpr double kNormalizedError = 4e-7;      // stated by shared/surface.h
constexpr double kRoughLogError = 0.0861 / 2;  // levels; stated by shared/height.h
constexpr double kLogStep = 0x1p-16;           // levels; the float code keeps 15 bits of the mantissa, then halves

double largest(dvec3 v)
{
	return std::max({ std::abs(v.x), std::abs(v.y), std::abs(v.z) });
}

// Index of the texel that a wrapped, possibly outside, texel coordinate means.
int64_t wrapIndex(int64_t i, int64_t size, uint32_t wrap)
{
	if (wrap == WRAP_CLAMP)
		return std::clamp<int64_t>(i, 0, size - 1);
	const int64_t period = wrap == WRAP_REPEAT ? size : 2 * size;
	const int64_t within = (i % period + period) % period;
	return within < size ? within : period - 1 - within;
}

double texel(const HeightMapData& map, uint64_t index)
{
	const auto* bytes = reinterpret_cast<const uint8_t*>(map.texels.data());
	if (map.record.format == HEIGHT_U8)
		return bytes[index] / 255.0;
	if (map.record.format == HEIGHT_U16)
		return (bytes[2 * index] + 256 * bytes[2 * index + 1]) / 65535.0;
	return std::bit_cast<float>(map.texels[index]);
}

dvec2 levelSize(const HeightMapData& map, uint32_t level)
{
	return dvec2(std::max(map.record.width >> level, 1u), std::max(map.record.height >> level, 1u));
}

dvec3 weightsOf(DomainPoint p)
{
	return dvec3(p.u, p.v, domainW(p)) / double(DOMAIN_SIZE);
}

// Bilinear, texel centres at half-integers.
double bilinear(const HeightMapData& map, uint32_t level, dvec2 uv)
{
	const dvec2 size = levelSize(map, level);
	dvec2 at = uv * size - 0.5;
	// Far outside the indices would not fit: the edge texel is reached long before.
	if (map.record.wrap_u == WRAP_CLAMP)
		at.x = std::clamp(at.x, -1.0, size.x);
	if (map.record.wrap_v == WRAP_CLAMP)
		at.y = std::clamp(at.y, -1.0, size.y);
	const dvec2 corner = glm::floor(at), blend = at - corner;
	const auto read = [&](int dx, int dy) {
		const auto width = int64_t(size.x), height = int64_t(size.y);
		const int64_t x = wrapIndex(int64_t(corner.x) + dx, width, map.record.wrap_u);
		const int64_t y = wrapIndex(int64_t(corner.y) + dy, height, map.record.wrap_v);
		return texel(map, uint64_t(map.record.level_first[level]) + uint64_t(y * width + x));
	};
	const double top = (1 - blend.x) * read(0, 0) + blend.x * read(1, 0);
	const double bottom = (1 - blend.x) * read(0, 1) + blend.x * read(1, 1);
	return (1 - blend.y) * top + blend.y * bottom;
}

}  // namespace

// Where a height is read, and the largest of the values that the coordinate was interpolated from.
struct DoubleSurface::Source
{
	dvec2 uv = dvec2(0);
	double density = 0;
	uint32_t height_map = NO_INDEX;
	dvec2 largest_uv = dvec2(0);
};

DoubleSurface::DoubleSurface(const HostScene& scene, const View& view, MipLog log)
	: scene_(scene), view_(view), log_(log), eye_(dvec3(view.eye_high) + dvec3(view.eye_low))
{
	for (const HeightMapData& map : scene.built().height_maps)
	{
		double low = texel(map, 0), high = low;
		for (uint64_t i = 0; i < uint64_t(map.record.width) * map.record.height; ++i)
		{
			low = std::min(low, texel(map, i));
			high = std::max(high, texel(map, i));
		}
		map_ranges_.push_back(high - low);
		map_peaks_.push_back(std::max(std::abs(low), std::abs(high)));
	}
}

dvec3 DoubleSurface::fromEye(uint32_t instance, dvec3 mesh_point) const
{
	return dvec3(scene_.built().instances[instance].world * dvec4(mesh_point, 1)) - eye_;
}

// World units, never below the near distance; orthographic: 1.
double DoubleSurface::rateDistance(dvec3 from_eye) const
{
	const double floor = std::sqrt(double(view_.distance_floor_squared)) / view_.unit;
	return view_.distance_weight == 0 ? floor : std::max(glm::length(from_eye), floor);
}

// Flat, or the PN triangle as its paper defines it: ten control points and their Bernstein weights.
dvec3 DoubleSurface::basePoint(const BaseTriangle& base, dvec3 weights) const
{
	const auto& positions = scene_.built().positions;
	const uint32_t vertices[3] = { base.v0, base.v1, base.v2 };
	if (!scene_.built().traits.has_pn)
		return dvec3(positions[base.v0]) * weights.x + dvec3(positions[base.v1]) * weights.y + dvec3(positions[base.v2]) * weights.z;
	dvec3 corners_sum(0), edges_sum(0), point(0);
	for (int i = 0; i < 3; ++i)
	{
		const dvec3 from(positions[vertices[i]]), normal(scene_.directions()[vertices[i]]);
		corners_sum += from;
		point += from * (weights[i] * weights[i] * weights[i]);
		for (int k = 1; k < 3; ++k)
		{
			const int j = (i + k) % 3;
			const dvec3 to(positions[vertices[j]]);
			const dvec3 control = (from * 2.0 + to - normal * glm::dot(to - from, normal)) / 3.0;
			edges_sum += control;
			point += control * (3 * weights[i] * weights[i] * weights[j]);
		}
	}
	const dvec3 edges_mean = edges_sum / 6.0;
	const dvec3 middle = edges_mean + (edges_mean - corners_sum / 3.0) / 2.0;
	return point + middle * (6 * weights.x * weights.y * weights.z);
}

// Weights are exact: one rounding per product, two of the sums. A PN triangle takes away a sum of directions: a rise is off by 4 roundings of the
// edge's length, its share by 3 more, a coefficient and the sum by 5 together; shares add up to at most 1/3. What is below 2^-80 counts as 0.
double DoubleSurface::baseBound(const BaseTriangle& base) const
{
	const auto& positions = scene_.built().positions;
	const dvec3 p0 = positions[base.v0], p1 = positions[base.v1], p2 = positions[base.v2];
	const double size = std::max({ largest(p0), largest(p1), largest(p2) });
	if (!scene_.built().traits.has_pn)
		return 3 * kEpsilon * size;
	const double longest = std::max({ glm::length(p1 - p0), glm::length(p2 - p1), glm::length(p0 - p2) });
	return 4 * kEpsilon * (size + longest * 1.1) + kEpsilon * longest + 0x1p-80;
}

// What factors are decided by, whatever the surface is.
dvec3 DoubleSurface::flatPoint(const BaseTriangle& base, DomainPoint p) const
{
	const auto& positions = scene_.built().positions;
	const dvec3 weights = weightsOf(p);
	return dvec3(positions[base.v0]) * weights.x + dvec3(positions[base.v1]) * weights.y + dvec3(positions[base.v2]) * weights.z;
}

DoubleSurface::Source DoubleSurface::ownSource(const BaseTriangle& base, dvec3 weights) const
{
	const auto& uvs = scene_.built().uvs;
	const auto& densities = scene_.built().densities;
	const dvec2 uv0 = uvs[base.v0], uv1 = uvs[base.v1], uv2 = uvs[base.v2];
	Source source;
	source.uv = uv0 * weights.x + uv1 * weights.y + uv2 * weights.z;
	source.density = densities[base.v0] * weights.x + densities[base.v1] * weights.y + densities[base.v2] * weights.z;
	source.height_map = base.height_map;
	source.largest_uv = glm::max(glm::max(glm::abs(uv0), glm::abs(uv1)), glm::abs(uv2));
	return source;
}

// The owner's values at corners and on seam edges, else the triangle's own.
DoubleSurface::Source DoubleSurface::sourceAt(const BaseTriangle& base, dvec3 weights) const
{
	const BuiltScene& built = scene_.built();
	const uint32_t vertices[3] = { base.v0, base.v1, base.v2 };
	for (int corner = 0; corner < 3; ++corner)
		if (weights[corner] == 1 && !built.seam_corner_indices.empty() && built.seam_corner_indices[vertices[corner]] != NO_INDEX)
		{
			const SeamCorner& seam = built.seam_corners[built.seam_corner_indices[vertices[corner]]];
			return { dvec2(seam.uv), seam.density, seam.height_map, glm::abs(dvec2(seam.uv)) };
		}
	const bool is_corner = weights.x == 1 || weights.y == 1 || weights.z == 1;
	const uint32_t seam_flags = triangleSeamFlags(base.flags);
	uint32_t record = base.first_seam_edge;
	for (int edge = 0; edge < 3; ++edge)
	{
		if ((seam_flags >> edge & 1) == 0)
			continue;
		const bool on_edge = weights[(edge + 2) % 3] == 0;
		if (on_edge && !is_corner)
		{
			const SeamEdge& seam = built.seam_edges[record];
			const double first = weights[edge], second = weights[(edge + 1) % 3];
			return { dvec2(seam.uv_first) * first + dvec2(seam.uv_second) * second, seam.density_first * first + seam.density_second * second,
					 seam.height_map, glm::max(glm::abs(dvec2(seam.uv_first)), glm::abs(dvec2(seam.uv_second))) };
		}
		++record;
	}
	return base.height_map == NO_INDEX ? Source{} : ownSource(base, weights);
}

double DoubleSurface::levelOf(double footprint_squared) const
{
	if (!(footprint_squared > 1))
		return 0;
	if (log_ == MipLog::True)
		return std::log2(footprint_squared) / 2;
	int exponent = 0;
	const double mantissa = std::frexp(footprint_squared, &exponent);  // 1/2..1
	return (exponent - 1 + (2 * mantissa - 1)) / 2;
}

// Two mips, blended; the bound follows the float evaluation step by step.
DoubleSurface::Height DoubleSurface::heightAt(const Source& source, uint32_t instance, dvec3 base_point, double base_bound) const
{
	const HeightMapData& map = scene_.built().height_maps[source.height_map];
	const dmat3 linear = dmat3(scene_.built().instances[instance].world);
	const double inverse_scale = std::sqrt(inverseScaleSquared(scene_.built().instances[instance]));
	const dvec3 from_eye = fromEye(instance, base_point);
	const double distance = rateDistance(from_eye);
	const double footprint = distance * std::sqrt(double(view_.sample_over_focal_squared)) * inverse_scale * source.density;
	const double level = std::min(levelOf(footprint * footprint), double(map.record.level_count - 1));
	const auto fine_level = uint32_t(level);
	const double blend = level - fine_level;
	const double fine = bilinear(map, fine_level, source.uv);
	const double coarse = blend > 0 ? bilinear(map, fine_level + 1, source.uv) : fine;

	// A placed component sums three products and the translation: matrix rounded to float, four more roundings; and the point's own error.
	const double reach = std::max({ glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]) });
	const double magnitude = reach * 3 * largest(base_point) + largest(from_eye);
	const double placed_error = 2 * (6 * kEpsilon * magnitude + 3 * reach * base_bound);
	// Squares double a relative error; about ten roundings to the footprint; levels change by at most one per relative unit.
	const double level_error = 2 * placed_error / distance + 16 * kEpsilon + kLogStep + (log_ == MipLog::True ? kRoughLogError : 0);
	// Interpolating, folding and scaling a coordinate: texels by which a read may be off; the slope is at most the range per texel.
	const dvec2 texels_off = levelSize(map, fine_level) * (source.largest_uv * 4.0 + 4.0) * kEpsilon;
	const double range = map_ranges_[source.height_map], peak = map_peaks_[source.height_map];
	const double bound = range * (std::min(1.0, texels_off.x + texels_off.y) + std::min(1.0, level_error)) + 14 * kEpsilon * peak;
	return { fine + (coarse - fine) * blend, level, bound };
}

DoublePoint DoubleSurface::at(ClusterRef ref, uint32_t triangle, DomainPoint p) const
{
	const BuiltScene& built = scene_.built();
	const BaseTriangle base = scene_.base(ref, triangle);
	const dvec3 weights = weightsOf(p);
	DoublePoint point;
	point.base = basePoint(base, weights);
	point.base_bound = baseBound(base);
	point.displaced = point.base;
	point.displaced_bound = point.base_bound;

	const Source source = sourceAt(base, weights);
	if (source.height_map == NO_INDEX)
		return point;
	const auto directions = scene_.directions();
	const dvec3 sum = dvec3(directions[base.v0]) * weights.x + dvec3(directions[base.v1]) * weights.y + dvec3(directions[base.v2]) * weights.z;
	const double length = glm::length(sum);
	const dvec3 direction = length > 0 ? sum / length : dvec3(0);
	const Height height = heightAt(source, ref.instance, point.base, point.base_bound);
	const HeightMap& map = built.height_maps[source.height_map].record;
	point.level = height.level;
	point.displacement = (height.value * map.factor + map.offset + view_.displacement_offset) * view_.displacement_scale;
	point.displaced = point.base + direction * point.displacement;

	const double scale = std::abs(double(view_.displacement_scale));
	const double displacement_bound =
		(height.bound * std::abs(map.factor) +
		 5 * kEpsilon * (std::abs(height.value * map.factor) + std::abs(map.offset) + std::abs(view_.displacement_offset))) *
		scale;
	// Interpolated unit vectors are off by 3 roundings in each axis; the shorter their sum, the more that turns it.
	const double direction_bound = length > 0 ? std::min(2.0, kNormalizedError + 3 * 1.75 * kEpsilon / length) : 0;
	point.displaced_bound = point.base_bound + displacement_bound + direction_bound * (std::abs(point.displacement) + displacement_bound) +
							kEpsilon * (std::abs(point.displacement) + largest(point.displaced)) * 1.01;
	return point;
}

dvec3 DoubleSurface::onFinestMip(const BaseTriangle& base, dvec3 weights) const
{
	const BuiltScene& built = scene_.built();
	const auto directions = scene_.directions();
	const uint32_t v0 = base.v0, v1 = base.v1, v2 = base.v2;
	const dvec3 point = basePoint(base, weights);
	const Source source = sourceAt(base, weights);
	if (source.height_map == NO_INDEX)
		return point;
	const dvec3 sum = dvec3(directions[v0]) * weights.x + dvec3(directions[v1]) * weights.y + dvec3(directions[v2]) * weights.z;
	const double length = glm::length(sum);
	if (!(length > 0))
		return point;
	const HeightMapData& map = built.height_maps[source.height_map];
	const double height = bilinear(map, 0, source.uv);
	return point + sum * ((height * map.record.factor + map.record.offset + view_.displacement_offset) * view_.displacement_scale / length);
}

double DoubleSurface::realFactor(ClusterRef ref, uint32_t triangle, DomainPoint p, DomainPoint q) const
{
	const BaseTriangle base = scene_.base(ref, triangle);
	const dvec3 a = fromEye(ref.instance, flatPoint(base, p)), b = fromEye(ref.instance, flatPoint(base, q));
	const double segment = std::sqrt(double(view_.rate_over_focal_squared)) * std::min(rateDistance(a), rateDistance(b));
	return glm::length(a - b) / segment;
}

}  // namespace tessera::reference
