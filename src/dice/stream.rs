//! Tessellations that are made piece by piece, so that memory does not grow with depth.

use super::error::DiceError;
use super::faces::FaceWriter;
use super::fill::{Evaluated, slots};
use super::layout::{Facet, Source};
use super::plan::Plan;
use super::real::{Real, Vector};
use super::tessellation::halves;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// Vertices of a piece, or those of one facet if it has more.
const VERTICES: u32 = 1 << 19;

/// Vertices next to each other.
#[derive(Debug, Clone, Copy)]
pub struct Piece<'p, T> {
    /// As of [`Tessellation::positions`](super::Tessellation::positions).
    pub positions: &'p [[T; 3]],
    /// One a vertex.
    pub normals: &'p [[T; 3]],
    /// One a vertex, if the mesh has texture coordinates.
    pub texcoords: Option<&'p [[f32; 2]]>,
}

/// The arrays of a [`Tessellation`](super::Tessellation), to the last bit, but never whole: each time they are asked for, they are
/// made anew in pieces. Only the copies along creases and seams are kept.
pub struct Stream<'p, T> {
    plan: &'p Plan<T>,
    evaluated: Evaluated,
    /// Vertices whose normals are means, with these.
    blunt: Vec<(u32, Vector<T>)>,
    copies: Part<T>,
}

/// Arrays of some vertices.
struct Part<T> {
    positions: Vec<Vector<T>>,
    normals: Vec<Vector<T>>,
    texcoords: Option<Vec<[f32; 2]>>,
}

impl<T: Real> Part<T> {
    fn new(count: usize, has_texcoords: bool) -> Self {
        let zero = [T::zero(); 3];
        let texcoords = has_texcoords.then(|| vec![[0.0; 2]; count]);
        Self { positions: vec![zero; count], normals: vec![zero; count], texcoords }
    }

    fn piece(&self) -> Piece<'_, T> {
        Piece { positions: &self.positions, normals: &self.normals, texcoords: self.texcoords.as_deref() }
    }
}

impl<T: Real> Plan<T> {
    /// The tessellation of control vertices at these positions, in pieces.
    ///
    /// # Errors
    /// [`DiceError::Count`] if there are not as many positions as control vertices.
    pub fn stream(&self, control: &[[f64; 3]]) -> Result<Stream<'_, T>, DiceError> {
        let (count, given) = (self.control_vertices, control.len());
        if count != given {
            return Err(DiceError::Count { what: "control positions", given, count });
        }
        let control: Vec<DVec3> = control.iter().map(|&p| p.into()).collect();
        let evaluated = self.evaluated(&control);
        let sources = &self.layout.sources;
        let mut blunt: Vec<_> = self.blunt_normals(&evaluated).collect();
        blunt.sort_unstable_by_key(|(vertex, _)| *vertex);
        let mut stream =
            Stream { plan: self, evaluated, blunt, copies: Part::new(sources.len(), self.has_texcoords()) };
        if !sources.is_empty() {
            stream.copy();
        }
        Ok(stream)
    }
}

impl<'p, T: Real> Stream<'p, T> {
    /// What stays when control vertices move.
    pub fn plan(&self) -> &'p Plan<T> {
        self.plan
    }

    /// Calls `visit` with all vertices in order.
    ///
    /// # Errors
    /// Those of `visit`.
    pub fn for_each_piece<E>(&self, mut visit: impl FnMut(Piece<'_, T>) -> Result<(), E>) -> Result<(), E> {
        for facets in self.pieces() {
            let [owned, _] = self.written(facets);
            visit(owned.piece())?;
        }
        visit(self.copies.piece())
    }

    /// Calls `visit` with all quads in order.
    ///
    /// # Errors
    /// Those of `visit`.
    pub fn for_each_quads<E>(&self, mut visit: impl FnMut(&[[u32; 4]]) -> Result<(), E>) -> Result<(), E> {
        self.pieces().try_for_each(|facets| visit(&faces(facets).0))
    }

    /// Calls `visit` with all triangles in order, without those that quads are cut into.
    ///
    /// # Errors
    /// Those of `visit`.
    pub fn for_each_triangles<E>(&self, mut visit: impl FnMut(&[[u32; 3]]) -> Result<(), E>) -> Result<(), E> {
        self.pieces().try_for_each(|facets| visit(&faces(facets).1))
    }

    /// Calls `visit` with all faces as triangles in order, as of
    /// [`Tessellation::all_triangles`](super::Tessellation::all_triangles).
    ///
    /// # Errors
    /// Those of `visit`.
    pub fn for_each_cut<E>(&self, mut visit: impl FnMut(&[[u32; 3]]) -> Result<(), E>) -> Result<(), E> {
        for facets in self.pieces() {
            let quads = faces(facets).0;
            let around = Around::new(self, facets, &quads);
            let cut = |&quad: &[u32; 4]| halves(quad, quad.map(|vertex| around.position(self.plan, vertex)));
            visit(&quads.par_iter().with_min_len(1024).flat_map_iter(cut).collect::<Vec<_>>())?;
        }
        self.for_each_triangles(visit)
    }

    fn pieces(&self) -> impl Iterator<Item = &[Facet]> {
        let owned = self.plan.layout.owned;
        let mut rest = self.plan.facets();
        std::iter::from_fn(move || {
            let first = rest.first()?.first;
            let count = rest.partition_point(|facet| facet.first - first < VERTICES).max(1);
            // The last one that begins in time may end much later.
            let end = |count: usize| rest.get(count).map_or(owned, |facet| facet.first);
            let count = if count > 1 && end(count) - first > 2 * VERTICES { count - 1 } else { count };
            let (piece, others) = rest.split_at(count);
            rest = others;
            Some(piece)
        })
    }

    /// The positions of the vertices that some facets own.
    fn positions(&self, facets: &[Facet]) -> Vec<Vector<T>> {
        let plan = self.plan;
        let ends = plan.ends_of(facets);
        let count = |i: usize, start: u32| vec![[T::zero(); 3]; (ends[i] - start) as usize];
        let (mut owned, mut copies) = (count(0, facets[0].first), count(1, facets[0].copies));
        let positions = slots(facets, ends, &mut owned, &mut copies);
        plan.evaluate_positions(&plan.surface(&self.evaluated), facets, positions);
        owned
    }

    /// The vertices that some facets own, and the copies that they write, but for what these have in common with others.
    fn written(&self, facets: &[Facet]) -> [Part<T>; 2] {
        let plan = self.plan;
        let ends = plan.ends_of(facets);
        let starts = [facets[0].first, facets[0].copies];
        let [mut owned, mut copies] = [0, 1].map(|i| Part::new((ends[i] - starts[i]) as usize, plan.has_texcoords()));
        let surface = plan.surface(&self.evaluated);
        let positions = slots(facets, ends, &mut owned.positions, &mut copies.positions);
        let normals = slots(facets, ends, &mut owned.normals, &mut copies.normals);
        plan.evaluate_facets(&surface, facets, positions, normals);
        for (part, start) in [(&mut owned, starts[0]), (&mut copies, starts[1])] {
            let from = self.blunt.partition_point(|(vertex, _)| *vertex < start);
            let end = start + part.normals.len() as u32;
            for (vertex, normal) in self.blunt[from..].iter().take_while(|(vertex, _)| *vertex < end) {
                part.normals[(vertex - start) as usize] = *normal;
            }
        }
        if let (Some(owned), Some(copies)) = (&mut owned.texcoords, &mut copies.texcoords) {
            plan.evaluate_texcoords(facets, slots(facets, ends, owned, copies));
        }
        [owned, copies]
    }

    /// Makes the copies.
    fn copy(&mut self) {
        let layout = &self.plan.layout;
        let first = layout.owned;
        let mut of_sources: FxHashMap<u32, [Vector<T>; 2]> = FxHashMap::default();
        for &Source { position, normal } in &layout.sources {
            of_sources.extend([position, normal].into_iter().filter(|&v| v < first).map(|v| (v, Default::default())));
        }
        let mut copies = Part::new(0, self.plan.has_texcoords());
        for facets in self.pieces() {
            let [owned, mut of_piece] = self.written(facets);
            for ((vertex, position), normal) in (facets[0].first..).zip(owned.positions).zip(owned.normals) {
                of_sources.entry(vertex).and_modify(|values| *values = [position, normal]);
            }
            copies.normals.append(&mut of_piece.normals);
            if let (Some(all), Some(mut texcoords)) = (&mut copies.texcoords, of_piece.texcoords) {
                all.append(&mut texcoords);
            }
        }
        for (copy, source) in layout.sources.iter().enumerate() {
            copies.positions.push(of_sources[&source.position][0]);
            copies.normals[copy] = match source.normal.checked_sub(first) {
                Some(other) => copies.normals[other as usize],
                None => of_sources[&source.normal][1],
            };
        }
        self.copies = copies;
    }
}

/// The quads and triangles of some facets.
fn faces(facets: &[Facet]) -> (Vec<[u32; 4]>, Vec<[u32; 3]>) {
    let of_facet = |writer: &mut FaceWriter, facet: &Facet| {
        let [quads, triangles] = facet.face_counts().map(|count| count as usize);
        let (mut quads, mut triangles) = (vec![[0; 4]; quads], vec![[0; 3]; triangles]);
        writer.write(facet, &mut quads, &mut triangles);
        (quads, triangles)
    };
    let parts: Vec<_> = facets.par_iter().with_min_len(64).map_init(FaceWriter::default, of_facet).collect();
    let (quads, triangles): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
    (quads.concat(), triangles.concat())
}

/// Positions of the vertices of some quads.
struct Around<T> {
    first: u32,
    positions: Vec<Vector<T>>,
    /// Of facets around, by their index.
    others: FxHashMap<usize, Vec<Vector<T>>>,
}

impl<T: Real> Around<T> {
    /// `quads` are those of `facets`.
    fn new(stream: &Stream<'_, T>, facets: &[Facet], quads: &[[u32; 4]]) -> Self {
        let (first, positions) = (facets[0].first, stream.positions(facets));
        let end = first + positions.len() as u32;
        let plan = stream.plan;
        let far = quads.as_flattened().iter().map(|&vertex| plan.position_of(vertex));
        let mut owners: Vec<usize> =
            far.filter(|vertex| !(first..end).contains(vertex)).map(|vertex| plan.owner(vertex)).collect();
        owners.sort_unstable();
        owners.dedup();
        let of_owner = |index: usize| (index, stream.positions(&plan.facets()[index..=index]));
        Self { first, positions, others: owners.into_par_iter().map(of_owner).collect() }
    }

    fn position(&self, plan: &Plan<T>, vertex: u32) -> Vector<T> {
        let vertex = plan.position_of(vertex);
        let own = vertex.checked_sub(self.first).and_then(|own| self.positions.get(own as usize));
        own.copied().unwrap_or_else(|| {
            let owner = plan.owner(vertex);
            self.others[&owner][(vertex - plan.facets()[owner].first) as usize]
        })
    }
}
