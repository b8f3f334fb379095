//! From any control mesh to one whose faces are patches: refinement where faces have more corners than the scheme has patches
//! for, or where the caller asks for it.

use super::cells::Cells;
use super::edges::EdgeTable;
use super::error::TableError;
use super::leaves::is_refined;
use super::options::{Evaluation, TableOptions};
use super::patch_id::MAX_LEVEL;
use super::pieces::cut_by_leaves;
use super::plan::{Patch, PatchPlan};
use super::wedges::{CutFace, Wedges};
use crate::adaptive::{self, DrawnBy};
use crate::limit::{Stencils, VertexEdits, refine};
use crate::mesh::{ControlMesh, MAX_CORNERS, MeshError, SHARPNESS_INFINITE};
use crate::patch::{Fallback, Scheme, Undefined};
use crate::topology::{Ring, RingKind, SHARP_FROM, Topology};
use glam::DVec3;
use std::fmt;
use std::sync::Arc;

/// Something that a user will want to know about how a mesh is drawn.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Notice {
    /// Faces with five or more corners: the whole mesh was refined once so that all faces are quads.
    RefinedPolygons {
        /// How many such faces there are.
        polygons: usize,
        /// The first of them.
        first: u32,
    },
    /// [`Edit`](crate::mesh::Edit)s at finer levels: the whole mesh was refined down to the finest of them.
    RefinedEdits {
        /// How many there are.
        count: usize,
        /// The finest level.
        level: usize,
    },
    /// Faces other than quads, where they are subdivided one by one: the whole mesh was refined once so that all are quads.
    RefinedToQuads {
        /// How many such faces there are.
        faces: usize,
        /// The first of them.
        first: u32,
    },
    /// Vertices where fans of faces touch in a point were split.
    SplitVertices {
        /// How many vertices that added.
        count: usize,
    },
    /// Faces that the scheme has no patches for, drawn with those of another.
    FellBack {
        /// How many such faces there are, of the prepared mesh.
        faces: usize,
        /// The first of them in the caller's mesh.
        first: u32,
        /// The scheme asked for.
        scheme: Scheme,
        /// The scheme that draws them.
        fallback: Scheme,
    },
    /// Sharp creases that end within the surface: around the end, patches do not have its limit.
    Darts {
        /// How many such ends there are.
        count: usize,
        /// The first of them, a vertex of the prepared mesh.
        first: u32,
    },
    /// No face is drawn: all are holes, or touch a boundary where that keeps faces from being drawn
    /// ([`BoundaryRule::None`](crate::mesh::BoundaryRule::None)).
    NothingDrawn,
    /// All vertices are at one place, as where a node of a file has the scale 0: there is nothing to see.
    NoExtent,
    /// End caps of adaptive subdivision at whose level creases or corners are of finite sharpness still.
    RoundedCaps {
        /// How many such caps there are.
        count: u32,
    },
    /// Creases or corners of finite sharpness that patches cannot follow.
    SemiSharp {
        /// Those drawn infinitely sharp: from [`SHARP_FROM`] up.
        sharp: usize,
        /// Those drawn smooth.
        smooth: usize,
    },
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RefinedPolygons { polygons, first } => write!(
                f,
                "{polygons} faces have five or more corners (the first is face {first}): the whole mesh is refined once"
            ),
            Self::RefinedEdits { count, level } => write!(
                f,
                "{count} edits are at levels down to {level}: the whole mesh is refined to this level, into {} faces for each quad",
                4u32.saturating_pow(*level as u32)
            ),
            Self::RefinedToQuads { faces, first } => {
                write!(f, "{faces} faces are no quads (the first is face {first}): the whole mesh is refined once")
            }
            Self::SplitVertices { count } => {
                write!(f, "{count} vertices were split off where fans of faces touch in a point")
            }
            Self::FellBack { faces, first, scheme, fallback } => write!(
                f,
                "{faces} faces have no {} patches (the first is face {first}): they are drawn with {} patches",
                scheme.name(),
                fallback.name()
            ),
            Self::Darts { count, first } => write!(
                f,
                "{count} ends of creases lie within the surface (the first at vertex {first}): patches around them only come near it; refine the mesh first to come closer"
            ),
            Self::NothingDrawn => write!(
                f,
                "no face is drawn: all are holes, or touch a boundary where the rule for boundaries is to draw none of those"
            ),
            Self::NoExtent => write!(
                f,
                "all vertices are at one place, so there is nothing to see: look for a scale of 0 in the file, or among its nodes"
            ),
            Self::RoundedCaps { count } => write!(
                f,
                "{count} end caps have creases or corners whose sharpness is not used up at their level, and draw them infinitely sharp or smooth: a greater depth, or depth of sharp features, follows them"
            ),
            Self::SemiSharp { sharp, smooth } => write!(
                f,
                "{} creases and corners have finite sharpness: {sharp} (from {SHARP_FROM} up) are drawn infinitely sharp, {smooth} smooth; adaptive surfaces have it as it is",
                sharp + smooth
            ),
        }
    }
}

/// A mesh whose faces are patches, and the way there from the caller's mesh.
#[derive(Debug, Clone)]
pub struct Prepared {
    topology: Arc<Topology>,
    cut: Option<Cut>,
    /// The refinement steps, in order. Each step's inputs are the outputs of the one before.
    pub steps: Vec<Step>,
    cells: Cells,
    refined_faces: Option<Notice>,
    refined_edits: Option<Notice>,
    /// Whether sharpness counts as infinite or none: it is not where faces are subdivided.
    rounds_sharpness: bool,
    /// Vertices split off by refinement.
    split_vertices: usize,
    /// End caps that round sharpness.
    rounded_caps: u32,
}

/// Faces of a prepared mesh that are cut, in wedges or by leaves.
#[derive(Debug, Clone)]
struct Cut {
    /// The mesh before.
    whole: Arc<Topology>,
    /// By face of the prepared mesh.
    faces: Vec<CutFace>,
}

/// A step of refinement.
#[derive(Debug, Clone)]
pub struct Step {
    pub(super) stencils: Stencils,
    pub(super) edits: VertexEdits,
}

impl Step {
    /// The refined vertices, where those before are these.
    pub fn apply(&self, vertices: &[DVec3]) -> Vec<DVec3> {
        let mut refined = self.stencils.apply(vertices);
        self.edits.apply(&mut refined);
        refined
    }
}

impl Prepared {
    /// The mesh as it is.
    fn of(mesh: &ControlMesh) -> Result<Self, MeshError> {
        Ok(Self {
            topology: Arc::new(Topology::new(mesh)),
            cut: None,
            steps: Vec::new(),
            cells: Cells::whole(mesh)?,
            refined_faces: None,
            refined_edits: None,
            rounds_sharpness: true,
            split_vertices: 0,
            rounded_caps: 0,
        })
    }

    /// The mesh refined `levels` times, and down to its finest edits.
    fn refined(mesh: &ControlMesh, levels: u32) -> Result<Self, MeshError> {
        let (level, count) = (mesh.edit_level(), mesh.data().edits.len());
        let refined_edits = (levels < level as u32).then_some(Notice::RefinedEdits { count, level });
        let levels = levels.max(level as u32);
        // Before anything is allocated. Each step makes a quad of every corner.
        let corners = 4usize.saturating_pow(levels).saturating_mul(mesh.corner_count());
        if corners > MAX_CORNERS {
            return Err(MeshError::TooLarge { what: "face corners when refined", count: corners, max: MAX_CORNERS });
        }
        if levels > MAX_LEVEL {
            let (count, max) = (levels as usize, MAX_LEVEL as usize);
            return Err(MeshError::TooLarge { what: "levels of refinement", count, max });
        }
        let mut prepared = Self { refined_edits, ..Self::of(mesh)? };
        for _ in 0..levels {
            prepared.split_vertices += prepared.topology.split_count();
            let refined = refine(&prepared.topology)?;
            prepared.cells = prepared.cells.refined(&prepared.topology);
            prepared.steps.push(Step { stencils: refined.stencils, edits: refined.edits });
            prepared.topology = Arc::new(Topology::new(&refined.mesh));
        }
        Ok(prepared)
    }

    /// The prepared mesh: triangles and quads only, or pentagons too where the scheme has patches for them.
    pub fn mesh(&self) -> &ControlMesh {
        self.topology.mesh()
    }

    /// How its faces hang together.
    pub fn topology(&self) -> &Arc<Topology> {
        &self.topology
    }

    /// How the faces hang together that adaptive subdivision is of: those of the prepared mesh, before some are cut in wedges.
    pub fn whole(&self) -> &Arc<Topology> {
        self.cut.as_ref().map_or(&self.topology, |cut| &cut.whole)
    }

    /// The face of [`Prepared::whole`] that a face of the prepared mesh is, or that it is a wedge of; then the corner from which the
    /// wedge's edge starts.
    pub fn whole_face(&self, face: u32) -> (u32, Option<u32>) {
        self.cut_face(face).map_or((face, None), |cut| (cut.face, cut.part.corner()))
    }

    /// What a face of the prepared mesh was before some were cut.
    pub(super) fn cut_face(&self, face: u32) -> Option<CutFace> {
        self.cut.as_ref().map(|cut| cut.faces[face as usize])
    }

    /// The roots of the quadtrees that a patch is evaluated by: of a wedge those around the two ends of its edge, else twice the same.
    pub fn roots(&self, plan: &adaptive::Plan, patch: &Patch) -> [u32; 2] {
        let (face, corner) = self.whole_face(patch.face);
        let first = plan.face_roots[face as usize];
        let Some(corner) = corner else { return [first; 2] };
        let next = if first + corner + 1 == plan.face_roots[face as usize + 1] { first } else { first + corner + 1 };
        [first + corner, next]
    }

    /// Has the faces that have centres in a plan cut in wedges, or all by leaves, and plans all.
    fn with_leaves(self, scheme: Scheme, plan: adaptive::Plan) -> Result<Planned, TableError> {
        let Self { topology: whole, cells, .. } = self;
        let by_leaves = plan.options.drawn_by == DrawnBy::Leaves;
        let (topology, cells, cut) = match plan.centre_faces.is_empty() {
            _ if by_leaves => {
                let pieces = cut_by_leaves(&whole, &plan)?;
                let cells = cells.cut_by_leaves(&whole, &plan, &pieces)?;
                (pieces.topology, cells, Some(Cut { whole, faces: pieces.faces }))
            }
            true => (whole, cells, None),
            false => {
                let Wedges { mesh, faces } = Wedges::new(&whole, &plan.centre_faces)?;
                let cells = cells.cut(&whole, &faces);
                (Arc::new(Topology::new(&mesh)), cells, Some(Cut { whole, faces }))
            }
        };
        let prepared = Self { topology, cells, cut, rounded_caps: plan.rounded_caps, ..self };
        let is_refined = |face| {
            let (face, corner) = prepared.whole_face(face);
            by_leaves || corner.is_some() || is_refined(&plan, face)
        };
        let patches = PatchPlan::new(&prepared.topology, &prepared.cells, scheme, Fallback::Refuse, is_refined)?;
        Ok((prepared, patches, Some(plan)))
    }

    /// Plans the patches of the prepared mesh.
    ///
    /// # Errors
    /// As of [`PatchPlan`]: a face that the scheme has no patch for, unless such faces fall back.
    pub fn plan(&self, scheme: Scheme, fallback: Fallback) -> Result<PatchPlan, Undefined> {
        PatchPlan::new(&self.topology, &self.cells, scheme, fallback, |_| false)
    }

    /// The edges of the patches in `plan`.
    pub fn edges(&self, plan: &PatchPlan) -> EdgeTable {
        EdgeTable::new(&self.topology, &self.cells, plan)
    }

    /// What a user will want to know, once the prepared mesh is planned.
    pub fn notices(&self, plan: &PatchPlan) -> Vec<Notice> {
        let splits = self.split_vertices + self.topology.split_count();
        let split = (splits > 0).then_some(Notice::SplitVertices { count: splits });
        let fell_back = plan.fallen_back().min_by_key(|patch| patch.face).map(|patch| Notice::FellBack {
            faces: plan.fallen_back().count(),
            first: plan.origin(patch).face,
            scheme: plan.scheme(),
            fallback: patch.scheme,
        });
        let refined = self.refined_edits.clone().or_else(|| self.refined_faces.clone());
        let rounded = semi_sharp(self.mesh()).filter(|_| self.rounds_sharpness);
        let darts = darts(&self.topology).filter(|_| self.rounds_sharpness);
        let nothing = plan.patches().is_empty().then_some(Notice::NothingDrawn);
        let no_extent = (self.mesh().diagonal() == 0.0).then_some(Notice::NoExtent);
        let caps = Some(Notice::RoundedCaps { count: self.rounded_caps });
        let caps = caps.filter(|_| self.rounded_caps > 0 && !self.rounds_sharpness);
        nothing
            .into_iter()
            .chain(no_extent)
            .chain(caps)
            .chain(refined)
            .chain(split)
            .chain(fell_back)
            .chain(darts)
            .chain(rounded)
            .collect()
    }
}

/// Prepares `mesh` for the patches of a scheme, and plans them.
///
/// As [`prepare()`], but a scheme that has patches for pentagons ([`Scheme::has_pentagons`]) takes a mesh as it is, if it is
/// defined on all of its faces. Where it is not, a mesh with faces of five or more corners can fall back only when refined.
///
/// # Errors
/// A refined mesh that cannot be addressed; faces that the scheme has no patch for, unless they fall back.
pub fn prepare_patches(
    mesh: &ControlMesh,
    scheme: Scheme,
    fallback: Fallback,
    levels: u32,
) -> Result<(Prepared, PatchPlan), TableError> {
    if levels == 0 && mesh.edit_level() == 0 && scheme.has_pentagons() {
        let prepared = Prepared::of(mesh)?;
        match prepared.plan(scheme, Fallback::Refuse) {
            Ok(plan) => return Ok((prepared, plan)),
            Err(undefined) if fallback == Fallback::Refuse => return Err(undefined.into()),
            Err(_) => {}
        }
    }
    let prepared = prepare(mesh, levels)?;
    let plan = prepared.plan(scheme, fallback)?;
    Ok((prepared, plan))
}

/// A prepared mesh, its patches, and what is refined of it.
type Planned = (Prepared, PatchPlan, Option<adaptive::Plan>);

/// Prepares `mesh` for the tables of some options, and plans its patches and its adaptive subdivision.
///
/// # Errors
/// Those of [`prepare_patches`], [`prepare_quads`] and [`adaptive::Plan::new`].
pub(crate) fn prepare_for(mesh: &ControlMesh, options: &TableOptions) -> Result<Planned, TableError> {
    let &TableOptions { scheme, fallback, evaluation, refine, .. } = options;
    let is_whole = refine == 0 && mesh.edit_level() == 0;
    match (options.adaptive, evaluation) {
        (Some(_), Evaluation::Subdivision) => Err(TableError::NotAdaptive { evaluation }),
        (Some(_), _) if options.is_by_leaves() && evaluation != Evaluation::Tessellation => {
            Err(TableError::NotByLeaves { evaluation })
        }
        (Some(adaptive), _) => {
            let prepared = Prepared { rounds_sharpness: false, ..Prepared::refined(mesh, refine)? };
            let plan = adaptive::Plan::new(&prepared.topology, scheme, &adaptive)?;
            prepared.with_leaves(scheme, plan)
        }
        (None, Evaluation::Subdivision) => prepare_quads(mesh, refine).map(|(prepared, plan)| (prepared, plan, None)),
        (None, _) if is_whole && scheme.has_caps() && mesh.data().face_sizes.iter().any(|&size| size > 4) => {
            let prepared = Prepared::of(mesh)?;
            let plan = adaptive::Plan::around_polygons(&prepared.topology, scheme)?;
            prepared.with_leaves(scheme, plan)
        }
        (None, _) => prepare_patches(mesh, scheme, fallback, refine).map(|(prepared, plan)| (prepared, plan, None)),
    }
}

/// Refines `mesh` at least `levels` times, and once if it has faces with five or more corners.
///
/// # Errors
/// [`MeshError::TooLarge`] if the refined mesh cannot be addressed.
pub fn prepare(mesh: &ControlMesh, levels: u32) -> Result<Prepared, MeshError> {
    let notice = |polygons, first| Notice::RefinedPolygons { polygons, first };
    refine_faces(mesh, levels, |size| size > 4, notice)
}

/// Prepares `mesh` for subdivision of one face after the other, and plans its faces as if they were patches: as [`prepare()`],
/// but every face becomes a quad.
///
/// # Errors
/// A refined mesh that cannot be addressed.
pub fn prepare_quads(mesh: &ControlMesh, levels: u32) -> Result<(Prepared, PatchPlan), TableError> {
    let notice = |faces, first| Notice::RefinedToQuads { faces, first };
    let prepared = Prepared { rounds_sharpness: false, ..refine_faces(mesh, levels, |size| size != 4, notice)? };
    let plan = prepared.plan(Scheme::Gregory, Fallback::Refuse)?;
    Ok((prepared, plan))
}

/// Refines `mesh` at least `levels` times, and once if faces have sizes that do not fit.
fn refine_faces(
    mesh: &ControlMesh,
    levels: u32,
    misfit: impl Fn(u32) -> bool,
    notice: impl Fn(usize, u32) -> Notice,
) -> Result<Prepared, MeshError> {
    let mut misfits = (0..).zip(&mesh.data().face_sizes).filter(|&(_, &size)| misfit(size));
    let Some((first, _)) = misfits.next() else { return Prepared::refined(mesh, levels) };
    let refined_faces = (levels == 0).then(|| notice(1 + misfits.count(), first));
    Ok(Prepared { refined_faces, ..Prepared::refined(mesh, levels.max(1))? })
}

/// Vertices around which all is smooth but one sharp edge, which ends there.
fn darts(topology: &Topology) -> Option<Notice> {
    let is_dart =
        |ring: &&Ring| ring.kind == RingKind::Smooth && topology.ring_half_edges(ring).any(|h| topology.is_sharp(h));
    let ends: Vec<u32> = topology.rings().iter().filter(is_dart).map(|ring| topology.mesh_vertex(ring.start)).collect();
    Some(Notice::Darts { count: ends.len(), first: *ends.iter().min()? })
}

fn semi_sharp(mesh: &ControlMesh) -> Option<Notice> {
    let data = mesh.data();
    let sharpness = data.creases.iter().map(|c| c.sharpness).chain(data.corners.iter().map(|c| c.sharpness));
    let finite = sharpness.filter(|&s| s > 0.0 && s < SHARPNESS_INFINITE);
    let (sharp, smooth): (Vec<f32>, Vec<f32>) = finite.partition(|&s| s >= SHARP_FROM);
    let notice = Notice::SemiSharp { sharp: sharp.len(), smooth: smooth.len() };
    (sharp.len() + smooth.len() > 0).then_some(notice)
}
