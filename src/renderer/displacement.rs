//! The caller's displacement maps.

use super::Error;
use super::gpu_data::{REACH_SHIFT, VECTOR_FLAG, half_not_below};
use crate::gpu::{DeviceContext, GpuError, Image, ImageDesc, Owned, VkResultExt};
use ash::vk;
use std::collections::HashMap;
use std::sync::Arc;

/// An image that says how far, or whereto, a surface is moved. See `glsl/lib/displace.glsl`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplacementMap {
    /// A view of a colour image with all its mip levels.
    pub view: vk::ImageView,
    /// Trilinear, as a rule; it has to let all mip levels through.
    pub sampler: vk::Sampler,
    /// The layout the image is in when models are drawn.
    pub layout: vk::ImageLayout,
    /// Whether red, green and blue are a vector in object space; else red is a height along the normal.
    pub vectors: bool,
    /// The least and the largest value in it: what culling has to reckon with.
    pub range: [f32; 2],
}

#[cfg(feature = "headless")]
impl From<&crate::headless::Texture> for DisplacementMap {
    /// Heights if a texel is one number, else vectors.
    fn from(texture: &crate::headless::Texture) -> Self {
        Self {
            view: texture.view(),
            sampler: texture.sampler(),
            layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
            vectors: texture.channels() > 1,
            range: texture.range(),
        }
    }
}

impl DisplacementMap {
    /// How far a point is moved at most.
    fn reach(&self, [scale, bias]: [f32; 2]) -> f32 {
        let [low, high] = self.range.map(|value| (scale * value + bias).abs());
        // The diagonal of a cube.
        low.max(high) * if self.vectors { 3f32.sqrt() } else { 1.0 }
    }

    /// The bits of a draw's flags that displacement takes.
    pub(super) fn flags(&self, displacement: [f32; 2]) -> u32 {
        let vectors = if self.vectors { VECTOR_FLAG } else { 0 };
        vectors | u32::from(half_not_below(self.reach(displacement))) << REACH_SHIFT
    }
}

/// Names a displacement map of a [`Renderer`](super::Renderer) by how many it was told of before. That of another renderer is not
/// told apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct DisplacementId(pub(super) usize);

impl DisplacementId {
    /// Of the first map that a renderer is told of: for tables that are built before there is a renderer.
    pub const FIRST: Self = Self(0);
}

/// The maps that a renderer knows, and one for models without: every descriptor has to be written (lavapipe bug C).
pub(super) struct Displacements {
    maps: HashMap<DisplacementId, DisplacementMap>,
    next: DisplacementId,
    nothing: DisplacementMap,
    _image: Image,
    _sampler: Owned<vk::Sampler>,
}

impl Displacements {
    pub(super) fn new(context: &Arc<DeviceContext>) -> Result<Self, GpuError> {
        let name = "subdiv no displacement";
        let extent = vk::Extent2D { width: 1, height: 1 };
        let usage = vk::ImageUsageFlags::SAMPLED;
        let image = Image::new(context, &ImageDesc::new(name, extent, vk::Format::R8_UNORM, usage))?;
        // SAFETY: the description is valid, and the sampler is taken over by `Owned`.
        let sampler = unsafe {
            let info = vk::SamplerCreateInfo::default();
            Owned::new(context, context.device().create_sampler(&info, None).of("vkCreateSampler", name)?, name)
        };
        let nothing = DisplacementMap {
            view: image.view(),
            sampler: sampler.raw(),
            layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
            vectors: false,
            range: [0.0; 2],
        };
        Ok(Self { maps: HashMap::new(), next: DisplacementId::FIRST, nothing, _image: image, _sampler: sampler })
    }

    pub(super) fn add(&mut self, map: DisplacementMap) -> DisplacementId {
        let id = self.next;
        self.next.0 += 1;
        self.maps.insert(id, map);
        id
    }

    /// Forgets a map.
    pub(super) fn remove(&mut self, id: DisplacementId) -> Result<(), Error> {
        self.maps.remove(&id).map(drop).ok_or(Error::NoSuchDisplacement { id })
    }

    pub(super) fn get(&self, id: Option<DisplacementId>) -> Result<DisplacementMap, Error> {
        match id {
            None => Ok(self.nothing),
            Some(id) => self.maps.get(&id).copied().ok_or(Error::NoSuchDisplacement { id }),
        }
    }
}
