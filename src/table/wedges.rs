//! Faces cut in wedges: the triangles between their edges and their centres.

use super::pieces::LeafPart;
use crate::mesh::{ControlMesh, FaceVarying, MeshData, MeshError};
use crate::topology::{Topology, draws_face};

/// A mesh some of whose faces are cut in wedges: what is left whole comes first, then the wedges face by face. Its vertices are
/// those of the whole mesh, then a centre for each face that is cut.
pub(super) struct Wedges {
    pub mesh: ControlMesh,
    /// What each face was before.
    pub faces: Vec<CutFace>,
}

/// A face, or a part of one, of the mesh before faces were cut.
#[derive(Debug, Clone, Copy)]
pub(super) struct CutFace {
    pub face: u32,
    pub part: Part,
}

/// A part of a face.
#[derive(Debug, Clone, Copy)]
pub(super) enum Part {
    Whole,
    /// The wedge at the edge from a corner.
    Wedge(u32),
    /// A leaf of adaptive subdivision, by its number.
    Leaf(u32),
    /// A triangle of one.
    OfLeaf(u32, LeafPart),
}

impl Part {
    /// The corner from which the edge of a wedge starts.
    pub(super) fn corner(self) -> Option<u32> {
        match self {
            Self::Wedge(corner) => Some(corner),
            _ => None,
        }
    }
}

impl Wedges {
    /// Cuts faces, given in order.
    ///
    /// # Errors
    /// [`MeshError::TooLarge`].
    pub(super) fn new(topology: &Topology, cut: &[u32]) -> Result<Self, MeshError> {
        let (mesh, draws) = (topology.mesh(), draws_face(topology));
        let old = mesh.data();
        let is_whole = |face: &u32| cut.binary_search(face).is_err();
        let whole = (0..mesh.face_count() as u32).filter(is_whole).map(|face| CutFace { face, part: Part::Whole });
        let wedges = cut.iter().flat_map(|&face| {
            (0..mesh.face(face).len() as u32).map(move |corner| CutFace { face, part: Part::Wedge(corner) })
        });
        let faces: Vec<CutFace> = whole.chain(wedges).collect();

        let mut data = MeshData { holes: Vec::new(), normals: None, ..old.clone() };
        data.face_sizes.clear();
        data.face_vertices.clear();
        let mut indices = Vec::new();
        for (number, &CutFace { face, part }) in (0..).zip(&faces) {
            if !draws[face as usize] {
                data.holes.push(number);
            }
            let corners = mesh.face_corners(face);
            let Some(corner) = part.corner() else {
                data.face_sizes.push(corners.len() as u32);
                data.face_vertices.extend_from_slice(mesh.face(face));
                indices.extend(corners);
                continue;
            };
            let next = (corner + 1) % corners.len() as u32;
            let centre = mesh.vertex_count() as u32 + cut.binary_search(&face).unwrap_or_default() as u32;
            let [from, to] = [corner, next].map(|corner| corners.start + corner as usize);
            data.face_sizes.push(3);
            data.face_vertices.extend([old.face_vertices[from], old.face_vertices[to], centre]);
            indices.extend([from, to, mesh.corner_count() + (centre as usize - mesh.vertex_count())]);
        }
        data.positions.extend(cut.iter().map(|&face| mean(mesh.face(face).iter().map(|&v| old.positions[v as usize]))));
        data.texcoords = old.texcoords.as_ref().map(|FaceVarying { values, indices: of_corners }| {
            let at = |corner: usize| values[of_corners[corner] as usize];
            let first = values.len() as u32;
            let centres = cut.iter().map(|&face| mean(mesh.face_corners(face).map(|h| at(h).map(f64::from))));
            let values = values.iter().copied().chain(centres.map(|centre| centre.map(|x| x as f32))).collect();
            let index = |&corner: &usize| match corner.checked_sub(mesh.corner_count()) {
                Some(centre) => first + centre as u32,
                None => of_corners[corner],
            };
            FaceVarying { values, indices: indices.iter().map(index).collect() }
        });
        Ok(Self { mesh: ControlMesh::new(data)?, faces })
    }
}

pub(super) fn mean<const N: usize>(points: impl ExactSizeIterator<Item = [f64; N]>) -> [f64; N] {
    let count = points.len() as f64;
    points.fold([0.0; N], |sum, point| std::array::from_fn(|i| sum[i] + point[i] / count))
}
