//! `subdiv screen`: how far the drawn triangles are from the limit surface on the screen.

use super::camera::CameraArgs;
use super::cull::CullArgs;
use super::described::{described, help};
use super::error::CliError;
use super::local::Local;
use super::output::{self, Progress, Table};
use super::parse;
use super::source::{DeviceArgs, MeshArgs, report_notices};
use ash_subdiv::capture::{CaptureDraw, Captured};
use ash_subdiv::measure::{PixelDeviation, ScreenError, screen_error};
use ash_subdiv::renderer::Factor;
use ash_subdiv::{Construction, ModelOptions, Spacing};
use clap::Args;
use serde::Serialize;
use std::fmt::Display;

/// The factors of OpenSubdiv's uniform levels.
const UNIFORM: [f32; 6] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];

#[derive(Debug, Args)]
#[command(after_help = help::<ScreenOut>(NOTES, EXAMPLES))]
pub(super) struct ScreenArgs {
    #[command(flatten)]
    mesh: MeshArgs,
    /// Factors such that segments are about this many pixels long; several with commas between. 4 if neither this nor --bend
    /// is given.
    #[arg(long, value_delimiter = ',', value_parser = parse::positive)]
    pixels: Vec<f32>,
    /// Factors such that edges stray from their curves by about this many pixels; several with commas between.
    #[arg(long, value_name = "PIXELS", value_delimiter = ',', value_parser = parse::positive)]
    bend: Vec<f32>,
    #[command(flatten)]
    cull: CullArgs,
    /// Where the tessellator puts its vertices along an edge.
    #[arg(long, default_value = "equal", value_parser = parse::one_of(Spacing::ALL, Spacing::name))]
    spacing: Spacing,
    /// Construction of the control points on the GPU.
    #[arg(long, value_name = "HOW", default_value = Construction::TwoStage.name(), value_parser = parse::one_of(Construction::ALL, Construction::name))]
    construction: Construction,
    /// Width and height of the screen in pixels.
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = parse::size)]
    size: [u32; 2],
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten, next_help_heading = "Device")]
    device: DeviceArgs,
}

const NOTES: &str = "\
shift: pixels between the triangle and the exact surface at the same (u, v); what textures are shifted by.
shape: its part along the normal; what outlines are off by.
facets: pixels between the triangle and the patch itself; what more triangles would take away. The error of the
patches is in shift and shape, and their floor.
rms and 99 % are over the area on the screen, that of closed meshes where they face the eye; what is hidden by
something in front counts. Triangles are counted as the device makes them. Equal is the first uniform factor of
1, 2, 4, 8, 16, 32 whose 99 % is no more than 5 % or 0.001 pixels larger.

";

const EXAMPLES: &str = "\
.

Examples:
  subdiv screen --shape creature
  subdiv screen model.obj --pixels 4,8 --bend 0.25 --cull back --size 1920x1080 --zoom 4 --json";

described! {
    #[derive(Serialize)]
    struct ScreenOut<'a> {
        mesh: String,
        device: &'a str,
        size: [u32; 2] = "[width, height]",
        spacing: &'static str,
        construction: &'static str,
        rows: &'a [Row],
    }
}

described! {
    #[derive(Serialize)]
    struct Row {
        metric: &'static str = "pixels, bend or uniform",
        value: f32,
        triangles: u64,
        samples: u64,
        shift: DeviationOut,
        shape: DeviationOut,
        facets: DeviationOut,
        equal: Option<EqualOut> = "null for uniform",
    }
}

described! {
    #[derive(Clone, Copy, Serialize)]
    struct DeviationOut {
        rms: f64,
        p99: f64,
        max: f64,
    }
}

described! {
    /// The coarsest uniform factors that are as good.
    #[derive(Serialize)]
    struct EqualOut {
        shift: Option<LevelOut> = "null if no factor up to 32 is as good",
        shape: Option<LevelOut>,
        facets: Option<LevelOut>,
    }
}

described! {
    #[derive(Clone, Copy, Serialize)]
    struct LevelOut {
        factor: f32,
        triangles: u64,
    }
}

impl From<PixelDeviation> for DeviationOut {
    fn from(PixelDeviation { rms, p99, max }: PixelDeviation) -> Self {
        Self { rms, p99, max }
    }
}

impl Row {
    fn new(factor: Factor, error: ScreenError) -> Self {
        let metric = match factor {
            Factor::Pixels(_) => "pixels",
            Factor::Curvature(_) => "bend",
            _ => "uniform",
        };
        let ScreenError { triangles, samples, shift, shape, facets, .. } = error;
        Self {
            metric,
            value: factor.value(),
            triangles,
            samples,
            shift: shift.into(),
            shape: shape.into(),
            facets: facets.into(),
            equal: None,
        }
    }

    fn text(&self) -> String {
        format!("{} {}", self.metric, self.value)
    }

    /// The first of some rows that is as good, or as good as.
    fn equal(&self, uniform: &[Self], of: fn(&Self) -> DeviationOut) -> Option<LevelOut> {
        let p99 = of(self).p99;
        let level = uniform.iter().find(|row| of(row).p99 <= (1.05 * p99).max(p99 + 1e-3))?;
        Some(LevelOut { factor: level.value, triangles: level.triangles })
    }
}

impl ScreenArgs {
    /// Factors that follow the view.
    fn adaptive(&self) -> Vec<Factor> {
        let pixels = self.pixels.iter().copied().map(Factor::Pixels);
        let factors: Vec<_> = pixels.chain(self.bend.iter().copied().map(Factor::Curvature)).collect();
        if factors.is_empty() { vec![Factor::Pixels(4.0)] } else { factors }
    }
}

pub(super) fn run(args: &ScreenArgs, json: bool) -> Result<(), CliError> {
    args.mesh.source.refuse_leaves()?;
    let progress = Progress::new("reading the mesh");
    let (mesh, local) = Local::of(args.mesh.load(&progress)?)?;
    progress.now("building tables");
    let options = ModelOptions { spacing: args.spacing, ..args.mesh.model_options(args.construction) };
    let [width, height] = args.size;
    let aspect = f64::from(width) / f64::from(height);
    let view = args.camera.in_space(local).view(&args.mesh.hull(&mesh)?, aspect)?.sized(width, height);
    let (device, mut adaptive, uniform) = args.device.run(|headless| {
        let captured = Captured::new(headless, &mesh, &options)?;
        report_notices(captured.tables().notices(), &progress);
        progress.now("measuring");
        let row = |factor: Factor| -> Result<Row, CliError> {
            let draw = CaptureDraw { view, cull: args.cull.cull(), ..CaptureDraw::new(factor) };
            Ok(Row::new(factor, screen_error(&captured, &mesh, &draw)?))
        };
        let adaptive = args.adaptive().into_iter().map(row).collect::<Result<Vec<_>, _>>()?;
        let uniform = UNIFORM.into_iter().map(Factor::Uniform).map(row).collect::<Result<Vec<_>, _>>()?;
        Ok((headless.properties().name.clone(), adaptive, uniform))
    })?;
    drop(progress);
    for row in &mut adaptive {
        row.equal = Some(EqualOut {
            shift: row.equal(&uniform, |row| row.shift),
            shape: row.equal(&uniform, |row| row.shape),
            facets: row.equal(&uniform, |row| row.facets),
        });
    }
    adaptive.extend(uniform);
    let out = ScreenOut {
        mesh: args.mesh.source.name(),
        device: &device,
        size: args.size,
        spacing: args.spacing.name(),
        construction: args.construction.name(),
        rows: &adaptive,
    };
    if json { output::json_pretty(&out) } else { print(&out) }
}

fn print(out: &ScreenOut) -> Result<(), CliError> {
    let mut table = Table::new(&[1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
    let head = ["shift rms", "99 %", "max", "shape rms", "99 %", "max", "facets rms", "99 %", "max"];
    let row = |table: &mut Table, name: &str, triangles: &dyn Display, [a, b, c, d, e, f, g, h, i]: [String; 9]| {
        table.row([&name, triangles, &a, &b, &c, &d, &e, &f, &g, &h, &i]);
    };
    row(&mut table, "factors", &"triangles", head.map(String::from));
    for r in out.rows {
        let (shift, shape, facets) = (r.shift, r.shape, r.facets);
        let numbers = [shift, shape, facets].map(|d| [d.rms, d.p99, d.max].map(|pixels| format!("{pixels:.4}")));
        let [[a, b, c], [d, e, f], [g, h, i]] = numbers;
        row(&mut table, &r.text(), &r.triangles, [a, b, c, d, e, f, g, h, i]);
    }
    table.print()?;
    output::with_stdout(|stdout| {
        let [width, height] = out.size;
        writeln!(stdout, "in pixels of {width} x {height}; {}, on {}", out.mesh, out.device)?;
        for row in out.rows {
            let Some(equal) = &row.equal else { continue };
            let (text, triangles) = (row.text(), row.triangles);
            for (what, level) in [("shift", equal.shift), ("shape", equal.shape), ("facets", equal.facets)] {
                match level {
                    Some(LevelOut { factor, triangles: uniform }) => {
                        let times = uniform as f64 / triangles.max(1) as f64;
                        writeln!(
                            stdout,
                            "{text}, {what}: {triangles} triangles; uniform {factor} is as good with {uniform}, \
                             {times:.2} times as many"
                        )?;
                    }
                    None => writeln!(
                        stdout,
                        "{text}, {what}: {triangles} triangles; no uniform factor up to 32 is as good"
                    )?,
                }
            }
        }
        Ok(())
    })
}
