//! What models take.

/// Bytes by what they are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct MemoryUsage {
    /// Connectivity or stencils, and texture coordinates, on the device.
    pub tables: u64,
    /// Control vertices on the device, and factors of edges.
    pub positions: u64,
    /// What the cached construction keeps, on the device: control points, what corners share, frames.
    pub control_points: u64,
    /// Vertices that were evaluated by compute, on the device.
    pub vertices: u64,
    /// Indices of the uniform grids of models that are not tessellated, on the device: once for all with as many segments.
    pub indices: u64,
    /// Edges and faces of control meshes on the device, if a style draws them.
    pub control_meshes: u64,
    /// What the host writes: positions of each frame in flight, and tables that were not copied yet.
    pub staging: u64,
    /// Lists of the patches that can be seen, on the device.
    pub lists: u64,
    /// What the host writes for each view, and for each item of a frame.
    pub views: u64,
}

impl MemoryUsage {
    /// All together.
    pub fn total(self) -> u64 {
        self.tables
            + self.positions
            + self.control_points
            + self.vertices
            + self.indices
            + self.control_meshes
            + self.lists
            + self.staging
            + self.views
    }
}
