//! The limit surface with vertices of the CPU.

use super::drawable::{Drawable, Frame, Lane, Pass, Setup, timed};
use super::{BenchError, Motion};
use crate::dice::{DiceOptions, MAX_DEPTH, Tessellation};
use crate::gpu::{GpuError, Spacing};
use crate::renderer::{Style, TableBytes};
use crate::topology::Topology;
use crate::triangles::{Triangles, TrianglesItem};
use ash::vk;

pub(super) struct Cpu<'a> {
    lane: Lane<'a>,
    topology: Topology,
    control: Vec<[f32; 3]>,
    drawn: Option<(Tessellation, Triangles)>,
    setup: Setup,
}

impl<'a> Cpu<'a> {
    pub(super) fn new(lane: Lane<'a>) -> Result<Self, BenchError> {
        if lane.spacing != Spacing::Equal {
            return Err(unsupported(format!("{} spacing: theirs is equal", lane.spacing.name())));
        }
        let mesh = &lane.subject.mesh;
        let (topology, control) = (Topology::new(mesh), mesh.positions_f32());
        Ok(Self { lane, topology, control, drawn: None, setup: Setup::default() })
    }
}

/// What the arrays cannot do.
fn unsupported(why: impl ToString) -> BenchError {
    GpuError::Unsupported { object: "vertices of the CPU".into(), why: why.to_string() }.into()
}

impl Drawable for Cpu<'_> {
    fn set_factor(&mut self, factor: f32) -> Result<(), BenchError> {
        self.drawn = None;
        let Lane { headless, target, subject, cull, .. } = self.lane;
        let depth = (1..=MAX_DEPTH).find(|&depth| (1 << depth) as f32 >= factor);
        let depth = depth.ok_or_else(|| unsupported(format!("factor {factor} is more than 2^{MAX_DEPTH}")))?;
        // As many segments as the refined faces have, from which the others make their patches.
        let options = DiceOptions::fixed(depth + subject.refine);
        let (tessellation, tables) = timed(|| Tessellation::<f32>::new(&self.topology, &options).map_err(unsupported))?;
        let style = |rasterizer_discard| Style { cull, rasterizer_discard, ..Style::default() };
        let styles = Pass::ALL.map(|pass| style(pass == Pass::Geometry));
        let (triangles, upload) = timed(|| {
            let (vertices, faces) = (tessellation.positions().len(), tessellation.all_triangles());
            let mut triangles = Triangles::new(headless, target, &styles, vertices, &faces)?;
            // SAFETY: nothing was drawn.
            unsafe { triangles.set_vertices(tessellation.positions(), tessellation.normals())? };
            Ok::<_, BenchError>(triangles)
        })?;
        self.drawn = Some((tessellation, triangles));
        self.setup = Setup { tables, upload, ..self.setup };
        Ok(())
    }

    unsafe fn cmd_prepare(&mut self, _cmd: vk::CommandBuffer, motion: Motion) -> Result<(), BenchError> {
        let Some((tessellation, triangles)) = self.drawn.as_mut().filter(|_| motion == Motion::Moving) else {
            return Ok(());
        };
        tessellation.update(&self.control).map_err(unsupported)?;
        // SAFETY: the device is done with earlier frames.
        unsafe { triangles.set_vertices(tessellation.positions(), tessellation.normals())? };
        Ok(())
    }

    unsafe fn cmd_draw(&mut self, cmd: vk::CommandBuffer, frame: &Frame) -> Result<(), BenchError> {
        let Some((_, triangles)) = &mut self.drawn else { return Ok(()) };
        let style = usize::from(frame.pass == Pass::Geometry);
        let (colour, words) = ([0.7, 0.7, 0.7, 1.0], [0; 4]);
        let item = |&transform: &_| TrianglesItem { style, transform, colour, words };
        let items: Vec<TrianglesItem> = frame.instances.iter().map(item).collect();
        // SAFETY: as the caller promises.
        unsafe {
            triangles.set_items(frame.view, &items)?;
            triangles.cmd_draw(cmd);
        }
        Ok(())
    }

    fn setup(&self) -> Setup {
        self.setup
    }

    fn bytes(&self) -> Vec<TableBytes> {
        let Some((_, triangles)) = &self.drawn else { return Vec::new() };
        let [vertices, indices] = triangles.bytes();
        vec![("vertices", vertices), ("indices", indices)]
    }

    fn control_point_bytes(&self) -> u64 {
        0
    }
}
