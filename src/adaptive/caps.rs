//! The control points of end caps.

use super::alone::Alone;
use super::feature::Class;
use super::few::{FEW, Few};
use super::look::Seen;
use super::numbering::Numbering;
use super::rows::{BlocksMut, Rows};
use crate::blend::{Blend, Frame, PatchCorner, RingValues, Row};
use crate::limit::Stencils;
use crate::mesh::{CreaseMethod, MeshError};
use crate::patch::Scheme;
use crate::patch::gregory::gregory_points;
use crate::topology::{Place, Topology};
use rayon::prelude::*;
use rustc_hash::FxBuildHasher;
use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

/// Control points of a cap.
pub(crate) const POINTS: u32 = 20;

/// The bit of a vertex in a row, while a plan is being made, that is one of a shared frame.
pub(super) const FRAME: u32 = 1 << 30;

/// Rings of more faces have their frames in rows of their own.
pub(super) const MANY: u32 = 16;

/// Caps for one thread at least.
const MIN_LEN: usize = 64;

/// In the place of a pattern.
const NONE: u32 = u32::MAX;

/// The caps of a plan.
pub(super) struct Caps {
    scheme: Scheme,
    patterns: Vec<Pattern>,
    /// The patterns of caps with rings of the same shapes, by what is in [`Seen::keys`].
    numbers: HashMap<Vec<u32>, u32, FxBuildHasher>,
    caps: Vec<Cap>,
    /// The vertices of the caps.
    vertices: Vec<u32>,
    /// The patterns of the others, by what they are.
    alike: HashMap<Alike, u32, FxBuildHasher>,
    limits: HashMap<Alone, Row, FxBuildHasher>,
}

/// Rows whose weights are the same but for rounding, mostly.
#[derive(PartialEq, Eq, Hash)]
struct Alike {
    offsets: Vec<u32>,
    terms: Vec<(u32, u32)>,
}

impl Alike {
    fn new(rows: &Stencils) -> Self {
        let terms = rows.indices.iter().zip(&rows.weights);
        let terms = terms.map(|(&index, &weight)| (index, (weight as f32).to_bits())).collect();
        Self { offsets: rows.offsets.clone(), terms }
    }
}

/// The points of caps as sums of the vertices around each.
struct Pattern {
    /// Over the numbers of those that are read.
    rows: Stencils,
    /// Of the vertices around, those that are read.
    read: Vec<u32>,
}

/// A cap in the making.
struct Cap {
    pattern: u32,
    /// Where its vertices start.
    first: u32,
    /// Number of vertices.
    count: u32,
}

/// What is around a level's caps.
pub(super) struct Around<'t> {
    pub topology: &'t Topology,
    /// The number of the topology's vertex 0.
    pub first_vertex: u32,
    /// What the vertices of the caps ask.
    pub classes: &'t [Class],
    /// The vertices at the points of faces of many corners, by face.
    pub centres: &'t BTreeMap<u32, u32>,
}

/// Rings of a level that are no part of a pattern, with their frames.
type Known = HashMap<u32, (RingValues<Row>, Frame<Row>), FxBuildHasher>;

impl Caps {
    pub(super) fn new(scheme: Scheme) -> Self {
        Self {
            scheme,
            patterns: Vec::new(),
            numbers: HashMap::default(),
            caps: Vec::new(),
            vertices: Vec::new(),
            alike: HashMap::default(),
            limits: HashMap::default(),
        }
    }

    /// Number of caps.
    pub(super) fn len(&self) -> usize {
        self.caps.len()
    }

    /// Adds the caps of quads with these half-edges. Other than in [`Scheme::control_points`], faces around one may have any
    /// number of corners, and the patch goes through the limits of its corners at darts and where sharpness is finite, too
    /// (but there not by Chaikin's method). `frames` takes in the points of frames that many caps share.
    ///
    /// # Errors
    /// Those of refining what is around a corner.
    pub(super) fn add(&mut self, around: &Around, quads: &[[u32; 4]], frames: &mut Vec<Row>) -> Result<(), MeshError> {
        let seen: Vec<Seen> = quads.par_chunks(MIN_LEN).map(|quads| Seen::new(around, quads)).collect();
        let mut known = Known::default();
        for (seen, quads) in seen.iter().zip(quads.chunks(MIN_LEN)) {
            let mut numbers = vec![NONE; seen.keys.len()];
            let mut start = 0;
            for (look, &quad) in seen.caps.iter().zip(quads) {
                let Some(key) = look.key else {
                    self.add_alone(around, quad, &mut known, frames)?;
                    continue;
                };
                let vertices = &seen.vertices[start..start + look.vertices];
                start += look.vertices;
                if numbers[key] == NONE {
                    numbers[key] = self.pattern(around, &seen.keys[key], quad, vertices);
                }
                self.push(numbers[key], vertices);
            }
        }
        Ok(())
    }

    /// Calls `mark` for all vertices that are read.
    pub(super) fn for_each_read(&self, mark: impl Fn(u32) + Sync) {
        self.caps.par_iter().with_min_len(MIN_LEN).for_each(|cap| self.read(cap).for_each(&mark));
    }

    /// Number of vertices that some caps read.
    pub(super) fn read_count(&self, caps: Range<usize>) -> usize {
        self.caps[caps].iter().map(|cap| self.patterns[cap.pattern as usize].read.len()).sum()
    }

    /// Adds the masks of all patterns, in order.
    pub(super) fn add_masks(&self, rows: &mut Rows) {
        for pattern in &self.patterns {
            rows.add_mask(pattern.read.len(), (0..pattern.rows.len()).map(|output| pattern.rows.row(output)));
        }
    }

    /// Writes some caps, where the masks of all patterns start with number `mask`, and with `number(v)` in the place of vertex v.
    pub(super) fn write(&self, caps: Range<usize>, mask: u32, number: impl Fn(u32) -> u32, blocks: &mut BlocksMut) {
        for cap in &self.caps[caps] {
            blocks.push(mask + cap.pattern, self.read(cap).map(&number));
        }
    }

    /// The vertices that a cap reads.
    fn read<'c>(&'c self, cap: &Cap) -> impl Iterator<Item = u32> + 'c {
        let vertices = &self.vertices[cap.first as usize..(cap.first + cap.count) as usize];
        self.patterns[cap.pattern as usize].read.iter().map(|&number| vertices[number as usize])
    }

    fn push(&mut self, pattern: u32, vertices: &[u32]) {
        self.caps.push(Cap { pattern, first: self.vertices.len() as u32, count: vertices.len() as u32 });
        self.vertices.extend_from_slice(vertices);
    }

    /// The pattern with a key, of which a quad and its vertices are an example.
    fn pattern(&mut self, around: &Around, key: &[u32], quad: [u32; 4], vertices: &[u32]) -> u32 {
        if let Some(&pattern) = self.numbers.get(key) {
            return pattern;
        }
        let number = |h: u32| {
            let vertex = around.vertex(h);
            vertices.iter().position(|&v| v == vertex).expect("a vertex that was seen") as u32
        };
        let rows = match vertices.len() <= FEW {
            true => few_rows(&self.points_of(around.topology, quad, |h| Few::unit(number(h)))),
            false => Stencils::new(self.points_of(around.topology, quad, |h| Row::unit(number(h)))),
        };
        let pattern = push_pattern(&mut self.patterns, rows, vertices.len());
        self.numbers.insert(key.to_vec(), pattern);
        pattern
    }

    /// Adds a cap that has its pattern for itself.
    fn add_alone(
        &mut self,
        around: &Around,
        quad: [u32; 4],
        known: &mut Known,
        frames: &mut Vec<Row>,
    ) -> Result<(), MeshError> {
        for h in quad {
            self.find_ring(around, h, known, frames)?;
        }
        let places = quad.map(|h| around.topology.place(h));
        let rings = places.map(|place| &known[&place.ring]);
        let of_rings = rings.map(|(ring, frame)| (ring, frame));
        // Of a long ring only what the rows read is looked at: each cap around it would look at all of it.
        let is_long = rings.iter().any(|(ring, _)| ring.edges.len() > MANY as usize);
        let long = is_long.then(|| Stencils::new(self.points_between(of_rings, places)));
        // Numbered as they come around the corners, so that caps that look alike have one pattern.
        let numbering = match &long {
            Some(rows) => Numbering::new(rows.indices.iter().copied()),
            None => {
                let corners = rings.iter().zip(places);
                Numbering::new(corners.flat_map(|((ring, frame), place)| terms(ring, frame, place.index as usize)))
            }
        };
        let rows = match long {
            None if numbering.vertices.len() <= FEW => {
                let few = |row: &Row| Few::new(row.weights().iter().map(|&(v, weight)| (numbering.number(v), weight)));
                let rings = rings.map(|(ring, frame)| (ring.map(few), frame.map(few)));
                few_rows(&self.points_between(rings.each_ref().map(|(ring, frame)| (ring, frame)), places))
            }
            rows => {
                let mut rows = rows.unwrap_or_else(|| Stencils::new(self.points_between(of_rings, places)));
                rows.indices.iter_mut().for_each(|vertex| *vertex = numbering.number(*vertex));
                rows
            }
        };
        let vertices = &numbering.vertices;
        let pattern = match self.alike.entry(Alike::new(&rows)) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(unknown) => *unknown.insert(push_pattern(&mut self.patterns, rows, vertices.len())),
        };
        self.push(pattern, vertices);
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
        if known.contains_key(&number) {
            return Ok(());
        }
        let ring = &topology.rings()[number as usize];
        let values = RingValues::collect(topology, ring, |h| around.unit(h), |h| around.opposite(h));
        let mut frame = self.scheme.frame(&values);
        if !around.is_settled(h)
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
        known.insert(number, (values, frame));
        Ok(())
    }

    /// The points of a quad whose rings are as the topology has them, `value(h)` being that where a half-edge starts.
    fn points_of<T: Blend>(&self, topology: &Topology, quad: [u32; 4], value: impl Fn(u32) -> T) -> Vec<T> {
        let places = quad.map(|h| topology.place(h));
        let rings =
            places.map(|place| RingValues::collect(topology, &topology.rings()[place.ring as usize], &value, &value));
        let frames = rings.each_ref().map(|ring| self.scheme.frame(ring));
        self.points_between([0, 1, 2, 3].map(|k| (&rings[k], &frames[k])), places)
    }

    /// The points of a quad with these rings and frames.
    fn points_between<T: Blend>(&self, rings: [(&RingValues<T>, &Frame<T>); 4], places: [Place; 4]) -> Vec<T> {
        let corner = |k: usize| PatchCorner { ring: rings[k].0, frame: rings[k].1, index: places[k].index as usize };
        let corners = [0, 1, 2, 3].map(corner);
        gregory_points(&corners, |corner, j| self.scheme.transversal(corner.ring, corner.frame, j))
    }
}

/// The vertices in a ring, from an edge on, and in its frame, some of them several times.
fn terms<'r>(ring: &'r RingValues<Row>, frame: &'r Frame<Row>, edge: usize) -> impl Iterator<Item = u32> + 'r {
    fn from<T>(values: &[T], start: usize) -> impl Iterator<Item = &T> {
        let (before, after) = values.split_at(start.min(values.len()));
        after.iter().chain(before)
    }
    let around = from(&ring.edges, edge).chain(from(&ring.diagonals, edge));
    let of_frame = [&frame.p, &frame.a, &frame.b].into_iter();
    let rows = std::iter::once(&ring.centre).chain(around).chain(of_frame);
    rows.flat_map(|row| row.weights()).map(|&(vertex, _)| vertex)
}

/// Adds the pattern of rows over so many vertices.
fn push_pattern(patterns: &mut Vec<Pattern>, mut rows: Stencils, vertices: usize) -> u32 {
    let mut is_read = vec![false; vertices];
    rows.indices.iter().for_each(|&number| is_read[number as usize] = true);
    let read: Vec<u32> = (0..vertices as u32).filter(|&number| is_read[number as usize]).collect();
    let mut numbers = vec![NONE; vertices];
    read.iter().zip(0..).for_each(|(&vertex, number)| numbers[vertex as usize] = number);
    rows.indices.iter_mut().for_each(|index| *index = numbers[*index as usize]);
    patterns.push(Pattern { rows, read });
    patterns.len() as u32 - 1
}

fn few_rows(points: &[Few]) -> Stencils {
    let mut rows = Stencils::default();
    points.iter().for_each(|point| rows.push(point.weights()));
    rows
}

impl Around<'_> {
    /// Whether masks tell the limit of the vertex from which a half-edge starts.
    pub(super) fn is_settled(&self, h: u32) -> bool {
        self.classes[self.topology.vertex(h) as usize].is_settled()
    }

    /// The vertex from which a half-edge starts.
    pub(super) fn vertex(&self, h: u32) -> u32 {
        self.first_vertex + self.topology.mesh_vertex(h)
    }

    fn unit(&self, h: u32) -> Row {
        Row::unit(self.vertex(h))
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
