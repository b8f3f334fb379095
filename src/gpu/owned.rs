use std::sync::Arc;

use ash::vk;

use super::DeviceContext;

/// A Vulkan handle that is destroyed with a function of the device.
pub trait DeviceHandle: vk::Handle + Copy {
    /// Destroys the object.
    ///
    /// # Safety
    ///
    /// The object is of `device`, is destroyed once, and the device is not using it.
    unsafe fn destroy(self, device: &ash::Device);
}

macro_rules! device_handles {
    ($($handle:ident: $destroy:ident,)*) => {
        $(impl DeviceHandle for vk::$handle {
            unsafe fn destroy(self, device: &ash::Device) {
                // SAFETY: as the caller promises.
                unsafe { device.$destroy(self, None) }
            }
        })*
    };
}

device_handles! {
    Buffer: destroy_buffer,
    BufferView: destroy_buffer_view,
    CommandPool: destroy_command_pool,
    DescriptorPool: destroy_descriptor_pool,
    DescriptorSetLayout: destroy_descriptor_set_layout,
    Fence: destroy_fence,
    Framebuffer: destroy_framebuffer,
    Image: destroy_image,
    ImageView: destroy_image_view,
    Pipeline: destroy_pipeline,
    PipelineCache: destroy_pipeline_cache,
    PipelineLayout: destroy_pipeline_layout,
    QueryPool: destroy_query_pool,
    RenderPass: destroy_render_pass,
    Sampler: destroy_sampler,
    Semaphore: destroy_semaphore,
    ShaderModule: destroy_shader_module,
}

/// A Vulkan object that is destroyed when dropped, and keeps its device context alive.
#[derive(Debug)]
pub struct Owned<T: DeviceHandle> {
    raw: T,
    context: Arc<DeviceContext>,
}

impl<T: DeviceHandle> Owned<T> {
    /// Takes over `raw`, and gives it its debug name.
    ///
    /// # Safety
    ///
    /// `raw` is an object of the context's device that nothing else destroys.
    pub unsafe fn new(context: &Arc<DeviceContext>, raw: T, name: &str) -> Self {
        context.set_name(raw, name);
        Self { raw, context: context.clone() }
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> T {
        self.raw
    }
}

impl<T: DeviceHandle> Drop for Owned<T> {
    fn drop(&mut self) {
        // SAFETY: `new` took the object over; by the contract of `DeviceContext::new` the device is done with it.
        unsafe { self.raw.destroy(self.context.device()) }
    }
}
