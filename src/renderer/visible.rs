//! Views of which compute leaves out the patches that cannot be seen, before they are drawn.
//!
//! A control shader can leave out a patch only when most of the work is done: the vertex shader ran, the control points are
//! there. A compute shader finds out before, with all lanes at work, and lists the patches that are left for indirect draws: in
//! their order, but of every 128 first those within the frustum, then those that cross it. Where control points are not cached it
//! makes those of all patches, and the draws make those of the patches that are left again.

use super::draw::Bound;
use super::evaluated::Drawn;
use super::factor::{Cull, Cut};
use super::gpu_data::DrawConstants;
use super::lattice::BoundLattice;
use super::lists::{FrameLists, ListConstants, ListLayout, REGION};
use super::model::Model;
use super::stages::PatchStages;
use super::{DrawItem, Error, Evaluation, Geometry, Renderer, RetiredObject, View};
use crate::gpu::Features;
use crate::table::PatchGroup;
use ash::vk;

/// The items of a view, with lists of the patches of them that can be seen: made by [`Renderer::cmd_cull`], drawn by
/// [`Renderer::cmd_draw_visible`].
#[derive(Debug, Clone)]
pub struct VisibleItems {
    frame: u32,
    /// Which preparation of the frame they are of.
    preparation: u64,
    view: View,
    view_offset: u32,
    set: vk::DescriptorSet,
    buffer: vk::Buffer,
    items: Vec<VisibleItem>,
}

#[derive(Debug, Clone)]
struct VisibleItem {
    item: DrawItem,
    lists: Vec<List>,
    /// Of the lattice whose indices the draws count, if it is one.
    segments: Option<u32>,
}

impl VisibleItems {
    /// The same, all in another of [`Options::styles`](super::Options::styles): such as for depth alone. With [`Cull::back`] in
    /// one that leaves out the same faces.
    pub fn in_style(&self, style: usize) -> Self {
        let mut other = self.clone();
        other.items.iter_mut().for_each(|visible| visible.item.style = style);
        other
    }
}

/// The lists of an item.
#[derive(Clone, Copy)]
pub(super) struct ItemLists<'v> {
    all: &'v VisibleItems,
    own: &'v VisibleItem,
}

impl ItemLists<'_> {
    /// Whether there are none: then the item is drawn as without.
    pub(super) fn is_empty(self) -> bool {
        self.own.lists.is_empty()
    }

    /// Tells whether the lists are of what is drawn now.
    pub(super) fn check(self, drawn: Drawn) -> Result<(), Error> {
        let &VisibleItem { item: DrawItem { model: id, factor, .. }, segments, .. } = self.own;
        match (drawn.lattice_segments(), segments) {
            (now, then) if now == then => Ok(()),
            (now, _) => Err(Error::OtherSegments { id, factor, segments: now.unwrap_or(0) }),
        }
    }
}

/// Of some patches of a group, which follow each other in the plan.
#[derive(Debug, Clone, Copy)]
struct List {
    group: usize,
    /// In the group.
    first: u32,
    count: u32,
    /// In the buffer.
    offset: u32,
    /// 0 on a lattice, of which each patch has an instance.
    patches_per_instance: u32,
}

impl List {
    fn first_corner(self, group: &PatchGroup) -> u32 {
        (group.first_corner + self.first as usize * group.kind.corners()) as u32
    }

    fn first_patch(self, group: &PatchGroup) -> u32 {
        group.patches.start as u32 + self.first
    }

    /// Of what makes it, where the item is drawn with these.
    fn constants(self, model: &Model, drawn: Drawn, of_draw: &DrawConstants) -> ListConstants {
        let (stages, group) = (model.stages[self.group], &model.tables.plan().groups()[self.group]);
        let (vertices, first_index) = match drawn {
            Drawn::Lattice(lattice) => lattice.indices_of_patch(self.group),
            _ => (stages.input_points(), 0),
        };
        ListConstants {
            transform: of_draw.transform,
            factor: of_draw.factor(),
            flags: of_draw.flags,
            first_corner: self.first_corner(group),
            first_patch: self.first_patch(group),
            count: self.count,
            vertices,
            first_index,
            patches_per_instance: self.patches_per_instance,
            copies: (ListLayout::new(stages).copies_start(self.count) / 4) as u32,
        }
    }
}

/// What draws of lists need, in [`Features`].
pub(super) const LIST_FEATURES: Features =
    Features { indirect_first_instance: true, multi_draw_indirect: true, ..Features::NONE };

impl Renderer {
    /// Records the search for the patches of some items that can be seen in a view, by their
    /// [`DrawItem::cull`]: for [`Renderer::cmd_draw_visible`], as often as you like in this frame.
    ///
    /// It is for models whose [evaluation leaves out patches](Evaluation::culls), whatever their construction: control points that
    /// are not [`Cached`](super::Construction::Cached) are made for this, and again where patches are drawn. Others are drawn as by
    /// [`Renderer::cmd_draw`]. Takes memory, which is kept for later frames: a little more than four bytes a patch, and for
    /// instances what they read of it, 256 bytes of a Gregory patch. Binds compute pipelines, with sets 0 and 1, and counts as one
    /// of [`Options::views_per_frame`](super::Options::views_per_frame).
    ///
    /// # Errors
    /// As [`Renderer::cmd_draw`]; [`Error::NoVisibleLists`]; [`Error::ListsTooLarge`]. What was recorded until then does no harm.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering, after [`Renderer::cmd_prepare`] of the same frame, for the same queue, which
    /// computes.
    pub unsafe fn cmd_cull(
        &mut self,
        cmd: vk::CommandBuffer,
        frame_index: u32,
        view: &View,
        items: &[DrawItem],
    ) -> Result<VisibleItems, Error> {
        self.check_frame(frame_index)?;
        if !self.options.visible_lists {
            return Err(Error::NoVisibleLists);
        }
        let view_offset = self.take_view(frame_index, view)?;
        let mut bytes = 0;
        for item in items {
            self.check_item(view, item)?;
            let lists = self.listed_groups(item)?.next().is_some();
            self.make_cuts(item.model, item.factor, item.cull, lists)?;
            for (_, stages, group) in self.listed_groups(item)? {
                let layout = ListLayout::new(stages);
                bytes += pieces(group, layout).map(|(_, count)| layout.bytes(count)).sum::<u64>();
            }
        }
        self.make_room(frame_index, bytes)?;
        let mut listed = Vec::with_capacity(items.len());
        for item in items {
            let lists = self.take_lists(frame_index, view, item)?;
            let segments = match lists.is_empty() {
                true => None,
                false => self.model(item.model)?.drawn(item.factor)?.lattice_segments(),
            };
            listed.push(VisibleItem { item: *item, lists, segments });
        }
        let lists = &self.lists[frame_index as usize];
        let (set, buffer) = (lists.set.raw(), lists.raw());
        let visible = VisibleItems {
            frame: frame_index,
            preparation: self.preparations[frame_index as usize],
            view: *view,
            view_offset,
            set,
            buffer,
            items: listed,
        };
        if bytes > 0 {
            // SAFETY: as the caller promises.
            unsafe { self.cmd_lists(cmd, &visible)? };
        }
        Ok(visible)
    }

    /// Records the draws of what [`Renderer::cmd_cull`] found. Otherwise as [`Renderer::cmd_draw`].
    ///
    /// # Errors
    /// As [`Renderer::cmd_draw`]; [`Error::OtherFrame`] if `visible` was found for another frame or by another renderer, or before
    /// this frame was last prepared; [`Error::OtherSegments`] if the segments were changed since.
    ///
    /// # Safety
    /// As [`Renderer::cmd_draw`]; after [`Renderer::cmd_cull`].
    pub unsafe fn cmd_draw_visible(
        &mut self,
        cmd: vk::CommandBuffer,
        frame_index: u32,
        visible: &VisibleItems,
    ) -> Result<(), Error> {
        self.check_frame(frame_index)?;
        if (visible.frame, visible.preparation) != (frame_index, self.preparations[frame_index as usize]) {
            return Err(Error::OtherFrame { frame: frame_index });
        }
        let mut bound = Bound::default();
        // SAFETY: as the caller promises.
        unsafe { self.cmd_bind_view(cmd, visible.set, [visible.view_offset, 0]) };
        for own in &visible.items {
            let lists = Some(ItemLists { all: visible, own });
            // SAFETY: as the caller promises.
            unsafe { self.cmd_draw_item(cmd, &visible.view, &own.item, lists, &mut bound)? };
        }
        Ok(())
    }

    /// The groups of which lists are made, if any, with their number.
    fn listed_groups(&self, item: &DrawItem) -> Result<impl Iterator<Item = (usize, PatchStages, &PatchGroup)>, Error> {
        let model = self.model(item.model)?;
        let surface = self.style(item)?.geometry == Geometry::Surface;
        let any = surface && item.cull != Cull::NONE && model.evaluation.culls();
        let groups = model.stages.iter().zip(model.tables.plan().groups()).enumerate();
        let groups = groups.map(|(number, (&stages, group))| (number, stages, group));
        Ok(groups.filter(move |(_, stages, _)| any && stages.has_hull()))
    }

    /// Makes room for lists of so many bytes in a frame.
    fn make_room(&mut self, frame: u32, bytes: u64) -> Result<(), Error> {
        let lists = &self.lists[frame as usize];
        if lists.has_room(bytes) {
            return Ok(());
        }
        // Offsets are of 32 bits.
        let max = u64::from(u32::MAX >> 1);
        if bytes > max {
            return Err(Error::ListsTooLarge { bytes, max });
        }
        let capacity = bytes.max(2 * lists.capacity).next_power_of_two().min(max + 1);
        let layout = self.pipelines.view_layout.raw();
        let larger = FrameLists::new(&self.context, layout, &self.views, capacity)?;
        let before = std::mem::replace(&mut self.lists[frame as usize], larger);
        // What was found in this frame so far is in there.
        self.retire(Some(frame), RetiredObject::Lists(Box::new(before)));
        Ok(())
    }

    fn take_lists(&mut self, frame: u32, view: &View, item: &DrawItem) -> Result<Vec<List>, Error> {
        let (model, most) = self.check_item(view, item)?;
        let mut lists = Vec::new();
        for (number, stages, group) in self.listed_groups(item)? {
            let layout = ListLayout::new(stages);
            for (first, count) in pieces(group, layout) {
                let patches_per_instance = match model.evaluation {
                    Evaluation::Tessellation => self.patches_per_instance(stages, count, most),
                    _ => 0,
                };
                let list = List { group: number, first, count, offset: 0, patches_per_instance };
                lists.push((list, layout.bytes(count)));
            }
        }
        let room = &mut self.lists[frame as usize];
        Ok(lists.into_iter().map(|(list, bytes)| List { offset: room.take(bytes), ..list }).collect())
    }

    unsafe fn cmd_lists(&self, cmd: vk::CommandBuffer, visible: &VisibleItems) -> Result<(), Error> {
        use vk::{AccessFlags as Access, PipelineStageFlags as Stage};
        for VisibleItem { item, lists, .. } in &visible.items {
            let (model, most) = self.check_item(&visible.view, item)?;
            let of_draw = item.constants(model, self.style(item)?, &visible.view, most);
            let drawn = model.drawn(item.factor)?;
            for list in lists {
                let constants = list.constants(model, drawn, &of_draw);
                let key = (model.stages[list.group], Cut::new(item.factor, item.cull));
                let (sets, offsets) = ([visible.set, model.set.raw], [visible.view_offset, list.offset]);
                // SAFETY: as the caller promises.
                unsafe { self.pipelines.lists.cmd_list(cmd, key, sets, offsets, &constants) };
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

    /// Records the draws of the lists of a group; `of_draw` are the constants of the whole item.
    ///
    /// # Safety
    /// As [`Renderer::cmd_draw_visible`], with the pipeline and the model's set and buffers bound.
    pub(super) unsafe fn cmd_draw_lists(
        &self,
        cmd: vk::CommandBuffer,
        ItemLists { all: visible, own }: ItemLists,
        (model, group): (&Model, usize),
        of_draw: &DrawConstants,
        bound: &mut BoundLattice,
    ) {
        let device = self.context.device();
        let (stages, of_group) = (model.stages[group], &model.tables.plan().groups()[group]);
        // SAFETY: as the caller promises.
        unsafe {
            for list in own.lists.iter().filter(|list| list.group == group) {
                let constants = DrawConstants {
                    first_corner: list.first_corner(of_group),
                    first_patch: list.first_patch(of_group),
                    patches_per_instance: list.patches_per_instance,
                    ..*of_draw
                };
                self.push(cmd, &constants);
                self.cmd_bind_view(cmd, visible.set, [visible.view_offset, list.offset]);
                let offset = u64::from(list.offset);
                let commands = offset + ListLayout::commands_start(list.count);
                let regions = ListLayout::regions(list.count);
                if list.patches_per_instance == 0 {
                    if stages.attributes {
                        let copies = offset + ListLayout::new(stages).copies_start(list.count);
                        bound.cmd_bind_vertices(device, cmd, visible.buffer, copies);
                    }
                    let stride = size_of::<vk::DrawIndexedIndirectCommand>() as u32;
                    device.cmd_draw_indexed_indirect(cmd, visible.buffer, commands, regions, stride);
                    continue;
                }
                let stride = size_of::<vk::DrawIndirectCommand>() as u32;
                if list.patches_per_instance > REGION {
                    // No region has whole instances: of its two draws only the second has anything.
                    let rest = commands + u64::from(stride);
                    device.cmd_draw_indirect(cmd, visible.buffer, rest, regions, 2 * stride);
                } else {
                    device.cmd_draw_indirect(cmd, visible.buffer, commands, 2 * regions, stride);
                }
            }
        }
    }
}

/// The patches of a group in pieces that a list has room for: from which on, and how many.
fn pieces(group: &PatchGroup, layout: ListLayout) -> impl Iterator<Item = (u32, u32)> {
    let (patches, most) = (group.patches.len() as u32, layout.max_patches());
    (0..patches).step_by(most as usize).map(move |first| (first, most.min(patches - first)))
}
