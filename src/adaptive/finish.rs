//! How a plan ends: what nothing reads is left out, and the rest is numbered and put in its place.

use super::build::{Builder, GHOST, Piece};
use super::caps::{Caps, FRAME, POINTS};
use super::error::AdaptiveError;
use super::options::Sums;
use super::plan::{Leaf, LeafKind, Plan};
use super::rows::{BlocksMut, Rows};
use crate::limit::{MaskedRows, Masks};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// Vertices, or leaves, for one thread at least.
const MIN_LEN: usize = 1024;

/// Caps that are written together.
const CAPS: usize = 256;

/// Blocks that are written together.
struct Part<'b> {
    source: Source<'b>,
    /// Number of blocks.
    blocks: usize,
    /// Number of vertices that they read.
    vertices: usize,
}

/// Where blocks come from.
enum Source<'b> {
    /// Some rows, and the masks of all by those that they have.
    Rows(&'b MaskedRows, Vec<Range<usize>>, Vec<u32>),
    Caps(Range<usize>),
}

/// The masks of single rows.
#[derive(Default)]
struct SingleMasks {
    masks: Masks,
    rows: Rows,
}

impl SingleMasks {
    /// The numbers of the masks of some rows.
    fn add(&mut self, rows: &MaskedRows) -> Vec<u32> {
        let number = |mask| {
            let weights = rows.weights.weights(mask);
            let number = self.masks.number(weights.iter().copied());
            if number as usize == self.rows.masks.len() {
                self.rows.add_mask(weights.len(), std::iter::once((0..).zip(weights.iter().copied())));
            }
            number
        };
        (0..rows.weights.len() as u32).map(number).collect()
    }
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
                    rows.masked(row).1.iter().for_each(|&vertex| mark(vertex));
                }
            });
        }
        used.into_iter().map(AtomicBool::into_inner).collect()
    }

    /// The blocks in their order; `shared` are ghosts and frames.
    fn parts<'b>(&'b self, used: &[bool], shared: &'b MaskedRows, masks: &mut SingleMasks) -> Vec<Part<'b>> {
        let mut of_rows = |rows: &'b MaskedRows, runs: Vec<Range<usize>>| {
            let count = runs.iter().map(|run| [run.len(), rows.term_count(run.clone())]);
            let [blocks, vertices] = count.fold([0, 0], |[a, b], [blocks, terms]| [a + blocks, b + terms]);
            Part { source: Source::Rows(rows, runs, masks.add(rows)), blocks, vertices }
        };
        let pieces: Vec<&Piece> = self.levels.iter().flatten().collect();
        let found: Vec<Vec<Range<usize>>> = pieces.par_iter().map(|piece| runs(piece, used).collect()).collect();
        let mut parts: Vec<Part> = pieces.iter().zip(found).map(|(piece, runs)| of_rows(&piece.rows, runs)).collect();
        parts.push(of_rows(shared, std::iter::once(0..shared.len()).collect()));
        parts.extend((0..self.caps.len()).step_by(CAPS).map(|first| {
            let caps = first..self.caps.len().min(first + CAPS);
            let (blocks, vertices) = (caps.len(), self.caps.read_count(caps.clone()));
            Part { source: Source::Caps(caps), blocks, vertices }
        }));
        parts
    }

    // Longer than a screen: each step numbers what the next ones read.
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
        let mut shared = MaskedRows::default();
        self.ghosts.iter().chain(&self.frames).for_each(|row| shared.push_row(row));
        let mut masks = SingleMasks::default();
        let parts = self.parts(&used, &shared, &mut masks);
        let mut rows = masks.rows;
        let cap_mask = rows.masks.len() as u32;
        self.caps.add_masks(&mut rows);
        let cap_points = frames.end as usize..frames.end as usize + POINTS as usize * self.caps.len();
        self.check_vertices(cap_points.end - control as usize)?;
        let read = parts.iter().map(|part| part.vertices).sum();
        self.check("vertices read by sums", read, u32::MAX as usize)?;
        self.check("weights of masks", rows.weights.len(), u32::MAX as usize)?;
        let rows = rows.with_blocks(
            &parts,
            |part| [part.blocks, part.vertices],
            |part, blocks| part.write(&self.caps, cap_mask, number, blocks),
        );
        drop(parts);

        let centres = control..control + self.centres.len() as u32;
        let start = |level: &Vec<Piece>| level.first().map_or(kept, |piece| numbers[piece.first]);
        let starts: Vec<u32> = self.levels.iter().map(start).chain([kept]).collect();
        let cap_points = cap_points.start as u32..cap_points.end as u32;
        self.grids.par_iter_mut().with_min_len(16 * MIN_LEN).for_each(|vertex| *vertex = number(*vertex));
        self.leaves.par_iter_mut().with_min_len(MIN_LEN).for_each(|leaf: &mut Leaf| {
            if leaf.kind == LeafKind::Cap {
                leaf.points += cap_points.start;
            }
        });
        let mut plan = Plan {
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
        };
        if plan.options.sums == Sums::Composed {
            plan.compose()?;
        }
        Ok(plan)
    }
}

impl Part<'_> {
    fn write(&self, caps: &Caps, cap_mask: u32, number: impl Fn(u32) -> u32, blocks: &mut BlocksMut) {
        match &self.source {
            Source::Rows(rows, runs, masks) => {
                for (mask, vertices) in runs.iter().cloned().flatten().map(|row| rows.masked(row)) {
                    blocks.push(masks[mask as usize], vertices.iter().map(|&vertex| number(vertex)));
                }
            }
            Source::Caps(range) => caps.write(range.clone(), cap_mask, number, blocks),
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
