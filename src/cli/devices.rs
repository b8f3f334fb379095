//! `subdiv devices`: the Vulkan devices of this machine.

use super::described::described;
use super::error::CliError;
use super::output::{self, with_stdout};
use ash_subdiv::headless::{DeviceInfo, HeadlessError, devices};
use serde::Serialize;

described! {
    #[derive(Serialize)]
    pub(super) struct DeviceOut {
        index: usize,
        name: String,
        #[serde(rename = "type")]
        kind: &'static str,
        vulkan: String,
        driver: String,
        driver_info: String,
        max_tessellation_level: u32,
        max_patch_size: u32,
        samples: Vec<u32>,
        max_image_size: u32,
        max_storage_buffer_range: u64,
        max_line_width: f32,
        features: Vec<&'static str>,
        /// Needs of the program that the device lacks; it can be used if this is empty.
        missing: Vec<String>,
    }
}

impl DeviceOut {
    fn new(info: DeviceInfo) -> Self {
        let (kind, vulkan) = (info.type_name(), info.api_version());
        let properties = info.properties;
        Self {
            index: info.index,
            kind,
            vulkan,
            max_tessellation_level: properties.max_tessellation_level,
            max_patch_size: properties.max_patch_size,
            samples: properties.sample_counts(),
            max_image_size: properties.max_image_size,
            max_storage_buffer_range: properties.max_storage_buffer_range,
            max_line_width: properties.line_widths[1],
            features: properties.features.named().filter(|(_, has)| *has).map(|(name, _)| name).collect(),
            name: properties.name,
            driver: properties.driver_name,
            driver_info: properties.driver_info,
            missing: info.missing,
        }
    }
}

pub(super) fn run(json: bool) -> Result<(), CliError> {
    let all: Vec<DeviceOut> = devices()?.into_iter().map(DeviceOut::new).collect();
    if all.is_empty() {
        return Err(HeadlessError::NoDevice.into());
    }
    if json {
        return output::json_pretty(&all);
    }
    with_stdout(|out| {
        for device in &all {
            let samples: Vec<String> = device.samples.iter().map(u32::to_string).collect();
            let lacks = if device.missing.is_empty() { "nothing".to_owned() } else { device.missing.join(", ") };
            writeln!(out, "{}: {}", device.index, device.name)?;
            for (what, value) in [
                ("type", device.kind.to_owned()),
                ("Vulkan", device.vulkan.clone()),
                ("driver", format!("{} {}", device.driver, device.driver_info)),
                ("largest factor", device.max_tessellation_level.to_string()),
                ("samples a pixel", samples.join(", ")),
                ("largest image", format!("{0} x {0}", device.max_image_size)),
                ("storage buffer", format!("{} bytes", device.max_storage_buffer_range)),
                ("widest line", format!("{} pixels", device.max_line_width)),
                ("features", device.features.join(", ")),
                ("lacks", lacks),
            ] {
                writeln!(out, "   {what:<16}{value}")?;
            }
        }
        Ok(())
    })
}
