//! How deep each facet is.

use super::bounds::{Asked, Bounds, PIECE};
use super::finer::{Cell, Finer};
use super::options::{Camera, Depth, DiceOptions};
use crate::mesh::MeshError;
use crate::topology::Topology;
use glam::DVec3;
use rayon::prelude::*;

/// Before the eye, as a part of its distance from the farthest point: what is nearer is as large as there.
const NEAR: f64 = 1e-4;

/// How often each facet, a face of `topology`, is halved: `None` of those that are not drawn.
pub(super) fn halvings(
    topology: &Topology,
    finer: &Finer,
    drawn: &[bool],
    options: &DiceOptions,
) -> Result<Vec<Option<u32>>, MeshError> {
    let mesh = topology.mesh();
    let deepest = options.max_depth - 1;
    let by_length = |length: &(dyn Fn(&Topology, u32) -> f64 + Sync), most: f64| -> Vec<u32> {
        let of_face = |topology: &Topology, face: u32| {
            let longest = (4 * face..4 * face + 4).map(|h| length(topology, h)).fold(0.0, f64::max);
            (0..deepest).find(|&n| longest <= most * f64::from(1 << n)).unwrap_or(deepest)
        };
        let of_facet = |facet: u32| match finer.node(facet) {
            Some(node) => of_cell(finer, Cell::Node(node), &of_face).min(deepest),
            None => of_face(topology, facet),
        };
        (0..mesh.face_count() as u32).into_par_iter().map(of_facet).collect()
    };
    let ends =
        |topology: &Topology, h: u32| [h, topology.next(h)].map(|h| topology.mesh().position(topology.mesh_vertex(h)));
    let mut depths = match &options.depth {
        Depth::Fixed(depth) => vec![depth - 1; mesh.face_count()],
        Depth::Each(depths) => depths.iter().map(|depth| depth - 1).collect(),
        Depth::EdgeLength(length) => by_length(
            &|topology, h| {
                let [a, b] = ends(topology, h);
                a.distance(b)
            },
            *length,
        ),
        Depth::Tolerance(distance) => {
            let facets: Vec<u32> = (0..).zip(drawn).filter(|(_, drawn)| **drawn).map(|(facet, _)| facet).collect();
            let mut depths = vec![0; mesh.face_count()];
            let asked = |depth| Asked { depth, has_finer_edges: false };
            for piece in facets.chunks(PIECE) {
                let bounds = Bounds::new(topology, finer, piece, deepest)?;
                let least =
                    |index| (0..deepest).find(|&n| bounds.is_within(*distance, index, asked(n))).unwrap_or(deepest);
                let of_facets: Vec<u32> = (0..piece.len()).into_par_iter().map(least).collect();
                piece.iter().zip(of_facets).for_each(|(&facet, depth)| depths[facet as usize] = depth);
            }
            depths
        }
        Depth::Pixels { pixels, camera } => {
            let seen = Seen::new(camera, mesh.data().positions.iter().map(|&p| p.into()));
            let length = |topology: &Topology, h: u32| match seen.is_outside(topology, h / 4) {
                true => 0.0,
                false => seen.length(ends(topology, h)),
            };
            by_length(&length, *pixels)
        }
    };
    for (facet, depth) in (0..).zip(&mut depths) {
        // Holes are made of whole cells.
        *depth = finer.holes(facet).iter().map(|hole| hole.halvings).fold(*depth, u32::max);
    }
    limit_steps(topology, drawn, &mut depths, options.max_step);
    if let Depth::Tolerance(distance) = options.depth {
        let mut kept = vec![None; depths.len()];
        while deepen_beside_finer((topology, finer), (distance, deepest), drawn, &mut depths, &mut kept)? {
            limit_steps(topology, drawn, &mut depths, options.max_step);
        }
    }
    Ok(depths.into_iter().zip(drawn).map(|(depth, drawn)| drawn.then_some(depth)).collect())
}

/// How often a part of a facet is halved whose faces are halved as `of_face` says.
fn of_cell(finer: &Finer, cell: Cell, of_face: &impl Fn(&Topology, u32) -> u32) -> u32 {
    match cell {
        Cell::Node(node) => {
            let of_quarters = finer.quarters(node).map(|quarter| of_cell(finer, quarter, of_face));
            1 + of_quarters.into_iter().fold(0, u32::max)
        }
        Cell::Face { level, index } => {
            let level = &finer.levels[level as usize];
            of_face(&level.topology, level.faces[index as usize].face)
        }
    }
}

/// Makes facets deeper that are beside finer ones, and therefore not within a distance of the surface; tells whether there were any.
/// `kept` are the depths at which they are.
fn deepen_beside_finer(
    (topology, finer): (&Topology, &Finer),
    (distance, deepest): (f64, u32),
    drawn: &[bool],
    depths: &mut [u32],
    kept: &mut [Option<u32>],
) -> Result<bool, MeshError> {
    let depth = |facet: u32| depths[facet as usize];
    let is_finer =
        |h: u32| topology.twin(h).is_some_and(|twin| drawn[twin as usize / 4] && depth(twin / 4) > depth(h / 4));
    let is_asked = |facet: &u32| {
        let index = *facet as usize;
        drawn[index]
            && depths[index] < deepest
            && kept[index] != Some(depths[index])
            && (4 * facet..4 * facet + 4).any(is_finer)
    };
    let facets: Vec<u32> = (0..depths.len() as u32).into_par_iter().filter(is_asked).collect();
    let mut deepened = false;
    for piece in facets.chunks(PIECE) {
        let bounds = Bounds::new(topology, finer, piece, deepest)?;
        let asked = |index: usize| Asked { depth: depths[piece[index] as usize], has_finer_edges: true };
        let within: Vec<bool> =
            (0..piece.len()).into_par_iter().map(|index| bounds.is_within(distance, index, asked(index))).collect();
        for (&facet, within) in piece.iter().zip(within) {
            let depth = &mut depths[facet as usize];
            match within {
                true => kept[facet as usize] = Some(*depth),
                false => *depth += 1,
            }
            deepened |= !within;
        }
    }
    Ok(deepened)
}

/// Makes facets deeper that differ from a deeper neighbour by more than a step.
fn limit_steps(topology: &Topology, drawn: &[bool], depths: &mut [u32], step: u32) {
    let deepest = depths.iter().copied().max().unwrap_or(0);
    for depth in (step + 1..=deepest).rev() {
        for facet in (0..depths.len()).filter(|&facet| drawn[facet]) {
            if depths[facet] != depth {
                continue;
            }
            for h in 4 * facet as u32..4 * facet as u32 + 4 {
                let Some(twin) = topology.twin(h) else { continue };
                let other = &mut depths[twin as usize / 4];
                *other = (*other).max(depth - step);
            }
        }
    }
}

/// A camera, and how near to it points are measured.
struct Seen<'c> {
    camera: &'c Camera,
    near: f64,
}

impl<'c> Seen<'c> {
    fn new(camera: &'c Camera, points: impl Iterator<Item = DVec3>) -> Self {
        let mut seen = Self { camera, near: 0.0 };
        seen.near = NEAR * points.map(|point| seen.clip(point)[3]).fold(f64::MIN_POSITIVE, f64::max);
        seen
    }

    fn clip(&self, p: DVec3) -> [f64; 4] {
        let m = &self.camera.view_projection;
        std::array::from_fn(|row| m[0][row] * p.x + m[1][row] * p.y + m[2][row] * p.z + m[3][row])
    }

    /// Length in pixels of a line.
    fn length(&self, ends: [DVec3; 2]) -> f64 {
        let [a, b] = ends.map(|end| {
            let [x, y, _, w] = self.clip(end);
            [x, y].map(|x| 0.5 * x / w.max(self.near))
        });
        let [width, height] = self.camera.size;
        ((a[0] - b[0]) * width).hypot((a[1] - b[1]) * height)
    }

    /// Whether a facet and all facets around it are beyond a plane of the view, in whose hull the surface is.
    fn is_outside(&self, topology: &Topology, facet: u32) -> bool {
        let mut planes = [true; 6];
        for h in 4 * facet..4 * facet + 4 {
            for spoke in topology.fan(h).0 {
                for corner in topology.mesh().face_corners(topology.face(spoke)) {
                    let [x, y, z, w] = self.clip(topology.mesh().position(topology.mesh_vertex(corner as u32)));
                    let inside = [w + x, w - x, w + y, w - y, z, w - z];
                    planes.iter_mut().zip(inside).for_each(|(plane, inside)| *plane &= inside < 0.0);
                }
            }
        }
        planes.contains(&true)
    }
}
