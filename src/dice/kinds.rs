//! The kinds of facets: what refines a facet of a kind depends on its connectivity and tags only, and is made once.
//!
//! A kind knows the points around a facet by number. A regular kind is a B-spline patch, whose control points are sums of the
//! points. Of any other kind the four quarters have kinds in turn, whose points are sums of the points; around an extraordinary
//! vertex the same kind comes again at every level, so there are few of them however deep facets go.

use super::real::Real;
use super::sums::Sums;
use crate::adaptive::{fill, grid, is_boundary};
use crate::blend::{Blend, Row};
use crate::limit::{Local, corner_masks, dart_edge, is_semi_sharp_at, refine};
use crate::mesh::{ControlMesh, MeshData, MeshError};
use crate::topology::{PatchKind, Topology};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::collections::HashSet;

/// What a facet of a kind is made of.
pub(super) struct Kind<T> {
    pub shape: Shape<T>,
}

pub(super) enum Shape<T> {
    /// Its 16 control points, number `4 i + j` with index i along u and j along v.
    Regular(Sums<T>),
    Irregular {
        /// Of each corner: the limit point and two vectors, along whose cross product the normal is.
        corners: Option<Sums<T>>,
        refined: Option<Refined<T>>,
    },
}

/// One step of refinement.
pub(super) struct Refined<T> {
    /// The refined points around the facet.
    pub points: Sums<T>,
    /// Its quarters: at corner k the k-th.
    pub quarters: [Quarter; 4],
}

/// A quarter of a facet.
#[derive(Clone)]
pub(super) struct Quarter {
    pub kind: u32,
    /// Which of the refined points its points are.
    pub points: Box<[u32]>,
    /// Which of its points is at the corner of the facet.
    pub corner: u32,
}

/// What a kind depends on: faces, creases and corners around a facet.
type Key = (Vec<u32>, Vec<(u32, u32, u32)>, Vec<(u32, u32)>);

fn key(data: &MeshData) -> Key {
    (
        data.face_vertices.clone(),
        data.creases.iter().map(|c| (c.vertices[0], c.vertices[1], c.sharpness.to_bits())).collect(),
        data.corners.iter().map(|c| (c.vertex, c.sharpness.to_bits())).collect(),
    )
}

/// Kinds in the making.
#[derive(Default)]
pub(super) struct Builder {
    drafts: Vec<Draft>,
    numbers: FxHashMap<Key, u32>,
    /// Kinds with the depths for which they are made.
    done: HashSet<(u32, u32)>,
    /// The same for all lesser depths.
    all: HashSet<(u32, u32)>,
}

struct Draft {
    /// The facet is face 0.
    topology: Topology,
    /// The control points of a regular facet.
    regular: Option<Vec<Row>>,
    corners: [Option<[Row; 3]>; 4],
    refined: Option<(Vec<Row>, [Quarter; 4])>,
    /// Whether facets of this kind end here.
    ends: bool,
}

impl Builder {
    /// The number of the kind of a part's face 0.
    pub(super) fn number(&mut self, data: MeshData) -> Result<u32, MeshError> {
        let key = key(&data);
        if let Some(&number) = self.numbers.get(&key) {
            return Ok(number);
        }
        let number = self.drafts.len() as u32;
        let topology = Topology::new(&ControlMesh::new(data)?);
        let regular = is_regular(&topology).then(|| control_points(&topology));
        self.drafts.push(Draft { topology, regular, corners: [const { None }; 4], refined: None, ends: false });
        self.numbers.insert(key, number);
        Ok(number)
    }

    /// Makes what facets of a kind need that are halved `depth` times.
    pub(super) fn deepen(&mut self, kind: u32, depth: u32) -> Result<(), MeshError> {
        if self.drafts[kind as usize].regular.is_some() || !self.done.insert((kind, depth)) {
            return Ok(());
        }
        if depth == 0 {
            self.drafts[kind as usize].ends = true;
            return (0..4).try_for_each(|k| self.corner(kind, k).map(|_| ()));
        }
        for k in 0..4 {
            let quarter = self.refine(kind)?[k].kind;
            self.deepen(quarter, depth - 1)?;
        }
        Ok(())
    }

    /// Makes all corners and steps of refinement of facets that are halved up to `depth` times.
    pub(super) fn deepen_all(&mut self, kind: u32, depth: u32) -> Result<(), MeshError> {
        if self.drafts[kind as usize].regular.is_some() || !self.all.insert((kind, depth)) {
            return Ok(());
        }
        self.deepen(kind, 0)?;
        if depth > 0 {
            for k in 0..4 {
                let quarter = self.refine(kind)?[k].kind;
                self.deepen_all(quarter, depth - 1)?;
            }
        }
        Ok(())
    }

    /// Refines a kind, unless it is.
    fn refine(&mut self, kind: u32) -> Result<&[Quarter; 4], MeshError> {
        if self.drafts[kind as usize].refined.is_none() {
            let refined = refine(&self.drafts[kind as usize].topology)?;
            let topology = Topology::new(&refined.mesh);
            let mut numbers = FxHashMap::default();
            let mut rows = Vec::new();
            let mut quarters = Vec::with_capacity(4);
            for k in 0..4u32 {
                // Child k begins at corner k; it is turned so that u and v run as in its parent.
                let first = (4 - k) % 4;
                let local = Local::cut(&topology, k, first as usize, DVec3::ZERO);
                let points = local.vertices.iter().map(|&vertex| {
                    *numbers.entry(vertex).or_insert_with(|| {
                        rows.push(Row::new(refined.stencils.row(vertex as usize).collect()));
                        rows.len() as u32 - 1
                    })
                });
                let points = points.collect();
                let corner = local.data.face_vertices[k as usize];
                quarters.push(Quarter { kind: self.number(local.data)?, points, corner });
            }
            let quarters = quarters.try_into().unwrap_or_else(|_| unreachable!("four corners"));
            self.drafts[kind as usize].refined = Some((rows, quarters));
        }
        let refined = self.drafts[kind as usize].refined.as_ref();
        Ok(&refined.expect("it was refined").1)
    }

    /// The limit point at a corner, and two vectors along whose cross product the normal is.
    fn corner(&mut self, kind: u32, k: u32) -> Result<[Row; 3], MeshError> {
        let draft = &self.drafts[kind as usize];
        if let Some(rows) = &draft.corners[k as usize] {
            return Ok(rows.clone());
        }
        let rows = if is_semi_sharp_at(&draft.topology, k) {
            // What is of finite sharpness is used up some levels further on.
            let quarter = self.refine(kind)?[k as usize].clone();
            let of_quarter = self.corner(quarter.kind, k)?;
            let (rows, _) = self.drafts[kind as usize].refined.as_ref().expect("it was refined");
            of_quarter.map(|row| {
                Row::sum(row.weights().iter().map(|&(i, weight)| (weight, &rows[quarter.points[i as usize] as usize])))
            })
        } else {
            let masks = corner_masks(&draft.topology, k, Row::unit);
            let [a, b] = masks.plane.unwrap_or_default();
            [masks.position, a, b]
        };
        self.drafts[kind as usize].corners[k as usize] = Some(rows.clone());
        Ok(rows)
    }

    pub(super) fn finish<T: Real>(self) -> Vec<Kind<T>> {
        self.drafts.into_iter().map(Draft::finish).collect()
    }
}

impl Draft {
    fn finish<T: Real>(self) -> Kind<T> {
        if let Some(rows) = self.regular {
            return Kind { shape: Shape::Regular(Sums::new(rows)) };
        }
        let corners = self.ends.then(|| Sums::new(self.corners.into_iter().flatten().flatten()));
        let refined = self.refined.map(|(rows, quarters)| Refined { points: Sums::new(rows), quarters });
        Kind { shape: Shape::Irregular { corners, refined } }
    }
}

/// Whether face 0 is a B-spline patch.
fn is_regular(topology: &Topology) -> bool {
    let is_plain = |h: u32| {
        let ring = &topology.rings()[topology.place(h).ring as usize];
        dart_edge(topology, ring).is_none() && !is_semi_sharp_at(topology, h)
    };
    topology.patch_kind(0) == Some(PatchKind::Regular) && (0..4).all(is_plain)
}

/// The control points of a regular face 0.
fn control_points(topology: &Topology) -> Vec<Row> {
    let half_edges = [0, 1, 2, 3];
    let mut grid = grid(topology, half_edges);
    let mut rows: Vec<Row> = (0..topology.mesh().vertex_count() as u32).map(Row::unit).collect();
    let boundary = half_edges.into_iter().filter(|&h| is_boundary(topology, h)).map(|h| 1 << h).sum();
    fill(&mut grid, boundary, |on, inner| {
        rows.push(Row::sum([(2.0, &rows[on as usize]), (-1.0, &rows[inner as usize])]));
        rows.len() as u32 - 1
    });
    grid.map(|point| rows[point as usize].clone()).into()
}
