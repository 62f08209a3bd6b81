#include "verify/picture.h"

#include "shared/visibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace tessera::verify
{

namespace
{

Identity identityOf(ClusterRef ref, uint32_t triangle, const std::array<DomainPoint, 3>& piece, uint32_t micro)
{
	return { { ref.instance, ref.cluster, triangle, piece[0].u, piece[0].v, piece[1].u, piece[1].v, piece[2].u, piece[2].v, micro } };
}

// An index that points nowhere becomes an identity that nothing has.
Identity resolve(const FrameDump& lists, const SceneOrder& order, uint32_t payload)
{
	const uint32_t index = payloadIndex(payload), triangle = payloadTriangle(payload);
	const std::array<DomainPoint, 3> whole = { domainCorner(0), domainCorner(1), domainCorner(2) };
	if (payloadKind(payload) == KIND_FULL_CLUSTER && index < lists.visible.size())
		return identityOf(order(lists.visible[index]), triangle, whole, 0);
	if (payloadKind(payload) == KIND_PART_TRIANGLE && index < lists.parts.size())
	{
		const DomainPiece& part = lists.parts[index];
		return identityOf(order(lists.visible[part.visible_cluster]), part.triangle, { part.c0, part.c1, part.c2 }, triangle);
	}
	return identityOf({ NO_INDEX, NO_INDEX }, NO_INDEX, whole, payload);
}

}  // namespace

Identity identityOf(const MicroTriangle& t)
{
	return identityOf(t.cluster, t.triangle, t.piece, t.micro);
}

std::string describe(const Identity& identity)
{
	const auto& w = identity.words;
	return fmt::format("instance {} cluster {} triangle {} part ({}, {}) ({}, {}) ({}, {}) micro {}", w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7],
					   w[8], w[9]);
}

uint64_t VisiblePicture::covered() const
{
	return uint64_t(std::count_if(pixels.begin(), pixels.end(), [](const VisiblePixel& pixel) { return pixel.covered(); }));
}

void addRound(const FrameDump& lists, const SceneOrder& order, std::span<const uint64_t> words, VisiblePicture& picture)
{
	picture.pixels.resize(words.size());
	for (size_t i = 0; i < words.size(); ++i)
	{
		const auto payload = static_cast<uint32_t>(words[i]);
		// NO_INDEX: what an earlier round drew is still the nearest.
		if (words[i] != 0 && payload != NO_INDEX)
			picture.pixels[i] = { std::bit_cast<float>(static_cast<uint32_t>(words[i] >> 32)), resolve(lists, order, payload) };
	}
}

CheckResult comparePictures(const VisiblePicture& expected, const VisiblePicture& found, const std::string& what, double depth_room)
{
	CheckResult result;
	result.sums["pixels compared"] = expected.pixels.size();
	if (expected.pixels.size() != found.pixels.size())
		result.violation(1, nowhere(fmt::format("{}: {} pixels, not {}", what, found.pixels.size(), expected.pixels.size())));
	for (size_t i = 0; i < std::min(expected.pixels.size(), found.pixels.size()); ++i)
	{
		const VisiblePixel &a = expected.pixels[i], &b = found.pixels[i];
		const bool same_depth = std::abs(double(a.depth) - double(b.depth)) <= depth_room * double(a.depth);
		if (same_depth && a.identity == b.identity)
			continue;
		if (same_depth)
		{
			++result.sums["ties"];
			continue;
		}
		const VisiblePixel& nearer = a.depth > b.depth ? a : b;
		const std::string sees = a.covered() && b.covered() ? "something else" : a.covered() ? "nothing" : "something";
		Place place = { nearer.identity.cluster(), nearer.identity.triangle(), { nearer.identity.words[3], nearer.identity.words[4] } };
		place.what = fmt::format("{}: pixel {}, {} sees {}", what, i % expected.width_px, i / expected.width_px, sees);
		place.pixel = static_cast<uint32_t>(i);
		result.violation(std::abs(double(a.depth) - double(b.depth)) / double(nearer.depth), place);
	}
	return result;
}

}  // namespace tessera::verify
