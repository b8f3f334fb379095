//! Presets: the measurements of papers, and their figures.

use super::super::described::described;
use super::facts::{MeshOut, OptionsOut};
use super::row::{Row, Who};
use super::unique;
use ash_subdiv::bench::{Contestant, Creases, Path, Subset};
use ash_subdiv::{Construction, Scheme};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use serde::{Deserialize, Serialize};

/// A table of a paper.
#[derive(Debug)]
pub(super) struct Preset {
    name: &'static str,
    pub title: &'static str,
    /// Differences, and the meaning of the figures.
    pub note: &'static str,
    pub schemes: &'static [Scheme],
    pub constructions: &'static [Construction],
    /// The first is what was published, the others stand beside it.
    pub paths: &'static [Path],
    pub factors: &'static [f32],
    /// Of adaptive surfaces, and how they follow creases.
    pub depths: &'static [u32],
    pub creases: &'static [Creases],
    /// Sharpness of all creases; as they are if none is given.
    pub sharpness: &'static [f32],
    /// The built-in shape that is measured if no mesh is given.
    pub shape: &'static str,
    pub patches: Subset,
    pub instances: u32,
    unit: Unit,
    /// Measured without pixels.
    geometry: bool,
    /// Figures by mesh; ratios are to the first.
    published: &'static [Published],
}

impl PartialEq for Preset {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Unit {
    Milliseconds,
    FramesASecond,
}

impl Unit {
    fn name(self) -> &'static str {
        if self == Self::Milliseconds { "ms" } else { "frames/s" }
    }

    fn milliseconds(self, figure: f64) -> f64 {
        if self == Self::Milliseconds { figure } else { 1e3 / figure }
    }
}

/// One figure: the mesh as the paper calls it, how it was drawn (of no account for subdivision), and the figure.
#[derive(Debug)]
struct Published(&'static str, Scheme, Construction, f32, f64);

/// Where patches were converted in one pass and evaluated in another.
const CONVERTED: &[Path] = &[Path::GeometryTwoPass, Path::Tessellation, Path::Bilinear, Path::VertexBuffer];

use Construction::{Cached, Stencil, TwoStage};
use Scheme::{Acc, CPatch, Gregory, Pm};

/// What most presets have.
const USUAL: Preset = Preset {
    name: "",
    title: "",
    note: "",
    schemes: &[],
    constructions: &[],
    paths: &[],
    factors: &[],
    depths: &[],
    creases: &[Creases::Direct],
    sharpness: &[],
    shape: "creature",
    patches: Subset::All,
    instances: 1,
    unit: Unit::FramesASecond,
    geometry: false,
    published: &[],
};

static PRESETS: [Preset; 7] = [
    Preset {
        name: "loop2009-table1",
        title: "Loop, Schaefer, Ni, Castaño 2009, table 1: 508 irregular quads",
        note: "Published: milliseconds in a simulator of Direct3D 11 hardware, N taken as the factor. Measured: geometry alone.",
        schemes: &[Gregory, Acc, Pm],
        constructions: &[TwoStage, Stencil],
        paths: &[Path::Tessellation, Path::Bilinear, Path::VertexBuffer],
        factors: &[6.0, 10.0],
        patches: Subset::Irregular,
        unit: Unit::Milliseconds,
        geometry: true,
        published: &[
            Published("508 irregular quads", Gregory, TwoStage, 10.0, 0.1047),
            Published("508 irregular quads", Pm, TwoStage, 10.0, 0.1327),
            Published("508 irregular quads", Gregory, Stencil, 10.0, 0.0913),
            Published("508 irregular quads", Acc, Stencil, 10.0, 0.104),
            Published("508 irregular quads", Gregory, TwoStage, 6.0, 0.0485),
            Published("508 irregular quads", Gregory, Stencil, 6.0, 0.053),
        ],
        ..USUAL
    },
    Preset {
        name: "loop2009-table2",
        title: "Loop, Schaefer, Ni, Castaño 2009, table 2: patches made every frame",
        note: "Published: frames a second on a GTX 260, instanced grids of N points along an edge, taken as factor N - 1. \
               Measured: the same (instanced), with pixels.",
        schemes: &[Gregory, Acc, Pm],
        constructions: &[Cached, TwoStage],
        paths: &[Path::Instanced, Path::Tessellation, Path::Bilinear, Path::VertexBuffer],
        factors: &[16.0, 24.0],
        published: &[
            Published("frog", Gregory, Cached, 16.0, 398.0),
            Published("frog", Acc, Cached, 16.0, 365.0),
            Published("frog", Pm, Cached, 16.0, 377.0),
            Published("frog", Gregory, Cached, 24.0, 213.0),
            Published("frog", Acc, Cached, 24.0, 186.0),
            Published("frog", Pm, Cached, 24.0, 208.0),
            Published("bigguy", Gregory, Cached, 16.0, 370.0),
            Published("bigguy", Acc, Cached, 16.0, 348.0),
            Published("bigguy", Pm, Cached, 16.0, 359.0),
            Published("bigguy", Gregory, Cached, 24.0, 194.0),
            Published("bigguy", Acc, Cached, 24.0, 176.0),
            Published("bigguy", Pm, Cached, 24.0, 186.0),
        ],
        ..USUAL
    },
    Preset {
        name: "ni2008-table4",
        title: "Ni, Yeo, Myles, Goel, Peters 2008, table 4: c-patches",
        note: "Published: frames a second, N x N points a patch, N = 5, 9, 17, 33, taken as factor N - 1, converted by \
               vertex and geometry shaders, then evaluated. Measured: the same in two passes (geometry-two-pass), with pixels.",
        schemes: &[CPatch],
        constructions: &[Cached, TwoStage],
        paths: CONVERTED,
        factors: &[4.0, 8.0, 16.0, 32.0],
        published: &[
            Published("sword", CPatch, Cached, 4.0, 965.0),
            Published("sword", CPatch, Cached, 8.0, 965.0),
            Published("sword", CPatch, Cached, 16.0, 965.0),
            Published("sword", CPatch, Cached, 32.0, 703.0),
            Published("head", CPatch, Cached, 4.0, 637.0),
            Published("head", CPatch, Cached, 8.0, 557.0),
            Published("head", CPatch, Cached, 16.0, 376.0),
            Published("head", CPatch, Cached, 32.0, 165.0),
            Published("frog", CPatch, Cached, 4.0, 483.0),
            Published("frog", CPatch, Cached, 8.0, 392.0),
            Published("frog", CPatch, Cached, 16.0, 226.0),
            Published("frog", CPatch, Cached, 32.0, 87.0),
        ],
        ..USUAL
    },
    Preset {
        name: "ni2008-table5",
        title: "Ni, Yeo, Myles, Goel, Peters 2008, table 5: c-patches in one pass",
        note: "Published: frames a second, N x N points a patch, N = 2, 5, 8, taken as factor N - 1, converted and evaluated in \
               one geometry shader. Measured: the same (geometry, stencil: the geometry shader makes the control points), with pixels.",
        schemes: &[CPatch],
        constructions: &[Stencil, Cached, TwoStage],
        paths: &[Path::Geometry, Path::GeometryTwoPass, Path::Tessellation, Path::Bilinear, Path::VertexBuffer],
        factors: &[1.0, 4.0, 7.0],
        published: &[
            Published("sword", CPatch, Stencil, 1.0, 389.0),
            Published("sword", CPatch, Stencil, 4.0, 96.0),
            Published("sword", CPatch, Stencil, 7.0, 43.0),
            Published("head", CPatch, Stencil, 1.0, 108.0),
            Published("head", CPatch, Stencil, 4.0, 34.0),
            Published("head", CPatch, Stencil, 7.0, 15.0),
            Published("frog", CPatch, Stencil, 1.0, 44.0),
            Published("frog", CPatch, Stencil, 4.0, 10.0),
            Published("frog", CPatch, Stencil, 7.0, 4.0),
        ],
        ..USUAL
    },
    Preset {
        name: "ni2008-nine",
        title: "Ni, Yeo, Myles, Goel, Peters 2008: c-patches, nine frogs",
        note: "Published: frames a second, N = 9, taken as factor N - 1. The way to draw is that of table 4.",
        schemes: &[CPatch],
        constructions: &[Cached, TwoStage],
        paths: CONVERTED,
        factors: &[8.0],
        instances: 9,
        published: &[Published("frog", CPatch, Cached, 8.0, 50.0)],
        ..USUAL
    },
    Preset {
        name: "antal2007",
        title: "Antal et al. 2007: Catmull-Clark subdivision of 1300 quads in geometry shaders, by levels 0, 1, 2",
        note: "Published: frames a second on an 8800 GTX; levels 0, 1, 2 are factors 1, 2, 4. Measured: the same, with pixels.",
        schemes: &[Gregory],
        constructions: &[TwoStage],
        paths: &[Path::Subdivision, Path::Tessellation, Path::Bilinear],
        factors: &[1.0, 2.0, 4.0],
        published: &[
            Published("1300 quads", Gregory, TwoStage, 1.0, 1073.0),
            Published("1300 quads", Gregory, TwoStage, 2.0, 306.0),
            Published("1300 quads", Gregory, TwoStage, 4.0, 18.8),
        ],
        ..USUAL
    },
    Preset {
        name: "niessner2012",
        title: "Nießner, Loop, Greiner 2012: semi-smooth creases from sharpness 0 to 8",
        note: "Published: time and memory hardly grow with sharpness where leaves follow creases, and double with each step where \
               faces along them are refined. Measured: an adaptive surface of depth 2 with leaves that follow creases, likewise \
               with end caps as deep as sharpness asks for, and with faces along creases refined as often; moving vertices.",
        schemes: &[Gregory],
        constructions: &[TwoStage],
        paths: &[Path::Tessellation, Path::Bilinear],
        factors: &[8.0],
        depths: &[2],
        creases: &Creases::ALL,
        sharpness: &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0],
        shape: "machine-part",
        ..USUAL
    },
];

/// A preset by its name.
pub(super) fn parser() -> impl TypedValueParser<Value = &'static Preset> {
    let value = |preset: &Preset| PossibleValue::new(preset.name).help(preset.title);
    PossibleValuesParser::new(PRESETS.iter().map(value)).map(|given| {
        // The parser lets none but these names through.
        PRESETS.iter().find(|preset| preset.name == given).unwrap_or(&PRESETS[0])
    })
}

described! {
    /// Description of a preset.
    #[derive(Debug, Serialize, Deserialize)]
    pub(super) struct PresetOut {
        pub name: String,
        pub title: String,
        /// Meaning of the figures, and why there are none.
        pub note: String,
    }
}

described! {
    /// A published figure and what was measured in its place.
    #[derive(Debug, Serialize, Deserialize)]
    pub(super) struct Beside {
        pub published_mesh: String,
        pub scheme: String,
        pub construction: String,
        pub factor: f32,
        pub figure: f64,
        pub unit: String,
        /// Ratio of times to the first figure of the mesh that something stands beside.
        pub published_ratio: f64,
        pub mesh: String,
        pub ms: f64,
        /// Ratio of medians to the row in place of that figure.
        pub ratio: f64,
    }
}

impl Preset {
    /// The schemes and constructions that it measures, if no others are given.
    pub(super) fn about_patches(&self) -> String {
        let schemes = self.schemes.iter().map(|scheme| scheme.name());
        schemes.chain(self.constructions.iter().map(|how| how.name())).collect::<Vec<_>>().join(", ")
    }

    /// Description where these figures are set beside.
    pub(super) fn about(&self, beside: &[Beside]) -> PresetOut {
        let mut note = self.note.to_owned();
        if beside.is_empty() && !self.published.is_empty() {
            let factors = unique(self.published, |published| published.3.to_string()).join(", ");
            let (path, patches) = (self.paths[0].name(), self.patches.name());
            let models = if self.instances == 1 { "one model".into() } else { format!("{} models", self.instances) };
            note += &format!(
                " None of the figures is of what was measured: they are of factors {factors}, {path}, {patches} patches of {models}, \
                 moving vertices, all in the picture, one pass."
            );
        }
        PresetOut { name: self.name.to_owned(), title: self.title.to_owned(), note }
    }

    /// Whether rows of these options are of what was published.
    fn is_of(&self, options: &OptionsOut) -> bool {
        (options.instances, options.patches.as_str(), options.refine) == (self.instances, self.patches.name(), 0)
    }

    /// Each figure with each mesh measured as was published; with the mesh of its name alone, where there is one.
    pub(super) fn beside(&self, rows: &[Row], meshes: &[MeshOut], options: &OptionsOut) -> Vec<Beside> {
        let copied = |row: &Row| meshes.iter().any(|mesh| mesh.name == row.setting.mesh && mesh.copies > 1);
        let rows: Vec<&Row> = rows.iter().filter(|row| row.setting.is_usual() && !copied(row)).collect();
        let mut lines = Vec::new();
        for figures in self.published.chunk_by(|a, b| a.0 == b.0).filter(|_| self.is_of(options)) {
            for rows in rows.chunk_by(|a, b| a.setting.mesh == b.setting.mesh) {
                let mesh = &rows[0].setting.mesh;
                let known = self.published.iter().find(|published| mesh.contains(published.0));
                if known.is_none_or(|known| known.0 == figures[0].0) {
                    lines.extend(self.lines(figures, rows));
                }
            }
        }
        lines
    }

    fn lines(&self, figures: &[Published], rows: &[&Row]) -> Vec<Beside> {
        let row = |published: &Published| {
            let Published(_, scheme, construction, factor, _) = published;
            let path = self.paths[0];
            let patches = (path != Path::Subdivision).then_some((*scheme, *construction));
            let drawn = Contestant::new(path, patches);
            let wanted = |row: &&&Row| row.who == Who::new(drawn) && row.factor == *factor;
            let row = *rows.iter().find(wanted)?;
            Some((row, if self.geometry { row.geometry_ms.median } else { row.gpu_ms.median }))
        };
        let found: Vec<_> = figures.iter().filter_map(|published| Some((published, row(published)?))).collect();
        let Some(&(first, (_, base))) = found.first() else { return Vec::new() };
        let published_base = self.unit.milliseconds(first.4);
        let line = |(published, (row, ms)): (&Published, (&Row, f64))| Beside {
            published_mesh: published.0.to_owned(),
            scheme: row.who.scheme.clone(),
            construction: row.who.construction.clone(),
            factor: row.factor,
            figure: published.4,
            unit: self.unit.name().to_owned(),
            published_ratio: self.unit.milliseconds(published.4) / published_base,
            mesh: row.setting.mesh.clone(),
            ms,
            ratio: ms / base,
        };
        found.into_iter().map(line).collect()
    }
}
