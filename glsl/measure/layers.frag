// Counts what covers a pixel: red the triangles that face the eye, green those that face away, each by 1/255.
#version 460

layout(location = 0) out vec4 colour;

void main() {
    colour = gl_FrontFacing ? vec4(1.0 / 255.0, 0.0, 0.0, 0.0) : vec4(0.0, 1.0 / 255.0, 0.0, 0.0);
}
