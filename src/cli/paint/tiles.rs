//! Where on which patch a fragment is.

use ash_subdiv::mesh::{FaceVarying, MeshData};
use ash_subdiv::table::CpuSurface;
use ash_subdiv::{ControlMesh, MeshError};
use std::collections::BTreeMap;
use std::f32::consts::TAU;

/// A mesh whose texture coordinates have a square tile for each patch, or for each face that is cut in wedges, in rows. GLSL twin:
/// `src/cli/glsl/tiles.glsl`.
pub(in super::super) struct Tiles {
    /// The mesh that the patches are of, before faces are cut.
    pub mesh: ControlMesh,
    /// Tiles in a row.
    pub columns: u32,
    /// Two words a tile: its patch and 0; or where the patches of its wedges are, and their number. Then these patches.
    pub words: Vec<u32>,
}

impl Tiles {
    pub(super) fn new(surface: &CpuSurface) -> Result<Self, MeshError> {
        let prepared = surface.prepared();
        // The patches of wedges by face and corner.
        let mut cut: BTreeMap<u32, BTreeMap<u32, u32>> = BTreeMap::new();
        let mut whole = Vec::new();
        for (number, patch) in (0..).zip(surface.plan().patches()) {
            match prepared.whole_face(patch.face) {
                (face, None) => whole.push((face, number)),
                (face, Some(corner)) => _ = cut.entry(face).or_default().insert(corner, number),
            }
        }
        let tiles = whole.len() + cut.len();
        let columns = (tiles.max(1) as f64).sqrt().ceil() as u32;
        let mesh = prepared.whole().mesh();
        let mut places = vec![[0.0; 2]; mesh.corner_count()];
        let mut put = |tile: u32, face: u32, ends: &[[f32; 2]]| {
            let origin = [tile % columns, tile / columns].map(|x| x as f32);
            for (corner, end) in mesh.face_corners(face).zip(ends) {
                places[corner] = [origin[0] + end[0], origin[1] + end[1]];
            }
        };
        let mut words = Vec::with_capacity(2 * tiles);
        for (tile, &(face, number)) in (0..).zip(&whole) {
            put(
                tile,
                face,
                match mesh.face(face).len() {
                    3 => &[[0.25, 0.25], [0.75, 0.25], [0.25, 0.75]],
                    _ => &[[0.25, 0.25], [0.75, 0.25], [0.75, 0.75], [0.25, 0.75]],
                },
            );
            words.extend([number, 0]);
        }
        let mut wedges: Vec<u32> = Vec::new();
        for (tile, (&face, patches)) in (whole.len() as u32..).zip(&cut) {
            let angle = |corner: usize| TAU * corner as f32 / patches.len() as f32;
            let end = |corner| [0.5 + 0.25 * angle(corner).cos(), 0.5 + 0.25 * angle(corner).sin()];
            put(tile, face, &(0..patches.len()).map(end).collect::<Vec<_>>());
            words.extend([(2 * tiles + wedges.len()) as u32, patches.len() as u32]);
            wedges.extend(patches.values());
        }
        words.extend(wedges);
        let texcoords = FaceVarying { indices: (0..places.len() as u32).collect(), values: places };
        let mesh = ControlMesh::new(MeshData { texcoords: Some(texcoords), ..mesh.data().clone() })?;
        Ok(Self { mesh, columns, words })
    }
}
