use std::any::Any;
use std::ffi::CString;
use std::sync::Arc;

use ash::vk;

use super::{Allocator, Features, PatchBatch};

/// The largest alignment of offsets into buffers that any Vulkan device asks for, of uniform, storage and texel buffers.
pub const MAX_OFFSET_ALIGNMENT: u64 = 256;
/// Every Vulkan device can dispatch as many workgroups along an axis.
pub const MAX_WORKGROUPS: u32 = 65_535;

/// A version of Vulkan as people write it, such as "1.3.230".
pub fn version_text(version: u32) -> String {
    let (major, minor) = (vk::api_version_major(version), vk::api_version_minor(version));
    format!("{major}.{minor}.{}", vk::api_version_patch(version))
}

/// Properties of a device: limits, and the driver bugs to work around, as named properties.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct DeviceProperties {
    /// As the driver calls it.
    pub name: String,
    /// Discrete, integrated, CPU, and so on.
    pub device_type: vk::PhysicalDeviceType,
    /// The newest Vulkan that the device has, as `VK_MAKE_API_VERSION` packs it.
    pub api_version: u32,
    /// Which driver it is; zero where the device does not say.
    pub driver: vk::DriverId,
    /// The driver's name.
    pub driver_name: String,
    /// The driver's version, in its own words.
    pub driver_info: String,
    /// Patches that a draw instance may hold.
    pub patch_batch: PatchBatch,
    /// Indices of triangles that the driver takes at a time, making vertices anew after: uniform grids with more are drawn as strips,
    /// which have a third. Mesa's draw module (lavapipe) takes 1023, looking each of them up, too; of others no such limit is known.
    pub indices_at_once: u32,
    /// Sample counts that colour and depth attachments both have.
    pub sample_counts: vk::SampleCountFlags,
    /// The largest tessellation factor.
    pub max_tessellation_level: u32,
    /// The most control points a patch can have.
    pub max_patch_size: u32,
    /// The largest storage buffer that a shader can see at once, in bytes.
    pub max_storage_buffer_range: u64,
    /// Storage buffers that a shader stage can have.
    pub max_stage_storage_buffers: u32,
    /// Vertex attributes of a pipeline.
    pub max_vertex_attributes: u32,
    /// The most elements of a texel buffer.
    pub max_texel_buffer_elements: u64,
    /// Whether shaders read tables as texel buffers, as they do where these are as large as tables may be: on lavapipe that takes
    /// half as long as reading storage buffers. Every device has 65 536 elements; those that have many more have all as many
    /// as are asked for here, 2^27.
    pub reads_texels: bool,
    /// The largest buffer, in bytes.
    pub max_buffer_size: u64,
    /// The largest width and height of a 2D image.
    pub max_image_size: u32,
    /// The push constants of a pipeline layout, in bytes.
    pub max_push_constants: u32,
    /// The thinnest and the widest line, in pixels.
    pub line_widths: [f32; 2],
    /// Nanoseconds a timestamp tick.
    pub timestamp_period: f32,
    /// The features that the device has, enabled or not.
    pub features: Features,
}

impl DeviceProperties {
    /// The properties of a physical device.
    ///
    /// # Safety
    ///
    /// `physical_device` comes from `instance`, whose version is at least 1.1.
    pub unsafe fn query(instance: &ash::Instance, physical_device: vk::PhysicalDevice) -> Self {
        let mut driver = vk::PhysicalDeviceDriverProperties::default();
        let mut v13 = vk::PhysicalDeviceVulkan13Properties::default();
        let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut driver).push_next(&mut v13);
        // SAFETY: as the caller promises.
        unsafe { instance.get_physical_device_properties2(physical_device, &mut all) };
        let core = all.properties;
        let limits = core.limits;
        let text =
            |text: Result<&std::ffi::CStr, _>| text.map(|t| t.to_string_lossy().into_owned()).unwrap_or_default();
        Self {
            name: text(core.device_name_as_c_str()),
            device_type: core.device_type,
            api_version: core.api_version,
            driver: driver.driver_id,
            driver_name: text(driver.driver_name_as_c_str()),
            driver_info: text(driver.driver_info_as_c_str()),
            patch_batch: PatchBatch::of_driver(driver.driver_id),
            indices_at_once: if driver.driver_id == vk::DriverId::MESA_LLVMPIPE { 1023 } else { u32::MAX },
            sample_counts: limits.framebuffer_color_sample_counts & limits.framebuffer_depth_sample_counts,
            max_tessellation_level: limits.max_tessellation_generation_level,
            max_patch_size: limits.max_tessellation_patch_size,
            max_storage_buffer_range: limits.max_storage_buffer_range.into(),
            max_stage_storage_buffers: limits.max_per_stage_descriptor_storage_buffers,
            max_vertex_attributes: limits.max_vertex_input_attributes,
            max_texel_buffer_elements: limits.max_texel_buffer_elements.into(),
            reads_texels: limits.max_texel_buffer_elements >= 1 << 27,
            // Zero where the device is older than Vulkan 1.3 and does not say.
            max_buffer_size: if v13.max_buffer_size == 0 { u64::MAX } else { v13.max_buffer_size },
            max_image_size: limits.max_image_dimension2_d,
            max_push_constants: limits.max_push_constants_size,
            line_widths: limits.line_width_range,
            timestamp_period: limits.timestamp_period,
            // SAFETY: as the caller promises.
            features: unsafe { Features::supported(instance, physical_device) },
        }
    }

    /// The sample counts in numbers, ascending.
    pub fn sample_counts(&self) -> Vec<u32> {
        (0..7).map(|bit| 1 << bit).filter(|&n| self.sample_counts.contains(vk::SampleCountFlags::from_raw(n))).collect()
    }
}

/// Options of a device's making, which Vulkan cannot be asked for afterwards.
#[derive(Default)]
pub struct ContextOptions {
    /// The features that were enabled at device creation.
    pub features: Features,
    /// Whether `VK_EXT_debug_utils` is enabled on the instance: objects then get debug names.
    pub debug_utils: bool,
    /// Have shaders read tables as storage buffers, even where [`DeviceProperties::reads_texels`] would have them read texel
    /// buffers: for devices on which that is faster.
    pub storage_tables: bool,
    /// Dropped after everything else: what has to outlive the last object, such as the owner of the device.
    pub keep_alive: Option<Box<dyn Any + Send + Sync>>,
}

/// The device that all objects of the crate are made from; shared by them.
pub struct DeviceContext {
    instance: ash::Instance,
    physical_device: vk::PhysicalDevice,
    device: ash::Device,
    properties: DeviceProperties,
    features: Features,
    debug_utils: Option<ash::ext::debug_utils::Device>,
    // These two last, in this order: fields are dropped from top to bottom.
    allocator: Arc<dyn Allocator>,
    _keep_alive: Option<Box<dyn Any + Send + Sync>>,
}

impl DeviceContext {
    /// Takes in the caller's device, which stays the caller's to destroy.
    ///
    /// # Safety
    ///
    /// * `device` was created from `physical_device` of `instance`, with the features and extensions that `options`
    ///   name, and `allocator` allocates from it.
    /// * `device` and `instance` live until the context, and every object made from it, is dropped.
    /// * An object made from the context is dropped, and its memory accessed by the host, only when the device is not
    ///   using it.
    pub unsafe fn new(
        instance: &ash::Instance,
        physical_device: vk::PhysicalDevice,
        device: &ash::Device,
        allocator: Arc<dyn Allocator>,
        options: ContextOptions,
    ) -> Arc<Self> {
        let debug_utils = options.debug_utils.then(|| ash::ext::debug_utils::Device::new(instance, device));
        // SAFETY: as the caller promises.
        let mut properties = unsafe { DeviceProperties::query(instance, physical_device) };
        properties.reads_texels &= !options.storage_tables;
        Arc::new(Self {
            instance: instance.clone(),
            physical_device,
            device: device.clone(),
            properties,
            features: options.features,
            debug_utils,
            allocator,
            _keep_alive: options.keep_alive,
        })
    }

    /// The Vulkan device.
    pub fn device(&self) -> &ash::Device {
        &self.device
    }

    /// Properties of images of this format and these uses; `None` if the device has none.
    pub(super) fn images(&self, format: vk::Format, usage: vk::ImageUsageFlags) -> Option<vk::ImageFormatProperties> {
        let (kind, tiling, none) = (vk::ImageType::TYPE_2D, vk::ImageTiling::OPTIMAL, vk::ImageCreateFlags::empty());
        let (instance, device) = (&self.instance, self.physical_device);
        // SAFETY: the device is of the instance, which lives, as the caller of `new` promised; there are uses.
        unsafe { instance.get_physical_device_image_format_properties(device, format, kind, tiling, usage, none).ok() }
    }

    /// What the device can do with images and buffers of a format.
    pub(crate) fn format_properties(&self, format: vk::Format) -> vk::FormatProperties {
        // SAFETY: the device is of the instance, which lives, as the caller of `new` promised.
        unsafe { self.instance.get_physical_device_format_properties(self.physical_device, format) }
    }

    /// Properties of the device.
    pub fn properties(&self) -> &DeviceProperties {
        &self.properties
    }

    /// The features that are enabled.
    pub fn features(&self) -> Features {
        self.features
    }

    /// Where buffers and images get their memory.
    pub fn allocator(&self) -> &dyn Allocator {
        &*self.allocator
    }

    /// Gives a Vulkan object the name that debuggers and validation messages show, if `VK_EXT_debug_utils` is enabled.
    pub fn set_name<T: vk::Handle>(&self, object: T, name: &str) {
        let Some(debug_utils) = &self.debug_utils else { return };
        let name = CString::new(name.replace('\0', " ")).unwrap_or_default();
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(object).object_name(&name);
        // SAFETY: the object is of this device. A name that could not be stored is no reason to fail.
        let _ = unsafe { debug_utils.set_debug_utils_object_name(&info) };
    }

    /// Opens a labelled region of a command buffer, shown by frame debuggers; closed by [`DeviceContext::cmd_end_label`].
    ///
    /// # Safety
    ///
    /// `cmd` is a command buffer of this device that is being recorded.
    pub unsafe fn cmd_begin_label(&self, cmd: vk::CommandBuffer, name: &str) {
        let Some(debug_utils) = &self.debug_utils else { return };
        let name = CString::new(name.replace('\0', " ")).unwrap_or_default();
        // SAFETY: as the caller promises.
        unsafe { debug_utils.cmd_begin_debug_utils_label(cmd, &vk::DebugUtilsLabelEXT::default().label_name(&name)) };
    }

    /// Closes a labelled region.
    ///
    /// # Safety
    ///
    /// `cmd` is being recorded, and a region is open in it.
    pub unsafe fn cmd_end_label(&self, cmd: vk::CommandBuffer) {
        if let Some(debug_utils) = &self.debug_utils {
            // SAFETY: as the caller promises.
            unsafe { debug_utils.cmd_end_debug_utils_label(cmd) };
        }
    }
}

impl std::fmt::Debug for DeviceContext {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DeviceContext")
            .field("device", &self.device.handle())
            .field("name", &self.properties.name)
            .finish()
    }
}
