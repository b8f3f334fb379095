// Faces that are refined where they have to be: a quadtree over (u, v), whose leaves are bicubic B-spline patches, with a crease
// along one edge or without, and Gregory patches. Rust twins: src/adaptive/evaluate.rs, src/adaptive/crease.rs,
// src/table/leaves.rs, src/table/pieces.rs.
#ifndef LEAVES_GLSL
#define LEAVES_GLSL

#include "constants.glsl"
#include "draw/patches.glsl"
#include "draw/positions.glsl"
#include "draw/tables.glsl"
#include "evaluate/patch.glsl"

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

// The control points of a leaf, as they are stored; of an end cap, those that its corners have twice are those of the edge before (f+),
// and `others` those of the edge after (f-).
struct LeafPoints {
    vec3 points[4][4];
    vec3 others[4];
};

LeafPoints leaf_points(uint leaf) {
    uint start = LEAF_FOURS * leaf;
    LeafPoints of_leaf;
    for (int i = 0; i < 4; ++i) {
        uvec4 row = leaf_four(start + 1u + uint(i));
        for (int j = 0; j < 4; ++j) {
            of_leaf.points[i][j] = vertex_position(row[j]);
        }
    }
    uvec4 head = leaf_four(start);
    if (head.x == LEAF_CAP) {
        for (uint k = 0u; k < 4u; ++k) {
            of_leaf.others[k] = vertex_position(head.y + k);
        }
    }
    return of_leaf;
}

// A leaf with these control points at its own parameters; `head` is the first four of it. Rust twin: `Plan::evaluate_leaf`.
Surface evaluate_leaf(uvec4 head, LeafPoints of_leaf, vec2 at) {
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
    vec3 origin = of_leaf.points[1][1];
    vec3 points[4][4];
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            precise vec3 point = of_leaf.points[i][j] - origin;
            points[i][j] = point;
        }
    }
    if (is_cap) {
        // The face points f+ and f- of each corner, blended by (u, v).
        precise float s = 1.0 - at.x, t = 1.0 - at.y;
#define FACE_POINT(i, j, k, a, b) \
    { \
        precise vec3 change = (of_leaf.others[k] - origin) - points[i][j]; \
        points[i][j] = blend(points[i][j], a, change, b); \
    }
        FACE_POINT(1, 1, 0, at.x, at.y)
        FACE_POINT(2, 1, 1, at.y, s)
        FACE_POINT(2, 2, 2, s, t)
        FACE_POINT(1, 2, 3, t, at.x)
#undef FACE_POINT
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

// A place on the surface: the root of a quadtree, by leaves a leaf, and (u, v) there.
struct Spot {
    uint root;
    vec2 at;
};

// The leaf in which it lies, and (u, v) there. Rust twin: `Plan::locate`.
Spot in_leaf(Spot spot) {
    if (IS_BY_LEAVES) {
        return spot;
    }
    vec2 at = spot.at;
    uint node = quadtree_node(spot.root);
    for (uint level = 0u; level < MAX_DEPTH && (node & LEAF_BIT) == 0u; ++level) {
        uvec2 far = uvec2(greaterThanEqual(at, vec2(0.5)));
        precise vec2 inside = 2.0 * at - vec2(far);
        at = inside;
        node = quadtree_node(node + far.x + 2u * far.y);
    }
    return Spot(node & ~LEAF_BIT, at);
}

Surface evaluate_spot(Spot spot) {
    Spot of_leaf = in_leaf(spot);
    return evaluate_leaf(leaf_four(LEAF_FOURS * of_leaf.root), leaf_points(of_leaf.root), of_leaf.at);
}

uint face_word(uint patch_number, uint word) {
    return table_words[tables.faces + FACE_WORDS * patch_number + word];
}

// The point of a wedge with these barycentric coordinates: each half is half of a root. Rust twin: `in_wedge` in src/table/cpu.rs.
Spot wedge_spot(uint patch_number, vec3 at) {
    bool far = at.x < at.y;
    precise float along = 2.0 * (far ? at.x : at.y) + at.z;
    return Spot(face_word(patch_number, far ? 1u : 0u), far ? vec2(at.z, along) : vec2(along, at.z));
}

// A point of edge `edge` of a leaf. Rust twin: `on_side` in src/table/pieces.rs.
vec2 on_leaf_edge(uint edge, uint part) {
    precise float t = float(part) / float(PIECE_PARTS), s = 1.0 - t;
    return edge == 0u ? vec2(t, 0.0) : edge == 1u ? vec2(1.0, t) : edge == 2u ? vec2(s, 1.0) : vec2(0.0, s);
}

uint piece_level(uint piece) {
    return piece >> PIECE_LEVEL_SHIFT & 15u;
}

// Corner k of a triangle of a leaf, whose second word this is. Rust twin: `LeafPart` in src/table/pieces.rs.
vec2 piece_corner(uint piece, uint k) {
    uint edge = piece >> PIECE_EDGE_SHIFT & 3u, apex = piece >> PIECE_APEX_SHIFT;
    vec2 at_apex = apex == APEX_IS_CENTRE ? vec2(0.5) : on_leaf_edge(apex, PIECE_PARTS / 2u);
    return k == 2u ? at_apex : on_leaf_edge(edge, (k == 0u ? piece : piece >> PIECE_TO_SHIFT) & PIECE_MASK);
}

// The point of a triangle of a leaf with these barycentric coordinates.
Spot piece_spot(uint patch_number, vec3 at) {
    uint piece = face_word(patch_number, 1u);
    precise vec2 place = (at.x * piece_corner(piece, 0u) + at.y * piece_corner(piece, 1u)) + at.z * piece_corner(piece, 2u);
    return Spot(face_word(patch_number, 0u), place);
}

// The point of a triangle.
Spot triangle_spot(uint patch_number, vec3 at) {
    return IS_BY_LEAVES ? piece_spot(patch_number, at) : wedge_spot(patch_number, at);
}

// The point of the patch that is evaluated.
Spot own_spot(vec3 at) {
#ifdef TRIANGLE
    return triangle_spot(evaluated_patch, at);
#else
    return Spot(face_word(evaluated_patch, 0u), at.xy);
#endif
}

// Edge 0 to 3, or corner 4 to 7, on which a point lies.
uint edge_or_corner(bvec4 on) {
    uint edge = on.x ? 0u : on.y ? 1u : on.z ? 2u : 3u;
#ifdef TRIANGLE
    bool corner = on.x ? on.y || on.z : on.y && on.z;
    return corner ? 4u + (on.x ? (on.y ? 1u : 0u) : 2u) : edge;
#else
    bool corner = (on.x || on.z) && (on.y || on.w);
    return corner ? 4u + (on.x ? (on.y ? 1u : 0u) : on.y ? 2u : 3u) : edge;
#endif
}

// How far a point of an edge is from the end of the edge.
float way_back(bvec4 on, vec3 at) {
#ifdef TRIANGLE
    return on.x ? at.x : on.y ? at.y : at.z;
#else
    precise float left = 1.0 - at.x, up = 1.0 - at.y;
    return on.x ? left : on.y ? up : on.z ? at.x : at.y;
#endif
}

// Who owns the positions on an edge or at a corner of the patch. Rust twin: `LeafTable::faces` in src/table/leaves.rs.
uint owner_of(uint edge_or_corner) {
    return face_word(evaluated_patch, OWNERS + edge_or_corner);
}

// Who owns the normals.
uint normal_owner_of(uint edge_or_corner) {
    return face_word(evaluated_patch, NORMAL_OWNERS + edge_or_corner);
}

// Whether the patch itself is the owner of its edge or corner.
bool is_own(uint owner, uint edge_or_corner) {
    return owner >> OWNER_SHIFT == evaluated_patch && (owner & 3u) == (edge_or_corner & 3u);
}

// A point of an edge, or a corner, as the owner has it; `back` is its distance from the end of this patch's edge.
Spot spot_of(uint owner, uint edge_or_corner, vec3 at, float back) {
    uint of = owner >> OWNER_SHIFT, k = owner & 3u;
    if (is_own(owner, edge_or_corner)) {
        return own_spot(at);
    }
    // The other side goes the other way.
    float way = edge_or_corner < 4u ? back : 0.0;
    precise float left = 1.0 - way;
    if ((owner & WEDGE_BIT) != 0u) {
        return triangle_spot(of, k == 0u ? vec3(left, way, 0.0) : k == 1u ? vec3(0.0, left, way) : vec3(way, 0.0, left));
    }
    vec2 place = k == 0u ? vec2(way, 0.0) : k == 1u ? vec2(1.0, way) : k == 2u ? vec2(left, 1.0) : vec2(0.0, left);
    return Spot(face_word(of, 0u), place);
}

#endif
