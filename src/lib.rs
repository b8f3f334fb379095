//! Catmull-Clark control meshes, drawn smooth by Vulkan's tessellation stages.
//!
//! # Where to start
//!
//! * To draw: a [`ControlMesh`] from a file ([`read()`]), from arrays ([`MeshData`]) or built in ([`shape`]); a [`Renderer`] beside your
//!   own, to which it becomes a model ([`Renderer::add_model`], [`ModelOptions`]); then a frame after the other: see [`renderer`].
//! * The limit surface as a mesh, without a device: [`dice`].
//! * Tables for shaders of your own: [`table`]. Control points and samples on the CPU: [`Scheme`],
//!   [`table::CpuSurface`].
//!
//! # The way of a mesh to the picture
//!
//! ```text
//!  file ──► ControlMesh ──► Topology ──► patches ──► tables ──► Vulkan buffers ──► VS ─► TCS ─► TES ─► FS ──► picture
//!           mesh            topology     patch       table      renderer          glsl/construct  glsl/evaluate
//!                              │                       ▲
//!                              └── limit (refinement) ─┘
//! ```
//!
//! 1. [`mesh`]: a [`ControlMesh`], from a file ([`mesh::read`]) or from arrays ([`MeshData`]), is checked once:
//!    manifold, oriented, finite. From here on nothing about it can fail but its size.
//! 2. [`table::prepare_patches`]: a mesh with faces of five or more corners is refined once ([`limit::refine`]), so that
//!    every face is a triangle or a quad; [`Scheme::Pm`] takes pentagons as they are, and Gregory patches have such faces cut in
//!    triangles instead, which are drawn by their leaves ([`adaptive`]). The caller may ask for more steps.
//! 3. [`topology`]: every vertex gets its ordered one-ring, every face its [`PatchKind`](topology::PatchKind).
//! 4. [`patch`]: the control points of a patch are sums of the control vertices in the one-rings of its corners.
//!    The code that makes them is written once, over values that can be summed: points give control points, rows of
//!    weights give stencils.
//! 5. [`table`]: connectivity and weights, as plain arrays for the GPU. They do not depend on positions.
//! 6. [`renderer`]: the arrays become buffers of a model. The shaders make the control points from this frame's vertices, in each draw
//!    (vertex and control stage) or once when vertices moved, and evaluate them (evaluation stage), so vertices may move freely.
//!
//! Each module knows only those below it:
//!
//! | floor | module | holds | knows nothing of |
//! |---|---|---|---|
//! | 11 | `bench` (features `measure` and `headless`) | how long each way to draw takes | files, printing |
//! | 10 | `measure` (feature `measure`) | how far schemes, and triangles on the screen, are from the limit surface; whether patches meet; statistics | files, printing |
//! | 9 | [`triangles`](mod@triangles) (feature `headless`) | triangles of the CPU, drawn as the renderer shades | files, windows |
//! | 9 | `capture` (feature `headless`) | control points and evaluated vertices, read back from the GPU | files, windows |
//! | 8 | [`renderer`] | the drop-in module: models, pipelines, frames | files, windows |
//! | 7 | [`tessellator`] | tessellation factors, edges and culling, as the shaders have them | Vulkan, models |
//! | 7 | `headless` (feature `headless`) | a device of our own, without a window, for tests and tools | patches |
//! | 6 | [`table`] | what the GPU reads | Vulkan |
//! | 5 | [`adaptive`] | feature-adaptive subdivision: which cells are refined, and the sums that make their vertices | Vulkan, positions |
//! | 5 | [`dice`] | the limit surface as a mesh, on the CPU | Vulkan, files |
//! | 4 | [`limit`] | Catmull-Clark refinement and its limit surface | patch schemes |
//! | 4 | [`patch`] | construction and evaluation of patches, generic over the value | Vulkan |
//! | 3 | `blend` (public in [`patch`]) | weighted sums: values, one-rings with tangent frames, Bezier curves, the regular patch | schemes |
//! | 2 | [`topology`] | half-edges, one-rings, sharp edges, patch kinds | positions |
//! | 1 | [`mesh`] | control meshes, the readers (OBJ, PLY, glTF), repair, built-in shapes | all above |
//! | 1 | [`gpu`] | device facts, memory, shaders, pipelines | meshes |
//!
//! # Example
//!
//! The control points of one patch, and a point of it, on the CPU:
//!
//! ```
//! use ash_subdiv::{Scheme, shape, topology::Topology};
//!
//! let mesh = shape("cube")?;
//! let topology = Topology::new(&mesh);
//! let kind = topology.patch_kind(0).expect("a triangle or a quad");
//! let points = Scheme::Gregory.control_points(&topology, 0, kind, |vertex| mesh.position(vertex));
//! assert_eq!(points.len(), 20);
//! let middle = Scheme::Gregory.evaluate(kind, &points, 0.5, 0.5);
//! assert!(middle.position.length() < 1.0 && (middle.normal.length() - 1.0).abs() < 1e-12);
//! # Ok::<(), ash_subdiv::MeshError>(())
//! ```
//!
//! On the GPU: see [`renderer`], the README, and `examples/minimal.rs`, a whole program in 150 lines.
//!
//! # Conventions
//!
//! * **Numbers** of vertices, faces and face corners count from zero. A face corner and the half-edge that starts
//!   there have the same number.
//! * **Winding**: faces are counter-clockwise seen from outside; normals point outwards.
//! * **Parameters**: a quad has its corners at (u, v) = (0, 0), (1, 0), (1, 1), (0, 1); a triangle has barycentric
//!   (u, v, w), one at its corners 0, 1, 2. `gl_TessCoord` is the same.
//! * **Order of control points**: in [`patch::bicubic`], [`patch::gregory`], [`patch::acc`] and [`patch::pm`].
//! * **Vectors**: what a caller gives or keeps is arrays (meshes, views, items, positions of a frame), so any version of any maths crate
//!   serves. What the CPU computes is of the re-exported [`glam`] (`DVec3`; `Vec3` where it repeats a shader), which `into` and
//!   `to_array` turn into arrays and back.
//! * **Options** are structs with a default, written with `..Default::default()`: new fields and new choices are minor changes.
//! * **Matrices** are given by columns, as `glam::Mat4::to_cols_array_2d` gives them, and act on column vectors. World
//!   space is right-handed.
//! * **Clip space** is Vulkan's: y down, depth from 0 (near) to 1. [`View`]'s constructors make it so.
//! * **Colours** are linear RGBA. Shaders write linear values: an sRGB format encodes them.
//! * **Units**: lengths are the mesh's own; angles are radians; sizes are bytes.
//!
//! # Tolerances
//!
//! * Regular patches are the limit surface, and every patch has its positions and tangent planes at the corners,
//!   but for rounding: that of `f64` in [`patch`], that of `f32` on the GPU. Creases and corners of finite sharpness
//!   are excepted: see [`topology::SHARP_FROM`]. So is [`Scheme::Pm`], whose irregular patches have the limit position
//!   among quads only, and tangent planes of their own.
//! * Adaptive surfaces ([`ModelOptions::adaptive`]) are the limit surface but for rounding outside of end caps, and have the
//!   sharpness that was authored: see [`adaptive`].
//! * Irregular patches lie off the limit surface between their corners. On the two character meshes of Loop et al.
//!   2009, an independent implementation of the same patches in `f64` measures, as root mean squares over all faces,
//!   2e-5 to 4e-5 of the diagonal (nearest distance) and half a degree (normal).
//! * Neighbouring patches share their edge curve and tangent planes along it (G1; [`Scheme::Acc`]: shading normals).
//!   The GPU evaluates the curve once for each patch: with Gregory patches, fitted or not, to the same bits in every
//!   construction; with other schemes to rounding. Normals agree to rounding, and to the bit with
//!   [`ModelOptions::shared_normals`]. Where faces fall back to Gregory patches
//!   ([`Fallback`]), they share their edge curves with patches of another scheme, too, but not all tangent planes
//!   ([`patch::FallbackRings`]).
//! * The constructions on the GPU ([`Construction`]) make the same control points but for rounding.
//!
//! # Where the formulas come from
//!
//! * Loop, Schaefer, Ni, Castaño, *Approximating Subdivision Surfaces with Gregory Patches for Hardware
//!   Tessellation*, 2009: the patches, their constructions, and the division of work among the shader stages.
//! * Loop, Schaefer, *Approximating Catmull-Clark Subdivision Surfaces with Bicubic Patches*, 2008: [`Scheme::Acc`].
//! * Myles, Ni, Peters, *Fast Parallel Construction of Smooth Surfaces from Meshes with Tri/Quad/Pent Facets*, 2008, and
//!   Ni, Yeo, Myles, Goel, Peters, *GPU smoothing of quad meshes*, 2008: [`Scheme::Pm`] and [`Scheme::CPatch`].
//! * Niessner, Loop, Meyer, DeRose, *Feature-adaptive GPU rendering of Catmull-Clark subdivision surfaces*, 2012, Niessner, Loop,
//!   Greiner, *Efficient evaluation of semi-smooth creases in Catmull-Clark subdivision surfaces*, 2012, and Brainerd, Foley,
//!   Kraemer, Moreton, Niessner, *Efficient GPU rendering of subdivision surfaces using adaptive quadtrees*, 2016:
//!   [`adaptive`] surfaces.
//! * Antal, Szécsi, Premecz, Csonka, *Catmull-Clark subdivision for geometry shaders*, 2007: subdivision of single faces on the
//!   GPU ([`Evaluation::Subdivision`](renderer::Evaluation::Subdivision)).
//! * Catmull, Clark, *Recursively generated B-spline surfaces on arbitrary topological meshes*, 1978: the surface.
//! * Halstead, Kass, DeRose, *Efficient, fair interpolation using Catmull-Clark surfaces*, 1993: limit positions
//!   and tangents at vertices.
//! * Hoppe et al., *Piecewise smooth surface reconstruction*, 1994, and DeRose, Kass, Truong, *Subdivision surfaces in
//!   character animation*, 1998: creases, corners, and their sharpness.
//! * Biermann, Levin, Zorin, *Piecewise smooth subdivision surfaces with normal control*, 2000: tangents across
//!   boundaries and creases.
//! * Tags and their defaults (boundary and crease rules, sharpness 10 as infinite) are those of OpenSubdiv.
//!
//! Comments say "patch_maths" for the collection of these formulas, corrected and checked, that the code was written
//! from.

#![warn(missing_docs)]

pub mod adaptive;
#[cfg(all(feature = "measure", feature = "headless"))]
pub mod bench;
mod blend;
#[cfg(feature = "headless")]
pub mod capture;
mod constants;
pub mod dice;
pub mod gpu;
#[cfg(feature = "headless")]
pub mod headless;
pub mod limit;
#[cfg(feature = "measure")]
pub mod measure;
pub mod mesh;
mod named;
pub mod patch;
pub mod renderer;
pub mod table;
pub mod tessellator;
pub mod topology;
#[cfg(feature = "headless")]
pub mod triangles;

pub use glam;
pub use gpu::{Allocator, ContextOptions, DeviceContext, Spacing};
#[cfg(feature = "gltf")]
pub use mesh::GltfOptions;
pub use mesh::read;
pub use mesh::{
    ControlMesh, MeshData, MeshError, ObjOptions, ReadOptions, ShapeInfo, grid_torus, replicate, shape, shapes,
};
pub use patch::{Fallback, Scheme};
pub use renderer::{
    Construction, DevicePositions, DrawItem, Error, Frame, Instance, Instances, ModelId, ModelOptions, Options,
    Renderer, Style, Target, View, check, requirements,
};

/// The examples of the README and of the pages under `docs/`, compiled as tests.
#[cfg(doctest)]
mod pages {
    #[doc = include_str!("../README.md")]
    pub struct ReadMe;
    #[doc = include_str!("../docs/drawing.md")]
    pub struct Drawing;
    #[doc = include_str!("../docs/meshes.md")]
    pub struct Meshes;
    #[doc = include_str!("../docs/animation.md")]
    pub struct Animation;
    #[doc = include_str!("../docs/tessellate.md")]
    pub struct Tessellate;
}
