//! The displacement maps that a renderer knows.

use crate::gpu::{DeviceContext, GpuError, Image, ImageDesc, Owned, VkResultExt};
use crate::renderer::options::{DisplacementId, DisplacementMap, Error};
use ash::vk;
use std::collections::HashMap;
use std::sync::Arc;

/// The maps that a renderer knows, and one for models without: every descriptor has to be written (lavapipe bug C).
pub(crate) struct Displacements {
    maps: HashMap<DisplacementId, DisplacementMap>,
    next: DisplacementId,
    nothing: DisplacementMap,
    _image: Image,
    _sampler: Owned<vk::Sampler>,
}

impl Displacements {
    pub(crate) fn new(context: &Arc<DeviceContext>) -> Result<Self, GpuError> {
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

    pub(crate) fn add(&mut self, map: DisplacementMap) -> DisplacementId {
        let id = self.next;
        self.next.0 += 1;
        self.maps.insert(id, map);
        id
    }

    /// Forgets a map.
    pub(crate) fn remove(&mut self, id: DisplacementId) -> Result<(), Error> {
        self.maps.remove(&id).map(drop).ok_or(Error::NoSuchDisplacement { id })
    }

    pub(crate) fn get(&self, id: Option<DisplacementId>) -> Result<DisplacementMap, Error> {
        match id {
            None => Ok(self.nothing),
            Some(id) => self.maps.get(&id).copied().ok_or(Error::NoSuchDisplacement { id }),
        }
    }
}
