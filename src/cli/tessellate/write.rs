//! Tessellations in files.

use super::super::error::CliError;
use super::super::interrupt::{Interruptible, Watch};
use super::super::output::write_file;
use super::{Kind, TessellateArgs};
use ash_subdiv::dice::{Piece, Sizes, Stream, Tessellation};
use ash_subdiv::mesh::write::{Kept, Pieces, Polygons, Vertices, write_glb, write_obj, write_ply};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

impl TessellateArgs {
    /// Whether v runs the other way in the file that is written.
    pub(super) fn turns_texcoords(&self, kind: Kind) -> bool {
        self.source.is_gltf() != (kind == Kind::Glb)
    }

    /// Writes a mesh that is there as a whole, without vertices that belong to no face.
    pub(super) fn write_arrays(
        &self,
        file: &Path,
        kind: Kind,
        tessellation: &Tessellation<f32>,
        unused: &[u32],
    ) -> Result<[usize; 3], CliError> {
        let cut = if self.quads { None } else { Some(tessellation.all_triangles()) };
        let (quads, triangles) = match &cut {
            Some(triangles) => (&[][..], triangles.as_slice()),
            None => (tessellation.quads(), tessellation.triangles()),
        };
        let turn = |all: &[[f32; 2]]| all.iter().copied().map(turned).collect::<Vec<_>>();
        let texcoords = tessellation.texcoords().filter(|_| self.turns_texcoords(kind)).map(turn);
        let plan = tessellation.plan();
        let sizes = plan.sizes();
        let owned = sizes.positions as u32;
        let copies: Vec<u32> = (owned..sizes.vertices as u32).map(|copy| plan.position_of(copy)).collect();
        let all = Polygons {
            positions: tessellation.positions(),
            normals: tessellation.normals(),
            texcoords: texcoords.as_deref().or(tessellation.texcoords()),
            copies: (owned, &copies),
            quads,
            triangles,
        };
        let kept = Kept::of(&all, unused);
        write(file, kind, &kept.as_ref().map_or(all, Kept::polygons))
    }
}

/// Writes the file. Gives the numbers of its vertices, quads and triangles.
pub(super) fn write(file: &Path, kind: Kind, mesh: &dyn Pieces) -> Result<[usize; 3], CliError> {
    let to = |part: &Path| -> io::Result<()> {
        let _watch = Watch::start();
        let mut out = BufWriter::with_capacity(1 << 20, Interruptible(File::create(part)?));
        match kind {
            Kind::Obj => write_obj(mesh, &mut out)?,
            Kind::Ply => write_ply(mesh, &mut out)?,
            Kind::Glb => write_glb(mesh, &mut out)?,
        }
        out.flush()
    };
    write_file(file, |part| to(part).map_err(|error| error.to_string()))?;
    let ([vertices, _], [quads, triangles]) = (mesh.vertex_counts(), mesh.face_counts());
    Ok([vertices, quads, triangles])
}

/// A tessellation that is made while it is written.
pub(super) struct Streamed<'s> {
    pub stream: &'s Stream<'s, f32>,
    pub sizes: Sizes,
    /// Whether quads stay quads.
    pub quads: bool,
    /// Whether v runs the other way.
    pub turned: bool,
}

impl Pieces for Streamed<'_> {
    fn vertex_counts(&self) -> [usize; 2] {
        [self.sizes.vertices, self.sizes.positions]
    }

    fn face_counts(&self) -> [usize; 2] {
        let Sizes { quads, triangles, .. } = self.sizes;
        if self.quads { [quads, triangles] } else { [0, 2 * quads + triangles] }
    }

    fn has_texcoords(&self) -> bool {
        self.stream.plan().has_texcoords()
    }

    fn position_of(&self, vertex: u32) -> u32 {
        self.stream.plan().position_of(vertex)
    }

    fn vertices(&self, visit: &mut dyn FnMut(Vertices) -> io::Result<()>) -> io::Result<()> {
        self.stream.for_each_piece(|Piece { positions, normals, texcoords }| {
            let other = texcoords.filter(|_| self.turned);
            let other = other.map(|all| all.iter().copied().map(turned).collect::<Vec<_>>());
            visit(Vertices { positions, normals, texcoords: other.as_deref().or(texcoords) })
        })
    }

    fn quads(&self, visit: &mut dyn FnMut(&[[u32; 4]]) -> io::Result<()>) -> io::Result<()> {
        if self.quads { self.stream.for_each_quads(visit) } else { Ok(()) }
    }

    fn triangles(&self, visit: &mut dyn FnMut(&[[u32; 3]]) -> io::Result<()>) -> io::Result<()> {
        if self.quads { self.stream.for_each_triangles(visit) } else { self.stream.for_each_cut(visit) }
    }
}

fn turned([u, v]: [f32; 2]) -> [f32; 2] {
    [u, 1.0 - v]
}
