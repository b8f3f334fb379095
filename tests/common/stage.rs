//! A small picture with renderers for it, and the vertices that compute evaluates.

use ash::vk;
use ash_subdiv::gpu::MemoryLocation;
use ash_subdiv::headless::objects::{Buffer, BufferDesc};
use ash_subdiv::headless::{Headless, Offscreen, OffscreenDesc};
use ash_subdiv::renderer::{Evaluation, Factor};
use ash_subdiv::{DrawItem, Error, Frame, ModelId, Options, Renderer, Target, View};

/// A picture, and a renderer for it.
pub struct Stage {
    pub target: Offscreen,
    pub headless: Headless,
}

impl Stage {
    pub fn new() -> Self {
        let headless = super::headless();
        Self { target: Offscreen::new(&headless, &OffscreenDesc::new(96, 96)).expect("an image"), headless }
    }

    pub fn renderer(&self, options: &Options) -> Renderer {
        let desc = self.target.desc();
        let target = Target::dynamic(desc.color, desc.depth, desc.samples);
        // SAFETY: every submission is waited for, and the renderer is dropped before the stage.
        unsafe { Renderer::new(self.headless.context(), &target, options) }.expect("a renderer")
    }

    /// Begins a frame and prepares it.
    pub fn frame(&self, renderer: &mut Renderer) -> Frame {
        let frame = begin(renderer);
        self.prepare(renderer, frame);
        frame
    }

    pub fn prepare(&self, renderer: &mut Renderer, frame: Frame) {
        // SAFETY: the command buffer is being recorded, and submitted.
        self.headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, frame) }).expect("prepared");
    }

    /// Of a cube from -1 to 1.
    pub fn view() -> View {
        View::framing([glam::DVec3::NEG_ONE, glam::DVec3::ONE], [-0.6, 0.5, 1.0], 1.0)
    }

    pub fn draw(&self, renderer: &mut Renderer, frame: Frame, items: &[DrawItem]) -> Result<Vec<u8>, Error> {
        let view = Self::view();
        let record = |cmd| {
            // SAFETY: as above, inside rendering.
            unsafe { renderer.cmd_draw(cmd, frame, &view, items) }
        };
        self.target.draw(&self.headless, [0.0; 4], record)
    }

    pub fn finish(self) {
        drop(self.target);
        self.headless.finish_silent();
    }
}

/// Begins a frame, where every submission is waited for.
pub fn begin(renderer: &mut Renderer) -> Frame {
    // SAFETY: all frames before are done.
    unsafe { renderer.begin_frame() }
}

/// The vertices of a model that was prepared, as words.
pub fn read_vertices(headless: &Headless, renderer: &Renderer, model: ModelId) -> Vec<f32> {
    let vertices = renderer.evaluated_vertices(model).expect("a model").expect("segments");
    let (name, size) = ("vertices to read", vertices.size);
    let usage = vk::BufferUsageFlags::TRANSFER_DST;
    let desc = BufferDesc { name, size, usage, location: MemoryLocation::Readback };
    let buffer = Buffer::new(headless.context(), &desc).expect("a buffer");
    let region = vk::BufferCopy { size, ..vk::BufferCopy::default() };
    let device = headless.device();
    // SAFETY: both buffers hold the range; what wrote it was waited for.
    let copy = |cmd| unsafe { device.cmd_copy_buffer(cmd, vertices.buffer, buffer.raw(), &[region]) };
    headless.submit(copy).expect("a copy");
    buffer.read(0, size as usize / 4).expect("as many words")
}

/// The factor of draws of a model with `n` segments along every edge, which are set where they have to be.
pub fn with_segments(renderer: &mut Renderer, model: ModelId, evaluation: Evaluation, n: u32) -> Factor {
    if !evaluation.needs_segments() {
        return Factor::Uniform(n as f32);
    }
    renderer.set_segments(model, n).expect("segments");
    Factor::Segments
}
