//! Tags on what is not there, and tags whose sharpness is no number from 0 up.

use super::{Joints, Place, RepairKind, Work};
use crate::mesh::{MeshData, adjacency};

/// Tags that went, and the first of them.
pub(super) type Gone = (usize, Option<Place>);

/// Takes out holes in faces that do not exist.
pub(super) fn drop_holes(data: &mut MeshData) -> Gone {
    let mut gone = (0, None);
    let faces = data.face_sizes.len();
    data.holes.retain(|&face| {
        let exists = (face as usize) < faces;
        note(&mut gone, exists, Place::Hole(face));
        exists
    });
    gone
}

/// Takes out creases and corners; `holes` went before.
pub(super) fn mend(work: &mut Work, joints: &Joints, holes: Gone) {
    let Work { data, repairs } = work;
    let (mut on_nothing, mut without_sharpness) = ((0, None), (0, None));
    let edges: Vec<[u32; 2]> = data.creases.iter().map(|crease| crease.vertices).collect();
    let exists = adjacency::are_edges(&edges, &joints.face_offsets, &data.face_vertices);
    let mut number = 0..;
    data.creases.retain(|crease| {
        let index = number.next().unwrap_or_default();
        let (is_edge, is_sharp) = (exists[index], crease.sharpness >= 0.0);
        note(&mut without_sharpness, is_sharp, Place::Crease(index));
        note(&mut on_nothing, is_edge || !is_sharp, Place::Crease(index));
        is_edge && is_sharp
    });
    let mut number = 0..;
    let vertices = data.positions.len();
    data.corners.retain(|corner| {
        let index = number.next().unwrap_or_default();
        let (is_vertex, is_sharp) = ((corner.vertex as usize) < vertices, corner.sharpness >= 0.0);
        note(&mut without_sharpness, is_sharp, Place::Corner(index));
        note(&mut on_nothing, is_vertex || !is_sharp, Place::Corner(index));
        is_vertex && is_sharp
    });
    let first = on_nothing.1.or(holes.1);
    repairs.add(RepairKind::TagsOnNothing, on_nothing.0 + holes.0, first);
    repairs.add(RepairKind::TagsWithoutSharpness, without_sharpness.0, without_sharpness.1);
}

/// Counts a tag that is not good.
fn note(gone: &mut Gone, is_good: bool, place: Place) {
    if !is_good {
        gone.0 += 1;
        gone.1.get_or_insert(place);
    }
}
