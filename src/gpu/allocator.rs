use std::any::Any;
use std::ptr::NonNull;

use ash::vk;

/// Why an [`Allocator`] had no memory to give.
pub type AllocatorError = Box<dyn std::error::Error + Send + Sync>;

/// Who reads and writes a piece of memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MemoryLocation {
    /// Only the device: `DEVICE_LOCAL`.
    DeviceLocal,
    /// The host writes, the device reads: `HOST_VISIBLE | HOST_COHERENT`, mapped.
    Upload,
    /// The device writes, the host reads: `HOST_VISIBLE | HOST_COHERENT`, mapped, cached if possible.
    Readback,
}

/// The one resource that a dedicated allocation is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dedicated {
    /// For `VkMemoryDedicatedAllocateInfo::buffer`.
    Buffer(vk::Buffer),
    /// For `VkMemoryDedicatedAllocateInfo::image`.
    Image(vk::Image),
}

/// Memory asked of an [`Allocator`].
#[derive(Debug, Clone)]
pub struct AllocationRequest<'a> {
    /// The name of the buffer or image, for reports.
    pub name: &'a str,
    /// Size, alignment and memory types, as Vulkan gave them for the buffer or image.
    pub requirements: vk::MemoryRequirements,
    /// Who reads and writes it.
    pub location: MemoryLocation,
    /// A buffer or an image with linear tiling; not an image with optimal tiling (`bufferImageGranularity`).
    pub linear: bool,
    /// Set where the driver prefers or requires an allocation of its own for this resource.
    pub dedicated: Option<Dedicated>,
}

/// Memory from an [`Allocator`]: `size` bytes of `memory`, from `offset` on.
#[derive(Debug)]
pub struct Allocation {
    /// Memory that the resource is bound to.
    pub memory: vk::DeviceMemory,
    /// Bytes from the start of `memory`.
    pub offset: u64,
    /// Bytes, at least as many as were asked for.
    pub size: u64,
    /// The host address of the first byte of this allocation (not of `memory`), if it is mapped.
    pub mapped: Option<NonNull<u8>>,
    /// Token by which the allocator recognizes the allocation when it is freed.
    pub token: Box<dyn Any + Send + Sync>,
}

// SAFETY: `mapped` is an address in memory that stays mapped as long as the allocation lives; whoever dereferences it
// keeps host accesses apart (`Buffer` does, through `&mut self` for writes).
unsafe impl Send for Allocation {}
// SAFETY: as above.
unsafe impl Sync for Allocation {}

/// Where buffers and images get their memory: the caller's allocator.
///
/// With the cargo feature `gpu-allocator`, `Mutex<gpu_allocator::vulkan::Allocator>` is an `Allocator`, so an
/// `Arc<Mutex<gpu_allocator::vulkan::Allocator>>` can be passed as it is. Anything else takes a few lines. One
/// `vkAllocateMemory` for each resource, for instance, which does for a dozen resources:
///
/// ```
/// use ash::vk;
/// use ash_subdiv::gpu::{Allocation, AllocationRequest, Allocator, AllocatorError, MemoryLocation};
///
/// struct OneEach {
///     device: ash::Device,
///     types: vk::PhysicalDeviceMemoryProperties,
/// }
///
/// unsafe impl Allocator for OneEach {
///     fn allocate(&self, request: &AllocationRequest<'_>) -> Result<Allocation, AllocatorError> {
///         let host = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
///         let wanted = match request.location {
///             MemoryLocation::DeviceLocal => vk::MemoryPropertyFlags::DEVICE_LOCAL,
///             MemoryLocation::Upload | MemoryLocation::Readback => host,
///         };
///         let allowed = |index: usize| request.requirements.memory_type_bits & (1 << index) != 0;
///         let index = (0..self.types.memory_type_count as usize)
///             .find(|&i| allowed(i) && self.types.memory_types[i].property_flags.contains(wanted))
///             .ok_or("no memory type fits")?;
///         let info = vk::MemoryAllocateInfo::default()
///             .allocation_size(request.requirements.size)
///             .memory_type_index(index as u32);
///         unsafe {
///             let memory = self.device.allocate_memory(&info, None)?;
///             let mapped = match request.location {
///                 MemoryLocation::DeviceLocal => None,
///                 _ => std::ptr::NonNull::new(
///                     self.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?.cast(),
///                 ),
///             };
///             Ok(Allocation { memory, offset: 0, size: request.requirements.size, mapped, token: Box::new(()) })
///         }
///     }
///
///     unsafe fn free(&self, allocation: Allocation) {
///         unsafe { self.device.free_memory(allocation.memory, None) }
///     }
/// }
/// ```
///
/// With `vk-mem`, the token is its `Allocation`, and the other fields come from `get_allocation_info`.
///
/// # Safety
///
/// An allocation meets the requirements of the request, belongs to the device that the resources are made from,
/// overlaps no other live allocation and stays valid until it is freed. Memory for [`MemoryLocation::Upload`] and
/// [`MemoryLocation::Readback`] is host-coherent, and mapped for as long as the allocation lives.
pub unsafe trait Allocator: Send + Sync {
    /// Memory for one buffer or image.
    ///
    /// # Errors
    /// There is no such memory left; the crate passes the reason on in [`GpuError::Allocation`](super::GpuError::Allocation).
    fn allocate(&self, request: &AllocationRequest<'_>) -> Result<Allocation, AllocatorError>;

    /// Takes back an allocation.
    ///
    /// # Safety
    ///
    /// `allocation` comes from this allocator, and the device no longer uses it.
    unsafe fn free(&self, allocation: Allocation);
}

#[cfg(feature = "gpu-allocator")]
mod gpu_allocator_impl {
    use std::sync::{Mutex, PoisonError};

    use gpu_allocator::vulkan as ga;

    use super::{Allocation, AllocationRequest, Allocator, AllocatorError, Dedicated, MemoryLocation};

    // SAFETY: gpu-allocator hands out disjoint ranges that meet the requirements; what it calls `CpuToGpu` and
    // `GpuToCpu` is host-visible and host-coherent memory, and mapped for its whole life.
    unsafe impl Allocator for Mutex<ga::Allocator> {
        fn allocate(&self, request: &AllocationRequest<'_>) -> Result<Allocation, AllocatorError> {
            let allocation =
                self.lock().unwrap_or_else(PoisonError::into_inner).allocate(&ga::AllocationCreateDesc {
                    name: request.name,
                    requirements: request.requirements,
                    location: match request.location {
                        MemoryLocation::DeviceLocal => gpu_allocator::MemoryLocation::GpuOnly,
                        MemoryLocation::Upload => gpu_allocator::MemoryLocation::CpuToGpu,
                        MemoryLocation::Readback => gpu_allocator::MemoryLocation::GpuToCpu,
                    },
                    linear: request.linear,
                    allocation_scheme: match request.dedicated {
                        Some(Dedicated::Buffer(buffer)) => ga::AllocationScheme::DedicatedBuffer(buffer),
                        Some(Dedicated::Image(image)) => ga::AllocationScheme::DedicatedImage(image),
                        None => ga::AllocationScheme::GpuAllocatorManaged,
                    },
                })?;
            Ok(Allocation {
                // SAFETY: the memory is only bound, and never freed or mapped by us.
                memory: unsafe { allocation.memory() },
                offset: allocation.offset(),
                size: allocation.size(),
                mapped: allocation.mapped_ptr().map(|address| address.cast()),
                token: Box::new(allocation),
            })
        }

        unsafe fn free(&self, allocation: Allocation) {
            // Anything else breaks the contract of `free`; leaking is the harmless answer.
            if let Ok(allocation) = allocation.token.downcast::<ga::Allocation>() {
                // The only failure is a sub-allocator that does not know the allocation.
                let _ = self.lock().unwrap_or_else(PoisonError::into_inner).free(*allocation);
            }
        }
    }
}
