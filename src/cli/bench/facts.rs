//! Facts about the rows: the device, the options, the meshes, who did not run, and the command.

use super::super::described::described;
use super::row::{Setting, Who};
use super::unique;
use ash_subdiv::bench::{BenchError, BenchOptions, Contestant, Subject, Subset};
use ash_subdiv::gpu::DeviceProperties;
use ash_subdiv::headless::objects::version_text;
use ash_subdiv::renderer::Error;
use ash_subdiv::topology::PatchKind;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

described! {
    #[derive(Debug, Serialize, Deserialize)]
    pub(super) struct DeviceOut {
        pub name: String,
        pub driver: String,
        pub driver_info: String,
        pub vulkan: String,
        /// Nanoseconds a tick.
        pub timestamp_period: f32,
        /// Processors of this machine, for drivers that draw on the CPU.
        pub processors: usize,
    }
}

described! {
    #[derive(Debug, Serialize, Deserialize)]
    pub(super) struct OptionsOut {
        pub size: [u32; 2] = "[width, height]",
        #[serde(default)]
        pub single_sided: bool,
        pub instances: u32,
        pub passes: Vec<u32>,
        pub frames: u32,
        pub warm_up: u32,
        pub patches: String,
        #[serde(default)]
        pub refine: u32,
    }
}

described! {
    #[derive(Debug, Serialize, Deserialize)]
    pub(super) struct MeshOut {
        pub name: String,
        /// The mesh that this is so many copies of: by its own name, if one.
        #[serde(default)]
        pub of: String,
        #[serde(default)]
        pub copies: u32,
        /// Sharpness of all creases, if it was given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub sharpness: Option<f32>,
        pub vertices: usize,
        pub faces: usize,
        /// Patches that are drawn, by kind.
        pub patches: BTreeMap<String, u32>,
        /// Error by surface, a scheme or adaptive surface: root mean square of the angle to the limit surface's normal, in radians.
        /// Measured for reports.
        #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
        pub normal_error: BTreeMap<String, f64>,
        /// Likewise of the position, over the diagonal.
        #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
        pub position_error: BTreeMap<String, f64>,
        /// A picture as a `data:` address. Made for reports.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub thumbnail: Option<String>,
    }
}

described! {
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
}

impl OptionsOut {
    pub(super) fn new(options: &BenchOptions, passes: Vec<u32>, patches: Subset, refine: u32) -> Self {
        let &BenchOptions { size, single_sided, instances, frames, warm_up, .. } = options;
        Self { size, single_sided, instances, passes, frames, warm_up, patches: patches.name().to_owned(), refine }
    }

    /// Options that the times of a row depend on besides its setting.
    pub(super) fn alike(&self) -> [String; 5] {
        let Self { size: [width, height], single_sided, instances, patches, refine, .. } = self;
        [
            format!("--size {width}x{height}"),
            if *single_sided { "--single-sided" } else { "both sides" }.to_owned(),
            format!("--instances {instances}"),
            format!("--patches {patches}"),
            format!("--refine {refine}"),
        ]
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
    /// `of` by name, and how many times.
    pub(super) fn new(subject: &Subject, of: &str, sharpness: Option<f32>, copies: u32) -> Self {
        let patches = PatchKind::ALL.map(|kind| (kind.name().to_owned(), subject.patch_count(kind)));
        Self {
            name: subject.name.clone(),
            of: of.to_owned(),
            copies,
            sharpness,
            vertices: subject.mesh.vertex_count(),
            faces: subject.mesh.face_count(),
            patches: patches.into(),
            normal_error: BTreeMap::new(),
            position_error: BTreeMap::new(),
            thumbnail: None,
        }
    }
}

/// What the name of a mesh ends in whose creases all have this sharpness.
pub(super) fn sharpness_in_name(sharpness: f32) -> String {
    format!(", sharpness {sharpness}")
}

/// The mesh of which this one is copies; itself, if nothing is known of it.
pub(super) fn original_name<'m>(meshes: &'m [MeshOut], name: &'m str) -> &'m str {
    let of = meshes.iter().find(|mesh| mesh.name == name).map(|mesh| mesh.of.as_str());
    of.filter(|of| !of.is_empty()).unwrap_or(name)
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
            setting: Setting::new(&subject.name, options, options.cameras[0]),
            who: Who::new(contestant),
            factor,
            why: reason(why),
        }
    }
}

/// In the program's words, where they are not the library's.
fn reason(why: &BenchError) -> String {
    match why {
        BenchError::Renderer(Error::NotEvaluatedBy { what, .. }) => {
            format!("it does not go with {what}: do without, or choose the path tessellation")
        }
        BenchError::Renderer(Error::NoSuchLevel { .. }) => {
            "subdivision has the factors 1, 2, 4 and 8, for levels 0 to 3".into()
        }
        BenchError::Renderer(Error::TableTooLarge { table, bytes, max, .. }) => {
            let table = table.replace('_', " ");
            format!(
                "{table} take {bytes} bytes, but a shader can see {max} at once on this device: draw a smaller mesh, or at smaller factors"
            )
        }
        _ => why.to_string(),
    }
}

/// Those from `first` on by their reasons, without reasons that those before had: each as a sentence that names `most` of them.
pub(super) fn left_out_by_reason(all: &[LeftOut], first: usize, most: usize) -> Vec<String> {
    fn reason(left: &LeftOut) -> (&str, Option<f32>, &str) {
        (&left.setting.mesh, left.factor, &left.why)
    }
    let (before, new) = all.split_at(first);
    let sentence = |(mesh, factor, why)| {
        let alike: Vec<_> = new.iter().filter(|left| reason(left) == (mesh, factor, why)).collect();
        let who = unique(&alike, |left| left.who.label());
        let mut names = who[..who.len().min(most)].join(", ");
        if who.len() > most {
            names += &format!(" and {} more", who.len() - most);
        }
        let factor = factor.map_or_else(String::new, |factor| format!(" at factor {factor}"));
        format!("{mesh}: {names} {} left out{factor}: {why}", if who.len() == 1 { "is" } else { "are" })
    };
    let is_new = |new: &(&str, Option<f32>, &str)| before.iter().all(|left| reason(left) != *new);
    unique(new, reason).into_iter().filter(is_new).map(sentence).collect()
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
