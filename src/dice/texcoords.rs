//! Texture coordinates, which may differ at a vertex from face to face.

use super::layout::Facet;
use super::patches::Patches;
use super::real::{Real, Vector};
use crate::limit::value_mesh;
use crate::mesh::{FaceVaryingRule, MeshError};
use crate::topology::Topology;

/// The texture coordinates of all facets, by the mesh's rule.
pub(super) enum Texcoords<T> {
    /// Of the corners of each facet, between which they are linear.
    Linear(Vec<[[f32; 2]; 4]>),
    /// The limit of a mesh in the plane, which has the facets of the mesh itself.
    Smooth { patches: Patches<T>, values: Vec<Vector<f64>> },
}

impl<T: Real> Texcoords<T> {
    /// Of the facets of a refined mesh; `None` if it has no texture coordinates.
    pub(super) fn new(topology: &Topology, facets: &[Facet]) -> Result<Option<Self>, MeshError> {
        let data = topology.mesh().data();
        let Some(texcoords) = &data.texcoords else { return Ok(None) };
        if data.face_varying_rule == FaceVaryingRule::All {
            let corners = texcoords.indices.chunks_exact(4);
            let at = |index: &u32| texcoords.values[*index as usize];
            return Ok(Some(Self::Linear(corners.map(|c| [at(&c[0]), at(&c[1]), at(&c[2]), at(&c[3])]).collect())));
        }
        let values = Topology::new(&value_mesh(topology, texcoords)?);
        let patches = Patches::of_layout(&values, facets)?;
        Ok(Some(Self::Smooth { patches, values: values.mesh().data().positions.clone() }))
    }
}

/// Between the values at the corners of a facet.
pub(super) fn bilinear(corners: &[[f32; 2]; 4], [u, v]: [f32; 2]) -> [f32; 2] {
    let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v];
    [0, 1].map(|axis| (0..4).map(|k| weights[k] * corners[k][axis]).sum())
}
