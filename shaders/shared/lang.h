// lang.h: lets one header be read by GLSL and by C++20. Nothing else may test __cplusplus.
#ifndef TESSERA_SHARED_LANG_H
#define TESSERA_SHARED_LANG_H

#ifdef __cplusplus

#include "base/vec.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#define SHARED_BEGIN  \
	namespace tessera \
	{
#define SHARED_END }
#define SHARED_FN inline
#define precise              // the C++ side is compiled with -ffp-contract=off
#define GPU_PTR(T) uint64_t  // device address; 0 = absent. In the CPU reference: the address of host memory
#define AT(T, address, index) (reinterpret_cast<const T*>(address)[index])
// What a specialisation constant says in shaders, the address says here.
#define IS_GIVEN(address) ((address) != 0)
// A field of a height map. Shaders read the first ones from a uniform buffer (lib/frame_data.glsl).
#define HEIGHT_MAP(surface, index, field) (AT(HeightMap, (surface).height_maps, index).field)
#define SHARED_LAYOUT(T, size, last, offset) \
	static_assert(sizeof(T) == (size) && offsetof(T, last) == (offset), #T ": host and device layouts differ");

namespace tessera
{
using uint = uint32_t;
inline float uintBitsToFloat(uint bits)
{
	return std::bit_cast<float>(bits);
}
inline uint floatBitsToUint(float value)
{
	return std::bit_cast<uint>(value);
}
inline float floor(float value)
{
	return std::floor(value);
}
inline float min(float a, float b)
{
	return a < b ? a : b;
}
inline float max(float a, float b)
{
	return a < b ? b : a;
}
inline uint min(uint a, uint b)
{
	return a < b ? a : b;
}
inline uint max(uint a, uint b)
{
	return a < b ? b : a;
}
inline int min(int a, int b)
{
	return a < b ? a : b;
}
inline int max(int a, int b)
{
	return a < b ? b : a;
}
inline int bitCount(uint value)
{
	return std::popcount(value);
}
// The reference always has every code path; shaders compile out what the scene does not need.
inline constexpr bool HAS_DISPLACEMENT = true;
inline constexpr bool HAS_SEAMS = true;
inline constexpr bool HAS_PN = true;  // a surface says whether it is so (Surface::pn_directions)
inline constexpr bool HAS_HEIGHT_U8 = true;
inline constexpr bool HAS_HEIGHT_U16 = true;
inline constexpr bool HAS_HEIGHT_F32 = true;
inline constexpr bool HAS_WRAP_REPEAT = true;
inline constexpr bool HAS_WRAP_CLAMP = true;
inline constexpr bool HAS_WRAP_MIRROR = true;
inline constexpr bool HAS_HEIGHT_FOOTPRINTS = false;
inline constexpr bool HAS_DETAIL = true;
inline constexpr bool HAS_DISPLACED_EDGES = true;
inline constexpr bool HAS_RAY_FALLOFF = true;     // a view says whether anything falls off (View::unseen_growth)
inline constexpr bool HAS_HIDDEN_FALLOFF = true;  // a surface says whether it is so (Surface::hidden_instances)
}  // namespace tessera

#else

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_spirv_intrinsics : require

// Every shader rounds to nearest even and keeps signed zeros, infinities and NaNs in float32 (DESIGN.md, section 5).
spirv_execution_mode(capabilities = [4467], 4462, 32);  // RoundingModeRTE 32
spirv_execution_mode(capabilities = [4466], 4461, 32);  // SignedZeroInfNanPreserve 32

#define SHARED_BEGIN
#define SHARED_END
#define SHARED_FN
#define GPU_PTR(T) T##Ref
#define AT(T, address, index) ((address).at[index])
#define IS_GIVEN(address) true
#define HEIGHT_MAP(surface, index, field) (HAS_MANY_HEIGHT_MAPS ? (surface).height_maps.at[index].field : frame_height_maps[index].field)
// Every array begins on a 16-byte boundary: the host allocates them so.
#define SHARED_LAYOUT(T, size, last, offset)                                    \
	layout(buffer_reference, scalar, buffer_reference_align = 16) buffer T##Ref \
	{                                                                           \
		T at[];                                                                 \
	};

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer uintRef
{
	uint at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer floatRef
{
	float at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer vec2Ref
{
	vec2 at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer vec3Ref
{
	vec3 at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer vec4Ref
{
	vec4 at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer uvec2Ref
{
	uvec2 at[];
};

#endif

#endif
