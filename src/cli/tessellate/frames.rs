//! A tessellation of a moving mesh: faces and depths stay, vertices are filled again for each file.

use super::super::error::CliError;
use super::super::interrupt::{Watch, check_frames};
use super::super::motion::{Moving, moved};
use super::super::output::Progress;
use super::{Kind, Made, TessellateArgs};
use ash_subdiv::ControlMesh;
use ash_subdiv::dice::{Depth, DiceOptions, Plan, Tessellation};
use ash_subdiv::topology::Topology;
use std::path::PathBuf;

impl TessellateArgs {
    /// The frames in their files: as deep everywhere as the frame that asks for most.
    pub(super) fn tessellate_frames(
        &self,
        kind: Kind,
        files: &[PathBuf],
        moving: &Moving,
        progress: &Progress,
    ) -> Result<Made, CliError> {
        let first = moving.first()?;
        let texels = self.displacement.texels()?;
        progress.now("choosing depths");
        let options = self.options_of_frames(&first, moving)?;
        let plan = Plan::<f32>::new(&Topology::new(&first), &options)?;
        self.check_size(plan.sizes())?;
        let mut largest_error = if texels.is_none() { Some(0.0f64) } else { None };
        let (depth_histogram, unused) = (plan.depth_histogram(), plan.unused());
        let mut tessellation = Tessellation::of(plan, &first.data().positions)?;
        let [scale, bias] = self.displacement.amount(&first);
        progress.fill("tessellating", files.len() as u64);
        let mut counts = [0; 3];
        let _watch = Watch::start();
        for ((number, file), positions) in files.iter().enumerate().zip(moving.frames()) {
            check_frames(number, files.len())?;
            let positions = positions?;
            let single: Vec<[f32; 3]> = positions.iter().map(|p| p.map(|x| x as f32)).collect();
            tessellation.update(&single)?;
            if let Some(texels) = &texels {
                tessellation.displace(|texcoord| scale * texels.sample(texcoord) + bias)?;
            }
            counts = self.write_arrays(file, kind, &tessellation, &unused).or_else(|error| {
                check_frames(number, files.len())?;
                Err(error)
            })?;
            if let Some(error) = &mut largest_error {
                let plan = Plan::<f32>::new(&Topology::new(&moved(&first, positions)?), &options)?;
                *error = plan.error_bound()?.max(*error);
            }
            progress.advance(1);
        }
        self.note_error(largest_error, progress);
        Ok(Made { counts, depth_histogram, largest_error, frames: Some(moving.described()) })
    }

    /// The greatest depth of each facet in all frames.
    fn options_of_frames(&self, first: &ControlMesh, moving: &Moving) -> Result<DiceOptions, CliError> {
        let mut seen = Vec::new();
        for positions in moving.frames() {
            let points: Vec<_> = positions?.into_iter().map(Into::into).collect();
            seen.extend(self.camera.deciding(&points, self.aspect()));
        }
        let options = self.options(&seen)?;
        if matches!(options.depth, Depth::Fixed(_)) {
            return Ok(options);
        }
        let mut depths = vec![1; first.corner_count()];
        for positions in moving.frames() {
            let plan = Plan::<f32>::new(&Topology::new(&moved(first, positions?)?), &options)?;
            depths.iter_mut().zip(plan.depths()).for_each(|(depth, other)| *depth = other.max(*depth));
        }
        Ok(DiceOptions { depth: Depth::Each(depths), ..options })
    }
}
