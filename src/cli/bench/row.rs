//! The rows: who was raced in which setting, and what that took.

use super::super::cull;
use super::super::described::described;
use ash_subdiv::adaptive::{DrawnBy, Sums};
use ash_subdiv::bench::{self, BenchOptions, Camera, Contestant, Creases, CullBy, Motion, Normals, Series, Subject};
use ash_subdiv::measure::statistics::{self, Estimate, Summary, paired_ratio};
use ash_subdiv::renderer::Cull;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

described! {
    #[derive(Debug, Clone, Copy, Serialize, Deserialize)]
    pub(super) struct Times {
        pub median: f64,
        pub min: f64,
        pub max: f64,
        pub mad: f64,
    }
}

described! {
    /// An estimate with its interval of 95 %.
    #[derive(Debug, Clone, Copy, Serialize, Deserialize)]
    pub(super) struct Interval {
        pub value: f64,
        pub low: f64,
        pub high: f64,
    }
}

described! {
    /// In what those of one table are raced, but for the factor.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub(super) struct Setting {
        pub mesh: String,
        pub spacing: String,
        #[serde(default = "moving")]
        pub motion: String,
        pub view: String,
        /// Nought in what several counts say together.
        pub passes: u32,
    }
}

/// Results of before there was a choice.
fn moving() -> String {
    Motion::Moving.name().to_owned()
}

/// Likewise.
fn direct() -> String {
    Creases::Direct.name().to_owned()
}

fn faces() -> String {
    DrawnBy::Faces.name().to_owned()
}

fn levels() -> String {
    Sums::Levels.name().to_owned()
}

described! {
    /// Contestant of a row.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub(super) struct Who {
        pub scheme: String,
        pub construction: String,
        pub path: String,
        pub normals: String,
        /// Depth of an adaptive surface.
        #[serde(default)]
        pub adaptive: Option<u32>,
        /// How it follows creases.
        #[serde(default = "direct")]
        pub creases: String,
        /// What its refined vertices are sums of.
        #[serde(default = "levels")]
        pub sums: String,
        /// Part of the surface that a patch is: faces or leaves.
        #[serde(default = "faces")]
        pub drawn_by: String,
        /// And by what, if that is not what usually does.
        pub cull: String,
    }
}

described! {
    #[derive(Debug, Clone, Serialize, Deserialize)]
    pub(super) struct Row {
        #[serde(flatten)]
        pub setting: Setting,
        #[serde(flatten)]
        pub who: Who,
        pub factor: f32,
        pub patches: u64,
        pub tes_invocations: Option<u64>,
        pub compute_invocations: Option<u64>,
        pub triangles: Option<u64>,
        /// Triangles that clipping left.
        pub visible_triangles: Option<u64>,
        pub gpu_ms: Times,
        pub geometry_ms: Times,
        pub setup_ms: f64,
        pub bytes: BTreeMap<String, u64>,
        /// To the first row of the setting and factor, frame by frame.
        pub gpu_ratio: Option<Interval>,
        pub geometry_ratio: Option<Interval>,
        pub construction_ms: Option<Interval>,
        pub tables_ms: f64,
        pub upload_ms: f64,
        pub pipelines_ms: f64,
        pub first_frame_ms: f64,
        pub traffic_bytes: BTreeMap<String, u64>,
        pub fence_ms: Fences,
        /// Every frame that counts.
        #[serde(default)]
        pub frames_ms: Frames,
    }
}

described! {
    /// On the host's clock.
    #[derive(Debug, Clone, Copy, Serialize, Deserialize)]
    pub(super) struct Fences {
        pub geometry: Times,
        pub gpu: Times,
    }
}

described! {
    /// Frame by frame.
    #[derive(Debug, Clone, Default, Serialize, Deserialize)]
    #[serde(default)]
    pub(super) struct Frames {
        pub geometry: Vec<f64>,
        pub gpu: Vec<f64>,
    }
}

/// Names of what is timed: frames with pixels, and geometry alone.
pub(super) const GPU: &str = "gpu";
pub(super) const GEOMETRY: &str = "geometry";

/// Name where there is nothing to name.
pub(super) const NONE: &str = "none";
/// The key of a map's sum.
const TOTAL: &str = "total";

impl Setting {
    pub(super) fn new(mesh: &str, options: &BenchOptions, camera: Camera) -> Self {
        Self {
            mesh: mesh.to_owned(),
            spacing: options.spacing.name().to_owned(),
            motion: options.motion.name().to_owned(),
            view: camera.name().to_owned(),
            passes: options.passes,
        }
    }

    /// Whether this is one of the settings of such a race.
    pub(super) fn is_of(&self, race: &BenchOptions) -> bool {
        race.cameras.iter().any(|&camera| *self == Self::new(&self.mesh, race, camera))
    }

    /// The setting where nothing else is asked for.
    fn usual(&self) -> Self {
        let usual = BenchOptions::default();
        Self::new(&self.mesh, &usual, usual.cameras[0])
    }

    /// Whether it is what a user gets who asks for nothing else, whatever the mesh.
    pub(super) fn is_usual(&self) -> bool {
        *self == self.usual()
    }

    /// The spacing, and what is not as always.
    pub(super) fn title(&self) -> String {
        self.title_among(&[])
    }

    /// Likewise, and that in which some of these rows differ.
    pub(super) fn title_among(&self, rows: &[Row]) -> String {
        let parts: [fn(&Self) -> Option<String>; 3] = [
            |setting| Some(format!("{} vertices", setting.motion)),
            |setting| Some(format!("{} view", setting.view)),
            |setting| match setting.passes {
                0 => None,
                1 => Some("1 pass".into()),
                passes => Some(format!("{passes} passes")),
            },
        ];
        let usual = self.usual();
        let told = |of: &fn(&Self) -> Option<String>| {
            let own = of(self);
            let is_told = own != of(&usual) || rows.iter().any(|row| of(&row.setting) != own);
            own.filter(|_| is_told)
        };
        let told = parts.iter().filter_map(told);
        [format!("{} spacing", self.spacing)].into_iter().chain(told).collect::<Vec<_>>().join(", ")
    }
}

impl Who {
    pub(super) fn new(contestant: Contestant) -> Self {
        let Contestant { patches, cull, cull_by, .. } = contestant;
        let by = match cull {
            Cull::NONE => String::new(),
            _ if cull_by == CullBy::usual(patches) => String::new(),
            _ => format!(" by {}", cull_by.name()),
        };
        Self {
            scheme: contestant.scheme_name().to_owned(),
            construction: contestant.construction_name().to_owned(),
            path: contestant.path.name().to_owned(),
            normals: contestant.normals.name().to_owned(),
            adaptive: contestant.depth,
            creases: contestant.creases.name().to_owned(),
            sums: contestant.sums.name().to_owned(),
            drawn_by: contestant.drawn_by.name().to_owned(),
            cull: cull::name(cull) + &by,
        }
    }

    /// In a few words.
    pub(super) fn label(&self) -> String {
        let Self { scheme, construction, path, .. } = self;
        let named = [scheme, construction, path].into_iter().filter(|s| *s != NONE).cloned();
        named.chain(self.drawn()).collect::<Vec<_>>().join(" ")
    }

    /// The surface that is drawn, whatever the way.
    pub(super) fn surface(&self) -> String {
        [self.scheme.clone()].into_iter().chain(self.leaves()).collect::<Vec<_>>().join(" ")
    }

    /// Whether it is one of what no change of this program makes faster or slower.
    pub(super) fn is_floor(&self) -> bool {
        bench::Path::ALL.iter().any(|path| path.is_floor() && path.name() == self.path)
    }

    /// The path, and what is not as always with it.
    pub(super) fn path_label(&self) -> String {
        [self.path.clone()].into_iter().chain(self.drawn()).collect::<Vec<_>>().join(", ")
    }

    /// What makes an adaptive surface another.
    fn leaves(&self) -> impl Iterator<Item = String> + use<> {
        let depth = self.adaptive.map(|depth| format!("adaptive {depth}"));
        let creases = (self.creases != Creases::Direct.name()).then(|| format!("{} creases", self.creases));
        let sums = (self.sums != Sums::Levels.name()).then(|| format!("{} sums", self.sums));
        let by = (self.drawn_by != DrawnBy::Faces.name()).then(|| format!("by {}", self.drawn_by));
        depth.into_iter().chain(creases).chain(sums).chain(by)
    }

    fn drawn(&self) -> impl Iterator<Item = String> {
        let normals = (self.normals != Normals::Own.name()).then(|| "shared normals".to_owned());
        let cull = (self.cull != NONE).then(|| self.cull.clone());
        self.leaves().chain(normals).chain(cull)
    }
}

impl Row {
    /// The rows of one factor, each view with its base.
    pub(super) fn all(subject: &Subject, options: &BenchOptions, rows: &[bench::Row]) -> Vec<Self> {
        let of_view = |rows: &[bench::Row]| {
            let base = rows.iter().find(|row| !row.contestant.path.is_floor()).unwrap_or(&rows[0]);
            rows.iter().filter_map(|row| Self::new(subject, options, row, base)).collect::<Vec<_>>()
        };
        rows.chunk_by(|a, b| a.camera == b.camera).flat_map(of_view).collect()
    }

    /// `None` if no frame counts.
    fn new(subject: &Subject, options: &BenchOptions, row: &bench::Row, base: &bench::Row) -> Option<Self> {
        let interval = |estimate: Option<Estimate>| estimate.map(Interval::from);
        let traffic = [
            ("tables", row.traffic.tables),
            ("control_points", row.traffic.control_points),
            ("vertices", row.traffic.vertices),
        ];
        let fence = |series: &Series| Times::of(&series.host);
        Some(Self {
            setting: Setting::new(&subject.name, options, row.camera),
            who: Who::new(row.contestant),
            factor: row.factor,
            patches: row.patches,
            tes_invocations: row.evaluations,
            compute_invocations: row.computed,
            triangles: row.triangles,
            visible_triangles: row.visible,
            gpu_ms: Times::of(&row.gpu.device)?,
            geometry_ms: Times::of(&row.geometry.device)?,
            setup_ms: row.setup.per_model(),
            bytes: with_total(&row.bytes),
            gpu_ratio: interval(paired_ratio(&row.gpu.device, &base.gpu.device)),
            geometry_ratio: interval(paired_ratio(&row.geometry.device, &base.geometry.device)),
            construction_ms: interval(row.construction),
            tables_ms: row.setup.tables,
            upload_ms: row.setup.upload,
            pipelines_ms: row.setup.pipelines,
            first_frame_ms: row.setup.first_frame,
            traffic_bytes: with_total(&traffic),
            fence_ms: Fences { geometry: fence(&row.geometry)?, gpu: fence(&row.gpu)? },
            frames_ms: Frames { geometry: row.geometry.device.clone(), gpu: row.gpu.device.clone() },
        })
    }

    pub(super) fn total_bytes(&self) -> u64 {
        self.bytes.get(TOTAL).copied().unwrap_or(0)
    }

    pub(super) fn traffic_total(&self) -> u64 {
        self.traffic_bytes.get(TOTAL).copied().unwrap_or(0)
    }

    pub(super) fn first_use_ms(&self) -> f64 {
        self.pipelines_ms + self.first_frame_ms
    }

    /// Frame by frame: [`GPU`] or [`GEOMETRY`].
    pub(super) fn frames(&self, what: &str) -> &[f64] {
        if what == GPU { &self.frames_ms.gpu } else { &self.frames_ms.geometry }
    }

    /// Whether both are of one table.
    pub(super) fn is_beside(&self, other: &Self) -> bool {
        (&self.setting, self.factor) == (&other.setting, other.factor)
    }
}

fn with_total(bytes: &[(&str, u64)]) -> BTreeMap<String, u64> {
    let total = (TOTAL, bytes.iter().map(|(_, bytes)| bytes).sum());
    bytes.iter().copied().chain([total]).map(|(name, bytes)| (name.to_owned(), bytes)).collect()
}

impl Times {
    pub(super) fn of(values: &[f64]) -> Option<Self> {
        let Summary { median, min, max, mad } = Summary::of(values)?;
        Some(Self { median, min, max, mad })
    }

    /// All that are times, and no spread.
    pub(super) fn all(&self) -> [f64; 3] {
        [self.median, self.min, self.max]
    }
}

impl From<Estimate> for Interval {
    fn from(Estimate { value, low, high }: statistics::Estimate) -> Self {
        Self { value, low, high }
    }
}
