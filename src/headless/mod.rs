//! A Vulkan device of our own, without a window: for the tests, the examples and the program.
//!
//! [`Headless::new`] takes the best device of the machine (or the one named in `SUBDIV_DEVICE`), with the Khronos
//! validation layer if asked or if `SUBDIV_VALIDATION` is set. [`Headless::submit`] runs commands and waits for them;
//! [`Offscreen`] is an image to draw into and to read back; [`Headless::timed`] and [`Headless::counted`] measure.

use std::any::Any;
use std::env;
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;

use crate::gpu::{ContextOptions, DeviceContext, DeviceProperties, Features, GpuError, Owned, VkResultExt};

mod devices;
mod error;
#[cfg(feature = "exr")]
mod exr;
mod instance;
mod offscreen;
mod query;
mod texture;

/// Vulkan objects of tools and tests, which may change with any version: buffers, images, descriptors and pipelines. Those that own
/// a handle destroy it when dropped, and keep their context alive.
pub mod objects {
    pub use crate::gpu::objects::*;
}

pub use devices::{DeviceInfo, devices};
pub use error::HeadlessError;
pub use offscreen::{Offscreen, OffscreenDesc};
pub use query::{Statistics, StatisticsQuery, Timestamps, Timing};
pub use texture::{Texels, Texture};

#[cfg(feature = "png")]
pub use offscreen::save_png;

use instance::{Instance, LIFE, Messages};

/// Options of the device.
#[derive(Debug, Clone, Default)]
pub struct HeadlessOptions {
    /// The validation layer, with synchronization validation. Also on if the environment variable `SUBDIV_VALIDATION` is
    /// set to anything but `0` or nothing.
    pub validation: bool,
    /// The number of the device, or a part of its name. If none, the environment variable `SUBDIV_DEVICE` says it; if
    /// that is not set, it is the first discrete GPU, or else the first integrated one, or else a CPU.
    pub device: Option<String>,
    /// Features that the device must have. Other features that it has are enabled too: see [`DeviceContext::features`].
    pub needs: Features,
    /// As [`ContextOptions::storage_tables`].
    pub storage_tables: bool,
}

/// A Vulkan device of our own, with one queue for everything.
///
/// The device itself goes when the last object made from its [`context`](Headless::context) is dropped.
pub struct Headless {
    context: Arc<DeviceContext>,
    instance: ash::Instance,
    physical_device: vk::PhysicalDevice,
    queue_family: u32,
    queue: Mutex<vk::Queue>,
    messages: Arc<Messages>,
    /// At most one of each type.
    kept: Mutex<Vec<Arc<dyn Any + Send + Sync>>>,
}

/// Destroys the device, and then the instance.
struct OwnedDevice {
    raw: ash::Device,
    _instance: Instance,
}

impl Drop for OwnedDevice {
    fn drop(&mut self) {
        let _one_at_a_time = LIFE.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: everything made from the device is gone: this is the last field of its context to be dropped.
        unsafe { self.raw.destroy_device(None) };
    }
}

impl Headless {
    /// Opens the device.
    ///
    /// # Errors
    /// No Vulkan, no validation layer where it is asked for, no device that fits, failed Vulkan calls.
    pub fn new(options: &HeadlessOptions) -> Result<Self, HeadlessError> {
        let set = |name| env::var(name).ok().filter(|value| !value.is_empty());
        let validation = options.validation || set("SUBDIV_VALIDATION").is_some_and(|value| value != "0");
        let wanted = options.device.clone().or_else(|| set("SUBDIV_DEVICE"));

        let instance = Instance::new(validation)?;
        let (physical_device, info) = devices::choose(&instance, options.needs, wanted.as_deref())?;
        let features = info.properties.features;
        // `choose` takes no device without one.
        let queue_family = devices::queue_family(&instance, physical_device).unwrap_or(0);
        let raw = create_device(&instance, physical_device, &info.properties, queue_family)?;
        let (messages, debug_utils, instance_handle) =
            (instance.messages.clone(), instance.debug_utils, instance.raw.clone());
        let owner = OwnedDevice { raw: raw.clone(), _instance: instance };

        let mut debug_settings = gpu_allocator::AllocatorDebugSettings::default();
        // `finish` reports leaks.
        debug_settings.log_leaks_on_shutdown = false;
        let allocator = gpu_allocator::vulkan::Allocator::new(&gpu_allocator::vulkan::AllocatorCreateDesc {
            instance: instance_handle.clone(),
            device: raw.clone(),
            physical_device,
            debug_settings,
            buffer_device_address: false,
            allocation_sizes: gpu_allocator::AllocationSizes::default(),
        })
        .map_err(|source| GpuError::Allocation {
            object: "allocator".into(),
            size: 0,
            source: source.into(),
        })?;
        // SAFETY: the device was made with these features, from this instance; both live as long as the context, which owns
        // them; objects are dropped when idle, because every submission is waited for.
        let context = unsafe {
            let options = ContextOptions {
                features,
                debug_utils,
                storage_tables: options.storage_tables,
                keep_alive: Some(Box::new(owner)),
            };
            DeviceContext::new(&instance_handle, physical_device, &raw, Arc::new(Mutex::new(allocator)), options)
        };
        // SAFETY: the device was made with one queue of this family.
        let queue = unsafe { raw.get_device_queue(queue_family, 0) };
        let queue = Mutex::new(queue);
        let kept = Mutex::default();
        Ok(Self { context, instance: instance_handle, physical_device, queue_family, queue, messages, kept })
    }

    /// Context that buffers, images and pipelines are made from.
    pub fn context(&self) -> &Arc<DeviceContext> {
        &self.context
    }

    /// The Vulkan device.
    pub fn device(&self) -> &ash::Device {
        self.context.device()
    }

    /// The Vulkan instance, whose version is 1.3.
    pub fn instance(&self) -> &ash::Instance {
        &self.instance
    }

    /// The physical device.
    pub fn physical_device(&self) -> vk::PhysicalDevice {
        self.physical_device
    }

    /// The family of the queue, which draws, copies and computes.
    pub fn queue_family(&self) -> u32 {
        self.queue_family
    }

    /// Properties of the device.
    pub fn properties(&self) -> &DeviceProperties {
        self.context.properties()
    }

    /// Records commands, runs them, and waits until they are done.
    pub fn submit<R>(&self, record: impl FnOnce(vk::CommandBuffer) -> R) -> Result<R, GpuError> {
        self.try_submit(|cmd| Ok::<R, GpuError>(record(cmd)))
    }

    /// As [`Headless::submit`], but nothing is run if recording fails.
    pub fn try_submit<R, E: From<GpuError>>(
        &self,
        record: impl FnOnce(vk::CommandBuffer) -> Result<R, E>,
    ) -> Result<R, E> {
        let (_pool, cmd, recorded) = self.commands(record)?;
        self.run(cmd)?;
        Ok(recorded)
    }

    /// Records commands that are never run: to time the recording alone.
    pub fn record<R, E: From<GpuError>>(&self, record: impl FnOnce(vk::CommandBuffer) -> Result<R, E>) -> Result<R, E> {
        self.commands(record).map(|(_, _, recorded)| recorded)
    }

    /// A command buffer with commands, and the pool it goes with.
    fn commands<R, E: From<GpuError>>(
        &self,
        record: impl FnOnce(vk::CommandBuffer) -> Result<R, E>,
    ) -> Result<(Owned<vk::CommandPool>, vk::CommandBuffer, R), E> {
        let device = self.device();
        let info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::TRANSIENT)
            .queue_family_index(self.queue_family);
        // A pool for each submission, so that several threads can record at once.
        // SAFETY: the handles are of this device and taken over by `Owned`; the command buffer goes with its pool, after the
        // device is done with it.
        unsafe {
            let pool = device.create_command_pool(&info, None).of("vkCreateCommandPool", "submission")?;
            let pool = Owned::new(&self.context, pool, "submission");
            let info = vk::CommandBufferAllocateInfo::default().command_pool(pool.raw()).command_buffer_count(1);
            let commands = device.allocate_command_buffers(&info).of("vkAllocateCommandBuffers", "submission")?;
            let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            device.begin_command_buffer(commands[0], &begin).of("vkBeginCommandBuffer", "submission")?;
            let recorded = record(commands[0])?;
            // What the device writes is to be seen by the host after the fence.
            let to_host = vk::MemoryBarrier2::default()
                .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
                .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
                .dst_stage_mask(vk::PipelineStageFlags2::HOST)
                .dst_access_mask(vk::AccessFlags2::HOST_READ);
            let barriers = [to_host];
            device.cmd_pipeline_barrier2(commands[0], &vk::DependencyInfo::default().memory_barriers(&barriers));
            device.end_command_buffer(commands[0]).of("vkEndCommandBuffer", "submission")?;
            Ok((pool, commands[0], recorded))
        }
    }

    /// Submits a command buffer and waits for it.
    fn run(&self, cmd: vk::CommandBuffer) -> Result<(), GpuError> {
        let device = self.device();
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(cmd)];
        let submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands)];
        // SAFETY: the queue is used under its lock; the fence outlives its use.
        unsafe {
            let fence = device.create_fence(&vk::FenceCreateInfo::default(), None).of("vkCreateFence", "submission")?;
            let fence = Owned::new(&self.context, fence, "submission");
            let queue = self.queue.lock().unwrap_or_else(PoisonError::into_inner);
            device.queue_submit2(*queue, &submit, fence.raw()).of("vkQueueSubmit2", "submission")?;
            drop(queue);
            device.wait_for_fences(&[fence.raw()], true, u64::MAX).of("vkWaitForFences", "submission")
        }
    }

    /// The queue, while nothing else is submitted to it.
    pub fn with_queue<R>(&self, with: impl FnOnce(vk::Queue) -> R) -> R {
        with(*self.queue.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Waits until the device has nothing to do.
    pub fn wait_idle(&self) -> Result<(), GpuError> {
        let _queue = self.queue.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: no other thread uses the queue.
        unsafe { self.device().device_wait_idle() }.of("vkDeviceWaitIdle", "device")
    }

    /// What is made once for this device by those who build on it, and goes with it: one of each type.
    pub(crate) fn kept<T: Default + Send + Sync + 'static>(&self) -> Arc<T> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.iter().find_map(|kept| kept.clone().downcast().ok()).unwrap_or_else(|| {
            let new = Arc::<T>::default();
            kept.push(new.clone());
            new
        })
    }

    /// The warnings and errors of the validation layer so far.
    pub fn validation_messages(&self) -> Vec<String> {
        self.messages.all()
    }

    /// Panics if the validation layer has said anything.
    #[track_caller]
    pub fn assert_silent(&self) {
        let messages = self.validation_messages();
        assert!(messages.is_empty(), "validation messages:\n{}", messages.join("\n"));
    }

    /// Destroys the device and returns everything the validation layer said, leaks included.
    pub fn finish(self) -> Vec<String> {
        let messages = self.messages.clone();
        let context = Arc::downgrade(&self.context);
        drop(self);
        if context.strong_count() > 0 {
            messages.push(format!(
                "the device is still in use: {} references to its context are left",
                context.strong_count()
            ));
        }
        messages.all()
    }

    /// [`Headless::finish`], with a panic if the validation layer has said anything.
    #[track_caller]
    pub fn finish_silent(self) {
        let messages = self.finish();
        assert!(messages.is_empty(), "validation messages:\n{}", messages.join("\n"));
    }
}

impl Drop for Headless {
    fn drop(&mut self) {
        // A lost device can be destroyed as well.
        let _ = self.wait_idle();
    }
}

/// A device with one queue, and every feature that it has and the crate knows of.
fn create_device(
    instance: &Instance,
    physical_device: vk::PhysicalDevice,
    properties: &DeviceProperties,
    queue_family: u32,
) -> Result<ash::Device, GpuError> {
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&[1.0])];
    let extensions: Vec<_> = properties.features.extensions().into_iter().map(|name| name.as_ptr()).collect();
    let _one_at_a_time = LIFE.lock().unwrap_or_else(PoisonError::into_inner);
    properties.features.chain(|features| {
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .push_next(features);
        // SAFETY: the device has all that is asked of it.
        unsafe { instance.raw.create_device(physical_device, &info, None) }.of("vkCreateDevice", &properties.name)
    })
}
