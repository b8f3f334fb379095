//! The arrays of a model, before they are on the GPU.

use super::prepare::Step;
use super::shared::SHARED_WORDS;
use super::{
    Construction, EdgeTable, Evaluation, FaceOrigin, LeafTable, Notice, PatchPlan, Refinement, RingTable, SharedTable,
    Sharing, StencilTable, SubdivisionTable, TableError, TableOptions, bytes, prepare_for,
};
use crate::mesh::ControlMesh;
use crate::topology::PatchKind;
use glam::{DVec3, Vec3};

/// Everything that a model's shaders read but its positions. Made without a device, on any thread.
#[derive(Debug, Clone)]
pub struct ModelTables {
    pub(crate) plan: PatchPlan,
    options: TableOptions,
    /// Of the two-stage and the cached construction, and wherever normals are shared.
    rings: Option<RingTable>,
    /// Of the stencil construction, and of conversion by the geometry shader.
    stencils: Option<StencilTable>,
    /// Of subdivision.
    fans: Option<SubdivisionTable>,
    /// Where normals are shared.
    shared: Option<SharedTable>,
    /// Of adaptive subdivision.
    leaves: Option<LeafTable>,
    /// Of steps that the device makes, and what is in the leaves' besides.
    refined_steps: Option<Refinement>,
    pub(crate) texcoords: Option<Vec<[f32; 2]>>,
    edges: Option<EdgeTable>,
    /// Pairs of control vertices: the edges of the caller's mesh.
    pub(crate) control_edges: Vec<u32>,
    /// Triples of control vertices: its faces as fans.
    pub(crate) control_faces: Vec<u32>,
    /// Vertices of the caller's mesh, and of the refined one if it had to be refined.
    pub(crate) control_vertices: usize,
    patch_vertices: usize,
    steps: Vec<Step>,
    notices: Vec<Notice>,
}

/// Bytes of a stored vertex, and of a texel of what is kept. GLSL twins: `glsl/lib/draw/positions.glsl`, `glsl/lib/construct/cached.glsl`.
pub(crate) const TEXEL_BYTES: u64 = 16;
/// Bytes of a frame of a ring. GLSL twin: `glsl/lib/construct/kept_frames.glsl`.
const FRAME_BYTES: u64 = 4 * 12;

/// Bytes of a table by its name.
pub type TableBytes = (&'static str, u64);

impl ModelTables {
    /// Prepares a mesh and builds its tables.
    ///
    /// # Errors
    /// A refined mesh or a table that cannot be addressed; faces that the scheme has no patch for; shared normals of a
    /// scheme whose patches share no edges.
    pub fn new(mesh: &ControlMesh, options: impl Into<TableOptions>) -> Result<Self, TableError> {
        let options = options.into();
        let subdivides = options.evaluation == Evaluation::Subdivision;
        let (prepared, mut plan, adaptive) = prepare_for(mesh, &options)?;
        let topology = prepared.topology();
        let fans = subdivides.then(|| SubdivisionTable::new(topology, &plan)).transpose()?;
        let converts = options.evaluation == Evaluation::GeometryTwoPass;
        let by_leaves = options.is_by_leaves();
        // The stencil table puts the patches in its own order, so it comes first.
        let stencils = (options.construction == Construction::Stencil && !subdivides && !by_leaves || converts)
            .then(|| StencilTable::new(topology, &mut plan))
            .transpose()?;
        let sharing = options.sharing();
        let edges = (options.edge_factors || sharing != Sharing::Positions).then(|| prepared.edges(&plan));
        let shared = match (sharing, &edges) {
            (Sharing::Displacement, Some(edges)) => {
                Some(SharedTable::with_texcoords(topology, edges, &plan).ok_or(TableError::NoTexcoords)?)
            }
            (Sharing::Normals, Some(edges)) => Some(SharedTable::new(topology, edges, &plan)),
            _ => None,
        };
        if shared.is_some() && !options.scheme.is_watertight() {
            return Err(TableError::NothingShared { scheme: options.scheme });
        }
        let leaves = adaptive.map(|adaptive| LeafTable::new(&prepared, &plan, adaptive));
        let refines = options.refine_on_device && !prepared.steps.is_empty();
        let refined_steps = refines.then(|| {
            let of_leaves = leaves.as_ref().map(|leaves| &leaves.refinement);
            Refinement::of_steps(&prepared.steps, mesh.vertex_count() as u32, of_leaves)
        });
        let rings = (stencils.is_none() && !subdivides || shared.is_some()) && !by_leaves;
        let rings = rings.then(|| RingTable::new(topology, &plan));
        Ok(Self {
            texcoords: plan.texcoords(topology),
            edges: edges.filter(|_| options.edge_factors),
            notices: prepared.notices(&plan),
            plan,
            options,
            rings,
            stencils,
            fans,
            shared,
            leaves,
            refined_steps: refined_steps.transpose()?,
            control_edges: control_edges(mesh),
            control_faces: control_faces(mesh),
            control_vertices: mesh.vertex_count(),
            patch_vertices: prepared.whole().mesh().vertex_count(),
            steps: prepared.steps,
        })
    }

    /// Whether another ring than its own owns what some corner shares.
    pub(crate) fn has_foreign_owners(&self) -> bool {
        let (Some(shared), Some(rings)) = (&self.shared, &self.rings) else { return false };
        let own = |(&[ring, plus, _, minus, _], &[own, _]): (&[u32; SHARED_WORDS], &[u32; 2])| {
            [ring, plus, minus] == [own; 3]
        };
        !shared.corners.iter().zip(&rings.corners).all(own)
    }

    /// What a user will want to know about how the mesh is drawn.
    pub fn notices(&self) -> &[Notice] {
        &self.notices
    }

    /// The edges of the patches, with [`TableOptions::edge_factors`].
    pub fn edges(&self) -> Option<&EdgeTable> {
        self.edges.as_ref()
    }

    /// Where each patch comes from, in the order of [`ModelTables::plan`].
    pub fn origins(&self) -> Vec<FaceOrigin> {
        self.plan.origins()
    }

    /// Vertices that the shaders read: the control vertices, followed by those of the refined mesh if it was refined, and by those of
    /// adaptive subdivision.
    pub(crate) fn stored_vertices(&self) -> usize {
        let control = if self.steps.is_empty() { 0 } else { self.control_vertices };
        let made = |refinement: &Refinement| refinement.first_vertex as usize + refinement.vertices();
        self.refinement().map_or(control + self.patch_vertices, made)
    }

    /// Puts the stored vertices but those that the device makes, for these positions of the control vertices in the place of what is in
    /// `stored`: with a fourth number each, as texel buffers have them.
    pub(crate) fn store_positions(&self, control: &[[f32; 3]], stored: &mut Vec<[f32; 4]>) {
        let wide = |&[x, y, z]: &[f32; 3]| [x, y, z, 0.0];
        stored.clear();
        stored.extend(control.iter().map(wide));
        if !self.refines_on_host() {
            return;
        }
        let wide = |p: DVec3| p.as_vec3().extend(0.0).to_array();
        let positions: Vec<DVec3> = control.iter().map(|&p| Vec3::from(p).as_dvec3()).collect();
        let refined = self.steps.iter().fold(positions, |refined, step| step.apply(&refined));
        stored.extend(refined.into_iter().map(wide));
    }

    /// Whether the host refines the whole mesh each time that its positions are set.
    pub(crate) fn refines_on_host(&self) -> bool {
        !self.steps.is_empty() && self.refined_steps.is_none()
    }

    /// Sums by which the device makes vertices.
    pub(crate) fn refinement(&self) -> Option<&Refinement> {
        self.refined_steps.as_ref().or(self.leaves.as_ref().map(|leaves| &leaves.refinement))
    }

    /// The leaves of faces that are refined, with [`TableOptions::adaptive`].
    pub fn leaves(&self) -> Option<&LeafTable> {
        self.leaves.as_ref()
    }

    /// Corners of a patch by leaves, by its number, in (u, v) of its cell ([`PatchId`](super::PatchId)): three of a triangle, else
    /// `[0, 0]`, `[1, 0]`, `[1, 1]`, `[0, 1]`. `None` unless patches are leaves
    /// ([`AdaptiveOptions::drawn_by`](crate::adaptive::AdaptiveOptions::drawn_by)), or if there is no such patch.
    pub fn cell_corners(&self, patch: usize) -> Option<Vec<[f64; 2]>> {
        let leaves = self.leaves.as_ref().filter(|_| self.options.is_by_leaves())?;
        let kind = self.plan.patches().get(patch)?.kind;
        Some(leaves.cell_corners(patch, kind))
    }

    /// The patches, in the order of the tables.
    pub fn plan(&self) -> &PatchPlan {
        &self.plan
    }

    /// The options that the tables were built for.
    pub fn options(&self) -> TableOptions {
        self.options
    }

    /// How many texels a corner has room for, where what it owns and shares is kept between draws; else 0. GLSL twin:
    /// `glsl/lib/construct/cached.glsl`.
    pub(crate) fn kept_texels(&self) -> u32 {
        let keeps = self.options.construction == Construction::Cached && !self.options.is_by_leaves();
        if !keeps || self.options.evaluation == Evaluation::Subdivision {
            return 0;
        }
        let owned = self.plan.groups().iter().map(|group| group.scheme.owned(group.kind)).max().unwrap_or(0);
        self.sharing().kept_texels(owned)
    }

    /// How many rings have frames that are kept between draws.
    pub(crate) fn kept_frames(&self) -> u32 {
        let frames = self.kept_texels() > 0 && self.options.evaluation != Evaluation::GeometryTwoPass;
        self.rings.as_ref().filter(|_| frames).map_or(0, |rings| rings.headers.len() as u32)
    }

    /// What the evaluation takes from other patches.
    pub(crate) fn sharing(&self) -> Sharing {
        self.options.sharing()
    }

    /// Bytes of what the cached construction keeps of corners, and of frames.
    pub(crate) fn kept_bytes(&self) -> [u64; 2] {
        let corners = self.plan.corner_count() as u64;
        [TEXEL_BYTES * u64::from(self.kept_texels()) * corners, FRAME_BYTES * u64::from(self.kept_frames())]
    }

    /// How many patches of a kind there are.
    pub fn patch_count(&self, kind: PatchKind) -> u32 {
        self.plan.count(kind)
    }

    /// How many types of connectivity have weights of their own: of rings (two-stage, cached), patches (stencil) or fans (subdivision).
    pub fn type_count(&self) -> usize {
        match (&self.stencils, &self.fans) {
            (Some(stencils), _) => stencils.type_count,
            (None, Some(fans)) => fans.type_count,
            (None, None) => self.rings.as_ref().map_or(0, |rings| rings.type_count),
        }
    }

    /// Bytes of each table that drawing the surface reads.
    pub fn bytes(&self) -> Vec<TableBytes> {
        let positions = ("positions", TEXEL_BYTES * self.stored_vertices() as u64);
        let tables = self.bindings().into_iter().filter(|(name, array)| *name != "texcoords" && !array.is_empty());
        let kept = ["control_points", "frames"].into_iter().zip(self.kept_bytes()).filter(|&(_, bytes)| bytes > 0);
        std::iter::once(positions).chain(tables.map(|(name, array)| (name, bytes(array)))).chain(kept).collect()
    }

    /// The arrays behind the bindings of set 1 from 1 on, in order, with their names. Those that the model does not need
    /// are empty.
    pub(crate) fn bindings(&self) -> [(&'static str, &[u8]); 17] {
        fn array<'t, T, E: bytemuck::NoUninit>(table: &'t Option<T>, array: impl Fn(&'t T) -> &'t [E]) -> &'t [u8] {
            table.as_ref().map_or(&[], |table| bytemuck::cast_slice(array(table)))
        }
        let (rings, stencils, fans) = (&self.rings, &self.stencils, &self.fans);
        let sums = |array: fn(&Refinement) -> &[u8]| self.refinement().map_or(&[][..], array);
        // Shaders read rings or fans, never both.
        let around = match fans {
            None => [
                ("ring_headers", array(rings, |t| &t.headers)),
                ("ring_entries", array(rings, |t| &t.entries)),
                ("ring_types", array(rings, |t| &t.types)),
                ("patch_corners", array(rings, |t| &t.corners)),
            ],
            Some(_) => [
                ("fan_headers", array(fans, |t| &t.headers)),
                ("fan_entries", array(fans, |t| t.entries.as_flattened())),
                ("fan_words", array(fans, |t| &t.words)),
                ("face_corners", array(fans, |t| &t.corners)),
            ],
        };
        let [headers, entries, types, corners] = around;
        [
            headers,
            entries,
            types,
            corners,
            ("quadtrees", array(&self.leaves, |t| &t.quadtrees)),
            ("leaves", array(&self.leaves, |t| t.leaves.as_flattened())),
            ("blocks", sums(|t| bytemuck::cast_slice(&t.blocks))),
            ("block_vertices", sums(|t| bytemuck::cast_slice(&t.vertices))),
            ("mask_weights", sums(|t| bytemuck::cast_slice(&t.weights))),
            ("stencil_patches", array(stencils, |t| &t.patches)),
            ("stencil_vertices", array(stencils, |t| &t.vertices)),
            ("stencil_types", array(stencils, |t| &t.types)),
            ("texcoords", array(&self.texcoords, |t| t.as_slice())),
            ("shared_corners", array(&self.shared, |t| t.corners.as_flattened())),
            ("shared_texcoords", array(&self.shared, |t| &t.texcoords)),
            ("hulls", array(&self.leaves, |t| &t.hulls)),
            ("faces", array(&self.leaves, |t| t.faces.as_flattened())),
        ]
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
