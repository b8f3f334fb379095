//! The most that is read from a file.

use super::{MAX_CORNERS, MeshError};

/// The most that is read from a file, checked before memory is taken for it. Greater sizes are errors
/// ([`MeshError::BeyondLimit`]) that name the limit.
///
/// Few bytes of a glTF file can draw a mesh any number of times; the other formats need bytes for all that they hold.
///
/// ```
/// use ash_subdiv::mesh::{Limits, ReadOptions};
/// let limits = Limits::default().with("faces", 200_000_000).expect("a limit");
/// let options = ReadOptions { limits, ..ReadOptions::default() };
/// assert_eq!(options.limits.faces, 200_000_000);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limits {
    /// Bytes of the file, and of all files that it names: 4 GiB.
    pub bytes: u64,
    /// Vertices: 50 million. Never more than 2^30.
    pub vertices: u64,
    /// Faces: 50 million.
    pub faces: u64,
    /// Face corners, and the numbers that move them, such as those of animations: 200 million. Never more than 2^30.
    pub corners: u64,
    /// Values in the JSON of a glTF file: 4 million. They may be nested 128 deep, whatever the limits.
    pub json_values: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { bytes: 4 << 30, vertices: 50_000_000, faces: 50_000_000, corners: 200_000_000, json_values: 4_000_000 }
    }
}

impl Limits {
    /// Names of the limits.
    pub const NAMES: [&str; 5] = ["bytes", "vertices", "faces", "corners", "json-values"];

    /// No limits but those of numbering: for what is in memory already.
    pub(super) const NUMBERING: Self = Self {
        bytes: u64::MAX,
        vertices: MAX_CORNERS as u64,
        faces: MAX_CORNERS as u64,
        corners: MAX_CORNERS as u64,
        json_values: u64::MAX,
    };

    /// The same with another limit, by its name; `None` if there is none of this name.
    pub fn with(mut self, name: &str, limit: u64) -> Option<Self> {
        let place = match name {
            "bytes" => &mut self.bytes,
            "vertices" => &mut self.vertices,
            "faces" => &mut self.faces,
            "corners" => &mut self.corners,
            "json-values" => &mut self.json_values,
            _ => return None,
        };
        *place = limit;
        Some(self)
    }

    pub(super) fn check_bytes(&self, count: u64) -> Result<(), MeshError> {
        check("bytes", "bytes", count, self.bytes)
    }

    pub(super) fn check_vertices(&self, count: u64) -> Result<(), MeshError> {
        check("vertices", "vertices", count, self.vertices.min(MAX_CORNERS as u64))
    }

    pub(super) fn check_faces(&self, count: u64) -> Result<(), MeshError> {
        check("faces", "faces", count, self.faces)
    }

    pub(super) fn check_corners(&self, what: &'static str, count: u64) -> Result<(), MeshError> {
        check("corners", what, count, self.corners.min(MAX_CORNERS as u64))
    }

    #[cfg(feature = "gltf")]
    pub(super) fn check_json_values(&self, count: u64) -> Result<(), MeshError> {
        check("json-values", "values in its JSON", count, self.json_values)
    }
}

fn check(limit: &'static str, what: &'static str, count: u64, max: u64) -> Result<(), MeshError> {
    if count <= max { Ok(()) } else { Err(MeshError::BeyondLimit { limit, what, count, max }) }
}
