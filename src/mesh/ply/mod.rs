//! PLY, as text or binary.

mod body;
mod header;
#[cfg(test)]
mod tests;

use super::error::shortened;
use super::obj::from_top;
use super::repair::weld;
use super::{ControlMesh, FaceVarying, Limits, MeshData, MeshError, RepairOptions, Repairs};
use body::{Body, Row};
use header::{Element, Header, Property};
use std::collections::HashMap;

/// Names of a face's list of vertices.
const VERTICES: [&str; 2] = ["vertex_indices", "vertex_index"];
/// Names of texture coordinates, whose v runs up from the bottom of the image.
const TEXCOORDS: [[&str; 2]; 4] = [["s", "t"], ["u", "v"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];

impl ControlMesh {
    /// Reads a PLY file: text, or binary of either byte order. Read are the positions of the element `vertex`, its texture coordinates
    /// (`s t`, `u v`) and normals (`nx ny nz`) if there are any, and the vertices of the element `face`. Where there are such, edges
    /// that lie on one another are joined as in glTF, for the file had to split their vertices.
    ///
    /// # Errors
    /// [`MeshError::Format`] for a file that is broken, and those of [`ControlMesh::new`].
    pub fn from_ply_bytes(bytes: &[u8]) -> Result<Self, MeshError> {
        Self::new(read(bytes, &Limits::NUMBERING)?)
    }

    /// As [`ControlMesh::from_ply_bytes`], with what is odd about the file mended: see [`repair`](super::repair()).
    ///
    /// # Errors
    /// As [`ControlMesh::from_ply_bytes`], for what can't be mended.
    pub fn from_ply_bytes_repaired(bytes: &[u8], options: &RepairOptions) -> Result<(Self, Repairs), MeshError> {
        Self::repaired(read(bytes, &Limits::NUMBERING)?, options)
    }
}

fn format_error(message: impl Into<String>) -> MeshError {
    MeshError::Format { message: shortened(message.into()) }
}

/// Parts of the mesh in a file, unchecked.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<MeshData, MeshError> {
    let (header, rest) = header::read(bytes)?;
    let announced = |name: &str| {
        let counts = header.elements.iter().filter(|element| element.name == name).map(|element| element.count);
        counts.fold(0, u64::saturating_add)
    };
    limits.check_vertices(announced("vertex"))?;
    limits.check_faces(announced("face"))?;
    let mut body = Body::new(header.encoding, rest);
    let mut data = MeshData::default();
    let mut texcoords = Vec::new();
    let mut normals = Vec::new();
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => read_vertices(element, &mut body, &mut data, &mut texcoords, &mut normals)?,
            "face" => read_faces(element, &mut body, &mut data, limits)?,
            _ => body.for_each_row(element, |_| Ok(()))?,
        }
    }
    check_element(&header, "vertex")?;
    check_element(&header, "face")?;
    let is_split = !texcoords.is_empty() || !normals.is_empty();
    let given = data.face_vertices.clone();
    data.texcoords = some(texcoords, &given);
    data.normals = some(normals, &given);
    if is_split && super::repair::is_sound(&data) && !data.face_sizes.contains(&0) {
        weld_split(&mut data);
    }
    Ok(data)
}

/// Values of vertices, by face corner.
fn some<T>(values: Vec<T>, indices: &[u32]) -> Option<FaceVarying<T>> {
    (!values.is_empty()).then(|| FaceVarying { values, indices: indices.to_vec() })
}

/// Joins edges that the file split for what differs from face to face.
fn weld_split(data: &mut MeshData) {
    let mut first: HashMap<[u64; 3], u32> = HashMap::new();
    let places: Vec<u32> = (0..)
        .zip(&data.positions)
        // Adding zero makes -0 and 0 the same.
        .map(|(vertex, position)| *first.entry(position.map(|x| (x + 0.0).to_bits())).or_insert(vertex))
        .collect();
    weld::join(data, &places);
}

fn check_element(header: &Header, name: &str) -> Result<(), MeshError> {
    match header.elements.iter().any(|element| element.name == name) {
        true => Ok(()),
        false => Err(format_error(format!("the file has no element \"{name}\": points alone have no surface"))),
    }
}

fn read_vertices(
    element: &Element,
    body: &mut Body,
    data: &mut MeshData,
    texcoords: &mut Vec<[f32; 2]>,
    normals: &mut Vec<[f32; 3]>,
) -> Result<(), MeshError> {
    let places = |names: &[&str]| names.iter().map(|name| element.place_of(name)).collect::<Option<Vec<usize>>>();
    let positions = places(&["x", "y", "z"])
        .ok_or_else(|| format_error("the element \"vertex\" has no x, y and z: write positions with these names"))?;
    let of_texcoords = TEXCOORDS.iter().find_map(|names| places(names));
    let of_normals = places(&["nx", "ny", "nz"]);
    body.for_each_row(element, |row| {
        data.positions.push(std::array::from_fn(|axis| row.numbers[positions[axis]]));
        if let Some(at) = &of_texcoords {
            texcoords.push([row.numbers[at[0]] as f32, from_top(row.numbers[at[1]]) as f32]);
        }
        if let Some(at) = &of_normals {
            normals.push(std::array::from_fn(|axis| row.numbers[at[axis]] as f32));
        }
        Ok(())
    })
}

fn read_faces(element: &Element, body: &mut Body, data: &mut MeshData, limits: &Limits) -> Result<(), MeshError> {
    let is_list = |property: &&Property| property.length.is_some() && VERTICES.contains(&property.name.as_str());
    let list = element.properties.iter().filter(|property| property.length.is_some()).position(|p| is_list(&p));
    let list =
        list.ok_or_else(|| format_error("the element \"face\" has no list \"vertex_indices\": write it again"))?;
    let mut face = 0;
    body.for_each_row(element, |row: &Row| {
        let vertices = row.list(list);
        limits.check_corners("face corners", (data.face_vertices.len() + vertices.len()) as u64)?;
        for &vertex in vertices {
            if !(0.0..f64::from(u32::MAX)).contains(&vertex) || vertex.fract() != 0.0 {
                return Err(format_error(format!("face {face} names vertex {vertex}: vertices count from 0")));
            }
            data.face_vertices.push(vertex as u32);
        }
        data.face_sizes.push(vertices.len() as u32);
        face += 1;
        Ok(())
    })
}
