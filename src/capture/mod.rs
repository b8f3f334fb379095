//! Capture: results of the stages before rasterization, written to a buffer by the shaders and read back: control points,
//! samples on a grid, every evaluated vertex, and the triangles between them. For tests, `subdiv patches`, `subdiv sample` and
//! `subdiv screen`.

mod buffer;
mod draws;
mod watch;

use crate::adaptive::DrawnBy;
use crate::gpu::{Domain, PatchBatch, tessellated_vertices};
use crate::headless::Headless;
use crate::mesh::ControlMesh;
use crate::renderer::{
    Capture, Cull, DevicePositions, DisplacementId, DisplacementMap, Error, Evaluation, Factor, ModelOptions,
    ModelTables, ShaderId, View,
};
#[cfg(doc)]
use crate::renderer::{Options, Renderer};
use crate::table::{MAX_SEGMENTS, uniform_grid_vertices};
use crate::topology::PatchKind;
use buffer::{CONTROL_POINT_WORDS, EDGES_ONLY, FACTOR_WORDS, Head, RECORD_BYTES};
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
#[cfg(feature = "measure")]
pub(crate) use watch::Idle;

/// A vertex as the evaluation shader computed it, in object space.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct CapturedVertex {
    /// (u, v, 0) of a quad, (u, v, w) of a triangle or a piece of a pentagon.
    pub coordinate: [f32; 3],
    /// The number of the patch in the order of [`ModelTables::plan`].
    pub patch: u32,
    /// Object space.
    pub position: [f32; 3],
    /// Normal of length one, towards the side from which the patch is counter-clockwise.
    pub normal: [f32; 3],
}

/// Which vertices of a draw are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Which {
    /// Every vertex.
    All,
    /// Vertices on the edges and corners of patches.
    OnEdges,
}

/// The factors of a patch as the control shader made them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CapturedFactors {
    /// Factor that each edge asks for, from the first corner's plus edge on, not yet within limits; the last is nothing for triangles.
    pub asked: [f32; 4],
    /// The inner factors; the second is nothing for triangles.
    pub inner: [f32; 2],
    /// Whether the patch is culled.
    pub culled: bool,
}

/// Draw of the watched model.
#[derive(Debug, Clone, PartialEq)]
pub struct CaptureDraw {
    /// View for factors in pixels and for culling.
    pub view: View,
    /// The factors.
    pub factor: Factor,
    /// Factors of edges, for [`Factor::Edges`]; else empty.
    pub edge_factors: Vec<f32>,
    /// Patches that are culled.
    pub cull: Cull,
    /// Scale and bias of the displacement.
    pub displacement: [f32; 2],
}

impl CaptureDraw {
    /// All patches with these factors, from nowhere in particular.
    pub fn new(factor: impl Into<Factor>) -> Self {
        Self {
            view: View::framing([glam::DVec3::NEG_ONE, glam::DVec3::ONE], [0.0, 0.0, 1.0], 1.0).sized(256, 256),
            factor: factor.into(),
            edge_factors: Vec::new(),
            cull: Cull::NONE,
            displacement: [0.0; 2],
        }
    }
}

/// A model whose stages before rasterization can be watched: those of tessellation, but for [`Captured::vertices`] also those
/// of other evaluations ([`ModelOptions::evaluation`]) that have them.
///
/// The device keeps some of the pipelines for the next capture with options that need the same ones, of this model or another.
pub struct Captured<'h> {
    headless: &'h Headless,
    options: ModelOptions,
    tables: ModelTables,
    positions: Vec<[f32; 3]>,
    given: Option<DevicePositions>,
    displacement: Option<DisplacementMap>,
    shaders: Vec<(ShaderId, Vec<u32>)>,
}

impl<'h> Captured<'h> {
    /// Builds the tables of a model. Of [`Evaluation::Subdivision`] there is nothing but [`Captured::grid`], of as many samples as
    /// one of its levels has; of [`Evaluation::GeometryTwoPass`] nothing but [`Captured::vertices_of`].
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device cannot write buffers before rasterization, and as
    /// [`Renderer::add_model`].
    pub fn new(headless: &'h Headless, mesh: &ControlMesh, options: &ModelOptions) -> Result<Self, Error> {
        if !headless.context().features().vertex_stores {
            let device = headless.properties().name.clone();
            return Err(Error::Unsupported { device, missing: vec!["vertexPipelineStoresAndAtomics".into()] });
        }
        // For grids of patches by leaves.
        let by_leaves = options.adaptive.is_some_and(|adaptive| adaptive.drawn_by == DrawnBy::Leaves);
        let options = ModelOptions { edge_factors: options.edge_factors || by_leaves, ..options.clone() };
        let tables = ModelTables::new(mesh, &options)?;
        let positions = mesh.positions_f32();
        Ok(Self { headless, options, tables, positions, given: None, displacement: None, shaders: Vec::new() })
    }

    /// A model with a displacement map.
    ///
    /// # Errors
    /// As [`Captured::new`]; a mesh without texture coordinates.
    ///
    /// # Safety
    /// As [`Renderer::add_displacement`]; the map lives as long as this.
    pub unsafe fn displaced(
        headless: &'h Headless,
        mesh: &ControlMesh,
        options: &ModelOptions,
        map: DisplacementMap,
    ) -> Result<Self, Error> {
        // The first map of a renderer.
        let options = ModelOptions { displacement: Some(DisplacementId::FIRST), ..options.clone() };
        Ok(Self { displacement: Some(map), ..Self::new(headless, mesh, &options)? })
    }

    /// Replaces shaders of the crate: see [`Options::shaders`].
    pub fn with_shaders(self, shaders: Vec<(ShaderId, Vec<u32>)>) -> Self {
        Self { shaders, ..self }
    }

    /// With positions of the device.
    ///
    /// # Safety
    /// As [`Renderer::set_device_positions`]; the buffer lives as long as this, and nothing writes it any more.
    pub unsafe fn with_device_positions(self, positions: DevicePositions) -> Self {
        Self { given: Some(positions), ..self }
    }

    /// The arrays that the shaders read, with the order of the patches.
    pub fn tables(&self) -> &ModelTables {
        &self.tables
    }

    /// The control points of every patch, as the control shader made them, in the orders of [`crate::patch`].
    ///
    /// # Errors
    /// Failed Vulkan calls; tables larger than a shader of the device can see.
    pub fn control_points(&self) -> Result<Vec<Vec<[f32; 3]>>, Error> {
        let words = self.capture_patches(&CaptureDraw::new(1.0))?;
        let patches = self.tables.plan().patches().iter();
        let points = patches.zip(words.chunks_exact(CONTROL_POINT_WORDS + FACTOR_WORDS)).map(|(patch, words)| {
            let mut points = vec![[0.0; 3]; patch.scheme.points(patch.kind)];
            // The shaders count them corner by corner.
            let slots = (0..patch.kind.corners()).flat_map(|k| patch.scheme.corner_slots(patch.kind, k));
            slots.zip(words.chunks_exact(3)).for_each(|(slot, p)| points[slot] = [p[0], p[1], p[2]]);
            points
        });
        Ok(points.collect())
    }

    /// The factors of every patch, in the order of [`ModelTables::plan`].
    ///
    /// # Errors
    /// As [`Renderer::cmd_draw`] and [`Renderer::set_edge_factors`].
    pub fn factors(&self, draw: &CaptureDraw) -> Result<Vec<CapturedFactors>, Error> {
        let words = self.capture_patches(draw)?;
        let factors = words.chunks_exact(CONTROL_POINT_WORDS + FACTOR_WORDS).map(|words| {
            let w = &words[CONTROL_POINT_WORDS..];
            CapturedFactors { asked: [w[0], w[1], w[2], w[3]], inner: [w[4], w[5]], culled: w[6] != 0.0 }
        });
        Ok(factors.collect())
    }

    /// Words that the control shader writes for each patch.
    fn capture_patches(&self, draw: &CaptureDraw) -> Result<Vec<f32>, Error> {
        let words = self.capture(
            Capture::Points,
            draw,
            |_| 4 * (CONTROL_POINT_WORDS + FACTOR_WORDS) as u64,
            |patches| Head { first_patch: patches.start, patches: patches.len() as u32, ..Head::zeroed() },
        )?;
        Ok(words.into_iter().flat_map(|(_, words)| words).collect())
    }

    /// Every patch on a grid of `n` samples along each side, in the order of
    /// [`grid_parameters`](crate::table::grid_parameters).
    ///
    /// # Errors
    /// [`Error::BadGrid`] unless `n` is from 2 to one more than the largest tessellation factor.
    pub fn grid(&self, n: u32) -> Result<Vec<Vec<CapturedVertex>>, Error> {
        let max = self.headless.properties().max_tessellation_level + 1;
        if !(2..=max).contains(&n) {
            return Err(Error::BadGrid { given: n, max });
        }
        let places = |kind: PatchKind| if kind.is_triangular() { n * (n + 1) / 2 } else { n * n };
        let bytes = |kind| u64::from(places(kind)) * RECORD_BYTES;
        let factor = (n - 1) as f32;
        // By leaves, a factor for all is that of whole faces.
        let edges = self.tables.edges().filter(|_| self.tables.options().is_by_leaves());
        let draw = match edges.map(|edges| vec![factor; edges.records.len()]) {
            Some(edge_factors) => CaptureDraw { edge_factors, ..CaptureDraw::new(Factor::Edges(1.0)) },
            None => CaptureDraw::new(factor),
        };
        let captured = self.capture(Capture::Grid, &draw, bytes, |patches| Head {
            first_patch: patches.start,
            patches: patches.len() as u32,
            grid: n,
            capacity: u32::MAX,
            count: 0,
        })?;
        let mut grids = Vec::with_capacity(self.tables.plan().patches().len());
        for (kind, words) in captured {
            let records: &[CapturedVertex] = bytemuck::cast_slice(&words);
            grids.extend(records.chunks_exact(places(kind) as usize).map(<[_]>::to_vec));
        }
        Ok(grids)
    }

    /// Every vertex that the tessellator made with this factor and the model's spacing, or the vertices of the uniform grid that the
    /// model is evaluated on, in no order.
    ///
    /// A device may evaluate a vertex more than once; then it is there more than once.
    ///
    /// # Errors
    /// [`Error::BadFactor`]; failed Vulkan calls; tables larger than a shader of the device can see.
    pub fn vertices(&self, factor: f32) -> Result<Vec<CapturedVertex>, Error> {
        self.vertices_of(&CaptureDraw::new(factor), Which::All)
    }

    /// The vertices of a draw, all or those on edges only.
    ///
    /// # Errors
    /// As [`Renderer::cmd_draw`] and [`Renderer::set_edge_factors`].
    pub fn vertices_of(&self, draw: &CaptureDraw, which: Which) -> Result<Vec<CapturedVertex>, Error> {
        let max = self.headless.properties().max_tessellation_level;
        let tessellated = self.evaluation(Capture::Vertices) == Evaluation::Tessellation;
        let bytes = |most: f32, kind: PatchKind| {
            let segments = match tessellated {
                true => self.options.spacing.segments(most, max),
                false => (most.ceil() as u32).min(MAX_SEGMENTS),
            };
            let domain = if kind.is_triangular() { Domain::Triangles } else { Domain::Quads };
            let vertices = match which {
                Which::All if !tessellated => uniform_grid_vertices(kind, segments),
                Which::All => tessellated_vertices(domain, self.options.spacing, most, max).into(),
                Which::OnEdges => 4 * (u64::from(segments) + 1),
            };
            // At worst a device shares nothing between the triangles of a patch.
            let shares = tessellated && self.headless.properties().patch_batch == PatchBatch::LAVAPIPE;
            if shares { vertices * RECORD_BYTES } else { 6 * vertices * RECORD_BYTES }
        };
        // Factors that only the device knows take pipelines of their own to be captured: not where there is room for the largest.
        let has_room = |kind| self.windows(kind, bytes(max as f32, kind)).count() <= 1;
        let most = match known_factor(draw) {
            Some(most) => most,
            None if tessellated && PatchKind::ALL.into_iter().all(has_room) => max as f32,
            None => self.captured_factor(draw)?,
        };
        let mut vertices = Vec::new();
        let captured = self.capture(
            Capture::Vertices,
            draw,
            |kind| bytes(most, kind),
            |patches| Head {
                first_patch: patches.start,
                patches: patches.len() as u32,
                grid: match which {
                    Which::All => 0,
                    Which::OnEdges => EDGES_ONLY,
                },
                capacity: u32::MAX,
                count: 0,
            },
        )?;
        for (_, words) in captured {
            vertices.extend_from_slice(bytemuck::cast_slice(&words));
        }
        Ok(vertices)
    }

    /// Every triangle that the tessellator makes in a draw: `see` is given those of some patches after the other, all of a
    /// patch at once, else in no order. Vertices are in the order of the triangle's winding.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device has no geometry shaders; as [`Renderer::cmd_draw`] and
    /// [`Renderer::set_edge_factors`]; those of `see`.
    pub fn triangles(
        &self,
        draw: &CaptureDraw,
        mut see: impl FnMut(&[[CapturedVertex; 3]]) -> Result<(), Error>,
    ) -> Result<(), Error> {
        if !self.headless.context().features().geometry {
            let device = self.headless.properties().name.clone();
            return Err(Error::Unsupported { device, missing: vec!["geometryShader".into()] });
        }
        let segments = self.options.spacing.segments(
            known_factor(draw).map_or_else(|| self.captured_factor(draw), Ok)?,
            self.headless.properties().max_tessellation_level,
        );
        // Those of a quad; triangles have fewer.
        let bytes = 2 * u64::from(segments).pow(2) * 3 * RECORD_BYTES;
        let head = |patches: &Range<u32>| Head {
            first_patch: patches.start,
            patches: patches.len() as u32,
            grid: 0,
            capacity: (patches.len() as u64 * bytes / RECORD_BYTES) as u32,
            count: 0,
        };
        self.capture_each(Capture::Triangles, draw, |_| bytes, head, |_, words| see(bytemuck::cast_slice(&words)))
    }

    /// The evaluation that is watched.
    fn evaluation(&self, mode: Capture) -> Evaluation {
        match self.options.evaluation {
            Evaluation::Subdivision => Evaluation::Subdivision,
            evaluation if mode == Capture::Vertices && evaluation != Evaluation::Compute => evaluation,
            _ => Evaluation::Tessellation,
        }
    }

    /// The largest factor that an edge asks for, as the device finds it.
    fn captured_factor(&self, draw: &CaptureDraw) -> Result<f32, Error> {
        Ok(self.factors(draw)?.iter().flat_map(|f| f.asked).fold(1.0, f32::max))
    }
}

/// The largest factor that an edge asks for, where it does not depend on the view.
fn known_factor(draw: &CaptureDraw) -> Option<f32> {
    match draw.factor {
        Factor::Uniform(factor) => Some(factor),
        Factor::Edges(scale) => Some(draw.edge_factors.iter().fold(1.0, |most, factor| (scale * factor).max(most))),
        _ => None,
    }
}
