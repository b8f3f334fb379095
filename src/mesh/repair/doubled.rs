//! Faces that lie on others of the same vertices.

use super::{Joints, Place, RepairKind, Work, faces};
use std::collections::HashMap;

/// Takes out faces on others. Tells whether there were any.
pub(super) fn mend(work: &mut Work, joints: &Joints) -> bool {
    let doubles = find(work, joints);
    let goes = |face: u32| doubles[face as usize] == Double::Copy;
    let count = (0..doubles.len() as u32).filter(|&face| goes(face)).count();
    let first = (0..doubles.len() as u32).find(|&face| goes(face));
    work.repairs.add(RepairKind::DoubledFaces, count, first.map(Place::Face));
    if count > 0 {
        let vertices = std::mem::take(&mut work.data.face_vertices);
        let before = faces::rebuild(work, &vertices, |face, corners, kept| {
            if !goes(face) {
                kept.extend(corners);
            }
        });
        work.repairs.renumber_faces(before);
    }
    count > 0
}

#[derive(Clone, Copy, PartialEq)]
enum Double {
    No,
    /// Lies on another, and goes.
    Copy,
    /// The back of another: may stay.
    Back,
}

fn find(work: &Work, joints: &Joints) -> Vec<Double> {
    let mut doubles = vec![Double::No; work.data.face_sizes.len()];
    // Only faces at wrong edges are looked at.
    let half_edges = joints.crowded.iter().map(|&(_, h)| h).chain(joints.opposed.iter().flatten().copied());
    let mut suspects: Vec<u32> = half_edges.map(|h| joints.faces[h as usize]).collect();
    suspects.sort_unstable();
    suspects.dedup();
    // Which of both sides is there.
    let mut sides: HashMap<Vec<u32>, [bool; 2]> = HashMap::new();
    for face in suspects {
        let (key, side) = canonical(&work.data.face_vertices[joints.corners(face)]);
        let seen = sides.entry(key).or_default();
        doubles[face as usize] = match (seen[side], seen[1 - side]) {
            (true, _) => Double::Copy,
            (false, true) => Double::Back,
            (false, false) => Double::No,
        };
        seen[side] = true;
    }
    decide_backs(&mut doubles, joints);
    doubles
}

/// A back goes where some of its edges have more than two faces with it, and none has without the backs. Where an edge has more
/// without them, too, the two faces belong to solids that touch.
fn decide_backs(doubles: &mut [Double], joints: &Joints) {
    let mut goes = vec![false; doubles.len()];
    let mut stays = vec![false; doubles.len()];
    for edge in joints.crowded_edges() {
        let count =
            |double| edge.iter().filter(|&&(_, h)| doubles[joints.faces[h as usize] as usize] == double).count();
        let (with, without) = (edge.len() - count(Double::Copy), count(Double::No));
        for &(_, h) in edge {
            let face = joints.faces[h as usize] as usize;
            goes[face] |= with > 2;
            stays[face] |= without > 2;
        }
    }
    for (face, double) in doubles.iter_mut().enumerate().filter(|(_, double)| **double == Double::Back) {
        *double = if goes[face] && !stays[face] { Double::Copy } else { Double::No };
    }
}

/// The vertices of a face from the lowest in the direction of its lower neighbour, and which direction that is.
fn canonical(vertices: &[u32]) -> (Vec<u32>, usize) {
    let count = vertices.len();
    let lowest = (0..count).min_by_key(|&corner| vertices[corner]).unwrap_or(0);
    let forward = |k: usize| vertices[(lowest + k) % count];
    let backward = |k: usize| vertices[(lowest + count - k) % count];
    match forward(1) <= backward(1) {
        true => ((0..count).map(forward).collect(), 0),
        false => ((0..count).map(backward).collect(), 1),
    }
}
