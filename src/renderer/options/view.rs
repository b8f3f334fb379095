//! Where the eye is.

use glam::camera::rh::{proj::vulkan, view};
use glam::{DVec3, Mat3, Vec3};

/// A camera and a light. Matrices are given by columns, as `glam::Mat4::to_cols_array_2d` gives them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// From world space to Vulkan's clip space: y down, depth from 0 to 1.
    pub view_projection: [[f32; 4]; 4],
    /// The eye in world space.
    pub eye: [f32; 3],
    /// Towards the light, in world space; any length but zero.
    pub light: [f32; 3],
    /// Width and height of the viewport in pixels, for factors in pixels ([`Factor`](crate::renderer::Factor)) and for leaving out
    /// small patches; zeros if it is not known. What is not a finite number above 0 counts as not known.
    pub viewport: [f32; 2],
    /// Whether it shows a mirror image, as of a lake: then triangles wind the other way in the picture than in space, which
    /// [`Cull::back`](crate::renderer::Cull::back) has to know.
    pub mirrored: bool,
    /// The view that factors and culling go by, if not this one: such as the main view for its shadows, so that both have the same
    /// triangles (and then without culling), or a view that is looked at from outside.
    pub measured_from: Option<MeasuredFrom>,
}

/// Whether the size of a viewport is known.
pub(crate) fn is_size(viewport: [f32; 2]) -> bool {
    viewport.iter().all(|&side| side > 0.0 && side.is_finite())
}

/// A view by which factors and culling go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredFrom {
    /// As [`View::view_projection`].
    pub view_projection: [[f32; 4]; 4],
    /// As [`View::eye`].
    pub eye: [f32; 3],
    /// As [`View::viewport`].
    pub viewport: [f32; 2],
}

impl View {
    /// A perspective camera at `eye` that looks at `target`. `fov_y` is the full vertical angle in radians, `aspect` width by
    /// height, above 0; the light comes from above the left shoulder.
    pub fn perspective(
        eye: [f32; 3],
        target: [f32; 3],
        up: [f32; 3],
        fov_y: f32,
        aspect: f32,
        [near, far]: [f32; 2],
    ) -> Self {
        let (eye, target) = (Vec3::from(eye), Vec3::from(target));
        let view = view::look_at_mat4(eye, target, up.into());
        let projection = vulkan::perspective(fov_y, aspect, near, far);
        let light = view.inverse().transform_vector3(Vec3::new(-0.45, 0.8, 0.65));
        Self {
            view_projection: (projection * view).to_cols_array_2d(),
            eye: eye.into(),
            light: light.normalize_or(Vec3::Y).into(),
            viewport: [0.0; 2],
            mirrored: false,
            measured_from: None,
        }
    }

    /// The same view, with factors and culling as in another.
    pub fn measured_from(self, other: &View) -> Self {
        Self { measured_from: Some(other.measured()), ..self }
    }

    /// What factors and culling go by.
    pub(crate) fn measured(&self) -> MeasuredFrom {
        let Self { view_projection, eye, viewport, .. } = *self;
        self.measured_from.unwrap_or(MeasuredFrom { view_projection, eye, viewport })
    }

    /// The same view, drawn this many pixels wide and high.
    pub fn sized(self, width: u32, height: u32) -> Self {
        Self { viewport: [width as f32, height as f32], ..self }
    }

    /// A camera that sees all of a box. `towards` leads from the box to the eye; `aspect` is width by height, and taken as 1 if it
    /// is not a finite number above 0, as of a window without pixels.
    pub fn framing(bounds: [impl Into<DVec3>; 2], towards: [f32; 3], aspect: f32) -> Self {
        const FOV_Y: f32 = 0.6;
        let aspect = if aspect > 0.0 && aspect.is_finite() { aspect } else { 1.0 };
        let [low, high] = bounds.map(|corner| corner.into().as_vec3());
        let centre = (low + high) / 2.0;
        let radius = ((high - low).length() / 2.0).max(f32::MIN_POSITIVE.sqrt());
        let towards = Vec3::from(towards).normalize_or(Vec3::Z);
        let up = if towards.cross(Vec3::Y).length_squared() > 1e-6 { Vec3::Y } else { Vec3::NEG_Z };
        // The eight corners decide, not the sphere around them: boxes fill the picture better.
        let view: Mat3 = view::look_to_mat3(-towards, up);
        let (tan_y, tan_x) = ((FOV_Y / 2.0).tan(), (FOV_Y / 2.0).tan() * aspect);
        let half = (high - low) / 2.0;
        let mut distance = 0.0f32;
        for corner in 0..8 {
            let sign = |bit: u32| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let at = view * (half * Vec3::new(sign(0), sign(1), sign(2)));
            distance = distance.max(at.z + (at.x.abs() / tan_x).max(at.y.abs() / tan_y));
        }
        let distance = distance * 1.04;
        let near = (distance - radius).max(radius * 1e-3);
        let eye = centre + towards * distance;
        Self::perspective(
            eye.into(),
            centre.into(),
            up.into(),
            FOV_Y,
            aspect,
            [near * 0.98, (distance + radius) * 1.02],
        )
    }
}
