// A caller's fragment shader: the texture coordinate as a colour.
#version 460
layout(location = 2) in vec2 texcoord;
layout(location = 0) out vec4 colour;

void main() {
    colour = vec4(texcoord, 0.0, 1.0);
}
