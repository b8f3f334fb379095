//! Where the mesh comes from, how it is prepared, and on which device the work is done.

use super::error::CliError;
use super::motion::{TimeArgs, at_time};
use super::output::Progress;
use super::parse;
use super::rules::RulesArgs;
use ash_subdiv::adaptive::{AdaptiveOptions, DrawnBy, Sums};
use ash_subdiv::headless::{Headless, HeadlessOptions};
use ash_subdiv::mesh::{
    Animated, Animations, Limits, ReadOptions, RepairOptions, Repairs, animated_shape, read, read_animated,
    read_repaired,
};
use ash_subdiv::table::{CpuSurface, Notice, TableOptions};
use ash_subdiv::{Construction, ControlMesh, Fallback, ModelOptions, Scheme};
use clap::Args;
use glam::DVec3;
use std::path::{Path, PathBuf};

/// The mesh, and the surface it is the control mesh of.
#[derive(Debug, Args)]
pub(super) struct MeshArgs {
    #[command(flatten)]
    pub source: SourceArgs,
    /// Scheme of the patches that faces become.
    #[arg(long, default_value = Scheme::Gregory.name(), value_parser = parse::one_of(Scheme::ALL, Scheme::name))]
    pub scheme: Scheme,
}

/// The mesh, whatever becomes of it.
#[derive(Debug, Args)]
pub(super) struct SourceArgs {
    /// The control mesh: a file ending in .obj, .ply, .gltf or .glb.
    mesh: Option<PathBuf>,
    /// A built-in shape instead of a file: see `subdiv shapes`.
    #[arg(long, value_name = "NAME")]
    shape: Option<String>,
    #[command(flatten)]
    reading: ReadingArgs,
    /// Mesh of a glTF scene, by its name or its node's; all of them if not given.
    #[arg(long, value_name = "NAME", conflicts_with = "shape")]
    mesh_name: Option<String>,
    /// Steps of Catmull-Clark refinement before patches are made; each makes four times as many faces.
    #[arg(long, value_name = "STEPS", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=8))]
    pub refine: u32,
    /// Draw faces that the scheme has no patches for with those of this one, instead of refusing the mesh.
    #[arg(long, value_name = "SCHEME", value_parser = parse::fallback())]
    fallback: Option<Fallback>,

    /// Refine irregular faces where they have to be, 0 to 10 levels deep, and draw the limit surface itself but for end caps there:
    /// patches of gregory or gregory-fitted. At 0 creases of finite sharpness are followed, and no face is refined.
    #[arg(long, value_name = "DEPTH")]
    adaptive: Option<u32>,

    /// With --adaptive: another depth around darts, corners and creases whose sharpness varies
    #[arg(long, value_name = "DEPTH", requires = "adaptive")]
    sharp_depth: Option<u32>,

    /// With --adaptive: what refined vertices are sums of, those one level above or control vertices
    #[arg(long, value_name = "OF", requires = "adaptive", default_value = "levels", value_parser = parse::one_of(Sums::ALL, Sums::name))]
    sums: Sums,

    /// With --adaptive: one patch a face, or one a leaf. The surface is the same; leaves go with --evaluation tessellation only
    #[arg(long, value_name = "WHAT", requires = "adaptive", default_value = "faces", value_parser = parse::one_of(DrawnBy::ALL, DrawnBy::name))]
    by: DrawnBy,

    #[command(flatten)]
    pub time: TimeArgs,

    #[command(flatten)]
    rules: RulesArgs,
}

impl MeshArgs {
    /// Options of the model, with this construction.
    pub(super) fn model_options(&self, construction: Construction) -> ModelOptions {
        self.source.model_options(self.scheme, construction)
    }

    /// Points around which the whole surface is: the control points of its patches. Of adaptive surfaces they are those without
    /// adaptive subdivision, so that pictures of all depths show the same.
    pub(super) fn hull(&self, mesh: &ControlMesh) -> Result<Vec<DVec3>, CliError> {
        let options = TableOptions { adaptive: None, ..self.source.table_options(self.scheme) };
        let mut points = CpuSurface::with_options(mesh, &options)?.control_points(|p| p).concat();
        // Where nothing is drawn, such as where all faces are holes.
        if points.is_empty() {
            points.extend(mesh.bounds());
        }
        Ok(points)
    }

    /// The patches of the mesh on the CPU; reports the notices about it.
    pub(super) fn cpu_surface(&self, mesh: &ControlMesh, progress: &Progress) -> Result<CpuSurface, CliError> {
        self.source.cpu_surface(mesh, self.scheme, progress)
    }

    /// Reads the file, or makes the shape; reports repairs.
    pub(super) fn load(&self, progress: &Progress) -> Result<ControlMesh, CliError> {
        self.source.load(progress)
    }
}

impl SourceArgs {
    /// The mesh as the user named it.
    pub(super) fn name(&self) -> String {
        let path = self.mesh.as_ref().map(|path| path.display().to_string());
        path.or_else(|| self.shape.clone()).unwrap_or_default()
    }

    /// Whether it is a glTF file.
    pub(super) fn is_gltf(&self) -> bool {
        let extension = self.mesh.as_ref().and_then(|path| path.extension());
        extension.is_some_and(|e| e.eq_ignore_ascii_case("gltf") || e.eq_ignore_ascii_case("glb"))
    }

    /// Options of the model, with this scheme and construction.
    pub(super) fn model_options(&self, scheme: Scheme, construction: Construction) -> ModelOptions {
        let name = self.shape.clone().unwrap_or_else(|| "mesh".into());
        let TableOptions { fallback, refine, adaptive, .. } = self.table_options(scheme);
        ModelOptions { name, scheme, construction, fallback, refine, adaptive, ..ModelOptions::default() }
    }

    /// How the mesh becomes patches of this scheme.
    pub(super) fn table_options(&self, scheme: Scheme) -> TableOptions {
        let adaptive = self.adaptive();
        TableOptions { scheme, fallback: self.fallback(), refine: self.refine, adaptive, ..TableOptions::default() }
    }

    /// Refuses patches by leaves, for a command that needs one patch a face.
    ///
    /// # Errors
    /// That they were asked for.
    pub(super) fn refuse_leaves(&self) -> Result<(), CliError> {
        match self.by {
            DrawnBy::Faces => Ok(()),
            DrawnBy::Leaves => Err(CliError::Usage(
                "--by leaves: the surface is the same by faces, which this command goes by: leave it out".into(),
            )),
        }
    }

    /// Depths of adaptive subdivision, if there is any.
    pub(super) fn adaptive(&self) -> Option<AdaptiveOptions> {
        self.adaptive.map(|depth| AdaptiveOptions {
            depth,
            sharp_depth: self.sharp_depth,
            sums: self.sums,
            drawn_by: self.by,
            ..AdaptiveOptions::default()
        })
    }

    /// The patches of the mesh on the CPU; reports the notices about it.
    pub(super) fn cpu_surface(
        &self,
        mesh: &ControlMesh,
        scheme: Scheme,
        progress: &Progress,
    ) -> Result<CpuSurface, CliError> {
        let surface = CpuSurface::with_options(mesh, &self.table_options(scheme))?;
        report_notices(&surface.notices(), progress);
        Ok(surface)
    }

    /// Fallback for faces that a scheme has no patches for.
    pub(super) fn fallback(&self) -> Fallback {
        self.fallback.unwrap_or_default()
    }

    /// Reads the file, or makes the shape; reports repairs.
    pub(super) fn load(&self, progress: &Progress) -> Result<ControlMesh, CliError> {
        let (mesh, repairs) = self.load_repaired()?;
        report_repairs(&repairs, progress);
        Ok(mesh)
    }

    /// Reads the file, or makes the shape, as it is at the time that is asked for.
    pub(super) fn load_repaired(&self) -> Result<(ControlMesh, Repairs), CliError> {
        let TimeArgs { time, animation } = &self.time;
        let Some(seconds) = time else {
            if let Some(name) = animation {
                return Err(CliError::Usage(format!("--animation {name}: say when, with --time or --frames")));
            }
            let Animated { mesh, repairs, .. } = self.read(false)?;
            return Ok((mesh, repairs));
        };
        let animated = self.read(true)?;
        let animation = self.time.choose(self, &animated.animations)?;
        Ok((at_time(&animated, animation, *seconds)?, animated.repairs))
    }

    /// Reads the file, or makes the shape, with its animations; reports repairs.
    pub(super) fn load_animated(&self, progress: &Progress) -> Result<Animated, CliError> {
        let animated = self.read(true)?;
        report_repairs(&animated.repairs, progress);
        animated.animations.notes().iter().for_each(|note| progress.note(note));
        Ok(animated)
    }

    /// The animations of the file or shape.
    pub(super) fn animations(&self) -> Result<Animations, CliError> {
        let may_have = self.is_gltf() || self.shape.is_some();
        if may_have { Ok(self.read(true)?.animations) } else { Ok(Animations::default()) }
    }

    /// Reads the file, or makes the shape, `moving` with its animations.
    pub(super) fn read(&self, moving: bool) -> Result<Animated, CliError> {
        let mut animated = match (&self.mesh, &self.shape) {
            (Some(path), None) => self.reading.read_animated(path, self.mesh_name.clone(), moving)?,
            (None, Some(name)) => animated_shape(name)?,
            (Some(path), Some(name)) => {
                let path = path.display();
                return Err(CliError::Usage(format!(
                    "both a mesh ({path}) and --shape {name} are given: leave one out"
                )));
            }
            (None, None) => {
                return Err(CliError::Usage(
                    "no mesh is given: name a file, or a built-in shape with --shape (`subdiv shapes` lists them)"
                        .into(),
                ));
            }
        };
        animated.mesh = self.rules.apply(animated.mesh)?;
        Ok(animated)
    }
}

/// How files are read.
#[derive(Debug, Args)]
pub(super) struct ReadingArgs {
    /// Refuse files that have to be mended: repeated corners, vertices without faces, edges of three faces, faces turned over …
    #[arg(long)]
    strict: bool,
    /// Join loose faces: edges on boundaries whose ends are this near, as a part of the bounding box's diagonal.
    #[arg(long, value_name = "TOLERANCE", conflicts_with = "strict", value_parser = parse::weld)]
    weld: Option<f64>,
    /// Put quads of glTF together that an exporter split into triangles: auto where most triangles are parts of quads, off never.
    #[arg(long, value_name = "WHEN", default_value = RebuildQuads::Auto.name(), value_parser = parse::one_of(RebuildQuads::ALL, RebuildQuads::name))]
    rebuild_quads: RebuildQuads,
    /// With --strict: take out vertices that belong to no face, instead of refusing the file (OBJ).
    #[arg(long)]
    drop_isolated: bool,
    /// Another limit on what is read, such as vertices=200000000; of bytes, vertices, faces, corners or json-values. May be repeated
    #[arg(long = "limit", value_name = "NAME=COUNT", value_parser = parse::limit)]
    limits: Vec<(&'static str, u64)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RebuildQuads {
    Auto,
    Off,
}

impl RebuildQuads {
    const ALL: [Self; 2] = [Self::Auto, Self::Off];

    fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Off => "off",
        }
    }
}

impl ReadingArgs {
    /// Reads a file, or one mesh of it.
    pub(super) fn read(&self, path: &Path, mesh: Option<String>) -> Result<(ControlMesh, Repairs), CliError> {
        let Animated { mesh, repairs, .. } = self.read_animated(path, mesh, false)?;
        Ok((mesh, repairs))
    }

    /// Reads a file, or one mesh of it, `moving` with its animations.
    fn read_animated(&self, path: &Path, mesh: Option<String>, moving: bool) -> Result<Animated, CliError> {
        let quads = self.rebuild_quads == RebuildQuads::Auto;
        let with = |limits: Limits, &(name, limit): &(&str, u64)| limits.with(name, limit).unwrap_or(limits);
        let limits = self.limits.iter().fold(Limits::default(), with);
        let options = ReadOptions { drop_isolated: self.drop_isolated, mesh, quads, limits };
        let repair = (!self.strict).then_some(RepairOptions { weld: self.weld });
        Ok(match repair {
            repair if moving => read_animated(path, &options, repair.as_ref())?,
            Some(repair) => read_repaired(path, &options, &repair)?.into(),
            None => (read(path, &options)?, Repairs::default()).into(),
        })
    }
}

/// What to say about how a file was mended, one note a line.
pub(super) fn notes(repairs: &Repairs) -> Vec<String> {
    let mut notes: Vec<String> = repairs.list.iter().map(ToString::to_string).collect();
    if repairs.rebuilt_quads > 0 {
        let count = repairs.rebuilt_quads;
        notes.push(format!("{count} quads are put together out of triangles: --rebuild-quads off keeps the triangles"));
    }
    if repairs.loose_edges > 0 {
        let count = repairs.loose_edges;
        notes.push(format!("{count} edges on boundaries lie on others without being joined: --weld 1e-6 joins them"));
    }
    notes
}

/// Reports how a file was mended.
pub(super) fn report_repairs(repairs: &Repairs, progress: &Progress) {
    notes(repairs).iter().for_each(|note| progress.note(note));
}

/// Reports the notices on how a mesh is drawn.
pub(super) fn report_notices(notices: &[Notice], progress: &Progress) {
    notices.iter().for_each(|notice| progress.note(notice));
}

/// The device that works.
#[derive(Debug, Args)]
pub(super) struct DeviceArgs {
    /// The Vulkan device, by number or part of its name: see `subdiv devices`.
    #[arg(long, value_name = "DEVICE")]
    device: Option<String>,
    /// Have the Khronos validation layer look on, and fail if it has anything to say.
    #[arg(long)]
    validation: bool,
}

impl DeviceArgs {
    /// Runs `work` on the device, and passes on what the validation layer said.
    pub(super) fn run<R>(&self, work: impl FnOnce(&Headless) -> Result<R, CliError>) -> Result<R, CliError> {
        let options =
            HeadlessOptions { validation: self.validation, device: self.device.clone(), ..HeadlessOptions::default() };
        let headless = Headless::new(&options)?;
        let result = work(&headless)?;
        match headless.finish().as_slice() {
            [] => Ok(result),
            messages => Err(CliError::Work(format!("validation: {}", messages.join("; ")))),
        }
    }
}
