// A caller's fragment shader for depth alone: half of what the texture coordinates span is cut out.
#version 460
layout(location = 2) in vec2 texcoord;

void main() {
    if (texcoord.x > 0.5) {
        discard;
    }
}
