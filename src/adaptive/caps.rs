//! The control points of end caps.

use super::feature::{has_finite_sharpness, is_settled};
use crate::blend::{Blend, PatchCorner, RingShape, RingValues, Row};
use crate::limit::{Stencils, dart_edge, dart_frame, refine_part};
use crate::mesh::{ControlMesh, Corner, Crease, CreaseMethod, MeshData, MeshError};
use crate::patch::Scheme;
use crate::patch::gregory::gregory_points;
use crate::topology::{Ring, Topology};
use rustc_hash::FxBuildHasher;
use std::collections::HashMap;

/// Control points of a cap.
pub(super) const POINTS: u32 = 20;

/// Makes the caps of a plan.
pub(super) struct Caps {
    scheme: Scheme,
    /// The points of caps with rings of the same shapes, as sums of the vertices in them.
    patterns: HashMap<Pattern, Stencils, FxBuildHasher>,
}

/// What the rows of a cap depend on, but for the vertices' numbers.
#[derive(PartialEq, Eq, Hash)]
struct Pattern {
    /// The ring around each corner, and the edge in it.
    rings: [(RingShape, usize); 4],
    /// Each vertex of the rings: its number among those that differ.
    vertices: Vec<u32>,
}

/// The limits of a level's vertices that masks cannot tell, by vertex.
pub(super) type Limits = HashMap<u32, Option<Row>>;

impl Caps {
    pub(super) fn new(scheme: Scheme) -> Self {
        Self { scheme, patterns: HashMap::default() }
    }

    /// Appends the points of a quad with these half-edges as sums of the mesh's vertices. Other than in
    /// [`Scheme::control_points`], faces around it may have any number of corners, and the patch goes through the limits of
    /// its corners at darts and where sharpness is finite, too (but there not by Chaikin's method).
    ///
    /// # Errors
    /// Those of refining what is around a corner.
    pub(super) fn push(
        &mut self,
        topology: &Topology,
        half_edges: [u32; 4],
        limits: &mut Limits,
        rows: &mut Stencils,
    ) -> Result<(), MeshError> {
        let data = topology.mesh().data();
        let mut points = [const { None }; 4];
        if !(data.creases.is_empty() && data.corners.is_empty()) {
            for (h, point) in half_edges.into_iter().zip(&mut points) {
                *point = limit(topology, h, limits)?;
            }
        }
        let rings = half_edges.map(|h| {
            let place = topology.place(h);
            (&topology.rings()[place.ring as usize], place.index as usize)
        });
        let is_small = |&(ring, _): &(&Ring, usize)| {
            ring.quads || topology.ring_half_edges(ring).all(|h| topology.face_size(h) <= 4)
        };
        if points.iter().any(Option::is_some) || !rings.iter().all(is_small) {
            let unit = |h: u32| Row::unit(topology.mesh_vertex(h));
            let ring = |(ring, index)| (RingValues::collect(topology, ring, unit, |h| opposite(topology, h)), index);
            let points = self.points(&rings.map(ring), points);
            points.iter().for_each(|row| rows.push(row.weights().iter().copied()));
            return Ok(());
        }
        let vertex = |h: u32| topology.mesh_vertex(h);
        let rings = rings.map(|(ring, index)| (RingValues::collect(topology, ring, vertex, vertex), index));
        self.push_pattern(rings, rows);
        Ok(())
    }

    /// Appends a cap whose rings have these vertices.
    fn push_pattern(&mut self, rings: [(RingValues<u32>, usize); 4], rows: &mut Stencils) {
        let (mut distinct, mut numbers) = (Vec::with_capacity(32), Vec::with_capacity(48));
        for ring in rings.iter().map(|(ring, _)| ring) {
            for vertex in std::iter::once(&ring.centre).chain(&ring.edges).chain(&ring.diagonals) {
                let number = distinct.iter().position(|v| v == vertex).unwrap_or_else(|| {
                    distinct.push(*vertex);
                    distinct.len() - 1
                });
                numbers.push(number as u32);
            }
        }
        let pattern = Pattern { rings: rings.map(|(ring, index)| (ring.shape, index)), vertices: numbers };
        let made = match self.patterns.contains_key(&pattern) {
            true => None,
            false => Some(self.points(&pattern.values(), [const { None }; 4])),
        };
        let points = self.patterns.entry(pattern).or_insert_with(|| Stencils::new(made.unwrap_or_default()));
        for row in 0..points.len() {
            rows.push(points.row(row).map(|(number, weight)| (distinct[number as usize], weight)));
        }
    }

    /// The points of a cap with these rings; `limits` are the corners that are elsewhere than masks say.
    fn points(&self, rings: &[(RingValues<Row>, usize); 4], limits: [Option<Row>; 4]) -> Vec<Row> {
        let scheme = self.scheme;
        let mut frames = rings.each_ref().map(|(ring, _)| scheme.frame(ring));
        for (frame, limit) in frames.iter_mut().zip(limits) {
            frame.p = limit.unwrap_or(std::mem::take(&mut frame.p));
        }
        let corner = |k: usize| PatchCorner { ring: &rings[k].0, frame: &frames[k], index: rings[k].1 };
        gregory_points(&[0, 1, 2, 3].map(corner), |corner, j| scheme.transversal(corner.ring, corner.frame, j))
    }
}

impl Pattern {
    /// The rings, with the numbers of their vertices as unknowns.
    fn values(&self) -> [(RingValues<Row>, usize); 4] {
        let mut numbers = self.vertices.iter();
        self.rings.each_ref().map(|(shape, index)| {
            let mut take = |count: usize| numbers.by_ref().take(count).map(|&number| Row::unit(number)).collect();
            let centre: Vec<Row> = take(1);
            let (edges, diagonals) = (take(shape.edges()), take(shape.faces()));
            let ring = RingValues {
                shape: shape.clone(),
                centre: centre.into_iter().next().unwrap_or_default(),
                edges,
                diagonals,
            };
            (ring, *index)
        })
    }
}

/// The limit of the vertex from which a half-edge starts, unless masks tell it.
fn limit(topology: &Topology, h: u32, limits: &mut Limits) -> Result<Option<Row>, MeshError> {
    let vertex = topology.vertex(h);
    if let Some(limit) = limits.get(&vertex) {
        return Ok(limit.clone());
    }
    let limit = if is_settled(topology, h) { None } else { limit_of_fan(topology, h)? };
    limits.insert(vertex, limit.clone());
    Ok(limit)
}

/// Refines the faces around a vertex until nothing there is of finite sharpness: then masks tell its limit.
fn limit_of_fan(topology: &Topology, h: u32) -> Result<Option<Row>, MeshError> {
    if topology.mesh().data().crease_method == CreaseMethod::Chaikin {
        // What is sharp beyond the faces around the vertex counts, too.
        return Ok(None);
    }
    let (mut data, mut rows) = fan_alone(topology, h);
    let mut steps = 0;
    loop {
        // Each face begins at the vertex.
        let starts = data.face_sizes.iter().scan(0, |start, size| Some(std::mem::replace(start, *start + size)));
        let starts: Vec<u32> = starts.collect();
        let topology = Topology::new(&ControlMesh::new(data)?);
        if steps > 0 && !has_finite_sharpness(&topology, 0) {
            let ring = &topology.rings()[topology.place(0).ring as usize];
            let values = RingValues::new(&topology, ring, |v| rows[v as usize].clone());
            let dart = dart_edge(&topology, ring);
            return Ok(Some(dart.map_or_else(|| values.frame(), |sharp| dart_frame(&values, sharp)).p));
        }
        let refined;
        (data, refined) = refine_part(&topology, &starts);
        let compose = |row| Row::sum(refined.row(row).map(|(vertex, weight)| (weight, &rows[vertex as usize])));
        rows = (0..refined.len()).map(compose).collect();
        steps += 1;
    }
}

/// The faces around the vertex from which a half-edge starts as a mesh of their own, in which each begins there, and its
/// vertices as those of the mesh.
fn fan_alone(topology: &Topology, h: u32) -> (MeshData, Vec<Row>) {
    let (mesh, fan) = (topology.mesh(), topology.fan(h).0);
    let mut numbers = HashMap::new();
    let mut rows = Vec::new();
    let mut data =
        MeshData { boundary: mesh.data().boundary, triangle_rule: mesh.data().triangle_rule, ..MeshData::default() };
    for &spoke in &fan {
        let size = topology.face_size(spoke);
        data.face_sizes.push(size);
        for h in std::iter::successors(Some(spoke), |&h| Some(topology.next(h))).take(size as usize) {
            let vertex = topology.mesh_vertex(h);
            data.face_vertices.push(*numbers.entry(vertex).or_insert_with(|| {
                rows.push(Row::unit(vertex));
                rows.len() as u32 - 1
            }));
        }
    }
    for &spoke in fan.iter().filter(|&&spoke| topology.twin(spoke).is_some()) {
        let vertices = [0, numbers[&topology.mesh_vertex(topology.next(spoke))]];
        data.creases.push(Crease { vertices, sharpness: topology.sharpness(spoke) });
    }
    let sharpness = topology.vertex_sharpness(topology.mesh_vertex(h));
    data.corners.push(Corner { vertex: 0, sharpness });
    data.positions = vec![[0.0; 3]; rows.len()];
    (data, rows)
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
