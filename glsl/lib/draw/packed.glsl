// Numbers that a stage hands on to the next, without gaps in rows of four: that is what stages hand on at a time, and drivers take time
// for each. `at` counts numbers, and is known when the shader is compiled.
#ifndef PACKED_GLSL
#define PACKED_GLSL

#define PACKED_ROWS(numbers) ((numbers + 3) / 4)
#define PACKED_NUMBER(rows, at) rows[(at) / 4][(at) % 4]
#define PACKED_PAIR(rows, at) vec2(PACKED_NUMBER(rows, at), PACKED_NUMBER(rows, (at) + 1))
#define PACKED_VECTOR(rows, at) \
    vec3(PACKED_NUMBER(rows, at), PACKED_NUMBER(rows, (at) + 1), PACKED_NUMBER(rows, (at) + 2))

// Puts vectors where they are to be among some numbers; then, row i of them.
#define PUT_PAIR(numbers, at, pair) numbers[at] = (pair).x, numbers[(at) + 1] = (pair).y
#define PUT_VECTOR(numbers, at, vector) \
    numbers[at] = (vector).x, numbers[(at) + 1] = (vector).y, numbers[(at) + 2] = (vector).z
#define ROW_OF(numbers, i) vec4(numbers[4 * (i)], numbers[4 * (i) + 1], numbers[4 * (i) + 2], numbers[4 * (i) + 3])

#endif
