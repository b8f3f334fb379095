//! Wavefront OBJ, with the tags OpenSubdiv's regression shapes have.

mod edits;
mod statements;
mod tags;
#[cfg(test)]
mod tests;

use super::error::shortened;
use super::{ControlMesh, FaceVarying, Limits, MeshData, MeshError, Place, RepairOptions, Repairs};
use statements::{ABSENT, NOTHING, face_corner, for_each_statement, number, number_f32, number_or_none};
use std::borrow::Cow;

/// How [`ControlMesh::from_obj_str`] reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ObjOptions {
    /// Take out vertices that belong to no face, and their corner tags, and number the others anew. Otherwise such a
    /// vertex is the error [`MeshError::IsolatedVertex`].
    pub drop_isolated: bool,
}

/// The line of every element that an error may name.
#[derive(Default)]
struct Lines {
    vertices: Vec<usize>,
    faces: Vec<usize>,
    creases: Vec<usize>,
    corners: Vec<usize>,
    edits: Vec<usize>,
    /// With the face, since [`ControlMesh::new`] tells which face is wrong, not which hole.
    holes: Vec<(u32, usize)>,
}

/// The file as far as it has been read.
#[derive(Default)]
struct ObjFile {
    data: MeshData,
    lines: Lines,
    texcoords: FaceVarying<[f32; 2]>,
    normals: FaceVarying<[f32; 3]>,
    /// Whether what [`repair`](super::repair) mends is no error.
    mend: bool,
}

impl ControlMesh {
    /// Reads the text of an OBJ file. Objects, groups, materials and smoothing are passed over: all faces of the file
    /// become one mesh, and polygons stay polygons.
    ///
    /// Understood are `v` (more than three components are ignored), `vt` (one to three; the third is ignored; v is
    /// turned round, for in OBJ it runs up from the bottom of the image), `vn`,
    /// `f` with indices that count from one or back, and the tags `t crease`, `corner`, `hole`,
    /// `interpolateboundary`, `creasemethod`, `smoothtriangles` and `facevaryinginterpolateboundary`, whose vertices
    /// and faces count from zero, and `vertexedit`, `edgeedit` and `faceedit`, which become [`Edit`](super::Edit)s. A crease
    /// may be a chain of more than two vertices. Where only some faces have texture coordinates the others get (0, 0), and
    /// likewise the normal (0, 0, 0).
    ///
    /// The integers of an edit are paths: the number of those that follow, a face, a child a level, and the corner or edge of the last
    /// face (of a `faceedit` none). Its strings are `add P value`, `subtract P value` or `set P value`, with three numbers a path, in
    /// object space; `set P sharpness`, with one number a path; of a `faceedit` just `hole`. Numbers beyond those are passed over.
    ///
    /// Without a tag the rules are those of [`MeshData::default`]; OpenSubdiv's own test programs take
    /// [`EdgeOnly`](super::BoundaryRule::EdgeOnly) for a file without `interpolateboundary`.
    ///
    /// ```
    /// use ash_subdiv::{ControlMesh, mesh::ObjOptions};
    /// let quad = ControlMesh::from_obj_str("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4", &ObjOptions::default())?;
    /// assert_eq!(quad.face(0), [0, 1, 2, 3]);
    /// # Ok::<(), ash_subdiv::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// [`MeshError::Syntax`] for a statement that can't be read, and those of [`ControlMesh::new`] with their line
    /// ([`MeshError::AtLine`]); in these, vertices and faces count from zero as everywhere.
    pub fn from_obj_str(text: &str, options: &ObjOptions) -> Result<Self, MeshError> {
        ObjFile::parse(text.as_bytes(), false, &Limits::NUMBERING)?.into_mesh(options)
    }

    /// As [`ControlMesh::from_obj_str`], from the bytes of a file.
    ///
    /// The text may be UTF-8, UTF-16 with a byte order mark, or in any other encoding that writes statements and numbers as ASCII
    /// does: names and comments are passed over.
    ///
    /// # Errors
    /// As [`ControlMesh::from_obj_str`].
    pub fn from_obj_bytes(bytes: &[u8], options: &ObjOptions) -> Result<Self, MeshError> {
        read(bytes, options, &Limits::NUMBERING)
    }

    /// As [`ControlMesh::from_obj_bytes`], with what is odd about the file mended: see [`repair`](super::repair). Repairs know
    /// their line. Numbers that are none are accepted where nothing needs them.
    ///
    /// # Errors
    /// As [`ControlMesh::from_obj_str`], for what can't be mended.
    pub fn from_obj_bytes_repaired(bytes: &[u8], options: &RepairOptions) -> Result<(Self, Repairs), MeshError> {
        read_repaired(bytes, options, &Limits::NUMBERING)
    }
}

/// A mesh within limits.
pub(super) fn read(bytes: &[u8], options: &ObjOptions, limits: &Limits) -> Result<ControlMesh, MeshError> {
    ObjFile::parse(&decoded(bytes), false, limits)?.into_mesh(options)
}

/// A mesh within limits, mended.
pub(super) fn read_repaired(
    bytes: &[u8],
    options: &RepairOptions,
    limits: &Limits,
) -> Result<(ControlMesh, Repairs), MeshError> {
    ObjFile::parse(&decoded(bytes), true, limits)?.into_repaired(options)
}

/// UTF-16 as UTF-8; the rest as it is.
fn decoded(bytes: &[u8]) -> Cow<'_, [u8]> {
    let utf_16 = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
        String::from_utf16_lossy(&units).into_bytes().into()
    };
    match bytes {
        [0xff, 0xfe, rest @ ..] => utf_16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => utf_16(rest, u16::from_be_bytes),
        _ => bytes.into(),
    }
}

impl ObjFile {
    fn parse(text: &[u8], mend: bool, limits: &Limits) -> Result<Self, MeshError> {
        let mut file = Self { mend, ..Self::default() };
        for_each_statement(text, |line, statement| {
            file.read(line, statement).map_err(|message| MeshError::Syntax { line, message: shortened(message) })?;
            file.check(limits)
        })?;
        Ok(file)
    }

    fn check(&self, limits: &Limits) -> Result<(), MeshError> {
        let MeshData { positions, face_sizes, face_vertices, .. } = &self.data;
        limits.check_vertices(positions.len() as u64)?;
        limits.check_faces(face_sizes.len() as u64)?;
        limits.check_corners("face corners", face_vertices.len() as u64)
    }

    fn read(&mut self, line: usize, statement: &str) -> Result<(), String> {
        let mut words = statement.split_ascii_whitespace();
        match words.next() {
            Some("f") => return self.read_face(line, words),
            Some("v") => {
                let number = if self.mend { number_or_none } else { number };
                self.data.positions.push(components(words, "v", number)?);
                self.lines.vertices.push(line);
            }
            Some("vt") => {
                let texcoord = texcoord(words);
                self.texcoords.values.push(if self.mend { texcoord.unwrap_or([f32::NAN; 2]) } else { texcoord? });
            }
            Some("vn") => {
                let normal = components(words, "vn", number_f32);
                self.normals.values.push(if self.mend { normal.unwrap_or([f32::NAN; 3]) } else { normal? });
            }
            Some("t") => return tags::read(words, line, &mut self.data, &mut self.lines),
            _ => {}
        }
        Ok(())
    }

    fn read_face<'a>(&mut self, line: usize, words: impl Iterator<Item = &'a str>) -> Result<(), String> {
        let counts = [self.data.positions.len(), self.texcoords.values.len(), self.normals.values.len()];
        let first = self.data.face_vertices.len();
        for word in words {
            let [vertex, texcoord, normal] = face_corner(word, counts, self.mend)?;
            self.data.face_vertices.push(vertex);
            self.texcoords.indices.push(texcoord);
            self.normals.indices.push(normal);
        }
        for (what, indices) in [("texture coordinate", &self.texcoords.indices), ("normal", &self.normals.indices)] {
            if !self.mend && indices[first..].windows(2).any(|pair| (pair[0] == ABSENT) != (pair[1] == ABSENT)) {
                return Err(format!(
                    "some corners of the face have a {what} and some have none: give it to all or none"
                ));
            }
        }
        self.data.face_sizes.push((self.data.face_vertices.len() - first) as u32);
        self.lines.faces.push(line);
        Ok(())
    }

    fn into_mesh(self, options: &ObjOptions) -> Result<ControlMesh, MeshError> {
        self.check_indices()?;
        let Self { mut data, mut lines, texcoords, normals, .. } = self;
        data.texcoords = completed(texcoords, [0.0; 2]);
        data.normals = completed(normals, [0.0; 3]);
        // Without faces all vertices would go, and the error would be the wrong one.
        let droppable = !data.positions.is_empty() && !data.face_sizes.is_empty();
        let kept = (options.drop_isolated && droppable).then(|| drop_isolated(&mut data, &mut lines)).transpose()?;
        ControlMesh::new(data).map_err(|mut error| {
            if let Some(kept) = kept {
                error.renumber(|vertex| kept[vertex as usize], |face| face);
            }
            lines.locate(error)
        })
    }

    fn into_repaired(mut self, options: &RepairOptions) -> Result<(ControlMesh, Repairs), MeshError> {
        self.check_indices()?;
        complete(&mut self.texcoords, &self.data.face_sizes, [0.0; 2]);
        complete(&mut self.normals, &self.data.face_sizes, [0.0; 3]);
        let Self { mut data, lines, texcoords, normals, .. } = self;
        let given = |indices: &[u32]| indices.iter().any(|&index| index != ABSENT);
        data.texcoords = Some(texcoords).filter(|texcoords| given(&texcoords.indices));
        data.normals = Some(normals).filter(|normals| given(&normals.indices));
        let (mesh, mut repairs) = ControlMesh::repaired(data, options).map_err(|error| lines.locate(error))?;
        repairs.list.iter_mut().for_each(|repair| repair.line = lines.of(repair.first));
        Ok((mesh, repairs))
    }

    /// Indices may point forward in the file, so they can be checked only when all of it is read.
    fn check_indices(&self) -> Result<(), MeshError> {
        let [vertices, texcoords, normals] =
            [self.data.positions.len(), self.texcoords.values.len(), self.normals.values.len()];
        let mut corner = 0;
        for (face, &size) in self.data.face_sizes.iter().enumerate() {
            for corner in corner..corner + size as usize {
                let at_line = |error| MeshError::AtLine { line: self.lines.faces[face], error: Box::new(error) };
                let vertex = self.data.face_vertices[corner];
                if vertex as usize >= vertices && vertices > 0 {
                    let face = face as u32;
                    return Err(at_line(MeshError::IndexOutOfRange { face, vertex, count: vertices }));
                }
                for (what, index, count) in [
                    ("texture coordinate", self.texcoords.indices[corner], texcoords),
                    ("normal", self.normals.indices[corner], normals),
                ] {
                    if !self.mend && index != ABSENT && index as usize >= count {
                        return Err(at_line(MeshError::CornerIndex { what, corner, index, count }));
                    }
                }
            }
            corner += size as usize;
        }
        Ok(())
    }
}

fn components<'a, T: Copy + Default, const N: usize>(
    mut words: impl Iterator<Item = &'a str>,
    statement: &str,
    number: impl Fn(&str) -> Result<T, String>,
) -> Result<[T; N], String> {
    let mut components = [T::default(); N];
    for (i, component) in components.iter_mut().enumerate() {
        let word = words.next().ok_or_else(|| format!("\"{statement}\" needs {N} numbers, but has {i}"))?;
        *component = number(word)?;
    }
    Ok(components)
}

/// One number or more; the first two count. In OBJ v runs up from the bottom of the image, here down from its top.
fn texcoord<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<[f32; 2], String> {
    let u = number_f32(words.next().ok_or("\"vt\" needs one number or more, but has none")?)?;
    let v = words.next().map_or(Ok(0.0), |word| number_f32(word).and_then(|_| number(word)))?;
    Ok([u, from_top(v) as f32])
}

/// Puts a texture coordinate's v from the bottom of the image to its top, and back. In double precision, so that v comes back as
/// it was.
pub(crate) fn from_top(v: f64) -> f64 {
    1.0 - v
}

/// Gives the corners of faces that have no values at all the value `fill`, if other faces have some.
fn complete<T>(attribute: &mut FaceVarying<T>, face_sizes: &[u32], fill: T) {
    let fill_index = attribute.values.len() as u32;
    if attribute.indices.iter().all(|&index| index == ABSENT) {
        return;
    }
    let is_wrong = |index: u32| index >= fill_index && index != ABSENT;
    attribute.indices.iter_mut().filter(|index| is_wrong(**index)).for_each(|index| *index = NOTHING);
    let (mut rest, mut filled) = (attribute.indices.as_mut_slice(), false);
    for &size in face_sizes {
        let (face, tail) = rest.split_at_mut(size as usize);
        if face.iter().all(|&index| index == ABSENT) {
            filled |= !face.is_empty();
            face.fill(fill_index);
        }
        rest = tail;
    }
    if filled {
        attribute.values.push(fill);
    }
}

/// Gives corners that have no value the value `fill`; none at all if no corner has one.
fn completed<T>(mut attribute: FaceVarying<T>, fill: T) -> Option<FaceVarying<T>> {
    if attribute.indices.iter().all(|&index| index == ABSENT) {
        return None;
    }
    if attribute.indices.contains(&ABSENT) {
        let index = attribute.values.len() as u32;
        attribute.values.push(fill);
        attribute.indices.iter_mut().filter(|index| **index == ABSENT).for_each(|absent| *absent = index);
    }
    Some(attribute)
}

/// Takes out vertices without a face. Gives the number in the file of every vertex kept; lines stay those of the file's numbers.
fn drop_isolated(data: &mut MeshData, lines: &mut Lines) -> Result<Vec<u32>, MeshError> {
    let mut numbers = vec![ABSENT; data.positions.len()];
    data.face_vertices.iter().for_each(|&vertex| numbers[vertex as usize] = 0);
    let mut kept = Vec::with_capacity(numbers.len());
    for (vertex, number) in numbers.iter_mut().enumerate().filter(|(_, number)| **number != ABSENT) {
        *number = kept.len() as u32;
        kept.push(vertex as u32);
    }
    data.positions = kept.iter().map(|&vertex| data.positions[vertex as usize]).collect();
    data.face_vertices.iter_mut().for_each(|vertex| *vertex = numbers[*vertex as usize]);

    for (crease, tag) in data.creases.iter_mut().enumerate() {
        let edge = tag.vertices;
        tag.vertices = edge.map(|vertex| numbers.get(vertex as usize).copied().unwrap_or(ABSENT));
        if tag.vertices.contains(&ABSENT) {
            return Err(lines.locate(MeshError::NoSuchEdge { crease, edge }));
        }
    }
    let corners = std::mem::take(&mut data.corners).into_iter().zip(std::mem::take(&mut lines.corners));
    for (corner, (mut tag, line)) in corners.enumerate() {
        match numbers.get(tag.vertex as usize) {
            Some(&ABSENT) => {}
            Some(&number) => {
                tag.vertex = number;
                data.corners.push(tag);
                lines.corners.push(line);
            }
            None => {
                let error = MeshError::NoSuchVertex { corner, vertex: tag.vertex, count: numbers.len() };
                return Err(MeshError::AtLine { line, error: Box::new(error) });
            }
        }
    }
    Ok(kept)
}

impl Lines {
    /// The line of something.
    fn of(&self, place: Place) -> Option<usize> {
        match place {
            Place::Vertex(vertex) => self.vertices.get(vertex as usize).copied(),
            Place::Face(face) | Place::Edge { face, .. } => self.faces.get(face as usize).copied(),
            Place::Crease(crease) => self.creases.get(crease).copied(),
            Place::Corner(corner) => self.corners.get(corner).copied(),
            Place::Hole(face) => self.holes.iter().find(|hole| hole.0 == face).map(|hole| hole.1),
        }
    }

    /// Adds the line of the element that `error` is about.
    fn locate(&self, error: MeshError) -> MeshError {
        let line = match &error {
            MeshError::IsolatedVertex { vertex } | MeshError::NotFinite { vertex, .. } => {
                Some(self.vertices[*vertex as usize])
            }
            MeshError::NoSuchEdge { crease, .. } => Some(self.creases[*crease]),
            MeshError::NoSuchVertex { corner, .. } => Some(self.corners[*corner]),
            MeshError::NoSuchFace { face, .. } => self.holes.iter().find(|hole| hole.0 == *face).map(|hole| hole.1),
            MeshError::BadEdit { edit, .. } => Some(self.edits[*edit]),
            MeshError::BadSharpness { what: "crease", index, .. } => Some(self.creases[*index]),
            MeshError::BadSharpness { index, .. } => Some(self.corners[*index]),
            error => error.face().map(|face| self.faces[face as usize]),
        };
        match line {
            Some(line) => MeshError::AtLine { line, error: Box::new(error) },
            None => error,
        }
    }
}
