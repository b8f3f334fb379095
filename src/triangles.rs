//! Triangles that the CPU made, drawn as the renderer shades: where a device has no tessellation stages, and to compare with.
//!
//! What is drawn are the arrays of a [`Tessellation`](crate::dice::Tessellation), or any others. Styles are those of a
//! [`Renderer`](crate::Renderer), of the geometry [`Surface`](crate::renderer::Geometry::Surface).

use crate::gpu::{
    Buffer, BufferDesc, DescriptorPool, DescriptorSet, DeviceContext, GpuError, GraphicsPipelineDesc, MemoryLocation,
    Owned, RenderTarget, SetLayout, Shader, descriptor_set_layout, pipeline_layout,
};
use crate::headless::{Headless, OffscreenDesc};
use crate::renderer::{
    DrawConstants, Fragment, ItemRecord, STAGES, ShaderId, Style, View, ViewData, without_instances,
};
use ash::vk;
use std::sync::Arc;

const NAME: &str = "triangles of the CPU";

/// The triangles in one style and colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrianglesItem {
    /// Index of the style.
    pub style: usize,
    /// Object to world, by columns.
    pub transform: [[f32; 4]; 4],
    /// As [`DrawItem::colors`](crate::DrawItem::colors), of all triangles.
    pub colour: [f32; 4],
    /// As [`DrawItem::words`](crate::DrawItem::words).
    pub words: [u32; 4],
}

/// Pipelines and buffers of one mesh of triangles.
pub struct Triangles {
    context: Arc<DeviceContext>,
    layout: Owned<vk::PipelineLayout>,
    _set_layout: SetLayout,
    set: DescriptorSet,
    pipelines: Vec<Owned<vk::Pipeline>>,
    discards: Vec<bool>,
    view: Buffer,
    /// A record for each item.
    items: Buffer,
    /// The style of each item.
    styles: Vec<usize>,
    positions: Buffer,
    normals: Buffer,
    indices: Buffer,
    count: u32,
}

impl Triangles {
    /// Pipelines of these styles for a target, and triangles of `vertices` vertices, which are to be set before anything is drawn.
    ///
    /// # Errors
    /// Failed Vulkan calls; [`GpuError::Unsupported`] if there are more indices than a draw can have.
    pub fn new(
        headless: &Headless,
        target: &OffscreenDesc,
        styles: &[Style],
        vertices: usize,
        triangles: &[[u32; 3]],
    ) -> Result<Self, GpuError> {
        let context = headless.context();
        use vk::DescriptorType as Type;
        let bindings = [Type::UNIFORM_BUFFER, Type::STORAGE_BUFFER, Type::UNIFORM_BUFFER_DYNAMIC, Type::STORAGE_BUFFER];
        let bindings = bindings.map(|ty| (ty, STAGES));
        let set_layout = descriptor_set_layout(context, NAME, &bindings)?;
        let size = size_of::<DrawConstants>() as u32;
        let constants = [vk::PushConstantRange { stage_flags: STAGES, offset: 0, size }];
        // SAFETY: the set layout is of this device.
        let layout = unsafe { pipeline_layout(context, NAME, &[set_layout.raw()], &constants)? };
        let buffer = |size: u64, usage| {
            Buffer::new(context, &BufferDesc { name: NAME, size, usage, location: MemoryLocation::Upload })
        };
        let view = buffer(size_of::<ViewData>() as u64, vk::BufferUsageFlags::UNIFORM_BUFFER)?;
        let items = item_buffer(context, styles.len())?;
        let pool = DescriptorPool::new(context, NAME, &[&set_layout]);
        // SAFETY: the layout is that of the pool; callers wait for submissions before the set goes.
        let set = unsafe { DescriptorSet::new(&pool, &set_layout, NAME)? };
        let views = [view.descriptor()];
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set.raw())
            .descriptor_type(Type::UNIFORM_BUFFER)
            .buffer_info(&views);
        // SAFETY: the set is new, and the buffer lives as long as it.
        unsafe { context.device().update_descriptor_sets(&[write], &[]) };
        let pipelines =
            styles.iter().map(|style| pipeline(context, layout.raw(), target, style)).collect::<Result<_, _>>()?;
        let count = u32::try_from(3 * triangles.len()).map_err(|_| {
            let why = format!("{} triangles have more indices than a draw can have", triangles.len());
            GpuError::Unsupported { object: NAME.into(), why }
        })?;
        let bytes = 12 * vertices as u64;
        let made = Self {
            context: context.clone(),
            layout,
            _set_layout: set_layout,
            set,
            pipelines,
            discards: styles.iter().map(|style| style.rasterizer_discard).collect(),
            view,
            items,
            styles: Vec::new(),
            positions: buffer(bytes, vk::BufferUsageFlags::VERTEX_BUFFER)?,
            normals: buffer(bytes, vk::BufferUsageFlags::VERTEX_BUFFER)?,
            indices: Buffer::with_data(context, NAME, vk::BufferUsageFlags::INDEX_BUFFER, triangles)?,
            count,
        };
        made.write_items();
        Ok(made)
    }

    /// Has the set show the records.
    fn write_items(&self) {
        let items = [vk::DescriptorBufferInfo { range: size_of::<ItemRecord>() as u64, ..self.items.descriptor() }];
        let write = vk::WriteDescriptorSet::default()
            .dst_set(self.set.raw())
            .dst_binding(2)
            .descriptor_type(vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC)
            .buffer_info(&items);
        // In the place of instances, of which there are none.
        let instances = [self.items.descriptor()];
        let no_instances = vk::WriteDescriptorSet::default()
            .dst_set(self.set.raw())
            .dst_binding(3)
            .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
            .buffer_info(&instances);
        // SAFETY: the device does not use the set, and the buffer lives as long as it.
        unsafe { self.context.device().update_descriptor_sets(&[write, no_instances], &[]) };
    }

    /// Sets the vertices.
    ///
    /// # Safety
    /// The device is done with earlier draws.
    ///
    /// # Errors
    /// Arrays that are longer than was announced.
    pub unsafe fn set_vertices(&mut self, positions: &[[f32; 3]], normals: &[[f32; 3]]) -> Result<(), GpuError> {
        self.positions.write(0, positions)?;
        self.normals.write(0, normals)
    }

    /// Sets what is seen, and what is drawn in which order.
    ///
    /// # Safety
    /// As [`Triangles::set_vertices`].
    ///
    /// # Errors
    /// Failed Vulkan calls.
    pub unsafe fn set_items(&mut self, view: &View, items: &[TrianglesItem]) -> Result<(), GpuError> {
        self.view.write(0, &[ViewData::new(view)])?;
        if (items.len() as u64) > self.items.size() / ItemRecord::STRIDE {
            self.items = item_buffer(&self.context, items.len())?;
            self.write_items();
        }
        for (place, item) in (0..).zip(items) {
            let record = ItemRecord { words: item.words, ..ItemRecord::new(&item.transform, [item.colour; 4], 1.0) };
            self.items.write(ItemRecord::STRIDE * place, &[record])?;
        }
        self.styles = items.iter().map(|item| item.style).collect();
        Ok(())
    }

    /// Records the draws of all items.
    ///
    /// # Safety
    /// `cmd` is being recorded, inside rendering that fits the target; all styles of items are among those that were announced.
    pub unsafe fn cmd_draw(&self, cmd: vk::CommandBuffer) {
        let (device, point) = (self.context.device(), vk::PipelineBindPoint::GRAPHICS);
        let constants = DrawConstants::new(0);
        for (place, &style) in (0..).zip(&self.styles) {
            let offset = place * ItemRecord::STRIDE as u32;
            // SAFETY: as the caller promises; all buffers hold what the draw reads.
            unsafe {
                device.cmd_bind_pipeline(cmd, point, self.pipelines[style].raw());
                if self.discards[style] {
                    device.cmd_set_rasterizer_discard_enable(cmd, true);
                }
                device.cmd_bind_descriptor_sets(cmd, point, self.layout.raw(), 0, &[self.set.raw()], &[offset]);
                device.cmd_push_constants(cmd, self.layout.raw(), STAGES, 0, bytemuck::bytes_of(&constants));
                device.cmd_bind_vertex_buffers(cmd, 0, &[self.positions.raw(), self.normals.raw()], &[0, 0]);
                device.cmd_bind_index_buffer(cmd, self.indices.raw(), 0, vk::IndexType::UINT32);
                device.cmd_draw_indexed(cmd, self.count, 1, 0, 0, 0);
            }
        }
    }

    /// Bytes of the vertices, and of the indices.
    pub fn bytes(&self) -> [u64; 2] {
        [self.positions.size() + self.normals.size(), self.indices.size()]
    }
}

/// A buffer with room for the records of `items` items.
fn item_buffer(context: &Arc<DeviceContext>, items: usize) -> Result<Buffer, GpuError> {
    let usage = vk::BufferUsageFlags::UNIFORM_BUFFER | vk::BufferUsageFlags::STORAGE_BUFFER;
    let size = ItemRecord::STRIDE * items.max(1) as u64;
    Buffer::new(context, &BufferDesc { name: NAME, size, usage, location: MemoryLocation::Upload })
}

fn pipeline(
    context: &Arc<DeviceContext>,
    layout: vk::PipelineLayout,
    target: &OffscreenDesc,
    style: &Style,
) -> Result<Owned<vk::Pipeline>, GpuError> {
    let vertex = without_instances(ShaderId::EvaluateUniformGridVert.code(), vk::ShaderStageFlags::VERTEX, true);
    let fragment = match &style.fragment {
        Fragment::Lit => ShaderId::ShadeLitFrag.code(),
        Fragment::Normals => ShaderId::ShadeNormalsFrag.code(),
        Fragment::Flat => ShaderId::ShadeFlatFrag.code(),
        Fragment::Spirv(code) => code,
    };
    let fragment = without_instances(fragment, vk::ShaderStageFlags::FRAGMENT, false);
    let mut stages = vec![Shader::vertex(&vertex)];
    let dynamic_states: &[_] =
        if style.rasterizer_discard { &[vk::DynamicState::RASTERIZER_DISCARD_ENABLE] } else { &[] };
    if !style.rasterizer_discard {
        stages.push(Shader::fragment(&fragment));
    }
    let vectors = |binding| vk::VertexInputBindingDescription::default().binding(binding).stride(12);
    let attribute = |binding| {
        let format = vk::Format::R32G32B32_SFLOAT;
        vk::VertexInputAttributeDescription::default().location(binding).binding(binding).format(format)
    };
    let color = [target.color];
    let of_target = RenderTarget::Dynamic { color: &color, depth: target.depth, stencil: vk::Format::UNDEFINED };
    let desc = GraphicsPipelineDesc {
        vertex_bindings: &[vectors(0), vectors(1)],
        vertex_attributes: &[attribute(0), attribute(1)],
        topology: vk::PrimitiveTopology::TRIANGLE_LIST,
        polygon_mode: if style.wireframe { vk::PolygonMode::LINE } else { vk::PolygonMode::FILL },
        cull_mode: style.cull,
        front_face: style.front_face,
        line_width: style.line_width,
        depth: style.depth,
        depth_bias: style.depth_bias,
        blend: style.blend,
        samples: target.samples,
        dynamic_states,
        ..GraphicsPipelineDesc::new(NAME, layout, of_target, &stages)
    };
    // SAFETY: the shaders are ours, or the caller's that fit the styles of renderers, and match the layout and the target.
    unsafe { desc.create(context) }
}
