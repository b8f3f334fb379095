//! What goes with the rows: the device, the options, the meshes, who did not run, and the command.

use super::results::{Setting, Who};
use ash_subdiv::bench::{BenchError, BenchOptions, Contestant, Subject, Subset};
use ash_subdiv::gpu::{DeviceProperties, version_text};
use ash_subdiv::topology::PatchKind;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct DeviceOut {
    pub name: String,
    pub driver: String,
    pub driver_info: String,
    pub vulkan: String,
    /// Nanoseconds a tick.
    pub timestamp_period: f32,
    /// Of this machine, for drivers that draw on the CPU.
    pub processors: usize,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct OptionsOut {
    pub size: [u32; 2],
    pub instances: u32,
    pub passes: Vec<u32>,
    pub frames: u32,
    pub warm_up: u32,
    pub patches: String,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct MeshOut {
    pub name: String,
    pub vertices: usize,
    pub faces: usize,
    /// Those that are drawn, by kind.
    pub patches: BTreeMap<String, u32>,
    /// Of each scheme: root mean square of the angle to the limit surface's normal, in radians. Measured for reports.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub normal_error: BTreeMap<String, f64>,
    /// A picture as a `data:` address. Made for reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thumbnail: Option<String>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct LeftOut {
    #[serde(flatten)]
    pub setting: Setting,
    #[serde(flatten)]
    pub who: Who,
    /// All if none.
    pub factor: Option<f32>,
    pub why: String,
}

impl OptionsOut {
    pub(super) fn new(options: &BenchOptions, passes: &[u32], patches: Subset) -> Self {
        let &BenchOptions { size, instances, frames, warm_up, .. } = options;
        Self { size, instances, passes: passes.to_vec(), frames, warm_up, patches: patches.name().to_owned() }
    }

    /// What the times of a row depend on besides its setting, as the program's options.
    pub(super) fn alike(&self) -> [String; 3] {
        let Self { size: [width, height], instances, patches, .. } = self;
        [format!("--size {width}x{height}"), format!("--instances {instances}"), format!("--patches {patches}")]
    }
}

impl DeviceOut {
    /// The device and its driver.
    pub(super) fn title(&self) -> String {
        format!("{}, {}", self.name, self.driver_info)
    }

    pub(super) fn new(properties: &DeviceProperties) -> Self {
        Self {
            name: properties.name.clone(),
            driver: properties.driver_name.clone(),
            driver_info: properties.driver_info.clone(),
            vulkan: version_text(properties.api_version),
            timestamp_period: properties.timestamp_period,
            processors: std::thread::available_parallelism().map_or(0, usize::from),
        }
    }
}

impl MeshOut {
    pub(super) fn new(subject: &Subject) -> Self {
        let patches = PatchKind::ALL.map(|kind| (kind.name().to_owned(), subject.patch_count(kind)));
        Self {
            name: subject.name.clone(),
            vertices: subject.mesh.vertex_count(),
            faces: subject.mesh.face_count(),
            patches: patches.into(),
            normal_error: BTreeMap::new(),
            thumbnail: None,
        }
    }
}

impl LeftOut {
    pub(super) fn new(
        subject: &Subject,
        options: &BenchOptions,
        contestant: Contestant,
        factor: Option<f32>,
        why: &BenchError,
    ) -> Self {
        Self {
            // In this view as in the others.
            setting: Setting::new(subject, options, options.cameras[0]),
            who: Who::new(contestant),
            factor,
            why: why.to_string(),
        }
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { setting, who, factor, why } = self;
        write!(f, "{}: {}", setting.mesh, who.label())?;
        if let Some(factor) = factor {
            write!(f, " at factor {factor}")?;
        }
        write!(f, " is left out: {why}")
    }
}

/// The arguments as a shell would take them.
pub(super) fn command_line(arguments: impl Iterator<Item = String>) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=:+@%".contains(c);
    let quote = |argument: String| match !argument.is_empty() && argument.chars().all(plain) {
        true => argument,
        false => format!("'{}'", argument.replace('\'', "'\\''")),
    };
    let mut arguments = arguments;
    // Not where the program lies, which is nobody's business.
    arguments.next();
    ["subdiv".to_owned()].into_iter().chain(arguments.map(quote)).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_can_be_typed_again() {
        let arguments = ["/x/subdiv", "bench", "a b.obj", "--factors", "4,8", "it's", ""];
        let line = command_line(arguments.into_iter().map(str::to_owned));
        assert_eq!(line, r"subdiv bench 'a b.obj' --factors 4,8 'it'\''s' ''");
    }
}
