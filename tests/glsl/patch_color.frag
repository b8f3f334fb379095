#version 460
// Colours that tell patches apart: red from the low bits of the patch id, green from the next, blue is full.

layout(location = 0) flat in uint shade_id;
layout(location = 0) out vec4 color;

void main()
{
    color = vec4((shade_id & 255) / 255.0, ((shade_id >> 8) & 255) / 255.0, 1.0, 1.0);
}
