//! The leaves of adaptive surfaces, as `subdiv patches --adaptive` writes them.

use super::error::CliError;
use super::output;
use super::patches::{by_origin, heading, sub};
use ash_subdiv::adaptive::{Leaf, LeafKind, Plan};
use ash_subdiv::table::{CpuSurface, FaceOrigin};
use ash_subdiv::topology::PatchKind;
use glam::DVec3;
use serde::{Serialize, Serializer};

/// A surface with its leaves, which are written one by one: by the origins of the patches, of each in the order of its quadtree.
struct Leaves<'s> {
    plan: &'s Plan,
    /// What control points are made of.
    vertices: Vec<DVec3>,
    /// Each patch's origin, and the root of its quadtree.
    patches: Vec<(FaceOrigin, u32)>,
}

#[derive(Serialize)]
struct LeavesOut<'s> {
    construction: &'static str,
    leaves: &'s Leaves<'s>,
}

/// A leaf as it is written.
#[derive(Serialize)]
struct LeafOut {
    /// The face of the input.
    face: u32,
    /// As [`sub`] has it.
    sub: i64,
    /// The cell of the patch.
    level: u32,
    u: u32,
    v: u32,
    kind: &'static str,
    /// The edge along which the crease is.
    edge: Option<u32>,
    /// The crease's sharpness at the level of the leaf.
    sharpness: Option<f32>,
    points: Vec<[f64; 3]>,
}

impl LeafOut {
    fn new(origin: FaceOrigin, leaf: &Leaf, points: Vec<DVec3>) -> Self {
        let &Leaf { level, u, v, kind, .. } = leaf;
        let (name, edge, sharpness) = match kind {
            LeafKind::Regular => ("regular", None, None),
            LeafKind::SingleCrease { edge, sharpness } => ("single_crease", Some(edge), Some(sharpness)),
            LeafKind::Cap => ("cap", None, None),
        };
        let points = points.into_iter().map(Into::into).collect();
        Self { face: origin.face, sub: sub(&origin), level, u, v, kind: name, edge, sharpness, points }
    }
}

impl Serialize for Leaves<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter().map(|(origin, leaf, points)| LeafOut::new(origin, leaf, points)))
    }
}

impl<'s> Leaves<'s> {
    fn new(surface: &'s CpuSurface, plan: &'s Plan) -> Self {
        let (origins, patches) = (surface.origins(), surface.plan().patches());
        // Of the two of a wedge the one around its corner: the other is the next wedge's.
        let patch = |i: usize| (origins[i], surface.prepared().roots(plan, &patches[i])[0]);
        Self { plan, vertices: surface.vertices(|p| p), patches: by_origin(&origins).into_iter().map(patch).collect() }
    }

    fn iter(&self) -> impl Iterator<Item = (FaceOrigin, &Leaf, Vec<DVec3>)> {
        self.patches.iter().flat_map(move |&(origin, root)| {
            self.plan.leaves_of(root).into_iter().map(move |leaf| {
                let leaf = &self.plan.leaves[leaf as usize];
                (origin, leaf, self.plan.control_points(leaf, &self.vertices))
            })
        })
    }
}

/// Writes the leaves of a surface, which has this plan.
pub(super) fn write(surface: &CpuSurface, plan: &Plan, json: bool) -> Result<(), CliError> {
    let leaves = Leaves::new(surface, plan);
    if json {
        return output::json(&LeavesOut { construction: "cpu", leaves: &leaves });
    }
    let scheme = surface.plan().scheme();
    output::with_stdout(|out| {
        for (origin, leaf, points) in leaves.iter() {
            let Leaf { level, u, v, kind, .. } = leaf;
            let kind_name = match kind {
                LeafKind::Regular => "regular".into(),
                LeafKind::SingleCrease { edge, sharpness } => format!("crease of sharpness {sharpness} on edge {edge}"),
                LeafKind::Cap => "end cap".into(),
            };
            writeln!(out, "{}level {level}, cell {u} {v}: {kind_name}", heading(origin))?;
            for (number, DVec3 { x, y, z }) in points.into_iter().enumerate() {
                let name = match kind {
                    LeafKind::Cap => scheme.point_name(PatchKind::IrregularQuad, number),
                    _ => format!("c{}{}", number / 4, number % 4),
                };
                writeln!(out, "  {name:<7}{x:>24}{y:>24}{z:>24}")?;
            }
        }
        Ok(())
    })
}
