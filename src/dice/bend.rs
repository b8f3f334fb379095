//! How far B-spline patches are from faces with points of them.

use super::strays::Bilinear;
use glam::DVec3;

/// Four B-spline control points of a curve become five of its halves.
fn halve(p: [DVec3; 4]) -> [DVec3; 5] {
    let middle = |i: usize| 0.5 * (p[i] + p[i + 1]);
    let corner = |i: usize| 0.125 * (p[i - 1] + 6.0 * p[i] + p[i + 1]);
    [middle(0), corner(1), middle(1), corner(2), middle(2)]
}

/// The control points of the quarters of a B-spline patch.
pub(super) fn quarters(points: &[DVec3; 16]) -> [[DVec3; 16]; 4] {
    let along_v: [[DVec3; 5]; 4] = std::array::from_fn(|i| halve(std::array::from_fn(|j| points[4 * i + j])));
    let along_u: [[DVec3; 5]; 5] = std::array::from_fn(|j| halve(std::array::from_fn(|i| along_v[i][j])));
    [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| std::array::from_fn(|k| along_u[j + k % 4][i + k / 4]))
}

/// The distance between a B-spline patch that is halved `depth` times and the faces of its cells, by second differences of its
/// control points: along the normals of such faces if these are known well enough, else altogether.
pub(super) fn bend(points: &[DVec3; 16], depth: u32, splits: u32) -> f64 {
    if depth > 0 && splits > 0 {
        return quarters(points).iter().map(|quarter| bend(quarter, depth - 1, splits - 1)).fold(0.0, f64::max);
    }
    let at = |i: usize, j: usize| points[4 * i + j];
    if depth == 0 {
        let mut parts = Vec::new();
        push_second(points, splits.min(SECOND_SPLITS), &mut parts);
        let distance = greatest(&parts, &|difference| [difference.length(); 2]);
        let along_u = |i: usize, j: usize| at(i, j) + 4.0 * at(i + 1, j) + at(i + 2, j);
        let corner = |[i, j]: [usize; 2]| (along_u(i, j) + 4.0 * along_u(i, j + 1) + along_u(i, j + 2)) / 36.0;
        let flat = Bilinear::new([[0, 0], [1, 0], [1, 1], [0, 1]].map(corner));
        let lean = flat.lean;
        let heights = greatest(&parts, &|d| [1.0, -1.0].map(|side| side * flat.height(d) + lean * d.length()));
        let side = |i: usize, j: usize| at(i + 2, j) - at(i, j);
        let across = |i: usize, j: usize| at(i, j + 2) - at(i, j);
        let normals = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| {
            let along = side(i, j) + 4.0 * side(i, j + 1) + side(i, j + 2);
            along.cross(across(i, j) + 4.0 * across(i + 1, j) + across(i + 2, j))
        });
        return distance.min(heights / flat.cosine(normals));
    }
    let parts = [Second::new(points, 1.0)];
    let distance = greatest(&parts, &|difference| [difference.length(); 2]);
    let along_normals = |cone: Cone| {
        // What is along an axis is less along normals, whichever side it is on.
        let sides = |d: DVec3| [1.0, -1.0].map(|side| (side * d.dot(cone.axis)) + cone.sine * d.length());
        greatest(&parts, &sides) / (1.0 - cone.sine * cone.sine).sqrt()
    };
    Cone::new(points).map_or(distance, |cone| distance.min(along_normals(cone))) / f64::from(1 << (2 * depth))
}

/// How often a patch that is one face is split to know its second differences better.
const SECOND_SPLITS: u32 = 2;

/// Second differences of the control points of a B-spline patch: along u, along both, along v.
struct Second {
    uu: [DVec3; 8],
    uv: [DVec3; 9],
    vv: [DVec3; 8],
}

impl Second {
    /// Times so much.
    fn new(points: &[DVec3; 16], scale: f64) -> Self {
        let at = |i: usize, j: usize| scale * points[4 * i + j];
        Self {
            uu: std::array::from_fn(|k| [k / 2, k % 2]).map(|[i, j]| at(j, i) - 2.0 * at(j + 1, i) + at(j + 2, i)),
            uv: std::array::from_fn(|k| [k / 3, k % 3])
                .map(|[i, j]| at(i, j) - at(i + 1, j) - at(i, j + 1) + at(i + 1, j + 1)),
            vv: std::array::from_fn(|k| [k / 2, k % 2]).map(|[i, j]| at(i, j) - 2.0 * at(i, j + 1) + at(i, j + 2)),
        }
    }
}

/// Second differences of a patch, from those of its parts after it was split so often.
fn push_second(points: &[DVec3; 16], splits: u32, parts: &mut Vec<Second>) {
    fn push(points: &[DVec3; 16], (scale, splits): (f64, u32), parts: &mut Vec<Second>) {
        match splits {
            0 => parts.push(Second::new(points, scale)),
            _ => quarters(points).iter().for_each(|quarter| push(quarter, (4.0 * scale, splits - 1), parts)),
        }
    }
    push(points, (1.0, splits), parts);
}

/// How far a patch is from faces between points of it, on one side or the other, by second differences of all its parts: `sides` tells
/// what a difference counts on each.
///
/// With weights w of a face's corners, which are (x, y) off, the distance is at most half the sum of `w (uu x^2 + 2 uv x y + vv y^2)`;
/// and the sums of `w x^2` and `w y^2` are a quarter at most, as the sums of `w x` and `w y` are zero within a unit square.
fn greatest(parts: &[Second], sides: &impl Fn(DVec3) -> [f64; 2]) -> f64 {
    let [mut uu, mut uv, mut vv] = [[f64::NEG_INFINITY; 2]; 3];
    let raise = |most: &mut [f64; 2], differences: &[DVec3]| {
        for &difference in differences {
            most.iter_mut().zip(sides(difference)).for_each(|(most, side)| *most = most.max(side));
        }
    };
    for part in parts {
        raise(&mut uu, &part.uu);
        raise(&mut uv, &part.uv);
        raise(&mut vv, &part.vv);
    }
    let of_side = |side: usize| most_of_form(uu[side], uv[0].max(uv[1]), vv[side]) / 8.0;
    of_side(0).max(of_side(1))
}

/// The greatest of `a x^2 + 2 b x y + c y^2` for x and y from 0 to 1, with b not below zero.
fn most_of_form(a: f64, b: f64, c: f64) -> f64 {
    // Greatest where x or y is 1, or both are 0.
    let along = |a: f64, c: f64| {
        let y = if b + c >= 0.0 { 1.0 } else { b / -c };
        a + (2.0 * b + c * y) * y
    };
    along(a, c).max(along(c, a)).max(0.0)
}

/// All normals of a patch, and of faces with points of it.
struct Cone {
    axis: DVec3,
    /// Of the greatest angle to the axis.
    sine: f64,
}

impl Cone {
    /// Tangents are sums of first differences of control points with weights above zero, so normals are of their cross products.
    /// `None` if these are not all on one side.
    fn new(points: &[DVec3; 16]) -> Option<Self> {
        let at = |i: usize, j: usize| points[4 * i + j];
        let mut along = [[DVec3::ZERO; 2]; 12];
        for i in 0..3 {
            for j in 0..4 {
                along[4 * i + j] = [at(i + 1, j) - at(i, j), at(j, i + 1) - at(j, i)];
            }
        }
        let axis = (at(2, 2) - at(1, 1)).cross(at(1, 2) - at(2, 1)).try_normalize()?;
        let mut least_cosine = 1.0f64;
        for [du, _] in along {
            for [_, dv] in along {
                least_cosine = least_cosine.min(du.cross(dv).normalize_or_zero().dot(axis));
            }
        }
        let is_narrow = least_cosine > 0.0;
        is_narrow.then(|| Self { axis, sine: (1.0 - least_cosine * least_cosine).max(0.0).sqrt() })
    }
}
