//! Pictures of vertices that the CPU evaluates.

use super::super::error::CliError;
use super::super::output::Progress;
use super::RenderArgs;
use super::args::STRIPES;
use super::draw::Picture;
use ash::vk;
use ash_subdiv::dice::{DiceOptions, MAX_DEPTH, Tessellation};
use ash_subdiv::headless::{Headless, Offscreen, OffscreenDesc};
use ash_subdiv::topology::Topology;
use ash_subdiv::triangles::{Triangles, TrianglesItem};
use ash_subdiv::{ControlMesh, View};
use glam::Mat4;

/// What draws a mesh as points of its limit surface.
pub(super) struct Diced<'h> {
    headless: &'h Headless,
    target: Offscreen,
    tessellation: Tessellation,
    triangles: Triangles,
    /// One a style.
    items: Vec<TrianglesItem>,
    background: [f32; 4],
}

impl<'h> Diced<'h> {
    pub(super) fn new(
        args: &RenderArgs,
        headless: &'h Headless,
        picture: &Picture,
        mesh: &ControlMesh,
        progress: &Progress,
    ) -> Result<Self, CliError> {
        let factor = args.factor.factor;
        let depth = (1..=MAX_DEPTH).find(|&depth| (1 << depth) as f32 >= factor).unwrap_or(MAX_DEPTH);
        if (1 << depth) as f32 != factor {
            let segments = 1 << depth;
            progress.note(format!("--evaluation cpu: edges have {segments} segments, the next power of two from 2 up"));
        }
        let tessellation = Tessellation::new(&Topology::new(mesh), &DiceOptions::fixed(depth))?;
        let [width, height] = picture.size;
        let samples = vk::SampleCountFlags::from_raw(picture.samples);
        let desc = OffscreenDesc { samples, color: args.shading.format(), ..OffscreenDesc::new(width, height) };
        let target = Offscreen::new(headless, &desc)?;
        let words = [args.stripes.unwrap_or(STRIPES), 0, 0, 0];
        let transform = Mat4::IDENTITY.to_cols_array_2d();
        let colours = args.shading.colours().into_iter().enumerate();
        let items = colours.map(|(style, colour)| TrianglesItem { style, transform, colour, words }).collect();
        let (vertices, faces) = (tessellation.positions().len(), tessellation.all_triangles());
        let mut triangles = Triangles::new(headless, &desc, &args.shading.styles(false), vertices, &faces)?;
        // SAFETY: nothing was drawn.
        unsafe { triangles.set_vertices(tessellation.positions(), tessellation.normals())? };
        Ok(Self { headless, target, tessellation, triangles, items, background: args.clear_colour() })
    }

    /// Draws a picture: see [`Drawing::draw`](super::draw::Drawing::draw).
    pub(super) fn draw(&mut self, view: &View, positions: Option<&[[f32; 3]]>) -> Result<Vec<u8>, CliError> {
        let Self { headless, target, tessellation, triangles, items, background } = self;
        if let Some(positions) = positions {
            tessellation.update(positions)?;
            // SAFETY: every submission before was waited for.
            unsafe { triangles.set_vertices(tessellation.positions(), tessellation.normals())? };
        }
        // SAFETY: likewise.
        unsafe { triangles.set_items(view, items)? };
        target.draw(headless, *background, |cmd| {
            // SAFETY: inside rendering that fits the target.
            unsafe { triangles.cmd_draw(cmd) };
            Ok::<(), CliError>(())
        })
    }
}
