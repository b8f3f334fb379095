//! The leaves of an adaptive surface, as what is painted on it.

use super::super::parse::Colour;
use super::legend::{Legend, Swatch};
use super::tiles::Tiles;
use ash_subdiv::MeshError;
use ash_subdiv::adaptive::{LEAF, LeafKind, MAX_DEPTH, Plan};
use ash_subdiv::table::CpuSurface;
#[cfg(doc)]
use ash_subdiv::table::Prepared;

/// Kinds of leaves: regular, single crease, end cap.
const KINDS: usize = 3;

/// By level. Of neighbours one is much lighter than the other, or of quite another hue.
const COLOURS: [Colour; MAX_DEPTH as usize + 1] = [
    Colour::rgb(0xb8b0a3),
    Colour::rgb(0x4c78a8),
    Colour::rgb(0x54a24b),
    Colour::rgb(0xeeca3b),
    Colour::rgb(0xf58518),
    Colour::rgb(0xd64550),
    Colour::rgb(0xb279a2),
    Colour::rgb(0x72b7b2),
    Colour::rgb(0x9d755d),
    Colour::rgb(0xff9da6),
    Colour::rgb(0x5b5b9e),
];

/// What the kinds of a level are mixed with, and by how much: light where a crease is followed, dark at end caps.
const TONES: [(Colour, f32); KINDS] =
    [(Colour::rgb(0), 0.0), (Colour::rgb(0xffffff), 0.6), (Colour::rgb(0x10131a), 0.55)];

/// The quadtree of each patch, with the levels and kinds of its leaves. GLSL twin: `src/cli/glsl/levels.frag`.
pub(in super::super) struct LevelMap {
    pub(super) tiles: Tiles,
    /// Of each patch the two that it is evaluated by: as [`Prepared::roots`].
    roots: Vec<[u32; 2]>,
    nodes: Vec<u32>,
    /// Whether there are leaves of each colour.
    is_seen: [bool; KINDS * COLOURS.len()],
}

impl LevelMap {
    /// The leaves of `surface`, which has this plan.
    pub(in super::super) fn new(surface: &CpuSurface, plan: &Plan) -> Result<Self, MeshError> {
        let number = |leaf: u32| {
            let leaf = &plan.leaves[leaf as usize];
            KINDS * leaf.level as usize + kind(leaf.kind)
        };
        let is_leaf = |node: u32| node & LEAF != 0;
        let colour = |&node: &u32| if is_leaf(node) { number(node & !LEAF) as u32 | LEAF } else { node };
        let mut is_seen = [false; KINDS * COLOURS.len()];
        (0..plan.leaves.len() as u32).for_each(|leaf| is_seen[number(leaf)] = true);
        let roots = surface.plan().patches().iter().map(|patch| surface.prepared().roots(plan, patch));
        let (roots, nodes) = (roots.collect(), plan.nodes.iter().map(colour).collect());
        Ok(Self { tiles: Tiles::new(surface)?, roots, nodes, is_seen })
    }

    /// Bytes that the shader reads.
    pub(super) fn bytes(&self) -> Vec<u8> {
        let Tiles { columns, words, .. } = &self.tiles;
        let header = [*columns, self.roots.len() as u32, words.len() as u32, 0];
        let colours: Vec<[f32; 4]> = (0..KINDS * COLOURS.len()).map(|number| colour(number).linear()).collect();
        let words = [words, self.roots.as_flattened(), &self.nodes].concat();
        [bytemuck::cast_slice(&header), bytemuck::cast_slice(&colours), bytemuck::cast_slice(&words)].concat()
    }

    /// The colours of the levels.
    pub(super) fn legend(&self) -> Legend {
        let swatch = |level: usize| {
            let seen = (KINDS * level..KINDS * (level + 1)).filter(|&number| self.is_seen[number]);
            Swatch { name: level.to_string(), colours: seen.map(colour).collect() }
        };
        let last = self.is_seen.iter().rposition(|&seen| seen).unwrap_or(0) / KINDS;
        let of_kind = |kind: usize| self.is_seen.iter().skip(kind).step_by(KINDS).any(|&seen| seen);
        let crease = if of_kind(1) { ", light: single crease" } else { "" };
        let cap = if of_kind(2) { ", dark: end cap" } else { "" };
        Legend::Swatches { title: format!("levels{crease}{cap}"), swatches: (0..=last).map(swatch).collect() }
    }
}

fn kind(kind: LeafKind) -> usize {
    match kind {
        LeafKind::Regular => 0,
        LeafKind::SingleCrease { .. } => 1,
        LeafKind::Cap => 2,
    }
}

/// The colour of a level and kind.
fn colour(number: usize) -> Colour {
    let (Colour(level), (Colour(tone), part)) = (COLOURS[number / KINDS], TONES[number % KINDS]);
    let mixed = |i: usize| (f32::from(level[i]) * (1.0 - part) + f32::from(tone[i]) * part).round() as u8;
    Colour([mixed(0), mixed(1), mixed(2), 255])
}
