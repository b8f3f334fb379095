//! The plan's arrays.

use super::feature::Reason;
use super::options::AdaptiveOptions;
use super::rows::Rows;
use std::ops::Range;

/// The bit of a node that says that it is a leaf.
pub const LEAF: u32 = crate::constants::LEAF_BIT;

/// Which cells of which faces are leaves, and the sums that make the leaves' control points.
///
/// Nothing in it depends on positions.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Depths that were asked for.
    pub options: AdaptiveOptions,
    /// Number of control vertices, which are the first vertices of the plan.
    pub control_vertices: u32,
    /// The vertices after the control vertices as sums of vertices with lower numbers ([`Plan::row`]):
    ///
    /// | vertex | sums |
    /// |---|---|
    /// | refined | vertices of the level before, centres |
    /// | ghost, frame | vertices of any level |
    /// | control point of a cap | vertices of any level, centres, frames |
    ///
    /// With [`Sums::Composed`](super::Sums::Composed) all are sums of control vertices.
    pub rows: Rows,
    /// The refined vertices of levels 1, 2, ..: their numbers. Each level follows on the one before.
    pub levels: Vec<Range<u32>>,
    /// The first vertices of level 1: the points of faces of five and more corners, and of triangles that have roots. Rows of level 1
    /// and of end caps read them.
    pub centres: Range<u32>,
    /// The faces that these are of, in order.
    pub centre_faces: Vec<u32>,
    /// The ghost vertices: those beyond boundaries and infinitely sharp creases, mirrored (`2 b - i`), that make leaves there
    /// regular.
    pub ghosts: Range<u32>,
    /// The frames of extraordinary vertices with many faces, which their end caps read: limit point, and the ends of two
    /// tangents there.
    pub frames: Range<u32>,
    /// The control points of end caps: 20 a cap, in the order of [`gregory`](crate::patch::gregory).
    pub cap_points: Range<u32>,
    /// The roots, by face. Root r is node r.
    pub roots: Vec<Root>,
    /// Where the roots of each face start, and after the last face their number. A face that is not drawn has none.
    pub face_roots: Vec<u32>,
    /// The quadtrees: a leaf's number with bit [`LEAF`], or the number of the first of four nodes in a row, those with the
    /// halves (u, v) = (0, 0), (1, 0), (0, 1), (1, 1).
    pub nodes: Vec<u32>,
    /// The leaves, by level.
    pub leaves: Vec<Leaf>,
    /// The control points of regular and single-crease leaves: 16 vertices each. Number `4 i + j` has index i along u and
    /// index j along v, as in [`bicubic`](crate::patch::bicubic).
    pub grids: Vec<u32>,
    /// The cells that are refined, by level.
    pub refined: Vec<RefinedCell>,
    /// End caps at whose corners something is of finite sharpness still, which they draw as infinite or none: a greater
    /// [`AdaptiveOptions::sharp_depth`] leaves fewer.
    pub rounded_caps: u32,
}

/// The root of a quadtree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Root {
    /// The face.
    pub face: u32,
    /// The corner of a face that is no quad, around which the root lies; 0 for a quad.
    pub part: u32,
    /// The root's level: 0 for a quad, else 1.
    pub level: u32,
}

/// A cell of a root that is drawn as one patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leaf {
    /// The root.
    pub root: u32,
    /// The root's face.
    pub face: u32,
    /// The root's part.
    pub part: u32,
    /// The level of the cell, counted from the control mesh.
    pub level: u32,
    /// The column of the cell, along u, among those of its level in the root.
    pub u: u32,
    /// The row of the cell, along v.
    pub v: u32,
    /// How the leaf is evaluated.
    pub kind: LeafKind,
    /// The edges along which the surface ends or is infinitely sharp: a bit each. Edges are those at v = 0, u = 1, v = 1,
    /// u = 0, in this order.
    pub boundary: u32,
    /// The edges beyond which leaves are finer: a bit each, in the same order.
    pub transition: u32,
    /// Regular and single-crease leaves: where their 16 vertices start in [`Plan::grids`]. End caps: the first of their 20
    /// vertices in a row.
    pub points: u32,
}

/// How a leaf is evaluated. Control points are in the order of the face's u and v, whatever the leaf's place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LeafKind {
    /// A bicubic B-spline patch.
    Regular,
    /// A bicubic B-spline patch with a crease along one edge (patch_maths F).
    SingleCrease {
        /// The edge, as in [`Leaf::boundary`].
        edge: u32,
        /// The crease's sharpness at the level of the leaf: the authored one less the level.
        sharpness: f32,
    },
    /// A Gregory patch.
    Cap,
}

/// A cell that is refined, or a face other than a quad.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RefinedCell {
    /// The face.
    pub face: u32,
    /// As in [`Leaf::part`]; 0 for a face other than a quad.
    pub part: u32,
    /// The level of the cell: its children are one level deeper.
    pub level: u32,
    /// As in [`Leaf::u`].
    pub u: u32,
    /// As in [`Leaf::v`].
    pub v: u32,
    /// Why it is refined. Of several reasons the first one of [`Reason::ALL`].
    pub reason: Reason,
}
