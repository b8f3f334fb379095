//! Animations of a control mesh: nodes move, skins bend, morph targets blend. Positions at a time, on the CPU.
//!
//! | file | holds |
//! |---|---|
//! | `keys` | values at times, and the three interpolations between them |
//! | `rig` | nodes with their transforms, skins, and what moves them: the pose at a time |
//! | `skinning` | what shaders of the caller's skin by |
//! | `binding` | what each control vertex follows: its node or joints, and its morph offsets |
//!
//! The order is that of glTF 2.0: morph targets first, then the skin. A skinned vertex is where its joints are; the transform of its
//! own node does not count.

mod binding;
mod keys;
mod rig;
mod skinning;

pub(crate) use binding::{Binding, Influence, Part};
pub(crate) use keys::{Interpolation, Keys};
pub(crate) use rig::{Clip, Node, Path, Placement, Rig, Skin, Track};

pub use skinning::Skinning;

use super::MeshError;
use glam::DVec3;
use rig::Pose;

/// The animations of a mesh: positions of its control vertices at any time.
///
/// Topology, tables and depths stay: what is filled here goes to `Renderer::set_positions` each frame, or to
/// [`Tessellation::update`](crate::dice::Tessellation::update).
///
/// ```
/// use ash_subdiv::mesh::animated_shape;
/// let tentacle = animated_shape("tentacle")?;
/// let mut positions = vec![[0.0f32; 3]; tentacle.mesh.vertex_count()];
/// let animation = tentacle.animations.find("curl")?;
/// tentacle.animations.positions(animation, 0.5, &mut positions)?;
/// # Ok::<(), ash_subdiv::MeshError>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Animations {
    pub(crate) rig: Rig,
    pub(crate) clips: Vec<Clip>,
    pub(crate) binding: Binding,
    pub(crate) notes: Vec<String>,
}

impl Animations {
    /// Whether nothing moves.
    pub fn is_empty(&self) -> bool {
        self.clips.is_empty()
    }

    /// Number of animations.
    pub fn len(&self) -> usize {
        self.clips.len()
    }

    /// Name of an animation, if it has one.
    pub fn name(&self, animation: usize) -> Option<&str> {
        self.clips.get(animation)?.name.as_deref()
    }

    /// Time of an animation's last key, in seconds; 0 if there is no such animation.
    pub fn duration(&self, animation: usize) -> f64 {
        self.clips.get(animation).map_or(0.0, Clip::duration)
    }

    /// The animation of this name, or else of this number, from 0.
    ///
    /// # Errors
    /// [`MeshError::UnknownAnimation`] if there is none.
    pub fn find(&self, name: &str) -> Result<usize, MeshError> {
        let named = self.clips.iter().position(|clip| clip.name.as_deref() == Some(name));
        let numbered = || name.parse().ok().filter(|&number: &usize| number < self.clips.len());
        named
            .or_else(numbered)
            .ok_or_else(|| MeshError::UnknownAnimation { name: name.to_owned(), known: self.known() })
    }

    /// The animations to choose from, in words.
    fn known(&self) -> String {
        let name = |(number, clip): (usize, &Clip)| match &clip.name {
            Some(name) => format!("\"{name}\""),
            None => number.to_string(),
        };
        match self.clips.as_slice() {
            [] => "it has none".to_owned(),
            clips => format!("choose one of {}", clips.iter().enumerate().map(name).collect::<Vec<_>>().join(", ")),
        }
    }

    /// What was odd about the file and was mended, in words.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Positions of all control vertices, in their order, at a time of an animation. Before its first key and after its last one
    /// everything is as there.
    ///
    /// # Errors
    /// [`MeshError::UnknownAnimation`], [`MeshError::PositionCount`] if `positions` has not one entry a control vertex,
    /// [`MeshError::BadTime`], and [`MeshError::NotFinite`] if a position is not finite then.
    pub fn positions(&self, animation: usize, seconds: f64, positions: &mut [[f32; 3]]) -> Result<(), MeshError> {
        self.fill(animation, seconds, positions, |p| p.as_vec3().to_array())
    }

    /// As [`Animations::positions`], in double precision: those of a [`MeshData`](super::MeshData).
    ///
    /// # Errors
    /// As [`Animations::positions`].
    pub fn positions_f64(&self, animation: usize, seconds: f64, positions: &mut [[f64; 3]]) -> Result<(), MeshError> {
        self.fill(animation, seconds, positions, |p| p.to_array())
    }

    fn fill<T: Send>(
        &self,
        animation: usize,
        seconds: f64,
        positions: &mut [T],
        of: impl Fn(DVec3) -> T + Sync,
    ) -> Result<(), MeshError> {
        let pose = self.pose(animation, seconds)?;
        let (given, count) = (positions.len(), self.binding.vertex_count());
        if given != count {
            return Err(MeshError::PositionCount { given, count });
        }
        self.binding.positions(&self.rig, &pose, positions, of)
    }

    /// All nodes at a time of an animation.
    fn pose(&self, animation: usize, seconds: f64) -> Result<Pose, MeshError> {
        let unknown = || MeshError::UnknownAnimation { name: animation.to_string(), known: self.known() };
        let clip = self.clips.get(animation).ok_or_else(unknown)?;
        if !seconds.is_finite() {
            return Err(MeshError::BadTime { seconds });
        }
        Ok(self.rig.pose(clip, seconds))
    }
}
