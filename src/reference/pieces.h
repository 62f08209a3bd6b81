// Part and split triangles by identity, so that lists of the host and of the device can be compared: their order is free.
#pragma once
#include "shared/geometry.h"

#include <array>
#include <compare>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tessera::reference
{

// A part or split triangle. piece.visible_cluster is the index of `cluster` in the list of visible clusters it was made from; it
// does not belong to the identity.
struct ReferencePiece
{
	ClusterRef cluster;
	DomainPiece piece;
};

// The identity: instance, cluster, triangle, corners in pattern order, factors, mirror. Sorts by instance, cluster, triangle.
struct PieceKey
{
	std::array<uint32_t, 9> words;

	auto operator<=>(const PieceKey&) const = default;
};
PieceKey keyOf(const ReferencePiece& piece);
std::string describe(const ReferencePiece& piece);

// Sorts by identity.
void sortPieces(std::vector<ReferencePiece>& pieces);

// What the device's records stand for, sorted by identity. A record whose visible cluster is out of range gets cluster NO_INDEX
// of instance NO_INDEX, which no expected piece has.
std::vector<ReferencePiece> canonicalPieces(std::span<const DomainTriangle> records, std::span<const ClusterRef> visible);

// The clusters behind the device's full_clusters (indices of visible clusters), sorted; out of range as above.
std::vector<ClusterRef> canonicalClusters(std::span<const uint32_t> indices, std::span<const ClusterRef> visible);

// Nothing when both hold the same (in any order, repeats counted); else a line with how many are missing and unexpected, and
// the first of each.
std::optional<std::string> firstDifference(std::span<const ReferencePiece> expected, std::span<const ReferencePiece> actual);
std::optional<std::string> firstDifference(std::span<const ClusterRef> expected, std::span<const ClusterRef> actual);

}  // namespace tessera::reference
