//! What shaders of the caller's skin by.

use super::Animations;
use super::binding::{Influence, Part};
use crate::mesh::MeshError;

/// What moves the control vertices at a time of an animation: a vertex is where the matrices of its
/// [influences](Animations::influences) take its position, weighted; one without influences stays there. In double precision that is
/// what [`Animations::positions`] fills.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Skinning {
    /// Positions of all control vertices before the skin, with morph targets.
    pub positions: Vec<[f32; 3]>,
    /// Matrices, column by column, as many at any time: of a joint its global transform times its inverse bind matrix; of a node without
    /// a skin its global transform.
    pub matrices: Vec<[[f32; 4]; 4]>,
}

impl Animations {
    /// What a compute shader skins by at a time of an animation, in seconds, into
    /// [positions of the device](crate::renderer::Renderer::set_device_positions).
    ///
    /// # Errors
    /// [`MeshError::UnknownAnimation`], [`MeshError::BadTime`].
    pub fn skinning(&self, animation: usize, seconds: f64) -> Result<Skinning, MeshError> {
        let pose = self.pose(animation, seconds)?;
        let positions = self.binding.morphed(&pose).into_iter().map(|p| p.as_vec3().to_array()).collect();
        let of_part = |part: &Part| part.matrices(&self.rig, &pose);
        let matrices = self.binding.parts().iter().flat_map(of_part);
        Ok(Skinning { positions, matrices: matrices.map(|matrix| matrix.as_mat4().to_cols_array_2d()).collect() })
    }

    /// The influences of each control vertex, which stay: the number of a matrix in [`Skinning::matrices`], and its weight. Weights of a
    /// vertex add up to one.
    pub fn influences(&self) -> Vec<Vec<(u32, f32)>> {
        let of_vertex = |influences: Vec<Influence>| influences.iter().map(|i| (i.joint, i.weight as f32)).collect();
        self.binding.influences(&self.rig).map(of_vertex).collect()
    }
}
