use super::{Animations, ControlMesh, Limits, MeshError, ObjOptions, RepairOptions, Repairs, obj, ply};
use std::io::Read as _;
use std::path::Path;

/// How [`read`] reads a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ReadOptions {
    /// Take out vertices that belong to no face (OBJ; meshes from glTF never have any).
    pub drop_isolated: bool,
    /// Which mesh of a glTF scene, by the name of the mesh or of its node; all as one mesh if `None`.
    pub mesh: Option<String>,
    /// Put quads of glTF together that were split into triangles: `GltfOptions::quads`.
    pub quads: bool,
    /// The most that is read.
    pub limits: Limits,
}

/// Reads a control mesh from a file whose name ends in `.obj`, `.ply`, `.gltf` or `.glb` (in any case).
///
/// # Errors
/// [`MeshError::Unreadable`] where there is no such file or its ending is unknown; otherwise what the reader says,
/// with the path ([`MeshError::InFile`]).
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<ControlMesh, MeshError> {
    read_any(path.as_ref(), options, None, false).map(|read| read.mesh)
}

/// As [`read`], with what is odd about the file mended: see [`repair`](super::repair()).
///
/// # Errors
/// As [`read`], for what can't be mended.
pub fn read_repaired(
    path: impl AsRef<Path>,
    options: &ReadOptions,
    repair: &RepairOptions,
) -> Result<(ControlMesh, Repairs), MeshError> {
    read_any(path.as_ref(), options, Some(repair), false).map(|read| (read.mesh, read.repairs))
}

/// A mesh with what moves it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Animated {
    /// The control mesh, as nothing moves it.
    pub mesh: ControlMesh,
    /// What was mended.
    pub repairs: Repairs,
    /// Empty where nothing moves.
    pub animations: Animations,
}

/// As [`read`], or [`read_repaired`] with `repair`, with the animations of the file. Only glTF has any.
///
/// # Errors
/// As [`read`], and where skins, morph targets or animations are broken.
pub fn read_animated(
    path: impl AsRef<Path>,
    options: &ReadOptions,
    repair: Option<&RepairOptions>,
) -> Result<Animated, MeshError> {
    read_any(path.as_ref(), options, repair, true)
}

type Read = Result<Animated, MeshError>;

/// A mesh that nothing moves.
impl From<(ControlMesh, Repairs)> for Animated {
    fn from((mesh, repairs): (ControlMesh, Repairs)) -> Self {
        Self { mesh, repairs, animations: Animations::default() }
    }
}

/// Reads a file, `moving` with its animations; without `repair` nothing is mended, but quads may be put together.
fn read_any(path: &Path, options: &ReadOptions, repair: Option<&RepairOptions>, moving: bool) -> Read {
    let unreadable = |message: String| MeshError::Unreadable { path: path.to_owned(), message };
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    let reader = match ending.as_deref() {
        Some("obj") => read_obj,
        Some("ply") => read_ply,
        Some("gltf" | "glb") => read_gltf,
        Some(other) => {
            return Err(unreadable(format!("files ending in .{other} can't be read: use .obj, .ply, .gltf or .glb")));
        }
        None => return Err(unreadable("the name has no ending: it must be .obj, .ply, .gltf or .glb".into())),
    };
    if path.is_dir() {
        return Err(unreadable("this is a directory: name a file in it".into()));
    }
    let in_file = |error| MeshError::InFile { path: path.to_owned(), error: Box::new(error) };
    let bytes = bytes_of(path, 0, &options.limits).map_err(|error| match error {
        Unread::Io(error) if error.kind() == std::io::ErrorKind::NotFound => unreadable("there is no such file".into()),
        Unread::Io(error) => unreadable(error.to_string()),
        Unread::Mesh(error) => in_file(error),
    })?;
    reader(path, &bytes, options, repair, moving).map_err(in_file)
}

/// Why the bytes of a file were not read.
pub(super) enum Unread {
    Io(std::io::Error),
    Mesh(MeshError),
}

/// The bytes of a file, if they are no more than the limit with those read `before`. Its length is asked first, but not relied on: devices and pipes have none.
pub(super) fn bytes_of(path: &Path, before: u64, limits: &Limits) -> Result<Vec<u8>, Unread> {
    let file = std::fs::File::open(path).map_err(Unread::Io)?;
    let length = file.metadata().map_err(Unread::Io)?.len();
    limits.check_bytes(before.saturating_add(length)).map_err(Unread::Mesh)?;
    let mut bytes = Vec::with_capacity(length as usize);
    file.take(limits.bytes.saturating_sub(before).saturating_add(1)).read_to_end(&mut bytes).map_err(Unread::Io)?;
    limits.check_bytes(before.saturating_add(bytes.len() as u64)).map_err(Unread::Mesh)?;
    Ok(bytes)
}

fn read_obj(_: &Path, bytes: &[u8], options: &ReadOptions, repair: Option<&RepairOptions>, _: bool) -> Read {
    whole(options, "an OBJ file")?;
    Ok(Animated::from(match repair {
        Some(repair) => obj::read_repaired(bytes, repair, &options.limits)?,
        None => {
            let obj_options = ObjOptions { drop_isolated: options.drop_isolated };
            (obj::read(bytes, &obj_options, &options.limits)?, Repairs::default())
        }
    }))
}

fn read_ply(_: &Path, bytes: &[u8], options: &ReadOptions, repair: Option<&RepairOptions>, _: bool) -> Read {
    whole(options, "a PLY file")?;
    let data = ply::read(bytes, &options.limits)?;
    Ok(Animated::from(match repair {
        Some(repair) => ControlMesh::repaired(data, repair)?,
        None => (ControlMesh::new(data)?, Repairs::default()),
    }))
}

/// No mesh of several is asked for.
fn whole(options: &ReadOptions, file: &str) -> Result<(), MeshError> {
    let Some(mesh) = &options.mesh else { return Ok(()) };
    Err(MeshError::Format {
        message: format!("\"{mesh}\" can't be chosen: {file} is read as one mesh; leave the name out"),
    })
}

#[cfg(feature = "gltf")]
fn read_gltf(path: &Path, bytes: &[u8], options: &ReadOptions, repair: Option<&RepairOptions>, moving: bool) -> Read {
    let folder = path.parent().map(Path::to_owned);
    let ReadOptions { mesh, quads, limits, .. } = options.clone();
    let options = super::GltfOptions { mesh, folder, quads, limits };
    if moving {
        return ControlMesh::from_gltf_bytes_animated(bytes, &options, repair);
    }
    Ok(Animated::from(match repair {
        Some(repair) => ControlMesh::from_gltf_bytes_repaired(bytes, &options, repair)?,
        None => {
            let (data, rebuilt_quads) = super::gltf::read(bytes, &options)?;
            (ControlMesh::new(data)?, Repairs { rebuilt_quads, ..Repairs::default() })
        }
    }))
}

#[cfg(not(feature = "gltf"))]
fn read_gltf(_: &Path, _: &[u8], _: &ReadOptions, _: Option<&RepairOptions>, _: bool) -> Read {
    Err(MeshError::Format { message: "this build can't read glTF: turn on the cargo feature \"gltf\"".into() })
}
