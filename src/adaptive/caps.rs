//! The control points of end caps.

use crate::blend::{Blend, Frame, PatchCorner, RingValues, Row};
use crate::patch::Scheme;
use crate::patch::gregory::gregory_points;
use crate::topology::Topology;

/// Control points of a cap.
pub(super) const POINTS: u32 = 20;

/// The points of a quad with these half-edges as sums of the mesh's vertices. Other than in
/// [`Scheme::control_points`], faces around it may have any number of corners.
pub(super) fn cap_rows(topology: &Topology, scheme: Scheme, half_edges: [u32; 4]) -> Vec<Row> {
    let ring = |h: u32| -> (RingValues<Row>, Frame<Row>, usize) {
        let place = topology.place(h);
        let unit = |h: u32| Row::unit(topology.mesh_vertex(h));
        let ring = &topology.rings()[place.ring as usize];
        let values = RingValues::collect(topology, ring, unit, |h| opposite(topology, h));
        let frame = scheme.frame(&values);
        (values, frame, place.index as usize)
    };
    let rings = half_edges.map(ring);
    let corners = rings.each_ref().map(|(ring, frame, index)| PatchCorner { ring, frame, index: *index });
    gregory_points(&corners, |corner, j| scheme.transversal(corner.ring, corner.frame, j))
}

/// What stands for the diagonal of a ring's face, `h` being its half-edge two steps from the ring's vertex. Masks see faces
/// through their centroids only, so a face of five and more corners may be the quad `4 c - v - a - b` that has the same one.
fn opposite(topology: &Topology, h: u32) -> Row {
    let unit = |h: u32| Row::unit(topology.mesh_vertex(h));
    if topology.face_size(h) <= 4 {
        return unit(h);
    }
    let vertices = topology.mesh().face(topology.face(h));
    let mut row = Row::default();
    for &vertex in vertices {
        row.add_scaled(4.0 / vertices.len() as f64, &Row::unit(vertex));
    }
    let head = topology.prev(h);
    let vertex = topology.prev(head);
    for h in [vertex, head, topology.prev(vertex)] {
        row.add_scaled(-1.0, &unit(h));
    }
    row
}
