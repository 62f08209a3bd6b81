// Times of the peer (vk_tessellated_clusters) that ours are compared with; bench/README.md says how they were measured.
#pragma once
#include "bench/csv.h"

namespace tessera::bench
{

struct PeerTime
{
	std::string scene;  // "sphere x16"
	uint32_t width_px = 0, height_px = 0;
	double px = 0;  // the peer's own pixels per segment
	double gpu_ms = 0;
	std::optional<double> micro_mtri;  // millions of micro-triangles; absent: not noted
	bool overflow = false;             // its buffers overflowed: triangles vanished
};

struct PeerTable
{
	std::string device;  // where the peer was measured
	std::vector<PeerTime> times;

	// nullptr: not measured.
	const PeerTime* find(std::string_view scene, uint32_t width_px, uint32_t height_px, double px) const;
};

// Columns device, scene, width, height, px, gpu_ms, micro_mtri, overflow (yes or no).
// Errors: BadInput with path, row and column (column missing, not a positive number, neither yes nor no).
Result<PeerTable> peerTable(const CsvTable& csv, std::string_view path);

// The peer's pixels per segment that mean equal work: it leaves the field of view out, so at 60 degrees its r is our 0.866 r.
// Nothing when `rate` is none of 8, 4, 2, 1 and 0.5 times that, to 0.5 %.
std::optional<double> peerPixels(double rate);

}  // namespace tessera::bench
