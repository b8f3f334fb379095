// The control vertices of a model. Each takes four numbers, of which the last is unused.
#ifndef POSITIONS_GLSL
#define POSITIONS_GLSL

#include "constants.glsl"

// Whether tables are read as texel buffers, as devices do that have large ones: otherwise as the storage buffers that they are, too.
// Rust twin: `DeviceProperties::reads_texels` in src/gpu/device.rs.
layout(constant_id = ID_READS_TEXELS) const bool READS_TEXELS = false;

#ifndef POSITIONS_ACCESS
#define POSITIONS_ACCESS readonly
#endif
layout(set = 1, binding = BINDING_POSITIONS, std430) POSITIONS_ACCESS buffer Positions { vec4 positions[]; };
#ifndef POSITION_TEXELS
#define POSITION_TEXELS BINDING_POSITION_TEXELS
#endif
layout(set = 1, binding = POSITION_TEXELS) uniform samplerBuffer position_texels;

vec3 vertex_position(uint vertex) {
    return READS_TEXELS ? texelFetch(position_texels, int(vertex)).xyz : positions[vertex].xyz;
}

#endif
