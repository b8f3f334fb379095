//! Vertices without faces.

use super::{Place, RepairKind, Work};

/// Takes them out, and the tags on them.
pub(super) fn drop(work: &mut Work) {
    let data = &mut work.data;
    let mut numbers = vec![u32::MAX; data.positions.len()];
    data.face_vertices.iter().for_each(|&vertex| numbers[vertex as usize] = 0);
    let Some(first) = numbers.iter().position(|&number| number == u32::MAX) else { return };
    let mut before = Vec::with_capacity(numbers.len());
    for (number, vertex) in numbers.iter_mut().zip(0..).filter(|(number, _)| **number != u32::MAX) {
        *number = before.len() as u32;
        before.push(vertex);
    }
    data.positions = before.iter().map(|&vertex| data.positions[vertex as usize]).collect();
    data.face_vertices.iter_mut().for_each(|vertex| *vertex = numbers[*vertex as usize]);
    data.creases.iter_mut().for_each(|crease| crease.vertices = crease.vertices.map(|vertex| numbers[vertex as usize]));
    data.corners.retain_mut(|corner| {
        corner.vertex = numbers[corner.vertex as usize];
        corner.vertex != u32::MAX
    });
    let count = numbers.len() - before.len();
    work.repairs.add(RepairKind::IsolatedVertices, count, Some(Place::Vertex(first as u32)));
    work.repairs.renumber_vertices(before);
}
