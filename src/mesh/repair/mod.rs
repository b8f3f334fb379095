//! Repair: what keeps the data of a file from being a control mesh is mended, and named.
//!
//! | step | file |
//! |---|---|
//! | attributes that are not there or no numbers | `attributes` |
//! | repeated corners, small faces | `faces` |
//! | loose faces | `weld` |
//! | doubled faces | `doubled` |
//! | faces turned over, sheets with one side | `orient` |
//! | edges of three and more faces: vertices parted | `part` |
//! | tags on nothing | `tags` |
//! | vertices without faces | `isolated` |

mod attributes;
mod doubled;
mod faces;
mod isolated;
#[cfg(feature = "gltf")]
mod matching;
mod orient;
mod part;
#[cfg(feature = "gltf")]
pub(super) mod quads;
#[cfg(all(test, feature = "gltf"))]
mod quads_tests;
mod report;
mod tags;
#[cfg(test)]
mod tests;
pub(super) mod weld;

use super::adjacency::{Edges, NO_TWIN};
use super::check::check_sound;
use super::{ControlMesh, MeshData, MeshError};
pub use report::{Place, Repair, RepairKind, Repairs};

/// Repairs beyond those that a mesh needs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RepairOptions {
    /// Join edges on boundaries that lie on others: their ends differ in no coordinate by more than this part of the bounding box's
    /// diagonal. Those within half of it surely are joined. At 0 they must be equal.
    pub weld: Option<f64>,
}

/// Mends what keeps `data` from being a [`ControlMesh`](super::ControlMesh). A mesh without fault comes back as it is.
///
/// In this order:
///
/// * Normals and texture coordinates that are not there or not finite become zero. The surface does not use normals.
/// * A corner that repeats the one before it, and a spike (out to a vertex and back), is left out; then faces of fewer than
///   three corners are.
/// * Where [`RepairOptions::weld`] says so, loose faces are joined.
/// * Of faces that lie on one another, the first stays. Two faces back to back stay both where all their edges have two faces (a
///   pillow), or where each belongs to a solid of its own.
/// * Faces are turned over where neighbours disagree, as few as possible in each piece. A sheet with one side is parted along
///   some edges.
/// * At an edge of three and more faces, and where a face passes a vertex twice, surfaces are parted: each gets its own copies of
///   the vertices. The edge is infinitely sharp, as in OpenSubdiv, and so are its ends where it does not run on through them:
///   the surfaces keep their shared line.
/// * Tags on edges, vertices and faces that do not exist, or whose sharpness is no number from 0 up, are left out.
/// * Vertices without faces are left out.
///
/// Positions of vertices that faces use, vertices that do not exist, and arrays of wrong length can't be mended:
/// [`ControlMesh::new`](super::ControlMesh::new) refuses them. Time and memory grow with the size of the mesh.
///
/// ```
/// use ash_subdiv::{ControlMesh, MeshData, mesh::{RepairKind, RepairOptions, repair}};
/// // Three triangles on one edge, and a vertex without faces.
/// let data = MeshData {
///     positions: vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., 1.], [9., 9., 9.]],
///     face_sizes: vec![3; 3],
///     face_vertices: vec![0, 1, 2, 1, 0, 3, 0, 1, 4],
///     ..MeshData::default()
/// };
/// let (data, repairs) = repair(data, &RepairOptions::default());
/// let kinds: Vec<_> = repairs.list.iter().map(|repair| repair.kind).collect();
/// assert_eq!(kinds, [RepairKind::CrowdedEdges, RepairKind::IsolatedVertices]);
/// let mesh = ControlMesh::new(data)?;
/// assert_eq!((mesh.face_count(), mesh.boundary_edge_count()), (3, 9));
/// # Ok::<(), ash_subdiv::MeshError>(())
/// ```
pub fn repair(data: MeshData, options: &RepairOptions) -> (MeshData, Repairs) {
    if !is_sound(&data) {
        return (data, Repairs::default());
    }
    let mut work = Work { data, repairs: Repairs::default() };
    attributes::mend(&mut work);
    let holes = tags::drop_holes(&mut work.data);
    let mut were_odd = faces::mend(&mut work);
    if let Some(tolerance) = options.weld {
        weld::mend(&mut work, tolerance);
        were_odd |= faces::mend(&mut work);
    }
    let mut joints = join_faces(&mut work);
    if options.weld.is_none() {
        work.repairs.loose_edges = weld::loose_edges(&work.data, &joints);
    }
    tags::mend(&mut work, &joints, holes);
    let crossed = if were_odd { faces::crossed(&work.data) } else { Vec::new() };
    part::mend(&mut work, &mut joints, &crossed);
    // Of meshes without faces the error is that there are none.
    if !work.data.face_sizes.is_empty() {
        isolated::drop(&mut work);
    }
    (work.data, work.repairs)
}

impl ControlMesh {
    /// Repairs `data` ([`repair`]) and makes it a mesh.
    ///
    /// # Errors
    /// Errors of [`ControlMesh::new`] for what can't be mended, with the numbers that vertices and faces were given with.
    pub fn repaired(data: MeshData, options: &RepairOptions) -> Result<(Self, Repairs), MeshError> {
        // Otherwise the error could be one of what is mended.
        check_sound(&data)?;
        let (data, repairs) = repair(data, options);
        match Self::new(data) {
            Ok(mesh) => Ok((mesh, repairs)),
            Err(mut error) => {
                error.renumber(|vertex| repairs.given_vertex(vertex), |face| repairs.given_face(face));
                Err(error)
            }
        }
    }
}

/// A mesh under repair.
struct Work {
    data: MeshData,
    repairs: Repairs,
}

/// Whether the arrays go together, so that they can be walked.
pub(super) fn is_sound(data: &MeshData) -> bool {
    check_sound(data).is_ok()
}

/// Joins faces along edges that two of them have; doubled faces go before, and others are turned over.
fn join_faces(work: &mut Work) -> Joints {
    let mut joints = Joints::new(&work.data);
    if joints.has_faults() && doubled::mend(work, &joints) {
        joints = Joints::new(&work.data);
    }
    if !joints.opposed.is_empty() {
        orient::mend(work, &joints);
        joints = Joints::new(&work.data);
        let first = joints.opposed.first().map(|pair| joints.place(&work.data, pair[1]));
        work.repairs.add(RepairKind::OneSidedSheets, joints.opposed.len(), first);
    }
    joints
}

/// Edges along which faces are joined.
struct Joints {
    face_offsets: Vec<u32>,
    /// The face of each half-edge.
    faces: Vec<u32>,
    /// The half-edge on the other side; [`NO_TWIN`] where there is none, and at the edges below.
    twins: Vec<u32>,
    /// Edges of three and more faces, or of one face twice: their half-edges, one edge after the other, with the number of the
    /// edge.
    crowded: Vec<(u32, u32)>,
    /// The half-edges of edges whose two faces both run in the same direction.
    opposed: Vec<[u32; 2]>,
}

impl Joints {
    fn new(data: &MeshData) -> Self {
        let mut face_offsets = Vec::with_capacity(data.face_sizes.len() + 1);
        face_offsets.push(0);
        face_offsets.extend(data.face_sizes.iter().scan(0, |end, size| {
            *end += size;
            Some(*end)
        }));
        let faces: Vec<u32> =
            (0..).zip(&data.face_sizes).flat_map(|(face, &size)| std::iter::repeat_n(face, size as usize)).collect();
        let vertices = &data.face_vertices;
        let (mut twins, mut crowded, mut opposed) = (vec![NO_TWIN; vertices.len()], Vec::new(), Vec::new());
        let edges = Edges::new(data.positions.len(), &face_offsets, vertices);
        for ((_, edge), number) in edges.iter().zip(0..) {
            match *edge {
                [_] => {}
                [a, b] if faces[a.half_edge as usize] != faces[b.half_edge as usize] => {
                    let (a, b) = (a.half_edge, b.half_edge);
                    if vertices[a as usize] == vertices[b as usize] {
                        opposed.push([a, b]);
                    } else {
                        twins[a as usize] = b;
                        twins[b as usize] = a;
                    }
                }
                _ => crowded.extend(edge.iter().map(|filed| (number, filed.half_edge))),
            }
        }
        Self { face_offsets, faces, twins, crowded, opposed }
    }

    fn corners(&self, face: u32) -> std::ops::Range<usize> {
        self.face_offsets[face as usize] as usize..self.face_offsets[face as usize + 1] as usize
    }

    fn next(&self, half_edge: u32) -> u32 {
        let corners = self.corners(self.faces[half_edge as usize]);
        if half_edge as usize + 1 == corners.end { corners.start as u32 } else { half_edge + 1 }
    }

    fn prev(&self, half_edge: u32) -> u32 {
        let corners = self.corners(self.faces[half_edge as usize]);
        if half_edge as usize == corners.start { corners.end as u32 - 1 } else { half_edge - 1 }
    }

    fn has_faults(&self) -> bool {
        !self.crowded.is_empty() || !self.opposed.is_empty()
    }

    /// The edge of a half-edge, as a place.
    fn place(&self, data: &MeshData, half_edge: u32) -> Place {
        Place::Edge { vertices: self.edge(data, half_edge), face: self.faces[half_edge as usize] }
    }

    /// The half-edges of each crowded edge.
    fn crowded_edges(&self) -> impl Iterator<Item = &[(u32, u32)]> {
        self.crowded.chunk_by(|a, b| a.0 == b.0)
    }

    /// The vertices of a half-edge's edge, the lower first.
    fn edge(&self, data: &MeshData, half_edge: u32) -> [u32; 2] {
        let ends = [half_edge, self.next(half_edge)].map(|h| data.face_vertices[h as usize]);
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    }

    /// Takes two faces apart.
    fn cut(&mut self, half_edge: u32) {
        let twin = std::mem::replace(&mut self.twins[half_edge as usize], NO_TWIN);
        if twin != NO_TWIN {
            self.twins[twin as usize] = NO_TWIN;
        }
    }
}
