//! What the host writes for the shaders, byte for byte as they read it.
//!
//! [`ViewData`] and [`ItemRecord`] are uniform blocks (`std140`) of 16-byte vectors, [`DrawConstants`] a push-constant block
//! (`std430`) of 4-byte scalars: for these the two rules agree with `repr(C)`. GLSL twin: `glsl/lib/draw/draw.glsl`.

use crate::constants::{KIND_MASK, KIND_SHIFT, VECTOR_FLAG};
use crate::gpu::MAX_OFFSET_ALIGNMENT;
use crate::renderer::options::{DisplacementMap, DrawItem, MeasuredFrom, View};
use crate::topology::PatchKind;
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
            viewport: crate::tessellator::viewport(&view_projection, viewport),
        }
    }
}

/// What shaders know of a draw item: a uniform block.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct ItemRecord {
    /// Rows of the object-to-world matrix.
    pub transform: [[f32; 4]; 3],
    /// Rows of its cofactor matrix, which turns normals.
    pub normal_transform: [[f32; 4]; 3],
    /// [`DrawItem::colors`].
    pub colours: [[f32; 4]; 4],
    /// [`DrawItem::words`].
    pub words: [u32; 4],
    /// Tessellation factor, or what its rule multiplies with.
    pub factor: f32,
    /// [`DrawItem::displacement`].
    pub displacement: [f32; 2],
    /// The longest way that a point is displaced.
    pub reach: f32,
    /// Segments of the uniform grid, if patches are drawn on one; else 0.
    pub segments: u32,
    pub unused: [u32; 3],
}

/// What changes from draw to draw of an item: push constants.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct DrawConstants {
    pub first_corner: u32,
    pub first_patch: u32,
    pub patches_per_instance: u32,
    pub flags: u32,
    /// Patches of an instance of the item, or tiles of them; 0 where it is drawn once.
    pub patches: u32,
    /// The word where the first instance is.
    pub first_word: u32,
    /// Words from one instance to the next.
    pub instance_stride: u32,
}

impl DrawConstants {
    /// With these flags, for no patches yet.
    pub(crate) fn new(flags: u32) -> Self {
        Self { flags, ..Self::zeroed() }
    }

    /// Has the draws be of a kind of patches.
    pub(crate) fn set_kind(&mut self, kind: PatchKind) {
        self.flags = self.flags & !(KIND_MASK << KIND_SHIFT) | (kind as u32) << KIND_SHIFT;
    }
}

const _: () = assert!(size_of::<ViewData>() == 192);
const _: () = assert!(std::mem::offset_of!(ItemRecord, colours) == 96);
const _: () = assert!(std::mem::offset_of!(ItemRecord, words) == 160);
const _: () = assert!(std::mem::offset_of!(ItemRecord, factor) == 176);
const _: () = assert!(size_of::<ItemRecord>() == 208);
// Every Vulkan device has at least 128 bytes of push constants: the rest is free.
const _: () = assert!(size_of::<DrawConstants>() == 28);
const _: () = assert!(PatchKind::ALL.len() == 4);

impl ItemRecord {
    /// Bytes from one record to the next: there is room for more.
    pub(crate) const STRIDE: u64 = (size_of::<Self>() as u64).next_multiple_of(MAX_OFFSET_ALIGNMENT);

    /// For an item that is not displaced, with a tessellation factor.
    pub(crate) fn new(transform: &[[f32; 4]; 4], colours: [[f32; 4]; 4], factor: f32) -> Self {
        let transform = Mat4::from_cols_array_2d(transform);
        let linear = Mat3::from_mat4(transform);
        let rows = [transform.row(0), transform.row(1), transform.row(2)];
        let [x, y, z] = [0, 1, 2].map(|i| linear.row(i));
        // A mirroring transform turns the faces inside out; their normals must go with them.
        let cofactors = [y.cross(z), z.cross(x), x.cross(y)];
        Self {
            transform: rows.map(Into::into),
            normal_transform: cofactors.map(|row| row.extend(0.0).into()),
            colours,
            factor,
            ..Self::zeroed()
        }
    }

    /// For an item of a model with this displacement map. `segments` are those of a uniform grid, or 0.
    pub(crate) fn of(item: &DrawItem, map: &DisplacementMap, factor: f32, segments: u32) -> Self {
        let [scale, bias] = item.displacement;
        let [low, high] = map.range.map(|value| (scale * value + bias).abs());
        // Vectors reach to the corner of a cube. Rounded up.
        let reach = low.max(high) * if map.vectors { 3f32.sqrt() } else { 1.0 } * 1.000_01;
        Self {
            words: item.words,
            displacement: item.displacement,
            reach,
            segments,
            ..Self::new(&item.transform, item.colors, factor)
        }
    }
}

/// The bits of a draw's flags that its displacement map takes.
pub(crate) fn displacement_flags(map: &DisplacementMap) -> u32 {
    if map.vectors { VECTOR_FLAG } else { 0 }
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
        let record = ItemRecord::new(&transform.to_cols_array_2d(), [[1.0; 4]; 4], 9.0);
        let apply = |rows: &[[f32; 4]; 3], v: Vec4| Vec3::from(rows.map(|row| Vec4::from(row).dot(v)));
        let (a, b) = (Vec3::new(1.0, 2.0, 0.5), Vec3::new(-1.0, 0.3, 2.0));
        let turn = |v: Vec3| apply(&record.transform, v.extend(0.0));
        let normal = apply(&record.normal_transform, a.cross(b).extend(0.0));
        assert!(normal.dot(turn(a)).abs() < 1e-4 && normal.dot(turn(b)).abs() < 1e-4);
        // It is the cross product of the turned tangents itself, so it points out where the faces do.
        assert!((normal - turn(a).cross(turn(b))).length() < 1e-4);
        let moved = apply(&record.transform, a.extend(1.0));
        assert!((moved - transform.transform_point3(a)).length() < 1e-5);
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
