//! Arguments of `subdiv render`.

use super::super::camera::CameraArgs;
use super::super::cull::CullArgs;
use super::super::described::help;
use super::super::displacement::DisplacementArgs;
use super::super::error::CliError;
use super::super::evaluation::EvaluationArgs;
use super::super::motion::FramesArgs;
use super::super::parse::{self, Colour, Maker};
use super::super::shading::Shading;
use super::super::source::{DeviceArgs, MeshArgs};
use super::RenderOut;
use ash_subdiv::renderer::{Cull, Evaluation, Factor};
use ash_subdiv::{Construction, Spacing};
use clap::Args;
use std::path::PathBuf;

/// Factors of the patches, and which are culled.
#[derive(Debug, Args)]
pub(super) struct FactorArgs {
    /// The tessellation factor of every patch, from 1 to 64; without the tessellation stages (--evaluation) to 1024.
    #[arg(long, default_value_t = 8.0, value_parser = parse::segments)]
    pub(super) factor: f32,
    /// Factors such that segments are about this many pixels long, instead of one for all.
    #[arg(long, value_parser = parse::positive, conflicts_with_all = ["factor", "bend"])]
    pub(super) pixels: Option<f32>,
    /// Factors such that edges stray from their curves by about this many pixels: more where they are bent.
    #[arg(long, value_name = "PIXELS", value_parser = parse::positive, conflicts_with = "factor")]
    pub(super) bend: Option<f32>,
    /// Instead of drawing patches, subdivide each face this many times in a geometry shader.
    #[arg(
        long, value_name = "STEPS", value_parser = clap::value_parser!(u32).range(0..=3),
        conflicts_with_all = ["factor", "pixels", "bend", "cull", "displacement", "evaluation", "construction", "scheme"]
    )]
    pub(super) level: Option<u32>,
    #[command(flatten)]
    pub(super) cull: CullArgs,
}

impl FactorArgs {
    pub(super) fn factor(&self) -> Factor {
        match (self.pixels, self.bend, self.level) {
            (Some(pixels), ..) => Factor::Pixels(pixels),
            (_, Some(pixels), _) => Factor::Curvature(pixels),
            (.., Some(level)) => Factor::Uniform((1 << level) as f32),
            _ => Factor::Uniform(self.factor),
        }
    }

    /// In words.
    pub(super) fn text(&self) -> String {
        match self.factor() {
            factor if self.level.is_some() => format!("subdivided into {0} x {0} a face", factor.value()),
            Factor::Pixels(pixels) => format!("segments of {pixels} pixels"),
            Factor::Curvature(pixels) => format!("bends within {pixels} pixels"),
            factor => format!("factor {}", factor.value()),
        }
    }
}

#[derive(Debug, Args)]
#[command(after_help = help::<RenderOut>("", EXAMPLES), allow_negative_numbers = true)]
pub(in super::super) struct RenderArgs {
    #[command(flatten)]
    pub(super) mesh: MeshArgs,
    /// The picture, a PNG file. Missing folders are made.
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: PathBuf,
    #[command(flatten)]
    pub(super) frames: FramesArgs,
    /// Fit the camera to each frame anew, instead of once to all.
    #[arg(long, requires = "frames", help_heading = "Animation")]
    pub(super) refit: bool,
    #[command(flatten)]
    pub(super) evaluation: EvaluationArgs,
    #[command(flatten)]
    pub(super) factor: FactorArgs,
    /// Where the tessellator puts its vertices along an edge.
    #[arg(long, default_value = "equal", value_parser = parse::one_of(Spacing::ALL, Spacing::name))]
    pub(super) spacing: Spacing,
    /// Content of the picture.
    #[arg(long, value_enum, default_value_t = Shading::Lit)]
    pub(super) shading: Shading,
    /// The error at the top of the scale of --shading error-position (over the diagonal of the mesh's bounding box) or
    /// error-normal (radians); if not given, a round number that 99 % of all samples are below.
    #[arg(long, value_name = "ERROR", value_parser = parse::positive)]
    pub(super) error_max: Option<f32>,
    /// Stripes of --shading reflection-lines, from straight up to straight down; 12 if not given. More show smaller bends.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) stripes: Option<u32>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = parse::size)]
    pub(super) size: [u32; 2],
    /// Samples a pixel; 4 if not given, or what the device has.
    #[arg(long, value_name = "COUNT")]
    pub(super) samples: Option<u32>,
    /// R,G,B from 0 to 255, #rrggbb, or transparent.
    #[arg(long, value_name = "COLOUR", default_value = "#f3f1ec", value_parser = parse::colour)]
    pub(super) background: Colour,
    #[command(flatten)]
    pub(super) camera: CameraArgs,
    #[command(flatten, next_help_heading = "Displacement")]
    pub(super) displacement: DisplacementArgs,
    #[command(flatten, next_help_heading = "Device")]
    pub(super) device: DeviceArgs,
}

/// Stripes if no other number is given.
pub(super) const STRIPES: u32 = 12;

const EXAMPLES: &str = "\
.

Examples:
  subdiv render --shape creature -o creature.png
  subdiv render model.obj --shading wireframe --factor 3.5 --spacing odd -o wires.png
  subdiv render scene.glb --mesh-name Head --background transparent --yaw 40 -o head.png
  subdiv render model.obj --scheme acc --shading error-normal --error-max 0.1 -o errors.png
  subdiv render model.obj --adaptive 4 --shading levels -o levels.png
  subdiv render model.obj --adaptive 4 --factor 32 --shading reflection-lines -o stripes.png
  subdiv render model.obj --level 2 --shading wireframe -o subdivided.png
  subdiv render model.obj --evaluation cpu --factor 16 -o limit.png
  subdiv render --shape creature --displacement scales --displacement-scale 0.01 --pixels 4 -o scales.png
  subdiv render model.glb --animation Walk --time 0.5 -o walk.png
  subdiv render --shape tentacle --frames 0..60 -o frames/frame_%04d.png
  subdiv render --shape cloth --eye 3,4,5 --target 0,0,0 --fov 25 --size 1920x1080 -o cloth.png";

impl RenderArgs {
    /// Whether the CPU makes the vertices.
    pub(super) fn is_cpu(&self) -> bool {
        self.evaluation.evaluation == Maker::Cpu && self.factor.level.is_none()
    }

    /// Construction of the control points; an error if the evaluation does not go with what was asked for.
    pub(super) fn construction(&self) -> Result<Construction, CliError> {
        let factor = self.factor.factor;
        if factor > parse::MAX_FACTOR && self.evaluation.evaluation == Maker::Device(Evaluation::Tessellation) {
            return Err(CliError::Usage(format!(
                "--factor {factor}: the tessellation stages take at most {}: choose another --evaluation for more",
                parse::MAX_FACTOR
            )));
        }
        let culls = match self.evaluation.evaluation {
            Maker::Device(evaluation) => evaluation.culls(),
            Maker::Cpu => false,
        };
        let cpu = self.is_cpu();
        let tessellated = [
            ("--pixels", self.factor.pixels.is_some()),
            ("--bend", self.factor.bend.is_some()),
            ("--cull", self.factor.cull.cull() != Cull::NONE && !culls),
            ("--spacing", self.spacing != Spacing::Equal),
            ("--refine", cpu && self.mesh.source.refine > 0),
            ("--adaptive", cpu && self.mesh.source.adaptive().is_some()),
        ];
        self.evaluation.construction(&tessellated, self.displacement.is_given().then_some("--displacement"))
    }
}
