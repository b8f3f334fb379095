// variants: TRIANGLES, ODD, EVEN
#version 460
#ifdef TRIANGLES
layout(triangles, equal_spacing) in;
#elif defined(ODD)
layout(quads, fractional_odd_spacing) in;
#elif defined(EVEN)
layout(quads, fractional_even_spacing) in;
#else
layout(quads, equal_spacing) in;
#endif

layout(location = 0) in vec2 patch_corner[];
layout(location = 1) patch in uint id;
layout(location = 0) flat out uint shade_id;

void main()
{
    vec2 uv = gl_TessCoord.xy;
    shade_id = id;
    vec2 low = mix(patch_corner[0], patch_corner[1], uv.x);
    vec2 high = mix(patch_corner[3], patch_corner[2], uv.x);
    gl_Position = vec4(mix(low, high, uv.y), 0.5, 1.0);
}
