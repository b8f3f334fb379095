//! Positions, normals and texture coordinates of a plan.

use super::error::DiceError;
use super::evaluate::{Arena, Faces, Surface};
use super::layout::Facet;
use super::plan::Plan;
use super::real::{Real, Vector, cross, subtract, unit};
use super::sectors::Role;
use super::texcoords::{Texcoords, bilinear};
use glam::DVec3;
use rayon::prelude::*;

/// Facets for a thread at least.
const MIN_LEN: usize = 16;

/// Where what a facet writes goes: what it owns, and its copies.
pub(super) struct Slots<'o, V> {
    owned: &'o mut [V],
    copies: &'o mut [V],
    /// The vertices of the first of each.
    first: u32,
    first_copy: u32,
}

impl<V> Slots<'_, V> {
    fn at(&mut self, vertex: u32) -> &mut V {
        match vertex.checked_sub(self.first_copy) {
            Some(copy) if (copy as usize) < self.copies.len() => &mut self.copies[copy as usize],
            _ => &mut self.owned[(vertex - self.first) as usize],
        }
    }
}

/// Cuts what some facets next to each other own, and their copies, into the parts that each writes. `ends` is where both end.
pub(super) fn slots<'o, V>(
    facets: &[Facet],
    [end_of_owned, end_of_copies]: [u32; 2],
    owned: &'o mut [V],
    copies: &'o mut [V],
) -> Vec<Slots<'o, V>> {
    let (mut first, mut copies) = (owned, copies);
    let end = |of: fn(&Facet) -> u32, i: usize, last: u32| facets.get(i + 1).map_or(last, of);
    let mut slots = Vec::with_capacity(facets.len());
    for (i, facet) in facets.iter().enumerate() {
        let (own, rest) = first.split_at_mut((end(|f| f.first, i, end_of_owned) - facet.first) as usize);
        let (copy, rest_of_copies) = copies.split_at_mut((end(|f| f.copies, i, end_of_copies) - facet.copies) as usize);
        (first, copies) = (rest, rest_of_copies);
        slots.push(Slots { owned: own, copies: copy, first: facet.first, first_copy: facet.copies });
    }
    slots
}

impl Facet {
    /// Calls `write` for each vertex that the facet writes, with its u and v in the facet.
    pub(super) fn for_each_written(&self, mut write: impl FnMut(u32, [f32; 2])) {
        let segments = 1u32 << self.depth;
        for k in (0..4).filter(|&k| self.corners[k].0 != Role::Other) {
            write(self.corners[k].1, along(k, 0.0));
        }
        for k in (0..4).filter(|&k| self.sides[k].0 != Role::Other) {
            let last = 1u32 << self.edges[k];
            for point in 1..last {
                write(self.on_edge(k, point), along(k, point as f32 / last as f32));
            }
        }
        let mut vertex = self.inside;
        let at = |i: u32| i as f32 / segments as f32;
        for j in 1..segments {
            for i in 1..segments {
                write(vertex, [at(i), at(j)]);
                vertex += 1;
            }
        }
    }

    /// Writes the vertices for which `grid` has values, a grid with the facet's own depth. `finer` makes a grid of another depth.
    fn write<V: Copy>(&self, slots: &mut Slots<'_, V>, grid: &[V]) {
        let segments = 1usize << self.depth;
        let side = segments + 1;
        let at = |k: usize, t: usize| grid[on_side(k, t, segments)];
        for k in (0..4).filter(|&k| self.corners[k].0 != Role::Other) {
            *slots.at(self.corners[k].1) = at(k, 0);
        }
        for k in (0..4).filter(|&k| self.sides[k].0 != Role::Other && !self.is_finer(k)) {
            (1..segments).for_each(|t| *slots.at(self.sides[k].1 + t as u32 - 1) = at(k, t));
        }
        let mut inside = (self.inside - slots.first) as usize;
        for j in 1..segments {
            let row = &grid[j * side + 1..j * side + segments];
            slots.owned[inside..inside + row.len()].copy_from_slice(row);
            inside += row.len();
        }
    }

    /// Writes the vertices of an edge out of a grid with its depth.
    fn write_edge<V: Copy>(&self, slots: &mut Slots<'_, V>, k: usize, grid: &[V]) {
        let segments = 1usize << self.edges[k];
        (1..segments).for_each(|t| *slots.at(self.sides[k].1 + t as u32 - 1) = grid[on_side(k, t, segments)]);
    }
}

/// Index in a grid of a point of side k, counted from corner k.
fn on_side(k: usize, t: usize, segments: usize) -> usize {
    let [i, j] = [[t, 0], [segments, t], [segments - t, segments], [0, segments - t]][k];
    j * (segments + 1) + i
}

/// u and v of a point of side k.
fn along(k: usize, t: f32) -> [f32; 2] {
    [[t, 0.0], [1.0, t], [1.0 - t, 1.0], [0.0, 1.0 - t]][k]
}

/// Arrays that belong to the caller, of as many vertices as [`Sizes`](super::Sizes) tells.
#[derive(Debug)]
pub struct VerticesMut<'o, T> {
    /// Object space.
    pub positions: &'o mut [[T; 3]],
    /// Of length one; zero where the surface has none.
    pub normals: &'o mut [[T; 3]],
}

fn check(what: &'static str, given: usize, count: usize) -> Result<(), DiceError> {
    if given == count { Ok(()) } else { Err(DiceError::Count { what, given, count }) }
}

/// The vertices of facets, and of finer levels.
pub(super) struct Evaluated {
    vertices: Vec<Vector<f64>>,
    levels: Vec<Vec<Vector<f64>>>,
}

fn arrays(vectors: Vec<DVec3>) -> Vec<Vector<f64>> {
    vectors.into_iter().map(Into::into).collect()
}

impl<T: Real> Plan<T> {
    /// Fills the caller's arrays for these control vertices.
    ///
    /// # Errors
    /// [`DiceError::Count`] if an array has not as many entries as it should.
    pub fn fill(&self, control: &[[T; 3]], out: VerticesMut<'_, T>) -> Result<(), DiceError> {
        check("control positions", control.len(), self.control_vertices)?;
        let control: Vec<DVec3> = control.iter().map(|p| DVec3::from_array(p.map(T::wide))).collect();
        self.fill_from(&control, out)
    }

    pub(super) fn fill_from(&self, control: &[DVec3], out: VerticesMut<'_, T>) -> Result<(), DiceError> {
        let count = self.layout.vertices();
        check("positions", out.positions.len(), count)?;
        check("normals", out.normals.len(), count)?;
        let evaluated = self.evaluated(control);
        let (facets, owned) = (self.facets(), self.layout.owned as usize);
        let ends = self.ends_of(facets);
        let slots = |array| {
            let (owned, copies) = <[_]>::split_at_mut(array, owned);
            slots(facets, ends, owned, copies)
        };
        let (positions, normals) = (slots(&mut *out.positions), slots(&mut *out.normals));
        self.evaluate_facets(&self.surface(&evaluated), facets, positions, normals);
        for (vertex, normal) in self.blunt_normals(&evaluated) {
            out.normals[vertex as usize] = normal;
        }
        for (copy, source) in (owned..).zip(&self.layout.sources) {
            out.positions[copy] = out.positions[source.position as usize];
            out.normals[copy] = out.normals[source.normal as usize];
        }
        Ok(())
    }

    /// All vertices for these control vertices.
    pub(super) fn evaluated(&self, control: &[DVec3]) -> Evaluated {
        let mut vertices = self.stencils.apply(control);
        self.edits.apply(&mut vertices);
        let levels = self.finer.vertices(&vertices).into_iter().map(arrays).collect();
        Evaluated { vertices: arrays(vertices), levels }
    }

    pub(super) fn surface<'s>(&'s self, evaluated: &'s Evaluated) -> Surface<'s, T> {
        let levels = self.finer_patches.iter().zip(&evaluated.levels);
        let levels: Vec<Faces<T>> = levels.map(|(patches, vertices)| Faces { patches, vertices }).collect();
        Surface {
            bases: &self.bases,
            facets: Faces { patches: &self.patches, vertices: &evaluated.vertices },
            finer: (!levels.is_empty()).then_some((&self.finer, levels)),
        }
    }

    /// Where what some facets own, and their copies, end.
    pub(super) fn ends_of(&self, facets: &[Facet]) -> [u32; 2] {
        let next = facets.last().and_then(|last| self.facets().get(self.index_of(last) + 1));
        next.map_or([self.layout.owned, self.layout.vertices() as u32], |next| [next.first, next.copies])
    }

    /// Writes positions and normals of some facets next to each other.
    pub(super) fn evaluate_facets(
        &self,
        surface: &Surface<'_, T>,
        facets: &[Facet],
        positions: Vec<Slots<'_, Vector<T>>>,
        normals: Vec<Slots<'_, Vector<T>>>,
    ) {
        let first = facets.first().map_or(0, |facet| self.index_of(facet));
        let work = facets.par_iter().enumerate().zip(positions).zip(normals).with_min_len(MIN_LEN);
        work.for_each_init(Arena::default, |arena, (((index, facet), mut positions), mut normals)| {
            surface.evaluate(first + index, facet.facet, facet.depth, true, arena);
            facet.write(&mut positions, &arena.positions);
            facet.write(&mut normals, &arena.normals);
            for k in facet.finer_copies() {
                surface.evaluate(first + index, facet.facet, facet.edges[k], true, arena);
                facet.write_edge(&mut normals, k, &arena.normals);
            }
        });
    }

    /// As [`Plan::evaluate_facets`], but for normals.
    pub(super) fn evaluate_positions(
        &self,
        surface: &Surface<'_, T>,
        facets: &[Facet],
        positions: Vec<Slots<'_, Vector<T>>>,
    ) {
        let first = facets.first().map_or(0, |facet| self.index_of(facet));
        let work = facets.par_iter().enumerate().zip(positions).with_min_len(MIN_LEN);
        work.for_each_init(Arena::default, |arena, ((index, facet), mut positions)| {
            surface.evaluate(first + index, facet.facet, facet.depth, false, arena);
            facet.write(&mut positions, &arena.positions);
        });
    }

    /// Vertices whose normals are means, with these.
    pub(super) fn blunt_normals(&self, evaluated: &Evaluated) -> impl Iterator<Item = (u32, Vector<T>)> {
        self.layout.blunt.iter().map(|(vertex, fan)| (*vertex, self.mean_normal(fan, &evaluated.vertices)))
    }

    /// The mean normal of the facets around a vertex that start with these half-edges.
    fn mean_normal(&self, fan: &[u32], vertices: &[Vector<f64>]) -> Vector<T> {
        let at = |h: u32| vertices[self.refined.mesh_vertex(h) as usize];
        let mut sum = [0.0; 3];
        for &h in fan {
            let [a, b] = [self.refined.next(h), self.refined.prev(h)].map(|end| unit(subtract(at(end), at(h))));
            let normal = unit(cross(a, b));
            (0..3).for_each(|axis| sum[axis] += normal[axis]);
        }
        unit(sum).map(T::of)
    }

    /// Fills the caller's array of texture coordinates, which do not move with the control vertices. Without texture coordinates
    /// nothing happens.
    ///
    /// # Errors
    /// As [`Plan::fill`].
    pub fn fill_texcoords(&self, out: &mut [[f32; 2]]) -> Result<(), DiceError> {
        if self.texcoords.is_none() {
            return Ok(());
        }
        check("texture coordinates", out.len(), self.layout.vertices())?;
        let facets = self.facets();
        let (owned, copies) = out.split_at_mut(self.layout.owned as usize);
        self.evaluate_texcoords(facets, slots(facets, self.ends_of(facets), owned, copies));
        Ok(())
    }

    /// Writes the texture coordinates of some facets next to each other.
    pub(super) fn evaluate_texcoords(&self, facets: &[Facet], slots: Vec<Slots<'_, [f32; 2]>>) {
        let Some(texcoords) = &self.texcoords else { return };
        let first = facets.first().map_or(0, |facet| self.index_of(facet));
        let work = facets.par_iter().enumerate().zip(slots).with_min_len(MIN_LEN);
        match texcoords {
            Texcoords::Linear(corners) => work.for_each(|((_, facet), mut slots)| {
                let corners = &corners[facet.facet as usize];
                facet.for_each_written(|vertex, uv| *slots.at(vertex) = bilinear(corners, uv));
            }),
            Texcoords::Smooth { patches, values } => {
                let surface = Surface { bases: &self.bases, facets: Faces { patches, vertices: values }, finer: None };
                let flat = |p: &[T; 3]| [p[0], p[1]].map(|x| x.wide() as f32);
                work.for_each_init(Arena::default, |arena, ((index, facet), mut slots)| {
                    surface.evaluate(first + index, facet.facet, facet.depth, false, arena);
                    facet.write(&mut slots, &arena.positions.iter().map(flat).collect::<Vec<_>>());
                    for k in facet.finer_copies() {
                        surface.evaluate(first + index, facet.facet, facet.edges[k], false, arena);
                        facet.write_edge(&mut slots, k, &arena.positions.iter().map(flat).collect::<Vec<_>>());
                    }
                });
            }
        }
    }

    /// Fills the caller's arrays of faces, counter-clockwise seen from outside.
    ///
    /// # Errors
    /// As [`Plan::fill`].
    pub fn fill_faces(&self, quads: &mut [[u32; 4]], triangles: &mut [[u32; 3]]) -> Result<(), DiceError> {
        check("quads", quads.len(), self.layout.quads as usize)?;
        check("triangles", triangles.len(), self.layout.triangles as usize)?;
        let facets = self.facets();
        let (mut rest_of_quads, mut rest_of_triangles) = (quads, triangles);
        let mut parts = Vec::with_capacity(facets.len());
        for (i, facet) in facets.iter().enumerate() {
            let next = facets.get(i + 1).map_or((self.layout.quads, self.layout.triangles), |f| (f.quads, f.triangles));
            let of_quads = rest_of_quads.split_off_mut(..(next.0 - facet.quads) as usize).unwrap_or_default();
            let of_triangles =
                rest_of_triangles.split_off_mut(..(next.1 - facet.triangles) as usize).unwrap_or_default();
            parts.push((facet, of_quads, of_triangles));
        }
        parts
            .into_par_iter()
            .with_min_len(MIN_LEN)
            .for_each_init(super::faces::FaceWriter::default, |writer, (facet, quads, triangles)| {
                writer.write(facet, quads, triangles)
            });
        Ok(())
    }
}
