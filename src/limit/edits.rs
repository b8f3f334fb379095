//! Edits of the vertices of a mesh that was refined once.

use super::local::Local;
use super::surface::LimitSurface;
use crate::mesh::{Change, ControlMesh, Edit, MeshData, MeshError};
use crate::topology::Topology;
use glam::DVec3;

/// Changes of vertices by edits, in order. Changes in tangent frames are for positions before any edit.
#[derive(Debug, Clone, Default)]
pub(crate) struct VertexEdits {
    edits: Vec<(u32, VertexChange)>,
}

#[derive(Debug, Clone)]
enum VertexChange {
    Offset(DVec3),
    Position(DVec3),
    Frame(Box<Frame>),
}

/// The tangent frame at a corner of a face.
#[derive(Debug, Clone)]
struct Frame {
    offset: DVec3,
    /// The face is face 0.
    around: Local,
    corner: u32,
}

impl VertexEdits {
    /// Whether nothing is changed.
    pub(crate) fn is_empty(&self) -> bool {
        self.edits.is_empty()
    }

    /// Gives a mesh its edits. Those at its level, made as far as they are about vertices, are found again in what is given back.
    pub(super) fn make(data: &mut MeshData, edits: Vec<Edit>) -> Result<Self, MeshError> {
        let now = edits.iter().filter(|edit| edit.level() == 0);
        let has_frames = now.clone().any(|edit| matches!(edit.change, Change::FrameOffset { .. }));
        let topology =
            has_frames.then(|| ControlMesh::new(data.clone()).map(|mesh| Topology::new(&mesh))).transpose()?;
        let of_edit = |edit: &Edit| {
            let vertex = |corner: u32| data.face_vertices[(4 * edit.face + corner) as usize];
            match edit.change {
                Change::Offset { corner, offset } => Some((vertex(corner), VertexChange::Offset(offset.into()))),
                Change::Position { corner, position } => {
                    Some((vertex(corner), VertexChange::Position(position.into())))
                }
                Change::FrameOffset { corner, offset } => {
                    let around = Local::cut(topology.as_ref()?, edit.face, 0, DVec3::ZERO);
                    let frame = Frame { offset: offset.into(), around, corner };
                    Some((vertex(corner), VertexChange::Frame(Box::new(frame))))
                }
                Change::CornerSharpness { .. } | Change::EdgeSharpness { .. } | Change::Hole => None,
            }
        };
        let made = Self { edits: now.filter_map(of_edit).collect() };
        let mut positions: Vec<DVec3> = data.positions.iter().map(|&p| p.into()).collect();
        made.apply(&mut positions);
        data.positions = positions.into_iter().map(Into::into).collect();
        let is_vertex = |change: &Change| {
            matches!(change, Change::Offset { .. } | Change::Position { .. } | Change::FrameOffset { .. })
        };
        data.edits = edits.into_iter().filter(|edit| edit.level() > 0 || !is_vertex(&edit.change)).collect();
        Ok(made)
    }

    /// Moves vertices. Where coordinates are so large, or no numbers, that there is no tangent frame, nothing is moved in it.
    pub(crate) fn apply(&self, positions: &mut [DVec3]) {
        let offset = |(_, change): &(u32, VertexChange)| match change {
            VertexChange::Frame(frame) => frame.offset(positions).unwrap_or_default(),
            VertexChange::Offset(offset) => *offset,
            VertexChange::Position(_) => DVec3::ZERO,
        };
        let offsets: Vec<DVec3> = self.edits.iter().map(offset).collect();
        for ((vertex, change), offset) in self.edits.iter().zip(offsets) {
            let position = &mut positions[*vertex as usize];
            match change {
                VertexChange::Position(place) => *position = *place,
                VertexChange::Offset(_) | VertexChange::Frame(_) => *position += offset,
            }
        }
    }
}

impl Frame {
    /// The offset in object space, of a mesh with these positions.
    fn offset(&self, positions: &[DVec3]) -> Result<DVec3, MeshError> {
        let centre = positions[self.around.vertices[0] as usize];
        let of_part = self.around.vertices.iter().map(|&vertex| (positions[vertex as usize] - centre).into());
        let part = MeshData { positions: of_part.collect(), ..self.around.data.clone() };
        let surface = LimitSurface::new(&ControlMesh::new(part)?)?;
        let (u, v) = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)][self.corner as usize];
        let limit = surface.evaluate(0, -1, u, v);
        let [along_u, along_v, along_normal] = self.offset.to_array();
        Ok(along_u * limit.du.normalize_or_zero()
            + along_v * limit.dv.normalize_or_zero()
            + along_normal * limit.normal)
    }
}
