//! Descriptor sets, and the pool that they come from.

use super::{DeviceContext, GpuError, Owned, SetLayout, VkResultExt};
use ash::vk;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Sets of the first block of a pool; each further block has twice as many as the last, up to [`MOST_SETS`].
const FIRST_SETS: u32 = 16;
const MOST_SETS: u32 = 1024;

/// A pool of descriptor sets that grows: a new block when none has room, and blocks without sets go.
#[derive(Debug)]
pub struct DescriptorPool {
    context: Arc<DeviceContext>,
    name: String,
    /// The most descriptors of each type that a set has.
    most: Vec<(vk::DescriptorType, u32)>,
    blocks: Mutex<Vec<Block>>,
}

/// A pool as Vulkan has it, of a fixed size.
#[derive(Debug)]
struct Block {
    pool: Owned<vk::DescriptorPool>,
    capacity: u32,
    used: u32,
}

/// A descriptor set, which goes back to its pool when it is dropped.
#[derive(Debug)]
pub struct DescriptorSet {
    raw: vk::DescriptorSet,
    block: vk::DescriptorPool,
    pool: Arc<DescriptorPool>,
}

impl DescriptorPool {
    /// A pool without blocks yet, for sets of these layouts.
    pub fn new(context: &Arc<DeviceContext>, name: &str, layouts: &[&SetLayout]) -> Arc<Self> {
        let mut most: Vec<(vk::DescriptorType, u32)> = Vec::new();
        for layout in layouts {
            for &(ty, _) in layout.bindings() {
                let count = layout.bindings().iter().filter(|(other, _)| *other == ty).count() as u32;
                match most.iter_mut().find(|(other, _)| *other == ty) {
                    Some((_, largest)) => *largest = count.max(*largest),
                    None => most.push((ty, count)),
                }
            }
        }
        Arc::new(Self { context: context.clone(), name: name.to_owned(), most, blocks: Mutex::default() })
    }

    /// Blocks, and sets in them.
    pub fn usage(&self) -> [usize; 2] {
        let blocks = self.blocks();
        [blocks.len(), blocks.iter().map(|block| block.used as usize).sum()]
    }

    fn blocks(&self) -> MutexGuard<'_, Vec<Block>> {
        self.blocks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A set in whichever block has room.
    unsafe fn allocate(
        &self,
        layout: &SetLayout,
        name: &str,
    ) -> Result<(vk::DescriptorSet, vk::DescriptorPool), GpuError> {
        let mut blocks = self.blocks();
        for block in blocks.iter_mut().rev().filter(|block| block.used < block.capacity) {
            // SAFETY: as the caller promises; the lock is held.
            match unsafe { block.allocate(&self.context, layout) } {
                // Sets of several layouts leave gaps in a block.
                Err(vk::Result::ERROR_FRAGMENTED_POOL | vk::Result::ERROR_OUT_OF_POOL_MEMORY) => {}
                set => return Ok((set.of("vkAllocateDescriptorSets", name)?, block.pool.raw())),
            }
        }
        let capacity = blocks.last().map_or(FIRST_SETS, |last| (2 * last.capacity).min(MOST_SETS));
        let mut block = Block::new(&self.context, &self.name, &self.most, capacity)?;
        // SAFETY: as above.
        let set = unsafe { block.allocate(&self.context, layout) }.of("vkAllocateDescriptorSets", name)?;
        let pool = block.pool.raw();
        blocks.push(block);
        Ok((set, pool))
    }

    fn free(&self, set: vk::DescriptorSet, pool: vk::DescriptorPool) {
        let mut blocks = self.blocks();
        let Some(i) = blocks.iter().position(|block| block.pool.raw() == pool) else { return };
        // SAFETY: the set is of this block, and the device is done with it; the lock is held. It cannot fail.
        let _ = unsafe { self.context.device().free_descriptor_sets(pool, &[set]) };
        blocks[i].used -= 1;
        if blocks[i].used == 0 && blocks.len() > 1 {
            blocks.remove(i);
        }
    }
}

impl Block {
    fn new(
        context: &Arc<DeviceContext>,
        name: &str,
        most: &[(vk::DescriptorType, u32)],
        capacity: u32,
    ) -> Result<Self, GpuError> {
        let size = |&(ty, count): &(_, u32)| vk::DescriptorPoolSize { ty, descriptor_count: count * capacity };
        let sizes: Vec<_> = most.iter().map(size).collect();
        let info = vk::DescriptorPoolCreateInfo::default()
            .flags(vk::DescriptorPoolCreateFlags::FREE_DESCRIPTOR_SET)
            .max_sets(capacity)
            .pool_sizes(&sizes);
        // SAFETY: the description is valid, and the pool is taken over by `Owned`.
        let pool = unsafe {
            let pool = context.device().create_descriptor_pool(&info, None).of("vkCreateDescriptorPool", name)?;
            Owned::new(context, pool, name)
        };
        Ok(Self { pool, capacity, used: 0 })
    }

    unsafe fn allocate(
        &mut self,
        context: &DeviceContext,
        layout: &SetLayout,
    ) -> ash::prelude::VkResult<vk::DescriptorSet> {
        let layouts = [layout.raw()];
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(self.pool.raw()).set_layouts(&layouts);
        // SAFETY: as the caller promises.
        let sets = unsafe { context.device().allocate_descriptor_sets(&info)? };
        self.used += 1;
        Ok(sets[0])
    }
}

impl DescriptorSet {
    /// A set with nothing in it.
    ///
    /// # Safety
    ///
    /// The layout is among those of the pool. The set is dropped when the device is done with it.
    pub unsafe fn new(pool: &Arc<DescriptorPool>, layout: &SetLayout, name: &str) -> Result<Self, GpuError> {
        // SAFETY: as the caller promises.
        let (raw, block) = unsafe { pool.allocate(layout, name)? };
        pool.context.set_name(raw, name);
        Ok(Self { raw, block, pool: pool.clone() })
    }

    /// A set with parts of buffers at the bindings 0, 1, ...
    ///
    /// # Safety
    ///
    /// As [`DescriptorSet::new`]; the layout has as many buffers, which live as long as the set is used.
    pub unsafe fn of_buffers(
        pool: &Arc<DescriptorPool>,
        layout: &SetLayout,
        name: &str,
        buffers: &[vk::DescriptorBufferInfo],
    ) -> Result<Self, GpuError> {
        // SAFETY: as the caller promises.
        let set = unsafe { Self::new(pool, layout, name)? };
        let writes: Vec<_> = (0..)
            .zip(layout.bindings().iter().zip(buffers))
            .map(|(binding, (&(ty, _), buffer))| {
                vk::WriteDescriptorSet::default()
                    .dst_set(set.raw)
                    .dst_binding(binding)
                    .descriptor_type(ty)
                    .buffer_info(std::slice::from_ref(buffer))
            })
            .collect();
        // SAFETY: as the caller promises; the set is new.
        unsafe { pool.context.device().update_descriptor_sets(&writes, &[]) };
        Ok(set)
    }

    /// The handle.
    pub fn raw(&self) -> vk::DescriptorSet {
        self.raw
    }
}

impl Drop for DescriptorSet {
    fn drop(&mut self) {
        self.pool.free(self.raw, self.block);
    }
}

#[cfg(all(test, feature = "headless"))]
mod tests {
    use super::*;
    use crate::gpu::descriptor_set_layout;
    use crate::headless::{Headless, HeadlessOptions};

    #[test]
    fn pools_grow_and_shrink() {
        let headless = Headless::new(&HeadlessOptions::default()).unwrap();
        let (context, stages) = (headless.context(), vk::ShaderStageFlags::COMPUTE);
        let (buffer, texels) = (vk::DescriptorType::STORAGE_BUFFER, vk::DescriptorType::UNIFORM_TEXEL_BUFFER);
        let small = descriptor_set_layout(context, "small", &[(buffer, stages)]).unwrap();
        let large =
            descriptor_set_layout(context, "large", &[(buffer, stages), (texels, stages), (buffer, stages)]).unwrap();
        let pool = DescriptorPool::new(context, "sets", &[&small, &large]);
        assert_eq!(pool.most, [(buffer, 2), (texels, 1)]);
        // SAFETY: the layouts are those of the pool, and no set is ever used.
        let set = |i| unsafe { DescriptorSet::new(&pool, if i % 3 == 0 { &small } else { &large }, "set") }.unwrap();
        let mut sets: Vec<_> = (0..100).map(set).collect();
        // 16, 32 and 64 of them.
        assert_eq!(pool.usage(), [3, 100]);
        sets.drain(..16);
        assert_eq!(pool.usage(), [2, 84]);
        sets.drain(..12);
        sets.extend((0..24).map(set));
        assert_eq!(pool.usage(), [2, 96], "what is freed is used again");
        sets.clear();
        assert_eq!(pool.usage(), [1, 0]);
    }
}
