#include "scene/gltf/primitive.h"

#include "scene/gltf/topology.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace tessera
{

// Smallest magnitude that is kept (2^-60): below it, products in the shared maths would meet denormals.
static constexpr float kSmallest = 0x1p-60f;

namespace
{

// The vertices of a primitive that its triangles use: a range of the accessors, and which elements of it.
struct VertexRange
{
	size_t first = 0;
	size_t count = 0;
	std::vector<uint32_t> kept;  // offsets from `first`, increasing; empty: all of them
};

class PrimitiveReader
{
public:
	PrimitiveReader(const PrimitiveInput& input, GltfWarnings& warnings) : m_input(input), m_warnings(warnings) {}

	Result<std::optional<Primitive>> read();

private:
	Status readTriangles(const GltfAccessor& positions, std::vector<uint32_t>& triangles);
	VertexRange selectVertices(std::vector<uint32_t>& triangles) const;
	Result<const GltfAccessor*> attribute(const std::string& name, size_t count, std::initializer_list<int> components) const;
	Status readPositions(const GltfAccessor& accessor, const VertexRange& range, Primitive& primitive);
	void readNormals(const GltfAccessor& accessor, const VertexRange& range, Primitive& primitive);
	Status readTexcoords(const VertexRange& range, size_t count, Primitive& primitive);
	void readColors(const GltfAccessor& accessor, const VertexRange& range, Primitive& primitive);
	size_t replaceNonFinite(std::vector<float>& values) const;

	void warn(const std::string& text) { m_warnings.add(m_input.place, text); }
	std::string attributePlace(const std::string& name) const { return fmt::format("{}.attributes.{}", m_input.place, name); }

	const PrimitiveInput& m_input;
	GltfWarnings& m_warnings;
};

}  // namespace

static std::vector<float> readRange(const GltfAccessor& accessor, const VertexRange& range)
{
	std::vector<float> values = readFloats(accessor, range.first, range.count);
	if (range.kept.empty())
		return values;
	const size_t components = static_cast<size_t>(accessor.components);
	for (size_t i = 0; i < range.kept.size(); ++i)
		std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(range.kept[i] * components), components,
					values.begin() + static_cast<std::ptrdiff_t>(i * components));
	values.resize(range.kept.size() * components);
	return values;
}

// Makes negative zeros positive and flushes what is too small to compute with.
static void flushSmall(std::vector<float>& values)
{
	for (float& value : values)
		value = std::fabs(value) < kSmallest ? 0.0f : value;
}

template <typename Vector>
static std::vector<Vector> asVectors(const std::vector<float>& values)
{
	constexpr size_t kComponents = sizeof(Vector) / sizeof(float);
	std::vector<Vector> vectors(values.size() / kComponents);
	std::memcpy(vectors.data(), values.data(), vectors.size() * sizeof(Vector));
	return vectors;
}

size_t PrimitiveReader::replaceNonFinite(std::vector<float>& values) const
{
	size_t replaced = 0;
	for (float& value : values)
		if (!std::isfinite(value))
		{
			value = 0;
			++replaced;
		}
	return replaced;
}

// An attribute's accessor, or null when the primitive lacks it.
Result<const GltfAccessor*> PrimitiveReader::attribute(const std::string& name, size_t count, std::initializer_list<int> components) const
{
	const auto found = m_input.source.attributes.find(name);
	if (found == m_input.source.attributes.end())
		return nullptr;
	const GltfAccessor& accessor = m_input.accessors[static_cast<size_t>(found->second)];
	if (std::find(components.begin(), components.end(), accessor.components) == components.end() || accessor.component_type == kGltfUnsignedInt)
		return m_input.document.bad(attributePlace(name), "accessors[{}] is {}, but VEC{} of float or of 8-bit or 16-bit integers is right",
									found->second, accessor.shown(), fmt::join(components, " or VEC"));
	if (count != 0 && accessor.count != count)
		return m_input.document.bad(attributePlace(name), "accessors[{}] has {} elements, but POSITION has {}", found->second, accessor.count, count);
	return &accessor;
}

Status PrimitiveReader::readTriangles(const GltfAccessor& positions, std::vector<uint32_t>& triangles)
{
	std::vector<uint32_t> indices;
	if (m_input.source.indices < 0)
	{
		indices.resize(positions.count);
		std::iota(indices.begin(), indices.end(), 0u);
	}
	else
	{
		const std::string place = m_input.place + ".indices";
		const GltfAccessor& accessor = m_input.accessors[static_cast<size_t>(m_input.source.indices)];
		const bool is_unsigned = accessor.component_type == kGltfUnsignedByte || accessor.component_type == kGltfUnsignedShort ||
								 accessor.component_type == kGltfUnsignedInt;
		if (accessor.components != 1 || !is_unsigned || accessor.normalized)
			return m_input.document.bad(place, "accessors[{}] is {}, but SCALAR of UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT is right",
										m_input.source.indices, accessor.shown());
		indices = readIndices(accessor);
		const uint32_t largest = *std::max_element(indices.begin(), indices.end());
		if (largest >= positions.count)
		{
			const auto at = std::find_if(indices.begin(), indices.end(), [&](uint32_t index) { return index >= positions.count; });
			return m_input.document.bad(place, "index {} is {}, but POSITION has {} vertices: values from 0 to {} are right", at - indices.begin(),
										*at, positions.count, positions.count - 1);
		}
	}
	if (m_input.source.mode == kGltfTriangles && indices.size() % 3 != 0)
		warn(fmt::format("its number of indices is not a multiple of 3; the last {} are left out", indices.size() % 3));
	triangles = triangleList(m_input.source.mode, std::move(indices));
	return {};
}

// Finds the vertices in use and renumbers the triangles to them: files often share one large vertex buffer between primitives.
VertexRange PrimitiveReader::selectVertices(std::vector<uint32_t>& triangles) const
{
	const auto [lowest, highest] = std::minmax_element(triangles.begin(), triangles.end());
	VertexRange range;
	range.first = *lowest;
	range.count = size_t(*highest) - *lowest + 1;

	std::vector<uint8_t> used(range.count, 0);
	for (uint32_t& index : triangles)
	{
		index -= static_cast<uint32_t>(range.first);
		used[index] = 1;
	}
	const size_t used_count = static_cast<size_t>(std::count(used.begin(), used.end(), uint8_t(1)));
	if (used_count == range.count)
		return range;

	std::vector<uint32_t> number(range.count, 0);
	range.kept.reserve(used_count);
	for (uint32_t i = 0; i < range.count; ++i)
		if (used[i])
		{
			number[i] = static_cast<uint32_t>(range.kept.size());
			range.kept.push_back(i);
		}
	for (uint32_t& index : triangles)
		index = number[index];
	return range;
}

Status PrimitiveReader::readPositions(const GltfAccessor& accessor, const VertexRange& range, Primitive& primitive)
{
	std::vector<float> values = readRange(accessor, range);
	const auto broken = std::find_if(values.begin(), values.end(), [](float value) { return !std::isfinite(value); });
	if (broken != values.end())
	{
		const size_t vertex = static_cast<size_t>(broken - values.begin()) / 3;
		const size_t element = range.first + (range.kept.empty() ? vertex : range.kept[vertex]);
		return m_input.document.bad(attributePlace("POSITION"), "accessors[{}], element {} is not finite; finite coordinates are right",
									m_input.source.attributes.at("POSITION"), element);
	}
	flushSmall(values);
	primitive.positions = asVectors<vec3>(values);
	return {};
}

void PrimitiveReader::readNormals(const GltfAccessor& accessor, const VertexRange& range, Primitive& primitive)
{
	std::vector<float> values = readRange(accessor, range);
	size_t broken = 0;
	for (size_t i = 0; i + 2 < values.size(); i += 3)
	{
		const dvec3 normal(values[i], values[i + 1], values[i + 2]);
		const double length = std::sqrt(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z);
		// Unit to float precision: the authored bits stay. Zero or broken: zero, which stands for "computed later".
		if (std::fabs(length - 1.0) < 1e-6)
			continue;
		broken += !std::isfinite(length);
		const double scale = std::isfinite(length) && length > kSmallest ? 1.0 / length : 0.0;
		for (int c = 0; c < 3; ++c)
			values[i + static_cast<size_t>(c)] = scale == 0.0 ? 0.0f : static_cast<float>(normal[c] * scale);
	}
	if (broken > 0)
		m_warnings.add(attributePlace("NORMAL"), fmt::format("{} normals are not finite and computed instead", broken));
	flushSmall(values);
	primitive.normals = asVectors<vec3>(values);
}

Status PrimitiveReader::readTexcoords(const VertexRange& range, size_t count, Primitive& primitive)
{
	for (const uint32_t set : m_input.texcoords_wanted)
	{
		const std::string name = fmt::format("TEXCOORD_{}", set);
		TRY_ASSIGN(const GltfAccessor* accessor, attribute(name, count, { 2 }));
		if (!accessor)
			continue;
		std::vector<float> values = readRange(*accessor, range);
		if (const size_t replaced = replaceNonFinite(values); replaced > 0)
			m_warnings.add(attributePlace(name), fmt::format("{} coordinates are not finite and replaced by 0", replaced));
		flushSmall(values);
		primitive.texcoords.resize(std::max(primitive.texcoords.size(), size_t(set) + 1));
		primitive.texcoords[set] = asVectors<vec2>(values);
	}
	return {};
}

void PrimitiveReader::readColors(const GltfAccessor& accessor, const VertexRange& range, Primitive& primitive)
{
	std::vector<float> values = readRange(accessor, range);
	if (const size_t replaced = replaceNonFinite(values); replaced > 0)
		m_warnings.add(attributePlace("COLOR_0"), fmt::format("{} components are not finite and replaced by 0", replaced));
	if (accessor.components == 4)
	{
		primitive.colors = asVectors<vec4>(values);
		return;
	}
	for (const vec3& color : asVectors<vec3>(values))
		primitive.colors.emplace_back(color.x, color.y, color.z, 1.0f);
}

Result<std::optional<Primitive>> PrimitiveReader::read()
{
	const int mode = m_input.source.mode;
	if (mode < kGltfTriangles)
	{
		warn(mode == 0 ? "POINTS are not supported and left out" : "LINES are not supported and left out");
		return std::nullopt;
	}
	TRY_ASSIGN(const GltfAccessor* positions, attribute("POSITION", 0, { 3 }));
	if (!positions)
	{
		warn("has no POSITION and is left out");
		return std::nullopt;
	}
	if (!m_input.source.targets.empty())
		warn("morph targets are not supported; the base shape is drawn");

	Primitive primitive;
	primitive.material = m_input.material;
	TRY(readTriangles(*positions, primitive.indices));
	if (primitive.indices.empty())
	{
		warn("has fewer than 3 vertices and is left out");
		return std::nullopt;
	}
	const VertexRange range = selectVertices(primitive.indices);
	TRY(readPositions(*positions, range, primitive));
	TRY_ASSIGN(const GltfAccessor* normals, attribute("NORMAL", positions->count, { 3 }));
	if (normals)
		readNormals(*normals, range, primitive);
	TRY(readTexcoords(range, positions->count, primitive));
	TRY_ASSIGN(const GltfAccessor* colors, attribute("COLOR_0", positions->count, { 3, 4 }));
	if (colors && !colors->isFloat() && !colors->normalized)
		return m_input.document.bad(attributePlace("COLOR_0"), "is {}, but integer colours must be normalized", colors->shown());
	if (colors)
		readColors(*colors, range, primitive);
	return primitive;
}

Result<std::optional<Primitive>> importPrimitive(const PrimitiveInput& input, GltfWarnings& warnings)
{
	return PrimitiveReader(input, warnings).read();
}

}  // namespace tessera
