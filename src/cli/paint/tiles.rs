//! Where on which patch a fragment is.

use ash_subdiv::mesh::{FaceVarying, MeshData};
use ash_subdiv::table::CpuSurface;
use ash_subdiv::{ControlMesh, MeshError};

/// A mesh whose texture coordinates have a square tile for each patch, in rows. GLSL twin: `src/cli/glsl/tiles.glsl`.
pub(in super::super) struct Tiles {
    /// The mesh that the patches are of.
    pub mesh: ControlMesh,
    /// Tiles in a row.
    pub columns: u32,
}

impl Tiles {
    pub(super) fn new(surface: &CpuSurface) -> Result<Self, MeshError> {
        let patches = surface.plan().patches();
        let columns = (patches.len().max(1) as f64).sqrt().ceil() as u32;
        let mesh = surface.prepared().mesh();
        let mut places = vec![[0.0; 2]; mesh.corner_count()];
        for (number, patch) in (0..).zip(patches) {
            let corners = mesh.face_corners(patch.face);
            let ends: &[[f32; 2]] = match corners.len() {
                3 => &[[0.25, 0.25], [0.75, 0.25], [0.25, 0.75]],
                _ => &[[0.25, 0.25], [0.75, 0.25], [0.75, 0.75], [0.25, 0.75]],
            };
            let origin = [number % columns, number / columns].map(|x| x as f32);
            for (corner, end) in corners.zip(ends) {
                places[corner] = [origin[0] + end[0], origin[1] + end[1]];
            }
        }
        let texcoords = FaceVarying { indices: (0..places.len() as u32).collect(), values: places };
        let mesh = ControlMesh::new(MeshData { texcoords: Some(texcoords), ..mesh.data().clone() })?;
        Ok(Self { mesh, columns })
    }
}
