//! Views of which compute culls the patches that cannot be seen, before they are drawn.
//!
//! A control shader can cull a patch only when most of the work is done: the vertex shader ran, the control points are
//! there. A compute shader finds out before, with all lanes at work, and lists the patches that are left for indirect draws: in
//! their order, but of every 128 first those within the frustum, then those that cross it. Where control points are not cached it
//! makes those of all patches, and the draws make those of the patches that are left again.

use super::lists::ListLayout;
use super::resolved::ResolvedItem;
use super::visible::{ItemLists, List, VisibleItem, VisibleItems};
use super::{Frame, Renderer};
#[cfg(doc)]
use crate::renderer::Evaluation;
use crate::renderer::evaluate::{Bound, Drawn, Place, path};
use crate::renderer::options::{Cull, DrawItem, Error, Geometry, View};
use crate::renderer::shader::{Cut, PatchStages};
use crate::table::PatchGroup;
use ash::vk;

impl Renderer {
    /// Records the search for the patches of some items that can be seen in a view, by their
    /// [`DrawItem::cull`]: for [`Renderer::cmd_draw_visible`], as often as you like in this frame.
    ///
    /// It is for models whose [evaluation culls patches](Evaluation::culls), whatever their construction: control points that
    /// are not [`Cached`](crate::renderer::Construction::Cached) are made for this, and again where patches are drawn. Others are drawn as by
    /// [`Renderer::cmd_draw`]. Takes memory, which is kept for later frames: a little more than four bytes a patch, and for
    /// instances what they read of it, 256 bytes of a Gregory patch. Binds compute pipelines, with sets 0 and 1, and counts as one
    /// of [`Options::views_per_frame`](crate::renderer::Options::views_per_frame).
    ///
    /// # Errors
    /// As [`Renderer::cmd_draw`]; [`Error::NoVisibleLists`]; [`Error::ListsTooLarge`]; [`Error::CulledInstances`]. What was recorded until then does no harm.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering, after [`Renderer::cmd_prepare`] of the same frame, for the same queue, which
    /// computes.
    pub unsafe fn cmd_cull(
        &mut self,
        cmd: vk::CommandBuffer,
        frame: Frame,
        view: &View,
        items: &[DrawItem],
    ) -> Result<VisibleItems, Error> {
        self.check_prepared(frame)?;
        let frame_index = frame.index();
        if !self.options.visible_lists {
            return Err(Error::NoVisibleLists);
        }
        if let Some(item) = items.iter().find(|item| item.instances.is_some()) {
            return Err(Error::CulledInstances { id: item.model });
        }
        let view_offset = self.take_view(frame_index, view)?;
        let items = items.iter().map(|item| self.with_segments(item)).collect::<Result<Vec<_>, Error>>()?;
        let mut bytes = 0;
        for item in &items {
            self.resolve(view, item)?;
            let lists = self.listed_groups(item)?.next().is_some();
            self.make_cuts(item.model, Cut::new(item.factor, item.cull), item.factor, lists)?;
            for (_, stages, group) in self.listed_groups(item)? {
                let layout = ListLayout::new(stages);
                bytes += pieces(group, layout).map(|(_, count)| layout.bytes(count)).sum::<u64>();
            }
        }
        self.make_room(frame_index, bytes, items.len())?;
        let mut listed = Vec::with_capacity(items.len());
        for item in &items {
            let lists = self.take_lists(frame_index, view, item)?;
            let ResolvedItem { record, drawn, .. } = self.resolve(view, item)?;
            let uniform_grid = drawn.and_then(Drawn::uniform_grid).filter(|_| !lists.is_empty());
            let segments = uniform_grid.map(|uniform_grid| uniform_grid.segments);
            let record = self.lists[frame_index as usize].records.push(&record)?;
            listed.push(VisibleItem { item: *item, record, lists, segments });
        }
        let lists = &self.lists[frame_index as usize];
        let (set, buffer) = (lists.set.raw(), lists.raw());
        let visible = VisibleItems { frame, view: *view, view_offset, set, buffer, items: listed };
        if bytes > 0 {
            // SAFETY: as the caller promises.
            unsafe { self.cmd_lists(cmd, &visible)? };
        }
        Ok(visible)
    }

    /// Records the draws of what [`Renderer::cmd_cull`] found. Otherwise as [`Renderer::cmd_draw`].
    ///
    /// # Errors
    /// As [`Renderer::cmd_draw`]; [`Error::OtherFrame`] if `visible` was found for another frame or by another renderer; [`Error::OtherSegments`] if the segments were changed since.
    ///
    /// # Safety
    /// As [`Renderer::cmd_draw`]; after [`Renderer::cmd_cull`].
    pub unsafe fn cmd_draw_visible(
        &mut self,
        cmd: vk::CommandBuffer,
        frame: Frame,
        visible: &VisibleItems,
    ) -> Result<(), Error> {
        self.check_prepared(frame)?;
        if visible.frame != frame {
            return Err(Error::OtherFrame);
        }
        let mut bound = Bound::default();
        for own in &visible.items {
            let lists = Some(ItemLists { all: visible, own });
            let place = Place { set: visible.set, view: visible.view_offset, record: own.record, instances: None };
            let resolved = self.resolve(&visible.view, &own.item)?;
            // SAFETY: as the caller promises.
            unsafe { self.cmd_draw_item(cmd, place, &resolved, lists, &mut bound)? };
        }
        Ok(())
    }

    /// The groups of which lists are made, if any, with their number.
    fn listed_groups(&self, item: &DrawItem) -> Result<impl Iterator<Item = (usize, PatchStages, &PatchGroup)>, Error> {
        let model = self.model(item.model)?;
        let surface = self.style(item)?.geometry == Geometry::Surface;
        let any = surface && item.cull != Cull::NONE && model.options.evaluation.culls();
        let groups = model.stages.iter().zip(model.tables.plan().groups()).enumerate();
        let groups = groups.map(|(number, (&stages, group))| (number, stages, group));
        Ok(groups.filter(move |(_, stages, _)| any && stages.has_hull()))
    }

    fn take_lists(&mut self, frame: u32, view: &View, item: &DrawItem) -> Result<Vec<List>, Error> {
        let ResolvedItem { model, most, .. } = self.resolve(view, item)?;
        let mut lists = Vec::new();
        for (number, stages, group) in self.listed_groups(item)? {
            let layout = ListLayout::new(stages);
            for (first, count) in pieces(group, layout) {
                let properties = self.context.properties();
                let patches_per_instance =
                    path(model.options.evaluation).patches_per_instance(properties, stages, count, most);
                let list = List { group: number, first, count, offset: 0, patches_per_instance };
                lists.push((list, layout.bytes(count)));
            }
        }
        let room = &mut self.lists[frame as usize];
        Ok(lists.into_iter().map(|(list, bytes)| List { offset: room.take(bytes), ..list }).collect())
    }

    unsafe fn cmd_lists(&self, cmd: vk::CommandBuffer, visible: &VisibleItems) -> Result<(), Error> {
        use vk::{AccessFlags as Access, PipelineStageFlags as Stage};
        for VisibleItem { item, record, lists, .. } in &visible.items {
            let ResolvedItem { model, constants: of_draw, .. } = self.resolve(&visible.view, item)?;
            let drawn = model.drawn(item.factor)?;
            for list in lists {
                let constants = list.constants(model, drawn, &of_draw);
                let key = (model.stages[list.group], Cut::new(item.factor, item.cull));
                let (sets, offsets) = ([visible.set, model.set.raw], [visible.view_offset, list.offset, *record]);
                // SAFETY: as the caller promises.
                unsafe { self.list_pipelines.cmd_list(cmd, key, sets, offsets, &constants) };
            }
        }
        let read = Access::SHADER_READ | Access::INDIRECT_COMMAND_READ | Access::VERTEX_ATTRIBUTE_READ;
        let written = [vk::MemoryBarrier::default().src_access_mask(Access::SHADER_WRITE).dst_access_mask(read)];
        let readers = Stage::DRAW_INDIRECT | Stage::VERTEX_INPUT | Stage::VERTEX_SHADER;
        let (device, none) = (self.context.device(), vk::DependencyFlags::empty());
        // SAFETY: as the caller promises.
        unsafe { device.cmd_pipeline_barrier(cmd, Stage::COMPUTE_SHADER, readers, none, &written, &[], &[]) };
        Ok(())
    }
}

/// The patches of a group in pieces that a list has room for: from which on, and how many.
fn pieces(group: &PatchGroup, layout: ListLayout) -> impl Iterator<Item = (u32, u32)> {
    let (patches, most) = (group.patches.len() as u32, layout.max_patches());
    (0..patches).step_by(most as usize).map(move |first| (first, most.min(patches - first)))
}
