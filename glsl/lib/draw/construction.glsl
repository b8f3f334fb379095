// The construction of the control points. Rust twin: `PatchStages::specialization` in src/renderer/shader/key.rs.
#ifndef CONSTRUCTION_GLSL
#define CONSTRUCTION_GLSL

#include "constants.glsl"

layout(constant_id = ID_CONSTRUCTION) const uint CONSTRUCTION = TWO_STAGE;

#define IS_CACHED (CONSTRUCTION == CACHED)

#endif
