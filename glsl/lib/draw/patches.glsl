// What the patches of a draw are. Rust twin: `PatchStages::specialization` in src/renderer/shader/key.rs.
#ifndef PATCHES_GLSL
#define PATCHES_GLSL

#include "constants.glsl"

// Of faces that are refined, triangles are wedges, each between an edge of a face other than a quad and the face's centre; by leaves,
// they are parts of leaves.
layout(constant_id = ID_ADAPTIVE) const uint PATCHES = NOT_ADAPTIVE;
const bool ADAPTIVE = PATCHES != NOT_ADAPTIVE;
const bool IS_BY_LEAVES = PATCHES == BY_LEAVES;

#endif
