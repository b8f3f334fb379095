//! Meshes with normals, written to files: OBJ, PLY, GLB.

#[cfg(feature = "gltf")]
mod glb;
mod kept;
mod obj;
mod ply;

#[cfg(feature = "gltf")]
pub use glb::write_glb;
pub use kept::Kept;
pub use obj::write_obj;
pub use ply::write_ply;

/// A mesh of triangles and quads.
#[derive(Debug, Clone, Copy)]
pub struct Polygons<'m> {
    /// Object space.
    pub positions: &'m [[f32; 3]],
    /// One a vertex.
    pub normals: &'m [[f32; 3]],
    /// One a vertex, if there are any.
    pub texcoords: Option<&'m [[f32; 2]]>,
    /// Vertices from this number on are copies of others: each with the vertex whose position it has.
    pub copies: (u32, &'m [u32]),
    /// Counter-clockwise.
    pub quads: &'m [[u32; 4]],
    /// Counter-clockwise.
    pub triangles: &'m [[u32; 3]],
}

impl Polygons<'_> {
    /// The vertex whose position a vertex has.
    fn position_of(&self, vertex: u32) -> u32 {
        let (first, sources) = self.copies;
        vertex.checked_sub(first).map_or(vertex, |copy| sources[copy as usize])
    }

    fn faces(&self) -> impl Iterator<Item = &[u32]> {
        let quads = self.quads.iter().map(<[u32; 4]>::as_slice);
        quads.chain(self.triangles.iter().map(<[u32; 3]>::as_slice))
    }
}

#[cfg(test)]
mod tests;
