//! From any control mesh to one whose faces are patches: refinement where faces have more corners than the scheme has patches
//! for, or where the caller asks for it.

use super::cells::Cells;
use super::edges::EdgeTable;
use super::error::TableError;
use super::leaves::is_refined;
use super::options::{Evaluation, TableOptions};
use super::patch_id::MAX_LEVEL;
use super::plan::PatchPlan;
use crate::adaptive::{self, AdaptiveOptions};
use crate::limit::{Stencils, refine};
use crate::mesh::{ControlMesh, MAX_CORNERS, MeshError, SHARPNESS_INFINITE};
use crate::patch::{Fallback, Scheme, Undefined};
use crate::topology::{Ring, RingKind, SHARP_FROM, Topology};
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
            Self::SemiSharp { sharp, smooth } => write!(
                f,
                "{} creases and corners have finite sharpness: {sharp} (from {SHARP_FROM} up) are drawn infinitely sharp, {smooth} smooth; refine the mesh first to come closer",
                sharp + smooth
            ),
        }
    }
}

/// A mesh whose faces are patches, and the way there from the caller's mesh.
#[derive(Debug, Clone)]
pub struct Prepared {
    topology: Arc<Topology>,
    /// The refinement steps, in order. Each step's inputs are the outputs of the one before.
    pub steps: Vec<Stencils>,
    cells: Cells,
    refined_faces: Option<Notice>,
    /// Whether sharpness counts as infinite or none: it is not where faces are subdivided.
    rounds_sharpness: bool,
    /// Vertices split off by refinement.
    split_vertices: usize,
}

impl Prepared {
    /// The mesh as it is.
    fn of(mesh: &ControlMesh) -> Result<Self, MeshError> {
        Ok(Self {
            topology: Arc::new(Topology::new(mesh)),
            steps: Vec::new(),
            cells: Cells::whole(mesh)?,
            refined_faces: None,
            rounds_sharpness: true,
            split_vertices: 0,
        })
    }

    /// The prepared mesh: triangles and quads only, or pentagons too where the scheme has patches for them.
    pub fn mesh(&self) -> &ControlMesh {
        self.topology.mesh()
    }

    /// How its faces hang together.
    pub fn topology(&self) -> &Arc<Topology> {
        &self.topology
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
        let refined = self.refined_faces.clone();
        let rounded = semi_sharp(self.mesh()).filter(|_| self.rounds_sharpness);
        let darts = darts(&self.topology).filter(|_| self.rounds_sharpness);
        refined.into_iter().chain(split).chain(fell_back).chain(darts).chain(rounded).collect()
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
    if levels == 0 && scheme.has_pentagons() {
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

/// Prepares `mesh` for the tables of some options, and plans its patches and its adaptive subdivision.
///
/// # Errors
/// Those of [`prepare_patches`], [`prepare_quads`] and [`adaptive::Plan::new`].
pub(crate) fn prepare_for(
    mesh: &ControlMesh,
    options: &TableOptions,
) -> Result<(Prepared, PatchPlan, Option<adaptive::Plan>), TableError> {
    let &TableOptions { scheme, fallback, evaluation, refine, .. } = options;
    match (options.adaptive, evaluation) {
        (Some(_), Evaluation::Subdivision) => Err(TableError::NotAdaptive { evaluation }),
        (Some(adaptive), _) => {
            let (prepared, patches, plan) = prepare_adaptive(mesh, scheme, &adaptive, refine)?;
            Ok((prepared, patches, Some(plan)))
        }
        (None, Evaluation::Subdivision) => prepare_quads(mesh, refine).map(|(prepared, plan)| (prepared, plan, None)),
        (None, _) => prepare_patches(mesh, scheme, fallback, refine).map(|(prepared, plan)| (prepared, plan, None)),
    }
}

/// Prepares `mesh` for adaptive subdivision, and plans it: as [`prepare()`], but every face becomes a quad.
///
/// # Errors
/// A refined mesh that cannot be addressed; those of [`adaptive::Plan::new`].
fn prepare_adaptive(
    mesh: &ControlMesh,
    scheme: Scheme,
    options: &AdaptiveOptions,
    levels: u32,
) -> Result<(Prepared, PatchPlan, adaptive::Plan), TableError> {
    let notice = |faces, first| Notice::RefinedToQuads { faces, first };
    let prepared = Prepared { rounds_sharpness: false, ..refine_faces(mesh, levels, |size| size != 4, notice)? };
    let (topology, cells) = (&prepared.topology, &prepared.cells);
    let plan = adaptive::Plan::new(topology, scheme, options)?;
    let is_refined = |face| is_refined(&plan, face);
    let patches = PatchPlan::new(topology, cells, scheme, Fallback::Refuse, is_refined)?;
    Ok((prepared, patches, plan))
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
    let mut prepared = Prepared::of(mesh)?;
    let mut misfits = (0..).zip(&mesh.data().face_sizes).filter(|&(_, &size)| misfit(size));
    let mut needed = levels;
    if let Some((first, _)) = misfits.next() {
        if levels == 0 {
            prepared.refined_faces = Some(notice(1 + misfits.count(), first));
        }
        needed = levels.max(1);
    }
    // Before anything is allocated. Each step makes a quad of every corner.
    let corners = 4usize.saturating_pow(needed).saturating_mul(mesh.corner_count());
    if corners > MAX_CORNERS {
        return Err(MeshError::TooLarge { what: "face corners when refined", count: corners, max: MAX_CORNERS });
    }
    if needed > MAX_LEVEL {
        let (count, max) = (needed as usize, MAX_LEVEL as usize);
        return Err(MeshError::TooLarge { what: "levels of refinement", count, max });
    }
    for _ in 0..needed {
        prepared.split_vertices += prepared.topology.split_count();
        let refined = refine(&prepared.topology)?;
        prepared.cells = prepared.cells.refined(&prepared.topology);
        prepared.steps.push(refined.stencils);
        prepared.topology = Arc::new(Topology::new(&refined.mesh));
    }
    Ok(prepared)
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
