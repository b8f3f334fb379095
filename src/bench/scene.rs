//! Scene of a picture: instances and view.

use super::drawable::{Frame, Pass};
use super::{BenchOptions, Camera, Subject};
use crate::renderer::View;
use glam::{DVec3, Mat4, Vec3};

/// Where the instances stand, and who looks at them.
pub(super) struct Scene {
    pub(super) camera: Camera,
    view: View,
    instances: Vec<[[f32; 4]; 4]>,
}

impl Scene {
    /// Side by side.
    pub(super) fn new(subject: &Subject, options: &BenchOptions, camera: Camera) -> Self {
        const APART: f64 = 1.1;
        let [low, high] = subject.mesh.bounds();
        let step = (high - low) * APART;
        let columns = f64::from(options.instances).sqrt().ceil() as u32;
        let rows = options.instances.div_ceil(columns);
        let place = |i: u32| DVec3::new(f64::from(i % columns), f64::from(i / columns), 0.0) * step;
        let offsets: Vec<DVec3> = (0..options.instances).map(place).collect();
        let far = DVec3::new(f64::from(columns - 1), f64::from(rows - 1), 0.0) * step;
        let [width, height] = options.size;
        let mut view = View::framing([low, high + far], [-0.5, 0.3, 1.0], width as f32 / height as f32);
        if camera == Camera::Clipped {
            let nearer = Mat4::from_scale(Vec3::new(3.0, 3.0, 1.0));
            view.view_projection = (nearer * Mat4::from_cols_array_2d(&view.view_projection)).to_cols_array_2d();
        }
        let instances = offsets.iter().map(|offset| Mat4::from_translation(offset.as_vec3()).to_cols_array_2d());
        Self { camera, view: view.sized(width, height), instances: instances.collect() }
    }

    pub(super) fn frame(&self, factor: f32, pass: Pass) -> Frame<'_> {
        Frame { view: &self.view, instances: &self.instances, factor, pass }
    }
}
