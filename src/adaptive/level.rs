//! The part of the mesh that is refined, level by level.

use super::feature::{Class, Reason, Shape, classify, is_constant, shape};
use super::options::AdaptiveOptions;
use crate::limit::{MaskedRows, Part, refine_part};
use crate::mesh::{CreaseMethod, MeshError};
use crate::topology::Topology;
use rayon::prelude::*;
use std::borrow::Cow;

/// In the place of a half-edge.
const NONE: u32 = u32::MAX;

/// Vertices, or faces, for one thread at least.
pub(super) const MIN_LEN: usize = 1024;

/// Where a face of a level lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cell {
    pub root: u32,
    /// The node of the cell.
    pub node: u32,
    pub u: u32,
    pub v: u32,
    /// The corner of the cell, counter-clockwise from its least (u, v), that is corner 0 of the face.
    pub first: u32,
    /// Whether the face is one of the plan's, and not only there because its neighbours depend on it.
    pub own: bool,
}

/// The faces of one level that the plan has there, with those around them.
pub(super) struct Level<'t> {
    pub number: u32,
    /// All that is needed around the level's own faces is there and right; what lies further out need not be.
    pub topology: Cow<'t, Topology>,
    /// The number of its vertex 0.
    pub first_vertex: u32,
    /// One a face.
    pub cells: Vec<Cell>,
}

/// What becomes of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fate {
    /// It is not the plan's.
    Support,
    Leaf(Shape),
    Refined(Reason),
}

impl Level<'_> {
    /// What the vertices of the plan's own faces ask, and what becomes of each face.
    pub(super) fn fates(&self, options: &AdaptiveOptions) -> (Vec<Class>, Vec<Fate>) {
        let topology = &*self.topology;
        // A half-edge from each vertex of the plan's own faces.
        let mut starts = vec![NONE; topology.vertex_count()];
        for (face, _) in (0..).zip(&self.cells).filter(|(_, cell)| cell.own) {
            self.corners(face).for_each(|h| starts[topology.vertex(h) as usize] = h);
        }
        let classify = |h: u32| if h == NONE { Class::Plain } else { classify(topology, h) };
        let classes: Vec<Class> = starts.into_par_iter().with_min_len(MIN_LEN).map(classify).collect();
        let class = |h: u32| classes[topology.vertex(h) as usize];
        let fate = |(face, cell): (usize, &Cell)| match cell.own {
            true => self.fate(face as u32, class, options),
            false => Fate::Support,
        };
        let fates = self.cells.par_iter().enumerate().with_min_len(MIN_LEN).map(fate).collect();
        (classes, fates)
    }

    fn fate(&self, face: u32, class: impl Fn(u32) -> Class, options: &AdaptiveOptions) -> Fate {
        let topology = &*self.topology;
        let corners = topology.mesh().face_corners(face);
        if corners.len() != 4 {
            return Fate::Refined(Reason::NonQuad);
        }
        if let Some(reason) = { corners }.filter_map(|h| class(h as u32).reason(self.number, options)).min() {
            return Fate::Refined(reason);
        }
        let shape = shape(topology, face, &class);
        let may_refine = self.number < options.sharp_depth();
        match shape {
            Shape::SingleCrease { half_edge, .. } if may_refine && !is_constant(topology, half_edge) => {
                Fate::Refined(Reason::VaryingCrease)
            }
            Shape::SingleCrease { .. } if may_refine && options.refine_creases => Fate::Refined(Reason::Crease),
            // Creases along opposite edges: their corners are no features.
            Shape::Irregular if may_refine && { self.corners(face) }.all(|h| class(h) == Class::Crease) => {
                Fate::Refined(Reason::VaryingCrease)
            }
            shape => Fate::Leaf(shape),
        }
    }

    fn corners(&self, face: u32) -> impl Iterator<Item = u32> + use<> {
        self.topology.mesh().face_corners(face).map(|h| h as u32)
    }

    /// The half-edges of a quad, from the corner of its cell with the least (u, v).
    pub(super) fn oriented(&self, face: u32) -> [u32; 4] {
        let start = self.topology.mesh().face_corners(face).start as u32;
        let first = self.cells[face as usize].first;
        [0, 1, 2, 3].map(|corner| start + (corner + 4 - first) % 4)
    }

    /// The next level: the children of the refined faces and all faces around them; its vertices as sums, in pieces; and the
    /// faces other than quads whose points are its first vertices. `child` tells the cell of a face's child around its
    /// corner.
    pub(super) fn refine(
        &self,
        fates: &[Fate],
        first_vertex: u32,
        child: impl Fn(u32, u32) -> Cell + Sync,
    ) -> Result<(Level<'static>, Vec<MaskedRows>, Vec<u32>), MeshError> {
        let topology = &*self.topology;
        let half_edges = self.half_edges_with_children(fates);
        let own = topology.mesh().vertex_count() as u32;
        let number = |vertex| if vertex < own { self.first_vertex + vertex } else { first_vertex + (vertex - own) };
        let has_centre = |face: u32| match topology.mesh().face(face).len() {
            3 => matches!(fates[face as usize], Fate::Refined(_)),
            size => size > 4,
        };
        let Part { mesh, rows, centres } = refine_part(topology, &half_edges, has_centre, number)?;
        let cell = |&h: &u32| {
            let face = topology.face(h);
            let cell = child(face, h - topology.mesh().face_corners(face).start as u32);
            Cell { own: matches!(fates[face as usize], Fate::Refined(_)), ..cell }
        };
        let cells = half_edges.par_iter().with_min_len(MIN_LEN).map(cell).collect();
        let topology = Cow::Owned(Topology::new(&mesh));
        Ok((Level { number: self.number + 1, topology, first_vertex, cells }, rows, centres))
    }

    /// Half-edges whose children the next level needs: those of refined faces and of the ring around them, by Chaikin's method of one
    /// ring more; and those of all faces with five and more corners, which have centres.
    fn half_edges_with_children(&self, fates: &[Fate]) -> Vec<u32> {
        let topology = &*self.topology;
        let all = 0..topology.mesh().corner_count() as u32;
        let mut touched = vec![false; topology.vertex_count()];
        for h in all.clone().filter(|&h| matches!(fates[topology.face(h) as usize], Fate::Refined(_))) {
            touched[topology.vertex(h) as usize] = true;
        }
        let is_touched = |h: u32| touched[topology.vertex(h) as usize] || topology.face_size(h) > 4;
        if topology.mesh().data().crease_method == CreaseMethod::Uniform {
            return all.filter(|&h| is_touched(h)).collect();
        }
        let faces = (0..topology.mesh().face_count() as u32).filter(|&face| { self.corners(face) }.any(is_touched));
        faces.flat_map(|face| self.corners(face)).collect()
    }
}
