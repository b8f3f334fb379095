//! Control points made by the geometry shader, in a pass of their own before the draws (Ni et al. 2008).

use crate::constants::ID_STRIDE;
use crate::gpu::{
    DeviceContext, GpuError, GraphicsPipelineDesc, Owned, RenderTarget, Shader, Specialization, VkResultExt,
    pipeline_layout,
};
use crate::renderer::shader::{PatchStages, ShaderCode, reads_texels};
use crate::renderer::shader::{ShaderKey, Source};
use crate::table::PatchPlan;
use ash::vk;
use bytemuck::{Pod, Zeroable};
use rustc_hash::FxHashMap;
use std::sync::Arc;

const NAME: &str = "subdiv conversion";

/// The patches of one kind, as push constants. GLSL twin: `Patches` in `glsl/construct/convert.geom`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Patches {
    first_patch: u32,
    first_corner: u32,
    corners: u32,
}

/// Pipelines by how many control points a corner owns and has room for, and a pass without attachments to run them in.
pub(crate) struct Conversion {
    context: Arc<DeviceContext>,
    layout: Owned<vk::PipelineLayout>,
    cache: vk::PipelineCache,
    pass: Owned<vk::RenderPass>,
    framebuffer: Owned<vk::Framebuffer>,
    made: FxHashMap<[u32; 2], Owned<vk::Pipeline>>,
}

fn key(stages: PatchStages) -> [u32; 2] {
    [stages.scheme.owned(stages.kind) as u32, stages.stride]
}

impl Conversion {
    /// With the set layouts of the draws.
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        sets: [vk::DescriptorSetLayout; 2],
        cache: vk::PipelineCache,
    ) -> Result<Self, GpuError> {
        let constants = [vk::PushConstantRange {
            stage_flags: vk::ShaderStageFlags::GEOMETRY,
            offset: 0,
            size: size_of::<Patches>() as u32,
        }];
        let subpass = [vk::SubpassDescription::default().pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)];
        let pass = vk::RenderPassCreateInfo::default().subpasses(&subpass);
        let device = context.device();
        // SAFETY: the set layouts are of this device; what is created is taken over by `Owned`.
        unsafe {
            let layout = pipeline_layout(context, NAME, &sets, &constants)?;
            let pass = device.create_render_pass(&pass, None).of("vkCreateRenderPass", NAME)?;
            let pass = Owned::new(context, pass, NAME);
            let framebuffer = vk::FramebufferCreateInfo::default().render_pass(pass.raw()).width(1).height(1).layers(1);
            let framebuffer = device.create_framebuffer(&framebuffer, None).of("vkCreateFramebuffer", NAME)?;
            let framebuffer = Owned::new(context, framebuffer, NAME);
            Ok(Self { context: context.clone(), layout, cache, pass, framebuffer, made: FxHashMap::default() })
        }
    }

    /// Makes what patches need.
    pub(crate) fn make(&mut self, stages: PatchStages, code: &ShaderCode) -> Result<(), GpuError> {
        let key = key(stages);
        if self.made.contains_key(&key) {
            return Ok(());
        }
        let [_, stride] = key;
        let constants = [Specialization::uint(ID_STRIDE, stride), reads_texels(self.context.properties())];
        let shaders = [
            Shader::vertex(code.find(ShaderKey::of(Source::ConvertVert))?),
            Shader::geometry(code.find(stages.conversion())?).specialized(&constants),
        ];
        let target = RenderTarget::RenderPass { render_pass: self.pass.raw(), subpass: 0, color_attachments: 0 };
        let desc = GraphicsPipelineDesc {
            topology: vk::PrimitiveTopology::POINT_LIST,
            rasterizer_discard: true,
            cache: self.cache,
            ..GraphicsPipelineDesc::new(NAME, self.layout.raw(), target, &shaders)
        };
        // SAFETY: the shaders are ours and match the layout and the pass.
        let pipeline = unsafe { desc.create(&self.context)? };
        self.made.insert(key, pipeline);
        Ok(())
    }

    /// Records the pass for all patches of a model, whose set this is.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering; the pipelines of `stages` were made.
    pub(crate) unsafe fn cmd_convert(
        &self,
        cmd: vk::CommandBuffer,
        set: vk::DescriptorSet,
        stages: &[PatchStages],
        plan: &PatchPlan,
    ) {
        let (device, layout) = (self.context.device(), self.layout.raw());
        let point = vk::PipelineBindPoint::GRAPHICS;
        let begin = vk::RenderPassBeginInfo::default()
            .render_pass(self.pass.raw())
            .framebuffer(self.framebuffer.raw())
            .render_area(vk::Rect2D { extent: vk::Extent2D { width: 1, height: 1 }, ..Default::default() });
        // SAFETY: as the caller promises; the pass is ended below.
        unsafe {
            device.cmd_begin_render_pass(cmd, &begin, vk::SubpassContents::INLINE);
            device.cmd_bind_descriptor_sets(cmd, point, layout, 1, &[set], &[]);
        }
        for (&stages, group) in stages.iter().zip(plan.groups()) {
            let Some(pipeline) = self.made.get(&key(stages)) else { continue };
            let corners = group.kind.corners() as u32;
            let (first_patch, first_corner) = (group.patches.start as u32, group.first_corner as u32);
            let patches = Patches { first_patch, first_corner, corners };
            // SAFETY: as above.
            unsafe {
                device.cmd_bind_pipeline(cmd, point, pipeline.raw());
                let stage = vk::ShaderStageFlags::GEOMETRY;
                device.cmd_push_constants(cmd, layout, stage, 0, bytemuck::bytes_of(&patches));
                device.cmd_draw(cmd, group.patches.len() as u32 * corners, 1, 0, 0);
            }
        }
        // SAFETY: as above.
        unsafe { device.cmd_end_render_pass(cmd) };
    }
}
