//! The patches that can be seen, on lists, and their draws.

use super::lists::{ListConstants, ListLayout};
use super::{Frame, Renderer};
use crate::constants::REGION;
use crate::renderer::evaluate::{Drawn, Recorder};
use crate::renderer::model::Model;
#[cfg(doc)]
use crate::renderer::options::Cull;
use crate::renderer::options::{DrawItem, Error, View};
use crate::renderer::shader::DrawConstants;
use crate::table::PatchGroup;
use ash::vk;

/// The items of a view, with lists of the patches of them that can be seen: made by [`Renderer::cmd_cull`], drawn by
/// [`Renderer::cmd_draw_visible`].
#[derive(Debug, Clone)]
pub struct VisibleItems {
    pub(crate) frame: Frame,
    pub(crate) view: View,
    pub(crate) view_offset: u32,
    pub(crate) set: vk::DescriptorSet,
    pub(crate) buffer: vk::Buffer,
    pub(crate) items: Vec<VisibleItem>,
}

#[derive(Debug, Clone)]
pub(crate) struct VisibleItem {
    pub item: DrawItem,
    /// Where its record is.
    pub record: u32,
    pub lists: Vec<List>,
    /// Of the uniform grid whose indices the draws count, if it is one.
    pub segments: Option<u32>,
}

impl VisibleItems {
    /// The same, all in another of [`Options::styles`](crate::renderer::Options::styles): such as for depth alone. With [`Cull::back`] in
    /// one that culls the same faces.
    pub fn in_style(&self, style: usize) -> Self {
        let mut other = self.clone();
        other.items.iter_mut().for_each(|visible| visible.item.style = style);
        other
    }
}

/// The lists of an item.
#[derive(Clone, Copy)]
pub(crate) struct ItemLists<'v> {
    pub all: &'v VisibleItems,
    pub own: &'v VisibleItem,
}

impl ItemLists<'_> {
    /// Whether there are none: then the item is drawn as without.
    pub(crate) fn is_empty(self) -> bool {
        self.own.lists.is_empty()
    }

    /// Tells whether the lists are of what is drawn now.
    pub(crate) fn check(self, drawn: Drawn) -> Result<(), Error> {
        let &VisibleItem { item: DrawItem { model: id, .. }, segments, .. } = self.own;
        match (drawn.uniform_grid().map(|uniform_grid| uniform_grid.segments), segments) {
            (now, then) if now == then => Ok(()),
            (now, _) => Err(Error::OtherSegments { id, segments: now.unwrap_or(0) }),
        }
    }
}

/// Of some patches of a group, which follow each other in the plan.
#[derive(Debug, Clone, Copy)]
pub(crate) struct List {
    pub group: usize,
    /// In the group.
    pub first: u32,
    pub count: u32,
    /// In the buffer.
    pub offset: u32,
    /// 0 on a uniform grid, of which each patch has an instance.
    pub patches_per_instance: u32,
}

impl List {
    fn first_corner(self, group: &PatchGroup) -> u32 {
        (group.first_corner + self.first as usize * group.kind.corners()) as u32
    }

    fn first_patch(self, group: &PatchGroup) -> u32 {
        group.patches.start as u32 + self.first
    }

    /// Of its draws; `of_item` are those of all draws of the item.
    fn of_draw(self, group: &PatchGroup, of_item: &DrawConstants) -> DrawConstants {
        DrawConstants {
            first_corner: self.first_corner(group),
            first_patch: self.first_patch(group),
            patches_per_instance: self.patches_per_instance,
            ..*of_item
        }
    }

    /// Of what makes it, where the item is drawn with these.
    pub(crate) fn constants(self, model: &Model, drawn: Drawn, of_draw: &DrawConstants) -> ListConstants {
        let (stages, group) = (model.stages[self.group], &model.tables.plan().groups()[self.group]);
        let (vertices, first_index) = match drawn.uniform_grid() {
            Some(uniform_grid) => uniform_grid.indices_of_patch(self.group),
            None => (stages.input_points(), 0),
        };
        ListConstants {
            of_draw: self.of_draw(group, of_draw),
            count: self.count,
            vertices,
            first_index,
            copies: (ListLayout::new(stages).copies_start(self.count) / 4) as u32,
        }
    }
}

impl Renderer {
    /// Records the draws of the lists of a group.
    ///
    /// # Safety
    /// As [`Renderer::cmd_draw_visible`], with the pipeline and the model's set and buffers bound.
    pub(crate) unsafe fn cmd_draw_lists(
        &self,
        recorder: &mut Recorder,
        ItemLists { all: visible, own }: ItemLists,
        (model, group): (&Model, usize),
    ) {
        let (device, cmd) = (recorder.device, recorder.cmd);
        let (stages, of_group) = (model.stages[group], &model.tables.plan().groups()[group]);
        // SAFETY: as the caller promises.
        unsafe {
            for list in own.lists.iter().filter(|list| list.group == group) {
                let constants = &mut recorder.constants;
                constants.first_corner = list.first_corner(of_group);
                constants.first_patch = list.first_patch(of_group);
                constants.patches_per_instance = list.patches_per_instance;
                recorder.push();
                recorder.bind_list(list.offset);
                let offset = u64::from(list.offset);
                let commands = offset + ListLayout::commands_start(list.count);
                let regions = ListLayout::regions(list.count);
                if list.patches_per_instance == 0 {
                    if stages.attributes {
                        let copies = offset + ListLayout::new(stages).copies_start(list.count);
                        recorder.bound.uniform_grid.cmd_bind_vertices(device, cmd, visible.buffer, copies);
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
