// Patches that cannot be seen. All tests are conservative: a picture is the same with and without.
//
// To be included where CORNERS and the `owned` control points are known, and where there are `outside` and `pixel_box` for what
// `examine` finds at each corner. HULL of a corner's control points enclose the patch, with those of the others; 0 if they need not.
// Rust twins: src/tessellator/culling.rs.
#ifndef CULLING_GLSL
#define CULLING_GLSL

#include "constants.glsl"
#include "edges/factors.glsl"


// What a corner's control points say of the patch.
struct Examined {
    uint outside;    // a bit for each plane that all of them are beyond
    vec4 pixel_box;  // the least and the largest x and y
    bool crosses;    // whether any may be beyond any plane
};

// How far displacement moves a point, at most, in world space.
float reach() {
    vec3 x = transform_row(0u).xyz, y = transform_row(1u).xyz, z = transform_row(2u).xyz;
    return sqrt(dot(x, x) + dot(y, y) + dot(z, z)) * item.displacement_reach;
}

vec4 clip_row(int i) {
    mat4 m = view.measured_view_projection;
    return vec4(m[0][i], m[1][i], m[2][i], m[3][i]);
}

#if HULL > 0
// How far before each plane the foremost of some points is, and the hindmost, in clip space: w + x, w + y, w - x, w - y; z, w - z. And
// the box around them in pixels.
struct Extents {
    vec4 sides, hind_sides;
    vec2 depths, hind_depths;
    vec4 box;
};

// Of no points yet.
Extents no_extents() {
    return Extents(vec4(-1e30), vec4(1e30), vec2(-1e30), vec2(1e30), vec4(1e30, 1e30, -1e30, -1e30));
}

void include_point(inout Extents extents, vec3 point) {
    vec4 clip = view.measured_view_projection * vec4(to_world(point), 1.0);
    vec4 before_sides = clip.w + vec4(clip.xy, -clip.xy);
    vec2 before_depths = vec2(clip.z, clip.w - clip.z);
    extents.sides = max(extents.sides, before_sides);
    extents.depths = max(extents.depths, before_depths);
    extents.hind_sides = min(extents.hind_sides, before_sides);
    extents.hind_depths = min(extents.hind_depths, before_depths);
    if ((DRAW_FLAGS & CULL_SMALL_FLAG) != 0u) {
        vec2 pixels = (0.5 + 0.5 * clip.xy / clip.w) * view.viewport.xy;
        extents.box = vec4(min(extents.box.xy, pixels), max(extents.box.zw, pixels));
        if (!(clip.w > view.viewport.z)) {
            // Not all of it is before the eye: as large as the picture.
            extents.box = vec4(-1e30, -1e30, 1e30, 1e30);
        }
    }
}

// What points say between which a patch lies.
Examined examined_points(Extents extents) {
    vec3 x = clip_row(0).xyz, y = clip_row(1).xyz, z = clip_row(2).xyz, w = clip_row(3).xyz;
    float margin = reach();
    vec4 side_margins = margin * vec4(length(w + x), length(w + y), length(w - x), length(w - y));
    vec2 depth_margins = margin * vec2(length(z), length(w - z));
    bvec4 beyond_sides = lessThan(extents.sides + side_margins, vec4(0.0));
    bvec2 beyond_depths = lessThan(extents.depths + depth_margins, vec2(0.0));
    bool within =
        all(greaterThan(extents.hind_sides, side_margins)) && all(greaterThan(extents.hind_depths, depth_margins));
    uvec4 bits = uvec4(beyond_sides) << uvec4(0u, 1u, 2u, 3u);
    uvec2 more = uvec2(beyond_depths) << uvec2(4u, 5u);
    return Examined(bits.x | bits.y | bits.z | bits.w | more.x | more.y, extents.box, !within);
}

Examined examine_points(vec3 points[HULL]) {
    Extents extents = no_extents();
    if ((DRAW_FLAGS & (CULL_FRUSTUM_FLAG | CULL_SMALL_FLAG)) == 0u) {
        return Examined(0u, extents.box, false);
    }
    for (int i = 0; i < HULL; ++i) {
        include_point(extents, points[i]);
    }
    return examined_points(extents);
}

// Of what a corner keeps of its control points.
Examined examine(vec3 kept[OWNED]) {
    vec3 points[HULL];
    for (int i = 0; i < HULL; ++i) {
        points[i] = i == 0 ? kept[0] : POINT_OF(kept, i);
    }
    return examine_points(points);
}

// Whether no pixel's centre lies within a box.
bool between_pixels(vec4 box) {
    // Vertices are moved to a grid of 1/256 of a pixel, or finer.
    const float SNAP = 1.0 / 128.0;
    vec2 low = ceil(box.xy - 0.5 - SNAP), high = floor(box.zw - 0.5 + SNAP);
    return low.x > high.x || low.y > high.y;
}

#ifndef TRIANGLE
// How long a vector is across the view, seen in any direction that leans by `lean` at most.
float extent(vec3 d, float lean) {
    return length(d.xy) + lean * abs(d.z);
}

// A tangent as the eye sees it: across the view, how long it is there, and how long with all that is not known of it.
vec4 tangent(vec3 d, float lean, float moved) {
    return vec4(d.xy, length(d.xy), extent(d, lean) + moved);
}

// One row of the differences along u, times their binomial coefficients.
mat3x4 along_u(vec3 row[4], float lean, vec3 moved) {
    return mat3x4(tangent(row[1] - row[0], lean, moved.x), 2.0 * tangent(row[2] - row[1], lean, moved.y),
                  tangent(row[3] - row[2], lean, moved.z));
}

// One of the differences along v, so that the dot product with one along u is at least what du x dv has towards the eye.
vec4 turned(vec3 d, float lean, float moved) {
    vec4 t = tangent(d, lean, moved);
    return vec4(t.y, -t.x, -t.z, t.w);
}

// Those between two rows of points, times their binomial coefficients.
mat4 along_v(vec3 row[4], vec3 next[4], float lean, vec4 moved) {
    return transpose(mat4(turned(next[0] - row[0], lean, moved.x), 3.0 * turned(next[1] - row[1], lean, moved.y),
                          3.0 * turned(next[2] - row[2], lean, moved.z), turned(next[3] - row[3], lean, moved.w)));
}

// How much the differences along u change from one row of points to the next, which is also how much those along v do.
vec3 twist(vec3 row[4], vec3 next[4], float lean) {
    vec3 a = next[0] - row[0], b = next[1] - row[1], c = next[2] - row[2], d = next[3] - row[3];
    return vec3(extent(b - a, lean), extent(c - b, lean), extent(d - c, lean));
}

// Three coefficients as four.
vec4 elevated(vec3 t) {
    return vec4(t.x, (t.x + 2.0 * t.y) / 3.0, (2.0 * t.y + t.z) / 3.0, t.z);
}

// Whether all coefficients of one row are below zero; the summands of coefficient i + k are in column i, row k.
bool below_zero(mat3x4 q) {
    float ends = max(q[0].x, q[2].w);
    float beside = max(q[0].y + q[1].x, q[1].w + q[2].z);
    float middle = max(q[0].z + q[1].y + q[2].x, q[0].w + q[1].z + q[2].y);
    return max(ends, max(beside, middle)) < 0.0;
}

// Whether all triangles of the patch face away from the eye, whose legs are at most `step` long in u and v: are seen clockwise, or
// counter-clockwise if those are to be culled.
//
// The normal of a bicubic patch is a Bezier patch of degree (5, 5); its coefficients are sums of cross products of the
// differences of control points along u and along v, and if all of them face away, so does the patch. (The convex hull of
// a patch of normals, as in Loop, Niessner and Eisenacher, Effective Back-Patch Culling for Hardware Tessellation, 2011, whose
// patch is that of tangent planes.) Points are turned so that the eye is on the z axis, and cross products have only what is
// towards it. What is not known of a tangent widens it:
// - Other points are seen in other directions, which lean by `lean` at most; that moves a tangent by that much of its depth.
// - The face point of a Gregory patch moves, by half the distance r of its ends, around their middle. As a function of u and
//   v, both differences that have it move by r at most, and as its weights change, too, those that have it and a point of an
//   edge by r / 2 more: a third of the derivative is 6 r (1 - u)^2 (1 - v)^2 v (uv / (u + v)^2), and the last factor is at
//   most 1 / 4.
// - The legs of a triangle are means of du and dv over the sides of a square. In its middle these are others, by half a
//   step times the twist of the patch. This is to the first order in `step`, and of triangles with legs along u and v.
bool faces_away(float step) {
    vec4 w = clip_row(3);
    // Displacement turns normals as it likes; a parallel projection has no eye.
    if (reach() > 0.0 || dot(w.xyz, w.xyz) == 0.0) {
        return false;
    }
    vec3 centre = 0.25 * ((owned[0][0] + owned[1][0]) + (owned[2][0] + owned[3][0]));
    vec3 to_eye = view.measured_eye.xyz - to_world(centre);
    float away = length(to_eye);
    vec3 z = to_eye / away;
    vec3 x = unit(abs(z.x) < 0.6 ? vec3(0.0, z.z, -z.y) : vec3(-z.z, 0.0, z.x));
    mat3 rows = mat3(transform_row(0u).xyz, transform_row(1u).xyz, transform_row(2u).xyz);
    bool is_mirrored = INSTANCES && (draw.flags & INSIDE_FLAG) != 0u && determinant(rows) < 0.0;
    // Where it is the others that are culled, cross products are seen in a mirror.
    vec3 y = ((draw.flags & COUNTER_CLOCKWISE_FLAG) != 0u) != is_mirrored ? cross(x, z) : cross(z, x);
    // Columns are what the axes are in object space; the rows of the transform are its matrix transposed.
    mat3 axes = rows * mat3(x, y, z);

    // Rows of control points, as seen from the centre.
#define AT(k, i) (CONTROL_POINT(k, i) - centre) * axes
    vec3 p0[4] = { (owned[0][0] - centre) * axes, AT(0, 1), AT(1, 2), (owned[1][0] - centre) * axes };
    vec3 p1[4] = { AT(0, 2), AT(0, 3), AT(1, 3), AT(1, 1) };
    vec3 p2[4] = { AT(3, 1), AT(3, 3), AT(2, 3), AT(2, 2) };
    vec3 p3[4] = { (owned[3][0] - centre) * axes, AT(3, 2), AT(2, 1), (owned[2][0] - centre) * axes };
    float squared = 0.0;
#ifdef TWO_FACE_POINTS
    vec3 others[4] = { AT(0, 4), AT(1, 4), AT(2, 4), AT(3, 4) };
    vec3 half_way[4] = { 0.5 * (others[0] - p1[1]), 0.5 * (others[1] - p1[2]), 0.5 * (others[2] - p2[2]),
                         0.5 * (others[3] - p2[1]) };
    for (int k = 0; k < 4; ++k) {
        squared = max(squared, dot(others[k], others[k]));
    }
#endif
#undef AT
    for (int i = 0; i < 4; ++i) {
        squared = max(squared, max(max(dot(p0[i], p0[i]), dot(p1[i], p1[i])), max(dot(p2[i], p2[i]), dot(p3[i], p3[i]))));
    }
    float size = sqrt(squared);
    // The eye is outside of the sphere around all of them.
    if (!(size < away)) {
        return false;
    }
    float lean = size / (away - size);
    vec4 moved = vec4(0.0);
#ifdef TWO_FACE_POINTS
    for (int k = 0; k < 4; ++k) {
        moved[k] = extent(half_way[k], lean);
    }
    p1[1] += half_way[0];
    p1[2] += half_way[1];
    p2[2] += half_way[2];
    p2[1] += half_way[3];
#endif
    vec3 t0 = 1.5 * step * twist(p0, p1, lean);
    vec3 t1 = 1.5 * step * twist(p1, p2, lean);
    vec3 t2 = 1.5 * step * twist(p2, p3, lean);
    vec3 moved1 = vec3(1.5 * moved.x, moved.x + moved.y, 1.5 * moved.y) + (t0 + 2.0 * t1) / 3.0;
    vec3 moved2 = vec3(1.5 * moved.w, moved.w + moved.z, 1.5 * moved.z) + (2.0 * t1 + t2) / 3.0;
    mat3x4 u0 = along_u(p0, lean, t0);
    mat3x4 u1 = 3.0 * along_u(p1, lean, moved1);
    mat3x4 u2 = 3.0 * along_u(p2, lean, moved2);
    mat3x4 u3 = along_u(p3, lean, t2);
    mat4 v0 = along_v(p0, p1, lean, vec4(0.0, 1.5 * moved.xy, 0.0) + elevated(t0));
    mat4 v1 = 2.0 * along_v(p1, p2, lean, vec4(0.0, moved.xy + moved.wz, 0.0) + elevated(t1));
    mat4 v2 = along_v(p2, p3, lean, vec4(0.0, 1.5 * moved.wz, 0.0) + elevated(t2));
    return below_zero(v0 * u0) && below_zero(v0 * u1 + v1 * u0) && below_zero(v0 * u2 + v1 * u1 + v2 * u0)
        && below_zero(v0 * u3 + v1 * u2 + v2 * u1) && below_zero(v1 * u3 + v2 * u2) && below_zero(v2 * u3);
}
#endif

// Whether the patch is culled, whose triangles are `step` long in its parameters at most.
bool is_culled(float step) {
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
    culled = culled || ((DRAW_FLAGS & CULL_BACK_FLAG) != 0u && faces_away(step));
#endif
    return culled;
}
#else
Examined examine(vec3 kept[OWNED]) {
    return Examined(0u, vec4(0.0), false);
}

bool is_culled(float step) {
    return false;
}
#endif

#endif
