//! `subdiv render`: a picture of a mesh.

use super::camera::CameraArgs;
use super::cull::CullArgs;
use super::displacement::{DisplacementArgs, texture};
use super::error::CliError;
use super::error_map::{ErrorMap, ErrorSet};
use super::evaluation::EvaluationArgs;
use super::info::Patches;
use super::legend::Legend;
use super::output::{self, Progress, write_file};
use super::parse::{self, Colour};
use super::picture::unpremultiply;
use super::shading::Shading;
use super::source::{DeviceArgs, MeshArgs, tell_notices};
use ash::vk;
use ash_subdiv::capture::{CaptureDraw, Captured, CapturedFactors};
use ash_subdiv::gpu::DeviceProperties;
use ash_subdiv::headless::{Headless, HeadlessError, Offscreen, OffscreenDesc, Texels, save_png};
use ash_subdiv::measure::Quantity;
use ash_subdiv::renderer::ModelTables;
use ash_subdiv::renderer::{Cull, DisplacementId, Evaluation, Factor};
use ash_subdiv::{Construction, ControlMesh, DrawItem, ModelOptions, Options, Renderer, Spacing, Target, View};
use clap::Args;
use glam::DVec3;
use serde::Serialize;
use std::path::PathBuf;

/// How finely patches are cut, and which are left out.
#[derive(Debug, Args)]
struct FactorArgs {
    /// The tessellation factor of every patch, from 1 to 64.
    #[arg(long, default_value_t = 8.0, value_parser = parse::factor)]
    factor: f32,
    /// Factors such that segments are about this many pixels long, instead of one for all.
    #[arg(long, value_parser = parse::positive, conflicts_with_all = ["factor", "bend"])]
    pixels: Option<f32>,
    /// Factors such that edges stray from their curves by about this many pixels: more where they are bent.
    #[arg(long, value_name = "PIXELS", value_parser = parse::positive, conflicts_with = "factor")]
    bend: Option<f32>,
    /// Instead of drawing patches, subdivide each face this many times in a geometry shader.
    #[arg(
        long, value_name = "STEPS", value_parser = clap::value_parser!(u32).range(0..=3),
        conflicts_with_all = ["factor", "pixels", "bend", "cull", "displacement", "evaluation", "construction", "scheme"]
    )]
    level: Option<u32>,
    #[command(flatten)]
    cull: CullArgs,
}

impl FactorArgs {
    fn factor(&self) -> Factor {
        match (self.pixels, self.bend, self.level) {
            (Some(pixels), ..) => Factor::Pixels(pixels),
            (_, Some(pixels), _) => Factor::Curvature(pixels),
            (.., Some(level)) => Factor::Uniform((1 << level) as f32),
            _ => Factor::Uniform(self.factor),
        }
    }

    /// In words.
    fn text(&self) -> String {
        match self.factor() {
            factor if self.level.is_some() => format!("subdivided into {0} x {0} a face", factor.value()),
            Factor::Pixels(pixels) => format!("segments of {pixels} pixels"),
            Factor::Curvature(pixels) => format!("bends within {pixels} pixels"),
            factor => format!("factor {}", factor.value()),
        }
    }
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct RenderArgs {
    #[command(flatten)]
    mesh: MeshArgs,
    /// The picture, a PNG file. Missing folders are made.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    evaluation: EvaluationArgs,
    #[command(flatten)]
    factor: FactorArgs,
    /// Where the tessellator puts its vertices along an edge.
    #[arg(long, default_value = "equal", value_parser = parse::spacing())]
    spacing: Spacing,
    /// What the picture shows.
    #[arg(long, value_enum, default_value_t = Shading::Lit)]
    shading: Shading,
    /// The error at the top of the scale of --shading error-position (over the diagonal of the mesh's bounding box) or
    /// error-normal (radians); if not given, a round number that 99 % of all samples are below.
    #[arg(long, value_name = "ERROR", value_parser = parse::positive)]
    error_max: Option<f32>,
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
    #[command(flatten, next_help_heading = "Displacement")]
    displacement: DisplacementArgs,
    #[command(flatten, next_help_heading = "Device")]
    device: DeviceArgs,
}

const EXAMPLES: &str = "\
JSON: file, size[width, height], patches{regular, irregular_quad, triangle, pentagon}, evaluation, construction,
factor (null unless one for all), pixels, bend, level (null unless given), spacing, shading, samples, device,
error{top, largest} (null unless an error is shown),
statistics{patches_drawn, patches_culled, largest_factor, factors_clamped}: factors_clamped tells whether an
edge asked for more segments than the device has.

Examples:
  subdiv render --shape creature -o creature.png
  subdiv render model.obj --shading wireframe --factor 3.5 --spacing odd -o wires.png
  subdiv render scene.glb --mesh-name Head --background transparent --yaw 40 -o head.png
  subdiv render model.obj --scheme acc --shading error-normal --error-max 0.1 -o errors.png
  subdiv render model.obj --level 2 --shading wireframe -o subdivided.png
  subdiv render --shape creature --displacement scales --displacement-scale 0.01 --pixels 4 -o scales.png
  subdiv render --shape cloth --eye 3,4,5 --target 0,0,0 --fov 25 --size 1920x1080 -o cloth.png";

#[derive(Serialize)]
struct RenderOut<'a> {
    file: &'a str,
    size: [u32; 2],
    patches: Patches,
    evaluation: &'static str,
    construction: &'static str,
    factor: Option<f32>,
    pixels: Option<f32>,
    bend: Option<f32>,
    level: Option<u32>,
    spacing: &'static str,
    shading: String,
    samples: u32,
    device: &'a str,
    error: Option<ErrorOut>,
    statistics: Option<StatisticsOut>,
}

/// What the control shader made of the factors.
#[derive(Clone, Copy, Serialize)]
struct StatisticsOut {
    patches_drawn: usize,
    patches_culled: usize,
    largest_factor: f32,
    factors_clamped: bool,
}

#[derive(Serialize)]
struct ErrorOut {
    top: f64,
    largest: f64,
}

pub(super) fn run(args: &RenderArgs, json: bool) -> Result<(), CliError> {
    let file = args.output.display().to_string();
    let ending = args.output.extension().map(|ending| ending.to_ascii_lowercase());
    if ending.is_none_or(|ending| ending != "png") {
        return Err(CliError::Usage(format!("--output {file}: pictures are PNG files: let the name end in .png")));
    }
    let construction = args.construction()?;
    let legend = if args.shading.quantity().is_some() { Legend::height(args.size)? } else { 0 };
    let progress = Progress::new("reading the mesh");
    let mesh = args.mesh.load()?;
    let map = args.error_map(&mesh, &progress)?;
    progress.now("building tables");
    let evaluation = args.factor.level.map_or(args.evaluation.evaluation, |_| Evaluation::Subdivision);
    let mut options = ModelOptions { spacing: args.spacing, evaluation, ..args.mesh.model_options(construction) };
    let texels = args.displacement.texels()?;
    options.displacement = texels.as_ref().map(|_| DisplacementId::FIRST);
    let mut drawn = &mesh;
    if let Some(map) = &map {
        (drawn, options.refine) = (&map.mesh, 0);
    }
    let tables = ModelTables::new(drawn, &options)?;
    if map.is_none() {
        tell_notices(tables.notices(), &progress);
    }
    let patches = Patches::of(&tables);
    let [width, height] = args.size;
    let size = [width, height - legend];
    let view = args.camera.view(&args.seen_points(&mesh, texels.as_ref())?, f64::from(size[0]) / f64::from(size[1]))?;
    let view = view.sized(size[0], size[1]);
    progress.now("drawing");
    let (samples, device, mut pixels, statistics) = args.device.run(|headless| {
        let samples = args.check_limits(headless.properties())?;
        let picture = Picture { size, samples, view, map: map.as_ref(), texels: texels.as_ref() };
        let statistics = args.statistics(headless, &picture, drawn, &options)?;
        let pixels = args.draw(headless, &picture, tables, drawn, &options)?;
        Ok((samples, headless.properties().name.clone(), pixels, statistics))
    })?;
    progress.now("writing the picture");
    if args.background.is_transparent() {
        unpremultiply(&mut pixels, args.shading.format() == vk::Format::R8G8B8A8_SRGB);
    }
    if let Some(map) = &map {
        args.legend(map).add(args.size, args.background, &mut pixels)?;
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
            evaluation: options.evaluation.name(),
            construction: options.construction.name(),
            factor: Some(args.factor.factor()).filter(|f| matches!(f, Factor::Uniform(_))).map(Factor::value),
            level: args.factor.level,
            pixels: args.factor.pixels,
            bend: args.factor.bend,
            spacing: parse::spacing_name(args.spacing),
            shading: args.shading.name(),
            samples,
            device: &device,
            statistics,
            error: map.map(|ErrorMap { top, largest, .. }| ErrorOut { top, largest }),
        });
    }
    output::with_stdout(|out| {
        let factor = args.factor.text();
        writeln!(out, "{file}: {width} x {height}, {patches}, {factor}, {samples} samples, on {device}")?;
        if let Some(ErrorMap { top, largest, .. }) = map {
            let [top, largest] = [top, largest].map(output::short);
            writeln!(out, "the scale ends at {top} (--error-max); the largest error is {largest}")?;
        }
        Ok(())
    })
}

/// What is drawn besides the model.
struct Picture<'p> {
    /// In pixels, without the legend.
    size: [u32; 2],
    samples: u32,
    view: View,
    map: Option<&'p ErrorMap>,
    texels: Option<&'p Texels>,
}

impl RenderArgs {
    /// How control points are made; an error if the evaluation does not go with what was asked for.
    fn construction(&self) -> Result<Construction, CliError> {
        self.evaluation.construction(&[
            ("--pixels", self.factor.pixels.is_some()),
            ("--bend", self.factor.bend.is_some()),
            ("--cull", self.factor.cull.cull() != Cull::NONE),
            ("--spacing", self.spacing != Spacing::Equal),
            ("--displacement", self.displacement.is_given()),
        ])
    }

    /// The errors to be shown, if any.
    fn error_map(&self, mesh: &ControlMesh, progress: &Progress) -> Result<Option<ErrorMap>, CliError> {
        let Some(quantity) = self.shading.quantity() else {
            return match self.error_max {
                None => Ok(None),
                Some(_) => {
                    let shading = self.shading.name();
                    let message = format!(
                        "--error-max: --shading {shading} shows no error: choose error-position or error-normal"
                    );
                    Err(CliError::Usage(message))
                }
            };
        };
        if self.factor.level.is_some() {
            let message = "--level: the error is that of patches: leave one of both out";
            return Err(CliError::Usage(message.into()));
        }
        if self.displacement.is_given() {
            let message = "--displacement: the error of a displaced surface is not known: leave one of both out";
            return Err(CliError::Usage(message.into()));
        }
        progress.now("measuring");
        let surface = self.mesh.cpu_surface(mesh, progress)?;
        let [low, high] = mesh.bounds();
        Ok(Some(ErrorMap::new(&surface, quantity, low.distance(high), self.error_max)?))
    }

    fn legend(&self, map: &ErrorMap) -> Legend {
        let what = match self.shading.quantity() {
            Some(Quantity::Normal) => "normal error, radians",
            _ => "position error / diagonal",
        };
        let title = format!("{}: {what}", self.mesh.scheme.name());
        Legend { title, top: map.top, exceeded: map.largest > map.top }
    }

    /// Points around which everything is that the picture shows.
    fn seen_points(&self, mesh: &ControlMesh, texels: Option<&Texels>) -> Result<Vec<DVec3>, CliError> {
        let positions = &mesh.data().positions;
        // Faces that are hardly subdivided are as large as the control mesh.
        let shows_control_mesh = self.shading.shows_control_mesh() || self.factor.level.is_some();
        if shows_control_mesh && !positions.is_empty() {
            return Ok(positions.iter().copied().map(DVec3::from).collect());
        }
        let hull = self.mesh.hull(mesh)?;
        let Some(texels) = texels else { return Ok(hull) };
        // Wherever displacement moves them.
        let reach = DVec3::splat(self.displacement.reach(mesh, texels));
        Ok(hull.into_iter().flat_map(|point| [point - reach, point + reach]).collect())
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

    /// What the factors of the picture come to; none where the device cannot tell, or nothing was asked for.
    fn statistics(
        &self,
        headless: &Headless,
        picture: &Picture,
        mesh: &ControlMesh,
        options: &ModelOptions,
    ) -> Result<Option<StatisticsOut>, CliError> {
        let (factor, cull) = (self.factor.factor(), self.factor.cull.cull());
        let asked = cull != Cull::NONE || !matches!(factor, Factor::Uniform(_));
        if !asked || !headless.context().features().vertex_stores {
            return Ok(None);
        }
        let displacement = self.displacement.amount(mesh);
        let draw = CaptureDraw { view: picture.view, cull, displacement, ..CaptureDraw::new(factor) };
        let texture = picture.texels.map(|texels| texture(headless, texels)).transpose()?;
        let captured = match &texture {
            // SAFETY: the texture is ready to be read, and outlives what is captured.
            Some(texture) => unsafe { Captured::displaced(headless, mesh, options, texture.into())? },
            None => Captured::new(headless, mesh, options)?,
        };
        let factors = captured.factors(&draw)?;
        let max = headless.properties().max_tessellation_level as f32;
        let asked = |f: &CapturedFactors| f.asked.into_iter().fold(0.0, f32::max);
        let culled = factors.iter().filter(|f| f.culled).count();
        let largest = factors.iter().filter(|f| !f.culled).map(asked).fold(1.0, f32::max);
        Ok(Some(StatisticsOut {
            patches_drawn: factors.len() - culled,
            patches_culled: culled,
            largest_factor: largest.min(max),
            factors_clamped: factors.iter().any(|f| asked(f) > max),
        }))
    }

    /// Draws the picture: rows from the top, four bytes RGBA a pixel.
    fn draw(
        &self,
        headless: &Headless,
        picture: &Picture,
        tables: ModelTables,
        mesh: &ControlMesh,
        model_options: &ModelOptions,
    ) -> Result<Vec<u8>, CliError> {
        let samples = vk::SampleCountFlags::from_raw(picture.samples);
        let [width, height] = picture.size;
        let desc = OffscreenDesc { samples, color: self.shading.format(), ..OffscreenDesc::new(width, height) };
        let target = Offscreen::new(headless, &desc)?;
        let texture = picture.texels.map(|texels| texture(headless, texels)).transpose()?;
        let errors = picture.map.map(|map| ErrorSet::new(headless.context(), map)).transpose()?;
        let options = Options {
            styles: self.shading.styles(),
            texcoords: errors.is_some(),
            evaluations: vec![model_options.evaluation],
            set_layouts: errors.iter().map(|errors| errors.layout.raw()).collect(),
            ..Options::default()
        };
        let render_target = Target::dynamic(desc.color, desc.depth, desc.samples);
        // SAFETY: the layout outlives the renderer, whose shaders fit it; every submission is waited for, so the renderer
        // is dropped when idle.
        let mut renderer = unsafe { Renderer::new(headless.context(), &render_target, &options)? };
        if let Some(texture) = &texture {
            // SAFETY: the texture is ready to be read, and outlives the renderer.
            unsafe { renderer.add_displacement(texture.into()) };
        }
        let model = renderer.add_tables(tables, &mesh.positions_f32(), model_options)?;
        if model_options.evaluation.needs_segments() {
            renderer.set_segments(model, self.factor.factor.ceil() as u32)?;
        }
        let item = DrawItem {
            cull: self.factor.cull.cull(),
            displacement: self.displacement.amount(mesh),
            ..DrawItem::new(model, self.factor.factor())
        };
        let draws = self.shading.draws(item);
        // SAFETY: the command buffer is being recorded, outside rendering.
        headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, 0) })?;
        let record = |cmd| {
            if let Some(errors) = &errors {
                let (point, layout) = (vk::PipelineBindPoint::GRAPHICS, renderer.pipeline_layout());
                // SAFETY: the set is of the layout at this place, and outlives the submission.
                unsafe {
                    headless.context().device().cmd_bind_descriptor_sets(cmd, point, layout, 2, &[errors.set], &[]);
                }
            }
            // SAFETY: inside rendering that fits the target, after the frame was prepared.
            unsafe { renderer.cmd_draw(cmd, 0, &picture.view, &draws) }
        };
        let background = match desc.color {
            vk::Format::R8G8B8A8_SRGB => self.background.linear(),
            _ => self.background.0.map(|byte| f32::from(byte) / 255.0),
        };
        Ok(target.draw(headless, background, record)?)
    }
}
