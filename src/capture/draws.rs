//! The buffer that the shaders write to, and the draws that fill it.

use super::watch::{Watcher, Watchers};
use super::{CaptureDraw, Captured, CapturedVertex};
use crate::gpu::{Buffer, BufferDesc, DescriptorSet, DeviceContext, GpuError, MemoryLocation};
use crate::renderer::{Capture, DrawItem, Error, Factor, ModelOptions};
use crate::topology::PatchKind;
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use std::sync::Arc;

/// The head of the buffer. GLSL twin: `glsl/lib/capture/capture.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct Head {
    pub first_patch: u32,
    pub patches: u32,
    pub grid: u32,
    pub capacity: u32,
    pub count: u32,
}

pub(super) const HEAD_BYTES: u64 = size_of::<Head>() as u64;
pub(super) const RECORD_BYTES: u64 = size_of::<CapturedVertex>() as u64;
/// Words that the control points of a patch take, whatever its kind.
pub(super) const CONTROL_POINT_WORDS: usize = 96;
/// Words that its factors take, after them.
pub(super) const FACTOR_WORDS: usize = 7;
/// In the place of a grid's size: vertices on edges as they come.
pub(super) const EDGES_ONLY: u32 = u32::MAX;
/// Larger captures are done in several draws, each of which keeps some of the patches.
const MAX_BYTES: u64 = 128 << 20;

const _: () = assert!(RECORD_BYTES == 40 && HEAD_BYTES == 20);

impl Captured<'_> {
    /// What [`Captured::capture_each`] captures, together.
    pub(super) fn capture(
        &self,
        mode: Capture,
        draw: &CaptureDraw,
        bytes: impl Fn(PatchKind) -> u64,
        head: impl Fn(&Range<u32>) -> Head,
    ) -> Result<Vec<(PatchKind, Vec<f32>)>, Error> {
        let mut captured = Vec::new();
        self.capture_each(mode, draw, bytes, head, |kind, words| {
            captured.push((kind, words));
            Ok(())
        })?;
        Ok(captured)
    }

    /// Draws all patches, as often as needed to keep what each of them writes. `bytes` is for one patch; the words
    /// come by kind of patch, in the order of the patches.
    pub(super) fn capture_each(
        &self,
        mode: Capture,
        draw: &CaptureDraw,
        bytes: impl Fn(PatchKind) -> u64,
        head: impl Fn(&Range<u32>) -> Head,
        mut take: impl FnMut(PatchKind, Vec<f32>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let headless = self.headless;
        let kept = headless.kept::<Watchers>();
        let watched = (mode, self.options.clone());
        let new = || Watcher::new(headless, mode, self.options.evaluation, &self.shaders);
        let mut watcher = if self.shaders.is_empty() { kept.take(&watched, new)? } else { new()? };
        let Watcher { renderer, layout, target, idle } = &mut watcher;
        // SAFETY: as the caller of `displaced` promises. Only models look at maps, and this one goes before the map does.
        let map = self.displacement.map(|map| unsafe { renderer.add_displacement(map) });
        let model_options =
            ModelOptions { evaluation: self.evaluation(mode), displacement: map, ..self.options.clone() };
        let model = renderer.add_tables(self.tables.clone(), &self.positions, &model_options)?;
        if model_options.evaluation.needs_segments() {
            let most = match draw.factor {
                Factor::Uniform(factor) => factor,
                _ => draw.edge_factors.iter().copied().fold(1.0, f32::max),
            };
            renderer.set_segments(model, most.ceil() as u32)?;
        }
        if let Factor::Edges(_) = draw.factor {
            renderer.set_edge_factors(model, 0, &draw.edge_factors)?;
        }
        let CaptureDraw { factor, cull, displacement, .. } = *draw;
        let item = DrawItem { factor, cull, displacement, ..DrawItem::new(model, 1.0) };

        for kind in PatchKind::ALL {
            let patches = self.tables.plan().range(kind);
            let (patches, per_patch) = (patches.start as u32..patches.end as u32, bytes(kind));
            let max = MAX_BYTES.min(headless.properties().max_storage_buffer_range) - HEAD_BYTES;
            let step = (max / per_patch).max(1) as usize;
            for first in patches.clone().step_by(step) {
                let window = first..patches.end.min(first + step as u32);
                let size = HEAD_BYTES + window.len() as u64 * per_patch;
                let mut buffer = capture_buffer(headless.context(), size)?;
                // What no shader writes is NaN.
                buffer.write(0, &vec![f32::NAN; size as usize / 4])?;
                let head = head(&window);
                buffer.write(0, &[head])?;
                let part = |buffer: &Buffer| (vk::DescriptorType::STORAGE_BUFFER, buffer.descriptor());
                let parts: Vec<_> = idle.iter().chain([&buffer]).map(part).collect();
                // SAFETY: the layout is of this device, and has as many; every submission is waited for.
                let set = unsafe { DescriptorSet::of_buffers(headless.context(), layout.raw(), "capture", &parts)? };
                let pipeline_layout = renderer.pipeline_layout();
                // SAFETY: the command buffer is being recorded; rendering is begun and ended in it, and fits the target.
                headless.try_submit(|cmd| unsafe {
                    renderer.cmd_prepare(cmd, 0)?;
                    target.cmd_begin(cmd, [0.0; 4]);
                    let point = vk::PipelineBindPoint::GRAPHICS;
                    headless.device().cmd_bind_descriptor_sets(cmd, point, pipeline_layout, 2, &[set.raw()], &[]);
                    renderer.cmd_draw(cmd, 0, &draw.view, &[item])?;
                    target.cmd_end(cmd);
                    Ok::<(), Error>(())
                })?;
                let words = if matches!(mode, Capture::Vertices | Capture::Triangles) {
                    let Head { count, .. } = buffer.read::<Head>(0, 1)?[0];
                    u64::from(count) * RECORD_BYTES / 4
                } else {
                    (size - HEAD_BYTES) / 4
                };
                take(kind, buffer.read(HEAD_BYTES, words as usize)?)?;
            }
        }
        if self.shaders.is_empty() {
            renderer.remove_model(model)?;
            map.map_or(Ok(()), |map| renderer.remove_displacement(map))?;
            // SAFETY: the command buffer is being recorded; the frame before was waited for. Frees the model.
            headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, 0) })?;
            kept.put_back(watched, watcher);
        }
        Ok(())
    }
}

pub(super) fn capture_buffer(context: &Arc<DeviceContext>, size: u64) -> Result<Buffer, GpuError> {
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    Buffer::new(context, &BufferDesc { name: "capture", size, usage, location: MemoryLocation::Readback })
}
