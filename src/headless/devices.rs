//! Which devices there are, and which of them is taken.

use ash::vk;

use super::HeadlessError;
use super::instance::Instance;
use crate::gpu::{DeviceProperties, Features, version_text};

/// A Vulkan device of this machine.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct DeviceInfo {
    /// The number that selects it in `SUBDIV_DEVICE` and `--device`.
    pub index: usize,
    /// Properties of the device.
    pub properties: DeviceProperties,
    /// Needs of the headless device that this one lacks; it can be used if this is empty.
    pub missing: Vec<String>,
}

impl DeviceInfo {
    /// "discrete GPU", "CPU", ...
    pub fn type_name(&self) -> &'static str {
        match self.properties.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => "discrete GPU",
            vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated GPU",
            vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual GPU",
            vk::PhysicalDeviceType::CPU => "CPU",
            _ => "other",
        }
    }

    /// The Vulkan version, such as "1.3.230".
    pub fn api_version(&self) -> String {
        version_text(self.properties.api_version)
    }

    /// Discrete GPUs first, then integrated ones, then what draws on the CPU.
    fn rank(&self) -> u32 {
        match self.properties.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => 0,
            vk::PhysicalDeviceType::INTEGRATED_GPU => 1,
            vk::PhysicalDeviceType::VIRTUAL_GPU => 2,
            vk::PhysicalDeviceType::CPU => 3,
            _ => 4,
        }
    }
}

/// Needs of every headless device.
pub(super) const BASE: Features = Features {
    tessellation: true,
    dynamic_rendering: true,
    synchronization2: true,
    maintenance4: true,
    ..Features::NONE
};

/// The Vulkan devices of this machine, in the driver's order, usable or not.
pub fn devices() -> Result<Vec<DeviceInfo>, HeadlessError> {
    let instance = Instance::new(false)?;
    Ok(list(&instance, Features::NONE)?.into_iter().map(|(_, info)| info).collect())
}

pub(super) fn list(
    instance: &Instance,
    needs: Features,
) -> Result<Vec<(vk::PhysicalDevice, DeviceInfo)>, HeadlessError> {
    let info = |(index, device)| {
        // SAFETY: the device is of this instance, whose version is 1.3.
        let properties = unsafe { DeviceProperties::query(&instance.raw, device) };
        let missing = missing(instance, device, &properties, needs);
        (device, DeviceInfo { index, properties, missing })
    };
    Ok(instance.physical_devices()?.into_iter().enumerate().map(info).collect())
}

fn missing(
    instance: &Instance,
    device: vk::PhysicalDevice,
    properties: &DeviceProperties,
    needs: Features,
) -> Vec<String> {
    let mut missing = Vec::new();
    if properties.api_version < vk::API_VERSION_1_3 {
        missing.push(format!("Vulkan 1.3 (it has {})", version_text(properties.api_version)));
    }
    missing.extend(properties.features.missing(BASE.union(needs)).into_iter().map(str::to_owned));
    if queue_family(instance, device).is_none() {
        missing.push("a queue for both graphics and compute".to_owned());
    }
    missing
}

/// The first queue family that can do everything.
pub(super) fn queue_family(instance: &Instance, device: vk::PhysicalDevice) -> Option<u32> {
    // SAFETY: the device is of this instance.
    let families = unsafe { instance.raw.get_physical_device_queue_family_properties(device) };
    let both = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    (0..).zip(&families).find(|(_, family)| family.queue_flags.contains(both)).map(|(index, _)| index)
}

/// The device that was asked for by number or part of its name, or the best one that has all that is needed.
pub(super) fn choose(
    instance: &Instance,
    needs: Features,
    wanted: Option<&str>,
) -> Result<(vk::PhysicalDevice, DeviceInfo), HeadlessError> {
    let mut all = list(instance, needs)?;
    if all.is_empty() {
        return Err(HeadlessError::NoDevice);
    }
    let name_list = |all: &[(vk::PhysicalDevice, DeviceInfo)]| {
        let names: Vec<_> = all.iter().map(|(_, info)| format!("{}: {}", info.index, info.properties.name)).collect();
        names.join(", ")
    };
    if let Some(wanted) = wanted {
        let known = name_list(&all);
        let number = wanted.parse::<usize>().ok();
        let part = wanted.to_lowercase();
        all.retain(|(_, info)| match number {
            Some(number) => info.index == number,
            None => info.properties.name.to_lowercase().contains(&part),
        });
        if all.is_empty() {
            return Err(HeadlessError::NoSuchDevice { wanted: wanted.to_owned(), known });
        }
    }
    // Stable, so that the driver's order decides among equals.
    all.sort_by_key(|(_, info)| info.rank());
    let reasons: Vec<_> =
        all.iter().map(|(_, info)| format!("{} lacks {}", info.properties.name, info.missing.join(", "))).collect();
    all.into_iter()
        .find(|(_, info)| info.missing.is_empty())
        .ok_or_else(|| HeadlessError::Unfit { reasons: reasons.join("; ") })
}
