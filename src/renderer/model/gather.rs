//! Positions that the device wrote, put where shaders read them.

use crate::gpu::{Buffer, BufferDesc, DescriptorSet, DeviceContext, GpuError, MAX_OFFSET_ALIGNMENT, MemoryLocation};
use crate::renderer::options::{DevicePositions, Error, ModelId};
use crate::renderer::pipelines::{ComputePipelines, workgroups};
use crate::renderer::shader::{SetLayouts, ShaderCode, ShaderKey, Source, reads_texels};
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;

/// Push constants. GLSL twin: `glsl/compute/gather.comp`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Gathered {
    count: u32,
    first: u32,
    stride: u32,
}

/// Positions in a buffer of the device, to be put where a model's shaders read them.
pub(crate) struct Given {
    set: DescriptorSet,
    constants: Gathered,
}

/// The pipeline that puts them there.
pub(crate) struct GatherPipeline {
    sets: Arc<SetLayouts>,
    pipeline: ComputePipelines<(), Gathered>,
}

impl GatherPipeline {
    /// The pipeline itself is made when it is first needed.
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        sets: &Arc<SetLayouts>,
        cache: vk::PipelineCache,
    ) -> Result<Self, GpuError> {
        let [view, model] = sets.shared();
        let layouts = [view, model, sets.vertices.raw()];
        let pipeline = ComputePipelines::new(context, "subdiv positions", &layouts, cache)?;
        Ok(Self { sets: sets.clone(), pipeline })
    }

    /// Makes what recording needs of the positions of a model with `count` control vertices.
    ///
    /// # Errors
    /// As [`DevicePositions::seen`]; failed Vulkan calls.
    ///
    /// # Safety
    /// The buffer is of the device and as large as is said, and lives as long as what is made.
    pub(crate) unsafe fn give(
        &mut self,
        id: ModelId,
        count: usize,
        positions: DevicePositions,
        code: &ShaderCode,
    ) -> Result<Given, Error> {
        let context = self.pipeline.context();
        let seen = positions.seen(id, count, context.properties().max_storage_buffer_range)?;
        let constants = [reads_texels(context.properties())];
        self.pipeline.make((), ShaderKey::of(Source::GatherComp), code, &constants)?;
        let range = seen.end - seen.start;
        let buffer = vk::DescriptorBufferInfo { buffer: positions.buffer, offset: seen.start, range };
        // SAFETY: the layout is among those of the pool, with this descriptor; the buffer lives as long as the caller promises.
        let set = unsafe {
            DescriptorSet::of_buffers(&self.sets.pool, &self.sets.vertices, "subdiv positions given", &[buffer])?
        };
        let first = ((positions.offset - seen.start) / 4) as u32;
        Ok(Given { set, constants: Gathered { count: count as u32, first, stride: positions.stride / 4 } })
    }

    /// Records the dispatch for a model, whose set this is, and gives the descriptor set, to be kept until the frame is done.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering.
    pub(super) unsafe fn cmd_gather(
        &self,
        cmd: vk::CommandBuffer,
        model: vk::DescriptorSet,
        Given { set, constants }: Given,
    ) -> DescriptorSet {
        // SAFETY: as the caller promises; the model has as many control vertices.
        unsafe {
            self.pipeline.cmd_bind(cmd, 1, &[model, set.raw()], &[]);
            self.pipeline.cmd_dispatch(cmd, &(), &constants, workgroups(constants.count));
        }
        set
    }
}

/// Room for the positions of a model on the device, which the caller's shaders write: as often as there are frames in flight, for
/// each to be written while the one before is read.
pub(super) struct PositionRoom {
    buffer: Buffer,
    /// Bytes from the positions of one frame to those of the next.
    size: u64,
}

impl PositionRoom {
    /// Bytes from one position to the next: those of a `vec4`, or of a `vec3` in an array.
    const STRIDE: u32 = 16;

    pub(super) fn new(context: &Arc<DeviceContext>, name: &str, count: usize, frames: u32) -> Result<Self, GpuError> {
        use vk::BufferUsageFlags as Usage;
        let size = (u64::from(Self::STRIDE) * count.max(1) as u64).next_multiple_of(MAX_OFFSET_ALIGNMENT);
        let desc = BufferDesc {
            name: &format!("{name}: positions on the device"),
            size: size * u64::from(frames),
            usage: Usage::STORAGE_BUFFER | Usage::TRANSFER_DST | Usage::TRANSFER_SRC,
            location: MemoryLocation::DeviceLocal,
        };
        Ok(Self { buffer: Buffer::new(context, &desc)?, size })
    }

    pub(super) fn of_frame(&self, frame: u32) -> DevicePositions {
        DevicePositions {
            buffer: self.buffer.raw(),
            offset: self.size * u64::from(frame),
            stride: Self::STRIDE,
            size: self.buffer.size(),
        }
    }

    pub(super) fn bytes(&self) -> u64 {
        self.buffer.size()
    }
}
