#include "verify/screen.h"

#include <algorithm>
#include <cmath>

namespace tessera::verify
{

namespace
{

bool isFinite(vec3 p)
{
	return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

// First pixel and the one after the last that [low, high] touches.
std::pair<uint32_t, uint32_t> pixelRange(double low, double high, uint32_t size)
{
	const double first = std::clamp(std::floor(low - 1), 0.0, double(size)), end = std::clamp(std::ceil(high + 1), 0.0, double(size));
	return { uint32_t(first), uint32_t(std::max(first, end)) };
}

}  // namespace

Screen::Screen(const reference::HostScene& scene, const View& view) : scene_(scene), view_(view), eye_(dvec3(view.eye_high) + dvec3(view.eye_low)) {}

dvec4 Screen::clipOf(uint32_t instance, vec3 displaced) const
{
	const dvec3 world = scene_.built().instances[instance].world * dvec4(displaced, 1);
	const dvec3 relative = (world - eye_) * double(view_.unit);
	const double depth = glm::dot(dvec3(view_.forward), relative);
	return { glm::dot(dvec3(view_.right), relative) * double(view_.focal_x), -glm::dot(dvec3(view_.up), relative) * double(view_.focal_y),
			 depth * double(view_.depth_slope) + double(view_.depth_offset), depth * double(view_.w_slope) + double(view_.w_offset) };
}

ScreenPoint Screen::onScreen(const dvec4& clip) const
{
	return { (clip.x / clip.w * 0.5 + 0.5) * view_.width_px, (clip.y / clip.w * 0.5 + 0.5) * view_.height_px, clip.z / clip.w };
}

bool Screen::shows(const MicroTriangle& t, const std::array<ScreenPoint, 3>& points) const
{
	const double area = screenArea(points);
	const bool mirrored = scene_.instances()[t.cluster.instance].mirrored != 0;
	const bool front = mirrored ? area > 0 : area < 0;
	return area != 0 && (front || scene_.built().materials[scene_.cluster(t.cluster).material].double_sided);
}

bool Screen::project(const MicroTriangle& t, std::array<ScreenPoint, 3>& points) const
{
	for (uint32_t i = 0; i < 3; ++i)
	{
		if (!isFinite(t.displaced[i]))
			return false;
		const dvec4 clip = clipOf(t.cluster.instance, t.displaced[i]);
		if (!(clip.z < clip.w))
			return false;
		points[i] = onScreen(clip);
	}
	return true;
}

std::vector<ScreenPoint> Screen::clipped(const MicroTriangle& t) const
{
	std::array<dvec4, 3> clip;
	for (uint32_t i = 0; i < 3; ++i)
	{
		if (!isFinite(t.displaced[i]))
			return {};
		clip[i] = clipOf(t.cluster.instance, t.displaced[i]);
	}
	std::vector<ScreenPoint> polygon;
	for (uint32_t i = 0; i < 3; ++i)
	{
		const dvec4 &from = clip[i], &to = clip[(i + 1) % 3];
		const double inside_from = from.w - from.z, inside_to = to.w - to.z;
		if (inside_from > 0)
			polygon.push_back(onScreen(from));
		if ((inside_from > 0) != (inside_to > 0))
			polygon.push_back(onScreen(from + (to - from) * (inside_from / (inside_from - inside_to))));
	}
	return polygon;
}

double Screen::pixelsPerUnit(uint32_t instance, vec3 displaced) const
{
	const dvec4 clip = clipOf(instance, displaced);
	const double per_scaled = double(view_.focal_y) * view_.height_px * 0.5 * double(view_.unit);
	return clip.w > 0 ? per_scaled / std::max(clip.w, view_.w_slope != 0 ? double(view_.near) : 0.0) : 0;
}

PixelBox pixelBox(const std::array<ScreenPoint, 3>& p, uint32_t width_px, uint32_t height_px)
{
	const auto [x0, x1] = pixelRange(std::min({ p[0].x, p[1].x, p[2].x }), std::max({ p[0].x, p[1].x, p[2].x }), width_px);
	const auto [y0, y1] = pixelRange(std::min({ p[0].y, p[1].y, p[2].y }), std::max({ p[0].y, p[1].y, p[2].y }), height_px);
	return { x0, x1, y0, y1 };
}

double screenArea(const std::array<ScreenPoint, 3>& p)
{
	return (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
}

}  // namespace tessera::verify
