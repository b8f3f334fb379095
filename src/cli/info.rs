//! `subdiv info`: what a mesh has, and what it becomes.

use super::described::{described, help};
use super::error::CliError;
use super::output::{self, Progress, Table};
use super::parse;
use super::source::{MeshArgs, notes};
use ash_subdiv::adaptive::{AdaptiveOptions, LevelCounts, Reason};
use ash_subdiv::mesh::{Animations, Repair, Repairs};
use ash_subdiv::renderer::ModelTables;
use ash_subdiv::topology::PatchKind;
use ash_subdiv::{Construction, ControlMesh, ModelOptions};
use clap::Args;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Display;

#[derive(Debug, Args)]
#[command(after_help = help::<Info>("", EXAMPLES))]
pub(super) struct InfoArgs {
    #[command(flatten)]
    mesh: MeshArgs,
    /// The construction whose tables are counted.
    #[arg(long, value_name = "HOW", default_value = Construction::TwoStage.name(), value_parser = parse::one_of(Construction::ALL, Construction::name))]
    construction: Construction,
}

const EXAMPLES: &str = "\
.

Examples:
  subdiv info --shape creature
  subdiv info model.obj --construction stencil --json
  subdiv info model.obj --adaptive 5";

described! {
    #[derive(Serialize)]
    struct Info {
        vertices: usize,
        edges: usize,
        faces: usize,
        /// Faces by their number of corners.
        face_sizes: BTreeMap<u32, usize> = "faces by their number of corners",
        /// Faces with five or more corners.
        ngons: usize,
        holes: usize,
        edits: usize,
        boundary_edges: usize,
        creased_edges: usize,
        sharp_corners: usize,
        /// Vertices by their number of edges.
        valence: BTreeMap<u32, usize> = "vertices by their number of edges",
        bounds: [[f64; 3]; 2] = "[low, high]",
        refine: u32,
        patches: Patches,
        /// What irregular faces are refined to.
        #[serde(skip_serializing_if = "Option::is_none")]
        adaptive: Option<Leaves> = "with --adaptive",
        construction: &'static str,
        /// Rings (two-stage, cached) or patches (stencil) that differ in connectivity and so have weights of their own.
        connectivity_types: usize,
        /// By table, and `total`.
        bytes: BTreeMap<&'static str, u64> = "by table, and total",
        notices: Vec<String>,
        repairs: Vec<Repaired> = "of the file",
        /// Edges on boundaries that lie on others.
        loose_edges: usize = "on boundaries, on others",
        /// Put together out of triangles.
        rebuilt_quads: usize = "out of triangles",
        animations: Vec<AnimationOut>,
    }
}

described! {
    #[derive(Serialize)]
    struct AnimationOut {
        name: Option<String> = "null if it has none",
        seconds: f64 = "time of the last key",
    }
}

impl AnimationOut {
    fn all(animations: &Animations) -> Vec<Self> {
        let one =
            |number| Self { name: animations.name(number).map(str::to_owned), seconds: animations.duration(number) };
        (0..animations.len()).map(one).collect()
    }
}

described! {
    /// What was mended in the file.
    #[derive(Serialize)]
    struct Repaired {
        kind: &'static str,
        count: usize,
        first: String,
        /// Of the file, if its reader knows.
        line: Option<usize> = "of the first, from 1",
        note: String,
    }
}

described! {
    /// Patches by kind.
    #[derive(Debug, Clone, Copy, Serialize)]
    pub(super) struct Patches {
        regular: u32,
        irregular_quad: u32,
        /// Wedges of other faces, too: one for each edge.
        triangle: u32,
        /// Five for each face of five corners.
        pentagon: u32,
    }
}

described! {
    /// The leaves of adaptive subdivision, those too that are whole faces.
    #[derive(Serialize)]
    struct Leaves {
        depth: u32,
        sharp_depth: u32,
        leaves: usize,
        /// The sums of all levels.
        #[serde(flatten)]
        kinds: LeafKinds,
        levels: Vec<Level> = "from level 0",
    }
}

described! {
    /// Leaves by kind, and refined cells.
    #[derive(Default, Serialize)]
    struct LeafKinds {
        regular: usize,
        single_crease: usize,
        caps: usize,
        /// Refined cells by reason.
        refined: BTreeMap<&'static str, usize> = "cells by reason",
    }
}

described! {
    #[derive(Serialize)]
    struct Level {
        level: usize,
        #[serde(flatten)]
        kinds: LeafKinds,
    }
}

impl LeafKinds {
    fn new(counts: &LevelCounts) -> Self {
        let &LevelCounts { regular, single_crease, caps, refined, .. } = counts;
        let refined = Reason::ALL.into_iter().zip(refined).filter(|&(_, count)| count > 0);
        Self { regular, single_crease, caps, refined: refined.map(|(reason, count)| (reason.name(), count)).collect() }
    }

    fn add(&mut self, other: &Self) {
        self.regular += other.regular;
        self.single_crease += other.single_crease;
        self.caps += other.caps;
        other.refined.iter().for_each(|(reason, count)| *self.refined.entry(reason).or_default() += count);
    }

    fn leaves(&self) -> usize {
        self.regular + self.single_crease + self.caps
    }

    /// Why cells are refined.
    fn reasons(&self) -> String {
        let reasons: Vec<_> = self.refined.iter().map(|(reason, count)| format!("{count} {reason}")).collect();
        reasons.join(", ")
    }
}

impl Leaves {
    fn new(options: AdaptiveOptions, counts: &[LevelCounts]) -> Self {
        let level = |(level, counts)| Level { level, kinds: LeafKinds::new(counts) };
        let levels: Vec<Level> = counts.iter().enumerate().map(level).collect();
        let mut kinds = LeafKinds::default();
        levels.iter().for_each(|level| kinds.add(&level.kinds));
        let (depth, sharp_depth) = (options.depth, options.sharp_depth());
        Self { depth, sharp_depth, leaves: kinds.leaves(), kinds, levels }
    }

    fn print(&self) -> Result<(), CliError> {
        let mut table = Table::new(&[1, 2, 3, 4, 5]);
        table.row([&"leaves", &"all", &"regular", &"single-crease", &"end caps", &"refined", &"because of"]);
        let mut row = |name: &dyn Display, kinds: &LeafKinds| {
            let refined: usize = kinds.refined.values().sum();
            let LeafKinds { regular, single_crease, caps, .. } = kinds;
            table.row([name, &kinds.leaves(), regular, single_crease, caps, &refined, &kinds.reasons()]);
        };
        for Level { level, kinds } in &self.levels {
            row(&format!("level {level}"), kinds);
        }
        row(&"all levels", &self.kinds);
        table.print()
    }
}

impl Patches {
    pub(super) fn of(tables: &ModelTables) -> Self {
        Self {
            regular: tables.patch_count(PatchKind::Regular),
            irregular_quad: tables.patch_count(PatchKind::IrregularQuad),
            triangle: tables.patch_count(PatchKind::Triangle),
            pentagon: tables.patch_count(PatchKind::Pentagon),
        }
    }

    pub(super) fn total(self) -> u32 {
        self.regular + self.irregular_quad + self.triangle + self.pentagon
    }
}

impl Display for Patches {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { regular, irregular_quad, triangle, pentagon } = self;
        write!(f, "{} patches ({regular} regular, {irregular_quad} irregular, {triangle} triangles", self.total())?;
        if *pentagon > 0 {
            write!(f, ", {pentagon} of pentagons")?;
        }
        write!(f, ")")
    }
}

pub(super) fn run(args: &InfoArgs, json: bool) -> Result<(), CliError> {
    let progress = Progress::new("reading the mesh");
    let (mesh, repairs) = args.mesh.source.load_repaired()?;
    // They need not be right where nobody asks for them.
    let animations = args.mesh.source.animations().unwrap_or_else(|error| {
        error.message().iter().for_each(|why| progress.note(format!("the animations can't be read: {why}")));
        Animations::default()
    });
    progress.now("building tables");
    let options = args.mesh.model_options(args.construction);
    let tables = ModelTables::new(&mesh, &options)?;
    let animations_out = AnimationOut::all(&animations);
    let info = Info { animations: animations_out, ..Info::new(&mesh, &tables, &options, &repairs) };
    drop(progress);
    if json {
        return output::json_pretty(&info);
    }
    info.print()?;
    notes(&repairs).iter().chain(animations.notes()).for_each(output::note);
    info.notices.iter().for_each(output::note);
    Ok(())
}

impl Repaired {
    fn new(repair: &Repair) -> Self {
        let &Repair { kind, count, first, line, .. } = repair;
        Self { kind: kind.name(), count, first: first.to_string(), line, note: repair.to_string() }
    }
}

impl Info {
    fn new(mesh: &ControlMesh, tables: &ModelTables, options: &ModelOptions, repairs: &Repairs) -> Self {
        let data = mesh.data();
        let mut face_sizes = BTreeMap::new();
        data.face_sizes.iter().for_each(|&size| *face_sizes.entry(size).or_insert(0) += 1);
        let mut bytes: BTreeMap<_, _> = tables.bytes().into_iter().collect();
        bytes.insert("total", bytes.values().sum());
        Self {
            vertices: mesh.vertex_count(),
            edges: mesh.edge_count(),
            faces: mesh.face_count(),
            ngons: face_sizes.range(5..).map(|(_, count)| count).sum(),
            face_sizes,
            holes: data.holes.len(),
            edits: data.edits.len(),
            boundary_edges: mesh.boundary_edge_count(),
            creased_edges: mesh.creased_edge_count(),
            sharp_corners: data.corners.iter().filter(|corner| corner.sharpness > 0.0).count(),
            valence: valence(mesh),
            bounds: mesh.bounds().map(Into::into),
            refine: options.refine,
            patches: Patches::of(tables),
            adaptive: options.adaptive.zip(tables.leaves()).map(|(options, table)| Leaves::new(options, &table.counts)),
            construction: options.construction.name(),
            connectivity_types: tables.type_count(),
            bytes,
            notices: tables.notices().iter().map(ToString::to_string).collect(),
            repairs: repairs.list.iter().map(Repaired::new).collect(),
            loose_edges: repairs.loose_edges,
            rebuilt_quads: repairs.rebuilt_quads,
            animations: Vec::new(),
        }
    }

    fn print(&self) -> Result<(), CliError> {
        let mut table = Table::new(&[1]);
        table.row([&"vertices", &self.vertices]);
        table.row([&"edges", &self.edges]);
        table.row([&"  on a boundary", &self.boundary_edges]);
        table.row([&"  creased", &self.creased_edges]);
        table.row([&"faces", &self.faces]);
        for (size, count) in &self.face_sizes {
            table.row([&format!("  of {size} corners"), count]);
        }
        table.row([&"  holes", &self.holes]);
        if self.edits > 0 {
            table.row([&"hierarchical edits", &self.edits]);
        }
        table.row([&"sharp corners", &self.sharp_corners]);
        for (valence, count) in &self.valence {
            table.row([&format!("vertices of valence {valence}"), count]);
        }
        table.row([&"patches", &self.patches.total()]);
        table.row([&"  regular", &self.patches.regular]);
        table.row([&"  irregular quads", &self.patches.irregular_quad]);
        table.row([&"  triangles", &self.patches.triangle]);
        table.row([&"  of pentagons", &self.patches.pentagon]);
        for (number, AnimationOut { name, seconds }) in self.animations.iter().enumerate() {
            let name = name.as_deref().unwrap_or("without a name");
            table.row([&format!("animation {number}, {name}: seconds"), seconds]);
        }
        table.row([&"connectivity types", &self.connectivity_types]);
        table.row([&format!("bytes, {}", self.construction), &self.bytes["total"]]);
        for (name, bytes) in self.bytes.iter().filter(|(name, _)| **name != "total") {
            table.row([&format!("  {}", name.replace('_', " ")), bytes]);
        }
        table.print()?;
        if let Some(leaves) = &self.adaptive {
            leaves.print()?;
        }

        Ok(())
    }
}

/// Vertices by their number of edges.
fn valence(mesh: &ControlMesh) -> BTreeMap<u32, usize> {
    let mut edges = vec![0u32; mesh.vertex_count()];
    for face in 0..mesh.face_count() as u32 {
        let vertices = mesh.face(face);
        for (k, h) in mesh.face_corners(face).enumerate() {
            // An edge counts once: at its lower half-edge; a boundary's twin is above all.
            if mesh.twins()[h] > h as u32 {
                edges[vertices[k] as usize] += 1;
                edges[vertices[(k + 1) % vertices.len()] as usize] += 1;
            }
        }
    }
    let mut valence = BTreeMap::new();
    edges.into_iter().for_each(|count| *valence.entry(count).or_insert(0) += 1);
    valence
}
