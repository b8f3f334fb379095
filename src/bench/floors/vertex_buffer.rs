//! Triangles that were evaluated before.

use super::{Input, Kit, device_buffer};
use crate::bench::BenchError;
use crate::bench::drawable::{Drawable, Frame, Lane, Setup, timed};
use crate::gpu::{Buffer, GpuError, Owned, Shader};
use crate::patch::Scheme;
use crate::renderer::{DrawConstants, ShaderId, TableBytes, topology};
use crate::table::{CpuSurface, UniformGridIndices, uniform_grid_vertices};
use crate::topology::PatchKind;
use ash::vk;
use glam::Vec3;

pub(crate) struct VertexBuffer<'a> {
    lane: Lane<'a>,
    kit: Kit,
    pipelines: [Owned<vk::Pipeline>; 2],
    surface: CpuSurface,
    points: Vec<Vec<Vec3>>,
    drawn: Option<Triangles>,
    setup: Setup,
    /// For bindings that no shader here reads.
    _nothing: Buffer,
}

struct Triangles {
    vertices: Buffer,
    indices: Buffer,
    count: u32,
    topology: vk::PrimitiveTopology,
}

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Vertex {
    position: [f32; 3],
    normal: [f32; 3],
}

impl<'a> VertexBuffer<'a> {
    pub(crate) fn new(lane: Lane<'a>) -> Result<Self, BenchError> {
        // Whichever the scheme, a vertex is a vertex.
        let surface = CpuSurface::new(&lane.subject.mesh, Scheme::Gregory, lane.subject.refine)?;
        let points = surface.control_points(|position| position.as_vec3());
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
        let nothing = device_buffer(lane.headless, "nothing", usage, &[[0.0f32; 4]])?;
        let kit = Kit::new(lane.headless, [&nothing, &nothing])?;
        let bindings = [vk::VertexInputBindingDescription::default().stride(size_of::<Vertex>() as u32)];
        let attribute = |location, offset| {
            let format = vk::Format::R32G32B32_SFLOAT;
            vk::VertexInputAttributeDescription::default().location(location).format(format).offset(offset)
        };
        let attributes = [attribute(0, 0), attribute(1, 12)];
        let dynamic_states = &[vk::DynamicState::PRIMITIVE_TOPOLOGY];
        let input = Input { patch_control_points: 0, bindings: &bindings, attributes: &attributes, dynamic_states };
        let stages = [Shader::vertex(ShaderId::EvaluateUniformGridVert.code())];
        let (pipelines, pipelines_ms) = timed(|| kit.pipelines(lane, &stages, &input))?;
        let setup = Setup { pipelines: pipelines_ms, ..Setup::default() };
        Ok(Self { lane, kit, pipelines, surface, points, drawn: None, setup, _nothing: nothing })
    }

    /// What the device must hold for `n` segments an edge and such indices of a patch of each kind, before anything is evaluated.
    fn check(&self, n: u32, of_kinds: &[Vec<u32>]) -> Result<(), GpuError> {
        let (mut vertices, mut indices) = (0, 0);
        for kind in PatchKind::ALL {
            let patches = u64::from(self.surface.plan().count(kind));
            vertices += patches * uniform_grid_vertices(kind, n);
            // Three more join strips.
            indices += patches * (of_kinds[kind as usize].len() as u64 + 3);
        }
        let bytes = (vertices * size_of::<Vertex>() as u64).max(4 * indices);
        let max = self.lane.headless.properties().max_buffer_size;
        if bytes > max || vertices.max(indices) > u64::from(u32::MAX) {
            let why = format!("{vertices} vertices and {indices} indices do not fit into buffers of {max} bytes");
            return Err(GpuError::Unsupported { object: "pre-tessellated triangles".into(), why });
        }
        Ok(())
    }

    /// Vertices and indices of all patches with `n` segments an edge, and such indices of a patch of each kind.
    fn triangles(&self, n: u32, of_patches: UniformGridIndices, of_kinds: &[Vec<u32>]) -> (Vec<Vertex>, Vec<u32>) {
        let grids = self.surface.grid(&self.points, n + 1);
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        for (patch, grid) in self.surface.plan().patches().iter().zip(grids) {
            let first = vertices.len() as u32;
            of_patches.append(&mut indices, &of_kinds[patch.kind as usize], first);
            vertices.extend(grid.iter().map(|s| Vertex { position: s.position.into(), normal: s.normal.into() }));
        }
        (vertices, indices)
    }
}

impl Drawable for VertexBuffer<'_> {
    fn set_factor(&mut self, factor: f32) -> Result<(), BenchError> {
        self.drawn = None;
        let headless = self.lane.headless;
        let n = self.lane.spacing.segments(factor, headless.properties().max_tessellation_level);
        let kinds = PatchKind::ALL.into_iter().filter(|&kind| self.surface.plan().count(kind) > 0);
        let of_patches = UniformGridIndices::new(kinds, n, headless.properties().indices_at_once);
        let of_kinds = PatchKind::ALL.map(|kind| of_patches.of(kind, n));
        self.check(n, &of_kinds)?;
        let ((vertices, indices), tables) = timed(|| Ok::<_, BenchError>(self.triangles(n, of_patches, &of_kinds)))?;
        let (drawn, upload) = timed(|| {
            use vk::BufferUsageFlags as Usage;
            Ok::<_, BenchError>(Triangles {
                vertices: device_buffer(headless, "bench vertices", Usage::VERTEX_BUFFER, &vertices)?,
                indices: device_buffer(headless, "bench indices", Usage::INDEX_BUFFER, &indices)?,
                count: indices.len() as u32,
                topology: topology(of_patches),
            })
        })?;
        self.drawn = Some(drawn);
        self.setup = Setup { tables, upload, ..self.setup };
        Ok(())
    }

    unsafe fn cmd_draw(&mut self, cmd: vk::CommandBuffer, frame: &Frame) -> Result<(), BenchError> {
        let Some(drawn) = &self.drawn else { return Ok(()) };
        // SAFETY: as the caller promises.
        unsafe {
            self.kit.write_frame(frame, 1.0)?;
            self.kit.cmd_bind_pipeline(cmd, &self.pipelines, frame);
            let device = self.lane.headless.device();
            device.cmd_bind_vertex_buffers(cmd, 0, &[drawn.vertices.raw()], &[0]);
            device.cmd_bind_index_buffer(cmd, drawn.indices.raw(), 0, vk::IndexType::UINT32);
            device.cmd_set_primitive_topology(cmd, drawn.topology);
            self.kit.cmd_push(cmd, &DrawConstants::new(0));
            for instance in 0..frame.instances.len() {
                self.kit.cmd_bind(cmd, instance);
                device.cmd_draw_indexed(cmd, drawn.count, 1, 0, 0, 0);
            }
        }
        Ok(())
    }

    fn setup(&self) -> Setup {
        self.setup
    }

    fn bytes(&self) -> Vec<TableBytes> {
        let drawn = self.drawn.iter();
        drawn.flat_map(|t| [("vertices", t.vertices.size()), ("indices", t.indices.size())]).collect()
    }

    fn control_point_bytes(&self) -> u64 {
        0
    }
}
