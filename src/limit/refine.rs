//! One step of Catmull-Clark refinement of a whole mesh, with all that it has.

use super::edits::VertexEdits;
use super::face_varying::{refine_linearly, refine_texcoords};
use super::stencils::Stencils;
use super::step::refine_vertices;
use crate::mesh::{ControlMesh, Edit, MeshData, MeshError};
use crate::topology::{Topology, draws_face};

/// A refined mesh and where it came from.
#[derive(Debug, Clone)]
pub struct Refined {
    /// All quads. Vertices: one for each manifold vertex, then each edge, then each face of the coarse mesh.
    pub mesh: ControlMesh,
    /// The refined positions as sums of the coarse mesh's, before edits.
    pub stencils: Stencils,
    /// Edits of the refined vertices.
    pub(crate) edits: VertexEdits,
    /// For each refined face, the coarse face corner it grew from: the child of corner h is
    /// `[vertex(h), edge(h), face, edge(prev(h))]`.
    pub parents: Vec<u32>,
}

/// Refines once.
///
/// Texture coordinates follow the mesh's [`crate::mesh::FaceVaryingRule`]; normals are refined linearly within each
/// face. Edits at level 1 are made; the others are edits of the refined mesh, one level less.
///
/// # Errors
/// [`MeshError::TooLarge`] if the refined mesh has more corners or vertices than can be addressed.
pub fn refine(topology: &Topology) -> Result<Refined, MeshError> {
    let (refined, stencils) = refine_vertices(topology);
    let mesh = topology.mesh();
    let data = mesh.data();
    let mut refined = MeshData {
        texcoords: data.texcoords.as_ref().map(|t| refine_texcoords(topology, t)).transpose()?,
        normals: data.normals.as_ref().map(|n| refine_linearly(topology, n)),
        // Where faces at the boundary are not drawn, the refined mesh could not tell which those were.
        holes: (0..)
            .zip(draws_face(topology))
            .filter(|(_, draws)| !draws)
            .flat_map(|(face, _)| mesh.face_corners(face))
            .map(|h| h as u32)
            .collect(),
        face_varying_rule: data.face_varying_rule,
        ..refined
    };
    let of_edit = |edit: &Edit| {
        let corners = mesh.face_corners(edit.face);
        edit.refined(corners.start as u32, corners.len() as u32)
    };
    let edits = VertexEdits::make(&mut refined, data.edits.iter().map(of_edit).collect())?;
    Ok(Refined {
        mesh: ControlMesh::new(refined)?,
        stencils,
        edits,
        parents: (0..mesh.corner_count() as u32).collect(),
    })
}
