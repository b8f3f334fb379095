// Faces that are refined where they have to be: a quadtree over (u, v), whose leaves are bicubic B-spline patches, with a crease
// along one edge or without, and Gregory patches. Rust twins: src/adaptive/evaluate.rs, src/adaptive/crease.rs,
// src/table/leaves.rs.
#ifndef LEAVES_GLSL
#define LEAVES_GLSL

#include "constants.glsl"
#include "draw/positions.glsl"
#include "draw/tables.glsl"
#include "evaluate/patch.glsl"

// Whether irregular quads are refined.
layout(constant_id = ID_ADAPTIVE) const bool ADAPTIVE = false;

// The patch that is evaluated, among all of the model.
uint evaluated_patch;

// A uniform cubic B-spline: what its points count at t, and for half of the derivative.
struct Spline {
    vec4 value, slope;
};

Spline spline(float t) {
    precise float s = 1.0 - t;
    precise float tt = t * t, ss = s * s;
    precise vec4 value = vec4(s * ss, 4.0 + tt * (3.0 * t - 6.0), 4.0 + ss * (3.0 * s - 6.0), t * tt) / 6.0;
    precise vec4 slope = vec4(-ss, t * (3.0 * t - 4.0), s * (4.0 - 3.0 * s), tt);
    return Spline(value, slope);
}

// Weights of control points that are mirrored at an infinitely sharp crease, at the third of them.
vec4 mirrored(vec4 weights) {
    precise vec4 of_points = vec4(weights.x, weights.y - weights.w, weights.z + 2.0 * weights.w, 0.0);
    return of_points;
}

// Weights of the control points next to a crease of whole sharpness, whose power of two this is. Rust twin: `after`.
vec4 after(vec4 weights, float sigma) {
    precise float square = sigma * sigma, six = 6.0 * sigma;
    precise float k = (1.0 - sigma) / six;
    precise float first = k * (6.0 * square - 5.0 * sigma + 1.0), side = (2.0 * square + 3.0 * sigma + 1.0) / six;
    precise float near = k * (4.0 * sigma - 2.0), far = k * (1.0 - 2.0 * sigma);
    precise float beside = k * (sigma + 1.0), middle = (2.0 * square + 6.0 * sigma - 2.0) / six;
    precise vec4 of_points = vec4(
        weights.x, (first * weights.x + side * weights.y) + (beside * weights.z + far * weights.w),
        (near * weights.y - 2.0 * first * weights.x) + (middle * weights.z + near * weights.w),
        (first * weights.x + far * weights.y) + (beside * weights.z + side * weights.w));
    return of_points;
}

vec4 creased(vec4 weights, float t, float sharpness) {
    float whole = floor(sharpness);
    precise float part = sharpness - whole;
    float sigma = float(1u << uint(whole));
    precise float from = 1.0 - 1.0 / sigma, next = 1.0 - 0.5 / sigma;
    vec4 sharp = mirrored(weights);
    vec4 nearer = t <= next ? sharp : after(weights, 2.0 * sigma);
    precise vec4 mixed = (1.0 - part) * after(weights, sigma) + part * nearer;
    return t <= from ? sharp : mixed;
}

// With a crease at the third point, or where `turned` at the second.
Spline creased_spline(float t, float sharpness, bool turned) {
    precise float s = 1.0 - t;
    Spline plain = spline(turned ? s : t);
    vec4 value = creased(plain.value, turned ? s : t, sharpness), slope = creased(plain.slope, turned ? s : t, sharpness);
    return turned ? Spline(value.wzyx, -slope.wzyx) : Spline(value, slope);
}

vec3 weighted(vec4 weights, vec3 x0, vec3 x1, vec3 x2, vec3 x3) {
    precise vec3 sum = (weights.x * x0 + weights.y * x1) + (weights.z * x2 + weights.w * x3);
    return sum;
}

// An end cap, by its control points as `Scheme::kept` has them, which stand in a row.
Surface evaluate_cap(uint first, float u, float v) {
    precise float s = 1.0 - u;
    precise float t = 1.0 - v;
#define AT(k, i) vertex_position(first + uint(5 * k + i))
#define CORNER(k, x, y) TensorCorner(AT(k, 0), AT(k, 1), AT(k, 2), blend(AT(k, 3), x, AT(k, 4), y))
    return evaluate_tensor(CORNER(0, u, v), CORNER(1, v, s), CORNER(2, s, t), CORNER(3, t, u), u, v);
#undef CORNER
#undef AT
}

// A leaf at its own parameters. Rust twin: `Plan::evaluate_leaf`.
Surface evaluate_leaf(uint leaf, vec2 at) {
    uint start = tables.leaves / 4u + LEAF_FOURS * leaf;
    uvec4 head = table_fours[start];
    if (head.x == LEAF_CAP) {
        return evaluate_cap(head.y, at.x, at.y);
    }
    Spline in_u = spline(at.x), in_v = spline(at.y);
    if (head.x != LEAF_REGULAR) {
        uint edge = head.x - LEAF_CREASE;
        float sharpness = uintBitsToFloat(head.y);
        bool across_u = (edge & 1u) != 0u, turned = edge == 0u || edge == 3u;
        Spline across = creased_spline(across_u ? at.x : at.y, sharpness, turned);
        if (across_u) {
            in_u = across;
        } else {
            in_v = across;
        }
    }
    // As seen from one of them, for sums to keep the bits of small leaves.
    vec3 origin = vertex_position(table_fours[start + 2u].y);
    vec3 of_u[4], slopes[4];
    for (uint i = 0u; i < 4u; ++i) {
        uvec4 row = table_fours[start + 1u + i];
        precise vec3 x0 = vertex_position(row.x) - origin, x1 = vertex_position(row.y) - origin;
        precise vec3 x2 = vertex_position(row.z) - origin, x3 = vertex_position(row.w) - origin;
        of_u[i] = weighted(in_v.value, x0, x1, x2, x3);
        slopes[i] = weighted(in_v.slope, x0, x1, x2, x3);
    }
    precise vec3 position = origin + weighted(in_u.value, of_u[0], of_u[1], of_u[2], of_u[3]);
    vec3 du = weighted(in_u.slope, of_u[0], of_u[1], of_u[2], of_u[3]);
    vec3 dv = weighted(in_u.value, slopes[0], slopes[1], slopes[2], slopes[3]);
    return Surface(position, du, dv, vec3(0.0));
}

// A face at (u, v), whose patch is given. Rust twin: `Plan::locate`.
Surface evaluate_face(uint patch_number, vec2 at) {
    uint node = table_words[tables.quadtrees + table_words[tables.faces + FACE_WORDS * patch_number]];
    for (uint level = 0u; level < MAX_DEPTH && (node & LEAF_BIT) == 0u; ++level) {
        uvec2 far = uvec2(greaterThanEqual(at, vec2(0.5)));
        precise vec2 inside = 2.0 * at - vec2(far);
        at = inside;
        node = table_words[tables.quadtrees + node + far.x + 2u * far.y];
    }
    return evaluate_leaf(node & ~LEAF_BIT, at);
}

// Edge 0 to 3, or corner 4 to 7, on which a point lies.
uint edge_or_corner(bvec4 on) {
    bool corner = (on.x || on.z) && (on.y || on.w);
    uint edge = on.x ? 0u : on.y ? 1u : on.z ? 2u : 3u;
    return corner ? 4u + (on.x ? (on.y ? 1u : 0u) : on.y ? 2u : 3u) : edge;
}

// Who owns the positions on an edge or at a corner of the patch. Rust twin: `LeafTable::faces` in src/table/leaves.rs.
uint owner_of(uint edge_or_corner) {
    return table_words[tables.faces + FACE_WORDS * evaluated_patch + 1u + edge_or_corner];
}

// Who owns the normals.
uint normal_owner_of(uint edge_or_corner) {
    return table_words[tables.faces + FACE_WORDS * evaluated_patch + NORMAL_OWNERS + edge_or_corner];
}

// A point of an edge or a corner, by the leaves of the owner: on an edge, `back` from the end of the patch's own.
Surface evaluate_owned(uint owner, uint edge_or_corner, vec2 at, float back) {
    uint k = owner & 3u, patch_number = owner >> OWNER_SHIFT;
    bool is_own = patch_number == evaluated_patch && k == (edge_or_corner & 3u);
    // The other side goes the other way.
    float way = edge_or_corner < 4u ? back : 0.0;
    precise float left = 1.0 - way;
    vec2 place = k == 0u ? vec2(way, 0.0) : k == 1u ? vec2(1.0, way) : k == 2u ? vec2(left, 1.0) : vec2(0.0, left);
    return evaluate_face(patch_number, is_own ? at : place);
}

// Whether leaves make a point of an edge or a corner.
bool is_of_leaves(bvec4 on) {
    return ADAPTIVE && owner_of(edge_or_corner(on)) != OWNER_NONE;
}

#endif
