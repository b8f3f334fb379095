//! `subdiv render`: a picture of a mesh. What is asked for is in `args`, what the device does for it in `draw`, and with vertices of
//! the CPU in `diced`.

mod args;
mod diced;
mod draw;

use super::described::described;
use super::error::CliError;
use super::info::Patches;
use super::interrupt::{Watch, check_frames};
use super::local::Local;
use super::motion::{FramesOut, Moving, moved};
use super::output::{self, Progress, write_file};
use super::paint::{ErrorMap, Legend, LevelMap, Painting};
use super::parse::Maker;
use super::picture::unpremultiply;
use super::shading::Shading;
use super::source::report_notices;
pub(super) use args::RenderArgs;
use ash::vk;
use ash_subdiv::gpu::DeviceProperties;
use ash_subdiv::headless::{HeadlessError, Texels, save_png};
use ash_subdiv::renderer::{DisplacementId, Evaluation, Factor, ModelTables};
use ash_subdiv::{Construction, ControlMesh, ModelOptions, View};
use diced::Diced;
use draw::{Drawing, Patched, Picture};
use glam::DVec3;
use serde::Serialize;
use std::path::{Path, PathBuf};

described! {
    #[derive(Serialize)]
    struct RenderOut<'a> {
        file: &'a str,
        size: [u32; 2] = "[width, height]",
        patches: Patches,
        evaluation: &'static str,
        construction: &'static str,
        factor: Option<f32> = "null unless one for all",
        pixels: Option<f32>,
        bend: Option<f32>,
        level: Option<u32> = "null unless given",
        spacing: &'static str,
        shading: String,
        samples: u32,
        device: &'a str,
        error: Option<ErrorOut> = "null unless an error is shown",
        statistics: Option<StatisticsOut> = "null with frames",
        time: Option<f64>,
        frames: Option<FramesOut>,
    }
}

described! {
    /// Factors as the control shader made them.
    #[derive(Clone, Copy, Serialize)]
    struct StatisticsOut {
        patches_drawn: usize,
        patches_culled: usize,
        largest_factor: f32,
        factors_clamped: bool = "whether an edge asked for more segments than the device has",
    }
}

described! {
    #[derive(Serialize)]
    struct ErrorOut {
        top: f64,
        largest: f64,
    }
}

impl ErrorOut {
    /// Of errors, if they are what is painted.
    fn of(painting: &Painting) -> Option<Self> {
        match *painting {
            Painting::Errors(ErrorMap { top, largest, .. }) => Some(Self { top, largest }),
            Painting::Levels(_) => None,
        }
    }
}

pub(super) fn run(args: &RenderArgs, json: bool) -> Result<(), CliError> {
    let files = args.files()?;
    let construction = args.construction()?;
    args.check_shading()?;
    let legend = if args.shading.is_painted() { Legend::height(args.size)? } else { 0 };
    let progress = Progress::new("reading the mesh");
    let (mesh, local, moving) = args.load(&progress)?;
    let painting = args.painting(&mesh, &progress)?;
    progress.now("building tables");
    let texels = args.displacement.texels()?;
    let options = args.model_options(construction, texels.is_some(), painting.is_some());
    let drawn = painting.as_ref().map_or(&mesh, Painting::mesh);
    let tables = ModelTables::new(drawn, &options)?;
    if painting.is_none() {
        report_notices(tables.notices(), &progress);
    }
    let patches = Patches::of(&tables);
    let size = [args.size[0], args.size[1] - legend];
    let views = args.views(&mesh, moving.as_ref(), texels.as_ref(), local, size)?;
    progress.now("drawing");
    let shown = Shown { files: &files, views: &views, moving: moving.as_ref() };
    let (samples, device, pixels, statistics) = args.device.run(|headless| {
        let samples = args.check_limits(headless.properties())?;
        let picture = Picture { size, samples, view: views[0], painting: painting.as_ref(), texels: texels.as_ref() };
        let statistics = if moving.is_some() { None } else { args.statistics(headless, &picture, drawn, &options)? };
        let drawing = match args.is_cpu() {
            true => Drawing::Triangles(Diced::new(args, headless, &picture, &mesh, &progress)?),
            false => Drawing::Patches(Patched::new(args, headless, &picture, tables, drawn, &options)?),
        };
        let pixels = args.draw_all(drawing, &shown, painting.as_ref(), &progress)?;
        Ok((samples, headless.properties().name.clone(), pixels, statistics))
    })?;
    if let Some(mut pixels) = pixels {
        args.save(&args.output, &mut pixels, painting.as_ref())?;
    }
    drop(progress);
    let error = painting.as_ref().and_then(ErrorOut::of);
    if !json {
        return args.print(patches, samples, &device, error);
    }
    output::json_pretty(&RenderOut {
        file: &args.output.display().to_string(),
        size: args.size,
        patches,
        evaluation: if args.is_cpu() { args.evaluation.evaluation.name() } else { options.evaluation.name() },
        construction: options.construction.name(),
        factor: Some(args.factor.factor()).filter(|f| matches!(f, Factor::Uniform(_))).map(Factor::value),
        level: args.factor.level,
        pixels: args.factor.pixels,
        bend: args.factor.bend,
        spacing: args.spacing.name(),
        shading: args.shading.name(),
        samples,
        device: &device,
        statistics,
        error,
        time: args.mesh.source.time.time,
        frames: moving.as_ref().map(Moving::described),
    })
}

impl RenderArgs {
    /// Names of the pictures.
    fn files(&self) -> Result<Vec<PathBuf>, CliError> {
        let ending = self.output.extension().map(|ending| ending.to_ascii_lowercase());
        if ending.is_none_or(|ending| ending != "png") {
            let file = self.output.display();
            return Err(CliError::Usage(format!("--output {file}: pictures are PNG files: let the name end in .png")));
        }
        self.frames.files(&self.output)
    }

    /// Options of the model that is drawn.
    fn model_options(&self, construction: Construction, displaced: bool, painted: bool) -> ModelOptions {
        let evaluation = match self.evaluation.evaluation {
            _ if self.factor.level.is_some() => Evaluation::Subdivision,
            Maker::Device(evaluation) => evaluation,
            Maker::Cpu => Evaluation::default(),
        };
        let options = self.mesh.model_options(construction);
        ModelOptions {
            spacing: self.spacing,
            evaluation,
            displacement: displaced.then_some(DisplacementId::FIRST),
            // What is painted is of the mesh that was refined for it.
            refine: if painted { 0 } else { options.refine },
            ..options
        }
    }

    /// The mesh in its local space, in the first of the frames if there are any.
    fn load(&self, progress: &Progress) -> Result<(ControlMesh, Local, Option<Moving>), CliError> {
        let Some(moving) = self.frames.load(&self.mesh.source, progress)? else {
            let (mesh, local) = Local::of(self.mesh.load(progress)?)?;
            return Ok((mesh, local, None));
        };
        let local = Local::around(moving.bounds()?);
        Ok((local.take(moving.first()?)?, local, Some(moving.in_space(local))))
    }
}

/// What is drawn into which files.
struct Shown<'s> {
    files: &'s [PathBuf],
    /// One a file.
    views: &'s [View],
    moving: Option<&'s Moving>,
}

impl RenderArgs {
    /// Draws all frames to their files; gives the pixels if there is but a picture.
    fn draw_all(
        &self,
        mut drawing: Drawing<'_>,
        shown: &Shown<'_>,
        painting: Option<&Painting>,
        progress: &Progress,
    ) -> Result<Option<Vec<u8>>, CliError> {
        let Shown { files, views, moving } = shown;
        let Some(moving) = moving else { return Ok(Some(drawing.draw(&views[0], None)?)) };
        let _watch = Watch::start();
        progress.fill("drawing", files.len() as u64);
        for (number, positions) in moving.frames().enumerate() {
            check_frames(number, files.len())?;
            let positions: Vec<[f32; 3]> = positions?.into_iter().map(|p| p.map(|x| x as f32)).collect();
            let mut pixels = drawing.draw(&views[number], Some(&positions))?;
            self.save(&files[number], &mut pixels, painting)?;
            progress.advance(1);
        }
        Ok(None)
    }

    /// The view of each file.
    fn views(
        &self,
        mesh: &ControlMesh,
        moving: Option<&Moving>,
        texels: Option<&Texels>,
        local: Local,
        [width, height]: [u32; 2],
    ) -> Result<Vec<View>, CliError> {
        let (camera, aspect) = (self.camera.in_space(local), f64::from(width) / f64::from(height));
        let view = |points: &[DVec3]| Ok::<_, CliError>(camera.view(points, aspect)?.sized(width, height));
        let Some(moving) = moving else { return Ok(vec![view(&self.seen_points(mesh, texels)?)?]) };
        let mut seen = Vec::new();
        for positions in moving.frames() {
            let points = self.seen_points(&moved(mesh, positions?)?, texels)?;
            seen.push(camera.deciding(&points, aspect));
        }
        if self.refit {
            return seen.iter().map(|points| view(points)).collect();
        }
        Ok(vec![view(&seen.concat())?; seen.len()])
    }

    /// Writes a picture to its file, with the legend of what is painted.
    fn save(&self, file: &Path, pixels: &mut Vec<u8>, painting: Option<&Painting>) -> Result<(), CliError> {
        let [width, height] = self.size;
        if self.background.is_transparent() {
            unpremultiply(pixels, self.shading.format() == vk::Format::R8G8B8A8_SRGB);
        }
        if let Some(painting) = painting {
            painting.legend(self.mesh.scheme.name()).add(self.size, self.background, pixels)?;
        }
        write_file(file, |part| match save_png(part, vk::Extent2D { width, height }, pixels) {
            Err(HeadlessError::Picture { message, .. }) => Err(message),
            result => result.map_err(|error| error.to_string()),
        })
    }

    /// Writes what was drawn as text.
    fn print(&self, patches: Patches, samples: u32, device: &str, error: Option<ErrorOut>) -> Result<(), CliError> {
        output::with_stdout(|out| {
            let (file, [width, height], factor) = (self.output.display(), self.size, self.factor.text());
            write!(out, "{file}: ")?;
            if let Some(frames) = self.frames.count() {
                write!(out, "{frames} frames, ")?;
            }
            writeln!(out, "{width} x {height}, {patches}, {factor}, {samples} samples, on {device}")?;
            if let Some(ErrorOut { top, largest }) = error {
                let [top, largest] = [top, largest].map(output::short);
                writeln!(out, "the scale ends at {top} (--error-max); the largest error is {largest}")?;
            }
            Ok(())
        })
    }

    /// What is to be painted on the surface, if anything.
    fn painting(&self, mesh: &ControlMesh, progress: &Progress) -> Result<Option<Painting>, CliError> {
        if !self.shading.is_painted() {
            return Ok(None);
        }
        progress.now("measuring");
        let surface = self.mesh.cpu_surface(mesh, progress)?;
        Ok(Some(match (self.shading.quantity(), surface.adaptive()) {
            (Some(quantity), _) => {
                let [low, high] = mesh.bounds();
                Painting::Errors(ErrorMap::new(&surface, quantity, low.distance(high), self.error_max)?)
            }
            (None, Some(plan)) => Painting::Levels(LevelMap::new(&surface, plan)?),
            (None, None) => {
                let message = "--shading levels: no face is refined: name a depth with --adaptive";
                return Err(CliError::Usage(message.into()));
            }
        }))
    }

    /// Checks that the other arguments go with the shading.
    fn check_shading(&self) -> Result<(), CliError> {
        let shading = self.shading.name();
        let usage = |message: String| Err(CliError::Usage(message));
        if self.shading.quantity().is_none() && self.error_max.is_some() {
            return usage(format!(
                "--error-max: --shading {shading} shows no error: choose error-position or error-normal"
            ));
        }
        if self.shading != Shading::ReflectionLines && self.stripes.is_some() {
            return usage(format!("--stripes: --shading {shading} has none: choose reflection-lines"));
        }
        if self.shading.is_painted() && self.factor.level.is_some() {
            let what = if self.shading == Shading::Levels { "levels are those" } else { "the error is that" };
            return usage(format!("--level: {what} of patches: leave one of both out"));
        }
        if self.is_cpu() && !self.shading.is_of_vertices() {
            let known = "choose lit, normals, wireframe or reflection-lines";
            return usage(format!("--evaluation cpu: --shading {shading} is drawn out of patches: {known}"));
        }
        if self.shading.is_painted() && self.frames.is_given() {
            return usage(format!(
                "--frames: --shading {shading} is measured for one mesh: draw frame by frame with --time"
            ));
        }
        if self.shading.is_painted() && self.displacement.is_given() {
            return usage(
                match self.shading {
                    Shading::Levels => {
                        "--displacement: levels are not painted on a displaced surface: leave one of both out"
                    }
                    _ => "--displacement: the error of a displaced surface is not known: leave one of both out",
                }
                .into(),
            );
        }
        Ok(())
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
        let reach = self.displacement.reach(mesh, texels);
        let corner = |bits: u32| DVec3::from([0, 1, 2].map(|axis| if bits >> axis & 1 == 0 { -reach } else { reach }));
        Ok(hull.into_iter().flat_map(|point| (0..8).map(move |bits| point + corner(bits))).collect())
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
}
