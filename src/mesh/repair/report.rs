//! Repairs in words.

use crate::mesh::Edit;
use crate::named::named;
use std::fmt::{self, Display};

named! {
    /// A kind of fault that is mended.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    #[non_exhaustive]
    pub enum RepairKind {
        /// Normals that are not there or not finite: zero.
        Normals = "normals",
        /// Texture coordinates that are not there or not finite: zero.
        TextureCoordinates = "texture_coordinates",
        /// Corners that repeat the one before, and spikes: left out.
        RepeatedCorners = "repeated_corners",
        /// Faces of fewer than three corners: left out.
        SmallFaces = "small_faces",
        /// Vertices on boundaries that were joined with others, as asked.
        WeldedVertices = "welded_vertices",
        /// Faces on others of the same vertices: left out.
        DoubledFaces = "doubled_faces",
        /// Faces whose neighbours run the other way round: turned.
        TurnedFaces = "turned_faces",
        /// Edges along which sheets with one side are parted.
        OneSidedSheets = "one_sided_sheets",
        /// Edges of three and more faces: sharp, and parted.
        CrowdedEdges = "crowded_edges",
        /// Corners at which a face passes a vertex again: parted.
        CrossedCorners = "crossed_corners",
        /// Tags on edges, vertices and faces that are not there: left out.
        TagsOnNothing = "tags_on_nothing",
        /// Tags whose sharpness is no number from 0 up: left out.
        TagsWithoutSharpness = "tags_without_sharpness",
        /// Edits of faces whose corners are not those that the edits were made for: left out.
        LostEdits = "lost_edits",
        /// Vertices without faces: left out.
        IsolatedVertices = "isolated_vertices",
    }
}

/// Something in a mesh, by the numbers that it was given with (from zero).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
#[non_exhaustive]
pub enum Place {
    Vertex(u32),
    Face(u32),
    Edge { vertices: [u32; 2], face: u32 },
    Crease(usize),
    Corner(usize),
    Hole(u32),
}

/// All faults of one kind.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Repair {
    /// The kind.
    pub kind: RepairKind,
    /// Faults of the kind.
    pub count: usize,
    /// The first of them.
    pub first: Place,
    /// The line of the file where the first is, from one, if the reader knows.
    pub line: Option<usize>,
}

/// Repairs made by [`repair`](super::repair).
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct Repairs {
    /// One a kind, in the order in which they were made.
    pub list: Vec<Repair>,
    /// The given vertex that each vertex is, or is a copy of; empty if they have the numbers that they had.
    pub vertices: Vec<u32>,
    /// The given face that each face is; empty if they have the numbers that they had.
    pub faces: Vec<u32>,
    /// Edges on boundaries that lie on others (to a millionth of the diagonal), where welding was not asked for.
    pub loose_edges: usize,
    /// Quads that were put together out of triangles, where the reader was asked to.
    pub rebuilt_quads: usize,
}

impl Repairs {
    /// The number that a vertex was given with.
    pub fn given_vertex(&self, vertex: u32) -> u32 {
        self.vertices.get(vertex as usize).copied().unwrap_or(vertex)
    }

    /// The number that a face was given with.
    pub fn given_face(&self, face: u32) -> u32 {
        self.faces.get(face as usize).copied().unwrap_or(face)
    }

    /// Adds faults of a kind, if there are any; the first is at a place whose numbers are those of the mesh under repair.
    pub(super) fn add(&mut self, kind: RepairKind, count: usize, first: Option<Place>) {
        let Some(first) = first.filter(|_| count > 0) else { return };
        let first = match first {
            Place::Vertex(vertex) => Place::Vertex(self.given_vertex(vertex)),
            Place::Face(face) => Place::Face(self.given_face(face)),
            Place::Edge { vertices, face } => {
                Place::Edge { vertices: vertices.map(|vertex| self.given_vertex(vertex)), face: self.given_face(face) }
            }
            tag => tag,
        };
        match self.list.iter_mut().find(|repair| repair.kind == kind) {
            Some(repair) => repair.count += count,
            None => self.list.push(Repair { kind, count, first, line: None }),
        }
    }

    /// Takes out the edits of these faces.
    pub(super) fn lose_edits(&mut self, edits: &mut Vec<Edit>, of: &[bool]) {
        let is_lost = |edit: &Edit| of.get(edit.face as usize).is_some_and(|lost| *lost);
        let first = edits.iter().find(|edit| is_lost(edit)).map(|edit| Place::Face(edit.face));
        let count = edits.len();
        edits.retain(|edit| !is_lost(edit));
        self.add(RepairKind::LostEdits, count - edits.len(), first);
    }

    /// Vertices were numbered anew: the number that each had before.
    pub(super) fn renumber_vertices(&mut self, before: Vec<u32>) {
        self.vertices = before.into_iter().map(|vertex| self.given_vertex(vertex)).collect();
    }

    /// Faces were numbered anew: the number that each had before.
    pub(super) fn renumber_faces(&mut self, before: Vec<u32>) {
        self.faces = before.into_iter().map(|face| self.given_face(face)).collect();
    }
}

impl Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vertex(vertex) => write!(f, "vertex {vertex}"),
            Self::Face(face) => write!(f, "face {face}"),
            Self::Edge { vertices: [a, b], face } => write!(f, "edge {a}-{b} of face {face}"),
            Self::Crease(crease) => write!(f, "crease {crease}"),
            Self::Corner(corner) => write!(f, "corner {corner}"),
            Self::Hole(face) => write!(f, "hole tag of face {face}"),
        }
    }
}

impl Display for Repair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use RepairKind as Kind;
        // One, and several.
        let [one, several] = match self.kind {
            Kind::Normals => [
                "corner has a normal that is not there or no number: the surface has its own",
                "corners have normals that are not there or no numbers: the surface has its own",
            ],
            Kind::TextureCoordinates => [
                "corner has a texture coordinate that is not there or no number: it gets (0, 0)",
                "corners have texture coordinates that are not there or no numbers: they get (0, 0)",
            ],
            Kind::RepeatedCorners => ["repeated corner is left out", "repeated corners are left out"],
            Kind::SmallFaces => {
                ["face of fewer than three corners is left out", "faces of fewer than three corners are left out"]
            }
            Kind::WeldedVertices => ["vertex is joined with another", "vertices are joined with others"],
            Kind::DoubledFaces => ["face on another is left out", "faces on others are left out"],
            Kind::TurnedFaces => {
                ["face is turned over to go with its neighbours", "faces are turned over to go with their neighbours"]
            }
            Kind::OneSidedSheets => [
                "edge is parted, for the sheet there has one side only",
                "edges are parted, for the sheet there has one side only",
            ],
            Kind::CrowdedEdges => ["edge of three or more faces is sharp", "edges of three or more faces are sharp"],
            Kind::CrossedCorners => [
                "corner at a vertex that its face has twice is parted",
                "corners at vertices that their face has twice are parted",
            ],
            Kind::TagsOnNothing => ["tag on nothing is left out", "tags on nothing are left out"],
            Kind::TagsWithoutSharpness => [
                "tag whose sharpness is no number from 0 up is left out",
                "tags whose sharpness is no number from 0 up are left out",
            ],
            Kind::LostEdits => {
                ["edit of a face that was mended is left out", "edits of faces that were mended are left out"]
            }
            Kind::IsolatedVertices => {
                ["vertex belongs to no face and is left out", "vertices belong to no face and are left out"]
            }
        };
        let Self { count, first, .. } = self;
        write!(f, "{count} {}", if *count == 1 { one } else { several })?;
        let the_first = if *count == 1 { "" } else { "the first: " };
        match self.line {
            Some(line) => write!(f, " ({the_first}{first}, line {line})"),
            None => write!(f, " ({the_first}{first})"),
        }
    }
}
