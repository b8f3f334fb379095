//! The drop-in Vulkan module.
//!
//! The caller owns instance, device, queues, allocator, command buffers and render targets; this module only records.
//!
//! One frame:
//!
//! 1. The caller waits until the submission of the frame that began [`Options::frames_in_flight`] frames ago is done, as always before
//!    using again what belongs to a frame in flight; then [`Renderer::begin_frame`].
//! 2. [`Renderer::set_positions`] writes this frame's control vertices, if they move; or [`Renderer::set_device_positions`] says where
//!    the device wrote them.
//! 3. [`Renderer::cmd_prepare`], outside rendering, records the copies and barriers.
//! 4. [`Renderer::cmd_draw`], inside rendering, records the draws of one view: for every model its regular patches,
//!    irregular quads and triangles. As often as there are views. Or, to draw only what can be seen,
//!    [`Renderer::cmd_cull`] outside rendering and [`Renderer::cmd_draw_visible`] inside.
//! 5. The caller submits; or, if it cannot, tells [`Renderer::frame_lost`].
//!
//! Passes into other attachments, such as shadows, are draws in styles with a target of their own ([`Style::target`]), of the
//! same models: what compute made of them is there for all. [`View::measured_from`] has a shadow be of the triangles that the eye
//! sees, [`VisibleItems::in_style`] draws what one search found in several passes that show its view.
//!
//! | pass | reads | writes |
//! |---|---|---|
//! | copies | staging buffers | tables, positions; indices of the control mesh if a style draws it |
//! | compute, positions of the device | the caller's buffer | positions, if the device gives them |
//! | compute, refinement | positions, sums | vertices of adaptive surfaces and, if the device is to, of refined meshes, if the vertices moved |
//! | compute, cached | rings and their weights, positions | a frame for each ring, if the vertices moved |
//! | compute, cached | those, patch corners, rings, positions | control points, and what corners share |
//! | compute, evaluation | control points, what corners share | vertices of models that are [`Evaluation::Compute`]: of those, the draws have only VS and FS |
//! | compute, culling | control points, or what the construction makes them of; the view, factors of edges | which patches can be seen: lists and indirect draws of them, and for instances copies of what is kept of them |
//! | GS, two passes | vertices and weights of the patches, positions | control points of models that are [`Evaluation::GeometryTwoPass`], if the vertices moved |
//! | VS, evaluated | vertices; the displacement map | position, normal, texture coordinate |
//! | VS, instanced | lists of patches; control points, what corners share; the displacement map | position, normal, texture coordinate of models that are [`Evaluation::Instanced`] (or of two passes), which have only FS besides |
//! | GS | vertices and weights of the patch, positions; or control points | strips of models that are [`Evaluation::Geometry`], which have only VS (the number of a tile) and FS besides |
//! | VS, two-stage | lists of patches, patch corners, rings and their weights, positions | what a corner of a patch takes from its ring: limit point, edge vectors, transversals and the like, what it shares |
//! | VS, stencil and cached | lists of patches | the number of the patch, for each patch |
//! | TCS, two-stage | what its corners took from their rings | control points, factors |
//! | TCS, stencil | vertices and weights of the patch, positions | control points, factors |
//! | TCS, cached | control points, what corners share; displaced, frames | those, levels of the map, factors |
//! | GS of models that are [`Evaluation::Subdivision`] | fans and their weights, positions | position, normal, texture coordinate; no TCS and TES |
//! | TES | control points, the view | position, normal, texture coordinate |
//! | FS | those, the view | the caller's attachments; none of ours where there are none |
//!
//! Positions, rings, their weights and what is kept of them are texel buffers where the device has large ones, else storage buffers
//! ([`DeviceProperties::reads_texels`](crate::gpu::DeviceProperties::reads_texels)).
//!
//! What shaders know of an item (transform, colours, factor, displacement, four words of yours) is a record in a buffer of the frame;
//! pushed is only what changes from draw to draw of it, such as where its patches start: for all stages.

mod construct;
mod evaluate;
mod frame;
mod model;
mod options;
mod pipelines;
mod shader;

pub use crate::table::{Construction, EdgeTable, Evaluation, ModelTables, TableBytes, TableOptions};
pub use frame::segments::EvaluatedVertices;
pub use frame::visible::VisibleItems;
pub use frame::{Frame, Renderer};
pub use options::{
    ColorEncoding, Cull, DevicePositions, DisplacementId, DisplacementMap, DrawItem, Error, Factor, Fragment, Geometry,
    Instance, Instances, MeasuredFrom, MemoryUsage, ModelId, ModelOptions, Options, Pass, Style, Target, View,
};
pub use pipelines::{Requirements, check, requirements};
pub use shader::ShaderId;

#[cfg(feature = "headless")]
pub(crate) use shader::Capture;
#[cfg(feature = "headless")]
pub(crate) use shader::{DrawConstants, ItemRecord, STAGES, ViewData, without_instances};
#[cfg(all(feature = "measure", feature = "headless"))]
pub(crate) use {
    evaluate::{subdivision::level as subdivision_level, topology},
    options::is_size,
    shader::{reads_texels, spaced},
};
