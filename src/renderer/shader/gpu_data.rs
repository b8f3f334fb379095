//! What the host writes for the shaders, byte for byte as they read it.
//!
//! [`ViewData`] is a uniform block (`std140`), [`DrawConstants`] a push-constant block (`std430`): both hold only
//! 16-byte vectors and trailing 4-byte scalars, for which the two rules agree with `repr(C)`. GLSL twin:
//! `glsl/lib/draw/draw.glsl`.

use crate::constants::{REACH_SHIFT, VECTOR_FLAG};
use crate::gpu::MAX_OFFSET_ALIGNMENT;
use crate::renderer::options::{DisplacementMap, MeasuredFrom, View};
use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Mat4, Vec3};

#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct ViewData {
    pub view_projection: [[f32; 4]; 4],
    pub eye: [f32; 4],
    pub light: [f32; 4],
    pub measured_view_projection: [[f32; 4]; 4],
    pub measured_eye: [f32; 4],
    pub viewport: [f32; 4],
}

impl ViewData {
    /// Bytes from one view to the next.
    pub(crate) const STRIDE: u64 = (size_of::<Self>() as u64).next_multiple_of(MAX_OFFSET_ALIGNMENT);

    /// What shaders know of a view.
    pub(crate) fn new(view: &View) -> Self {
        let [x, y, z] = view.eye;
        let light = Vec3::from(view.light).normalize_or(Vec3::Y);
        let MeasuredFrom { view_projection, eye: [eye_x, eye_y, eye_z], viewport } = view.measured();
        Self {
            view_projection: view.view_projection,
            eye: [x, y, z, 1.0],
            light: light.extend(0.0).into(),
            measured_view_projection: view_projection,
            measured_eye: [eye_x, eye_y, eye_z, 1.0],
            viewport: crate::tessellate::viewport(&view_projection, viewport),
        }
    }
}

#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct DrawConstants {
    /// Rows of the object-to-world matrix.
    pub transform: [[f32; 4]; 3],
    /// Rows of its cofactor matrix, which turns normals; in the last column the tessellation factor, and scale and bias of
    /// the displacement.
    pub normal_transform: [[f32; 4]; 3],
    pub colour: [f32; 4],
    pub first_corner: u32,
    pub first_patch: u32,
    pub patches_per_instance: u32,
    pub flags: u32,
}

/// The half-precision number next to `x` that is not below it, for `x` from 0 up.
pub(crate) fn half_not_below(x: f32) -> u16 {
    const SMALLEST_NORMAL: f32 = 1.0 / 16384.0;
    const LARGEST: f32 = 65504.0;
    if x <= 0.0 {
        0
    } else if x > LARGEST {
        0x7c00
    } else {
        // The exponent's bias goes from 127 to 15, and 13 bits of the fraction are rounded up.
        ((x.max(SMALLEST_NORMAL).to_bits() - ((127 - 15) << 23) + 0x1fff) >> 13) as u16
    }
}

/// How far a point is moved at most by a map under this scale and bias.
fn reach(map: &DisplacementMap, [scale, bias]: [f32; 2]) -> f32 {
    let [low, high] = map.range.map(|value| (scale * value + bias).abs());
    // The diagonal of a cube.
    low.max(high) * if map.vectors { 3f32.sqrt() } else { 1.0 }
}

/// The bits of a draw's flags that displacement takes.
pub(crate) fn displacement_flags(map: &DisplacementMap, displacement: [f32; 2]) -> u32 {
    let vectors = if map.vectors { VECTOR_FLAG } else { 0 };
    vectors | u32::from(half_not_below(reach(map, displacement))) << REACH_SHIFT
}

const _: () = assert!(size_of::<ViewData>() == 192);
const _: () = assert!(std::mem::offset_of!(DrawConstants, colour) == 96);
const _: () = assert!(std::mem::offset_of!(DrawConstants, first_corner) == 112);
// Every Vulkan device has at least 128 bytes of push constants.
const _: () = assert!(size_of::<DrawConstants>() == 128);

impl DrawConstants {
    /// For an object-to-world matrix given by columns, with a tessellation factor, and scale and bias of the displacement.
    pub(crate) fn new(transform: &[[f32; 4]; 4], [factor, scale, bias]: [f32; 3]) -> Self {
        let transform = Mat4::from_cols_array_2d(transform);
        let linear = Mat3::from_mat4(transform);
        let rows = [transform.row(0), transform.row(1), transform.row(2)];
        let [x, y, z] = [0, 1, 2].map(|i| linear.row(i));
        let cofactors: [Vec3; 3] = [y.cross(z), z.cross(x), x.cross(y)];
        // A mirroring transform turns the faces inside out; their normals must go with them.
        Self {
            transform: rows.map(Into::into),
            normal_transform: [
                cofactors[0].extend(factor).into(),
                cofactors[1].extend(scale).into(),
                cofactors[2].extend(bias).into(),
            ],
            ..Self::zeroed()
        }
    }

    pub(crate) fn factor(&self) -> f32 {
        self.normal_transform[0][3]
    }

    pub(crate) fn set_factor(&mut self, factor: f32) {
        self.normal_transform[0][3] = factor;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Quat, Vec4};

    #[test]
    fn normals_stay_normal_under_any_transform() {
        let transform = Mat4::from_scale_rotation_translation(
            Vec3::new(2.0, 0.5, -3.0),
            Quat::from_rotation_y(0.7) * Quat::from_rotation_x(0.3),
            Vec3::new(5.0, 6.0, 7.0),
        );
        let constants = DrawConstants::new(&transform.to_cols_array_2d(), [9.0, 0.5, 0.25]);
        let apply = |rows: &[[f32; 4]; 3], v: Vec4| Vec3::from(rows.map(|row| Vec4::from(row).dot(v)));
        let (a, b) = (Vec3::new(1.0, 2.0, 0.5), Vec3::new(-1.0, 0.3, 2.0));
        let turn = |v: Vec3| apply(&constants.transform, v.extend(0.0));
        let without_others = constants.normal_transform.map(|[x, y, z, _]| [x, y, z, 0.0]);
        let normal = apply(&without_others, a.cross(b).extend(0.0));
        assert!(normal.dot(turn(a)).abs() < 1e-4 && normal.dot(turn(b)).abs() < 1e-4);
        // It is the cross product of the turned tangents itself, so it points out where the faces do.
        assert!((normal - turn(a).cross(turn(b))).length() < 1e-4);
        assert_eq!(constants.normal_transform.map(|row| row[3]), [9.0, 0.5, 0.25]);
        let moved = apply(&constants.transform, a.extend(1.0));
        assert!((moved - transform.transform_point3(a)).length() < 1e-5);
    }

    #[test]
    fn halves_are_not_below() {
        let value = |half: u16| match half >> 10 {
            0 => 0.0,
            31 => f32::INFINITY,
            exponent => (1.0 + f32::from(half & 0x3ff) / 1024.0) * 2f32.powi(i32::from(exponent) - 15),
        };
        for x in [0.0, 1e-9, 6.2e-5, 0.03, 0.5, 0.500_01, 1.0, 3.3, 1000.3, 65504.0, 65505.0, 1e9] {
            let half = value(half_not_below(x));
            let normal = (1e-4..=65504.0).contains(&x);
            assert!(half >= x && (half <= x * 1.001 || !normal), "{x}: {half}");
        }
    }

    #[test]
    fn the_nearest_that_is_seen() {
        let view = View::perspective([1.0, 2.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0], 0.6, 1.5, [0.25, 40.0]);
        let [_, _, near, _] = ViewData::new(&view).viewport;
        assert!((near - 0.25).abs() < 1e-4, "{near}");
        let framing = |aspect| View::framing([DVec3::NEG_ONE, DVec3::ONE], [0.0, 0.0, 1.0], aspect);
        for aspect in [0.0, -2.0, f32::NAN, f32::INFINITY] {
            assert_eq!(framing(aspect), framing(1.0));
        }
        let parallel = Mat4::from_scale(Vec3::new(0.5, -0.5, 0.1)).to_cols_array_2d();
        assert_eq!(ViewData::new(&View { view_projection: parallel, ..view }).viewport[2], 1.0);
    }
}
