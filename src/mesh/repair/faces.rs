//! Repeated corners, faces of fewer than three corners, and faces that pass a vertex twice.

use super::{Place, RepairKind, Work};
use crate::mesh::MeshData;
use std::ops::Range;

/// Cleans faces. Tells whether there were any to clean: then some may pass a vertex twice all the same.
pub(super) fn mend(work: &mut Work) -> bool {
    let Some(odd) = odd_faces(&work.data) else { return false };
    let (mut repeated, mut first_repeated) = (0, None);
    let (mut small, mut first_small) = (0, None);
    let vertices = std::mem::take(&mut work.data.face_vertices);
    let before = rebuild(work, &vertices, |face, corners, kept| {
        let size = corners.len();
        if !odd[face as usize] {
            kept.extend(corners);
            return;
        }
        clean(&vertices, corners, kept);
        if kept.len() < 3 {
            kept.clear();
            small += 1;
            first_small.get_or_insert(Place::Face(face));
        } else if kept.len() < size {
            repeated += size - kept.len();
            first_repeated.get_or_insert(Place::Face(face));
        }
    });
    work.repairs.add(RepairKind::RepeatedCorners, repeated, first_repeated);
    work.repairs.add(RepairKind::SmallFaces, small, first_small);
    if small > 0 {
        work.repairs.renumber_faces(before);
    }
    true
}

/// Faces that are too small or name a vertex twice; `None` if there are none.
fn odd_faces(data: &MeshData) -> Option<Vec<bool>> {
    let mut last_face = vec![u32::MAX; data.positions.len()];
    let mut odd = vec![false; data.face_sizes.len()];
    let mut corner = 0;
    for (face, &size) in data.face_sizes.iter().enumerate() {
        let corners = corner..corner + size as usize;
        corner = corners.end;
        let names = |&vertex: &u32| std::mem::replace(&mut last_face[vertex as usize], face as u32) == face as u32;
        // All vertices must be marked.
        odd[face] = size < 3 || data.face_vertices[corners].iter().map(names).fold(false, |any, one| any | one);
    }
    odd.contains(&true).then_some(odd)
}

/// Corners of a face without those that repeat the one before, and without spikes.
fn clean(vertices: &[u32], corners: Range<usize>, kept: &mut Vec<usize>) {
    let vertex = |corner: usize| vertices[corner];
    for corner in corners {
        push(kept, corner, vertex);
    }
    // The same across the end: the first corners are walked again.
    let mut start = 0;
    while kept.len() - start >= 2 {
        let (first, last) = (kept[start], kept[kept.len() - 1]);
        if vertex(first) == vertex(last) {
            kept.pop();
        } else if kept.len() - start >= 3 && vertex(first) == vertex(kept[kept.len() - 2]) {
            // The last corner is a spike out of the first, which is there twice.
            kept.truncate(kept.len() - 2);
        } else if kept.len() - start >= 3 && vertex(kept[start + 1]) == vertex(last) {
            // The first corner is a spike out of the last.
            start += 2;
        } else {
            break;
        }
    }
    kept.drain(..start);
}

fn push(kept: &mut Vec<usize>, corner: usize, vertex: impl Fn(usize) -> u32) {
    if kept.last().is_some_and(|&last| vertex(last) == vertex(corner)) {
        return;
    }
    if kept.len() >= 2 && vertex(kept[kept.len() - 2]) == vertex(corner) {
        kept.pop();
        return;
    }
    kept.push(corner);
}

/// Corners whose vertex an earlier corner of the face has.
pub(super) fn crossed(data: &MeshData) -> Vec<u32> {
    let mut last_face = vec![u32::MAX; data.positions.len()];
    let mut crossed = Vec::new();
    let mut corners = 0u32..;
    for (face, &size) in (0..).zip(&data.face_sizes) {
        for corner in corners.by_ref().take(size as usize) {
            let vertex = data.face_vertices[corner as usize];
            if std::mem::replace(&mut last_face[vertex as usize], face) == face {
                crossed.push(corner);
            }
        }
    }
    crossed
}

/// Makes the faces anew out of corners of the old ones: `corners_of` adds those that a face keeps, none if it goes. Holes keep
/// their faces; edits of other faces than before go. Gives the number that each face had before.
pub(super) fn rebuild(
    work: &mut Work,
    vertices: &[u32],
    mut corners_of: impl FnMut(u32, Range<usize>, &mut Vec<usize>),
) -> Vec<u32> {
    let data = &mut work.data;
    let (mut before, mut corners, mut kept) = (Vec::new(), Vec::with_capacity(vertices.len()), Vec::new());
    let mut numbers = vec![u32::MAX; data.face_sizes.len()];
    let mut changed = vec![false; numbers.len()];
    let mut end = 0;
    for (face, &size) in (0..).zip(&std::mem::take(&mut data.face_sizes)) {
        let range = end..end + size as usize;
        end = range.end;
        kept.clear();
        corners_of(face, range, &mut kept);
        changed[face as usize] = kept.len() != size as usize;
        if !kept.is_empty() {
            numbers[face as usize] = before.len() as u32;
            before.push(face);
            data.face_sizes.push(kept.len() as u32);
            corners.append(&mut kept);
        }
    }
    data.face_vertices = corners.iter().map(|&corner| vertices[corner]).collect();
    let attributes = [
        data.texcoords.as_mut().map(|texcoords| &mut texcoords.indices),
        data.normals.as_mut().map(|normals| &mut normals.indices),
    ];
    for indices in attributes.into_iter().flatten() {
        *indices = corners.iter().map(|&corner| indices[corner]).collect();
    }
    work.repairs.lose_edits(&mut data.edits, &changed);
    data.edits.iter_mut().for_each(|edit| edit.face = numbers.get(edit.face as usize).copied().unwrap_or(edit.face));
    data.holes.retain_mut(|hole| {
        *hole = numbers[*hole as usize];
        *hole != u32::MAX
    });
    before
}
