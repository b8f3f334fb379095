//! `subdiv render`: a picture of a mesh.

use super::camera::CameraArgs;
use super::error::CliError;
use super::info::Patches;
use super::output::{self, Progress, write_file};
use super::parse::{self, Colour};
use super::picture::unpremultiply;
use super::shading::Shading;
use super::source::{DeviceArgs, MeshArgs, tell_notices};
use ash::vk;
use ash_subdiv::gpu::DeviceProperties;
use ash_subdiv::headless::{Headless, HeadlessError, Offscreen, OffscreenDesc, save_png};
use ash_subdiv::renderer::ModelTables;
use ash_subdiv::table::CpuSurface;
use ash_subdiv::{Construction, ControlMesh, ModelOptions, Options, Renderer, Spacing, Target, View};
use clap::Args;
use glam::DVec3;
use serde::Serialize;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct RenderArgs {
    #[command(flatten)]
    mesh: MeshArgs,
    /// The picture, a PNG file. Missing folders are made.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// How the GPU makes the control points.
    #[arg(long, value_name = "HOW", default_value = Construction::TwoStage.name(), value_parser = parse::construction())]
    construction: Construction,
    /// The tessellation factor of every patch, from 1 to 64.
    #[arg(long, default_value_t = 8.0, value_parser = parse::factor)]
    factor: f32,
    /// Where the tessellator puts its vertices along an edge.
    #[arg(long, default_value = "equal", value_parser = parse::spacing())]
    spacing: Spacing,
    /// What the picture shows.
    #[arg(long, value_enum, default_value_t = Shading::Lit)]
    shading: Shading,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = parse::size)]
    size: [u32; 2],
    /// Samples a pixel; 4 if not given, or what the device has.
    #[arg(long, value_name = "COUNT")]
    samples: Option<u32>,
    /// R,G,B from 0 to 255, #rrggbb, or transparent.
    #[arg(long, value_name = "COLOUR", default_value = "#f3f1ec", value_parser = parse::colour)]
    background: Colour,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten, next_help_heading = "Device")]
    device: DeviceArgs,
}

const EXAMPLES: &str = "\
JSON: file, size[width, height], patches{regular, irregular_quad, triangle, pentagon}, construction, factor,
spacing, shading, samples, device.

Examples:
  subdiv render --shape creature -o creature.png
  subdiv render model.obj --shading wireframe --factor 3.5 --spacing odd -o wires.png
  subdiv render scene.glb --mesh-name Head --background transparent --yaw 40 -o head.png
  subdiv render --shape cloth --eye 3,4,5 --target 0,0,0 --fov 25 --size 1920x1080 -o cloth.png";

#[derive(Serialize)]
struct RenderOut<'a> {
    file: &'a str,
    size: [u32; 2],
    patches: Patches,
    construction: &'static str,
    factor: f32,
    spacing: &'static str,
    shading: String,
    samples: u32,
    device: &'a str,
}

pub(super) fn run(args: &RenderArgs, json: bool) -> Result<(), CliError> {
    let file = args.output.display().to_string();
    let ending = args.output.extension().map(|ending| ending.to_ascii_lowercase());
    if ending.is_none_or(|ending| ending != "png") {
        return Err(CliError::Usage(format!("--output {file}: pictures are PNG files: let the name end in .png")));
    }
    let progress = Progress::new("reading the mesh");
    let mesh = args.mesh.load()?;
    progress.now("building tables");
    let options = ModelOptions { spacing: args.spacing, ..args.mesh.model_options(args.construction) };
    let tables = ModelTables::new(&mesh, &options)?;
    tell_notices(tables.notices(), &progress);
    let patches = Patches::of(&tables);
    let [width, height] = args.size;
    let view = args.camera.view(&args.seen_points(&mesh)?, f64::from(width) / f64::from(height))?;
    progress.now("drawing");
    let (samples, device, mut pixels) = args.device.run(|headless| {
        let samples = args.check_limits(headless.properties())?;
        let pixels = args.draw(headless, samples, &view, tables, &mesh, &options)?;
        Ok((samples, headless.properties().name.clone(), pixels))
    })?;
    progress.now("writing the picture");
    if args.background.is_transparent() {
        unpremultiply(&mut pixels, args.shading.format() == vk::Format::R8G8B8A8_SRGB);
    }
    write_file(&args.output, |part| match save_png(part, vk::Extent2D { width, height }, &pixels) {
        Err(HeadlessError::Picture { message, .. }) => Err(message),
        result => result.map_err(|error| error.to_string()),
    })?;
    drop(progress);
    if json {
        return output::json_pretty(&RenderOut {
            file: &file,
            size: args.size,
            patches,
            construction: args.construction.name(),
            factor: args.factor,
            spacing: parse::spacing_name(args.spacing),
            shading: args.shading.name(),
            samples,
            device: &device,
        });
    }
    output::with_stdout(|out| {
        let factor = args.factor;
        Ok(writeln!(out, "{file}: {width} x {height}, {patches}, factor {factor}, {samples} samples, on {device}")?)
    })
}

impl RenderArgs {
    /// Points around which everything is that the picture shows.
    fn seen_points(&self, mesh: &ControlMesh) -> Result<Vec<DVec3>, CliError> {
        let mut points = Vec::new();
        if self.shading.shows_control_mesh() {
            points.extend(mesh.data().positions.iter().copied().map(DVec3::from));
        }
        if points.is_empty() {
            let (source, scheme) = (&self.mesh.source, self.mesh.scheme);
            let surface = CpuSurface::with_fallback(mesh, scheme, source.fallback(), source.refine)?;
            points = surface.control_points(|p| p).concat();
        }
        // Where nothing is drawn, such as where all faces are holes.
        if points.is_empty() {
            points.extend(mesh.bounds());
        }
        Ok(points)
    }

    /// Checks size and samples against the device; gives the samples.
    fn check_limits(&self, properties: &DeviceProperties) -> Result<u32, CliError> {
        let (device, max, [width, height]) = (&properties.name, properties.max_image_size, self.size);
        if width.max(height) > max {
            let message = format!("--size {width}x{height}: {device} draws at most {max} x {max} pixels");
            return Err(CliError::Work(message));
        }
        let known = properties.sample_counts();
        match self.samples {
            Some(samples) if known.contains(&samples) => Ok(samples),
            Some(samples) => {
                let known: Vec<String> = known.iter().map(u32::to_string).collect();
                Err(CliError::Work(format!("--samples {samples}: {device} has {}", known.join(", "))))
            }
            None => Ok(known.into_iter().filter(|&count| count <= 4).max().unwrap_or(1)),
        }
    }

    /// Draws the picture: rows from the top, four bytes RGBA a pixel.
    fn draw(
        &self,
        headless: &Headless,
        samples: u32,
        view: &View,
        tables: ModelTables,
        mesh: &ControlMesh,
        model_options: &ModelOptions,
    ) -> Result<Vec<u8>, CliError> {
        let samples = vk::SampleCountFlags::from_raw(samples);
        let [width, height] = self.size;
        let desc = OffscreenDesc { samples, color: self.shading.format(), ..OffscreenDesc::new(width, height) };
        let target = Offscreen::new(headless, &desc)?;
        let options = Options { styles: self.shading.styles(), ..Options::default() };
        let render_target = Target::dynamic(desc.color, desc.depth, desc.samples);
        // SAFETY: no handles of ours are given; every submission is waited for, so the renderer is dropped when idle.
        let mut renderer = unsafe { Renderer::new(headless.context(), &render_target, &options)? };
        let model = renderer.add_tables(tables, &mesh.positions_f32(), model_options)?;
        let draws = self.shading.draws(model, self.factor);
        // SAFETY: the command buffer is being recorded, outside rendering.
        headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, 0) })?;
        // SAFETY: inside rendering that fits the target, after the frame was prepared.
        let record = |cmd| unsafe { renderer.cmd_draw(cmd, 0, view, &draws) };
        let background = match desc.color {
            vk::Format::R8G8B8A8_SRGB => self.background.linear(),
            _ => self.background.0.map(|byte| f32::from(byte) / 255.0),
        };
        Ok(target.draw(headless, background, record)?)
    }
}
