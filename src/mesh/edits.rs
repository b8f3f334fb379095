//! Hierarchical edits: changes to what refinement makes of a mesh, at finer levels of a base face.

use super::control_mesh::{Corner, Crease, MeshData};
use super::error::MeshError;

/// The finest level that an edit may be at.
pub const MAX_EDIT_LEVEL: usize = 10;

/// A change to one vertex, edge or face of the mesh at some level of refinement, as RenderMan's `HierarchicalSubdivisionMesh` has
/// them. It takes the place of what refinement made there, and is refined on.
///
/// **Path.** An edit names a face by its ancestors: a face of the control mesh, then one child a level; as many children, so deep the
/// level. Child k of a face holds corner k of its parent. The corners of a face count from 0 counter-clockwise. Those of a quad's child
/// are turned so that u and v run as in the parent: corner k of child k is corner k of the parent, corner k + 2 its centre. Any other face
/// has one child a corner; corner 0 of child k is corner k of the parent, and corner 2 its centre. Edge k of a face runs from its corner k to
/// its corner k + 1.
///
/// **Order.** All edits of a level are made after refinement to this level and before the next. Several edits of one vertex or edge are
/// made in the order of [`MeshData::edits`]; so are those that name it through different faces.
///
/// Edits at level 0, with no child, change the control mesh itself: [`ControlMesh::new`](super::ControlMesh::new) makes them, and
/// they are gone from its data.
#[derive(Debug, Clone, PartialEq)]
pub struct Edit {
    /// The face of the control mesh.
    pub face: u32,
    /// From its child to the face that is edited.
    pub children: Vec<u32>,
    /// The change.
    pub change: Change,
}

/// Change that an edit makes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Change {
    /// Moves a corner of the face by an offset, in object space.
    Offset {
        /// The corner.
        corner: u32,
        /// In the units of the mesh.
        offset: [f64; 3],
    },
    /// Puts a corner of the face somewhere, in object space. It stays there when control vertices move.
    Position {
        /// The corner.
        corner: u32,
        /// In the units of the mesh.
        position: [f64; 3],
    },
    /// Moves a corner of the face by an offset in the tangent frame of the limit surface there, so that it follows moving vertices: along the
    /// directions of u and v in the face, both of length one, and along the normal. The surface is that without edits of this level
    /// and finer ones; where it has no tangent or normal, nothing is moved along it. Only at level 1 and finer.
    FrameOffset {
        /// The corner.
        corner: u32,
        /// Along u, along v, along the normal, each in the units of the mesh.
        offset: [f64; 3],
    },
    /// Gives a corner of the face a sharpness, as of [`Corner`].
    CornerSharpness {
        /// The corner.
        corner: u32,
        /// At the edit's level: one less of it is left a level further on.
        sharpness: f32,
    },
    /// Gives an edge of the face a sharpness, as of [`Crease`].
    EdgeSharpness {
        /// The edge.
        edge: u32,
        /// At the edit's level: it is used up from there on.
        sharpness: f32,
    },
    /// Makes the face a hole, with all its descendants.
    Hole,
}

impl Edit {
    /// The level of refinement that is edited.
    pub fn level(&self) -> usize {
        self.children.len()
    }

    /// Checks the edit of a mesh whose faces have `face_sizes`.
    fn check(&self, face_sizes: &[u32]) -> Result<(), String> {
        let Self { face, children, change } = self;
        let count = face_sizes.len();
        let Some(&base) = face_sizes.get(*face as usize) else {
            return Err(format!("level 0: it names face {face}, but the mesh has {count} faces"));
        };
        if self.level() > MAX_EDIT_LEVEL {
            return Err(format!("it is at level {}, but edits go down to level {MAX_EDIT_LEVEL}", self.level()));
        }
        let mut size = base;
        for (level, &child) in (1..).zip(children) {
            if child >= size {
                return Err(format!("level {level}: there is no child {child}: the face has {}", last(size)));
            }
            size = 4;
        }
        let level = self.level();
        let is_finite = |values: &[f64; 3]| match values.iter().all(|&x| (x as f32).is_finite()) {
            true => Ok(()),
            false => Err(format!(
                "({}, {}, {}) is no place: give finite numbers of at most 3.4e38",
                values[0], values[1], values[2]
            )),
        };
        let is_there = |what: &str, number: u32| match number < size {
            true => Ok(()),
            false => Err(format!("level {level}: there is no {what} {number}: the face has {}", last(size))),
        };
        let is_sharpness = |sharpness: f32| match sharpness >= 0.0 {
            true => Ok(()),
            false => {
                Err(format!("sharpness {sharpness}: sharpness is a number from 0 up (10 and more is infinitely sharp)"))
            }
        };
        match *change {
            Change::FrameOffset { .. } if level == 0 => {
                Err("an offset in the tangent frame is at level 1 or finer: name a child, or move the vertex".into())
            }
            Change::Offset { corner, offset: value }
            | Change::Position { corner, position: value }
            | Change::FrameOffset { corner, offset: value } => {
                is_there("corner", corner)?;
                is_finite(&value)
            }
            Change::CornerSharpness { corner, sharpness } => {
                is_there("corner", corner)?;
                is_sharpness(sharpness)
            }
            Change::EdgeSharpness { edge, sharpness } => {
                is_there("edge", edge)?;
                is_sharpness(sharpness)
            }
            Change::Hole => Ok(()),
        }
    }

    /// The edit as one of the mesh that is refined once, in which the child at a face corner has the number of this corner and begins with
    /// it. `first` is the number of the face's first corner, `size` that of its corners.
    pub(crate) fn refined(&self, first: u32, size: u32) -> Self {
        let child = self.children[0];
        // Corners of a quad's child are turned, those of the refined mesh are not.
        let turn = if size == 4 { 4 - child } else { 0 };
        let turned = |corner: u32| (corner + turn) % 4;
        let children = self.children[1..].iter().map(|&child| turned(child)).collect();
        let change = match self.change {
            Change::Offset { corner, offset } => Change::Offset { corner: turned(corner), offset },
            Change::Position { corner, position } => Change::Position { corner: turned(corner), position },
            // The frame is turned with the corners.
            Change::FrameOffset { corner, offset: [u, v, normal] } => {
                let [u, v] = [[u, v], [-v, u], [-u, -v], [v, -u]][turn as usize % 4];
                Change::FrameOffset { corner: turned(corner), offset: [u, v, normal] }
            }
            Change::CornerSharpness { corner, sharpness } => {
                Change::CornerSharpness { corner: turned(corner), sharpness }
            }
            Change::EdgeSharpness { edge, sharpness } => Change::EdgeSharpness { edge: turned(edge), sharpness },
            Change::Hole => Change::Hole,
        };
        Self { face: first + child, children, change }
    }
}

fn last(size: u32) -> String {
    format!("{size} (0 to {})", size - 1)
}

/// Checks the edits of a mesh whose other parts are sound, and makes those at level 0.
pub(super) fn make_edits(data: &mut MeshData, face_offsets: &[u32]) -> Result<(), MeshError> {
    for (index, edit) in data.edits.iter().enumerate() {
        edit.check(&data.face_sizes).map_err(|message| MeshError::BadEdit { edit: index, message })?;
    }
    for (index, Edit { face, children, change }) in std::mem::take(&mut data.edits).into_iter().enumerate() {
        if !children.is_empty() {
            data.edits.push(Edit { face, children, change });
            continue;
        }
        let first = face_offsets[face as usize];
        let size = data.face_sizes[face as usize];
        let vertex = |corner: u32| data.face_vertices[(first + corner % size) as usize];
        match change {
            Change::Offset { corner, offset } => {
                let position = &mut data.positions[vertex(corner) as usize];
                (0..3).for_each(|axis| position[axis] += offset[axis]);
                if position.iter().any(|&x| !(x as f32).is_finite()) {
                    let message = "it moves the vertex beyond 3.4e38".into();
                    return Err(MeshError::BadEdit { edit: index, message });
                }
            }
            Change::Position { corner, position } => data.positions[vertex(corner) as usize] = position,
            Change::CornerSharpness { corner, sharpness } => {
                data.corners.push(Corner { vertex: vertex(corner), sharpness });
            }
            Change::EdgeSharpness { edge, sharpness } => {
                data.creases.push(Crease { vertices: [vertex(edge), vertex(edge + 1)], sharpness });
            }
            Change::Hole => data.holes.push(face),
            Change::FrameOffset { .. } => unreachable!("refused above"),
        }
    }
    Ok(())
}
