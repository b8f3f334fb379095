// Numbers that shaders and the host agree on. build.rs makes a Rust constant of each: `crate::constants`.
#ifndef CONSTANTS_GLSL
#define CONSTANTS_GLSL

// Specialization constants, by their ids.
#define ID_CORNERS 0u
#define ID_ENCODE_SRGB 1u
#define ID_MAX_FACTOR 2u
#define ID_STRIDE 3u
#define ID_DRAW_FLAGS 4u
#define ID_MAY_BE_FITTED 5u
#define ID_MAY_HAVE_PENTAGONS 6u
#define ID_HAS_FOREIGN_OWNERS 7u
#define ID_HAS_EDGE_FACTORS 8u
#define ID_READS_TEXELS 9u
#define ID_LISTED 10u
#define ID_COPIES 11u
#define ID_CONSTRUCTION 12u
#define ID_HAS_TEXCOORDS 13u
#define ID_ADAPTIVE 14u
// Far from the ids of fragment shaders that callers bring.
#define ID_INSTANCES 1000u

// Bindings of set 1: storage buffers, where tables start, the displacement map; texel buffers, of tables from BINDING_TABLE_TEXELS on.
#define BINDING_POSITIONS 0u
#define BINDING_TABLES 1u
#define BINDING_FRAMES 2u
#define BINDING_EDGE_FACTORS 3u
#define BINDING_CONTROL_POINTS 4u
#define BINDING_TABLE_STARTS 5u
#define BINDING_DISPLACEMENT_MAP 6u
#define BINDING_POSITION_TEXELS 7u
#define BINDING_TABLE_TEXELS 8u
#define BINDING_FRAME_TEXELS 17u
#define BINDING_CONTROL_POINT_TEXELS 18u

// Constructions, by their numbers.
#define TWO_STAGE 0u
#define STENCIL 1u
#define CACHED 2u

// Where factors come from, and what is culled: bits of DRAW_FLAGS.
#define METRIC_MASK 3u
#define METRIC_UNIFORM 0u
#define METRIC_PIXELS 1u
#define METRIC_CURVATURE 2u
#define METRIC_EDGES 3u
#define CULL_FRUSTUM_FLAG 4u
#define CULL_BACK_FLAG 8u
#define CULL_SMALL_FLAG 16u

// Bits of a draw's flags: the displacement map has vectors; what is seen counter-clockwise faces away. From KIND_SHIFT on, the kind
// of the patches. Then, of instances, whether what faces away is the inside, so that a mirrored one has it the other way round.
#define VECTOR_FLAG 1u
#define COUNTER_CLOCKWISE_FLAG 2u
#define KIND_SHIFT 2u
#define KIND_MASK 3u
#define INSIDE_FLAG 16u

// The location where a fragment shader has the number of its instance.
#define LOCATION_INSTANCE 3u
// The location where an evaluation shader has that of its patch.
#define LOCATION_PATCH_INSTANCE 24u

// What corners share: words, and the bit of a plus edge whose faces have normals of their own.
#define SHARED_WORDS 5u
#define SHARP_EDGE_BIT 0x40000000u

// Rings and their entries.
#define TRIANGLE_BIT 0x80000000u
#define PENTAGON_BIT 0x40000000u
#define OPEN_BIT 0x80000000u
#define CONE_BIT 0x40000000u
#define FALLBACK_BIT 0x20000000u
#define FITTED_BIT 0x10000000u

// Fans of subdivision: an open one; words before the weights of a type.
#define FAN_OPEN_BIT 0x80000000u
#define TYPE_HEAD 10u

// Stencils: words of a type for each corner, before the weights.
#define HEAD_WORDS 3u

// Invocations of a workgroup that makes control points.
#define GROUP_INVOCATIONS 64u
// Patches of a workgroup that lists what can be seen.
#define REGION 128u
// Vertices of a patch that a workgroup evaluates.
#define GROUP_VERTICES 256u
// Vertices of a tile of a patch in strips.
#define TILE_VERTICES 64u

// Quadtrees over faces: levels, and the bit of a node that is a leaf.
#define MAX_DEPTH 10u
#define LEAF_BIT 0x80000000u
// Fours of a leaf, and its kinds; with a crease, the first of four.
#define LEAF_FOURS 5u
#define LEAF_REGULAR 0u
#define LEAF_CAP 1u
#define LEAF_CREASE 2u
// What patches are: not of leaves, a face each, a leaf or a part of one each.
#define NOT_ADAPTIVE 0u
#define BY_FACES 1u
#define BY_LEAVES 2u
// The second word of a patch by leaves: where on which edge of the leaf a triangle begins (from bit 0) and ends, in parts of the
// edge; the level of the leaf; and where the triangle ends in a point: in the middle of an edge of the leaf, or its centre.
#define PIECE_PARTS 1024u
#define PIECE_MASK 2047u
#define PIECE_TO_SHIFT 11u
#define PIECE_EDGE_SHIFT 22u
#define PIECE_LEVEL_SHIFT 24u
#define PIECE_APEX_SHIFT 28u
#define APEX_IS_CENTRE 4u
// Words of a face: the first of those that say who owns the positions, the normals; that where its hull starts. An owner is a patch from OWNER_SHIFT on, whether
// it is a wedge, and its edge or corner; or none, where a neighbour is not refined.
#define FACE_WORDS 19u
#define OWNERS 2u
#define NORMAL_OWNERS 10u
#define FACE_HULL 18u
#define OWNER_SHIFT 3u
#define WEDGE_BIT 4u
#define OWNER_NONE 0xffffffffu

// An entry of a hull: a vertex, or the first of those that are the control points of an end cap.
#define HULL_CAP_BIT 0x80000000u
#define CAP_VERTICES 20u

// What is captured of a patch, and of a vertex.
#define CONTROL_POINT_WORDS 96u
#define FACTOR_WORDS 7u
#define RECORD_WORDS 10u
// In the place of a grid's size: vertices on edges as they come.
#define EDGES_ONLY 0xffffffffu

#endif
