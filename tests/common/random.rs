//! Small random meshes: any valence, triangles and quads, boundaries, vertices where fans touch.

use ash_subdiv::mesh::Crease;
use ash_subdiv::topology::Topology;
use ash_subdiv::{ControlMesh, MeshData, grid_torus, limit::refine, shape};
use glam::DVec3;

/// Numbers that are the same on every machine (SplitMix64).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// From -1 to 1.
    pub fn signed(&mut self) -> f64 {
        self.next() as f64 / u64::MAX as f64 * 2.0 - 1.0
    }

    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}

/// Faces and positions while they are being changed.
struct Soup {
    positions: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
}

impl Soup {
    fn of(mesh: &ControlMesh) -> Self {
        let faces = (0..mesh.face_count() as u32).map(|f| mesh.face(f).to_vec()).collect();
        Self { positions: mesh.data().positions.iter().map(|&p| p.into()).collect(), faces }
    }

    fn centre(&self, face: &[u32]) -> DVec3 {
        face.iter().map(|&v| self.positions[v as usize]).sum::<DVec3>() / face.len() as f64
    }

    /// Puts a smaller face into a face, joined to it by quads: the valence of its corners grows.
    fn inset(&mut self, face: usize) {
        let outer = self.faces[face].clone();
        let (centre, first, n) = (self.centre(&outer), self.positions.len() as u32, outer.len());
        self.positions.extend(outer.iter().map(|&v| centre.lerp(self.positions[v as usize], 0.5)).collect::<Vec<_>>());
        self.faces[face] = (0..n as u32).map(|i| first + i).collect();
        for k in 0..n {
            let (a, b) = (k as u32, ((k + 1) % n) as u32);
            self.faces.push(vec![outer[k], outer[(k + 1) % n], first + b, first + a]);
        }
    }

    /// Cuts a quad in two.
    fn cut(&mut self, face: usize, corner: usize) {
        let quad = self.faces[face].clone();
        if quad.len() == 4 {
            let at = |i: usize| quad[(corner + i) % 4];
            self.faces[face] = vec![at(0), at(1), at(2)];
            self.faces.push(vec![at(0), at(2), at(3)]);
        }
    }

    fn mesh(self) -> Option<ControlMesh> {
        // Without the vertices that no face has any more.
        let mut used = vec![u32::MAX; self.positions.len()];
        let mut positions = Vec::new();
        let mut faces = self.faces;
        for v in faces.iter_mut().flatten() {
            let new = &mut used[*v as usize];
            if *new == u32::MAX {
                *new = positions.len() as u32;
                positions.push(self.positions[*v as usize].to_array());
            }
            *v = *new;
        }
        let face_sizes = faces.iter().map(|f| f.len() as u32).collect();
        ControlMesh::new(MeshData { positions, face_sizes, face_vertices: faces.concat(), ..MeshData::default() }).ok()
    }
}

/// A mesh of some dozens of triangles and quads.
pub fn random_mesh(seed: u64) -> ControlMesh {
    let random = &mut Random::new(seed);
    loop {
        let base = match random.below(4) {
            0 => shape("cube"),
            1 => shape("tetrahedron").and_then(|mesh| Ok(refine(&Topology::new(&mesh))?.mesh)),
            2 => ControlMesh::new(grid_torus(5, 4)),
            _ => shape("strip"),
        };
        let mut soup = Soup::of(&base.expect("built in"));
        for _ in 0..random.below(6) {
            let face = random.below(soup.faces.len());
            soup.inset(face);
        }
        for _ in 0..random.below(8) {
            let (face, corner) = (random.below(soup.faces.len()), random.below(4));
            soup.cut(face, corner);
        }
        // Holes with boundaries, some of which touch.
        for _ in 0..random.below(5) {
            if soup.faces.len() > 2 {
                let face = random.below(soup.faces.len());
                soup.faces.swap_remove(face);
            }
        }
        for position in &mut soup.positions {
            *position += 0.05 * random.vector();
        }
        random.shuffle(&mut soup.faces);
        for face in &mut soup.faces {
            let corner = random.below(face.len());
            face.rotate_left(corner);
        }
        // Removed faces can leave none.
        if let Some(mesh) = soup.mesh() {
            return mesh;
        }
    }
}

/// The same with some of its edges infinitely sharp.
pub fn random_creased_mesh(seed: u64) -> ControlMesh {
    let mesh = random_mesh(seed);
    let random = &mut Random::new(seed ^ 0x5eed);
    let mut creases = Vec::new();
    for face in 0..mesh.face_count() as u32 {
        let vertices = mesh.face(face);
        for k in 0..vertices.len() {
            if random.below(6) == 0 {
                creases.push(Crease { vertices: [vertices[k], vertices[(k + 1) % vertices.len()]], sharpness: 10.0 });
            }
        }
    }
    ControlMesh::new(MeshData { creases, ..mesh.into_data() }).expect("edges of the mesh")
}
