//! How a plan ends: what nothing reads is left out, and the rest is numbered and put in its place.

use super::build::{Builder, GHOST, Piece};
use super::caps::{Caps, FRAME, POINTS};
use super::error::AdaptiveError;
use super::plan::{Leaf, LeafKind, Plan};
use crate::limit::{RowsMut, Stencils};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// Vertices, or leaves, for one thread at least.
const MIN_LEN: usize = 1024;

/// Caps whose rows are written together.
const CAPS: usize = 256;

/// Rows that are written together.
struct Part<'b> {
    source: Source<'b>,
    /// Number of rows.
    rows: usize,
    /// Number of terms.
    terms: usize,
}

/// Where rows come from.
enum Source<'b> {
    Refined(&'b Piece),
    Shared(&'b Stencils),
    Caps(Range<usize>),
}

impl Builder {
    /// Which refined vertices are read, by leaves or by others that are.
    fn used(&self) -> Vec<bool> {
        let used: Vec<AtomicBool> = (0..self.row_count).map(|_| AtomicBool::new(false)).collect();
        let control = self.control_vertices;
        // The centres, by which faces other than quads are cut in wedges.
        used[..self.centres.len()].iter().for_each(|used| used.store(true, Ordering::Relaxed));
        let mark = |vertex: u32| {
            if vertex & (GHOST | FRAME) == 0 && vertex >= control {
                used[(vertex - control) as usize].store(true, Ordering::Relaxed);
            }
        };
        self.grids.par_iter().with_min_len(16 * MIN_LEN).for_each(|&vertex| mark(vertex));
        for row in self.ghosts.iter().chain(&self.frames) {
            row.weights().iter().for_each(|&(vertex, _)| mark(vertex));
        }
        self.caps.for_each_read(mark);
        // A level is read by the next one only; but for the centres in the first, which read no refined vertices.
        for level in self.levels.iter().rev() {
            level.par_iter().for_each(|Piece { first, rows }| {
                for row in (0..rows.len()).filter(|row| used[first + row].load(Ordering::Relaxed)) {
                    rows.row(row).for_each(|(vertex, _)| mark(vertex));
                }
            });
        }
        used.into_iter().map(AtomicBool::into_inner).collect()
    }

    /// The rows in their order, and what makes them.
    fn parts<'b>(&'b self, used: &[bool], shared: &'b Stencils) -> Vec<Part<'b>> {
        let refined = |piece: &'b Piece| {
            let used = runs(piece, used).map(|run| [run.len(), terms(&piece.rows, run)]);
            let [rows, terms] = used.fold([0, 0], |[a, b], [rows, terms]| [a + rows, b + terms]);
            Part { source: Source::Refined(piece), rows, terms }
        };
        let pieces: Vec<&Piece> = self.levels.iter().flatten().collect();
        let mut parts: Vec<Part> = pieces.into_par_iter().map(refined).collect();
        parts.push(Part { source: Source::Shared(shared), rows: shared.len(), terms: shared.indices.len() });
        parts.extend((0..self.caps.len()).step_by(CAPS).map(|first| {
            let caps = first..self.caps.len().min(first + CAPS);
            let (rows, terms) = (POINTS as usize * caps.len(), self.caps.terms(caps.clone()));
            Part { source: Source::Caps(caps), rows, terms }
        }));
        parts
    }

    pub(super) fn finish(mut self) -> Result<Plan, AdaptiveError> {
        let used = self.used();
        let control = self.control_vertices;
        // The number of each vertex among those that are read.
        let mut next = control;
        let count = |&used: &bool| {
            next += u32::from(used);
            next - u32::from(used)
        };
        let numbers: Vec<u32> = used.iter().map(count).collect();
        let kept = next;
        let ghosts = kept..kept + self.ghosts.len() as u32;
        let frames = ghosts.end..ghosts.end + self.frames.len() as u32;
        let number = |vertex: u32| match vertex {
            _ if vertex < control => vertex,
            _ if vertex & GHOST != 0 => ghosts.start + (vertex & !GHOST),
            _ if vertex & FRAME != 0 => frames.start + (vertex & !FRAME),
            _ => numbers[(vertex - control) as usize],
        };
        let shared = [std::mem::take(&mut self.ghosts), std::mem::take(&mut self.frames)].concat();
        let shared = Stencils::new(shared);
        let parts = self.parts(&used, &shared);
        let all = parts.iter().map(|part| part.rows).sum();
        self.check_vertices(all)?;
        self.check("terms", parts.iter().map(|part| part.terms).sum(), u32::MAX as usize)?;
        let rows = Stencils::join(
            &parts,
            |part| [part.rows, part.terms],
            |part, rows| part.write(&used, &self.caps, number, rows),
        );
        drop(parts);

        let centres = control..control + self.centres.len() as u32;
        let start = |level: &Vec<Piece>| level.first().map_or(kept, |piece| numbers[piece.first]);
        let starts: Vec<u32> = self.levels.iter().map(start).chain([kept]).collect();
        let cap_points = frames.end..control + all as u32;
        self.grids.par_iter_mut().with_min_len(16 * MIN_LEN).for_each(|vertex| *vertex = number(*vertex));
        self.leaves.par_iter_mut().with_min_len(MIN_LEN).for_each(|leaf: &mut Leaf| {
            if leaf.kind == LeafKind::Cap {
                leaf.points += cap_points.start;
            }
        });
        Ok(Plan {
            options: self.options,
            control_vertices: control,
            rows,
            levels: starts.windows(2).map(|pair| pair[0]..pair[1]).collect(),
            grids: self.grids,
            leaves: self.leaves,
            centres,
            centre_faces: self.centres.into_keys().collect(),
            ghosts,
            frames,
            cap_points,
            roots: self.roots,
            face_roots: self.face_roots,
            nodes: self.nodes,
            refined: self.refined,
            rounded_caps: self.rounded_caps,
        })
    }
}

impl Part<'_> {
    fn write(&self, used: &[bool], caps: &Caps, number: impl Fn(u32) -> u32, rows: &mut RowsMut) {
        match &self.source {
            Source::Refined(piece) => runs(piece, used).for_each(|run| rows.push(&piece.rows, run, &number)),
            Source::Shared(shared) => rows.push(shared, 0..shared.len(), number),
            Source::Caps(range) => caps.write(range.clone(), number, rows),
        }
    }
}

/// The rows of a piece that are used, as ranges.
fn runs<'u>(piece: &Piece, used: &'u [bool]) -> impl Iterator<Item = Range<usize>> + use<'u> {
    let chunks = used[piece.first..piece.first + piece.rows.len()].chunk_by(|a, b| a == b);
    let ranges = chunks.scan(0, |start, chunk| {
        *start += chunk.len();
        Some((chunk[0], *start - chunk.len()..*start))
    });
    ranges.filter_map(|(used, range)| used.then_some(range))
}

fn terms(rows: &Stencils, range: Range<usize>) -> usize {
    (rows.offsets[range.end] - rows.offsets[range.start]) as usize
}
