//! A small modelling kit: quads are grown out of quads, so that a model is closed and all-quad by construction.

use glam::{DQuat, DVec3};

/// A grid of vertices whose cells are faces of the model.
///
/// The cells are counter-clockwise from outside: the column direction, the row direction and the outward normal are
/// right-handed.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    pub columns: usize,
    pub rows: usize,
    /// `(columns + 1) * (rows + 1)` vertices, a row at a time.
    grid: Vec<u32>,
    /// Column 0 lies in the mirror plane x = 0: the patch is the right half of a symmetric one.
    half: bool,
}

impl Patch {
    pub(super) fn new(columns: usize, rows: usize, mut vertex: impl FnMut(usize, usize) -> u32) -> Self {
        let grid = (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j))).map(|(i, j)| vertex(i, j)).collect();
        Self { columns, rows, grid, half: false }
    }

    pub(super) fn vertex(&self, column: usize, row: usize) -> u32 {
        self.grid[row * (self.columns + 1) + column]
    }

    /// `columns` x `rows` cells from the cell (`column`, `row`) on.
    pub(super) fn sub(&self, column: usize, row: usize, columns: usize, rows: usize) -> Self {
        let half = self.half && column == 0;
        Self { half, ..Self::new(columns, rows, |i, j| self.vertex(column + i, row + j)) }
    }

    pub(super) fn cell(&self, column: usize, row: usize) -> Self {
        self.sub(column, row, 1, 1)
    }

    /// Turned by half a turn: the last column and row become the first.
    pub(super) fn turned(&self) -> Self {
        Self::new(self.columns, self.rows, |i, j| self.vertex(self.columns - i, self.rows - j))
    }

    /// Declares column 0 to lie in the mirror plane.
    pub(super) fn halved(self) -> Self {
        Self { half: true, ..self }
    }

    fn cells(&self) -> impl Iterator<Item = [u32; 4]> {
        (0..self.rows)
            .flat_map(|j| (0..self.columns).map(move |i| (i, j)))
            .map(|(i, j)| [self.vertex(i, j), self.vertex(i + 1, j), self.vertex(i + 1, j + 1), self.vertex(i, j + 1)])
    }

    /// Grid places along the rim, counter-clockwise from (0, 0): closed (the last is the first), or for a half
    /// patch open, from the mirror plane to the mirror plane.
    pub(super) fn rim(&self) -> Vec<(usize, usize)> {
        let (c, r) = (self.columns, self.rows);
        let mut rim: Vec<_> = (0..c).map(|i| (i, 0)).collect();
        rim.extend((0..r).map(|j| (c, j)));
        rim.extend((0..=c).rev().map(|i| (i, r)));
        if !self.half {
            rim.extend((0..r).rev().map(|j| (0, j)));
        }
        rim
    }
}

/// A cross-section of a tube.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ring {
    pub at: DVec3,
    /// Half axes along the columns and rows of the patch the tube grows from: about those of the smooth surface.
    pub size: [f64; 2],
    /// How far the middle of the cross-section stands out when it ends the tube.
    pub dome: f64,
}

impl Ring {
    pub(super) fn new(at: [f64; 3], size: [f64; 2]) -> Self {
        Self { at: at.into(), size, dome: 0.0 }
    }
}

/// Patches of a tube: its end and its sides.
pub(super) struct Tube {
    /// The end.
    pub cap: Patch,
    /// The sides: a column a rim edge (counter-clockwise, see [`Patch::rim`]), a row a ring.
    pub wall: Patch,
}

#[derive(Debug, Default)]
pub(super) struct Sculpt {
    pub positions: Vec<DVec3>,
    pub faces: Vec<[u32; 4]>,
}

impl Sculpt {
    pub(super) fn add_vertex(&mut self, position: DVec3) -> u32 {
        self.positions.push(position);
        self.positions.len() as u32 - 1
    }

    pub(super) fn add_faces(&mut self, patch: &Patch) {
        self.faces.extend(patch.cells());
    }

    pub(super) fn remove_faces(&mut self, patch: &Patch) {
        let sorted = |mut cell: [u32; 4]| {
            cell.sort_unstable();
            cell
        };
        let cells: Vec<_> = patch.cells().map(sorted).collect();
        self.faces.retain(|&face| !cells.contains(&sorted(face)));
    }

    /// The middle of a patch; of the whole symmetric patch, for a half one.
    pub(super) fn centre(&self, patch: &Patch) -> DVec3 {
        let sum: DVec3 = patch.grid.iter().map(|&v| self.positions[v as usize]).sum();
        let centre = sum / patch.grid.len() as f64;
        if patch.half { DVec3::new(0.0, centre.y, centre.z) } else { centre }
    }

    /// Unit vectors along the columns (away from column 0) and outward.
    pub(super) fn frame(&self, patch: &Patch) -> [DVec3; 2] {
        let at = |i, j| self.positions[patch.vertex(i, j) as usize];
        let (c, r) = (patch.columns, patch.rows);
        let u = at(c, 0) + at(c, r) - at(0, 0) - at(0, r);
        let u = if patch.half { DVec3::X } else { u.normalize() };
        let v = at(0, r) + at(c, r) - at(0, 0) - at(c, 0);
        [u, u.cross(v).normalize()]
    }

    /// Pulls a patch out: its rim stays, its cells move to new vertices, sides are added between.
    pub(super) fn extrude(&mut self, base: &Patch, mut place: impl FnMut(usize, usize) -> DVec3) -> Tube {
        self.remove_faces(base);
        let cap = Patch::new(base.columns, base.rows, |i, j| self.add_vertex(place(i, j)));
        let cap = Patch { half: base.half, ..cap };
        self.add_faces(&cap);
        let rim = base.rim();
        let wall = Patch::new(rim.len() - 1, 1, |i, j| {
            let (column, row) = rim[i];
            if j == 0 { base.vertex(column, row) } else { cap.vertex(column, row) }
        });
        self.add_faces(&wall);
        Tube { cap, wall }
    }

    /// Pulls a patch out along the centres of `rings`, one step a ring, without twist.
    pub(super) fn tube(&mut self, base: &Patch, rings: &[Ring]) -> Tube {
        let [mut u, mut normal] = self.frame(base);
        let mut last = self.centre(base);
        let mut cap = base.clone();
        let mut walls = Vec::with_capacity(rings.len());
        // Around a rim of k vertices, the smooth surface lies inside the control points by this factor.
        let edges = if base.half { 2 * base.rim().len() - 2 } else { base.rim().len() - 1 };
        let shrink = (2.0 + (std::f64::consts::TAU / edges as f64).cos()) / 3.0;
        for (k, ring) in rings.iter().enumerate() {
            let ahead = rings.get(k + 1).map_or(ring.at, |next| next.at);
            let tangent = (ahead - last).normalize();
            let turn = DQuat::from_rotation_arc(normal, tangent);
            if !base.half {
                u = turn * u;
            }
            normal = tangent;
            u = (u - normal * u.dot(normal)).normalize();
            let v = normal.cross(u);
            let [a_size, b_size] = ring.size.map(|s| s / shrink);
            let tube = self.extrude(&cap, |i, j| {
                let [a, b] = disc(base, i, j);
                let dome = ring.dome * (1.0 - a * a - b * b).max(0.0);
                ring.at + u * (a * a_size) + v * (b * b_size) + normal * dome
            });
            cap = tube.cap;
            walls.push(tube.wall);
            last = ring.at;
        }
        let columns = base.rim().len() - 1;
        let wall =
            Patch::new(
                columns,
                rings.len(),
                |i, j| {
                    if j == 0 { walls[0].vertex(i, 0) } else { walls[j - 1].vertex(i, 1) }
                },
            );
        Tube { cap, wall }
    }

    /// A tube from the middle of a patch to the middle plus `reach`, bent sideways by `bend` on the way.
    pub(super) fn spike(&mut self, base: &Patch, reach: DVec3, bend: DVec3, sizes: &[[f64; 2]]) -> Tube {
        let centre = self.centre(base);
        let ring = |(k, &size): (usize, &[f64; 2])| {
            let s = (k + 1) as f64 / sizes.len() as f64;
            Ring { at: centre + reach * s + bend * (s * (1.0 - s)), size, dome: 0.0 }
        };
        let rings: Vec<_> = sizes.iter().enumerate().map(ring).collect();
        self.tube(base, &rings)
    }

    /// Rings about the middle of a patch: how far each stands out, and its radius.
    pub(super) fn bump(&mut self, base: &Patch, out: DVec3, rings: &[(f64, f64)]) -> Tube {
        let centre = self.centre(base);
        let out = out.normalize();
        let [u, _] = self.frame(base);
        let u = (u - out * u.dot(out)).normalize();
        let v = out.cross(u);
        let mut tube = Tube { cap: base.clone(), wall: base.clone() };
        for &(height, radius) in rings {
            tube = self.extrude(&tube.cap.clone(), |i, j| {
                let [a, b] = disc(base, i, j);
                let dome = 0.35 * radius * (1.0 - a * a - b * b).max(0.0);
                centre + (u * a + v * b) * radius + out * (height + dome)
            });
        }
        tube
    }

    /// Moves vertices towards the middle of their neighbours by `factor`, in the right half of a symmetric model.
    pub(super) fn relax_half(&mut self, factor: f64) {
        let mut sums = vec![(DVec3::ZERO, 0.0); self.positions.len()];
        for face in &self.faces {
            for k in 0..4 {
                let (from, to) = (face[k] as usize, face[(k + 1) % 4] as usize);
                // Off the mirror plane both faces of an edge contribute; in it, the face and its mirror image do.
                for (vertex, other) in [(from, to), (to, from)] {
                    sums[vertex].0 += self.positions[other];
                    sums[vertex].1 += 1.0;
                }
            }
        }
        for (position, (sum, count)) in self.positions.iter_mut().zip(sums) {
            if count > 0.0 {
                let in_plane = position.x == 0.0;
                *position = position.lerp(sum / count, factor);
                if in_plane {
                    position.x = 0.0;
                }
            }
        }
    }

    /// Adds the mirror image in x = 0 of everything, sharing the vertices in the plane.
    pub(super) fn mirrored(mut self) -> Self {
        let mut image = Vec::with_capacity(self.positions.len());
        for v in 0..self.positions.len() {
            let position = self.positions[v];
            let in_plane = position.x == 0.0;
            image.push(if in_plane { v as u32 } else { self.add_vertex(position * DVec3::new(-1.0, 1.0, 1.0)) });
        }
        for f in 0..self.faces.len() {
            let [a, b, c, d] = self.faces[f].map(|v| image[v as usize]);
            self.faces.push([d, c, b, a]);
        }
        self
    }

    /// Positions and face vertices, without the vertices that no face uses.
    pub(super) fn finish(self) -> (Vec<[f64; 3]>, Vec<u32>) {
        let mut numbers = vec![u32::MAX; self.positions.len()];
        let mut positions = Vec::new();
        let mut face_vertices = Vec::with_capacity(4 * self.faces.len());
        for &vertex in self.faces.iter().flatten() {
            let number = &mut numbers[vertex as usize];
            if *number == u32::MAX {
                *number = positions.len() as u32;
                positions.push(self.positions[vertex as usize].to_array());
            }
            face_vertices.push(*number);
        }
        (positions, face_vertices)
    }
}

/// Where a grid place lies in the unit disc: the square grid, pulled round.
fn disc(patch: &Patch, column: usize, row: usize) -> [f64; 2] {
    let a = column as f64 / patch.columns as f64;
    let a = if patch.half { a } else { 2.0 * a - 1.0 };
    let b = 2.0 * row as f64 / patch.rows as f64 - 1.0;
    [a * (1.0 - b * b / 2.0).sqrt(), b * (1.0 - a * a / 2.0).sqrt()]
}
