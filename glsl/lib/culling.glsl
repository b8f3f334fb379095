// Patches that cannot be seen. All tests are conservative: a picture is the same with and without.
//
// To be included where HULL of the control points that a corner owns are known to enclose the patch together.
#ifndef CULLING_GLSL
#define CULLING_GLSL

#include "factors.glsl"

// What a corner's control points say of the patch, for the first invocation to put together.
layout(location = 28) out uint outside[];      // a bit for each plane that all of them are beyond
layout(location = 29) out vec4 pixel_box[];    // the least and the largest x and y

// How far displacement moves a point, at most, in world space.
float reach() {
    float scale = sqrt(dot(draw.transform[0].xyz, draw.transform[0].xyz)
                       + dot(draw.transform[1].xyz, draw.transform[1].xyz)
                       + dot(draw.transform[2].xyz, draw.transform[2].xyz));
    return scale * unpackHalf2x16(draw.flags).y;
}

vec4 clip_row(int i) {
    mat4 m = view.measured_view_projection;
    return vec4(m[0][i], m[1][i], m[2][i], m[3][i]);
}

#if HULL > 0
// Writes what the control points of this corner say.
void examine_corner() {
    if ((DRAW_FLAGS & (CULL_FRUSTUM_FLAG | CULL_SMALL_FLAG)) == 0u) {
        return;
    }
    float margin = reach();
    vec4 w = clip_row(3);
    vec4 planes[6] = { w + clip_row(0), w - clip_row(0), w + clip_row(1), w - clip_row(1), clip_row(2), w - clip_row(2) };
    uint beyond = 63u;
    vec4 box = vec4(1e30, 1e30, -1e30, -1e30);
    for (int i = 0; i < HULL; ++i) {
        vec4 at = vec4(to_world(i == 0 ? owned[gl_InvocationID][0] : CONTROL_POINT(gl_InvocationID, i)), 1.0);
        for (int plane = 0; plane < 6; ++plane) {
            if (dot(planes[plane], at) + margin * length(planes[plane].xyz) >= 0.0) {
                beyond &= ~(1u << plane);
            }
        }
        vec4 clip = view.measured_view_projection * at;
        vec2 pixels = (0.5 + 0.5 * clip.xy / clip.w) * view.viewport.xy;
        box = vec4(min(box.xy, pixels), max(box.zw, pixels));
        if (!(clip.w > view.viewport.z)) {
            // Not all of it is before the eye: as large as the picture.
            box = vec4(-1e30, -1e30, 1e30, 1e30);
        }
    }
    outside[gl_InvocationID] = beyond;
    pixel_box[gl_InvocationID] = box;
}

// Whether no pixel's centre lies within a box.
bool between_pixels(vec4 box) {
    // Vertices are moved to a grid of 1/256 of a pixel, or finer.
    const float SNAP = 1.0 / 128.0;
    vec2 low = ceil(box.xy - 0.5 - SNAP), high = floor(box.zw - 0.5 + SNAP);
    return low.x > high.x || low.y > high.y;
}

#ifndef TRIANGLE
// A cone of directions: an axis of length one and the sine of the angle to it; above 1 for all directions.
struct Cone {
    vec3 axis;
    float sine;
};

// Around differences of control points that are each right to `radius`.
Cone cone_around(vec3 d[12], float radius) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 12; ++i) {
        sum += d[i];
    }
    vec3 axis = unit(sum);
    float least = 1.0;
    for (int i = 0; i < 12; ++i) {
        least = min(least, (dot(d[i], axis) - radius) / (length(d[i]) + radius));
    }
    return Cone(axis, least > 0.0 ? sqrt(max(1.0 - least * least, 0.0)) : 2.0);
}

// Whether every point of the patch faces away from the eye: normals are within a cone that those of the tangents span
// (Sederberg and Meyers, Loop detection in surface patch intersections, 1988).
bool faces_away() {
    vec4 w = clip_row(3);
    // Displacement turns normals as it likes; a parallel projection has no eye.
    if (reach() > 0.0 || dot(w.xyz, w.xyz) == 0.0) {
        return false;
    }
    vec3 p[4], plus[4], minus[4], inner[4];
    float radius = 0.0;
    vec3 centre = vec3(0.0);
    for (int k = 0; k < 4; ++k) {
        p[k] = to_world(owned[k][0]);
        plus[k] = to_world(CONTROL_POINT(k, 1));
        minus[k] = to_world(CONTROL_POINT(k, 2));
        inner[k] = to_world(CONTROL_POINT(k, 3));
#if HULL == 5
        // The face point moves between two, and by that turns the tangents, too: by less than a third of their distance.
        vec3 other = to_world(CONTROL_POINT(k, 4));
        radius = max(radius, 1.3 * length(inner[k] - other));
        inner[k] = 0.5 * (inner[k] + other);
#endif
        centre += 0.25 * p[k];
    }
    vec3 du[12] = { plus[0] - p[0], minus[1] - plus[0], p[1] - minus[1],               //
                    inner[0] - minus[0], inner[1] - inner[0], plus[1] - inner[1],      //
                    inner[3] - plus[3], inner[2] - inner[3], minus[2] - inner[2],      //
                    minus[3] - p[3], plus[2] - minus[3], p[2] - plus[2] };
    vec3 dv[12] = { minus[0] - p[0], plus[3] - minus[0], p[3] - plus[3],               //
                    inner[0] - plus[0], inner[3] - inner[0], minus[3] - inner[3],      //
                    inner[1] - minus[1], inner[2] - inner[1], plus[2] - inner[2],      //
                    plus[1] - p[1], minus[2] - plus[1], p[2] - minus[2] };
    Cone u = cone_around(du, radius), v = cone_around(dv, radius);
    vec3 normal = cross(u.axis, v.axis);
    float squared = dot(normal, normal);
    float sine = sqrt((u.sine * u.sine + 2.0 * u.sine * v.sine * abs(dot(u.axis, v.axis)) + v.sine * v.sine)
                      / max(squared, 1e-20));
    float size = 0.0;
    for (int k = 0; k < 4; ++k) {
        size = max(max(size, length(p[k] - centre)), max(length(plus[k] - centre), length(minus[k] - centre)));
        size = max(size, length(inner[k] - centre) + radius);
    }
    vec3 to_eye = view.measured_eye.xyz - centre;
    float spread = size / max(length(to_eye), 1e-20);
    if (sine >= 1.0 || spread >= 1.0) {
        return false;
    }
    float cosine = dot(normal, to_eye) / (sqrt(squared) * length(to_eye));
    // The sum of both angles.
    return cosine < -(sine * sqrt(1.0 - spread * spread) + spread * sqrt(1.0 - sine * sine));
}
#endif

// Whether the patch can be left out.
bool is_culled() {
    uint beyond = outside[0] & outside[1] & outside[2];
    vec4 box = vec4(min(min(pixel_box[0].xy, pixel_box[1].xy), pixel_box[2].xy),
                    max(max(pixel_box[0].zw, pixel_box[1].zw), pixel_box[2].zw));
#ifndef TRIANGLE
    beyond &= outside[3];
    box = vec4(min(box.xy, pixel_box[3].xy), max(box.zw, pixel_box[3].zw));
#endif
    bool culled = (DRAW_FLAGS & CULL_FRUSTUM_FLAG) != 0u && beyond != 0u;
    culled = culled || ((DRAW_FLAGS & CULL_SMALL_FLAG) != 0u && reach() == 0.0 && between_pixels(box));
#ifndef TRIANGLE
    culled = culled || ((DRAW_FLAGS & CULL_BACK_FLAG) != 0u && faces_away());
#endif
    return culled;
}
#else
void examine_corner() {
}

bool is_culled() {
    return false;
}
#endif

#endif
