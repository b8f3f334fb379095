//! Renderers that are kept from one use to the next: making their pipelines takes longer than most of what they are asked for.

use super::buffer::{HEAD_BYTES, Head, RECORD_BYTES, capture_buffer};
use crate::gpu::{Buffer, DescriptorPool, DescriptorSet, SetLayout, descriptor_set_layout};
use crate::headless::{Headless, Offscreen, OffscreenDesc};
use crate::renderer::{
    Capture, DevicePositions, DrawItem, Error, Evaluation, ModelOptions, Options, Renderer, STAGES, ShaderId, Style,
    Target, View,
};
use ash::vk;
use bytemuck::Zeroable;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

/// Entries that a pool keeps: a driver may take 20 MB for a pipeline.
const KEPT: usize = 4;

/// Pool of idle values by key; it keeps those used last.
pub(crate) struct Idle<K, T>(Mutex<VecDeque<(K, T)>>);

impl<K, T> Default for Idle<K, T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: PartialEq, T> Idle<K, T> {
    /// One that was put back, else one that is made now.
    pub(crate) fn take(&self, key: &K, make: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
        let mut idle = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let found = idle.iter().position(|(of, _)| of == key).and_then(|index| idle.remove(index));
        drop(idle);
        found.map_or_else(make, |(_, kept)| Ok(kept))
    }

    /// For the next. What failed in some way is better dropped.
    pub(crate) fn put_back(&self, key: K, used: T) {
        let mut idle = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        idle.push_back((key, used));
        let oldest = if idle.len() > KEPT { idle.pop_front() } else { None };
        // Destroying pipelines takes its time, too.
        drop(idle);
        drop(oldest);
    }
}

/// A renderer that watches, without a model between captures, and what it draws with.
pub(super) struct Watcher {
    pub renderer: Renderer,
    /// Layout of set 2.
    pub layout: SetLayout,
    pub sets: Arc<DescriptorPool>,
    pub target: Offscreen,
    /// Where triangles are written down, the evaluation shader has a buffer to itself, and writes none of its vertices.
    pub idle: Option<Buffer>,
}

/// Pool of watchers with the crate's own shaders, for all models of a device ([`Headless::kept`]).
pub(super) type Watchers = Idle<(Capture, ModelOptions), Watcher>;

impl Watcher {
    /// `shaders` are in the place of the crate's own.
    pub fn new(
        headless: &Headless,
        mode: Capture,
        evaluation: Evaluation,
        shaders: &[(ShaderId, Vec<u32>)],
    ) -> Result<Self, Error> {
        let context = headless.context();
        let mut bindings = vec![(vk::DescriptorType::STORAGE_BUFFER, STAGES)];
        let mut idle = None;
        if mode == Capture::Triangles {
            bindings.push((vk::DescriptorType::STORAGE_BUFFER, vk::ShaderStageFlags::GEOMETRY));
            let mut buffer = capture_buffer(context, HEAD_BYTES + RECORD_BYTES)?;
            buffer.write(0, &[Head::zeroed()])?;
            idle = Some(buffer);
        }
        let layout = descriptor_set_layout(context, "capture", &bindings)?;
        let sets = DescriptorPool::new(context, "capture", &[&layout]);
        let target = Offscreen::new(headless, &OffscreenDesc::new(4, 4))?;
        let options = Options {
            frames_in_flight: 1,
            styles: vec![Style { rasterizer_discard: true, ..Style::default() }],
            set_layouts: vec![layout.raw()],
            shaders: shaders.to_vec(),
            evaluations: vec![evaluation],
            ..Options::default()
        };
        let desc = target.desc();
        let render_target = Target::dynamic(desc.color, desc.depth, desc.samples);
        // SAFETY: the set layout is that of the capture buffer and outlives the renderer, which is dropped when idle:
        // every submission is waited for.
        let renderer = unsafe { Renderer::with_capture(context, &render_target, &options, mode)? };
        Ok(Self { renderer, layout, sets, target, idle })
    }

    /// Draws, and reads what the shaders wrote behind `head` into a buffer of `bytes` more.
    pub fn watch(
        &mut self,
        headless: &Headless,
        mode: Capture,
        view: &View,
        (item, given): (DrawItem, Option<DevicePositions>),
        head: Head,
        bytes: u64,
    ) -> Result<Vec<f32>, Error> {
        let Self { renderer, layout, sets, target, idle } = self;
        let size = HEAD_BYTES + bytes;
        let mut buffer = capture_buffer(headless.context(), size)?;
        // What no shader writes is NaN.
        buffer.write(0, &vec![f32::NAN; size as usize / 4])?;
        buffer.write(0, &[head])?;
        let parts: Vec<_> = idle.iter().chain([&buffer]).map(Buffer::descriptor).collect();
        // SAFETY: the layout is that of the pool, and has as many; every submission is waited for.
        let set = unsafe { DescriptorSet::of_buffers(sets, layout, "capture", &parts)? };
        let pipeline_layout = renderer.pipeline_layout();
        // SAFETY: the command buffer is being recorded; rendering is begun and ended in it, and fits the target.
        headless.try_submit(|cmd| unsafe {
            let frame = renderer.begin_frame();
            given.map_or(Ok(()), |given| renderer.set_device_positions(item.model, frame, given))?;
            renderer.cmd_prepare(cmd, frame)?;
            target.cmd_begin(cmd, [0.0; 4]);
            let point = vk::PipelineBindPoint::GRAPHICS;
            headless.device().cmd_bind_descriptor_sets(cmd, point, pipeline_layout, 2, &[set.raw()], &[]);
            renderer.cmd_draw(cmd, frame, view, &[item])?;
            target.cmd_end(cmd);
            Ok::<(), Error>(())
        })?;
        let words = if matches!(mode, Capture::Vertices | Capture::Triangles) {
            let Head { count, .. } = buffer.read::<Head>(0, 1)?[0];
            u64::from(count) * RECORD_BYTES / 4
        } else {
            bytes / 4
        };
        Ok(buffer.read(HEAD_BYTES, words as usize)?)
    }
}
