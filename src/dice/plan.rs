//! All about a tessellation that does not depend on positions.

use super::bicubic::Basis;
use super::bounds::{self, Asked, Bounds};
use super::depth::halvings;
use super::error::DiceError;
use super::faces::FaceWriter;
use super::finer::Finer;
use super::layout::{Facet, Layout, Split};
use super::options::DiceOptions;
use super::patches::Patches;
use super::place::{Place, place};
use super::real::Real;
use super::texcoords::Texcoords;
use crate::limit::{Stencils, VertexEdits, refine};
use crate::mesh::SHARPNESS_INFINITE;
use crate::topology::Topology;
use rayon::prelude::*;

/// Sizes of a tessellation's arrays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Sizes {
    /// Vertices, those that share their position with another included, and those inside holes of edits ([`Plan::unused`]).
    pub vertices: usize,
    /// Vertices with a position of their own; they come first.
    pub positions: usize,
    /// Faces with four corners.
    pub quads: usize,
    /// Faces with three corners.
    pub triangles: usize,
    /// Bytes of a [`Tessellation`](super::Tessellation)'s arrays.
    pub bytes: u64,
}

/// Which facet is how deep, who writes which vertex, and the sums that make vertices: what stays when control vertices move.
pub struct Plan<T> {
    /// The mesh refined once, whose faces are the facets.
    pub(super) refined: Topology,
    /// The corner of a coarse face in which each facet lies, by face: sizes of the coarse faces.
    pub(super) face_offsets: Vec<u32>,
    pub(super) stencils: Stencils,
    pub(super) edits: VertexEdits,
    pub(super) control_vertices: usize,
    pub(super) layout: Layout,
    pub(super) patches: Patches<T>,
    pub(super) finer: Finer,
    /// By level.
    pub(super) finer_patches: Vec<Patches<T>>,
    pub(super) bases: Vec<Basis<T>>,
    pub(super) texcoords: Option<Texcoords<T>>,
}

impl<T: Real> Plan<T> {
    /// Plans a mesh. Depths come from its positions.
    ///
    /// # Errors
    /// [`DiceError`]: options that make no sense, and tessellations that are too large.
    pub fn new(topology: &Topology, options: &DiceOptions) -> Result<Self, DiceError> {
        let mesh = topology.mesh();
        options.check(mesh.corner_count())?;
        let coarse = refine(topology)?;
        let refined = Topology::new(&coarse.mesh);
        let mut drawn = vec![true; coarse.mesh.face_count()];
        coarse.mesh.data().holes.iter().for_each(|&hole| drawn[hole as usize] = false);
        if !drawn.contains(&true) {
            return Err(DiceError::NothingDrawn);
        }
        let finer = Finer::new(&refined, &drawn)?;
        let depths = halvings(&refined, &finer, &drawn, options)?;
        let seams = seams(topology);
        let split = |h: u32| {
            let is_inside = refined.twin(h).is_some_and(|twin| drawn[twin as usize / 4]);
            let crease = is_inside && refined.sharpness(h) >= SHARPNESS_INFINITE;
            // Only the edges around the corner of a facet are parts of edges of the mesh.
            let edge = match h % 4 {
                0 => Some(h / 4),
                3 => Some(topology.prev(h / 4)),
                _ => None,
            };
            Split { crease, seam: is_inside && edge.is_some_and(|edge| seams.get(edge as usize) == Some(&true)) }
        };
        let layout = Layout::new(&refined, &depths, |facet| finer.holes(facet), split)?;
        let patches = Patches::of_layout(&refined, &layout.facets)?;
        let finer_patches = Patches::of_finer(&finer, &layout.facets)?;
        let deepest = depths.iter().flatten().copied().max().unwrap_or(0);
        let bases = (0..=deepest).map(Basis::new).collect();
        let texcoords = Texcoords::new(&refined, &layout.facets)?;
        Ok(Self {
            face_offsets: mesh.face_offsets().to_vec(),
            stencils: coarse.stencils,
            edits: coarse.edits,
            control_vertices: mesh.vertex_count(),
            refined,
            layout,
            patches,
            finer,
            finer_patches,
            bases,
            texcoords,
        })
    }

    /// Sizes of all arrays.
    pub fn sizes(&self) -> Sizes {
        let layout = &self.layout;
        let (vertices, quads, triangles) = (layout.vertices(), layout.quads as usize, layout.triangles as usize);
        let vectors = 6 * size_of::<T>() as u64 + if self.texcoords.is_some() { 8 } else { 0 };
        let bytes = vertices as u64 * vectors + 16 * quads as u64 + 12 * triangles as u64;
        Sizes { vertices, positions: layout.owned as usize, quads, triangles, bytes }
    }

    /// Whether there are texture coordinates.
    pub fn has_texcoords(&self) -> bool {
        self.texcoords.is_some()
    }

    /// Facets by depth: entry d counts those at depth d.
    pub fn depth_histogram(&self) -> Vec<usize> {
        let mut histogram = Vec::new();
        for facet in &self.layout.facets {
            let depth = facet.depth as usize + 1;
            if histogram.len() <= depth {
                histogram.resize(depth + 1, 0);
            }
            histogram[depth] += 1;
        }
        histogram
    }

    /// The depth of each facet, one a face corner of the control mesh, as [`Depth::Each`](super::Depth::Each) has them; 1 where
    /// nothing is drawn. Of several positions of one mesh the greatest serve all.
    pub fn depths(&self) -> Vec<u32> {
        let mut depths = vec![1; self.face_offsets.last().map_or(0, |&end| end as usize)];
        self.facets().iter().for_each(|facet| depths[facet.facet as usize] = facet.depth + 1);
        depths
    }

    /// A distance within which all faces are of the limit surface, for the control vertices of which the plan was made.
    ///
    /// It is a bound from control points: second differences, `(uu + 2 uv + vv) / 8` of them at most and a quarter of that for each
    /// halving, wherever the surface is a B-spline patch (Filip, Magedson, Markot 1986; here less where the surface bends to both sides),
    /// and how far control points around what is left next to extraordinary vertices and sharp features are from a face. Between points with the same parameters it
    /// holds in any case. Where it is less, it is along the normals of faces, whose angles to the surface's count; there the surface
    /// must not fold back within a face. Displacement, texture coordinates and rounding are not covered.
    ///
    /// # Errors
    /// [`DiceError::Mesh`] if the refined mesh is too large.
    pub fn error_bound(&self) -> Result<f64, DiceError> {
        let deepest = self.bases.len() as u32 - 1;
        let of_piece = |piece: &[Facet]| -> Result<f64, DiceError> {
            let facets: Vec<u32> = piece.iter().map(|facet| facet.facet).collect();
            let bounds = Bounds::new(&self.refined, &self.finer, &facets, deepest)?;
            Ok(bounds.greatest(|index| {
                let Facet { depth, edges, .. } = piece[index];
                Asked { depth, has_finer_edges: edges.iter().any(|&edge| edge > depth) }
            }))
        };
        self.facets().chunks(bounds::PIECE).map(of_piece).try_fold(0.0, |most, bound| Ok(f64::max(most, bound?)))
    }

    /// The vertex whose position a vertex has: itself unless it is a copy along a crease or a seam.
    pub fn position_of(&self, vertex: u32) -> u32 {
        match vertex.checked_sub(self.layout.owned) {
            Some(copy) => self.layout.sources[copy as usize].position,
            None => vertex,
        }
    }

    /// Where on the control mesh each vertex is.
    pub fn places(&self) -> Vec<Place> {
        let mut places = vec![Place::default(); self.layout.vertices()];
        for facet in &self.layout.facets {
            let corner = facet.facet;
            let face = self.face_offsets.partition_point(|&offset| offset <= corner) - 1;
            let [start, end] = [face, face + 1].map(|face| self.face_offsets[face]);
            facet.for_each_written(|vertex, uv| {
                places[vertex as usize] = place(face as u32, corner - start, end - start, uv);
            });
        }
        places
    }

    /// Vertices that belong to no face, in order: those inside holes of edits. Positions of copies that belong to one are not
    /// among them.
    pub fn unused(&self) -> Vec<u32> {
        let facets = self.facets();
        if facets.iter().all(|facet| facet.holes.is_empty()) {
            return Vec::new();
        }
        let mut is_used = vec![false; self.layout.vertices()];
        let mut writer = FaceWriter::default();
        for facet in facets {
            let [quads, triangles] = facet.face_counts().map(|count| count as usize);
            let (mut quads, mut triangles) = (vec![[0; 4]; quads], vec![[0; 3]; triangles]);
            writer.write(facet, &mut quads, &mut triangles);
            for &vertex in quads.as_flattened().iter().chain(triangles.as_flattened()) {
                is_used[vertex as usize] = true;
                is_used[self.position_of(vertex) as usize] = true;
            }
        }
        (0..).zip(is_used).filter(|(_, is_used)| !is_used).map(|(vertex, _)| vertex).collect()
    }

    /// Index of a facet of the plan.
    pub(super) fn index_of(&self, facet: &Facet) -> usize {
        self.facets().partition_point(|other| other.facet < facet.facet)
    }

    /// Index of the facet that owns a vertex, which is no copy.
    pub(super) fn owner(&self, vertex: u32) -> usize {
        self.facets().partition_point(|facet| facet.first <= vertex) - 1
    }

    pub(super) fn facets(&self) -> &[Facet] {
        &self.layout.facets
    }
}

/// The half-edges along which the texture coordinates of the faces on both sides differ, if there are any.
fn seams(topology: &Topology) -> Vec<bool> {
    let Some(texcoords) = &topology.mesh().data().texcoords else { return Vec::new() };
    let index = |h: u32| texcoords.indices[h as usize];
    let is_seam = |h: u32| {
        topology
            .twin(h)
            .is_some_and(|twin| index(h) != index(topology.next(twin)) || index(topology.next(h)) != index(twin))
    };
    (0..topology.mesh().corner_count() as u32).into_par_iter().map(is_seam).collect()
}
