//! Steps of refinement as sums that the device makes.

use super::error::TableError;
use super::leaves::{Refinement, RefinementStep};
use super::prepare::Step;
use crate::limit::Masks;

/// A refinement that grows by sums of its own.
struct Sums {
    refinement: Refinement,
    masks: Masks,
    /// The first four of the weights of each mask.
    starts: Vec<u32>,
}

impl Refinement {
    /// Steps that refine the whole mesh, of `control` vertices, and what is refined of the last one's mesh. The vertices of the last
    /// step follow on the control vertices; those of steps before it come last of all.
    ///
    /// # Errors
    /// [`TableError::EditsOnDevice`].
    pub(super) fn of_steps(steps: &[Step], control: u32, then: Option<&Self>) -> Result<Self, TableError> {
        let refinement = Self {
            first_vertex: control,
            steps: Vec::new(),
            blocks: Vec::new(),
            vertices: Vec::new(),
            weights: Vec::new(),
        };
        let mut sums = Sums { refinement, masks: Masks::default(), starts: Vec::new() };
        let lengths: Vec<u32> = steps.iter().map(|step| step.stencils.len() as u32).collect();
        let last = lengths.last().copied().unwrap_or(0);
        let mut end = then.map_or(control + last, |then| then.first_vertex + then.vertices() as u32);
        let mut before = 0;
        for (number, (step, &length)) in steps.iter().zip(&lengths).enumerate() {
            if !step.edits.is_empty() {
                return Err(TableError::EditsOnDevice);
            }
            let made = if number + 1 == steps.len() { control } else { end };
            sums.push(step, before, made);
            (before, end) = (made, end.max(made + length));
        }
        Ok(sums.finish(then))
    }
}

impl Sums {
    /// Appends a step from the vertices from number `before` on to those from `made` on.
    fn push(&mut self, step: &Step, before: u32, made: u32) {
        let Self { refinement, masks, starts } = self;
        let (first_block, rows) = (refinement.blocks.len() as u32, step.stencils.len());
        let mut terms = Vec::new();
        for row in 0..rows {
            // The greatest weights first: rows that look alike have one mask.
            terms.clear();
            terms.extend(step.stencils.row(row));
            terms.sort_by(|a, b| b.1.total_cmp(&a.1));
            let mask = masks.number(terms.iter().map(|&(_, weight)| weight)) as usize;
            if mask == starts.len() {
                starts.push(refinement.weights.len() as u32);
                let weight = |four: &[(u32, f64)], i| four.get(i).map_or(0.0, |&(_, weight)| weight as f32);
                refinement.weights.extend(terms.chunks(4).map(|four| std::array::from_fn(|i| weight(four, i))));
            }
            refinement.blocks.push([starts[mask], refinement.vertices.len() as u32]);
            let vertex = |four: &[(u32, f64)], i| before + four.get(i).unwrap_or(&terms[0]).0;
            refinement.vertices.extend(terms.chunks(4).map(|four| std::array::from_fn(|i| vertex(four, i))));
        }
        let first = made - refinement.first_vertex;
        refinement.steps.push(RefinementStep { rows: first..first + rows as u32, first_block, rows_of_block: 1 });
    }

    /// Appends the sums of another refinement, whose vertices have their numbers already.
    fn finish(self, then: Option<&Refinement>) -> Refinement {
        let mut all = self.refinement;
        let [blocks, vertices, weights] =
            [all.blocks.len(), all.vertices.len(), all.weights.len()].map(|length| length as u32);
        let Some(then) = then else {
            all.blocks.push([0, vertices]);
            return all;
        };
        let rows = then.first_vertex - all.first_vertex;
        all.steps.extend(then.steps.iter().map(|step| RefinementStep {
            rows: rows + step.rows.start..rows + step.rows.end,
            first_block: blocks + step.first_block,
            ..step.clone()
        }));
        all.blocks
            .extend(then.blocks.iter().map(|&[of_mask, of_vertices]| [weights + of_mask, vertices + of_vertices]));
        all.vertices.extend_from_slice(&then.vertices);
        all.weights.extend_from_slice(&then.weights);
        all
    }
}
