//! A draw as factors and culling see it.

use super::{Cull, Factor};
use glam::{Mat4, Vec2, Vec3, Vec3Swizzles, Vec4, Vec4Swizzles};

/// The view and the draw by which patches are tessellated and culled.
///
/// GLSL twin: `View` and `Draw` in `glsl/lib/draw/draw.glsl`.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredDraw {
    /// World space to clip space.
    pub view_projection: Mat4,
    /// World space.
    pub eye: Vec3,
    /// As [`viewport`] gives it.
    pub viewport: Vec4,
    /// Rows of the object-to-world matrix.
    pub transform: [Vec4; 3],
    /// The factors.
    pub factor: Factor,
    /// The largest factor of the device.
    pub max_factor: f32,
    /// Culled patches.
    pub cull: Cull,
    /// Whether counter-clockwise triangles face away.
    pub counter_clockwise: bool,
    /// The largest distance that displacement moves a point in object space, as half-precision number.
    pub displacement: f32,
}

impl MeasuredDraw {
    /// A draw in world space without culling or displacement. `view_projection` is given by columns, `size` is that of the
    /// viewport in pixels.
    pub fn new(view_projection: &[[f32; 4]; 4], eye: [f32; 3], size: [f32; 2], factor: Factor) -> Self {
        Self {
            view_projection: Mat4::from_cols_array_2d(view_projection),
            eye: eye.into(),
            viewport: viewport(view_projection, size).into(),
            transform: [Vec4::X, Vec4::Y, Vec4::Z],
            factor,
            max_factor: 64.0,
            cull: Cull::NONE,
            counter_clockwise: false,
            displacement: 0.0,
        }
    }

    pub(super) fn draw_factor(&self) -> f32 {
        self.factor.value()
    }

    /// GLSL twin: `to_world` in `glsl/lib/draw/draw.glsl`.
    pub(super) fn to_world(&self, position: Vec3) -> Vec3 {
        let [x, y, z] = self.transform;
        Vec3::new(exact_row(x, position), exact_row(y, position), exact_row(z, position))
    }

    /// Clip space of the view that is measured.
    pub(super) fn to_clip(&self, position: Vec3) -> Vec4 {
        let m = self.view_projection;
        let world = self.to_world(position);
        ((m.w_axis + m.z_axis * world.z) + m.y_axis * world.y) + m.x_axis * world.x
    }

    /// x, y in pixels and the distance from the eye's plane. What is behind the eye counts as just before it.
    ///
    /// GLSL twin: `to_pixels` in `glsl/lib/edges/factors.glsl`.
    pub(super) fn to_pixels(&self, position: Vec3) -> Vec3 {
        let clip = self.to_clip(position);
        let w = clip.w.max(self.viewport.z);
        (0.5 * self.viewport.xy() * (clip.xy() / w)).extend(w)
    }

    /// The largest distance that displacement moves a point, in world space.
    ///
    /// GLSL twin: `reach` in `glsl/lib/edges/culling.glsl`.
    pub(super) fn reach(&self) -> f32 {
        let squared = self.transform.map(|row| exact_dot(row.xyz(), row.xyz()));
        (squared[0] + squared[1] + squared[2]).sqrt() * self.displacement
    }

    /// GLSL twin: `clip_row` in `glsl/lib/edges/culling.glsl`.
    pub(super) fn clip_row(&self, i: usize) -> Vec4 {
        self.view_projection.row(i)
    }

    pub(super) fn size(&self) -> Vec2 {
        self.viewport.xy()
    }
}

/// GLSL twin: `exact_row` in `glsl/lib/draw/draw.glsl`.
fn exact_row(row: Vec4, x: Vec3) -> f32 {
    ((row.w + row.z * x.z) + row.y * x.y) + row.x * x.x
}

/// GLSL twin: `exact_dot` in `glsl/lib/evaluate/patch.glsl`.
pub(super) fn exact_dot(a: Vec3, b: Vec3) -> f32 {
    (a.x * b.x + a.y * b.y) + a.z * b.z
}

/// GLSL twin: `exact_cross` in `glsl/lib/evaluate/patch.glsl`.
pub(super) fn exact_cross(a: Vec3, b: Vec3) -> Vec3 {
    a.yzx() * b.zxy() - a.zxy() * b.yzx()
}

/// A vector made one long, unless it is zero.
///
/// GLSL twin: `unit` in `glsl/lib/evaluate/patch.glsl`.
pub(super) fn unit(x: Vec3) -> Vec3 {
    let squared = exact_dot(x, x);
    if squared > 0.0 { x * squared.sqrt().recip() } else { x }
}

/// Width and height of a viewport, the least distance of what is seen in it, and what a length of one at a distance of one is of
/// half the height; of a view given by columns.
pub fn viewport(view_projection: &[[f32; 4]; 4], [width, height]: [f32; 2]) -> [f32; 4] {
    let rows = Mat4::from_cols_array_2d(view_projection).transpose();
    [width, height, nearest(rows), rows.y_axis.truncate().length()]
}

/// The least clip-space w of what is between the planes of depth 0 and 1; `rows` are those of the matrix.
fn nearest(rows: Mat4) -> f32 {
    let (depth, w) = (rows.z_axis, rows.w_axis);
    let squared = w.truncate().length_squared();
    if squared == 0.0 {
        // A parallel projection: w is the same everywhere.
        return w.w.max(f32::MIN_POSITIVE);
    }
    // On the way of the view: depth = a w + b.
    let a = depth.truncate().dot(w.truncate()) / squared;
    let b = depth.w - a * w.w;
    let planes = [-b / a, b / (1.0 - a)];
    planes.into_iter().filter(|w| w.is_finite() && *w > 0.0).fold(f32::INFINITY, f32::min).clamp(1e-20, 1e20)
}
