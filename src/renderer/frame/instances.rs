//! Instances of items: room for the host's, and where shaders find them.

use super::{Frame, Renderer};
use crate::gpu::{Buffer, BufferDesc, MemoryLocation};
use crate::renderer::evaluate::PlacedInstances;
use crate::renderer::options::{DrawItem, Error, Instance, Instances};
use ash::vk;

/// Instances that there is room for when there are any.
const FIRST_INSTANCES: u64 = 256;

/// The instances that the host gave in a frame.
#[derive(Default)]
pub(super) struct FrameInstances {
    /// Those that have no more room; the last is not full.
    buffers: Vec<Buffer>,
    used: u64,
}

impl FrameInstances {
    /// Forgets them, and keeps the largest buffer.
    pub(super) fn clear(&mut self) {
        self.buffers.drain(..self.buffers.len().saturating_sub(1));
        self.used = 0;
    }

    pub(super) fn bytes(&self) -> u64 {
        self.buffers.iter().map(Buffer::size).sum()
    }
}

impl Renderer {
    /// Takes over instances for [`DrawItem::instances`], for as many items and views of the frame as you like.
    ///
    /// # Errors
    /// [`Error::OldFrame`]; [`Error::TooManyInstances`]; failed Vulkan calls.
    pub fn instances(&mut self, frame: Frame, instances: &[Instance]) -> Result<Instances, Error> {
        self.check_frame(frame)?;
        let (bytes, max) = (size_of_val(instances) as u64, self.context.properties().max_storage_buffer_range);
        if bytes > max {
            return Err(Error::TooManyInstances { given: instances.len(), max: max / size_of::<Instance>() as u64 });
        }
        let room = &mut self.instances[frame.index() as usize];
        let last = room.buffers.last().map_or(0, Buffer::size);
        if room.used + bytes > last || last == 0 {
            let size = bytes.max(2 * last).max(FIRST_INSTANCES * size_of::<Instance>() as u64).min(max);
            let desc = BufferDesc {
                name: "subdiv instances",
                size,
                usage: vk::BufferUsageFlags::STORAGE_BUFFER,
                location: MemoryLocation::Upload,
            };
            room.buffers.push(Buffer::new(&self.context, &desc)?);
            room.used = 0;
        }
        let offset = room.used;
        room.used += bytes;
        let [.., buffer] = &mut room.buffers[..] else { return Err(Error::OldFrame) };
        buffer.write(offset, instances)?;
        Ok(Instances::in_frame(frame.stamp(), buffer.raw(), buffer.size(), offset, instances.len() as u32))
    }

    /// Where the shaders of an item find its instances, and set 0 with them.
    pub(super) fn place_instances(
        &mut self,
        frame: Frame,
        item: &DrawItem,
    ) -> Result<Option<(vk::DescriptorSet, PlacedInstances)>, Error> {
        let Some(instances) = item.instances else { return Ok(None) };
        if instances.frame().is_some_and(|stamp| stamp != frame.stamp()) {
            return Err(Error::OldFrame);
        }
        let seen = instances.seen(item.model, self.context.properties().max_storage_buffer_range)?;
        let [first_word, stride] = instances.words(&seen);
        let lists = &mut self.lists[frame.index() as usize];
        let set = lists.set_of_instances(&self.pipelines.sets, instances.buffer(), seen)?;
        Ok(Some((set, PlacedInstances { count: instances.count(), first_word, stride })))
    }
}
