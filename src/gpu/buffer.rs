use std::mem::ManuallyDrop;
use std::sync::Arc;

use ash::vk;
use bytemuck::{AnyBitPattern, NoUninit};

use super::{Allocation, AllocationRequest, Dedicated, DeviceContext, GpuError, MemoryLocation, Owned, VkResultExt};

/// Description of a [`Buffer`].
#[derive(Debug, Clone, Copy)]
pub struct BufferDesc<'a> {
    /// The debug name.
    pub name: &'a str,
    /// Bytes; rounded up to a multiple of 4, and at least 4.
    pub size: u64,
    /// Uses of the buffer.
    pub usage: vk::BufferUsageFlags,
    /// Who reads and writes it.
    pub location: MemoryLocation,
}

/// A buffer with its memory; both go when it is dropped.
///
/// Host memory is coherent, so nothing is flushed; the order of host and device accesses is the caller's business.
#[derive(Debug)]
pub struct Buffer {
    name: String,
    size: u64,
    context: Arc<DeviceContext>,
    raw: ManuallyDrop<Owned<vk::Buffer>>,
    allocation: ManuallyDrop<Allocation>,
}

impl Buffer {
    /// A buffer that the host writes and copies are made from.
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub fn upload(context: &Arc<DeviceContext>, name: &str, size: u64) -> Result<Self, GpuError> {
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        Self::new(context, &BufferDesc { name, size, usage, location: MemoryLocation::Upload })
    }

    /// A buffer in the device's own memory, which copies go into.
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub fn device_local(
        context: &Arc<DeviceContext>,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
    ) -> Result<Self, GpuError> {
        let usage = usage | vk::BufferUsageFlags::TRANSFER_DST;
        Self::new(context, &BufferDesc { name, size, usage, location: MemoryLocation::DeviceLocal })
    }

    /// A new buffer, with memory.
    ///
    /// # Errors
    /// No memory; a size the device does not have; no use.
    pub fn new(context: &Arc<DeviceContext>, desc: &BufferDesc<'_>) -> Result<Self, GpuError> {
        let BufferDesc { name, usage, location, .. } = *desc;
        let max = context.properties().max_buffer_size;
        if desc.size > max {
            let why = format!("{} bytes are asked for, and the largest buffer of the device has {max}", desc.size);
            return Err(GpuError::Unsupported { object: name.to_owned(), why });
        }
        if usage.is_empty() {
            return Err(GpuError::Unsupported {
                object: name.to_owned(),
                why: "it is for no use: name at least one".into(),
            });
        }
        let size = desc.size.max(4).next_multiple_of(4);

        let device = context.device();
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: the description is valid, and the buffer is taken over by `Owned`.
        let raw = unsafe {
            let raw = device.create_buffer(&info, None).of("vkCreateBuffer", name)?;
            Owned::new(context, raw, name)
        };
        let mut dedicated = vk::MemoryDedicatedRequirements::default();
        let mut requirements = vk::MemoryRequirements2::default().push_next(&mut dedicated);
        let info = vk::BufferMemoryRequirementsInfo2::default().buffer(raw.raw());
        // SAFETY: the buffer is of this device.
        unsafe { device.get_buffer_memory_requirements2(&info, &mut requirements) };
        let requirements = requirements.memory_requirements;
        let allocation = context
            .allocator()
            .allocate(&AllocationRequest {
                name,
                requirements,
                location,
                linear: true,
                dedicated: wants_dedicated(&dedicated).then(|| Dedicated::Buffer(raw.raw())),
            })
            .map_err(|source| GpuError::Allocation { object: name.to_owned(), size: requirements.size, source })?;
        // From here on the drop of `buffer` frees everything.
        let buffer = Self {
            name: name.to_owned(),
            size,
            context: context.clone(),
            raw: ManuallyDrop::new(raw),
            allocation: ManuallyDrop::new(allocation),
        };
        // SAFETY: an allocation meets the requirements of its request (contract of `Allocator`).
        unsafe { device.bind_buffer_memory(buffer.raw(), buffer.allocation.memory, buffer.allocation.offset) }
            .of("vkBindBufferMemory", name)?;
        Ok(buffer)
    }

    /// A buffer for the host to fill, filled with `data`.
    ///
    /// # Errors
    /// As [`Buffer::new`]; [`GpuError::NotMapped`] where the host cannot write.
    pub fn with_data<T: NoUninit>(
        context: &Arc<DeviceContext>,
        name: &str,
        usage: vk::BufferUsageFlags,
        data: &[T],
    ) -> Result<Self, GpuError> {
        let size = size_of_val(data) as u64;
        let mut buffer = Self::new(context, &BufferDesc { name, size, usage, location: MemoryLocation::Upload })?;
        buffer.write(0, data)?;
        Ok(buffer)
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::Buffer {
        self.raw.raw()
    }

    /// Bytes: what was asked for, rounded up to a multiple of 4.
    pub fn size(&self) -> u64 {
        self.size
    }

    /// The debug name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The whole buffer, for a descriptor.
    pub fn descriptor(&self) -> vk::DescriptorBufferInfo {
        vk::DescriptorBufferInfo { buffer: self.raw(), offset: 0, range: vk::WHOLE_SIZE }
    }

    /// A view of at least a texel from `offset` on, in bytes, as a texel buffer; it ends where the
    /// device sees no more. The buffer is for such views, and the offset aligned.
    ///
    /// # Errors
    /// No memory.
    pub(crate) fn texels(
        &self,
        format: vk::Format,
        texel: u64,
        offset: u64,
        bytes: u64,
    ) -> Result<Owned<vk::BufferView>, GpuError> {
        let most = self.context.properties().max_texel_buffer_elements;
        let range = (bytes / texel).clamp(1, most) * texel;
        let info = vk::BufferViewCreateInfo::default().buffer(self.raw()).format(format).offset(offset).range(range);
        // SAFETY: the buffer is of this device, has the usage and holds the range; the view is taken over by `Owned`.
        unsafe {
            let raw = self.context.device().create_buffer_view(&info, None).of("vkCreateBufferView", &self.name)?;
            Ok(Owned::new(&self.context, raw, &self.name))
        }
    }

    /// Copies `data` to `offset`, in bytes from the start of the buffer.
    ///
    /// # Errors
    /// [`GpuError::NotMapped`] and [`GpuError::OutOfBounds`].
    pub fn write<T: NoUninit>(&mut self, offset: u64, data: &[T]) -> Result<(), GpuError> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let target = self.mapped(offset, bytes.len() as u64, "written")?;
        // SAFETY: `mapped` checked the range, and `&mut self` keeps other host accesses out.
        unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), target, bytes.len()) };
        Ok(())
    }

    /// Copies `count` values out of the buffer, from `offset` bytes on.
    ///
    /// # Errors
    /// [`GpuError::NotMapped`] and [`GpuError::OutOfBounds`].
    pub fn read<T: AnyBitPattern + NoUninit>(&self, offset: u64, count: usize) -> Result<Vec<T>, GpuError> {
        let bytes = (count as u64).saturating_mul(size_of::<T>() as u64);
        let source = self.mapped(offset, bytes, "read")?;
        let mut values = vec![T::zeroed(); count];
        // SAFETY: `mapped` checked the range; any bits are a `T`.
        unsafe { std::ptr::copy_nonoverlapping(source, values.as_mut_ptr().cast(), bytes as usize) };
        Ok(values)
    }

    /// The host address of a range that was checked to lie in the buffer.
    fn mapped(&self, offset: u64, bytes: u64, access: &'static str) -> Result<*mut u8, GpuError> {
        let object = || self.name.clone();
        let start = self.allocation.mapped.ok_or_else(|| GpuError::NotMapped { object: object(), access })?;
        if offset.checked_add(bytes).is_none_or(|end| end > self.size) {
            return Err(GpuError::OutOfBounds { object: object(), offset, bytes, size: self.size });
        }
        // SAFETY: the offset lies in the allocation, which is mapped as a whole.
        Ok(unsafe { start.as_ptr().add(offset as usize) })
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: neither is used again; by the contract of `DeviceContext::new` the device is done with them. The buffer
        // goes before its memory.
        unsafe {
            ManuallyDrop::drop(&mut self.raw);
            self.context.allocator().free(ManuallyDrop::take(&mut self.allocation));
        }
    }
}

/// Whether the driver wants a resource to have memory of its own.
pub(super) fn wants_dedicated(requirements: &vk::MemoryDedicatedRequirements<'_>) -> bool {
    requirements.prefers_dedicated_allocation == vk::TRUE || requirements.requires_dedicated_allocation == vk::TRUE
}
