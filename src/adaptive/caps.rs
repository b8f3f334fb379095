//! The control points of end caps.

use super::feature::{has_finite_sharpness, is_settled};
use crate::blend::{Blend, Frame, PatchCorner, RingValues, Row};
use crate::limit::{dart_edge, dart_frame, refine_part};
use crate::mesh::{ControlMesh, CreaseMethod, MeshError};
use crate::patch::Scheme;
use crate::patch::gregory::gregory_points;
use crate::topology::Topology;
use std::collections::HashMap;

/// Control points of a cap.
pub(super) const POINTS: u32 = 20;

/// Makes the caps of one level.
pub(super) struct Caps<'t> {
    topology: &'t Topology,
    scheme: Scheme,
    /// The limits of vertices that masks cannot tell, by vertex.
    limits: HashMap<u32, Option<Row>>,
}

impl<'t> Caps<'t> {
    pub(super) fn new(topology: &'t Topology, scheme: Scheme) -> Self {
        Self { topology, scheme, limits: HashMap::new() }
    }

    /// The points of a quad with these half-edges as sums of the mesh's vertices. Other than in
    /// [`Scheme::control_points`], faces around it may have any number of corners, and the patch goes through the limits of
    /// its corners at darts and where sharpness is finite, too (but there by Chaikin's method).
    ///
    /// # Errors
    /// Those of refining what is around a corner.
    pub(super) fn rows(&mut self, half_edges: [u32; 4]) -> Result<Vec<Row>, MeshError> {
        let mut rings = half_edges.map(|h| self.ring(h));
        let data = self.topology.mesh().data();
        if !(data.creases.is_empty() && data.corners.is_empty()) {
            for (h, (_, frame, _)) in half_edges.into_iter().zip(&mut rings) {
                if let Some(limit) = self.limit(h)? {
                    frame.p = limit;
                }
            }
        }
        let corners = rings.each_ref().map(|(ring, frame, index)| PatchCorner { ring, frame, index: *index });
        let scheme = self.scheme;
        Ok(gregory_points(&corners, |corner, j| scheme.transversal(corner.ring, corner.frame, j)))
    }

    fn ring(&self, h: u32) -> (RingValues<Row>, Frame<Row>, usize) {
        let place = self.topology.place(h);
        let ring = &self.topology.rings()[place.ring as usize];
        let unit = |h: u32| Row::unit(self.topology.mesh_vertex(h));
        let values = RingValues::collect(self.topology, ring, unit, |h| opposite(self.topology, h));
        let frame = self.scheme.frame(&values);
        (values, frame, place.index as usize)
    }

    /// The limit of the vertex from which a half-edge starts, unless it is that of its ring's frame.
    fn limit(&mut self, h: u32) -> Result<Option<Row>, MeshError> {
        let vertex = self.topology.vertex(h);
        if let Some(limit) = self.limits.get(&vertex) {
            return Ok(limit.clone());
        }
        let is_known = is_settled(self.topology, h);
        let limit = if is_known { None } else { limit_of_fan(self.topology, h)? };
        self.limits.insert(vertex, limit.clone());
        Ok(limit)
    }
}

/// Refines the faces around a vertex until nothing there is of finite sharpness: then masks tell its limit.
fn limit_of_fan(topology: &Topology, h: u32) -> Result<Option<Row>, MeshError> {
    let mut half_edges = topology.fan(h).0;
    let mut rows: Vec<Row> = Vec::new();
    let mut refined: Option<Topology> = None;
    loop {
        let topology = refined.as_ref().unwrap_or(topology);
        let ring = &topology.rings()[topology.place(half_edges[0]).ring as usize];
        if refined.is_some() && !has_finite_sharpness(topology, half_edges[0]) {
            let values = RingValues::new(topology, ring, |v| rows[v as usize].clone());
            let dart = dart_edge(topology, ring);
            return Ok(Some(dart.map_or_else(|| values.frame(), |sharp| dart_frame(&values, sharp)).p));
        }
        if topology.mesh().data().crease_method == CreaseMethod::Chaikin {
            // What is sharp beyond the faces around the vertex counts, too.
            return Ok(None);
        }
        let (data, steps) = refine_part(topology, &half_edges);
        rows = match refined {
            None => steps,
            Some(_) => steps.iter().map(|step| step.compose(&rows)).collect(),
        };
        // Each child begins at the vertex.
        half_edges = (0..data.face_sizes.len() as u32).map(|face| 4 * face).collect();
        refined = Some(Topology::new(&ControlMesh::new(data)?));
    }
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
