//! The Vulkan instance, with the validation layer and what it says.

use std::borrow::Cow;
use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use ash::vk;

use super::HeadlessError;
use crate::gpu::{VkResultExt, version_text};

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Instances and devices are made and destroyed one at a time: tests do so in parallel, and then loader, layers and
/// drivers load and unload libraries and read the environment, which is not safe in all of them.
pub(super) static LIFE: Mutex<()> = Mutex::new(());

/// The loader, opened once and never closed.
fn entry() -> Result<&'static ash::Entry, HeadlessError> {
    static ENTRY: OnceLock<Result<ash::Entry, String>> = OnceLock::new();
    // SAFETY: loading the Vulkan loader runs its initializers, which are sound.
    let entry = ENTRY.get_or_init(|| unsafe { ash::Entry::load() }.map_err(|error| error.to_string()));
    entry.as_ref().map_err(|message| HeadlessError::NoLoader { message: message.clone() })
}

/// Warnings and errors of the validation layer, in the order they came.
#[derive(Debug, Default)]
pub(super) struct Messages(Mutex<Vec<String>>);

impl Messages {
    pub(super) fn push(&self, message: String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(message);
    }

    pub(super) fn all(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Messages that are known to be wrong, by id, each with the reason. None so far.
const FALSE_POSITIVES: &[(&str, &str)] = &[];

/// Called by the validation layer.
unsafe extern "system" fn collect(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _types: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer passes valid data, and the pointer that `Instance::new` gave it.
    let (data, messages) = unsafe { (&*data, &*messages.cast::<Messages>()) };
    let text = |pointer: *const std::ffi::c_char| match pointer.is_null() {
        true => Cow::Borrowed(""),
        // SAFETY: a string of the layer.
        false => unsafe { CStr::from_ptr(pointer) }.to_string_lossy(),
    };
    let id = text(data.p_message_id_name);
    if !FALSE_POSITIVES.iter().any(|(known, _)| *known == id) {
        messages.push(format!("{severity:?} {id}: {}", text(data.p_message)));
    }
    vk::FALSE
}

/// An instance that is destroyed when dropped.
pub(super) struct Instance {
    pub raw: ash::Instance,
    /// Whether object names are understood (`VK_EXT_debug_utils`).
    pub debug_utils: bool,
    pub messages: Arc<Messages>,
    messenger: Option<(ash::ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
}

impl Instance {
    pub fn new(validation: bool) -> Result<Self, HeadlessError> {
        let entry = entry()?;
        let one_at_a_time = LIFE.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: plain queries.
        let version = unsafe { entry.try_enumerate_instance_version() }
            .of("vkEnumerateInstanceVersion", "instance")?
            .unwrap_or(vk::API_VERSION_1_0);
        if version < vk::API_VERSION_1_3 {
            return Err(HeadlessError::OldLoader { version: version_text(version) });
        }
        let layers =
            // SAFETY: as above.
            unsafe { entry.enumerate_instance_layer_properties() }.of("vkEnumerateInstanceLayerProperties", "instance")?;
        if validation && !layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION_LAYER)) {
            return Err(HeadlessError::NoValidationLayer);
        }
        // SAFETY: as above.
        let extensions = unsafe { entry.enumerate_instance_extension_properties(None) }
            .of("vkEnumerateInstanceExtensionProperties", "instance")?;
        let debug_utils =
            validation || extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(ash::ext::debug_utils::NAME));

        let mut names = Vec::new();
        if debug_utils {
            names.push(ash::ext::debug_utils::NAME.as_ptr());
        }
        let mut layer_names = Vec::new();
        if validation {
            names.push(ash::ext::validation_features::NAME.as_ptr());
            layer_names.push(VALIDATION_LAYER.as_ptr());
        }
        let messages = Arc::new(Messages::default());
        let application =
            vk::ApplicationInfo::default().application_name(c"ash-subdiv").api_version(vk::API_VERSION_1_3);
        let mut features = vk::ValidationFeaturesEXT::default()
            .enabled_validation_features(&[vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION]);
        // Chained into the creation too, so that what happens in vkCreateInstance and vkDestroyInstance is heard.
        let mut listener = listener(&messages);
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&application)
            .enabled_extension_names(&names)
            .enabled_layer_names(&layer_names);
        if validation {
            info = info.push_next(&mut features).push_next(&mut listener);
        }
        // SAFETY: the description is valid; `messages` lives as long as the instance.
        let raw = unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
            vk::Result::ERROR_INCOMPATIBLE_DRIVER => HeadlessError::NoDevice,
            result => crate::gpu::GpuError::from_result(result, "vkCreateInstance", "instance").into(),
        })?;
        // Dropping the instance takes it again.
        drop(one_at_a_time);
        let mut instance = Self { raw, debug_utils, messages, messenger: None };
        if validation {
            instance.listen(entry)?;
        }
        Ok(instance)
    }

    /// Collects what the validation layer reports from now on.
    fn listen(&mut self, entry: &ash::Entry) -> Result<(), HeadlessError> {
        let debug = ash::ext::debug_utils::Instance::new(entry, &self.raw);
        // SAFETY: the description is valid; `messages` lives as long as the instance.
        let messenger = unsafe { debug.create_debug_utils_messenger(&listener(&self.messages), None) }
            .of("vkCreateDebugUtilsMessengerEXT", "instance")?;
        self.messenger = Some((debug, messenger));
        Ok(())
    }

    /// The physical devices, in the driver's order.
    pub fn physical_devices(&self) -> Result<Vec<vk::PhysicalDevice>, HeadlessError> {
        let _one_at_a_time = LIFE.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: a plain query.
        match unsafe { self.raw.enumerate_physical_devices() } {
            Err(vk::Result::ERROR_INITIALIZATION_FAILED) => Err(HeadlessError::NoDevice),
            devices => Ok(devices.of("vkEnumeratePhysicalDevices", "instance")?),
        }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // Called with `LIFE` free: the owner of the device has released it.
        let _one_at_a_time = LIFE.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: everything made from the instance is gone.
        unsafe {
            if let Some((debug, messenger)) = self.messenger.take() {
                debug.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

fn listener(messages: &Arc<Messages>) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    use vk::DebugUtilsMessageSeverityFlagsEXT as Severity;
    use vk::DebugUtilsMessageTypeFlagsEXT as Type;
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::WARNING | Severity::ERROR)
        // GENERAL is the loader's talk about the machine's other drivers.
        .message_type(Type::VALIDATION | Type::PERFORMANCE)
        .pfn_user_callback(Some(collect))
        .user_data(Arc::as_ptr(messages).cast_mut().cast())
}
