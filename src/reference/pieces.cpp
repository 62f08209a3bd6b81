#include "reference/pieces.h"

#include <fmt/format.h>

#include <algorithm>

namespace tessera::reference
{

namespace
{

using ClusterKey = std::array<uint32_t, 2>;

ClusterKey keyOf(ClusterRef ref)
{
	return { ref.instance, ref.cluster };
}

std::string describe(ClusterRef ref)
{
	return fmt::format("instance {} cluster {}", ref.instance, ref.cluster);
}

ClusterRef refAt(std::span<const ClusterRef> visible, uint32_t index)
{
	return index < visible.size() ? visible[index] : ClusterRef{ NO_INDEX, NO_INDEX };
}

// Items with their keys, sorted.
template <typename Key, typename T>
std::vector<std::pair<Key, const T*>> sortedByKey(std::span<const T> items)
{
	std::vector<std::pair<Key, const T*>> sorted;
	sorted.reserve(items.size());
	for (const T& item : items)
		sorted.emplace_back(keyOf(item), &item);
	std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
	return sorted;
}

template <typename Key, typename T>
std::optional<std::string> difference(std::span<const T> expected, std::span<const T> actual)
{
	const auto wanted = sortedByKey<Key>(expected);
	const auto found = sortedByKey<Key>(actual);
	std::vector<const T*> missing, unexpected;
	size_t i = 0, j = 0;
	while (i < wanted.size() || j < found.size())
	{
		if (j == found.size() || (i < wanted.size() && wanted[i].first < found[j].first))
			missing.push_back(wanted[i++].second);
		else if (i == wanted.size() || found[j].first < wanted[i].first)
			unexpected.push_back(found[j++].second);
		else
			++i, ++j;
	}
	if (missing.empty() && unexpected.empty())
		return std::nullopt;
	std::string text =
		fmt::format("{} expected, {} found; {} missing, {} unexpected", wanted.size(), found.size(), missing.size(), unexpected.size());
	if (!missing.empty())
		text += "; missing: " + describe(*missing[0]);
	if (!unexpected.empty())
		text += "; unexpected: " + describe(*unexpected[0]);
	return text;
}

}  // namespace

PieceKey keyOf(const ReferencePiece& reference)
{
	DomainPiece piece = reference.piece;
	piece.visible_cluster = 0;
	const DomainTriangle t = packTriangle(piece);
	return { { reference.cluster.instance, reference.cluster.cluster, piece.triangle, t.words[0], t.words[1], t.words[2], t.words[3], t.words[4],
			   t.words[5] } };
}

std::string describe(const ReferencePiece& reference)
{
	const DomainPiece& p = reference.piece;
	return fmt::format("{} triangle {} corners ({}, {}) ({}, {}) ({}, {}) factors {} {} {} mirror {}", describe(reference.cluster), p.triangle,
					   p.c0.u, p.c0.v, p.c1.u, p.c1.v, p.c2.u, p.c2.v, p.a, p.b, p.c, p.mirror);
}

void sortPieces(std::vector<ReferencePiece>& pieces)
{
	const auto sorted = sortedByKey<PieceKey>(std::span<const ReferencePiece>(pieces));
	std::vector<ReferencePiece> result;
	result.reserve(pieces.size());
	for (const auto& [key, piece] : sorted)
		result.push_back(*piece);
	pieces = std::move(result);
}

std::vector<ReferencePiece> canonicalPieces(std::span<const DomainTriangle> records, std::span<const ClusterRef> visible)
{
	std::vector<ReferencePiece> pieces;
	pieces.reserve(records.size());
	for (const DomainTriangle& record : records)
	{
		const DomainPiece piece = unpackTriangle(record);
		pieces.push_back({ refAt(visible, piece.visible_cluster), piece });
	}
	sortPieces(pieces);
	return pieces;
}

std::vector<ClusterRef> canonicalClusters(std::span<const uint32_t> indices, std::span<const ClusterRef> visible)
{
	std::vector<ClusterRef> refs;
	refs.reserve(indices.size());
	for (const uint32_t index : indices)
		refs.push_back(refAt(visible, index));
	std::sort(refs.begin(), refs.end(), [](ClusterRef a, ClusterRef b) { return keyOf(a) < keyOf(b); });
	return refs;
}

std::optional<std::string> firstDifference(std::span<const ReferencePiece> expected, std::span<const ReferencePiece> actual)
{
	return difference<PieceKey>(expected, actual);
}

std::optional<std::string> firstDifference(std::span<const ClusterRef> expected, std::span<const ClusterRef> actual)
{
	return difference<ClusterKey>(expected, actual);
}

}  // namespace tessera::reference
