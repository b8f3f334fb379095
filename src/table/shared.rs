//! Ownership of what patches share: the ring that owns each edge and each vertex.

use super::PatchPlan;
use crate::mesh::NO_TWIN;
use crate::topology::Topology;
use rayon::prelude::*;

/// Bit of [`SharedCorner::plus_edge`]: the faces at the plus edge are lit with normals of their own.
pub const SHARP_EDGE_BIT: u32 = 1 << 30;

/// Owners of what a patch corner shares with other patches. GLSL twin: `glsl/lib/edges/shared.glsl`.
///
/// Along a smooth edge and around a smooth vertex there is only one ring to ask. Along a crease the side speaks on whose left
/// the edge leads from the lower vertex to the higher; for a vertex with several rings the first of them in
/// [`Topology::rings`].
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct SharedCorner {
    /// Ring that owns the vertex.
    pub ring: u32,
    /// Ring at this vertex that owns the plus edge.
    pub plus_ring: u32,
    /// The number of the plus edge in that ring, and a bit.
    pub plus_edge: u32,
    /// Ring at this vertex that owns the minus edge.
    pub minus_ring: u32,
    /// The number of the minus edge in that ring.
    pub minus_edge: u32,
}

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

/// A [`SharedCorner`] for each patch corner, in the order of the plan.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SharedTable {
    /// In the order of the patches' corners.
    pub corners: Vec<SharedCorner>,
    /// Likewise, for displacement; else empty.
    pub texcoords: Vec<SharedTexcoord>,
}

impl SharedTable {
    /// For the corners of the patches in `plan`.
    pub fn new(topology: &Topology, plan: &PatchPlan) -> Self {
        let speakers = Speakers::new(topology);
        let corners = plan.corners(topology).into_par_iter().map(|h| speakers.corner(h));
        Self { corners: corners.collect(), texcoords: Vec::new() }
    }

    /// The same, with texture coordinates for displacement. `None` if the mesh has none.
    pub fn with_texcoords(topology: &Topology, plan: &PatchPlan) -> Option<Self> {
        let attribute = topology.mesh().data().texcoords.as_ref()?;
        let at = |h: u32| attribute.values[attribute.indices[h as usize] as usize];
        let speakers = Speakers::new(topology);
        let corners = plan.corners(topology);
        Some(Self {
            corners: corners.par_iter().map(|&h| speakers.corner(h)).collect(),
            texcoords: corners.par_iter().map(|&h| speakers.texcoord(h, at)).collect(),
        })
    }
}

/// Owners of edges and vertices.
pub(crate) struct Speakers<'t> {
    topology: &'t Topology,
    /// The first ring of each vertex of the mesh.
    first_rings: Vec<u32>,
}

const NO_RING: u32 = u32::MAX;

impl<'t> Speakers<'t> {
    pub(crate) fn new(topology: &'t Topology) -> Self {
        let mut first_rings = vec![NO_RING; topology.mesh().vertex_count()];
        for (ring, index) in topology.rings().iter().zip(0..) {
            let first = &mut first_rings[topology.mesh_vertex(ring.start) as usize];
            *first = (*first).min(index);
        }
        Self { topology, first_rings }
    }

    /// Half-edge that owns the edge of half-edge `h`: itself or its twin.
    pub(crate) fn edge(&self, h: u32) -> u32 {
        let twin = self.topology.mesh().twins()[h as usize];
        if twin != NO_TWIN && self.is_reversed(h) { twin } else { h }
    }

    /// Whether a half-edge leads to a lower vertex.
    pub(crate) fn is_reversed(&self, h: u32) -> bool {
        self.topology.mesh_vertex(h) > self.topology.mesh_vertex(self.topology.next(h))
    }

    /// Ring and number in it of the edge of half-edge `h`, at its start, as its owner sees it.
    fn at_start(&self, h: u32) -> (u32, u32) {
        let speaker = self.edge(h);
        if speaker == h { self.plus(h) } else { self.minus(self.topology.next(speaker)) }
    }

    /// The same at its end.
    fn at_end(&self, h: u32) -> (u32, u32) {
        let speaker = self.edge(h);
        if speaker == h { self.minus(self.topology.next(h)) } else { self.plus(speaker) }
    }

    fn plus(&self, h: u32) -> (u32, u32) {
        let place = self.topology.place(h);
        (place.ring, place.index)
    }

    fn minus(&self, h: u32) -> (u32, u32) {
        let place = self.topology.place(h);
        (place.ring, (place.index + 1) % self.topology.rings()[place.ring as usize].edges())
    }

    fn corner(&self, h: u32) -> SharedCorner {
        let topology = self.topology;
        let (plus_ring, plus_edge) = self.at_start(h);
        let (minus_ring, minus_edge) = self.at_end(topology.prev(h));
        let sharp = !topology.is_within_rings(h);
        SharedCorner {
            ring: self.first_rings[topology.mesh_vertex(h) as usize],
            plus_ring,
            plus_edge: plus_edge | if sharp { SHARP_EDGE_BIT } else { 0 },
            minus_ring,
            minus_edge,
        }
    }

    fn texcoord(&self, h: u32, at: impl Fn(u32) -> [f32; 2]) -> SharedTexcoord {
        let topology = self.topology;
        // At the start of half-edge `h` seen from the side that speaks, and at its end.
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
