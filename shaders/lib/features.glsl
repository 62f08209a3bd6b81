// What the scene and the options need: specialisation constants, so that the rest is not compiled in (DESIGN.md, C5).
// Ids and reasons: src/plan/features.cpp.
#ifndef TESSERA_LIB_FEATURES
#define TESSERA_LIB_FEATURES

layout(constant_id = 1) const bool HAS_DISPLACEMENT = true;
layout(constant_id = 2) const bool HAS_SEAMS = true;
layout(constant_id = 3) const bool HAS_TESSELLATION = true;
layout(constant_id = 4) const bool HAS_COLOR_TEXTURES = true;
layout(constant_id = 5) const bool HAS_VERTEX_COLORS = true;
layout(constant_id = 6) const bool HAS_SMOOTH_NORMALS = true;
layout(constant_id = 7) const bool HAS_CULLING = true;
layout(constant_id = 8) const bool HAS_MIXED_SIDES = true;
layout(constant_id = 42) const bool SIDES_IN_FRAGMENTS = false;
layout(constant_id = 9) const bool HAS_MIRRORED_INSTANCES = true;
layout(constant_id = 10) const bool HAS_SINGLE_SIDED = true;
layout(constant_id = 11) const bool IS_SHADED_VIEW = true;
layout(constant_id = 12) const bool KEEPS_VERTICES = true;
layout(constant_id = 13) const bool EXPANDS_TRIANGLES = true;
layout(constant_id = 15) const bool HAS_HEIGHT_U8 = true;
layout(constant_id = 16) const bool HAS_HEIGHT_U16 = true;
layout(constant_id = 17) const bool HAS_HEIGHT_F32 = true;
layout(constant_id = 18) const bool HAS_WRAP_REPEAT = true;
layout(constant_id = 19) const bool HAS_WRAP_CLAMP = true;
layout(constant_id = 20) const bool HAS_WRAP_MIRROR = true;
layout(constant_id = 21) const bool HAS_MANY_HEIGHT_MAPS = true;
layout(constant_id = 22) const bool DIRECTIONS_ARE_NORMALS = false;
layout(constant_id = 23) const bool HAS_OCCLUSION = true;
layout(constant_id = 41) const bool SMALL_FIRST = false;
layout(constant_id = 40) const bool HAS_HEIGHT_FOOTPRINTS = false;
layout(constant_id = 28) const bool HAS_PN = true;
layout(constant_id = 30) const bool HAS_DETAIL = true;
layout(constant_id = 31) const bool HAS_DISPLACED_EDGES = true;
layout(constant_id = 53) const bool HAS_RAY_FALLOFF = false;
layout(constant_id = 54) const bool HAS_HIDDEN_FALLOFF = false;
layout(constant_id = 14) const bool READS_BUFFER = true;
layout(constant_id = 24) const bool HAS_RAYS = true;
layout(constant_id = 27) const bool KEEPS_PLACES = false;
layout(constant_id = 55) const bool SHARES_STRUCTURES = false;
layout(constant_id = 50) const bool BUILDS_CLUSTERS = false;
layout(constant_id = 51) const bool HAS_TRANSIENT_UNITS = true;
layout(constant_id = 52) const bool HAS_TRANSIENT_GROUPS = true;
layout(constant_id = 25) const bool HAS_SHADOWS = true;
layout(constant_id = 26) const bool HAS_AMBIENT_OCCLUSION = true;

#endif
