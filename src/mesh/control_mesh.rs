use super::check::{check, check_sharpness, check_size, check_tags};
use super::edits::{Edit, make_edits};
use super::rules::{BoundaryRule, CreaseMethod, FaceVaryingRule, TriangleRule};
use super::{MeshError, adjacency};
use glam::DVec3;
use std::sync::Arc;

/// A sharpness from which on an edge or vertex is infinitely sharp, as in OpenSubdiv.
pub const SHARPNESS_INFINITE: f32 = 10.0;

/// A crease: the edge between two vertices and its sharpness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crease {
    /// The ends of the edge, in either order.
    pub vertices: [u32; 2],
    /// From 0 (smooth) up; [`SHARPNESS_INFINITE`] and more is infinitely sharp.
    pub sharpness: f32,
}

/// A sharp vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// The vertex.
    pub vertex: u32,
    /// From 0 (smooth) up; [`SHARPNESS_INFINITE`] and more is infinitely sharp.
    pub sharpness: f32,
}

/// Values that may differ at one vertex from face to face: a pool, and an index into it a face corner.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FaceVarying<T> {
    /// The pool, in any order.
    pub values: Vec<T>,
    /// One a face corner, in the order of the faces' corners.
    pub indices: Vec<u32>,
}

/// The parts of a control mesh, unchecked. Fill what you have and leave the rest to `Default`.
///
/// ```
/// use ash_subdiv::{ControlMesh, MeshData};
/// let tetrahedron = ControlMesh::new(MeshData {
///     positions: vec![[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]],
///     face_sizes: vec![3; 4],
///     face_vertices: vec![0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2],
///     ..MeshData::default()
/// })?;
/// assert_eq!(tetrahedron.face_count(), 4);
/// # Ok::<(), ash_subdiv::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeshData {
    /// Object space, any unit.
    pub positions: Vec<[f64; 3]>,
    /// Vertices a face, three or more.
    pub face_sizes: Vec<u32>,
    /// The vertices of every face, counter-clockwise seen from outside, one face after the other.
    pub face_vertices: Vec<u32>,
    /// Texture coordinates: (0, 0) is the upper left of the image, as in glTF and Vulkan.
    pub texcoords: Option<FaceVarying<[f32; 2]>>,
    /// Authored normals. The smooth surface has normals of its own; these are kept for callers.
    pub normals: Option<FaceVarying<[f32; 3]>>,
    /// Sharp edges. Of several for one edge the last counts.
    pub creases: Vec<Crease>,
    /// Sharp vertices. Of several for one vertex the last counts.
    pub corners: Vec<Corner>,
    /// Faces that shape the surface but are not drawn.
    pub holes: Vec<u32>,
    /// Rule of the surface at boundaries.
    pub boundary: BoundaryRule,
    /// Subdivision of finite sharpness.
    pub crease_method: CreaseMethod,
    /// Subdivision of triangles.
    pub triangle_rule: TriangleRule,
    /// Refinement of texture coordinates ([`crate::limit::refine`]). Within a patch they are interpolated linearly.
    pub face_varying_rule: FaceVaryingRule,
    /// Changes at finer levels, in the order in which they are made.
    pub edits: Vec<Edit>,
}

/// A checked, oriented control mesh whose edges have one or two faces.
///
/// Vertices, faces and face corners keep the numbers they were given. A *corner number* (also: half-edge number) is
/// an index into [`MeshData::face_vertices`]; half-edge `h` runs from its corner to the next corner of the face.
///
/// A mesh does not change: a clone of it is another handle to the same arrays.
///
/// # Panics
/// Methods that take the number of a vertex or a face panic if there is none with that number.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlMesh {
    checked: Arc<Checked>,
}

/// The parts of a mesh, and what was found while they were checked.
#[derive(Debug, Clone, PartialEq)]
struct Checked {
    data: MeshData,
    face_offsets: Vec<u32>,
    twins: Vec<u32>,
    /// The crease sharpness of each half-edge's edge; empty where there are no creases.
    edge_sharpness: Vec<f32>,
    /// The corner sharpness of each vertex; empty where there are no corners.
    vertex_sharpness: Vec<f32>,
}

impl ControlMesh {
    /// Checks `data` and makes it a mesh.
    ///
    /// # Errors
    /// Empty meshes, faces with fewer than three vertices, repeated vertices or indices out of range, positions that
    /// are not finite, isolated vertices, edges with three faces or with two faces in the same direction, and tags
    /// and edits that name what is not there. Vertices where fans of faces touch in a point are accepted.
    pub fn new(mut data: MeshData) -> Result<Self, MeshError> {
        let face_offsets = check(&data)?;
        let twins = adjacency::twins(data.positions.len(), &face_offsets, &data.face_vertices)?;
        if !data.edits.is_empty() {
            make_edits(&mut data, &face_offsets)?;
        }
        check_tags(&data)?;
        let edge_sharpness = edge_sharpness(&data, &face_offsets, &twins)?;
        let vertex_sharpness = vertex_sharpness(&data);
        data.holes.sort_unstable();
        data.holes.dedup();
        Ok(Self { checked: Arc::new(Checked { data, face_offsets, twins, edge_sharpness, vertex_sharpness }) })
    }

    /// A mesh of quads, with what is known about it: twins, and the sharpness of half-edges, empty where there are no creases.
    /// Face sizes need not be given.
    ///
    /// # Errors
    /// [`MeshError::TooLarge`]; the rest is not checked.
    pub(crate) fn of_quads(mut data: MeshData, twins: Vec<u32>, edge_sharpness: Vec<f32>) -> Result<Self, MeshError> {
        check_size(&data)?;
        let corners = data.face_vertices.len() as u32;
        data.face_sizes = vec![4; corners as usize / 4];
        let face_offsets = (0..=corners).step_by(4).collect();
        let vertex_sharpness = vertex_sharpness(&data);
        Ok(Self { checked: Arc::new(Checked { data, face_offsets, twins, edge_sharpness, vertex_sharpness }) })
    }

    /// The same mesh with other sharpness of its creases and corners, in the order of [`MeshData::creases`] and
    /// [`MeshData::corners`].
    ///
    /// # Errors
    /// [`MeshError::SharpnessCount`]; sharpness that is negative or no number.
    pub fn with_sharpness(&self, creases: &[f32], corners: &[f32]) -> Result<Self, MeshError> {
        let Checked { mut data, face_offsets, twins, .. } = (*self.checked).clone();
        for (what, given, needed) in
            [("creases", creases.len(), data.creases.len()), ("corners", corners.len(), data.corners.len())]
        {
            if given != needed {
                return Err(MeshError::SharpnessCount { what, given, needed });
            }
        }
        data.creases.iter_mut().zip(creases).for_each(|(crease, &sharpness)| crease.sharpness = sharpness);
        data.corners.iter_mut().zip(corners).for_each(|(corner, &sharpness)| corner.sharpness = sharpness);
        check_tags(&data)?;
        let edge_sharpness = edge_sharpness(&data, &face_offsets, &twins)?;
        let vertex_sharpness = vertex_sharpness(&data);
        Ok(Self { checked: Arc::new(Checked { data, face_offsets, twins, edge_sharpness, vertex_sharpness }) })
    }

    /// The parts, as given (holes sorted, edits at level 0 made).
    pub fn data(&self) -> &MeshData {
        &self.checked.data
    }

    /// Gives the parts back, to be changed and checked again.
    pub fn into_data(self) -> MeshData {
        match Arc::try_unwrap(self.checked) {
            Ok(checked) => checked.data,
            Err(shared) => shared.data.clone(),
        }
    }

    /// The number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.checked.data.positions.len()
    }

    /// The number of faces, holes included.
    pub fn face_count(&self) -> usize {
        self.checked.data.face_sizes.len()
    }

    /// Corners (half-edges) of all faces together.
    pub fn corner_count(&self) -> usize {
        self.checked.data.face_vertices.len()
    }

    /// Edges, each counted once.
    pub fn edge_count(&self) -> usize {
        self.corner_count() - self.checked.twins.iter().enumerate().filter(|&(h, &t)| t < h as u32).count()
    }

    /// Edges with one face.
    pub fn boundary_edge_count(&self) -> usize {
        self.checked.twins.iter().filter(|&&t| t == adjacency::NO_TWIN).count()
    }

    /// Where a vertex is, in object space.
    pub fn position(&self, vertex: u32) -> DVec3 {
        self.checked.data.positions[vertex as usize].into()
    }

    /// The vertices of a face, counter-clockwise.
    pub fn face(&self, face: u32) -> &[u32] {
        &self.checked.data.face_vertices[self.face_corners(face)]
    }

    /// The corner numbers of a face.
    pub fn face_corners(&self, face: u32) -> std::ops::Range<usize> {
        self.checked.face_offsets[face as usize] as usize..self.checked.face_offsets[face as usize + 1] as usize
    }

    /// Prefix sums of the face sizes: one more than there are faces.
    pub fn face_offsets(&self) -> &[u32] {
        &self.checked.face_offsets
    }

    /// The half-edge on the other side of each half-edge, `u32::MAX` on a boundary.
    pub fn twins(&self) -> &[u32] {
        &self.checked.twins
    }

    /// The sharpness of a half-edge's edge: that of its crease, else 0; [`SHARPNESS_INFINITE`] on a boundary.
    pub fn sharpness(&self, half_edge: u32) -> f32 {
        if self.checked.twins[half_edge as usize] == adjacency::NO_TWIN {
            return SHARPNESS_INFINITE;
        }
        self.crease_sharpness(half_edge)
    }

    /// The sharpness of the crease on a half-edge's edge, a boundary too; else 0.
    pub(crate) fn crease_sharpness(&self, half_edge: u32) -> f32 {
        self.checked.edge_sharpness.get(half_edge as usize).copied().unwrap_or(0.0)
    }

    /// The sharpness of a vertex that is tagged as a corner, else 0.
    pub fn vertex_sharpness(&self, vertex: u32) -> f32 {
        self.checked.vertex_sharpness.get(vertex as usize).copied().unwrap_or(0.0)
    }

    /// Edges tagged as creases with a sharpness above zero, boundaries among them, each counted once.
    pub fn creased_edge_count(&self) -> usize {
        let Checked { edge_sharpness, twins, .. } = &*self.checked;
        let lower = edge_sharpness.iter().zip(twins).zip(0..).filter(|&((&s, &twin), h)| s > 0.0 && h < twin);
        lower.count()
    }

    /// The finest level that an edit is at; 0 without edits.
    pub fn edit_level(&self) -> usize {
        self.checked.data.edits.iter().map(Edit::level).max().unwrap_or(0)
    }

    /// Smallest and largest coordinates of the control points.
    pub fn bounds(&self) -> [DVec3; 2] {
        let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for &position in &self.checked.data.positions {
            bounds[0] = bounds[0].min(position.into());
            bounds[1] = bounds[1].max(position.into());
        }
        bounds
    }

    /// Length of the diagonal of [`ControlMesh::bounds`].
    pub fn diagonal(&self) -> f64 {
        let [low, high] = self.bounds();
        (high - low).length()
    }

    /// Positions in the precision of the GPU, in vertex order.
    pub fn positions_f32(&self) -> Vec<[f32; 3]> {
        self.checked.data.positions.iter().map(|p| p.map(|x| x as f32)).collect()
    }
}

/// Crease sharpness by half-edge. Of several creases for one edge the last counts.
fn edge_sharpness(data: &MeshData, face_offsets: &[u32], twins: &[u32]) -> Result<Vec<f32>, MeshError> {
    let mut sharpness = vec![0.0; if data.creases.is_empty() { 0 } else { twins.len() }];
    let edges: Vec<[u32; 2]> = data.creases.iter().map(|crease| crease.vertices).collect();
    let found = adjacency::find_edges(&edges, face_offsets, &data.face_vertices, twins);
    for (index, (crease, edge)) in data.creases.iter().zip(found).enumerate() {
        check_sharpness("crease", index, crease.sharpness)?;
        if edge == adjacency::NO_TWIN {
            return Err(MeshError::NoSuchEdge { crease: index, edge: crease.vertices });
        }
        sharpness[edge as usize] = crease.sharpness;
        if let Some(of_twin) = sharpness.get_mut(twins[edge as usize] as usize) {
            *of_twin = crease.sharpness;
        }
    }
    Ok(sharpness)
}

/// Corner sharpness by vertex. Of several corners for one vertex the last counts.
fn vertex_sharpness(data: &MeshData) -> Vec<f32> {
    let mut sharpness = vec![0.0; if data.corners.is_empty() { 0 } else { data.positions.len() }];
    for corner in &data.corners {
        sharpness[corner.vertex as usize] = corner.sharpness;
    }
    sharpness
}
