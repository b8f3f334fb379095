//! Quads that an exporter split into triangles, put together again.
//!
//! First by the exporter's order: it wrote both triangles of a quad one after the other, always in the same manner. If most
//! triangles are in such pairs, these are the quads, and the rest are triangles. Otherwise by shape: of all pairs of neighbours
//! those with the best corners first, as many as can be found. If most triangles find one, they were quads; otherwise nothing changes.

use super::matching::{Candidate, Matching};
use super::{Joints, MeshData, NO_TWIN};
use glam::DVec3;

/// Triangles in pairs of one manner, as a part of all, from which on the order is believed.
const ORDERED: f64 = 0.7;
/// Triangles in pairs by shape from which on those are believed.
const SHAPED: f64 = 0.75;
/// Triangles in pairs of one manner from which on pairs of that manner are quads, whatever their shape.
const CERTAIN: f64 = 0.8;
/// Mean of the corners' |cosines| up to which a pair can be a quad: by order, and by shape. Two equilateral triangles have 0.5.
const BENT_IN_ORDER: f64 = 0.7;
const BENT: f64 = 0.4;
/// Cosine of the angle between the normals of a pair, at least: by order, and by shape.
const FOLD_IN_ORDER: f64 = 0.0;
const FOLD: f64 = 0.7;
/// Sine of a quad's corners, at least, on the convex side.
const CONVEX: f64 = 0.05;

/// Two triangles with a common edge: the half-edges of both on it.
#[derive(Clone, Copy)]
struct Pair {
    first: u32,
    second: u32,
    bent: f64,
    fold: f64,
    is_convex: bool,
}

/// Pairs triangles of `data` that have the same number in `groups` (one a face; faces of `u32::MAX` stay). Gives the number of
/// quads.
pub(in super::super) fn rebuild(data: &mut MeshData, groups: &[u32]) -> usize {
    let joints = Joints::new(data);
    let triangles = Triangles { data, joints: &joints, groups };
    let count = (0..groups.len() as u32).filter(|&face| triangles.is_one(face)).count() as f64;
    let ordered = Some(triangles.in_order(count)).filter(|pairs| 2.0 * pairs.len() as f64 >= ORDERED * count);
    let pairs = ordered.or_else(|| triangles.by_shape(count)).unwrap_or_default();
    merge(data, &joints, &pairs);
    pairs.len()
}

impl Pair {
    /// Whether an exporter may have split this quad.
    fn may_follow(&self) -> bool {
        self.is_convex && self.bent <= BENT_IN_ORDER && self.fold >= FOLD_IN_ORDER
    }

    fn cost(&self) -> f64 {
        self.bent + (1.0 - self.fold)
    }
}

struct Triangles<'d> {
    data: &'d MeshData,
    joints: &'d Joints,
    groups: &'d [u32],
}

impl Triangles<'_> {
    fn is_one(&self, face: u32) -> bool {
        self.data.face_sizes[face as usize] == 3 && self.groups[face as usize] != u32::MAX
    }

    fn position(&self, half_edge: u32) -> DVec3 {
        self.data.positions[self.data.face_vertices[half_edge as usize] as usize].into()
    }

    /// The pair across a half-edge, if no seam is there.
    fn pair(&self, first: u32) -> Option<Pair> {
        let second = self.joints.twins[first as usize];
        if second == NO_TWIN {
            return None;
        }
        let [a, b] = [first, second].map(|h| self.joints.faces[h as usize]);
        let may = self.is_one(a) && self.is_one(b) && self.groups[a as usize] == self.groups[b as usize];
        if !may || self.is_seam(first, second) {
            return None;
        }
        let apex = |h: u32| self.position(self.joints.prev(h));
        let corners = [self.position(first), apex(second), self.position(second), apex(first)];
        let normal = |h: u32| {
            let [x, y, z] = [h, self.joints.next(h), self.joints.prev(h)].map(|h| self.position(h));
            (y - x).cross(z - x).normalize_or_zero()
        };
        let [n, m] = [normal(first), normal(second)];
        let up = (n + m).normalize_or_zero();
        let (mut bent, mut is_convex) = (0.0, true);
        for k in 0..4 {
            let [from, at, to] = [corners[(k + 3) % 4], corners[k], corners[(k + 1) % 4]];
            let (into, out) = ((at - from).normalize_or_zero(), (to - at).normalize_or_zero());
            is_convex &= into.cross(out).dot(up) >= CONVEX;
            bent += into.dot(out).abs() / 4.0;
        }
        Some(Pair { first, second, bent, fold: n.dot(m), is_convex })
    }

    /// Whether texture coordinates differ across an edge.
    fn is_seam(&self, first: u32, second: u32) -> bool {
        let Some(texcoords) = &self.data.texcoords else { return false };
        let value = |h: u32| texcoords.values[texcoords.indices[h as usize] as usize];
        value(first) != value(self.joints.next(second)) || value(self.joints.next(first)) != value(second)
    }

    /// The pairs of the manner that most triangles which follow one another have; there are `count` triangles.
    fn in_order(&self, count: f64) -> Vec<Pair> {
        let good = self.following(Pair::may_follow);
        let bent = |pairs: &[Pair]| pairs.iter().map(|pair| pair.bent).sum::<f64>();
        // As many pairs as can be; of manners that are nearly as frequent the one with better corners.
        let worth = |pairs: &[Pair]| pairs.len() as f64 - bent(pairs);
        let manners = (0..9).map(|manner| (manner, self.of_manner(manner, &good)));
        let Some((manner, best)) = manners.max_by(|a, b| worth(&a.1).total_cmp(&worth(&b.1))) else {
            return Vec::new();
        };
        if 2.0 * (best.len() as f64) < CERTAIN * count {
            return best;
        }
        self.of_manner(manner, &self.following(|_| true))
    }

    /// For each triangle, its pairs with the next one of the file.
    fn following(&self, may: impl Fn(&Pair) -> bool) -> Vec<Option<Pair>> {
        let following = |face: u32| {
            let pairs = self.joints.corners(face).filter_map(|h| {
                let twin = self.joints.twins[h];
                let follows = twin != NO_TWIN && self.joints.faces[twin as usize] == face + 1;
                follows.then(|| self.pair(h as u32)).flatten()
            });
            { pairs }.find(&may)
        };
        (0..self.groups.len() as u32).map(following).collect()
    }

    /// Pairs of a manner, from the first triangle on: it is told by the corner of each triangle from which the common edge starts.
    fn of_manner(&self, manner: usize, following: &[Option<Pair>]) -> Vec<Pair> {
        let corner = |h: u32| h as usize - self.joints.corners(self.joints.faces[h as usize]).start;
        let (mut found, mut face) = (Vec::new(), 0);
        while face < following.len() {
            match following[face].filter(|pair| 3 * corner(pair.first) + corner(pair.second) == manner) {
                Some(pair) => {
                    found.push(pair);
                    face += 2;
                }
                None => face += 1,
            }
        }
        found
    }

    /// The best pairs of good shape first, as long as both triangles are free. If there are enough, those were quads; then partners
    /// are changed along paths from one triangle that is left to another, over pairs of any shape that exporters write.
    fn by_shape(&self, count: f64) -> Option<Vec<Pair>> {
        let half_edges = 0..self.joints.twins.len() as u32;
        let mut pairs: Vec<Pair> = half_edges
            .filter(|&h| h < self.joints.twins[h as usize])
            .filter_map(|h| self.pair(h))
            .filter(Pair::may_follow)
            .collect();
        pairs.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        let faces = |pair: &Pair| [pair.first, pair.second].map(|h| self.joints.faces[h as usize]);
        let mut candidates = vec![Vec::new(); self.groups.len()];
        for (number, pair) in (0..).zip(&pairs) {
            let [a, b] = faces(pair);
            for (face, node) in [(a, b), (b, a)] {
                candidates[face as usize].push(Candidate { node, cost: pair.cost(), pair: number });
            }
        }
        let mut matching = Matching::new(&candidates);
        let mut found = 0.0;
        for (number, pair) in (0..).zip(&pairs).filter(|(_, pair)| pair.bent <= BENT && pair.fold >= FOLD) {
            let [a, b] = faces(pair);
            if matching.mates[a as usize].is_none() && matching.mates[b as usize].is_none() {
                matching.join(a, Candidate { node: b, cost: pair.cost(), pair: number });
                found += 2.0;
            }
        }
        if found < SHAPED * count {
            return None;
        }
        matching.augment();
        let mates = (0..).zip(&matching.mates);
        let of_lower = |(face, mate): (u32, &Option<Candidate>)| mate.filter(|mate| face < mate.node);
        Some(mates.filter_map(of_lower).map(|mate| pairs[mate.pair as usize]).collect())
    }
}

/// Puts each quad in the place of the first of its triangles.
fn merge(data: &mut MeshData, joints: &Joints, pairs: &[Pair]) {
    if pairs.is_empty() {
        return;
    }
    let mut inserted = vec![NO_TWIN; data.face_vertices.len()];
    let mut goes = vec![false; data.face_sizes.len()];
    for pair in pairs {
        let [a, b] = [pair.first, pair.second].map(|h| joints.faces[h as usize]);
        let (first, second) = if a < b { (pair.first, pair.second) } else { (pair.second, pair.first) };
        inserted[first as usize] = joints.prev(second);
        goes[a.max(b) as usize] = true;
    }
    let (mut corners, mut sizes) = (Vec::with_capacity(data.face_vertices.len()), Vec::new());
    for face in (0..data.face_sizes.len() as u32).filter(|&face| !goes[face as usize]) {
        let first = corners.len();
        for corner in joints.corners(face) {
            corners.push(corner);
            corners.extend(Some(inserted[corner] as usize).filter(|_| inserted[corner] != NO_TWIN));
        }
        sizes.push((corners.len() - first) as u32);
    }
    data.face_sizes = sizes;
    let attributes = [
        data.texcoords.as_mut().map(|texcoords| &mut texcoords.indices),
        data.normals.as_mut().map(|normals| &mut normals.indices),
    ];
    for numbers in attributes.into_iter().flatten().chain([&mut data.face_vertices]) {
        *numbers = corners.iter().map(|&corner| numbers[corner]).collect();
    }
}
