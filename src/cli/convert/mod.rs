//! `subdiv convert`: a control mesh from one file to another.

use super::described::{described, help};
use super::error::CliError;
use super::output::{self, Progress, write_file};
use super::source::{ReadingArgs, report_repairs};
use ash_subdiv::mesh::MeshData;
use ash_subdiv::mesh::write::control::{write_glb, write_obj, write_ply};
use clap::Args;
use serde::Serialize;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
#[command(after_help = help::<ConvertOut>("", EXAMPLES))]
pub(super) struct ConvertArgs {
    /// The control mesh: a file ending in .obj, .ply, .gltf or .glb.
    mesh: PathBuf,
    /// What is written: a file ending in .obj (with tags), .glb (polygons as FB_ngon_encoding) or .ply. Missing folders are made.
    output: PathBuf,
    #[command(flatten)]
    reading: ReadingArgs,
    /// Mesh of a glTF scene, by its name or its node's; all of them if not given.
    #[arg(long, value_name = "NAME")]
    mesh_name: Option<String>,
}

const EXAMPLES: &str = "\
.

Examples:
  subdiv convert model.obj model.glb
  subdiv convert --weld 1e-6 scan.ply scan.obj";

described! {
    #[derive(Serialize)]
    struct ConvertOut {
        file: String,
        vertices: usize = "of the control mesh",
        faces: usize,
        /// Kinds of tags that the format has no place for.
        lost: Vec<&'static str> = "kinds of tags",
    }
}

/// A format of control meshes.
#[derive(Clone, Copy, PartialEq)]
enum Format {
    Obj,
    Glb,
    Ply,
}

pub(super) fn run(args: &ConvertArgs, json: bool) -> Result<(), CliError> {
    let format = args.format()?;
    let progress = Progress::new("reading the mesh");
    let (mesh, repairs) = args.reading.read(&args.mesh, args.mesh_name.clone())?;
    report_repairs(&repairs, &progress);
    progress.now("writing the mesh");
    let write = |part: &Path| -> io::Result<()> {
        let mut out = BufWriter::new(File::create(part)?);
        match format {
            Format::Obj => write_obj(&mesh, &mut out)?,
            Format::Glb => write_glb(&mesh, &mut out)?,
            Format::Ply => write_ply(&mesh, &mut out)?,
        }
        out.flush()
    };
    write_file(&args.output, |part| write(part).map_err(|error| error.to_string()))?;
    let lost = lost(mesh.data(), format);
    if !lost.is_empty() {
        progress.note(format_args!("{} are left out: they have no place in the file", lost.join(", ")));
    }
    drop(progress);
    let out = ConvertOut {
        file: args.output.display().to_string(),
        vertices: mesh.vertex_count(),
        faces: mesh.face_count(),
        lost,
    };
    if json {
        return output::json_pretty(&out);
    }
    let ConvertOut { file, vertices, faces, .. } = out;
    output::with_stdout(|stdout| Ok(writeln!(stdout, "{file}: {vertices} vertices, {faces} faces")?))
}

impl ConvertArgs {
    fn format(&self) -> Result<Format, CliError> {
        let ending = self.output.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("obj") => Ok(Format::Obj),
            Some("glb") => Ok(Format::Glb),
            Some("ply") => Ok(Format::Ply),
            _ => {
                let file = self.output.display();
                Err(CliError::Usage(format!(
                    "{file}: control meshes are written to files ending in .obj, .glb or .ply"
                )))
            }
        }
    }
}

/// Kinds of tags that a mesh has and the file has not.
fn lost(data: &MeshData, format: Format) -> Vec<&'static str> {
    let MeshData { creases, corners, holes, edits, .. } = data;
    let has_no_tags = format != Format::Obj;
    let rules = MeshData::default();
    let has_rules = (data.boundary, data.crease_method, data.triangle_rule, data.face_varying_rule)
        != (rules.boundary, rules.crease_method, rules.triangle_rule, rules.face_varying_rule);
    let kinds = [
        (has_no_tags && !creases.is_empty(), "creases"),
        (has_no_tags && !corners.is_empty(), "corners"),
        (has_no_tags && !holes.is_empty(), "holes"),
        (has_no_tags && has_rules, "rules of subdivision"),
        (!edits.is_empty(), "edits"),
    ];
    kinds.into_iter().filter_map(|(has, kind)| has.then_some(kind)).collect()
}

#[cfg(test)]
mod tests;
