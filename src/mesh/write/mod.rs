//! Meshes with normals, written to files: OBJ, PLY, GLB. Control meshes: see [`control`].

pub mod control;
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

use std::io;

/// A mesh of triangles and quads that is handed out in pieces: each time it is asked for, and in the same order.
pub trait Pieces {
    /// Numbers of vertices, and of those that come first and are no copies of others.
    fn vertex_counts(&self) -> [usize; 2];
    /// Numbers of quads and of triangles.
    fn face_counts(&self) -> [usize; 2];
    /// Whether there are texture coordinates.
    fn has_texcoords(&self) -> bool;
    /// The vertex whose position a vertex has: itself unless it is a copy.
    fn position_of(&self, vertex: u32) -> u32;
    /// Hands out all vertices.
    ///
    /// # Errors
    /// Errors of `visit`.
    fn vertices(&self, visit: &mut dyn FnMut(Vertices) -> io::Result<()>) -> io::Result<()>;
    /// Hands out all quads, counter-clockwise.
    ///
    /// # Errors
    /// Errors of `visit`.
    fn quads(&self, visit: &mut dyn FnMut(&[[u32; 4]]) -> io::Result<()>) -> io::Result<()>;
    /// Hands out all triangles, counter-clockwise.
    ///
    /// # Errors
    /// Errors of `visit`.
    fn triangles(&self, visit: &mut dyn FnMut(&[[u32; 3]]) -> io::Result<()>) -> io::Result<()>;
}

/// Vertices next to each other.
#[derive(Debug, Clone, Copy)]
pub struct Vertices<'v> {
    /// Object space.
    pub positions: &'v [[f32; 3]],
    /// One a vertex.
    pub normals: &'v [[f32; 3]],
    /// One a vertex, if there are any.
    pub texcoords: Option<&'v [[f32; 2]]>,
}

/// A mesh of triangles and quads in arrays: one piece.
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

impl Pieces for Polygons<'_> {
    fn vertex_counts(&self) -> [usize; 2] {
        [self.positions.len(), self.copies.0 as usize]
    }

    fn face_counts(&self) -> [usize; 2] {
        [self.quads.len(), self.triangles.len()]
    }

    fn has_texcoords(&self) -> bool {
        self.texcoords.is_some()
    }

    fn position_of(&self, vertex: u32) -> u32 {
        let (first, sources) = self.copies;
        vertex.checked_sub(first).map_or(vertex, |copy| sources[copy as usize])
    }

    fn vertices(&self, visit: &mut dyn FnMut(Vertices) -> io::Result<()>) -> io::Result<()> {
        let &Self { positions, normals, texcoords, .. } = self;
        visit(Vertices { positions, normals, texcoords })
    }

    fn quads(&self, visit: &mut dyn FnMut(&[[u32; 4]]) -> io::Result<()>) -> io::Result<()> {
        visit(self.quads)
    }

    fn triangles(&self, visit: &mut dyn FnMut(&[[u32; 3]]) -> io::Result<()>) -> io::Result<()> {
        visit(self.triangles)
    }
}

/// Hands out all faces: the quads, then the triangles.
fn for_each_face(mesh: &dyn Pieces, mut visit: impl FnMut(&[u32]) -> io::Result<()>) -> io::Result<()> {
    mesh.quads(&mut |quads| quads.iter().try_for_each(|quad| visit(quad)))?;
    mesh.triangles(&mut |triangles| triangles.iter().try_for_each(|triangle| visit(triangle)))
}

#[cfg(test)]
mod tests;
