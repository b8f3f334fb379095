//! The exact limit surfaces of `tests/limit` and `../shared/limit`: the format is in `tests/limit/README.md`.

use super::{files, shared, tests};
use ash_subdiv::mesh::{BoundaryRule, ReadOptions, read};
use ash_subdiv::table::FaceOrigin;
use ash_subdiv::{ControlMesh, MeshData};
use glam::DVec3;
use std::path::Path;

/// The limit surface of a mesh.
pub struct Limit {
    pub boundary: BoundaryRule,
    /// Samples along a side of a record.
    pub side: usize,
    pub records: Vec<Record>,
    pub vertices: Vec<VertexLimit>,
}

/// A quad, or the part of another face around its corner `sub`.
pub struct Record {
    pub face: u32,
    /// -1 for a whole quad.
    pub sub: i32,
    pub regular: bool,
    /// Number `j * side + i` at u = i / (side - 1), v = j / (side - 1).
    pub samples: Vec<LimitSample>,
}

#[derive(Clone, Copy)]
pub struct LimitSample {
    pub position: DVec3,
    pub du: DVec3,
    pub dv: DVec3,
}

pub struct VertexLimit {
    /// Whether limit point and normal exist and agree among the faces around the vertex.
    pub valid: bool,
}

/// The part of the limit surface where a patch has a point, and (u, v) there: the patch is a quad, or the triangle between an edge of
/// another face and its centre, which is half of the parts around both ends of the edge.
pub fn on_limit(mesh: &ControlMesh, origin: &FaceOrigin, [u, v]: [f64; 2]) -> (i32, [f64; 2]) {
    let Some(corner) = origin.corner else { return (-1, [u, v]) };
    let next = (corner + 1) % mesh.face(origin.face).len() as u32;
    // By the middle of the edge: as much of it as the nearer end has of the other.
    let (centre, middle) = (1.0 - u - v, 2.0 * u.min(v));
    if u >= v { (corner as i32, [middle + centre, centre]) } else { (next as i32, [centre, middle + centre]) }
}

impl LimitSample {
    /// Of length one, or zero where the derivatives are parallel.
    pub fn normal(&self) -> DVec3 {
        self.du.cross(self.dv).normalize_or_zero()
    }
}

impl Record {
    /// The sample at corner `k` of a quad's record; a part of a face has that of its own corner only.
    pub fn at_corner(&self, side: usize, k: usize) -> LimitSample {
        let last = side - 1;
        self.samples[[0, last, side * last + last, side * last][k]]
    }
}

impl Limit {
    /// The sample at corner `k` of a face.
    pub fn at_corner(&self, face: u32, k: usize) -> Option<LimitSample> {
        let mut records = self.records.iter().filter(|r| r.face == face);
        records.find_map(|record| match record.sub {
            -1 => Some(record.at_corner(self.side, k)),
            sub if sub as usize == k => Some(record.at_corner(self.side, 0)),
            _ => None,
        })
    }
}

/// The names of all limit surfaces: those of `tests/limit`, and of `../shared` where that is.
pub fn names() -> Vec<String> {
    let mut paths = files(&tests("limit"), "bin");
    assert!(paths.len() >= 5, "tests/limit");
    if cfg!(shared) {
        let theirs = files(&shared().join("limit"), "bin");
        assert_eq!(theirs.len(), 38, "../shared/limit");
        paths.extend(theirs);
    }
    paths.iter().map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect()
}

/// A mesh, with the boundary rule its limit surface was made with, and that surface.
pub fn mesh_and_limit(name: &str) -> (ControlMesh, Limit) {
    let ours = tests("limit").join(name).with_extension("bin");
    let (limit, path) = match ours.exists() {
        true => (ours.clone(), ours.with_extension("obj")),
        false => (
            shared().join("limit").join(name).with_extension("bin"),
            shared().join("meshes").join(name).with_extension("obj"),
        ),
    };
    let limit = parsed(&limit);
    let options = ReadOptions { drop_isolated: true, ..ReadOptions::default() };
    let mesh = read(&path, &options).expect("a mesh");
    let mesh = ControlMesh::new(MeshData { boundary: limit.boundary, ..mesh.into_data() }).expect("the same mesh");
    (mesh, limit)
}

/// A limit surface of `../shared`.
pub fn limit(name: &str) -> Limit {
    parsed(&shared().join("limit").join(name).with_extension("bin"))
}

fn parsed(path: &Path) -> Limit {
    parse(&std::fs::read(path).expect("a .bin file"))
}

struct Bytes<'b>(&'b [u8]);

impl Bytes<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (head, tail) = self.0.split_first_chunk().expect("a longer file");
        self.0 = tail;
        *head
    }

    fn i32(&mut self) -> i32 {
        i32::from_le_bytes(self.take())
    }

    fn f64(&mut self) -> f64 {
        f64::from_le_bytes(self.take())
    }

    fn point(&mut self) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.f64()))
    }
}

fn parse(bytes: &[u8]) -> Limit {
    let mut bytes = Bytes(bytes);
    assert_eq!(&bytes.take(), b"OSDLIM01");
    let header = [(); 14].map(|()| bytes.i32());
    let [mode, boundary, vertices, _faces, records, side, _, _, flags, ..] = header;
    assert_eq!((mode, flags & 1), (0, 1), "records hold P, Du and Dv");
    let samples = (side * side) as usize;
    let record = |bytes: &mut Bytes| {
        let [face, sub, _size, regular] = [(); 4].map(|()| bytes.i32());
        let sample = |bytes: &mut Bytes| {
            let [position, du, dv] = [(); 3].map(|()| bytes.point());
            LimitSample { position, du, dv }
        };
        let samples = (0..samples).map(|_| sample(bytes)).collect();
        Record { face: face as u32, sub, regular: regular != 0, samples }
    };
    let records = (0..records).map(|_| record(&mut bytes)).collect();
    let vertex = |bytes: &mut Bytes| {
        let valid = bytes.i32() != 0;
        // The number of corners, the limit point and normal, how far apart the faces' are: the records have them.
        bytes.take::<{ 4 + 6 * 8 + 2 * 8 }>();
        VertexLimit { valid }
    };
    let vertices = (0..vertices).map(|_| vertex(&mut bytes)).collect();
    assert!(bytes.0.is_empty(), "nothing is left");
    let boundary = match boundary {
        0 => BoundaryRule::None,
        1 => BoundaryRule::EdgeOnly,
        _ => BoundaryRule::EdgeAndCorner,
    };
    Limit { boundary, side: side as usize, records, vertices }
}
