//! Whether neighbouring patches meet: to the last bit in their evaluated vertices, and in every pixel.

use crate::capture::{CaptureDraw, Captured, CapturedVertex, Idle, Which};
use crate::gpu::Blend;
use crate::headless::{Headless, Offscreen, OffscreenDesc, Texture};
use crate::mesh::{ControlMesh, FaceVarying, MeshData, SHARPNESS_INFINITE};
use crate::renderer::{
    DrawItem, EdgeTable, Error, Factor, Fragment, ModelOptions, ModelTables, Options, Renderer, Style, Target, View,
};
use crate::table::{Patch, prepare_for};
use crate::topology::PatchKind;
use ash::vk;
use rayon::prelude::*;

mod shaders {
    //! Compiled from `glsl/measure`.
    include!(concat!(env!("OUT_DIR"), "/measure_shaders.rs"));
}

/// Comparison of the patches at edges: samples, and those that differ.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tally {
    /// Pairs of vertices that two patches evaluated at one place of the surface.
    pub samples: u64,
    /// Pairs whose positions differ in some bit (zeros of both signs are one), and vertices that only one patch has.
    pub position_mismatches: u64,
    /// Pairs whose normals differ, where the surface is to have one.
    pub normal_mismatches: u64,
    /// The first that differ.
    pub first: Option<Mismatch>,
}

impl Tally {
    /// Puts together what two comparisons found.
    pub fn add(&mut self, other: Self) {
        self.samples += other.samples;
        self.position_mismatches += other.position_mismatches;
        self.normal_mismatches += other.normal_mismatches;
        self.first = self.first.take().or(other.first);
    }

    /// Whether nothing differs.
    pub fn is_watertight(&self) -> bool {
        self.position_mismatches == 0 && self.normal_mismatches == 0
    }
}

/// Two vertices that should be the same, or one that has no partner.
#[derive(Debug, Clone, PartialEq)]
pub struct Mismatch {
    /// The vertices at both ends of the edge, or the one vertex twice.
    pub vertices: [u32; 2],
    /// Parameter along the edge.
    pub at: f32,
    /// The faces of the vertices.
    pub faces: [u32; 2],
    /// The vertices.
    pub captured: [CapturedVertex; 2],
}

/// Who meets whom: for the evaluated vertices of one model.
pub struct Seams {
    patches: Vec<Patch>,
    /// The number of the first corner of each patch.
    first_corners: Vec<usize>,
    edges: EdgeTable,
    /// Whether each edge has two patches, and whether they are to have one normal.
    paired: Vec<bool>,
    smooth: Vec<bool>,
    /// For each patch corner: its vertex and its ring; whether its plus edge leads to a lower vertex.
    corners: Vec<(u32, u32, bool)>,
}

impl Seams {
    /// Seams of a model of a mesh that is drawn with these tables.
    ///
    /// # Errors
    /// As [`ModelTables::new`].
    pub fn new(mesh: &ControlMesh, tables: &ModelTables) -> Result<Self, Error> {
        let (prepared, ..) = prepare_for(mesh, &tables.options())?;
        let topology = prepared.topology();
        let plan = tables.plan();
        let edges = prepared.edges(plan);
        let mut patches = vec![0; edges.vertices.len()];
        edges.of_corners.iter().for_each(|&edge| patches[edge as usize] += 1);
        // Leaves on both sides of an edge have one normal wherever the limit surface has.
        let mut of_leaves = vec![true; edges.vertices.len()];
        let refined = plan.patches().iter().flat_map(|patch| std::iter::repeat_n(patch.refined, patch.kind.corners()));
        refined.zip(&edges.of_corners).for_each(|(refined, &edge)| of_leaves[edge as usize] &= refined);
        let mut smooth = vec![true; edges.vertices.len()];
        let half_edges = plan.corners(topology);
        for (&h, &edge) in half_edges.iter().zip(&edges.of_corners) {
            smooth[edge as usize] = match of_leaves[edge as usize] {
                true => topology.sharpness(h) < SHARPNESS_INFINITE,
                false => topology.is_within_rings(h),
            };
        }
        let corner = |&h: &u32| {
            let (vertex, next) = (topology.mesh_vertex(h), topology.mesh_vertex(topology.next(h)));
            (vertex, topology.place(h).ring, vertex > next)
        };
        let corners = half_edges.iter().map(corner).collect();
        let paired = patches.into_iter().map(|count| count == 2).collect();
        let patches = plan.patches().to_vec();
        let first_corner = |sum: &mut usize, patch: &Patch| {
            let first = *sum;
            *sum += patch.kind.corners();
            Some(first)
        };
        let first_corners = patches.iter().scan(0, first_corner).collect();
        Ok(Self { patches, first_corners, edges, paired, smooth, corners })
    }

    /// Edges with two patches.
    pub fn edge_count(&self) -> usize {
        self.paired.iter().filter(|&&paired| paired).count()
    }

    /// Compares vertices of one draw; `normals` says whether they are shared. With culling, vertices may be without
    /// partner.
    pub fn compare(&self, vertices: &[CapturedVertex], normals: bool, culled: bool) -> Tally {
        let mut places: Vec<Place> = vertices
            .par_iter()
            .enumerate()
            .filter_map(|(i, vertex)| self.place(vertex).map(|key| Place { key, index: i as u32 }))
            .collect();
        places.par_sort_unstable();
        let groups: Vec<&[Place]> = places.chunk_by(|a, b| a.key == b.key).collect();
        let tally = |group: &&[Place]| self.compare_group(group, vertices, normals, culled);
        let add = |mut a: Tally, b: Tally| {
            a.add(b);
            a
        };
        groups.par_iter().map(tally).reduce(Tally::default, add)
    }

    fn compare_group(&self, group: &[Place], vertices: &[CapturedVertex], normals: bool, culled: bool) -> Tally {
        let key = group[0].key;
        let first = vertices[group[0].index as usize];
        let mut tally = Tally::default();
        let note = |tally: &mut Tally, other: CapturedVertex| {
            let faces = [first, other].map(|vertex| self.patches[vertex.patch as usize].face);
            let vertices = if key.is_edge { self.edges.vertices[key.number as usize] } else { [key.number; 2] };
            let mismatch = Mismatch { vertices, at: f32::from_bits(key.at), faces, captured: [first, other] };
            tally.first.get_or_insert(mismatch);
        };
        if key.is_edge && self.paired[key.number as usize] && !culled {
            let lonely = group.iter().all(|place| vertices[place.index as usize].patch == first.patch);
            if lonely {
                tally.position_mismatches += 1;
                note(&mut tally, first);
            }
        }
        for place in &group[1..] {
            let other = vertices[place.index as usize];
            tally.samples += 1;
            let smooth =
                if key.is_edge { self.smooth[key.number as usize] } else { self.ring(&first) == self.ring(&other) };
            if bits(first.position) != bits(other.position) {
                tally.position_mismatches += 1;
                note(&mut tally, other);
            } else if normals && smooth && bits(first.normal) != bits(other.normal) {
                tally.normal_mismatches += 1;
                note(&mut tally, other);
            }
        }
        tally
    }

    /// The ring at the corner of a patch that a captured vertex is at.
    fn ring(&self, captured: &CapturedVertex) -> Option<u32> {
        let patch = captured.patch as usize;
        let on = on_edges(self.patches[patch].kind, captured.coordinate);
        let (k, _) = on.into_iter().flatten().find(|(_, t)| *t == 0.0)?;
        Some(self.corners[self.first_corners[patch] + k].1)
    }

    /// Which edge, or which vertex, a captured vertex lies on, if any.
    fn place(&self, captured: &CapturedVertex) -> Option<Key> {
        let patch = captured.patch as usize;
        let kind = self.patches[patch].kind;
        let first = self.first_corners[patch];
        let on = on_edges(kind, captured.coordinate);
        if let Some((k, _)) = on.into_iter().flatten().find(|(_, t)| *t == 0.0) {
            return Some(Key { is_edge: false, number: self.corners[first + k].0, at: 0 });
        }
        let (k, t) = on.into_iter().flatten().next()?;
        let reversed = self.corners[first + k].2;
        let at = if reversed { 1.0 - t } else { t };
        Some(Key { is_edge: true, number: self.edges.of_corners[first + k], at: at.to_bits() })
    }
}

/// A place where patches meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    is_edge: bool,
    /// Of the edge or the vertex.
    number: u32,
    /// Bits of the way from the lower vertex.
    at: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Place {
    key: Key,
    /// Of the captured vertex.
    index: u32,
}

/// The edges of a patch on which parameters lie, by the corner where each starts, and how far along: two at a corner.
fn on_edges(kind: PatchKind, [u, v, w]: [f32; 3]) -> [Option<(usize, f32)>; 4] {
    let edge = |k: usize, distance: f32, t: f32| (distance == 0.0).then_some((k, t));
    match kind {
        PatchKind::Triangle => [edge(0, w, v), edge(1, u, w), edge(2, v, u), None],
        _ => [edge(0, v, u), edge(1, 1.0 - u, v), edge(2, 1.0 - v, 1.0 - u), edge(3, u, 1.0 - v)],
    }
}

fn bits(x: [f32; 3]) -> [u32; 3] {
    x.map(|x| (x + 0.0).to_bits())
}

/// A mesh of which every face has a part of texture space to itself, so that every edge is a seam.
///
/// # Errors
/// None that the mesh did not have before.
pub fn with_seams_everywhere(mesh: &ControlMesh) -> Result<ControlMesh, Error> {
    let mut values = Vec::with_capacity(mesh.corner_count());
    for face in 0..mesh.face_count() {
        let n = mesh.face(face as u32).len();
        // A regular polygon, turned from face to face.
        let corner = |k: usize| {
            let angle = std::f32::consts::TAU * (k as f32 / n as f32 + 0.618 * face as f32);
            [0.5 + 0.45 * angle.cos(), 0.5 + 0.45 * angle.sin()]
        };
        values.extend((0..n).map(corner));
    }
    let indices = (0..values.len() as u32).collect();
    let texcoords = Some(FaceVarying { values, indices });
    Ok(ControlMesh::new(MeshData { texcoords, ..mesh.data().clone() })?)
}

/// Factors from 1 to `most`, different for every edge.
pub fn random_factors(edges: usize, most: f32, seed: u64) -> Vec<f32> {
    let factor = |edge: u64| {
        // SplitMix64 (Steele, Lea and Flood 2014).
        let mut x =
            (edge + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(seed.wrapping_mul(0xd1b5_4a32_d192_ed03));
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        1.0 + (most - 1.0) * ((x ^ (x >> 31)) >> 40) as f32 / (1u64 << 24) as f32
    };
    (0..edges as u64).map(factor).collect()
}

/// Captures what a draw evaluates on edges and compares it.
///
/// # Errors
/// As [`Captured::vertices_of`].
pub fn compare(captured: &Captured, seams: &Seams, draw: &CaptureDraw, normals: bool) -> Result<Tally, Error> {
    let vertices = captured.vertices_of(draw, Which::OnEdges)?;
    Ok(seams.compare(&vertices, normals, draw.cull != crate::renderer::Cull::NONE))
}

/// Pixels of a square picture in which a closed surface does not have as many layers that face the eye as layers that face
/// away: where there is a hole, or something is drawn twice.
///
/// # Errors
/// As [`Renderer::add_model`] and [`Renderer::cmd_draw`].
pub fn leaked_pixels(
    headless: &Headless,
    mesh: &ControlMesh,
    options: &ModelOptions,
    displacement: Option<&Texture>,
    draw: &CaptureDraw,
    side: u32,
) -> Result<u64, Error> {
    let kept = headless.kept::<Idle<(u32, ModelOptions), Layers>>();
    let drawn = (side, options.clone());
    let mut layers = kept.take(&drawn, || Layers::new(headless, side))?;
    let Layers { renderer, target } = &mut layers;
    // SAFETY: the texture outlives the model, and nothing else looks at it.
    let map = displacement.map(|texture| unsafe { renderer.add_displacement(texture.into()) });
    let options = ModelOptions { displacement: map, ..options.clone() };
    let (tables, drawn_so) = (ModelTables::new(mesh, &options)?, (draw.factor, draw.cull));
    let model = renderer.add_drawn(tables, &mesh.positions_f32(), &options, drawn_so)?;
    // SAFETY: the frame before was waited for.
    let frame = unsafe { renderer.begin_frame() };
    if let Factor::Edges(_) = draw.factor {
        renderer.set_edge_factors(model, frame, &draw.edge_factors)?;
    }
    let CaptureDraw { factor, cull, displacement, .. } = *draw;
    let item = DrawItem { factor, cull, displacement, ..DrawItem::new(model, 1.0) };
    let view: View = draw.view;
    // SAFETY: outside rendering, and inside what fits the target.
    headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, frame) })?;
    // SAFETY: likewise.
    let pixels = target.draw(headless, [0.0; 4], |cmd| unsafe { renderer.cmd_draw(cmd, frame, &view, &[item]) })?;
    renderer.remove_model(model)?;
    map.map_or(Ok(()), |map| renderer.remove_displacement(map))?;
    // SAFETY: all frames before are done. Frees the model.
    unsafe { renderer.begin_frame() };
    kept.put_back(drawn, layers);
    Ok(pixels.chunks_exact(4).filter(|pixel| pixel[0] != pixel[1]).count() as u64)
}

/// A renderer that counts layers, without a model between pictures.
struct Layers {
    renderer: Renderer,
    target: Offscreen,
}

impl Layers {
    fn new(headless: &Headless, side: u32) -> Result<Self, Error> {
        let desc = OffscreenDesc { color: vk::Format::R8G8B8A8_UNORM, ..OffscreenDesc::new(side, side) };
        let style = Style {
            fragment: Fragment::Spirv(shaders::LAYERS_FRAG.to_vec()),
            blend: Blend::Add,
            depth: None,
            ..Style::default()
        };
        let options = Options { frames_in_flight: 1, styles: vec![style], ..Options::default() };
        let render_target = Target::dynamic(desc.color, desc.depth, desc.samples);
        let target = Offscreen::new(headless, &desc)?;
        // SAFETY: every submission is waited for.
        let renderer = unsafe { Renderer::new(headless.context(), &render_target, &options)? };
        Ok(Self { renderer, target })
    }
}
