//! Patches that cannot be seen. All tests are conservative: a picture is the same with and without.

use super::MeasuredDraw;
use super::draw::unit;
use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

/// What a corner's control points say of the patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Examined {
    /// A bit for each plane that all of them are beyond: x, y below and above, near, far.
    pub outside: u32,
    /// The least and the largest x and y.
    pub pixel_box: Vec4,
    /// Whether any may be beyond any plane.
    pub crosses: bool,
}

const FAR: f32 = 1e30;

/// The control points of a corner that, with those of the others, enclose the patch; none if they do not.
///
/// GLSL twin: `HULL` in `glsl/lib/edges/culling.glsl`.
fn hull(owned: &[Vec3]) -> &[Vec3] {
    match owned.len() {
        // Of ACC patches the others are tangents.
        8 => &owned[..4],
        // The spokes of Pm-patches may leave the hull of what corners own.
        6 => &[],
        _ => owned,
    }
}

/// Whether no pixel's centre lies within a box.
///
/// GLSL twin: `between_pixels` in `glsl/lib/edges/culling.glsl`.
fn between_pixels(pixel_box: Vec4) -> bool {
    // Vertices are moved to a grid of 1/256 of a pixel, or finer.
    const SNAP: f32 = 1.0 / 128.0;
    let (low, high) = ((pixel_box.xy() - 0.5 - SNAP).ceil(), (pixel_box.zw() - 0.5 + SNAP).floor());
    low.x > high.x || low.y > high.y
}

/// The length of a vector across the view, seen in any direction that leans by `lean` at most.
///
/// GLSL twin: `extent` in `glsl/lib/edges/culling.glsl`.
fn extent(d: Vec3, lean: f32) -> f32 {
    d.truncate().length() + lean * d.z.abs()
}

/// A tangent as the eye sees it: across the view, its length there, and its length with all that is not known of it.
///
/// GLSL twin: `tangent` in `glsl/lib/edges/culling.glsl`.
fn tangent(d: Vec3, lean: f32, moved: f32) -> Vec4 {
    Vec4::new(d.x, d.y, d.truncate().length(), extent(d, lean) + moved)
}

/// One row of the differences along u, times their binomial coefficients.
///
/// GLSL twin: `along_u` in `glsl/lib/edges/culling.glsl`.
fn along_u(row: &[Vec3; 4], lean: f32, moved: Vec3) -> [Vec4; 3] {
    [
        tangent(row[1] - row[0], lean, moved.x),
        2.0 * tangent(row[2] - row[1], lean, moved.y),
        tangent(row[3] - row[2], lean, moved.z),
    ]
}

/// A difference along v, so that the dot product with one along u is at least what du x dv has towards the eye.
///
/// GLSL twin: `turned` in `glsl/lib/edges/culling.glsl`.
fn turned(d: Vec3, lean: f32, moved: f32) -> Vec4 {
    let t = tangent(d, lean, moved);
    Vec4::new(t.y, -t.x, -t.z, t.w)
}

/// The differences between two rows of points, times their binomial coefficients.
///
/// GLSL twin: `along_v` in `glsl/lib/edges/culling.glsl`.
fn along_v(row: &[Vec3; 4], next: &[Vec3; 4], lean: f32, moved: Vec4) -> [Vec4; 4] {
    [0, 1, 2, 3].map(|i| [1.0, 3.0, 3.0, 1.0][i] * turned(next[i] - row[i], lean, moved[i]))
}

/// How much the differences along u change from one row of points to the next, which is also how much those along v do.
///
/// GLSL twin: `twist` in `glsl/lib/edges/culling.glsl`.
fn twist(row: &[Vec3; 4], next: &[Vec3; 4], lean: f32) -> Vec3 {
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| next[i] - row[i]);
    Vec3::new(extent(b - a, lean), extent(c - b, lean), extent(d - c, lean))
}

/// Three coefficients as four.
///
/// GLSL twin: `elevated` in `glsl/lib/edges/culling.glsl`.
fn elevated(t: Vec3) -> Vec4 {
    Vec4::new(t.x, (t.x + 2.0 * t.y) / 3.0, (2.0 * t.y + t.z) / 3.0, t.z)
}

/// The products of differences along v and along u: the summands of coefficient i + k in column i, row k.
fn products(v: &[Vec4; 4], u: &[Vec4; 3]) -> [Vec4; 3] {
    u.map(|u| Vec4::from(v.map(|v| v.dot(u))))
}

fn sum(terms: &[(&[Vec4; 4], &[Vec4; 3])]) -> [Vec4; 3] {
    let add = |a: [Vec4; 3], b: [Vec4; 3]| [0, 1, 2].map(|i| a[i] + b[i]);
    terms.iter().map(|(v, u)| products(v, u)).fold([Vec4::ZERO; 3], add)
}

/// Whether all coefficients of one row are below zero; the summands of coefficient i + k are in column i, row k.
///
/// GLSL twin: `below_zero` in `glsl/lib/edges/culling.glsl`.
fn below_zero(q: [Vec4; 3]) -> bool {
    let ends = q[0].x.max(q[2].w);
    let beside = (q[0].y + q[1].x).max(q[1].w + q[2].z);
    let middle = (q[0].z + q[1].y + q[2].x).max(q[0].w + q[1].z + q[2].y);
    ends.max(beside.max(middle)) < 0.0
}

impl MeasuredDraw {
    /// What the control points of a corner say of the patch.
    ///
    /// GLSL twin: `examine` in `glsl/lib/edges/culling.glsl`.
    pub fn examine(&self, owned: &[Vec3]) -> Examined {
        let mut pixel_box = Vec4::new(FAR, FAR, -FAR, -FAR);
        if !self.cull.frustum && !self.cull.small {
            return Examined { outside: 0, pixel_box, crosses: false };
        }
        // How far before each plane the foremost point is, and the hindmost, in clip space: w + x, w + y, w - x, w - y; z, w - z.
        let (mut sides, mut hind_sides) = (Vec4::splat(-FAR), Vec4::splat(FAR));
        let (mut depths, mut hind_depths) = (Vec2::splat(-FAR), Vec2::splat(FAR));
        for &point in hull(owned) {
            let clip = self.to_clip(point);
            let before_sides = clip.w + Vec4::new(clip.x, clip.y, -clip.x, -clip.y);
            let before_depths = Vec2::new(clip.z, clip.w - clip.z);
            sides = sides.max(before_sides);
            depths = depths.max(before_depths);
            hind_sides = hind_sides.min(before_sides);
            hind_depths = hind_depths.min(before_depths);
            if self.cull.small {
                let pixels = (0.5 + 0.5 * clip.xy() / clip.w) * self.size();
                let (low, high) = (pixel_box.xy().min(pixels), pixel_box.zw().max(pixels));
                pixel_box = Vec4::new(low.x, low.y, high.x, high.y);
                if clip.w.partial_cmp(&self.viewport.z) != Some(std::cmp::Ordering::Greater) {
                    // Not all of it is before the eye: as large as the picture.
                    pixel_box = Vec4::new(-FAR, -FAR, FAR, FAR);
                }
            }
        }
        let [x, y, z, w] = [0, 1, 2, 3].map(|i| self.clip_row(i).xyz());
        let margin = self.reach();
        let side_margins = margin * Vec4::from([w + x, w + y, w - x, w - y].map(Vec3::length));
        let depth_margins = margin * Vec2::new(z.length(), (w - z).length());
        let beyond_sides = (sides + side_margins).cmplt(Vec4::ZERO).bitmask();
        let beyond_depths = (depths + depth_margins).cmplt(Vec2::ZERO).bitmask();
        let within = hind_sides.cmpgt(side_margins).all() && hind_depths.cmpgt(depth_margins).all();
        Examined { outside: beyond_sides | beyond_depths << 4, pixel_box, crosses: !within }
    }

    /// Whether all triangles of a quad patch face away from the eye, whose legs are at most `step` long in u and v: see the twin
    /// for why.
    ///
    /// GLSL twin: `faces_away` in `glsl/lib/edges/culling.glsl`.
    pub fn faces_away(&self, owned: &[Vec<Vec3>], step: f32) -> bool {
        let w = self.clip_row(3).xyz();
        // Displacement turns normals as it likes; a parallel projection has no eye.
        if self.reach() > 0.0 || w.dot(w) == 0.0 {
            return false;
        }
        let centre = 0.25 * ((owned[0][0] + owned[1][0]) + (owned[2][0] + owned[3][0]));
        let to_eye = self.eye - self.to_world(centre);
        let away = to_eye.length();
        let axes = self.axes(to_eye / away);
        let seen = |k: usize, i: usize| {
            let d = owned[k][i] - centre;
            Vec3::from(axes.map(|axis| d.dot(axis)))
        };
        let mut p = [
            [seen(0, 0), seen(0, 1), seen(1, 2), seen(1, 0)],
            [seen(0, 2), seen(0, 3), seen(1, 3), seen(1, 1)],
            [seen(3, 1), seen(3, 3), seen(2, 3), seen(2, 2)],
            [seen(3, 0), seen(3, 2), seen(2, 1), seen(2, 0)],
        ];
        let mut squared = p.as_flattened().iter().map(|p| p.dot(*p)).fold(0.0, f32::max);
        // Half of the way that the face point of a Gregory patch moves at each corner.
        let mut half_way = [Vec3::ZERO; 4];
        if owned[0].len() == 5 {
            for (k, [row, column]) in [[1, 1], [1, 2], [2, 2], [2, 1]].into_iter().enumerate() {
                let other = seen(k, 4);
                half_way[k] = 0.5 * (other - p[row][column]);
                squared = squared.max(other.dot(other));
                p[row][column] += half_way[k];
            }
        }
        let size = squared.sqrt();
        // The eye is outside of the sphere around all of them.
        if size.partial_cmp(&away) != Some(std::cmp::Ordering::Less) {
            return false;
        }
        let lean = size / (away - size);
        let moved = half_way.map(|half_way| extent(half_way, lean));
        all_below_zero(&p, moved.into(), lean, step)
    }

    /// The axes of the eye's space in object space, its z axis towards the eye along `z`.
    fn axes(&self, z: Vec3) -> [Vec3; 3] {
        let x = unit(if z.x.abs() < 0.6 { Vec3::new(0.0, z.z, -z.y) } else { Vec3::new(-z.z, 0.0, z.x) });
        // Where it is the others that are culled, cross products are seen in a mirror.
        let y = if self.counter_clockwise { x.cross(z) } else { z.cross(x) };
        let rows = self.transform.map(|row| row.xyz());
        [x, y, z].map(|axis| rows[0] * axis.x + rows[1] * axis.y + rows[2] * axis.z)
    }

    /// Whether a patch can be culled, whose triangles are `step` long in its parameters at most. `owned` are the control points
    /// of each corner.
    ///
    /// GLSL twin: `is_culled` in `glsl/lib/edges/culling.glsl`.
    pub fn is_culled(&self, owned: &[Vec<Vec3>], step: f32) -> bool {
        if hull(&owned[0]).is_empty() {
            return false;
        }
        let mut beyond = u32::MAX;
        let (mut low, mut high) = (Vec2::splat(FAR), Vec2::splat(-FAR));
        for examined in owned.iter().map(|owned| self.examine(owned)) {
            beyond &= examined.outside;
            low = low.min(examined.pixel_box.xy());
            high = high.max(examined.pixel_box.zw());
        }
        let small = || self.reach() == 0.0 && between_pixels(Vec4::new(low.x, low.y, high.x, high.y));
        self.cull.frustum && beyond != 0
            || self.cull.small && small()
            || self.cull.back && owned.len() == 4 && self.faces_away(owned, step)
    }
}

/// Whether all coefficients of the normals of a patch are below zero, whose points in the eye's space are these, row by row.
fn all_below_zero(p: &[[Vec3; 4]; 4], moved: Vec4, lean: f32, step: f32) -> bool {
    let [t0, t1, t2] = [0, 1, 2].map(|i| 1.5 * step * twist(&p[i], &p[i + 1], lean));
    let moved1 = Vec3::new(1.5 * moved.x, moved.x + moved.y, 1.5 * moved.y) + (t0 + 2.0 * t1) / 3.0;
    let moved2 = Vec3::new(1.5 * moved.w, moved.w + moved.z, 1.5 * moved.z) + (2.0 * t1 + t2) / 3.0;
    let u0 = along_u(&p[0], lean, t0);
    let u1 = along_u(&p[1], lean, moved1).map(|u| 3.0 * u);
    let u2 = along_u(&p[2], lean, moved2).map(|u| 3.0 * u);
    let u3 = along_u(&p[3], lean, t2);
    let inner = |x: f32, y: f32, scale: f32| Vec4::new(0.0, scale * x, scale * y, 0.0);
    let v0 = along_v(&p[0], &p[1], lean, inner(moved.x, moved.y, 1.5) + elevated(t0));
    let v1 =
        along_v(&p[1], &p[2], lean, inner(moved.x + moved.w, moved.y + moved.z, 1.0) + elevated(t1)).map(|v| 2.0 * v);
    let v2 = along_v(&p[2], &p[3], lean, inner(moved.w, moved.z, 1.5) + elevated(t2));
    below_zero(sum(&[(&v0, &u0)]))
        && below_zero(sum(&[(&v0, &u1), (&v1, &u0)]))
        && below_zero(sum(&[(&v0, &u2), (&v1, &u1), (&v2, &u0)]))
        && below_zero(sum(&[(&v0, &u3), (&v1, &u2), (&v2, &u1)]))
        && below_zero(sum(&[(&v1, &u3), (&v2, &u2)]))
        && below_zero(sum(&[(&v2, &u3)]))
}
