// visibility.h: the visibility payload, 32 bits: which micro-triangle a pixel sees. Source: DESIGN.md, section 3.
#ifndef TESSERA_SHARED_VISIBILITY_H
#define TESSERA_SHARED_VISIBILITY_H
#include "shared/lang.h"

SHARED_BEGIN

#define KIND_FULL_CLUSTER 0u
#define KIND_PART_TRIANGLE 1u

//   bit 31 kind, bits 7-30 index into visible_clusters or part_triangles, bits 0-6 triangle within it
SHARED_FN uint packPayload(uint kind, uint index, uint triangle)
{
	return (kind << 31) | (index << 7) | triangle;
}
SHARED_FN uint payloadKind(uint payload)
{
	return payload >> 31;
}
SHARED_FN uint payloadIndex(uint payload)
{
	return (payload >> 7) & 0xffffffu;
}
SHARED_FN uint payloadTriangle(uint payload)
{
	return payload & 0x7fu;
}

SHARED_END

#endif
