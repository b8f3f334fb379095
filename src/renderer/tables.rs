//! The arrays of a model, before they are on the GPU.

use super::{Construction, ModelOptions};
use crate::limit::Stencils;
use crate::mesh::ControlMesh;
use crate::table::{FaceOrigin, Notice, PatchPlan, RingTable, StencilTable, TableError, bytes, prepare};
use crate::topology::{PatchKind, Topology};
use glam::Vec3;
use std::borrow::Cow;

/// Everything that a model's shaders read but its positions. Made without a device, on any thread.
#[derive(Debug, Clone)]
pub struct ModelTables {
    pub(super) plan: PatchPlan,
    pub(super) construction: ConstructionTable,
    /// Whether the control points are kept between draws, and how many a corner has room for then.
    cached: Option<usize>,
    pub(super) texcoords: Option<Vec<[f32; 2]>>,
    /// Pairs of control vertices: the edges of the caller's mesh.
    pub(super) control_edges: Vec<u32>,
    /// Triples of control vertices: its faces as fans.
    pub(super) control_faces: Vec<u32>,
    /// Vertices of the caller's mesh, and of the refined one if it had to be refined.
    pub(super) control_vertices: usize,
    patch_vertices: usize,
    steps: Vec<Stencils>,
    origins: Vec<FaceOrigin>,
    notices: Vec<Notice>,
}

#[derive(Debug, Clone)]
pub(super) enum ConstructionTable {
    TwoStage(RingTable),
    Stencil(StencilTable),
}

/// Bytes of a table by its name.
pub type TableBytes = (&'static str, u64);

impl ModelTables {
    /// Prepares a mesh and builds its tables.
    ///
    /// # Errors
    /// A refined mesh or a table that cannot be addressed; faces that the scheme has no patch for.
    pub fn new(mesh: &ControlMesh, options: &ModelOptions) -> Result<Self, TableError> {
        let prepared = prepare(mesh, options.refine)?;
        let topology = Topology::new(&prepared.mesh);
        let mut plan = PatchPlan::new(&topology);
        let scheme = options.scheme;
        plan.check(&topology, scheme)?;
        let construction = match options.construction {
            Construction::TwoStage => ConstructionTable::TwoStage(RingTable::new(&topology, &plan, scheme)),
            Construction::Stencil | Construction::Cached => {
                ConstructionTable::Stencil(StencilTable::new(&topology, &mut plan, scheme)?)
            }
        };
        Ok(Self {
            texcoords: plan.texcoords(&topology),
            origins: plan.patches().iter().map(|patch| prepared.origin(patch.face)).collect(),
            plan,
            construction,
            cached: (options.construction == Construction::Cached).then(|| scheme.most_owned()),
            control_edges: control_edges(mesh),
            control_faces: control_faces(mesh),
            control_vertices: mesh.vertex_count(),
            patch_vertices: prepared.mesh.vertex_count(),
            notices: prepared.notices(&topology),
            steps: prepared.steps,
        })
    }

    /// What a user will want to know about how the mesh is drawn.
    pub fn notices(&self) -> &[Notice] {
        &self.notices
    }

    /// Where each patch comes from, in the order of [`ModelTables::plan`].
    pub fn origins(&self) -> &[FaceOrigin] {
        &self.origins
    }

    /// Vertices that the shaders read: those of the refined mesh, followed by the control vertices if it was refined.
    pub(super) fn stored_vertices(&self) -> usize {
        self.patch_vertices + if self.steps.is_empty() { 0 } else { self.control_vertices }
    }

    /// Where the control vertices start among the stored ones.
    pub(super) fn first_control_vertex(&self) -> usize {
        self.stored_vertices() - self.control_vertices
    }

    /// The stored vertices for these positions of the control vertices.
    pub(super) fn stored_positions<'p>(&self, control: &'p [[f32; 3]]) -> Cow<'p, [[f32; 3]]> {
        if self.steps.is_empty() {
            return Cow::Borrowed(control);
        }
        let mut refined: Vec<Vec3> = control.iter().map(|&p| p.into()).collect();
        for step in &self.steps {
            refined = step.apply(&refined);
        }
        Cow::Owned(refined.into_iter().map(Into::into).chain(control.iter().copied()).collect())
    }

    /// The patches, in the order of the tables.
    pub fn plan(&self) -> &PatchPlan {
        &self.plan
    }

    pub(super) fn construction(&self) -> Construction {
        match self.construction {
            ConstructionTable::TwoStage(_) => Construction::TwoStage,
            ConstructionTable::Stencil(_) if self.cached.is_some() => Construction::Cached,
            ConstructionTable::Stencil(_) => Construction::Stencil,
        }
    }

    /// Bytes of the control points that the cached construction keeps.
    pub(super) fn control_point_bytes(&self) -> u64 {
        let corners = PatchKind::ALL.map(|kind| u64::from(self.plan.count(kind)) * kind.corners() as u64);
        12 * self.cached.unwrap_or(0) as u64 * corners.iter().sum::<u64>()
    }

    /// How many patches of a kind there are.
    pub fn patch_count(&self, kind: PatchKind) -> u32 {
        self.plan.count(kind)
    }

    /// How many types of connectivity have weights of their own: of rings (two-stage) or of patches (stencil).
    pub fn type_count(&self) -> usize {
        match &self.construction {
            ConstructionTable::TwoStage(rings) => rings.type_count,
            ConstructionTable::Stencil(stencils) => stencils.type_count,
        }
    }

    /// Bytes of each table that drawing the surface reads.
    pub fn bytes(&self) -> Vec<TableBytes> {
        let mut all = vec![("positions", 12 * self.stored_vertices() as u64)];
        match &self.construction {
            ConstructionTable::TwoStage(t) => all.extend([
                ("ring_headers", bytes(&t.headers)),
                ("ring_entries", bytes(&t.entries)),
                ("ring_types", bytes(&t.types)),
                ("patch_corners", bytes(&t.corners)),
            ]),
            ConstructionTable::Stencil(t) => all.extend([
                ("stencil_patches", bytes(&t.patches)),
                ("stencil_vertices", bytes(&t.vertices)),
                ("stencil_types", bytes(&t.types)),
            ]),
        }
        if self.cached.is_some() {
            all.push(("control_points", self.control_point_bytes()));
        }
        all
    }

    /// The arrays behind bindings 1 to 4 of set 1, in order, with their names. The cached construction has its control
    /// points at the last.
    pub(super) fn bindings(&self) -> [(&'static str, &[u8]); 4] {
        use bytemuck::cast_slice;
        match &self.construction {
            ConstructionTable::TwoStage(t) => [
                ("ring headers", cast_slice(&t.headers)),
                ("ring entries", cast_slice(&t.entries)),
                ("ring types", cast_slice(&t.types)),
                ("patch corners", cast_slice(&t.corners)),
            ],
            ConstructionTable::Stencil(t) => [
                ("stencil patches", cast_slice(&t.patches)),
                ("stencil vertices", cast_slice(&t.vertices)),
                ("stencil types", cast_slice(&t.types)),
                ("nothing", &[]),
            ],
        }
    }
}

fn control_edges(mesh: &ControlMesh) -> Vec<u32> {
    let mut edges = Vec::with_capacity(mesh.corner_count());
    for face in 0..mesh.face_count() as u32 {
        let (vertices, corners) = (mesh.face(face), mesh.face_corners(face));
        for (k, h) in corners.enumerate() {
            // An edge of two faces belongs to the lower half-edge; a boundary's twin is above all.
            if mesh.twins()[h] > h as u32 {
                edges.extend([vertices[k], vertices[(k + 1) % vertices.len()]]);
            }
        }
    }
    edges
}

fn control_faces(mesh: &ControlMesh) -> Vec<u32> {
    let mut triangles = Vec::with_capacity(3 * (mesh.corner_count() - 2 * mesh.face_count()));
    for face in 0..mesh.face_count() as u32 {
        let vertices = mesh.face(face);
        triangles.extend(vertices[1..].windows(2).flat_map(|pair| [vertices[0], pair[0], pair[1]]));
    }
    triangles
}
