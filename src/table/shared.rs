//! Ownership of what patches share: the ring that owns each edge and each vertex.

use super::edges::EdgeTable;
use super::plan::PatchPlan;
use crate::constants::{self, SHARP_EDGE_BIT};
use crate::topology::Topology;
use rayon::prelude::*;

/// Words of [`SharedTable::corners`] a patch corner.
pub const SHARED_WORDS: usize = constants::SHARED_WORDS as usize;

/// Texture coordinates of a patch corner on what it shares: where displacement is looked up there, so that both sides of a
/// seam find the same texel. The patch's own are used inside. GLSL twin: `glsl/lib/edges/shared_texcoords.glsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct SharedTexcoord {
    /// At this end of the plus edge, on the side that owns the edge.
    pub plus: [f32; 2],
    /// At this end of the minus edge, likewise.
    pub minus: [f32; 2],
    /// At the corner, where the ring that owns the vertex starts.
    pub corner: [f32; 2],
    /// First the mean length of an edge of that ring in texture space, then zero.
    pub scale: [f32; 2],
}

/// Owners of what patch corners share with other patches.
///
/// Along a smooth edge and around a smooth vertex there is only one ring to ask. The edges' owners are those of their
/// [`EdgeRecord`](super::EdgeRecord)s; a vertex with several rings has the first of them in [`Topology::rings`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SharedTable {
    /// For each patch corner, in the order of the plan: the ring that owns the vertex; the ring at this vertex on the side that
    /// owns the plus edge, and the number of the edge in it, with `SHARP_EDGE_BIT`; the same of the minus edge, without. GLSL
    /// twin: `glsl/lib/edges/shared.glsl`.
    pub corners: Vec<[u32; SHARED_WORDS]>,
    /// Likewise, for displacement; else empty.
    pub texcoords: Vec<SharedTexcoord>,
}

impl SharedTable {
    /// For the corners of the patches in `plan`.
    pub fn new(topology: &Topology, edges: &EdgeTable, plan: &PatchPlan) -> Self {
        let owners = Owners::new(topology, edges);
        let corners = plan.corners(topology).into_par_iter().map(|h| owners.corner(h));
        Self { corners: corners.collect(), texcoords: Vec::new() }
    }

    /// The same, with texture coordinates for displacement. `None` if the mesh has none.
    pub fn with_texcoords(topology: &Topology, edges: &EdgeTable, plan: &PatchPlan) -> Option<Self> {
        let attribute = topology.mesh().data().texcoords.as_ref()?;
        let at = |h: u32| attribute.values[attribute.indices[h as usize] as usize];
        let owners = Owners::new(topology, edges);
        let corners = plan.corners(topology);
        Some(Self {
            corners: corners.par_iter().map(|&h| owners.corner(h)).collect(),
            texcoords: corners.par_iter().map(|&h| owners.texcoord(h, at)).collect(),
        })
    }
}

/// Owners of edges and vertices.
struct Owners<'t> {
    topology: &'t Topology,
    edges: &'t EdgeTable,
    /// The first ring of each vertex of the mesh.
    first_rings: Vec<u32>,
}

const NO_RING: u32 = u32::MAX;

impl<'t> Owners<'t> {
    fn new(topology: &'t Topology, edges: &'t EdgeTable) -> Self {
        let mut first_rings = vec![NO_RING; topology.mesh().vertex_count()];
        for (ring, index) in topology.rings().iter().zip(0..) {
            let first = &mut first_rings[topology.mesh_vertex(ring.start) as usize];
            *first = (*first).min(index);
        }
        Self { topology, edges, first_rings }
    }

    /// The half-edge that owns the edge of half-edge `h`: itself or its twin.
    fn edge(&self, h: u32) -> u32 {
        self.edges.of_half_edge(h).owner
    }

    /// Ring and number in it of the edge of half-edge `h`, at its start, as its owner sees it.
    fn at_start(&self, h: u32) -> [u32; 2] {
        let owner = self.edge(h);
        if owner == h { self.plus(h) } else { self.minus(self.topology.next(owner)) }
    }

    /// The same at its end.
    fn at_end(&self, h: u32) -> [u32; 2] {
        let owner = self.edge(h);
        if owner == h { self.minus(self.topology.next(h)) } else { self.plus(owner) }
    }

    fn plus(&self, h: u32) -> [u32; 2] {
        let place = self.topology.place(h);
        [place.ring, place.index]
    }

    fn minus(&self, h: u32) -> [u32; 2] {
        let place = self.topology.place(h);
        [place.ring, (place.index + 1) % self.topology.rings()[place.ring as usize].edges()]
    }

    fn corner(&self, h: u32) -> [u32; SHARED_WORDS] {
        let ring = self.first_rings[self.topology.mesh_vertex(h) as usize];
        let [plus_ring, plus_edge] = self.at_start(h);
        let [minus_ring, minus_edge] = self.at_end(self.topology.prev(h));
        let sharp = if self.edges.of_half_edge(h).is_sharp { SHARP_EDGE_BIT } else { 0 };
        [ring, plus_ring, plus_edge | sharp, minus_ring, minus_edge]
    }

    fn texcoord(&self, h: u32, at: impl Fn(u32) -> [f32; 2]) -> SharedTexcoord {
        let topology = self.topology;
        // At the start of half-edge `h` seen from the side that owns the edge, and at its end.
        let start = |h: u32| if self.edge(h) == h { h } else { topology.next(self.edge(h)) };
        let end = |h: u32| if self.edge(h) == h { topology.next(h) } else { self.edge(h) };
        let ring = &topology.rings()[self.first_rings[topology.mesh_vertex(h) as usize] as usize];
        let length = |h: u32| {
            let ([x0, y0], [x1, y1]) = (at(h), at(topology.next(h)));
            (x1 - x0).hypot(y1 - y0)
        };
        let mean = topology.ring_half_edges(ring).map(length).sum::<f32>() / ring.faces as f32;
        SharedTexcoord {
            plus: at(start(h)),
            minus: at(end(topology.prev(h))),
            corner: at(ring.start),
            scale: [mean, 0.0],
        }
    }
}
