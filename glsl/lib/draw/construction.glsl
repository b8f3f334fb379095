// The construction of the control points. Rust twin: `PatchStages::specialization` in src/renderer/shader/key.rs.
#ifndef CONSTRUCTION_GLSL
#define CONSTRUCTION_GLSL

const uint TWO_STAGE = 0u, STENCIL = 1u, CACHED = 2u;
layout(constant_id = 12) const uint CONSTRUCTION = TWO_STAGE;

#define IS_CACHED (CONSTRUCTION == CACHED)

#endif
