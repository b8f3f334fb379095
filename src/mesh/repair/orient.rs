//! Faces that run the other way round than their neighbours.

use super::{Joints, NO_TWIN, Place, RepairKind, Work};

/// Turns over as few faces of each piece as go with the others.
pub(super) fn mend(work: &mut Work, joints: &Joints) {
    let turned = turned_faces(work, joints);
    let count = turned.iter().filter(|turned| **turned).count();
    let first = turned.iter().position(|turned| *turned);
    work.repairs.add(RepairKind::TurnedFaces, count, first.map(|face| Place::Face(face as u32)));
    let data = &mut work.data;
    work.repairs.lose_edits(&mut data.edits, &turned);
    let attributes = [
        data.texcoords.as_mut().map(|texcoords| &mut texcoords.indices),
        data.normals.as_mut().map(|normals| &mut normals.indices),
    ];
    for numbers in attributes.into_iter().flatten().chain([&mut data.face_vertices]) {
        for (face, _) in turned.iter().enumerate().filter(|(_, turned)| **turned) {
            // The first corner stays the first.
            numbers[joints.corners(face as u32)][1..].reverse();
        }
    }
}

/// Faces to turn: a walk over each piece, nearest faces first.
fn turned_faces(work: &Work, joints: &Joints) -> Vec<bool> {
    let vertices = &work.data.face_vertices;
    let mut across = joints.twins.clone();
    for &[a, b] in &joints.opposed {
        across[a as usize] = b;
        across[b as usize] = a;
    }
    let count = work.data.face_sizes.len();
    let (mut turned, mut seen) = (vec![false; count], vec![false; count]);
    let mut piece = Vec::new();
    for start in 0..count as u32 {
        if std::mem::replace(&mut seen[start as usize], true) {
            continue;
        }
        piece.clear();
        piece.push(start);
        let mut walked = 0;
        while let Some(&face) = piece.get(walked) {
            walked += 1;
            for half_edge in joints.corners(face) {
                let other = across[half_edge];
                if other == NO_TWIN {
                    continue;
                }
                let neighbour = joints.faces[other as usize] as usize;
                if !std::mem::replace(&mut seen[neighbour], true) {
                    let opposed = vertices[half_edge] == vertices[other as usize];
                    turned[neighbour] = turned[face as usize] != opposed;
                    piece.push(neighbour as u32);
                }
            }
        }
        let count = piece.iter().filter(|&&face| turned[face as usize]).count();
        if 2 * count > piece.len() {
            piece.iter().for_each(|&face| turned[face as usize] = !turned[face as usize]);
        }
    }
    turned
}
