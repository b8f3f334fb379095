//! Animations: the mesh at a time, and sequences of files.

use super::described::described;
use super::error::CliError;
use super::local::Local;
use super::output::Progress;
use super::parse;
use super::source::SourceArgs;
use ash_subdiv::ControlMesh;
use ash_subdiv::mesh::{Animated, Animations};
use clap::Args;
use glam::DVec3;
use serde::Serialize;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The time at which the mesh is taken.
#[derive(Debug, Args)]
pub(super) struct TimeArgs {
    /// Take the mesh as its animation has it at this time (glTF, and shapes that move).
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = parse::seconds)]
    pub(super) time: Option<f64>,
    /// The animation, by its name or number; the first if not given. `subdiv info` lists them.
    #[arg(long, value_name = "NAME")]
    pub(super) animation: Option<String>,
}

impl TimeArgs {
    /// The animation that is asked for.
    pub(super) fn choose(&self, source: &SourceArgs, animations: &Animations) -> Result<usize, CliError> {
        let name = source.name();
        if animations.is_empty() {
            return Err(CliError::Usage(format!(
                "{name} has no animations: leave --time, --frames and --animation out"
            )));
        }
        match &self.animation {
            Some(animation) => {
                animations.find(animation).map_err(|error| CliError::Usage(format!("--animation: {name}: {error}")))
            }
            None => Ok(0),
        }
    }
}

/// A sequence of files instead of one.
#[derive(Debug, Args)]
#[command(next_help_heading = "Animation")]
pub(super) struct FramesArgs {
    /// Write a file for each of these frames of the animation, the last one excluded; frame N is at N / fps seconds. The file's name
    /// has %d or %04d where the number is to be.
    #[arg(long, value_name = "FIRST..END", value_parser = parse::frames, conflicts_with = "time")]
    frames: Option<Range<u32>>,
    /// Frames a second.
    #[arg(long, value_name = "FPS", default_value_t = 30.0, value_parser = parse::rate, requires = "frames")]
    fps: f64,
}

impl FramesArgs {
    pub(super) fn is_given(&self) -> bool {
        self.frames.is_some()
    }

    /// Names of the files, one a frame; `output` itself if there are no frames.
    ///
    /// # Errors
    /// A name with frames that has no place for the number, or several.
    pub(super) fn files(&self, output: &Path) -> Result<Vec<PathBuf>, CliError> {
        let Some(frames) = &self.frames else { return Ok(vec![output.to_owned()]) };
        let name = output.to_string_lossy();
        let pattern = Pattern::of(&name).ok_or_else(|| {
            CliError::Usage(format!(
                "--output {name}: name one place for the number of the frame, such as frame_%04d.png"
            ))
        })?;
        Ok(frames.clone().map(|frame| pattern.name(frame).into()).collect())
    }

    /// The moving mesh, if there are frames.
    pub(super) fn load(&self, source: &SourceArgs, progress: &Progress) -> Result<Option<Moving>, CliError> {
        let Some(frames) = self.frames.clone() else { return Ok(None) };
        let Animated { mesh, animations, .. } = source.load_animated(progress)?;
        let animation = source.time.choose(source, &animations)?;
        let (fps, local) = (self.fps, None);
        Ok(Some(Moving { rest: mesh, animations, animation, frames, fps, local }))
    }

    /// Number of frames, if there are any.
    pub(super) fn count(&self) -> Option<usize> {
        self.frames.as_ref().map(ExactSizeIterator::len)
    }
}

described! {
    /// A sequence of files.
    #[derive(Serialize)]
    pub(super) struct FramesOut {
        animation: String = "its name or number",
        first: u32,
        count: usize,
        fps: f64,
    }
}

/// A mesh in the frames of an animation.
pub(super) struct Moving {
    rest: ControlMesh,
    animations: Animations,
    animation: usize,
    frames: Range<u32>,
    fps: f64,
    /// The space that positions are given in, if it is not the file's.
    local: Option<Local>,
}

impl Moving {
    /// Positions of the control vertices, frame by frame.
    pub(super) fn frames(&self) -> impl Iterator<Item = Result<Vec<[f64; 3]>, CliError>> {
        self.frames.clone().map(|frame| self.positions(f64::from(frame) / self.fps))
    }

    fn positions(&self, seconds: f64) -> Result<Vec<[f64; 3]>, CliError> {
        let mut positions = positions(&self.rest, &self.animations, self.animation, seconds)?;
        self.local.iter().for_each(|local| local.take_positions(&mut positions));
        Ok(positions)
    }

    /// The same in a local space.
    pub(super) fn in_space(self, local: Local) -> Self {
        Self { local: Some(local), ..self }
    }

    /// The mesh in its first frame.
    pub(super) fn first(&self) -> Result<ControlMesh, CliError> {
        moved(&self.rest, self.positions(f64::from(self.frames.start) / self.fps)?)
    }

    /// Smallest and largest coordinates of all frames.
    pub(super) fn bounds(&self) -> Result<[DVec3; 2], CliError> {
        let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for positions in self.frames() {
            for position in positions?.into_iter().map(DVec3::from) {
                bounds = [bounds[0].min(position), bounds[1].max(position)];
            }
        }
        Ok(bounds)
    }

    pub(super) fn described(&self) -> FramesOut {
        let animation = self.animations.name(self.animation).map_or_else(|| self.animation.to_string(), str::to_owned);
        FramesOut { animation, first: self.frames.start, count: self.frames.len(), fps: self.fps }
    }
}

fn positions(
    mesh: &ControlMesh,
    animations: &Animations,
    animation: usize,
    seconds: f64,
) -> Result<Vec<[f64; 3]>, CliError> {
    let mut positions = vec![[0.0; 3]; mesh.vertex_count()];
    animations.positions_f64(animation, seconds, &mut positions)?;
    Ok(positions)
}

/// A mesh with its control vertices elsewhere.
pub(super) fn moved(mesh: &ControlMesh, positions: Vec<[f64; 3]>) -> Result<ControlMesh, CliError> {
    Ok(ControlMesh::new(ash_subdiv::MeshData { positions, ..mesh.data().clone() })?)
}

/// The mesh of an animation at a time.
pub(super) fn at_time(animated: &Animated, animation: usize, seconds: f64) -> Result<ControlMesh, CliError> {
    moved(&animated.mesh, positions(&animated.mesh, &animated.animations, animation, seconds)?)
}

/// A name with a place for a number, as printf has it: `%d`, or `%04d` for four digits at least; `%%` is a percent sign.
struct Pattern {
    before: String,
    digits: usize,
    after: String,
}

impl Pattern {
    fn of(name: &str) -> Option<Self> {
        let (mut texts, mut found) = ([String::new(), String::new()], None);
        let mut rest = name.chars();
        while let Some(letter) = rest.next() {
            let text = &mut texts[usize::from(found.is_some())];
            if letter != '%' {
                text.push(letter);
                continue;
            }
            if let Some(after) = rest.as_str().strip_prefix('%') {
                text.push('%');
                rest = after.chars();
                continue;
            }
            let (digits, after) = rest.as_str().split_once('d')?;
            let digits = match digits {
                "" => 0,
                padded => padded.strip_prefix('0')?.parse().ok().filter(|digits| (1..=20).contains(digits))?,
            };
            if found.replace(digits).is_some() {
                return None;
            }
            rest = after.chars();
        }
        let [before, after] = texts;
        Some(Self { before, digits: found?, after })
    }

    fn name(&self, number: u32) -> String {
        let Self { before, digits, after } = self;
        format!("{before}{number:0digits$}{after}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_names() {
        let name = |pattern: &str| Pattern::of(pattern).map(|pattern| pattern.name(12));
        assert_eq!(name("a_%04d.png").as_deref(), Some("a_0012.png"));
        assert_eq!(name("%d").as_deref(), Some("12"));
        assert_eq!(name("%01d/100%%.obj").as_deref(), Some("12/100%.obj"));
        assert_eq!(name("é%03dß").as_deref(), Some("é012ß"));
        for wrong in ["a.png", "%", "%x", "%4d", "%-4d", "%0d", "%0999999999999d", "%d%d", "%%d"] {
            assert_eq!(name(wrong), None, "{wrong}");
        }
    }
}
