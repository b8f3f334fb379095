//! The draws that fill the buffer.

use super::buffer::{HEAD_BYTES, Head};
use super::watch::{Watcher, Watchers};
use super::{CaptureDraw, Captured};
use crate::adaptive::AdaptiveOptions;
use crate::renderer::{Capture, DisplacementId, DrawItem, Error, Factor, ModelId, ModelOptions, Renderer};
use crate::topology::PatchKind;
use std::ops::Range;

/// Larger captures are done in several draws, each of which keeps some of the patches.
const MAX_BYTES: u64 = 128 << 20;

impl Captured<'_> {
    /// Words of all patches: [`Captured::capture_each`], collected.
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
        let watched = (mode, self.pipelines());
        let new = || Watcher::new(headless, mode, self.options.evaluation, &self.shaders);
        let mut watcher = if self.shaders.is_empty() { kept.take(&watched, new)? } else { new()? };
        let (model, map) = self.add_to(&mut watcher.renderer, mode, draw)?;
        let CaptureDraw { mut factor, cull, displacement, .. } = *draw;
        if self.evaluation(mode).needs_segments() {
            factor = Factor::Segments;
        }
        let item = DrawItem { factor, cull, displacement, ..DrawItem::new(model, 1.0) };
        for kind in PatchKind::ALL {
            let per_patch = bytes(kind);
            for window in self.windows(kind, per_patch) {
                let bytes = window.len() as u64 * per_patch;
                take(kind, watcher.watch(headless, mode, &draw.view, (item, self.given), head(&window), bytes)?)?;
            }
        }
        if self.shaders.is_empty() {
            let renderer = &mut watcher.renderer;
            renderer.remove_model(model)?;
            map.map_or(Ok(()), |map| renderer.remove_displacement(map))?;
            // SAFETY: the frame before was waited for. Frees the model.
            unsafe { renderer.begin_frame() };
            kept.put_back(watched, watcher);
        }
        Ok(())
    }

    /// The options without what pipelines do not depend on.
    fn pipelines(&self) -> ModelOptions {
        let of = |AdaptiveOptions { drawn_by, .. }| AdaptiveOptions { drawn_by, ..AdaptiveOptions::default() };
        let adaptive = self.options.adaptive.map(of);
        ModelOptions { name: String::new(), refine: 0, adaptive, ..self.options.clone() }
    }

    /// Adds the model to a renderer, ready for this draw, with its displacement map if it has one.
    fn add_to(
        &self,
        renderer: &mut Renderer,
        mode: Capture,
        draw: &CaptureDraw,
    ) -> Result<(ModelId, Option<DisplacementId>), Error> {
        // SAFETY: as the caller of `displaced` promises. Only models look at maps, and this one goes before the map does.
        let map = self.displacement.map(|map| unsafe { renderer.add_displacement(map) });
        let options = ModelOptions { evaluation: self.evaluation(mode), displacement: map, ..self.options.clone() };
        // Only the pipelines of this draw: making others would take longer than drawing.
        let drawn = (draw.factor, draw.cull);
        let model = renderer.add_drawn(self.tables.clone(), &self.positions, &options, drawn)?;
        if options.evaluation.needs_segments() {
            let most = match draw.factor {
                Factor::Uniform(factor) => factor,
                _ => draw.edge_factors.iter().copied().fold(1.0, f32::max),
            };
            renderer.set_segments(model, most.ceil() as u32)?;
        }
        if let Factor::Edges(_) = draw.factor {
            // SAFETY: every submission is waited for.
            let frame = unsafe { renderer.begin_frame() };
            renderer.set_edge_factors(model, frame, &draw.edge_factors)?;
            renderer.frame_lost(frame)?;
        }
        Ok((model, map))
    }

    /// The patches of a kind, as many at a time as one buffer holds.
    pub(super) fn windows(&self, kind: PatchKind, bytes: u64) -> impl Iterator<Item = Range<u32>> {
        let patches = self.tables.plan().range(kind);
        let (start, end) = (patches.start as u32, patches.end as u32);
        let max = MAX_BYTES.min(self.headless.properties().max_storage_buffer_range) - HEAD_BYTES;
        let step = (max / bytes).max(1) as usize;
        (start..end).step_by(step).map(move |first| first..end.min(first + step as u32))
    }
}
