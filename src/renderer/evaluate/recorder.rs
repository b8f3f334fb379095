//! Recording draws: what is bound, and what is pushed.

use super::uniform_grid::BoundUniformGrid;
use crate::gpu::{Buffer, DeviceProperties};
use crate::renderer::shader::{DrawConstants, PatchStages, STAGES};
use crate::table::PatchGroup;
use ash::vk;

/// What is bound in a command buffer so far.
#[derive(Default)]
pub(crate) struct Bound {
    pub pipeline: vk::Pipeline,
    pub set: vk::DescriptorSet,
    pub uniform_grid: BoundUniformGrid,
    /// Whether the rasterizer was told to discard since the last pipeline that cannot be told.
    pub discards: bool,
}

/// Where shaders find the view and the item.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// Set 0.
    pub set: vk::DescriptorSet,
    /// Bytes before the view in its buffer.
    pub view: u32,
    /// Bytes before the item's record in its buffer.
    pub record: u32,
    pub instances: Option<PlacedInstances>,
}

/// Where shaders find the instances of an item.
#[derive(Clone, Copy)]
pub(crate) struct PlacedInstances {
    pub count: u32,
    /// The word where the first is.
    pub first_word: u32,
    /// Words from one to the next.
    pub stride: u32,
}

/// The draws of one item.
pub(crate) struct Recorder<'r> {
    pub device: &'r ash::Device,
    pub properties: &'r DeviceProperties,
    pub layout: vk::PipelineLayout,
    pub cmd: vk::CommandBuffer,
    pub place: Place,
    pub bound: &'r mut Bound,
    pub constants: DrawConstants,
}

/// A group of patches, to be drawn.
pub(crate) struct DrawnGroup<'m> {
    pub number: usize,
    pub stages: PatchStages,
    pub group: &'m PatchGroup,
    /// The largest factor of an edge.
    pub most: f32,
    /// Control points that are kept.
    pub control_points: Option<&'m Buffer>,
}

impl Recorder<'_> {
    /// Binds the view, the item and the set of its model.
    ///
    /// # Safety
    /// `cmd` is being recorded.
    pub(crate) unsafe fn bind_item(&mut self, model: vk::DescriptorSet) {
        let sets = [self.place.set, model];
        let changed = if self.bound.set == model { &sets[..1] } else { &sets[..] };
        self.bound.set = model;
        // SAFETY: as the caller promises.
        unsafe { self.bind(changed, 0) };
    }

    /// Binds a list of patches, which starts at `offset` bytes in the buffer of the lists.
    ///
    /// # Safety
    /// `cmd` is being recorded.
    pub(crate) unsafe fn bind_list(&self, offset: u32) {
        // SAFETY: as the caller promises.
        unsafe { self.bind(&[self.place.set], offset) };
    }

    /// Binds sets from set 0 on, with the offsets of the view, a list and the item.
    unsafe fn bind(&self, sets: &[vk::DescriptorSet], list: u32) {
        let (point, offsets) = (vk::PipelineBindPoint::GRAPHICS, [self.place.view, list, self.place.record]);
        // SAFETY: as the caller promises.
        unsafe { self.device.cmd_bind_descriptor_sets(self.cmd, point, self.layout, 0, sets, &offsets) };
    }

    /// Pushes the constants.
    ///
    /// # Safety
    /// `cmd` is being recorded.
    pub(crate) unsafe fn push(&self) {
        let constants = bytemuck::bytes_of(&self.constants);
        // SAFETY: as the caller promises.
        unsafe { self.device.cmd_push_constants(self.cmd, self.layout, STAGES, 0, constants) };
    }

    /// Records the draws of an item with `patches` patches (or tiles of them), once or of all its instances: of as many at a time, which
    /// `draw` is told, as can be counted.
    pub(crate) fn cmd_draw_instances(&mut self, patches: u32, mut draw: impl FnMut(&mut Self, u32)) {
        let Some(PlacedInstances { count, first_word, stride }) = self.place.instances else {
            draw(self, 1);
            return;
        };
        self.constants.patches = patches;
        self.constants.instance_stride = stride;
        let step = u32::MAX / patches.max(1);
        for first in (0..count).step_by(step as usize) {
            self.constants.first_word = first_word + first * stride;
            draw(self, step.min(count - first));
        }
    }

    /// Records the draws of `count` patches (or tiles of them), in each instance of the item. As [`Recorder::cmd_draw_all`].
    ///
    /// # Safety
    /// As [`Renderer::cmd_draw`](crate::Renderer::cmd_draw), with the pipeline bound.
    pub(crate) unsafe fn cmd_draw_batches(&mut self, count: u32, points: u32, vertices: u32) {
        // SAFETY: as the caller promises.
        self.cmd_draw_instances(count, |recorder, instances| unsafe {
            recorder.cmd_draw_all(instances * count, points, vertices);
        });
    }

    /// Records the draws of `count` patches (or tiles of them), in instances as the device likes them. Each has `points` points, and
    /// at most `vertices` vertices when it is evaluated.
    ///
    /// # Safety
    /// As [`Renderer::cmd_draw`](crate::Renderer::cmd_draw), with the pipeline bound.
    unsafe fn cmd_draw_all(&mut self, count: u32, points: u32, vertices: u32) {
        for draw in self.properties.patch_batch.draws(count, points, vertices) {
            // SAFETY: as the caller promises.
            unsafe {
                if self.constants.patches_per_instance != draw.patches_per_instance || draw.first_instance == 0 {
                    self.constants.patches_per_instance = draw.patches_per_instance;
                    self.push();
                }
                self.device.cmd_draw(self.cmd, draw.vertex_count, draw.instance_count, 0, draw.first_instance);
            }
        }
    }
}
