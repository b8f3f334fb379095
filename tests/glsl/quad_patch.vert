// variants: NARROW
#version 460
// The corners of square patches in a row, `PATCHES_PER_INSTANCE` patches an instance. With NARROW the row is drawn small.

layout(constant_id = 0) const uint PATCHES_PER_INSTANCE = 1;
layout(constant_id = 1) const uint PATCHES = 1;

layout(location = 0) out vec2 corner;
layout(location = 1) out uint patch_id;

void main()
{
    patch_id = gl_InstanceIndex * PATCHES_PER_INSTANCE + gl_VertexIndex / 4;
    uint i = gl_VertexIndex % 4;
    vec2 unit = vec2((i + 1) / 2 % 2, i / 2);
    corner = vec2((patch_id + unit.x) / PATCHES, unit.y) * 2.0 - 1.0;
#ifdef NARROW
    corner *= 0.5;
#endif
}
