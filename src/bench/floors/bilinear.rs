//! The tessellation stages at their least: corners pass through, faces stay bilinear.

use super::{Input, Kit, device_buffer};
use crate::bench::BenchError;
use crate::bench::drawable::{Drawable, Frame, Lane, Setup, timed};
use crate::bench::shaders;
use crate::gpu::{Buffer, Domain, Owned, Shader, Spacing, Specialization, tessellated_vertices};
use crate::patch::{Fallback, Scheme};
use crate::renderer::{DrawConstants, TableBytes, reads_texels, spaced};
use crate::table::{TableError, prepare};
use crate::topology::PatchKind;
use ash::vk;

pub(crate) struct Bilinear {
    kit: Kit,
    spacing: Spacing,
    /// Regular and irregular quads together, then triangles; those that there are.
    kinds: Vec<Kind>,
    positions: Buffer,
    corners: Buffer,
    setup: Setup,
}

struct Kind {
    corners: u32,
    patches: u32,
    first_corner: u32,
    pipelines: [Owned<vk::Pipeline>; 2],
}

impl Bilinear {
    pub(crate) fn new(lane: Lane) -> Result<Self, BenchError> {
        let Lane { headless, subject, spacing, .. } = lane;
        let ((positions, corners, plan), tables) = timed(|| {
            let prepared = prepare(&subject.mesh, subject.refine)?;
            let plan = prepared.plan(Scheme::Gregory, Fallback::Refuse).map_err(TableError::from)?;
            let face_vertices = &prepared.mesh().data().face_vertices;
            let corners = plan.corners(prepared.topology()).into_iter().map(|h| face_vertices[h as usize]);
            let corners: Vec<u32> = corners.collect();
            let positions: Vec<_> = prepared.mesh().positions_f32().iter().map(|&[x, y, z]| [x, y, z, 0.0]).collect();
            Ok::<_, BenchError>((positions, corners, plan))
        })?;
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
        let ((positions, corners), upload) = timed(|| {
            let positions = device_buffer(headless, "bilinear positions", storage, &positions)?;
            Ok::<_, BenchError>((positions, device_buffer(headless, "bilinear corners", storage, &corners)?))
        })?;
        let kit = Kit::new(headless, [&positions, &corners])?;
        let quads = plan.count(PatchKind::Regular) + plan.count(PatchKind::IrregularQuad);
        let all = [(PatchKind::IrregularQuad, quads, 0), {
            let kind = PatchKind::Triangle;
            (kind, plan.count(kind), 4 * quads)
        }];
        let (kinds, pipelines) = timed(|| {
            let kinds = all.into_iter().filter(|&(_, patches, _)| patches > 0);
            let kinds = kinds.map(|(kind, patches, first_corner)| {
                let corners = kind.corners() as u32;
                let specialization = [Specialization::uint(0, corners), reads_texels(headless.properties())];
                let [control, evaluation] = stages(kind);
                let evaluation = spaced(evaluation, spacing);
                let stages = [
                    Shader::vertex(shaders::BILINEAR_VERT).specialized(&specialization),
                    Shader::tess_control(control),
                    Shader::tess_evaluation(&evaluation),
                ];
                let input = Input { patch_control_points: corners, ..Input::default() };
                let pipelines = kit.pipelines(lane, &stages, &input)?;
                Ok::<_, BenchError>(Kind { corners, patches, first_corner, pipelines })
            });
            kinds.collect::<Result<Vec<_>, _>>()
        })?;
        let setup = Setup { tables, upload, pipelines, ..Setup::default() };
        Ok(Self { kit, spacing, kinds, positions, corners, setup })
    }
}

/// The control and the evaluation shader.
fn stages(kind: PatchKind) -> [&'static [u32]; 2] {
    use shaders::*;
    match kind {
        PatchKind::Triangle => [BILINEAR_TESC_TRIANGLE, BILINEAR_TESE_TRIANGLE],
        _ => [BILINEAR_TESC, BILINEAR_TESE],
    }
}

impl Drawable for Bilinear {
    unsafe fn cmd_draw(&mut self, cmd: vk::CommandBuffer, frame: &Frame) -> Result<(), BenchError> {
        let max = self.kit.context.properties().max_tessellation_level;
        let factor = frame.factor.min(max as f32);
        // SAFETY: as the caller promises.
        unsafe { self.kit.write_frame(frame, factor)? };
        let properties = self.kit.context.properties();
        for kind in &self.kinds {
            let domain = if kind.corners == 3 { Domain::Triangles } else { Domain::Quads };
            let vertices = tessellated_vertices(domain, self.spacing, factor, max);
            // SAFETY: as the caller promises.
            unsafe { self.kit.cmd_bind_pipeline(cmd, &kind.pipelines, frame) };
            for instance in 0..frame.instances.len() {
                // SAFETY: as the caller promises.
                unsafe { self.kit.cmd_bind(cmd, instance) };
                let mut constants = DrawConstants::new(0);
                constants.first_corner = kind.first_corner;
                for draw in properties.patch_batch.draws(kind.patches, kind.corners, vertices) {
                    constants.patches_per_instance = draw.patches_per_instance;
                    // SAFETY: as the caller promises.
                    unsafe {
                        self.kit.cmd_push(cmd, &constants);
                        let (count, instances, first) = (draw.vertex_count, draw.instance_count, draw.first_instance);
                        self.kit.context.device().cmd_draw(cmd, count, instances, 0, first);
                    }
                }
            }
        }
        Ok(())
    }

    fn setup(&self) -> Setup {
        self.setup
    }

    fn bytes(&self) -> Vec<TableBytes> {
        vec![("positions", self.positions.size()), ("patch_corners", self.corners.size())]
    }

    fn control_point_bytes(&self) -> u64 {
        self.kinds.iter().map(|kind| 12 * u64::from(kind.corners) * u64::from(kind.patches)).sum()
    }
}
