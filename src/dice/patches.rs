//! The facets of a mesh of quads, each with its kind and the points around it.

use super::finer::{Cell, Finer, Turned};
use super::kinds::{Builder, Kind};
use super::layout::Facet;
use super::real::Real;
use crate::adaptive::grid;
use crate::limit::Local;
use crate::mesh::MeshError;
use crate::topology::{RingKind, Topology};
use glam::DVec3;
use rayon::prelude::*;

/// In the place of a kind: a B-spline patch of 16 vertices with nothing beside it, number `4 i + j` with index i along u and j
/// along v.
pub(super) const PLAIN: u32 = u32::MAX;

/// Facets that are looked at together.
const PIECE: usize = 1 << 14;

/// What makes the surface over each facet.
pub(super) struct Patches<T> {
    pub kinds: Vec<Kind<T>>,
    /// The kind of each facet, by its index.
    of_facets: Vec<u32>,
    /// Where the points of each facet start, and after the last facet their number.
    starts: Vec<u32>,
    /// Vertices of the mesh.
    points: Vec<u32>,
}

impl<T: Real> Patches<T> {
    /// Of facets that are faces of the mesh. `deepen` makes what the facet with an index, of a kind, is evaluated with.
    pub(super) fn new(
        topology: &Topology,
        facets: &[Turned],
        deepen: impl Fn(&mut Builder, usize, u32) -> Result<(), MeshError>,
    ) -> Result<Self, MeshError> {
        let part = |facet: &Turned| {
            let is_plain = (0..4).all(|k| is_plain(topology, facet.half_edge(k)));
            (!is_plain).then(|| Local::cut(topology, facet.face, facet.first as usize, DVec3::ZERO))
        };
        let mut builder = Builder::default();
        let mut patches = Self {
            kinds: Vec::new(),
            of_facets: Vec::with_capacity(facets.len()),
            starts: vec![0],
            points: Vec::with_capacity(16 * facets.len()),
        };
        // No more neighbourhoods are kept at a time than a piece has.
        let parts =
            facets.chunks(PIECE).flat_map(|piece| piece.par_iter().with_min_len(256).map(part).collect::<Vec<_>>());
        for (index, part) in parts.enumerate() {
            patches.of_facets.push(match part {
                Some(part) => {
                    patches.points.extend(part.vertices);
                    let kind = builder.number(part.data)?;
                    deepen(&mut builder, index, kind)?;
                    kind
                }
                None => {
                    patches.points.extend(grid(topology, [0, 1, 2, 3].map(|k| facets[index].half_edge(k))));
                    PLAIN
                }
            });
            patches.starts.push(patches.points.len() as u32);
        }
        patches.kinds = builder.finish();
        Ok(patches)
    }

    /// Of facets with all that they write.
    pub(super) fn of_layout(topology: &Topology, facets: &[Facet]) -> Result<Self, MeshError> {
        let numbers: Vec<Turned> = facets.iter().map(|facet| Turned { face: facet.facet, first: 0 }).collect();
        Self::new(topology, &numbers, |builder, index, kind| {
            let facet = &facets[index];
            builder.deepen(kind, facet.depth)?;
            facet.finer_copies().try_for_each(|k| builder.deepen(kind, facet.edges[k]))
        })
    }

    /// Of the finer parts of facets, by level.
    pub(super) fn of_finer(finer: &Finer, facets: &[Facet]) -> Result<Vec<Self>, MeshError> {
        let mut depths: Vec<Vec<Vec<u32>>> =
            finer.levels.iter().map(|level| vec![Vec::new(); level.faces.len()]).collect();
        for facet in facets {
            let Some(node) = finer.node(facet.facet) else { continue };
            for depth in std::iter::once(facet.depth).chain(facet.finer_copies().map(|k| facet.edges[k])) {
                finer.for_each_face(Cell::Node(node), depth, &mut |level, index, depth| {
                    depths[level as usize][index as usize].push(depth);
                });
            }
        }
        let of_level = |(level, depths): (&super::finer::Level, &Vec<Vec<u32>>)| {
            Self::new(&level.topology, &level.faces, |builder, index, kind| {
                depths[index].iter().try_for_each(|&depth| builder.deepen(kind, depth))
            })
        };
        finer.levels.iter().zip(&depths).map(of_level).collect()
    }

    /// The kind of a facet by its index, and the vertices that are its points.
    pub(super) fn facet(&self, facet: usize) -> (u32, &[u32]) {
        (self.of_facets[facet], &self.points[self.starts[facet] as usize..self.starts[facet + 1] as usize])
    }
}

/// Whether the vertex from which a half-edge starts is inside the surface, with four quads and nothing sharp.
fn is_plain(topology: &Topology, half_edge: u32) -> bool {
    let ring = &topology.rings()[topology.place(half_edge).ring as usize];
    if ring.kind != RingKind::Smooth || !ring.is_regular() {
        return false;
    }
    let data = topology.mesh().data();
    data.creases.is_empty() && data.corners.is_empty()
        || topology.vertex_sharpness(topology.mesh_vertex(half_edge)) == 0.0
            && topology.ring_half_edges(ring).all(|h| topology.sharpness(h) == 0.0)
}
