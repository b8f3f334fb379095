//! The floors that no way to draw the surface gets below: small pipelines of the bench's own, lit and drawn as the renderer
//! does.

mod bilinear;
mod vertex_buffer;

pub(super) use bilinear::Bilinear;
pub(super) use vertex_buffer::VertexBuffer;

use super::BenchError;
use super::drawable::{Frame, Lane, Pass};
use crate::gpu::{
    Buffer, BufferDesc, DepthState, DescriptorPool, DescriptorSet, DeviceContext, GpuError, GraphicsPipelineDesc,
    MemoryLocation, Owned, RenderTarget, SetLayout, Shader, descriptor_set_layout, pipeline_layout,
};
use crate::headless::Headless;
use crate::renderer::{DrawConstants, ItemRecord, STAGES, ShaderId, ViewData, without_instances};
use ash::vk;
use bytemuck::NoUninit;
use std::sync::Arc;

/// The storage buffers that a floor's shaders may read in set 1. The first of them is there once more, as a texel buffer.
const BINDINGS: usize = 2;

/// Input of the vertex stage, and what it passes on.
#[derive(Default)]
struct Input<'a> {
    /// Nought without tessellation.
    patch_control_points: u32,
    bindings: &'a [vk::VertexInputBindingDescription],
    attributes: &'a [vk::VertexInputAttributeDescription],
    dynamic_states: &'a [vk::DynamicState],
}

/// Layouts and the view, as `glsl/lib/draw/draw.glsl` has them.
struct Kit {
    context: Arc<DeviceContext>,
    layout: Owned<vk::PipelineLayout>,
    _set_layouts: [SetLayout; 2],
    sets: [DescriptorSet; 2],
    view: Buffer,
    /// A record for each instance.
    items: Buffer,
    _position_texels: Owned<vk::BufferView>,
}

impl Kit {
    /// `storage` goes to the bindings of set 1.
    fn new(headless: &Headless, storage: [&Buffer; BINDINGS]) -> Result<Self, GpuError> {
        const NAME: &str = "bench floor";
        let context = headless.context();
        use vk::DescriptorType as Type;
        let (uniform, buffer, texels) = (Type::UNIFORM_BUFFER, Type::STORAGE_BUFFER, Type::UNIFORM_TEXEL_BUFFER);
        let of_item = Type::UNIFORM_BUFFER_DYNAMIC;
        let set_layouts = [
            descriptor_set_layout(context, NAME, &[uniform, buffer, of_item, buffer].map(|ty| (ty, STAGES)))?,
            descriptor_set_layout(context, NAME, &[(buffer, STAGES), (buffer, STAGES), (texels, STAGES)])?,
        ];
        let raw = [set_layouts[0].raw(), set_layouts[1].raw()];
        let size = size_of::<DrawConstants>() as u32;
        let constants = [vk::PushConstantRange { stage_flags: STAGES, offset: 0, size }];
        // SAFETY: the set layouts are of this device.
        let layout = unsafe { pipeline_layout(context, NAME, &raw, &constants)? };
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let desc =
            BufferDesc { name: NAME, size: size_of::<ViewData>() as u64, usage, location: MemoryLocation::Upload };
        let view = Buffer::new(context, &desc)?;
        let items = item_buffer(context, 1)?;
        let pool = DescriptorPool::new(context, NAME, &set_layouts.each_ref());
        // SAFETY: the layouts are those of the pool; every submission is waited for.
        let sets = unsafe {
            [DescriptorSet::new(&pool, &set_layouts[0], NAME)?, DescriptorSet::new(&pool, &set_layouts[1], NAME)?]
        };
        let device = context.device();
        let views = [view.descriptor()];
        let buffers = storage.map(Buffer::descriptor);
        let write = |set, ty| vk::WriteDescriptorSet::default().dst_set(set).descriptor_type(ty);
        let position_texels = storage[0].texels(vk::Format::R32G32B32A32_SFLOAT, 16, 0, storage[0].size())?;
        let texel_views = [position_texels.raw()];
        let writes = [
            write(sets[0].raw(), uniform).buffer_info(&views),
            write(sets[0].raw(), buffer).dst_binding(1).buffer_info(&buffers[..1]),
            write(sets[0].raw(), buffer).dst_binding(3).buffer_info(&buffers[..1]),
            write(sets[1].raw(), buffer).buffer_info(&buffers),
            write(sets[1].raw(), texels).dst_binding(BINDINGS as u32).texel_buffer_view(&texel_views),
        ];
        // SAFETY: the sets are new, and the buffers live as long as they.
        unsafe { device.update_descriptor_sets(&writes, &[]) };
        let kit = Self {
            context: context.clone(),
            layout,
            _set_layouts: set_layouts,
            sets,
            view,
            items,
            _position_texels: position_texels,
        };
        kit.write_items();
        Ok(kit)
    }

    /// Pipelines for [`Pass::ALL`].
    fn pipelines(&self, lane: Lane, stages: &[Shader], input: &Input) -> Result<[Owned<vk::Pipeline>; 2], GpuError> {
        let target = RenderTarget::Dynamic {
            color: std::slice::from_ref(&lane.target.color),
            depth: lane.target.depth,
            stencil: vk::Format::UNDEFINED,
        };
        // As in pipelines of items that are drawn once.
        let last = stages.len() - 1;
        let code = |(number, stage): (usize, &Shader)| without_instances(stage.code, stage.stage, number == last);
        let codes: Vec<Vec<u32>> = stages.iter().enumerate().map(code).collect();
        let stages: Vec<Shader> = stages.iter().zip(&codes).map(|(stage, code)| Shader { code, ..*stage }).collect();
        let fragment = without_instances(ShaderId::ShadeLitFrag.code(), vk::ShaderStageFlags::FRAGMENT, false);
        let pipeline = |pass: Pass| {
            let (mut stages, mut dynamic_states) = (stages.to_vec(), input.dynamic_states.to_vec());
            match pass {
                Pass::Pixels => stages.push(Shader::fragment(&fragment)),
                // As the styles of a renderer.
                Pass::Geometry => dynamic_states.push(vk::DynamicState::RASTERIZER_DISCARD_ENABLE),
            }
            let desc = GraphicsPipelineDesc {
                cull_mode: lane.cull,
                patch_control_points: input.patch_control_points,
                vertex_bindings: input.bindings,
                vertex_attributes: input.attributes,
                depth: Some(DepthState::LESS),
                samples: lane.target.samples,
                dynamic_states: &dynamic_states,
                ..GraphicsPipelineDesc::new("bench floor", self.layout.raw(), target, &stages)
            };
            // SAFETY: the shaders are ours and match each other, the layout and the target.
            unsafe { desc.create(&self.context) }
        };
        let [pixels, geometry] = Pass::ALL.map(pipeline);
        Ok([pixels?, geometry?])
    }

    /// Has the set of the view show the records.
    fn write_items(&self) {
        let items = [vk::DescriptorBufferInfo { range: size_of::<ItemRecord>() as u64, ..self.items.descriptor() }];
        let write = vk::WriteDescriptorSet::default()
            .dst_set(self.sets[0].raw())
            .dst_binding(2)
            .descriptor_type(vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC)
            .buffer_info(&items);
        // SAFETY: the device does not use the set, and the buffer lives as long as it.
        unsafe { self.context.device().update_descriptor_sets(&[write], &[]) };
    }

    /// Writes the view, and a record for each instance.
    ///
    /// # Safety
    /// The device is done with earlier frames.
    unsafe fn write_frame(&mut self, frame: &Frame, factor: f32) -> Result<(), GpuError> {
        self.view.write(0, &[ViewData::new(frame.view)])?;
        if (frame.instances.len() as u64) > self.items.size() / ItemRecord::STRIDE {
            self.items = item_buffer(&self.context, frame.instances.len())?;
            self.write_items();
        }
        for (i, transform) in (0..).zip(frame.instances) {
            let record = ItemRecord::new(transform, [[0.7, 0.7, 0.7, 1.0]; 4], factor);
            self.items.write(ItemRecord::STRIDE * i, &[record])?;
        }
        Ok(())
    }

    /// Binds the sets, with the record of an instance.
    ///
    /// # Safety
    /// `cmd` is being recorded, after [`Kit::write_frame`].
    unsafe fn cmd_bind(&self, cmd: vk::CommandBuffer, instance: usize) {
        let (point, layout) = (vk::PipelineBindPoint::GRAPHICS, self.layout.raw());
        let sets = self.sets.each_ref().map(DescriptorSet::raw);
        let offset = instance as u32 * ItemRecord::STRIDE as u32;
        // SAFETY: as the caller promises.
        unsafe { self.context.device().cmd_bind_descriptor_sets(cmd, point, layout, 0, &sets, &[offset]) };
    }

    /// # Safety
    /// `cmd` is being recorded.
    unsafe fn cmd_push(&self, cmd: vk::CommandBuffer, constants: &DrawConstants) {
        let bytes = bytemuck::bytes_of(constants);
        // SAFETY: as the caller promises.
        unsafe { self.context.device().cmd_push_constants(cmd, self.layout.raw(), STAGES, 0, bytes) };
    }

    /// # Safety
    /// `cmd` is being recorded.
    unsafe fn cmd_bind_pipeline(&self, cmd: vk::CommandBuffer, pipelines: &[Owned<vk::Pipeline>; 2], frame: &Frame) {
        let discards = frame.pass == Pass::Geometry;
        let (device, pipeline) = (self.context.device(), pipelines[usize::from(discards)].raw());
        // SAFETY: as the caller promises.
        unsafe {
            device.cmd_bind_pipeline(cmd, vk::PipelineBindPoint::GRAPHICS, pipeline);
            if discards {
                device.cmd_set_rasterizer_discard_enable(cmd, true);
            }
        }
    }
}

/// A buffer with room for the records of `items` items.
fn item_buffer(context: &Arc<DeviceContext>, items: usize) -> Result<Buffer, GpuError> {
    let (size, usage) = (ItemRecord::STRIDE * items as u64, vk::BufferUsageFlags::UNIFORM_BUFFER);
    Buffer::new(context, &BufferDesc { name: "bench floor items", size, usage, location: MemoryLocation::Upload })
}

/// A buffer on the device with this in it.
pub(super) fn device_buffer<T: NoUninit>(
    headless: &Headless,
    name: &str,
    usage: vk::BufferUsageFlags,
    data: &[T],
) -> Result<Buffer, BenchError> {
    let context = headless.context();
    let size = size_of_val(data) as u64;
    let usage = usage | vk::BufferUsageFlags::TRANSFER_DST;
    let buffer = Buffer::new(context, &BufferDesc { name, size, usage, location: MemoryLocation::DeviceLocal })?;
    if data.is_empty() {
        return Ok(buffer);
    }
    let staged = Buffer::with_data(context, name, vk::BufferUsageFlags::TRANSFER_SRC, data)?;
    let region = vk::BufferCopy { src_offset: 0, dst_offset: 0, size };
    let written = [vk::MemoryBarrier2::default()
        .src_stage_mask(vk::PipelineStageFlags2::COPY)
        .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::ALL_GRAPHICS)
        .dst_access_mask(vk::AccessFlags2::MEMORY_READ)];
    // SAFETY: both buffers hold the range; the submission is waited for.
    headless.submit(|cmd| unsafe {
        headless.device().cmd_copy_buffer(cmd, staged.raw(), buffer.raw(), &[region]);
        headless.device().cmd_pipeline_barrier2(cmd, &vk::DependencyInfo::default().memory_barriers(&written));
    })?;
    Ok(buffer)
}
