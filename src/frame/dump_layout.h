// How the buffer that dump_micro writes is divided.
#pragma once
#include "raster/dump_micro.h"

#include <cstdint>

namespace tessera
{

// What micro_dump holds, and where in its buffer, in bytes.
struct DumpLayout
{
	uint32_t items, vertices, triangles;  // most of each

	static constexpr uint64_t aligned(uint64_t bytes) { return (bytes + 15) / 16 * 16; }
	constexpr uint64_t firstItem() const { return aligned(sizeof(DumpHead)); }
	constexpr uint64_t firstVertex() const { return firstItem() + items * sizeof(DumpItem); }
	constexpr uint64_t firstTriangle() const { return aligned(firstVertex() + vertices * sizeof(DumpVertex)); }
	constexpr uint64_t bytes() const { return firstTriangle() + triangles * sizeof(DumpTriangle); }
};
// Before a frame has shown how many it takes.
inline constexpr DumpLayout kFirstDump = { 1024, 1 << 16, 1 << 17 };

}  // namespace tessera
