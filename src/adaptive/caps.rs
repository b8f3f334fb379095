//! The control points of end caps.

use super::feature::{has_finite_sharpness, is_settled};
use crate::blend::{Blend, Frame, PatchCorner, RingShape, RingValues, Row};
use crate::limit::{Stencils, dart_edge, dart_frame, refine_part};
use crate::mesh::{ControlMesh, Corner, Crease, CreaseMethod, MeshData, MeshError};
use crate::patch::Scheme;
use crate::patch::gregory::gregory_points;
use crate::topology::{Place, Topology};
use rustc_hash::FxBuildHasher;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Control points of a cap.
pub(super) const POINTS: u32 = 20;

/// The bit of a vertex in a row, while a plan is being made, that is one of a shared frame.
pub(super) const FRAME: u32 = 1 << 30;

/// Rings of more faces have their frames in rows of their own.
const MANY: u32 = 16;

/// Makes the caps of a plan.
pub(super) struct Caps {
    scheme: Scheme,
    /// The points of caps with rings of the same shapes, as sums of the vertices in them.
    patterns: HashMap<Pattern, Stencils, FxBuildHasher>,
    limits: HashMap<Alone, Row, FxBuildHasher>,
}

/// What the rows of a cap depend on, but for the vertices' numbers.
#[derive(PartialEq, Eq, Hash)]
struct Pattern {
    /// The ring around each corner, and the edge in it.
    rings: [(RingShape, usize); 4],
    /// Each vertex of the rings: its number among those that differ.
    vertices: Vec<u32>,
}

/// What is around a level's caps.
pub(super) struct Around<'t> {
    pub topology: &'t Topology,
    /// The number of the topology's vertex 0.
    pub first_vertex: u32,
    /// The vertices at the points of faces of many corners, by face.
    pub centres: &'t HashMap<u32, u32>,
}

/// What was found around the caps of a level.
#[derive(Default)]
pub(super) struct Known {
    /// Whether masks tell the limit, by vertex.
    settled: HashMap<u32, bool>,
    /// Rings that are no part of a pattern, with their frames.
    rings: HashMap<u32, (RingValues<Row>, Frame<Row>)>,
}

impl Caps {
    pub(super) fn new(scheme: Scheme) -> Self {
        Self { scheme, patterns: HashMap::default(), limits: HashMap::default() }
    }

    /// Appends the points of a quad with these half-edges. Other than in [`Scheme::control_points`], faces around it may have
    /// any number of corners, and the patch goes through the limits of its corners at darts and where sharpness is finite, too
    /// (but there not by Chaikin's method). `frames` takes in the points of frames that many caps share.
    ///
    /// # Errors
    /// Those of refining what is around a corner.
    pub(super) fn push(
        &mut self,
        around: &Around,
        half_edges: [u32; 4],
        known: &mut Known,
        frames: &mut Vec<Row>,
        rows: &mut Stencils,
    ) -> Result<(), MeshError> {
        let topology = around.topology;
        let is_plain = |h: u32, known: &mut Known| {
            let ring = &topology.rings()[topology.place(h).ring as usize];
            ring.faces <= MANY
                && (ring.quads || topology.ring_half_edges(ring).all(|h| topology.face_size(h) <= 4))
                && known.is_settled(topology, h)
        };
        let places = half_edges.map(|h| topology.place(h));
        if half_edges.into_iter().all(|h| is_plain(h, known)) {
            let vertex = |h: u32| around.first_vertex + topology.mesh_vertex(h);
            let ring = |place: Place| {
                let ring = &topology.rings()[place.ring as usize];
                (RingValues::collect(topology, ring, vertex, vertex), place.index as usize)
            };
            self.push_pattern(places.map(ring), rows);
            return Ok(());
        }
        for h in half_edges {
            self.find_ring(around, h, known, frames)?;
        }
        let corner = |place: Place| {
            let (ring, frame) = &known.rings[&place.ring];
            PatchCorner { ring, frame, index: place.index as usize }
        };
        self.points(&places.map(corner)).iter().for_each(|row| rows.push(row.weights().iter().copied()));
        Ok(())
    }

    /// The limit of the vertex from which a half-edge starts, which masks do not tell.
    fn limit(&mut self, around: &Around, h: u32) -> Result<Option<Row>, MeshError> {
        if around.topology.mesh().data().crease_method == CreaseMethod::Chaikin {
            // What is sharp beyond the faces around the vertex counts, too.
            return Ok(None);
        }
        let (alone, vertices) = Alone::new(around, h);
        let limit = match self.limits.entry(alone) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(unknown) => {
                let limit = unknown.key().limit(around.topology)?;
                unknown.insert(limit)
            }
        };
        Ok(Some(Row::new(limit.weights().iter().map(|&(number, w)| (vertices[number as usize], w)).collect())))
    }

    /// Makes the ring around the vertex from which a half-edge starts.
    fn find_ring(
        &mut self,
        around: &Around,
        h: u32,
        known: &mut Known,
        frames: &mut Vec<Row>,
    ) -> Result<(), MeshError> {
        let topology = around.topology;
        let number = topology.place(h).ring;
        if known.rings.contains_key(&number) {
            return Ok(());
        }
        let ring = &topology.rings()[number as usize];
        let values = RingValues::collect(topology, ring, |h| around.unit(h), |h| around.opposite(h));
        let mut frame = self.scheme.frame(&values);
        if !known.is_settled(topology, h)
            && let Some(limit) = self.limit(around, h)?
        {
            frame.p = limit;
        }
        if ring.faces > MANY {
            // Each row would be as long as the ring: the caps around it share three.
            let first = frames.len() as u32;
            let [along, across] = [&frame.a, &frame.b].map(|tangent| Row::sum([(1.0, &frame.p), (1.0, tangent)]));
            frames.extend([frame.p, along, across]);
            let [p, along, across] = [0, 1, 2].map(|i| Row::unit((first + i) | FRAME));
            let seen = |row: &Row| Row::sum([(1.0, row), (-1.0, &p)]);
            frame = Frame { a: seen(&along), b: seen(&across), p };
        }
        known.rings.insert(number, (values, frame));
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
            false => Some(self.pattern_points(&pattern)),
        };
        let points = self.patterns.entry(pattern).or_insert_with(|| Stencils::new(made.unwrap_or_default()));
        for row in 0..points.len() {
            rows.push(points.row(row).map(|(number, weight)| (distinct[number as usize], weight)));
        }
    }

    fn points(&self, corners: &[PatchCorner<Row>; 4]) -> Vec<Row> {
        gregory_points(corners, |corner, j| self.scheme.transversal(corner.ring, corner.frame, j))
    }

    fn pattern_points(&self, pattern: &Pattern) -> Vec<Row> {
        let rings = pattern.values();
        let frames = rings.each_ref().map(|(ring, _)| self.scheme.frame(ring));
        self.points(&[0, 1, 2, 3].map(|k| PatchCorner { ring: &rings[k].0, frame: &frames[k], index: rings[k].1 }))
    }
}

impl Known {
    fn is_settled(&mut self, topology: &Topology, h: u32) -> bool {
        let data = topology.mesh().data();
        let is_untagged = data.creases.is_empty() && data.corners.is_empty();
        is_untagged || *self.settled.entry(topology.vertex(h)).or_insert_with(|| is_settled(topology, h))
    }
}

impl Around<'_> {
    fn unit(&self, h: u32) -> Row {
        Row::unit(self.first_vertex + self.topology.mesh_vertex(h))
    }

    /// What stands for the diagonal of a ring's face, `h` being its half-edge two steps from the ring's vertex. Masks see faces
    /// through their centroids only, so a face of five and more corners may be the quad `4 c - v - a - b` that has the same
    /// one.
    fn opposite(&self, h: u32) -> Row {
        let topology = self.topology;
        if topology.face_size(h) <= 4 {
            return self.unit(h);
        }
        let face = topology.face(h);
        let corners = topology.mesh().face_corners(face).map(|h| self.unit(h as u32));
        let share = 4.0 / f64::from(topology.face_size(h));
        let mut row = match self.centres.get(&face) {
            Some(&centre) => Row::sum([(4.0, &Row::unit(centre))]),
            None => Row::sum(corners.collect::<Vec<_>>().iter().map(|corner| (share, corner))),
        };
        let head = topology.prev(h);
        let vertex = topology.prev(head);
        for h in [vertex, head, topology.prev(vertex)] {
            row.add_scaled(-1.0, &self.unit(h));
        }
        row
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

/// The faces around a vertex as a mesh of their own, in which each begins there: all that the vertex's limit depends on, by
/// the uniform method.
#[derive(PartialEq, Eq, Hash)]
struct Alone {
    face_sizes: Vec<u32>,
    face_vertices: Vec<u32>,
    /// The bits of the sharpness of the vertex, and of each edge from it that has faces on both sides, with its other end.
    vertex_sharpness: u32,
    edges: Vec<(u32, u32)>,
}

impl Alone {
    /// What is around the vertex from which a half-edge starts, and its vertices' numbers.
    fn new(around: &Around, h: u32) -> (Self, Vec<u32>) {
        let topology = around.topology;
        let fan = topology.fan(h).0;
        let (mut numbers, mut vertices) = (HashMap::new(), Vec::new());
        let face_sizes: Vec<u32> = fan.iter().map(|&spoke| topology.face_size(spoke)).collect();
        let mut face_vertices = Vec::new();
        for (&spoke, &size) in fan.iter().zip(&face_sizes) {
            for h in std::iter::successors(Some(spoke), |&h| Some(topology.next(h))).take(size as usize) {
                let vertex = topology.mesh_vertex(h);
                face_vertices.push(*numbers.entry(vertex).or_insert_with(|| {
                    vertices.push(around.first_vertex + vertex);
                    vertices.len() as u32 - 1
                }));
            }
        }
        let inner = fan.iter().filter(|&&spoke| topology.twin(spoke).is_some());
        let edge = |&h: &u32| (numbers[&topology.mesh_vertex(topology.next(h))], topology.sharpness(h).to_bits());
        let vertex_sharpness = topology.vertex_sharpness(topology.mesh_vertex(h)).to_bits();
        (Self { face_sizes, face_vertices, vertex_sharpness, edges: inner.map(edge).collect() }, vertices)
    }

    /// The limit as a sum of the vertices here: refined until nothing at the vertex is of finite sharpness, masks tell it.
    fn limit(&self, topology: &Topology) -> Result<Row, MeshError> {
        let crease = |&(end, bits): &(u32, u32)| Crease { vertices: [0, end], sharpness: f32::from_bits(bits) };
        let count = self.face_vertices.iter().max().map_or(0, |&last| last + 1);
        let mut data = MeshData {
            positions: vec![[0.0; 3]; count as usize],
            face_sizes: self.face_sizes.clone(),
            face_vertices: self.face_vertices.clone(),
            creases: self.edges.iter().map(crease).collect(),
            corners: vec![Corner { vertex: 0, sharpness: f32::from_bits(self.vertex_sharpness) }],
            boundary: topology.mesh().data().boundary,
            triangle_rule: topology.mesh().data().triangle_rule,
            ..MeshData::default()
        };
        let mut rows: Vec<Row> = (0..count).map(Row::unit).collect();
        let mut steps = 0;
        loop {
            let starts = data.face_sizes.iter().scan(0, |start, size| Some(std::mem::replace(start, *start + size)));
            let starts: Vec<u32> = starts.collect();
            let topology = Topology::new(&ControlMesh::new(data)?);
            if steps > 0 && !has_finite_sharpness(&topology, 0) {
                let ring = &topology.rings()[topology.place(0).ring as usize];
                let values = RingValues::new(&topology, ring, |v| rows[v as usize].clone());
                let dart = dart_edge(&topology, ring);
                return Ok(dart.map_or_else(|| values.frame(), |sharp| dart_frame(&values, sharp)).p);
            }
            let part = refine_part(&topology, &starts);
            let coarse = std::mem::take(&mut rows);
            for row in 0..part.rows.len() {
                // Centres, numbered after the coarse vertices, come first.
                let value =
                    |vertex: u32| coarse.get(vertex as usize).unwrap_or_else(|| &rows[vertex as usize - coarse.len()]);
                rows.push(Row::sum(part.rows.row(row).map(|(vertex, weight)| (weight, value(vertex)))));
            }
            data = part.data;
            steps += 1;
        }
    }
}
