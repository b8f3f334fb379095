// Conversion by the geometry shader: a point for each corner of each patch, which says which corner it is.
#version 460

layout(location = 0) out uint corner_number;

void main() {
    corner_number = uint(gl_VertexIndex);
}
