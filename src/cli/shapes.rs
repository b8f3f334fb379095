//! `subdiv shapes`: the built-in meshes.

use super::described::{described, help};
use super::error::CliError;
use super::output::{self, Table, write_file};
use ash_subdiv::mesh::write::control::write_obj;
use ash_subdiv::{shape, shapes};
use clap::Args;
use serde::Serialize;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
#[command(
    after_help = help::<Vec<ShapeOut>>("", EXAMPLES)
)]
pub(super) struct ShapesArgs {
    /// Only this shape.
    name: Option<String>,
    /// Write it to a file, as OBJ with OpenSubdiv's tags.
    #[arg(long, value_name = "FILE", requires = "name")]
    obj: Option<PathBuf>,
}

const EXAMPLES: &str = "\
; with --obj {shape, file}.

Examples:
  subdiv shapes
  subdiv shapes torus
  subdiv shapes machine-part --obj machine-part.obj";

described! {
    #[derive(Serialize)]
    struct ShapeOut {
        name: &'static str,
        summary: &'static str,
        vertices: usize,
        faces: usize,
    }
}

described! {
    #[derive(Serialize)]
    struct WrittenOut<'a> {
        shape: &'a str,
        file: String,
    }
}

pub(super) fn run(args: &ShapesArgs, json: bool) -> Result<(), CliError> {
    if let (Some(name), Some(path)) = (&args.name, &args.obj) {
        let mesh = shape(name)?;
        let write = |part: &Path| -> io::Result<()> {
            let mut out = BufWriter::new(std::fs::File::create(part)?);
            write_obj(&mesh, &mut out)?;
            out.flush()
        };
        write_file(path, |part| write(part).map_err(|error| error.to_string()))?;
        let file = path.display().to_string();
        return match json {
            true => output::json_pretty(&WrittenOut { shape: name, file }),
            false => output::with_stdout(|out| Ok(writeln!(out, "{file}: {} faces", mesh.face_count())?)),
        };
    }
    let mut all = Vec::new();
    // What is asked for and is none is told here.
    args.name.as_deref().map_or(Ok(()), |name| shape(name).map(drop))?;
    for info in shapes().iter().filter(|info| args.name.as_deref().is_none_or(|name| info.name == name)) {
        let mesh = shape(info.name)?;
        let (vertices, faces) = (mesh.vertex_count(), mesh.face_count());
        all.push(ShapeOut { name: info.name, summary: info.summary, vertices, faces });
    }
    if json {
        return output::json_pretty(&all);
    }
    let mut table = Table::new(&[1]);
    all.iter().for_each(|s| table.row([&s.name, &format!("{} faces", s.faces), &s.summary]));
    table.print()
}
