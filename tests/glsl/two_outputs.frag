// A caller's fragment shader for two attachments: red and blue.
#version 460
layout(location = 0) out vec4 first;
layout(location = 1) out vec4 second;

void main() {
    first = vec4(1.0, 0.0, 0.0, 1.0);
    second = vec4(0.0, 0.0, 1.0, 1.0);
}
