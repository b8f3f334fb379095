//! What the tessellation stages computed, written to a buffer by the shaders themselves and read back: control points,
//! samples on a grid, and every evaluated vertex. For tests, `subdiv patches` and `subdiv sample`.

use crate::gpu::{
    Buffer, BufferDesc, Domain, GpuError, MemoryLocation, Owned, VkResultExt, descriptor_set_layout,
    tessellated_vertices,
};
use crate::headless::{Headless, Offscreen, OffscreenDesc};
use crate::mesh::ControlMesh;
use crate::renderer::{Capture, DrawItem, Error, ModelOptions, ModelTables, Options, Renderer, Style, Target, View};
use crate::topology::PatchKind;
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::ops::Range;

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
    /// Of length one, towards the side from which the patch is counter-clockwise.
    pub normal: [f32; 3],
}

/// The head of the buffer. GLSL twin: `glsl/lib/capture.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Head {
    first_patch: u32,
    patches: u32,
    grid: u32,
    capacity: u32,
    count: u32,
}

const HEAD_BYTES: u64 = size_of::<Head>() as u64;
const RECORD_BYTES: u64 = size_of::<CapturedVertex>() as u64;
/// Words that the control points of a patch take, whatever its kind.
const CONTROL_POINT_WORDS: usize = 96;
/// Larger captures are done in several draws, each of which keeps some of the patches.
const MAX_BYTES: u64 = 128 << 20;

const _: () = assert!(RECORD_BYTES == 40 && HEAD_BYTES == 20);

/// A model whose tessellation stages can be watched.
pub struct Captured<'h> {
    headless: &'h Headless,
    options: ModelOptions,
    tables: ModelTables,
    positions: Vec<[f32; 3]>,
}

impl<'h> Captured<'h> {
    /// Builds the tables of a model.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device cannot write buffers before rasterization, and as
    /// [`Renderer::add_model`].
    pub fn new(headless: &'h Headless, mesh: &ControlMesh, options: &ModelOptions) -> Result<Self, Error> {
        if !headless.context().features().vertex_stores {
            let device = headless.properties().name.clone();
            return Err(Error::Unsupported { device, missing: vec!["vertexPipelineStoresAndAtomics".into()] });
        }
        let tables = ModelTables::new(mesh, options)?;
        Ok(Self { headless, options: options.clone(), tables, positions: mesh.positions_f32() })
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
        let words = self.capture(
            Capture::Points,
            1.0,
            |_| 4 * CONTROL_POINT_WORDS as u64,
            |patches| Head { first_patch: patches.start, patches: patches.len() as u32, ..Head::zeroed() },
        )?;
        let patches = self.tables.plan().patches().iter();
        let words: Vec<f32> = words.into_iter().flat_map(|(_, words)| words).collect();
        let points = patches.zip(words.chunks_exact(CONTROL_POINT_WORDS)).map(|(patch, words)| {
            let mut points = vec![[0.0; 3]; patch.scheme.points(patch.kind)];
            // The shaders count them corner by corner.
            let slots = (0..patch.kind.corners()).flat_map(|k| patch.scheme.corner_slots(patch.kind, k));
            slots.zip(words.chunks_exact(3)).for_each(|(slot, p)| points[slot] = [p[0], p[1], p[2]]);
            points
        });
        Ok(points.collect())
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
        let captured = self.capture(Capture::Grid, (n - 1) as f32, bytes, |patches| Head {
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

    /// Every vertex that the tessellator made with this factor and the model's spacing, in no order.
    ///
    /// A device may evaluate a vertex more than once; then it is there more than once.
    ///
    /// # Errors
    /// [`Error::BadFactor`]; failed Vulkan calls; tables larger than a shader of the device can see.
    pub fn vertices(&self, factor: f32) -> Result<Vec<CapturedVertex>, Error> {
        let max = self.headless.properties().max_tessellation_level;
        let bytes = |kind: PatchKind| {
            let domain = if kind.is_triangular() { Domain::Triangles } else { Domain::Quads };
            // At worst a device shares nothing between the triangles of a patch.
            let shared = if self.headless.properties().patch_batch == crate::gpu::PatchBatch::LAVAPIPE { 1 } else { 6 };
            shared * u64::from(tessellated_vertices(domain, self.options.spacing, factor, max)) * RECORD_BYTES
        };
        let mut vertices = Vec::new();
        let captured = self.capture(Capture::Vertices, factor, bytes, |patches| Head {
            first_patch: patches.start,
            patches: patches.len() as u32,
            grid: 0,
            capacity: u32::MAX,
            count: 0,
        })?;
        for (_, words) in captured {
            vertices.extend_from_slice(bytemuck::cast_slice(&words));
        }
        Ok(vertices)
    }

    /// Draws all patches, as often as needed to keep what each of them writes. `bytes` is for one patch; the words
    /// come by kind of patch, in the order of the patches.
    fn capture(
        &self,
        mode: Capture,
        factor: f32,
        bytes: impl Fn(PatchKind) -> u64,
        head: impl Fn(&Range<u32>) -> Head,
    ) -> Result<Vec<(PatchKind, Vec<f32>)>, Error> {
        let headless = self.headless;
        let context = headless.context();
        let stages = vk::ShaderStageFlags::TESSELLATION_CONTROL | vk::ShaderStageFlags::TESSELLATION_EVALUATION;
        let layout = descriptor_set_layout(context, "capture", &[(vk::DescriptorType::STORAGE_BUFFER, stages)])?;
        let target = Offscreen::new(headless, &OffscreenDesc::new(4, 4))?;
        let options = Options {
            styles: vec![Style { rasterizer_discard: true, ..Style::default() }],
            set_layouts: vec![layout.raw()],
            ..Options::default()
        };
        let desc = target.desc();
        let render_target = Target::dynamic(desc.color, desc.depth, desc.samples);
        // SAFETY: the set layout is that of the capture buffer and outlives the renderer, which is dropped when idle:
        // every submission is waited for.
        let mut renderer = unsafe { Renderer::with_capture(context, &render_target, &options, mode)? };
        let model = renderer.add_tables(self.tables.clone(), &self.positions, &self.options)?;

        let mut captured = Vec::new();
        for kind in PatchKind::ALL {
            let patches = self.tables.plan().range(kind);
            let (patches, per_patch) = (patches.start as u32..patches.end as u32, bytes(kind));
            let max = MAX_BYTES.min(headless.properties().max_storage_buffer_range) - HEAD_BYTES;
            let step = (max / per_patch).max(1) as usize;
            for first in patches.clone().step_by(step) {
                let window = first..patches.end.min(first + step as u32);
                let size = HEAD_BYTES + window.len() as u64 * per_patch;
                let mut buffer = Buffer::new(
                    context,
                    &BufferDesc {
                        name: "capture",
                        size,
                        usage: vk::BufferUsageFlags::STORAGE_BUFFER,
                        location: MemoryLocation::Readback,
                    },
                )?;
                // What no shader writes is NaN.
                buffer.write(0, &vec![f32::NAN; size as usize / 4])?;
                let head = head(&window);
                buffer.write(0, &[head])?;
                let (_pool, set) = capture_set(headless, layout.raw(), &buffer)?;
                let pipeline_layout = renderer.pipeline_layout();
                let view = View::framing([glam::DVec3::NEG_ONE, glam::DVec3::ONE], [0.0, 0.0, 1.0], 1.0);
                // SAFETY: the command buffer is being recorded; rendering is begun and ended in it, and fits the target.
                headless.try_submit(|cmd| unsafe {
                    renderer.cmd_prepare(cmd, 0)?;
                    target.cmd_begin(cmd, [0.0; 4]);
                    let point = vk::PipelineBindPoint::GRAPHICS;
                    headless.device().cmd_bind_descriptor_sets(cmd, point, pipeline_layout, 2, &[set], &[]);
                    renderer.cmd_draw(cmd, 0, &view, &[DrawItem::new(model, factor)])?;
                    target.cmd_end(cmd);
                    Ok::<(), Error>(())
                })?;
                let words = if mode == Capture::Vertices {
                    let Head { count, .. } = buffer.read::<Head>(0, 1)?[0];
                    u64::from(count) * RECORD_BYTES / 4
                } else {
                    (size - HEAD_BYTES) / 4
                };
                captured.push((kind, buffer.read(HEAD_BYTES, words as usize)?));
            }
        }
        Ok(captured)
    }
}

fn capture_set(
    headless: &Headless,
    layout: vk::DescriptorSetLayout,
    buffer: &Buffer,
) -> Result<(Owned<vk::DescriptorPool>, vk::DescriptorSet), GpuError> {
    let sizes = [vk::DescriptorPoolSize { ty: vk::DescriptorType::STORAGE_BUFFER, descriptor_count: 1 }];
    let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
    let (device, layouts, infos) = (headless.device(), [layout], [buffer.descriptor()]);
    // SAFETY: the pool is taken over by `Owned` and has room for the set, which is new.
    unsafe {
        let pool = device.create_descriptor_pool(&info, None).of("vkCreateDescriptorPool", "capture")?;
        let pool = Owned::new(headless.context(), pool, "capture");
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool.raw()).set_layouts(&layouts);
        let set = device.allocate_descriptor_sets(&info).of("vkAllocateDescriptorSets", "capture")?[0];
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
            .buffer_info(&infos);
        device.update_descriptor_sets(&[write], &[]);
        Ok((pool, set))
    }
}
