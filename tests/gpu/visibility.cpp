#include "visibility.h"

#include "shared/visibility.h"

#include <algorithm>
#include <bit>

namespace tessera::test
{

namespace
{

Identity identityOf(ClusterRef ref, const DomainPiece& piece, uint32_t micro)
{
	return { { ref.instance, ref.cluster, piece.triangle, piece.c0.u, piece.c0.v, piece.c1.u, piece.c1.v, piece.c2.u, piece.c2.v, micro } };
}

DomainPiece wholeTriangle(uint32_t triangle)
{
	return { domainCorner(0), domainCorner(1), domainCorner(2), 0, triangle, 1, 1, 1, 0 };
}

Identity resolve(const GpuFrame& frame, uint32_t payload)
{
	const uint32_t index = payloadIndex(payload), triangle = payloadTriangle(payload);
	if (payloadKind(payload) == KIND_FULL_CLUSTER)
		return index < frame.visible.size() ? identityOf(frame.visible[index], wholeTriangle(triangle), 0) : Identity{};
	return index < frame.parts.size() ? identityOf(frame.parts[index].cluster, frame.parts[index].piece, triangle) : Identity{};
}

// --- the reference's micro-triangles, drawn in double precision ---------------------------------------------------------------------

constexpr double kEdgeMargin_px = 1.0 / 64;  // drivers snap vertices to 1/256 of a pixel
constexpr double kDepthMargin = 1e-5;        // relative

struct Candidate
{
	double depth = 0;
	bool sure = false;  // well inside
	Identity identity;
};

// What of a triangle lies before the near plane (z <= w), as a polygon.
std::vector<dvec4> beforeNearPlane(const std::array<vec4, 3>& clip)
{
	std::vector<dvec4> polygon;
	for (int i = 0; i < 3; ++i)
	{
		const dvec4 from(clip[i]), to(clip[(i + 1) % 3]);
		const double inside_from = from.w - from.z, inside_to = to.w - to.z;
		if (inside_from >= 0)
			polygon.push_back(from);
		if ((inside_from >= 0) != (inside_to >= 0))
			polygon.push_back(from + (to - from) * (inside_from / (inside_from - inside_to)));
	}
	return polygon;
}

struct Painter
{
	const View& view;
	bool shows_back;
	std::vector<std::vector<Candidate>> pixels;

	dvec3 onScreen(const dvec4& c) const { return { (c.x / c.w * 0.5 + 0.5) * view.width_px, (c.y / c.w * 0.5 + 0.5) * view.height_px, c.z / c.w }; }

	void draw(const std::array<vec4, 3>& clip, const Identity& identity)
	{
		const std::vector<dvec4> polygon = beforeNearPlane(clip);
		for (size_t i = 2; i < polygon.size(); ++i)
			drawTriangle({ onScreen(polygon[0]), onScreen(polygon[i - 1]), onScreen(polygon[i]) }, identity);
	}

	void drawTriangle(const std::array<dvec3, 3>& p, const Identity& identity)
	{
		const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
		// y points down: counter-clockwise fronts have negative area.
		if (area == 0 || (area > 0 && !shows_back))
			return;
		const auto range = [](double low, double high, uint32_t size) {
			return std::pair(int(std::clamp(std::floor(low - 1), 0.0, double(size))), int(std::clamp(std::ceil(high + 1), 0.0, double(size))));
		};
		const auto [x0, x1] = range(std::min({ p[0].x, p[1].x, p[2].x }), std::max({ p[0].x, p[1].x, p[2].x }), view.width_px);
		const auto [y0, y1] = range(std::min({ p[0].y, p[1].y, p[2].y }), std::max({ p[0].y, p[1].y, p[2].y }), view.height_px);
		for (int y = y0; y < y1; ++y)
			for (int x = x0; x < x1; ++x)
				drawPixel(p, area, x, y, identity);
	}

	void drawPixel(const std::array<dvec3, 3>& p, double area, int x, int y, const Identity& identity)
	{
		double depth = 0, inside_px = 1e9;
		for (int corner = 0; corner < 3; ++corner)
		{
			const dvec3 &from = p[size_t(corner + 1) % 3], &to = p[size_t(corner + 2) % 3];
			const double dx = to.x - from.x, dy = to.y - from.y;
			const double weight = (dx * (y + 0.5 - from.y) - dy * (x + 0.5 - from.x)) / area;
			const double length = std::sqrt(dx * dx + dy * dy);
			inside_px = std::min(inside_px, length > 0 ? weight * std::abs(area) / length : -1e9);
			depth += weight * p[size_t(corner)].z;
		}
		if (inside_px > -kEdgeMargin_px)
			pixels[size_t(y) * view.width_px + size_t(x)].push_back({ depth, inside_px > kEdgeMargin_px, identity });
	}
};

ExpectedPixel decide(const std::vector<Candidate>& candidates)
{
	if (candidates.empty())
		return { true, false, {} };
	const auto nearest = std::max_element(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.depth < b.depth; });
	if (!nearest->sure)
		return {};
	for (const Candidate& candidate : candidates)
		if (candidate.identity != nearest->identity && candidate.depth >= nearest->depth * (1 - kDepthMargin))
			return {};
	return { true, true, nearest->identity };
}

}  // namespace

std::string describe(const Identity& identity)
{
	const auto& w = identity.words;
	return fmt::format("instance {} cluster {} triangle {} part ({}, {}) ({}, {}) ({}, {}) micro {}", w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7],
					   w[8], w[9]);
}

std::vector<VisiblePixel> visibilityOf(const GpuFrame& frame)
{
	const std::vector<float> depths = frame.read<float>("visibility_depth");
	const std::vector<uint32_t> payloads = frame.read<uint32_t>("visibility_payload");
	const std::vector<uint64_t> words = frame.read<uint64_t>("kept_visibility");
	std::vector<VisiblePixel> pixels(std::max(depths.size(), words.size()));
	for (size_t i = 0; i < words.size(); ++i)
		if (words[i] != 0)
			pixels[i] = { std::bit_cast<float>(uint32_t(words[i] >> 32)), resolve(frame, uint32_t(words[i])) };
	for (size_t i = 0; i < depths.size(); ++i)
		if (depths[i] > 0)
			pixels[i] = { depths[i], resolve(frame, payloads[i]) };
	return pixels;
}

VisibilityDifference compareVisibility(const std::vector<VisiblePixel>& a, const std::vector<VisiblePixel>& b, uint32_t width_px,
									   double depth_tolerance)
{
	VisibilityDifference difference;
	EXPECT_EQ(a.size(), b.size());
	for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
	{
		difference.covered += a[i].covered() || b[i].covered();
		const bool same_depth = std::abs(double(a[i].depth) - double(b[i].depth)) <= depth_tolerance * double(a[i].depth);
		if (same_depth && a[i].identity == b[i].identity)
			continue;
		if (same_depth)
			++difference.ties;
		else if (difference.others++ == 0)
			difference.first = fmt::format("pixel {}, {}: depth {} of {}, depth {} of {}", i % width_px, i / width_px, a[i].depth,
										   describe(a[i].identity), b[i].depth, describe(b[i].identity));
	}
	return difference;
}

std::vector<ExpectedPixel> expectedVisibility(const GpuFrame& frame)
{
	const View& view = frame.view();
	const reference::HostScene& host = frame.scene.host;
	Painter painter = { view, false, std::vector<std::vector<Candidate>>(size_t(view.width_px) * view.height_px) };
	const auto draw = [&](const reference::Evaluated& mesh, ClusterRef ref, const auto& identity) {
		const bool mirrored = host.instances()[ref.instance].mirrored != 0;
		painter.shows_back = host.built().materials[host.cluster(ref).material].double_sided;
		for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
		{
			const uvec3 v = mesh.triangles[t];
			std::array<vec4, 3> clip = { mesh.vertices[v.x].clip, mesh.vertices[v.y].clip, mesh.vertices[v.z].clip };
			if (mirrored)
				std::swap(clip[0], clip[1]);
			painter.draw(clip, identity(t));
		}
	};
	for (const reference::ReferencePiece& part : frame.parts)
		draw(reference::evaluatePart(host, view, part), part.cluster, [&](uint32_t t) { return identityOf(part.cluster, part.piece, t); });
	for (const ClusterRef ref : frame.fullClusters())
		draw(reference::evaluateFullCluster(host, view, ref), ref, [&](uint32_t t) { return identityOf(ref, wholeTriangle(t), 0); });
	std::vector<ExpectedPixel> pixels(painter.pixels.size());
	std::transform(painter.pixels.begin(), painter.pixels.end(), pixels.begin(), decide);
	return pixels;
}

}  // namespace tessera::test
