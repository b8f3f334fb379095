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

layout(set = 1, binding = BINDING_TABLE_TEXELS + 4) uniform usamplerBuffer quadtree_texels;
layout(set = 1, binding = BINDING_TABLE_TEXELS + 5) uniform usamplerBuffer leaf_texels;

uint quadtree_node(uint i) {
    return READS_TEXELS ? texelFetch(quadtree_texels, int(i)).x : table_words[tables.quadtrees + i];
}

uvec4 leaf_four(uint i) {
    return READS_TEXELS ? texelFetch(leaf_texels, int(i)) : table_fours[tables.leaves / 4u + i];
}

// The patch that is evaluated, among all of the model.
uint evaluated_patch;

// Weights of the control points of a curve: of the value, and of something in the direction of the derivative.
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

// The Bernstein polynomials, as an end cap has them.
Spline bezier(float t) {
    precise float s = 1.0 - t;
    precise float tt = t * t, ss = s * s;
    precise vec4 slope = vec4(-ss, ss - 2.0 * s * t, 2.0 * s * t - tt, tt);
    return Spline(cubic_basis(t), slope);
}

// A leaf at its own parameters. Rust twin: `Plan::evaluate_leaf`.
Surface evaluate_leaf(uint leaf, vec2 at) {
    uint start = LEAF_FOURS * leaf;
    uvec4 head = leaf_four(start);
    bool is_cap = head.x == LEAF_CAP;
    Spline in_u = spline(at.x), in_v = spline(at.y);
    if (is_cap) {
        in_u = bezier(at.x);
        in_v = bezier(at.y);
    } else if (head.x != LEAF_REGULAR) {
        uint edge = head.x - LEAF_CREASE;
        bool across_u = (edge & 1u) != 0u, turned = edge == 0u || edge == 3u;
        Spline across = creased_spline(across_u ? at.x : at.y, uintBitsToFloat(head.y), turned);
        if (across_u) {
            in_u = across;
        } else {
            in_v = across;
        }
    }
    // As seen from one of them, for sums to keep the bits of small leaves.
    uvec4 rows[4] = { leaf_four(start + 1u), leaf_four(start + 2u), leaf_four(start + 3u), leaf_four(start + 4u) };
    vec3 origin = vertex_position(rows[1].y);
    vec3 points[4][4];
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            precise vec3 point = vertex_position(rows[i][j]) - origin;
            points[i][j] = point;
        }
    }
    if (is_cap) {
        // The face points f+ and f- of each corner, blended by (u, v).
        precise float s = 1.0 - at.x, t = 1.0 - at.y;
#define INNER(i, j, k, a, b) \
    { \
        precise vec3 change = (vertex_position(head.y + k) - origin) - points[i][j]; \
        points[i][j] = blend(points[i][j], a, change, b); \
    }
        INNER(1, 1, 0u, at.x, at.y)
        INNER(2, 1, 1u, at.y, s)
        INNER(2, 2, 2u, s, t)
        INNER(1, 2, 3u, t, at.x)
#undef INNER
    }
    vec3 of_u[4], slopes[4];
    for (int i = 0; i < 4; ++i) {
        of_u[i] = symmetric_sum(in_v.value, points[i][0], points[i][1], points[i][2], points[i][3]);
        slopes[i] = symmetric_sum(in_v.slope, points[i][0], points[i][1], points[i][2], points[i][3]);
    }
    precise vec3 position = origin + symmetric_sum(in_u.value, of_u[0], of_u[1], of_u[2], of_u[3]);
    vec3 du = symmetric_sum(in_u.slope, of_u[0], of_u[1], of_u[2], of_u[3]);
    vec3 dv = symmetric_sum(in_u.value, slopes[0], slopes[1], slopes[2], slopes[3]);
    return Surface(position, du, dv, vec3(0.0));
}

// A face at (u, v), whose patch is given. Rust twin: `Plan::locate`.
Surface evaluate_face(uint patch_number, vec2 at) {
    uint node = quadtree_node(table_words[tables.faces + FACE_WORDS * patch_number]);
    for (uint level = 0u; level < MAX_DEPTH && (node & LEAF_BIT) == 0u; ++level) {
        uvec2 far = uvec2(greaterThanEqual(at, vec2(0.5)));
        precise vec2 inside = 2.0 * at - vec2(far);
        at = inside;
        node = quadtree_node(node + far.x + 2u * far.y);
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

// (u, v) of an edge's point, or of a corner, in the owner's face; `back` is its distance from the end of this patch's edge.
vec2 place_of(uint owner, uint edge_or_corner, vec2 at, float back) {
    uint k = owner & 3u;
    bool is_own = owner >> OWNER_SHIFT == evaluated_patch && k == (edge_or_corner & 3u);
    // The other side goes the other way.
    float way = edge_or_corner < 4u ? back : 0.0;
    precise float left = 1.0 - way;
    vec2 place = k == 0u ? vec2(way, 0.0) : k == 1u ? vec2(1.0, way) : k == 2u ? vec2(left, 1.0) : vec2(0.0, left);
    return is_own ? at : place;
}

// Whether leaves make a point of an edge or a corner.
bool is_of_leaves(bvec4 on) {
    return ADAPTIVE && owner_of(edge_or_corner(on)) != OWNER_NONE;
}

#endif
