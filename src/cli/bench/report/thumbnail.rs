//! A small picture of each mesh.

use super::super::super::error::CliError;
use super::super::super::picture::unpremultiply;
use ash::vk;
use ash_subdiv::bench::Subject;
use ash_subdiv::headless::{Headless, Offscreen, OffscreenDesc};
use ash_subdiv::{DrawItem, ModelOptions, Options, Renderer, Target, View};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use std::io::Cursor;

/// Pixels along each side; shown at half the size.
const SIDE: u32 = 320;

/// The picture of what is raced, as a `data:` address.
pub(in super::super) fn thumbnail(headless: &Headless, subject: &Subject) -> Result<String, CliError> {
    let most = headless.properties().sample_counts().into_iter().filter(|&count| count <= 4).max().unwrap_or(1);
    let samples = vk::SampleCountFlags::from_raw(most);
    let desc = OffscreenDesc { samples, ..OffscreenDesc::new(SIDE, SIDE) };
    let target = Offscreen::new(headless, &desc)?;
    let render_target = Target::dynamic(desc.color, desc.depth, desc.samples);
    // SAFETY: no handles of ours are given; every submission is waited for, so the renderer is dropped when idle.
    let mut renderer = unsafe { Renderer::new(headless.context(), &render_target, &Options::default())? };
    let options = ModelOptions { name: subject.name.clone(), refine: subject.refine, ..ModelOptions::default() };
    let model = renderer.add_model(&subject.mesh, &options)?;
    let view = View::framing(subject.mesh.bounds(), [-0.5, 0.3, 1.0], 1.0);
    // SAFETY: there was no frame before.
    let frame = unsafe { renderer.begin_frame() };
    // SAFETY: the command buffer is being recorded, outside rendering.
    headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, frame) })?;
    let item = DrawItem::new(model, 4.0).color([0.72, 0.64, 0.55, 1.0]);
    let mut pixels = target.draw(headless, [0.0; 4], |cmd| {
        // SAFETY: inside rendering that fits the target, after the frame was prepared.
        unsafe { renderer.cmd_draw(cmd, frame, &view, &[item]) }
    })?;
    unpremultiply(&mut pixels, true);
    let mut png = Cursor::new(Vec::new());
    image::write_buffer_with_format(
        &mut png,
        &pixels,
        SIDE,
        SIDE,
        image::ExtendedColorType::Rgba8,
        image::ImageFormat::Png,
    )
    .map_err(|e| CliError::Work(format!("{}: its picture can't be made: {e}", subject.name)))?;
    Ok(format!("data:image/png;base64,{}", BASE64_STANDARD.encode(png.into_inner())))
}
