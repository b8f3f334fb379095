//! Weights of a bicubic patch across a crease (Niessner, Loop, Greiner 2012; patch_maths F).

type Weights = [f64; 4];
type Matrix = [[f64; 4]; 4];

/// The points of an infinitely sharp crease at P2: that beyond it is mirrored.
const INFINITE: Matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 2.0, 0.0]];

/// The uniform cubic B-spline basis at t, and its derivative.
pub(super) fn spline(t: f64) -> [Weights; 2] {
    let s = 1.0 - t;
    let (t2, s2) = (t * t, s * s);
    let value = [s * s2, 4.0 + t2 * (3.0 * t - 6.0), 4.0 + s2 * (3.0 * s - 6.0), t * t2];
    let slope = [-s2, t * (3.0 * t - 4.0), s * (4.0 - 3.0 * s), t2];
    [value.map(|w| w / 6.0), slope.map(|w| w / 2.0)]
}

/// Those of a curve with a crease of finite sharpness at P2, where t = 1.
pub(super) fn creased_spline(t: f64, sharpness: f64) -> [Weights; 2] {
    let floor = sharpness.floor();
    let part = sharpness - floor;
    let start = |s: f64| 1.0 - (-s).exp2();
    let matrix = if t <= start(floor) {
        INFINITE
    } else if t <= start(floor + 1.0) {
        mix(1.0 - part, &after(floor), part, &INFINITE)
    } else {
        mix(1.0 - part, &after(floor), part, &after(floor + 1.0))
    };
    spline(t).map(|basis| std::array::from_fn(|j| (0..4).map(|i| basis[i] * matrix[i][j]).sum()))
}

fn mix(a: f64, of_a: &Matrix, b: f64, of_b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a * of_a[i][j] + b * of_b[i][j]))
}

/// What refining s times with the rules of a crease, and back with those of a smooth surface, does: the control points next
/// to the crease.
fn after(s: f64) -> Matrix {
    let sigma = s.exp2();
    let square = sigma * sigma;
    let six = 6.0 * sigma;
    let k = (1.0 - sigma) / six;
    let first = k * (6.0 * square - 5.0 * sigma + 1.0);
    let side = (2.0 * square + 3.0 * sigma + 1.0) / six;
    let (near, far) = (k * (4.0 * sigma - 2.0), k * (1.0 - 2.0 * sigma));
    let (beside, middle) = (k * (sigma + 1.0), (2.0 * square + 6.0 * sigma - 2.0) / six);
    [[1.0, first, -2.0 * first, first], [0.0, side, near, far], [0.0, beside, middle, beside], [0.0, far, near, side]]
}
