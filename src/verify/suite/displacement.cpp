// Height maps and factors from nothing to absurd.
#include "verify/suite/case.h"
#include "verify/suite/parts.h"

#include <limits>

namespace tessera::verify
{

namespace
{

constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

Case ballWith(std::string name, std::string what, std::function<Image()> image, float factor, float offset = 0)
{
	Case one = { "displacement", std::move(name), std::move(what) };
	one.scene = [image = std::move(image), factor, offset] {
		return parts::ball(2, image(), factor, offset);
	};
	return one;
}

Image bumps()
{
	return parts::noise(32, 32, TexelFormat::U8, 4);
}

Image constant(float height)
{
	return parts::heights(8, 8, TexelFormat::U8, [height](uint32_t, uint32_t) { return height; });
}

// Black, with single white texels.
Image spikes(uint32_t side)
{
	return parts::heights(side, side, TexelFormat::U8, [](uint32_t x, uint32_t y) { return x % 13 == 5 && y % 11 == 7 ? 1.0f : 0.0f; });
}

Image sized(uint32_t width, uint32_t height)
{
	return parts::noise(width, height, TexelFormat::U8, 9);
}

std::string isDisplaced(const CaseRun& run, bool wanted)
{
	return run.scene.traits.has_displacement == wanted ? "" : wanted ? "nothing is displaced" : "something is displaced";
}

void addFactors(std::vector<Case>& cases)
{
	Case none = ballWith("factor_0", "a height map times 0: drawn as if there were none", bumps, 0);
	none.also = [](const CaseRun& run) {
		return isDisplaced(run, false);
	};
	cases.push_back(none);
	cases.push_back(ballWith("factor_negative", "a height map times -0.3", bumps, -0.3f, 0.1f));
	Case large = ballWith("factor_1e4", "displacement 1e4 times the model", bumps, 1e4f);
	large.rates = { 8 };
	cases.push_back(large);
	Case huge = ballWith("factor_1e30", "displacement farther than squares of floats reach", bumps, 1e30f);
	huge.expected = refused(ExitCode::BadInput, "at most 2^60");
	cases.push_back(huge);
	Case tiny = ballWith("factor_1e-12", "displacement below a float's resolution of the surface", bumps, 1e-12f);
	cases.push_back(tiny);
	Case scaled = ballWith("scale_-100", "--displacement-scale -100", bumps, 0.1f);
	scaled.options.displacement_scale = -100;
	scaled.rates = { 8 };
	cases.push_back(scaled);
}

void addMaps(std::vector<Case>& cases)
{
	cases.push_back(ballWith(
		"spikes", "spikes of one texel", [] { return spikes(64); }, 0.5f));
	for (const auto& [width, height] : { std::pair(1u, 1u), std::pair(1u, 97u), std::pair(97u, 1u), std::pair(37u, 23u), std::pair(16384u, 1u) })
		cases.push_back(ballWith(
			fmt::format("map_{}x{}", width, height), "a map of odd sides", [width = width, height = height] { return sized(width, height); }, 0.1f));
	Case largest = ballWith(
		"map_16384x16384", "the largest map that is read", [] { return sized(16384, 16384); }, 0.1f);
	largest.quick = false;
	largest.needs = { 4ull << 30, 16ull << 30, false };
	largest.rates = { 8 };
	cases.push_back(largest);
	cases.push_back(ballWith(
		"constant_1", "a white map", [] { return constant(1); }, 0.2f));
	Case black = ballWith(
		"constant_0", "a black map and an offset", [] { return constant(0); }, 0.2f, -0.15f);
	cases.push_back(black);
	cases.push_back(ballWith(
		"sixteen_bits", "a map of 16 bits", [] { return parts::noise(33, 17, TexelFormat::U16, 8); }, 0.1f));
}

void addFloatMaps(std::vector<Case>& cases)
{
	cases.push_back(ballWith(
		"float_map", "a float map with heights from -5 to 5",
		[] { return parts::heights(19, 21, TexelFormat::F32, [](uint32_t x, uint32_t y) { return float(x * 7 % 11) - 5 + 0.01f * float(y); }); },
		0.05f));
	for (const auto& [name, value] :
		 { std::pair("float_map_nan", kNan), std::pair("float_map_infinite", kInfinity), std::pair("float_map_negative_infinite", -kInfinity) })
		cases.push_back(ballWith(
			name, "a float map in which some texels are no numbers, which count as 0",
			[value = value] {
				return parts::heights(16, 16, TexelFormat::F32, [value](uint32_t x, uint32_t y) { return (x + y) % 5 == 0 ? value : float(x) / 16; });
			},
			0.1f));
	Case huge = ballWith(
		"float_map_1e35", "a float map with heights that leave the range of squares",
		[] { return parts::heights(8, 8, TexelFormat::F32, [](uint32_t x, uint32_t) { return x == 3 ? 1e35f : 0.0f; }); }, 0.1f);
	huge.expected = refused(ExitCode::BadInput, "at most 2^60");
	cases.push_back(huge);
}

// The same map repeated, clamped and mirrored, with coordinates beyond its borders.
void addWraps(std::vector<Case>& cases)
{
	for (const auto& [name, wrap] : { std::pair("wrap_clamp", Wrap::ClampToEdge), std::pair("wrap_mirror", Wrap::MirroredRepeat) })
	{
		Case one = ballWith(name, "coordinates from -3 to 4", bumps, 0.1f);
		one.scene = [wrap = wrap] {
			ImportedScene scene = parts::ball(2, bumps(), 0.1f);
			scene.textures[0].wrap_u = scene.textures[0].wrap_v = wrap;
			for (vec2& uv : scene.meshes[0].primitives[0].texcoords[0])
				uv = uv * 7.0f - vec2(3);
			return scene;
		};
		cases.push_back(one);
	}
}

}  // namespace

void addDisplacementCases(std::vector<Case>& cases)
{
	addFactors(cases);
	addMaps(cases);
	addFloatMaps(cases);
	addWraps(cases);
}

}  // namespace tessera::verify
