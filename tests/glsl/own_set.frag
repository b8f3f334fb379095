// A texture where the crate has a buffer.
#version 460

layout(set = 0, binding = 1) uniform sampler2D own;
layout(location = 0) out vec4 color;

void main() {
    color = texture(own, vec2(0.5));
}
