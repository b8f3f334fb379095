//! Where the picture is seen from.

use super::error::CliError;
use super::local::Local;
use super::parse;
use ash_subdiv::View;
use clap::Args;
use glam::{DMat3, DQuat, DVec2, DVec3};

/// The camera: either set up so that everything is in the picture, or placed by hand.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Camera")]
pub(super) struct CameraArgs {
    /// Turn the eye around the mesh: degrees from the front (+z), counter-clockwise seen from above.
    #[arg(long, value_name = "DEGREES", default_value_t = -32.0, allow_negative_numbers = true, value_parser = parse::angle)]
    yaw: f32,
    /// Lift the eye: degrees above the horizon.
    #[arg(long, value_name = "DEGREES", default_value_t = 20.0, allow_negative_numbers = true, value_parser = parse::angle)]
    pitch: f32,
    /// Come nearer: 2 fills twice the picture.
    #[arg(long, value_name = "TIMES", default_value_t = 1.0, value_parser = parse::positive)]
    zoom: f32,
    /// Place the eye by hand.
    #[arg(
        long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse::triple,
        conflicts_with_all = ["yaw", "pitch", "zoom"]
    )]
    eye: Option<DVec3>,
    /// Point that the eye looks at; the middle of the mesh if not given.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse::triple, requires = "eye")]
    target: Option<DVec3>,
    /// Direction that is up.
    #[arg(long, value_name = "X,Y,Z", default_value = "0,1,0", allow_hyphen_values = true, value_parser = parse::triple)]
    up: DVec3,
    /// The vertical angle of view, in degrees.
    #[arg(long, value_name = "DEGREES", default_value_t = 30.0, value_parser = parse::fov)]
    fov: f32,
}

impl CameraArgs {
    /// The same camera in local space.
    pub(super) fn in_space(&self, local: Local) -> Self {
        let place = |point: Option<DVec3>| point.map(|point| local.to_local(point));
        Self { eye: place(self.eye), target: place(self.target), ..self.clone() }
    }

    /// The view of these points in a picture `aspect` times as wide as high.
    pub(super) fn view(&self, points: &[DVec3], aspect: f64) -> Result<View, CliError> {
        if self.up.length_squared() < 1e-12 {
            return Err(CliError::Usage("--up: it must have a length".into()));
        }
        let tan = self.tan(aspect);
        let (eye, axes) = match self.eye {
            Some(eye) => (eye, self.axes_from(eye, points)?),
            None => {
                let axes = self.axes_around();
                (frame(points, axes, tan, f64::from(self.zoom)), axes)
            }
        };
        let away = points.iter().map(|&p| axes.z_axis.dot(eye - p));
        let (near, far) = away.fold((f64::MAX, f64::MIN), |(near, far), d| (near.min(d), far.max(d)));
        // Behind the eye is nothing to be seen; what is too near would cost the far end its depth precision.
        let far = if far > 0.0 { far * 1.01 } else { 1.0 };
        let near = (near * 0.99).max(far * 1e-4);
        Ok(View::perspective(
            eye.as_vec3().into(),
            (eye - axes.z_axis * far).as_vec3().into(),
            axes.y_axis.as_vec3().into(),
            self.fov.to_radians(),
            aspect as f32,
            [near as f32, far as f32],
        ))
    }

    /// Tangents of half the angles of view.
    fn tan(&self, aspect: f64) -> DVec2 {
        let tan_y = (f64::from(self.fov).to_radians() / 2.0).tan();
        DVec2::new(tan_y * aspect, tan_y)
    }

    /// A few points that the view of many, and of others with them, depends on: of an animation's frames no more need be kept.
    pub(super) fn deciding(&self, points: &[DVec3], aspect: f64) -> Vec<DVec3> {
        if self.eye.is_some() {
            let [low, high] = bounds(points);
            let corner =
                |bits: u32| DVec3::from_array([0, 1, 2].map(|k| if bits >> k & 1 == 0 { low[k] } else { high[k] }));
            return (0..8).map(corner).collect();
        }
        let (axes, tan) = (self.axes_around(), self.tan(aspect) / ROOM * f64::from(self.zoom));
        let [x, y, z] = [axes.x_axis, axes.y_axis, axes.z_axis];
        let directions = [z * tan.x + x, z * tan.x - x, z * tan.y + y, z * tan.y - y, z, -z];
        let farthest = |d: DVec3| points.iter().copied().max_by(|a, b| a.dot(d).total_cmp(&b.dot(d)));
        directions.into_iter().filter_map(farthest).collect()
    }

    /// Right, up and backwards for the eye that was turned and lifted.
    fn axes_around(&self) -> DMat3 {
        let (yaw, pitch) = (f64::from(self.yaw).to_radians(), f64::from(self.pitch).to_radians());
        let turn = DQuat::from_rotation_arc(DVec3::Y, self.up.normalize());
        DMat3::from_quat(turn * DQuat::from_rotation_y(yaw) * DQuat::from_rotation_x(-pitch))
    }

    /// The same for the eye that was placed.
    fn axes_from(&self, eye: DVec3, points: &[DVec3]) -> Result<DMat3, CliError> {
        let usage = |message: &str| CliError::Usage(message.into());
        let target = self.target.unwrap_or_else(|| middle(points));
        let back = (eye - target).try_normalize().ok_or_else(|| usage("--eye and --target are the same point"))?;
        let right = self.up.normalize().cross(back);
        if right.length_squared() < 1e-12 {
            return Err(usage("--up points along the view: choose another direction"));
        }
        let right = right.normalize();
        Ok(DMat3::from_cols(right, back.cross(right), back))
    }
}

fn middle(points: &[DVec3]) -> DVec3 {
    let [low, high] = bounds(points);
    (low + high) / 2.0
}

fn bounds(points: &[DVec3]) -> [DVec3; 2] {
    let low = points.iter().copied().fold(DVec3::MAX, DVec3::min);
    [low, points.iter().copied().fold(DVec3::MIN, DVec3::max)]
}

/// Room at the sides of a picture that is fitted.
const ROOM: f64 = 1.08;

/// The nearest eye that sees all points, with some room at the sides; `tan` of half the angles of view.
fn frame(points: &[DVec3], axes: DMat3, tan: DVec2, zoom: f64) -> DVec3 {
    let tan = tan / ROOM * zoom;
    // In the eye's axes a point p is left of the right-hand plane if p.x + p.z tan <= eye.x + eye.z tan, and so on: the
    // farthest points in four directions decide.
    let (mut above, mut below) = (DVec2::MIN, DVec2::MIN);
    let (mut front, mut behind) = (f64::MIN, f64::MAX);
    for &point in points {
        let p = axes.transpose() * point;
        above = above.max(p.truncate() + p.z * tan);
        below = below.max(p.z * tan - p.truncate());
        (front, behind) = (front.max(p.z), behind.min(p.z));
    }
    let across = (above - below) / 2.0;
    let back = ((above + below) / (2.0 * tan)).max_element();
    // Not into the mesh itself, however narrow it is.
    let back = if zoom <= 1.0 { back.max(front + (front - behind) * 1e-3) } else { back };
    axes * across.extend(back)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Vec<DVec3> {
        let sign = |i: u32, bit: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
        (0..8).map(|i| DVec3::new(5.0 + sign(i, 0), 3.0 * sign(i, 1), sign(i, 2))).collect()
    }

    #[test]
    fn everything_is_in_the_picture_and_in_its_middle() {
        let args = |yaw, pitch| CameraArgs { yaw, pitch, zoom: 1.0, eye: None, target: None, up: DVec3::Y, fov: 40.0 };
        for (yaw, pitch) in [(0.0, 0.0), (-32.0, 12.0), (170.0, -90.0), (45.0, 90.0)] {
            for aspect in [0.5, 1.0, 2.0] {
                let view = args(yaw, pitch).view(&cube(), aspect).unwrap();
                let clip = glam::Mat4::from_cols_array_2d(&view.view_projection);
                let seen: Vec<_> = cube().iter().map(|p| clip.project_point3(p.as_vec3())).collect();
                assert!(seen.iter().all(|p| (0.0..=1.0).contains(&p.z)), "{seen:?}");
                let low = seen.iter().copied().fold(glam::Vec3::MAX, glam::Vec3::min).truncate();
                let high = seen.iter().copied().fold(glam::Vec3::MIN, glam::Vec3::max).truncate();
                // One direction is full on both sides; the other is within.
                let room = 1.0 - 1.08 * low.abs().max(high.abs());
                let full = 1.0 - 1.08 * low.abs().min(high.abs());
                assert!(room.min_element() > -1e-4, "{low} {high}");
                assert!(full.abs().min_element() < 1e-4, "{low} {high}");
            }
        }
    }

    #[test]
    fn yaw_and_pitch_place_the_eye() {
        let mut args =
            CameraArgs { yaw: 90.0, pitch: 0.0, zoom: 1.0, eye: None, target: None, up: DVec3::Y, fov: 30.0 };
        assert!(args.axes_around().z_axis.distance(DVec3::X) < 1e-9);
        (args.yaw, args.pitch) = (0.0, 90.0);
        assert!(args.axes_around().z_axis.distance(DVec3::Y) < 1e-9);
        (args.pitch, args.up) = (0.0, DVec3::Z);
        assert!(args.axes_around().y_axis.distance(DVec3::Z) < 1e-9);
        assert!(args.axes_around().z_axis.distance(DVec3::NEG_Y) < 1e-9);
    }
}
