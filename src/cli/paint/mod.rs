//! What is painted on a surface from a map over its patches, with a legend.

mod errors;
mod legend;
mod levels;
mod tiles;

use super::error::CliError;
use ash::vk;
use ash_subdiv::gpu::{DeviceContext, MemoryLocation};
use ash_subdiv::headless::Headless;
use ash_subdiv::headless::objects::{
    Buffer, BufferDesc, DescriptorPool, DescriptorSet, SetLayout, descriptor_set_layout,
};
use ash_subdiv::{ControlMesh, Renderer};
pub(super) use errors::ErrorMap;
pub(super) use legend::Legend;
pub(super) use levels::LevelMap;
use std::sync::Arc;

/// A map over patches.
pub(super) enum Painting {
    Errors(ErrorMap),
    Levels(LevelMap),
}

impl Painting {
    /// The mesh to draw, whose texture coordinates find the map's tiles.
    pub(super) fn mesh(&self) -> &ControlMesh {
        match self {
            Self::Errors(map) => &map.tiles.mesh,
            Self::Levels(map) => &map.tiles.mesh,
        }
    }

    /// The legend, for patches of this scheme.
    pub(super) fn legend(&self, scheme: &str) -> Legend {
        match self {
            Self::Errors(map) => map.legend(scheme),
            Self::Levels(map) => map.legend(),
        }
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Errors(_) => "map of errors",
            Self::Levels(_) => "map of levels",
        }
    }

    /// Bytes that the shader reads.
    fn bytes(&self) -> Vec<u8> {
        match self {
            Self::Errors(map) => map.bytes(),
            Self::Levels(map) => map.bytes(),
        }
    }
}

/// A map on the device, with the descriptor set that the fragment shader finds it in.
pub(super) struct PaintingSet {
    pub layout: SetLayout,
    pub set: DescriptorSet,
    _buffer: Buffer,
}

impl PaintingSet {
    pub(super) fn new(context: &Arc<DeviceContext>, painting: &Painting) -> Result<Self, CliError> {
        let (name, bytes) = (painting.name(), painting.bytes());
        let max = context.properties().max_storage_buffer_range;
        if bytes.len() as u64 > max {
            let (device, size) = (&context.properties().name, bytes.len());
            return Err(CliError::Work(format!(
                "the {name} has {size} bytes, and a shader of {device} can see {max}: refine less"
            )));
        }
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let desc = BufferDesc { name, size: bytes.len() as u64, usage, location: MemoryLocation::Upload };
        let mut buffer = Buffer::new(context, &desc)?;
        buffer.write(0, &bytes)?;
        let ty = vk::DescriptorType::STORAGE_BUFFER;
        let layout = descriptor_set_layout(context, name, &[(ty, vk::ShaderStageFlags::FRAGMENT)])?;
        let pool = DescriptorPool::new(context, name, &[&layout]);
        // SAFETY: the layout is that of the pool, with this descriptor; the buffer goes with the set.
        let set = unsafe { DescriptorSet::of_buffers(&pool, &layout, name, &[buffer.descriptor()])? };
        Ok(Self { layout, set, _buffer: buffer })
    }

    /// Binds the set where the shaders look for it.
    ///
    /// # Safety
    /// `cmd` is being recorded; `renderer` has the layout; this outlives the submission.
    pub(super) unsafe fn cmd_bind(&self, headless: &Headless, cmd: vk::CommandBuffer, renderer: &Renderer) {
        let (point, layout) = (vk::PipelineBindPoint::GRAPHICS, renderer.pipeline_layout());
        let sets = [self.set.raw()];
        // SAFETY: as the caller promises.
        unsafe { headless.device().cmd_bind_descriptor_sets(cmd, point, layout, 2, &sets, &[]) };
    }
}
