//! What a frame does before its draws: copies, and what compute shaders make of them.

use super::{Frame, Renderer};
use crate::renderer::model::Model;
use crate::renderer::options::Error;
#[cfg(doc)]
use crate::renderer::{Construction, Evaluation};
use ash::vk;

impl Renderer {
    /// Records what has to happen before this frame's draws: copies, barriers, and what compute shaders make. Once a frame; again, it
    /// records what was set or added since.
    ///
    /// Where there is something to compute, it binds compute pipelines, with set 1, and pushes constants; models that are
    /// [`Evaluation::GeometryTwoPass`] have a render pass of their own here. What is bound for draws is to be bound after it.
    ///
    /// # Errors
    /// [`Error::OldFrame`]; failed Vulkan calls, after which the frame is [lost](Renderer::frame_lost).
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering, for a queue that can copy and draw, and compute if
    /// [positions of the device](Renderer::set_device_positions) were set for the frame, or a model is
    /// [`Construction::Cached`] (but for [`Evaluation::GeometryTwoPass`]) or [adaptive](crate::renderer::ModelOptions::adaptive), has
    /// faces of five and more corners ([`ModelOptions::refine`](crate::renderer::ModelOptions::refine)) or, with
    /// [`Options::visible_lists`](crate::renderer::Options::visible_lists), its [evaluation culls patches](Evaluation::culls). It is
    /// submitted before the next frame is, or [`Renderer::frame_lost`] is told: changes are recorded once, and later frames count on
    /// them.
    pub unsafe fn cmd_prepare(&mut self, cmd: vk::CommandBuffer, frame: Frame) -> Result<(), Error> {
        self.check_frame(frame)?;
        self.begun.is_prepared = true;
        let frame_index = frame.index();
        let are_given = self.begun.are_given();
        if !are_given && self.models.values().all(|model| model.is_at_rest()) {
            return Ok(());
        }
        let device = self.context.device();
        use vk::{AccessFlags as Access, PipelineStageFlags as Stage};
        let readers = Stage::VERTEX_INPUT | self.shader_readers();
        // Positions that the device gives are put there by compute, which reads what compute and copies of the caller's wrote.
        let (writers, written, read) = match are_given {
            true => (Stage::TRANSFER | Stage::COMPUTE_SHADER, Access::SHADER_WRITE, Access::SHADER_READ),
            false => (Stage::TRANSFER, Access::empty(), Access::empty()),
        };
        let none = vk::DependencyFlags::empty();
        let writes = Access::TRANSFER_WRITE | written;
        let after_copies = [vk::MemoryBarrier::default()
            .src_access_mask(writes)
            // Computation writes control points and vertices again, too.
            .dst_access_mask(Access::SHADER_READ | Access::SHADER_WRITE | Access::INDEX_READ)];
        let after_writes = [vk::MemoryBarrier::default().src_access_mask(writes).dst_access_mask(writes | read)];
        // SAFETY: as the caller promises; the copied ranges are of live buffers.
        unsafe {
            // The frame before may still read what is overwritten here.
            device.cmd_pipeline_barrier(cmd, readers | writers, writers, none, &after_writes, &[], &[]);
            for (&id, model) in &mut self.models {
                let mut sent = model.before();
                let given = self.begun.take_given(id).map(|given| (&self.pipelines.gather, given));
                model.mark_stale(given.is_some());
                let copies = given.is_some() || model.needs_copies();
                let copied = copies.then(|| model.cmd_copy(device, cmd, frame_index, given, &mut sent));
                self.begun.sent.push((Some(id), sent));
                copied.transpose()?;
            }
            device.cmd_pipeline_barrier(cmd, writers, readers, none, &after_copies, &[], &[]);
            self.cmd_compute(cmd);
        }
        Ok(())
    }

    /// Records what makes control points, and vertices where they are evaluated by compute, for draws to read them.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering, after the copies and the barrier that follows them. That and the one
    /// before the copies have the computation wait for what read the points before.
    pub(crate) unsafe fn cmd_compute(&mut self, cmd: vk::CommandBuffer) {
        let readers = self.shader_readers();
        let Self { models, pipelines, context, .. } = self;
        if !models.values().any(Model::is_stale) {
            return;
        }
        use vk::PipelineStageFlags as Stage;
        let makers = readers & (Stage::COMPUTE_SHADER | Stage::GEOMETRY_SHADER);
        let written = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::SHADER_WRITE)
            .dst_access_mask(vk::AccessFlags::SHADER_READ)];
        let none = vk::DependencyFlags::empty();
        let device = context.device();
        // SAFETY: as the caller promises; every pipeline of a model's kinds was made when it was added.
        unsafe {
            for model in models.values() {
                model.cmd_refine(pipelines, cmd);
            }
            for model in models.values().filter(|model| model.has_stale_points()) {
                model.cmd_frames(pipelines, cmd);
            }
            device.cmd_pipeline_barrier(cmd, makers, readers, none, &written, &[], &[]);
            for model in models.values().filter(|model| model.has_stale_points()) {
                model.cmd_points(pipelines, cmd);
            }
            device.cmd_pipeline_barrier(cmd, makers, readers, none, &written, &[], &[]);
        }
        for model in models.values_mut().filter(|model| model.is_stale()) {
            // SAFETY: as above, after the control points.
            unsafe { model.cmd_evaluate(&pipelines.uniform_grid, cmd) };
        }
        let evaluated = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::SHADER_WRITE)
            .dst_access_mask(vk::AccessFlags::VERTEX_ATTRIBUTE_READ)];
        // SAFETY: as the caller promises.
        unsafe {
            device.cmd_pipeline_barrier(cmd, makers, Stage::VERTEX_INPUT, none, &evaluated, &[], &[]);
        }
    }

    /// Has a model's control points and vertices made anew in the next frame: the bench times them.
    #[cfg(all(feature = "measure", feature = "headless"))]
    pub(crate) fn forget_control_points(&mut self, id: crate::renderer::ModelId) -> Result<(), Error> {
        self.models.get_mut(&id).ok_or(Error::NoSuchModel { id })?.forget_points();
        Ok(())
    }

    /// The shader stages that read what models keep in buffers.
    fn shader_readers(&self) -> vk::PipelineStageFlags {
        use vk::PipelineStageFlags as Stage;
        let mut readers =
            Stage::VERTEX_SHADER | Stage::TESSELLATION_CONTROL_SHADER | Stage::TESSELLATION_EVALUATION_SHADER;
        if self.context.features().geometry {
            readers |= Stage::GEOMETRY_SHADER;
        }
        // The queue may be one that does not compute.
        let lists = self.options.visible_lists;
        if self.models.values().any(|model| model.computes() || lists && model.options.evaluation.culls()) {
            readers |= Stage::COMPUTE_SHADER;
        }
        readers
    }
}
