//! Indices of uniform grids: one buffer for all models with the same.

use crate::gpu::{Buffer, DeviceContext, GpuError};
use crate::renderer::options::MemoryUsage;
use crate::table::{UniformGridIndices, uniform_grid_vertices};
use crate::topology::PatchKind;
use ash::vk;
use rustc_hash::FxHashMap;
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// What the indices of a uniform grid depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct UniformGridShape {
    pub segments: u32,
    /// Of how many quads, and of how many triangles, whose vertices follow each other, there are indices; 0 if none are drawn.
    pub blocks: [u32; 2],
}

impl UniformGridShape {
    /// Where in [`UniformGridShape::blocks`] patches of a kind are.
    pub(crate) fn place(kind: PatchKind) -> usize {
        usize::from(kind.is_triangular())
    }
}

/// Those of a quad or of a triangle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PatchIndices {
    /// How many, and where the first is.
    pub count: u32,
    pub first: u32,
    /// How many join the patch to the one before in its block.
    pub joint: u32,
    /// Patches that there are indices for.
    pub block: u32,
}

/// Indices on the device, or on the way there.
pub(crate) struct SharedIndices {
    pub buffer: Buffer,
    pub topology: vk::PrimitiveTopology,
    patches: [PatchIndices; 2],
    staged: Mutex<Option<Buffer>>,
}

impl SharedIndices {
    fn new(context: &Arc<DeviceContext>, shape: UniformGridShape, at_once: u32) -> Result<Self, GpuError> {
        let UniformGridShape { segments, blocks } = shape;
        let kinds = [PatchKind::Regular, PatchKind::Triangle];
        let drawn = kinds.into_iter().filter(|&kind| blocks[UniformGridShape::place(kind)] > 0);
        let of = UniformGridIndices::new(drawn, segments, at_once);
        let mut indices = Vec::new();
        let patches = kinds.map(|kind| {
            let block = blocks[UniformGridShape::place(kind)];
            let of_patch = if block > 0 { of.of(kind, segments) } else { Vec::new() };
            let (count, first) = (of_patch.len() as u32, indices.len() as u32);
            let mut of_block = Vec::new();
            let vertices = uniform_grid_vertices(kind, segments);
            (0..block).for_each(|patch| of.append(&mut of_block, &of_patch, patch * vertices as u32));
            indices.extend(of_block);
            PatchIndices { count, first, joint: of.joint(count), block }
        });
        // A buffer of no bytes is no buffer.
        let bytes = (4 * indices.len() as u64).max(4);
        let mut staged = Buffer::upload(context, "subdiv indices to copy", bytes)?;
        staged.write(0, &indices)?;
        let buffer = Buffer::device_local(context, "subdiv indices", bytes, vk::BufferUsageFlags::INDEX_BUFFER)?;
        Ok(Self { buffer, topology: topology(of), patches, staged: Mutex::new(Some(staged)) })
    }

    pub(crate) fn of_patch(&self, kind: PatchKind) -> PatchIndices {
        self.patches[UniformGridShape::place(kind)]
    }

    /// Gives away what is to be copied to the device: to the first that asks.
    pub(crate) fn take_upload(&self) -> Option<Buffer> {
        self.staged.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Takes back what was not copied.
    pub(crate) fn give_back(&self, staged: Buffer) {
        *self.staged.lock().unwrap_or_else(PoisonError::into_inner) = Some(staged);
    }

    pub(crate) fn add_memory(&self, usage: &mut MemoryUsage) {
        usage.indices += self.buffer.size();
        usage.staging += self.staged.lock().unwrap_or_else(PoisonError::into_inner).as_ref().map_or(0, Buffer::size);
    }
}

/// All that are in use.
pub(crate) struct IndexCache {
    /// Where a patch has more as a list, it is a strip.
    at_once: u32,
    made: FxHashMap<UniformGridShape, Weak<SharedIndices>>,
}

impl IndexCache {
    /// None yet. Lists of a patch have up to `at_once` indices.
    pub(crate) fn new(at_once: u32) -> Self {
        Self { at_once, made: FxHashMap::default() }
    }

    /// Those of a shape.
    pub(crate) fn get(
        &mut self,
        context: &Arc<DeviceContext>,
        shape: UniformGridShape,
    ) -> Result<Arc<SharedIndices>, GpuError> {
        if let Some(indices) = self.made.get(&shape).and_then(Weak::upgrade) {
            return Ok(indices);
        }
        self.made.retain(|_, indices| indices.strong_count() > 0);
        let indices = Arc::new(SharedIndices::new(context, shape, self.at_once)?);
        self.made.insert(shape, Arc::downgrade(&indices));
        Ok(indices)
    }
}

/// What indices are drawn as.
pub(crate) fn topology(of: UniformGridIndices) -> vk::PrimitiveTopology {
    match of {
        UniformGridIndices::List => vk::PrimitiveTopology::TRIANGLE_LIST,
        UniformGridIndices::Strip => vk::PrimitiveTopology::TRIANGLE_STRIP,
    }
}
