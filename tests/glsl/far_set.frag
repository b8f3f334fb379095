// A texture in a set that no option names.
#version 460

layout(set = 2, binding = 0) uniform sampler2D own;
layout(location = 0) out vec4 color;

void main() {
    color = texture(own, vec2(0.5));
}
