//! Gregory patches whose two free choices are fitted to the limit surface: the points and the evaluation of [`gregory`],
//! with other lengths of tangents and other transversals.
//!
//! Loop et al. 2009 (sections 3.2 and 3.4) leave both choices open. For G1, edge points around a vertex have to be `p +
//! s (e_j - p)` with one factor s, and the two faces at an edge have to see the same `r_j` with opposite signs; any s and
//! any `r_j` will do. Here, at a vertex inside the surface with n faces, of which a share t are triangles, and with
//! `c = cos(2 pi / n)`:
//!
//! * `s = 1 + tangent[0] c + tangent[1] c^2 + tangent[2] t`;
//! * `r'_j = r_j + k (r_j - w_j) + triangle T r_j`, `k = lift[0] c + lift[1] c^2`, where T is the number of triangles at
//!   the edge (0 to 2), and `w_j = (3/2) (e_{j+1} - e_{j-1})` is what `r_j` would be if the transversal stayed in the
//!   tangent plane.
//!
//! Among quads of valence 4 nothing changes, nor at boundaries, creases and corners: patches there keep their exact
//! neighbours and boundary curves.
//!
//! **What was fitted on what.** The six numbers of [`Fit::GREGORY`] minimise the angle between normals and the distance
//! along them, each against that of [`Scheme::Gregory`](super::Scheme::Gregory) on the same mesh, over small random
//! meshes of triangles and quads. No built-in shape and no model from elsewhere is among them. `cargo run --release
//! --example fit_gregory` fits again in two seconds.
//!
//! Measured as by `subdiv error`, root mean squares over all faces, as multiples of Gregory's:
//!
//! | | normals | nearest distance |
//! |---|---|---|
//! | training set (192 meshes; distance along the normal) | 0.953 | 0.933 |
//! | monster frog, bigguy | 0.82, 0.86 | 0.97, 0.90 |
//! | the same, refined once | 0.76, 0.78 | |
//! | OpenSubdiv's car, rook | 0.87, 1.01 | 0.90, 1.00 |
//! | built-in `creature`, `creature-mixed`, `valences` | 0.82, 0.79, 0.87 | 0.86, 0.72, 0.91 |
//! | built-in `polygons`, `cube`, `tetrahedron` | 1.04, 2.71, 0.57 | 1.52, 0.08, 0.27 |
//!
//! Normals are closer than those of every other scheme on the character meshes, the car and `valences`. Distances at the
//! same parameters grow, by 6 to 8 % on characters: points move within the surface.
//!
//! **What it is not good at.** Balls: on `polygons`, 1e-5 of the diagonal from the limit surface in any case, and `cube`
//! Gregory's normals are closer. The rook, whose narrow bevels are unlike the training set, gains nothing.
//!
//! **What did not generalise**, when fitted to the same meshes. Factors by pairs of valences, up to 29 numbers: no better
//! elsewhere than by the vertex's own. Weights of their own for the midpoints and centroids in `r_j`: up to 2 % worse
//! elsewhere. Cubes of c: 1 to 3 % worse on the frog and `valences`. Factors of their own for edges between two triangles: 7 %
//! worse on `creature-mixed`. (Tangents left as long as they were would lose a third of the gain on `creature`; the
//! transversal of the edge's other end would gain another 1 to 3 %, for twice the fetches.)
//!
//! [`gregory`]: super::gregory

use crate::blend::{Blend, Frame, RingShape, RingValues};
use crate::topology::RingKind;

/// The numbers that [`fitted`](self) patches are made with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Factors of the length of tangents: by c, by c^2, by the share of triangles.
    pub tangent: [f64; 3],
    /// How far the transversal is lifted off the tangent plane: by c, by c^2.
    pub lift: [f64; 2],
    /// How much longer the transversal is for each triangle at the edge.
    pub triangle: f64,
}

impl Fit {
    /// As `examples/fit_gregory.rs` finds them, to three decimals.
    pub const GREGORY: Self = Self { tangent: [0.026, -0.27, 0.085], lift: [0.198, 0.639], triangle: 0.383 };

    /// The factor of tangents around a vertex.
    fn tangent_factor(&self, shape: &RingShape) -> f64 {
        if shape.kind != RingKind::Smooth {
            return 1.0;
        }
        let cos = shape.cosine();
        let triangles = shape.triangles.iter().filter(|&&triangle| triangle).count();
        let share = triangles as f64 / shape.faces() as f64;
        let [linear, square, triangle] = self.tangent;
        1.0 + linear * cos + square * cos * cos + triangle * share
    }

    /// The weights of `r_j` and of `b cos(phi_j) - a sin(phi_j)` of the fitted frame in the transversal of edge `j`.
    pub fn transversal_weights(&self, shape: &RingShape, j: usize) -> [f64; 2] {
        if shape.kind != RingKind::Smooth {
            return [1.0, 0.0];
        }
        let faces = shape.faces();
        let [cos, sin] = shape.edge_direction(1);
        let triangles = [j, j + faces - 1].map(|i| f64::from(u8::from(shape.triangles[i % faces])));
        let lift = self.lift[0] * cos + self.lift[1] * cos * cos;
        // e_{j+1} - e_{j-1} is the tangent across edge j, twice the sine long.
        [1.0 + lift + self.triangle * (triangles[0] + triangles[1]), -3.0 * sin * lift]
    }
}

/// The limit point and the tangents, as long as fitted.
pub fn fitted_frame<T: Blend>(ring: &RingValues<T>, fit: &Fit) -> Frame<T> {
    let Frame { p, a, b } = ring.frame();
    let factor = fit.tangent_factor(&ring.shape);
    if factor == 1.0 {
        return Frame { p, a, b };
    }
    Frame { p, a: T::sum([(factor, &a)]), b: T::sum([(factor, &b)]) }
}

/// `r'_j` of a ring whose frame is its [`fitted_frame`].
///
/// GLSL twin: `scheme_transversal` in `glsl/lib/construct/rings.glsl`.
pub fn fitted_transversal<T: Blend>(ring: &RingValues<T>, frame: &Frame<T>, j: usize, fit: &Fit) -> T {
    let r = ring.transversal(j);
    let [along, across] = fit.transversal_weights(&ring.shape, j);
    let [cos, sin] = ring.shape.edge_direction(j);
    T::sum([(along, &r), (across * cos, &frame.b), (-across * sin, &frame.a)])
}
