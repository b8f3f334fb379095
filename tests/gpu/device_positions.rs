//! Positions of control vertices that the device writes.

use crate::common::stage::{Stage, begin, read_vertices, with_segments};
use crate::common::{self, pentagons};
use ash::vk;
use ash_subdiv::adaptive::{AdaptiveOptions, DrawnBy};
use ash_subdiv::capture::Captured;
use ash_subdiv::gpu::MemoryLocation;
use ash_subdiv::headless::objects::{
    Buffer, BufferDesc, ComputePipelineDesc, DescriptorPool, DescriptorSet, Owned, SetLayout, Shader,
    descriptor_set_layout, pipeline_layout,
};
use ash_subdiv::headless::{Headless, Offscreen};
use ash_subdiv::mesh::{Change, Edit, Skinning, animated_shape};
use ash_subdiv::renderer::{DevicePositions, Evaluation, Factor};
use ash_subdiv::table::{ModelTables, TableError};
use ash_subdiv::{
    Construction, ControlMesh, DrawItem, Error, Frame, ModelId, ModelOptions, Options, Renderer, Scheme, View, shape,
};
use std::sync::Arc;

#[allow(dead_code, reason = "other tests use the other shaders")]
mod shaders {
    include!(concat!(env!("OUT_DIR"), "/test_shaders.rs"));
}

const SEGMENTS: u32 = 4;

/// Every way in which vertices become a surface.
pub fn ways() -> Vec<(ControlMesh, ModelOptions)> {
    let mesh = |name| shape(name).expect("built in");
    let plain = ModelOptions::default();
    let depth = |depth| Some(AdaptiveOptions { depth, ..AdaptiveOptions::default() });
    let leaves = AdaptiveOptions { depth: 2, drawn_by: DrawnBy::Leaves, ..AdaptiveOptions::default() };
    let on_device = |refine| ModelOptions { refine, refine_on_device: true, ..ModelOptions::default() };
    let cached = ModelOptions { construction: Construction::Cached, ..plain.clone() };
    let mut ways: Vec<_> = Construction::ALL
        .into_iter()
        .map(|construction| (mesh("valences"), ModelOptions { construction, ..plain.clone() }))
        .collect();
    for evaluation in Evaluation::ALL.into_iter().filter(|evaluation| *evaluation != Evaluation::Tessellation) {
        ways.push((mesh("cube"), ModelOptions::evaluated(evaluation)));
    }
    ways.extend([
        (mesh("valences"), ModelOptions { shared_normals: true, ..cached.clone() }),
        (mesh("machine-part"), ModelOptions { adaptive: depth(2), ..plain.clone() }),
        (mesh("valences"), ModelOptions { adaptive: depth(1), ..ModelOptions::evaluated(Evaluation::Instanced) }),
        (mesh("machine-part"), ModelOptions { adaptive: Some(leaves), ..plain.clone() }),
        // By triangles around the centres of larger faces.
        (pentagons(), plain.clone()),
        (mesh("valences"), on_device(1)),
        (mesh("cube"), ModelOptions { construction: Construction::Stencil, ..on_device(3) }),
        (pentagons(), ModelOptions { scheme: Scheme::Acc, ..on_device(0) }),
        (pentagons(), ModelOptions { refine_on_device: true, ..ModelOptions::evaluated(Evaluation::Subdivision) }),
        (mesh("valences"), ModelOptions { adaptive: depth(2), ..on_device(2) }),
    ]);
    ways
}

fn moved(mesh: &ControlMesh, scale: f32) -> Vec<[f32; 3]> {
    mesh.positions_f32().iter().map(|&[x, y, z]| [scale * x, scale * y + 0.1 * x * z, scale * z]).collect()
}

/// A buffer of the caller's that the host filled: positions from some offset on.
fn buffer(headless: &Headless, positions: &[[f32; 3]], offset: u64, stride: u32) -> (Buffer, DevicePositions) {
    let mut words = vec![f32::NAN; offset as usize / 4];
    for position in positions {
        words.extend(position);
        words.resize(words.len() + stride as usize / 4 - 3, f32::NAN);
    }
    words.truncate(offset as usize / 4 + stride as usize / 4 * (positions.len() - 1) + 3);
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_SRC;
    let buffer = Buffer::with_data(headless.context(), "positions of the caller's", usage, &words).expect("a buffer");
    let positions = DevicePositions { buffer: buffer.raw(), offset, stride, size: buffer.size() };
    (buffer, positions)
}

fn give(renderer: &mut Renderer, model: ModelId, frame: Frame, positions: DevicePositions) -> Result<(), Error> {
    // SAFETY: buffers outlive the renderers; every submission is waited for.
    unsafe { renderer.set_device_positions(model, frame, positions) }
}

fn draw(stage: &Stage, renderer: &mut Renderer, frame: Frame, (view, item): (&View, DrawItem)) -> Vec<u8> {
    // SAFETY: the command buffer is being recorded, inside rendering.
    let record = |cmd| unsafe { renderer.cmd_draw(cmd, frame, view, &[item]) };
    stage.target.draw(&stage.headless, [0.0; 4], record).expect("a picture")
}

fn covered(pixels: &[u8]) -> usize {
    pixels.chunks(4).filter(|pixel| pixel[3] > 0).count()
}

#[test]
fn positions_of_the_device_are_those_of_the_host() {
    let stage = Stage::new();
    for (number, (mesh, options)) in ways().into_iter().enumerate() {
        let mut renderer = stage.renderer(&Options::default());
        let view = View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0);
        let [host, device] = [0; 2].map(|_| renderer.add_model(&mesh, &options).expect("a model"));
        let factor = [host, device].map(|id| with_segments(&mut renderer, id, options.evaluation, SEGMENTS))[0];
        let item = |model| (&view, DrawItem::new(model, factor));
        let strides = [12, 16, 20, 48];
        let (_buffer, given) =
            buffer(&stage.headless, &moved(&mesh, 0.7), [0, 4, 252, 260, 516][number % 5], strides[number % 4]);
        let frame = begin(&mut renderer);
        if number % 2 == 0 {
            // Else it never had the host's.
            stage.prepare(&mut renderer, frame);
        }
        renderer.set_positions(host, frame, &moved(&mesh, 0.7)).expect("positions");
        give(&mut renderer, device, frame, given).expect("positions");
        stage.prepare(&mut renderer, frame);
        let [expected, drawn] = [host, device].map(|id| draw(&stage, &mut renderer, frame, item(id)));
        assert!(covered(&expected) > 500, "{options:?}: {}", covered(&expected));
        assert!(drawn == expected, "{options:?}");
        if options.evaluation == Evaluation::Compute {
            let [host, device] = [host, device].map(|id| read_vertices(&stage.headless, &renderer, id));
            assert!(host.iter().map(|x| x.to_bits()).eq(device.iter().map(|x| x.to_bits())));
        }
        // They hold until others are set, by whomever.
        let frame = stage.frame(&mut renderer);
        assert!(draw(&stage, &mut renderer, frame, item(device)) == expected, "{options:?}");
        let frame = begin(&mut renderer);
        for id in [host, device] {
            renderer.set_positions(id, frame, &mesh.positions_f32()).expect("positions");
        }
        stage.prepare(&mut renderer, frame);
        let [rest, drawn] = [host, device].map(|id| draw(&stage, &mut renderer, frame, item(id)));
        assert!(drawn == rest && rest != expected, "{options:?}");
        drop(renderer);
    }
    stage.finish();
}

#[test]
fn captures_are_the_same() {
    let headless = common::headless();
    for (mesh, options) in ways() {
        if options.evaluation != Evaluation::Tessellation {
            continue;
        }
        let positions = moved(&mesh, 0.6);
        let data = ash_subdiv::MeshData {
            positions: positions.iter().map(|p| p.map(f64::from)).collect(),
            ..mesh.clone().into_data()
        };
        let there = ControlMesh::new(data).expect("the same faces");
        let (_buffer, given) = buffer(&headless, &positions, 8, 28);
        let host = Captured::new(&headless, &there, &options).expect("a model");
        let device = Captured::new(&headless, &mesh, &options).expect("a model");
        // SAFETY: the buffer lives longer.
        let device = unsafe { device.with_device_positions(given) };
        let [expected, captured] = [&host, &device].map(|of| of.grid(4).expect("a capture"));
        assert!(expected == captured, "{options:?}");
        if options.adaptive.is_none() {
            let [expected, captured] = [&host, &device].map(|of| of.control_points().expect("a capture"));
            let bits =
                |points: &[Vec<[f32; 3]>]| points.concat().concat().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&expected), bits(&captured), "{options:?}");
        }
    }
    headless.finish_silent();
}

/// What the device refines is what the host does, but for rounding.
#[test]
fn the_device_refines_as_the_host_does() {
    let headless = common::headless();
    for (name, refine) in [("valences", 1), ("cube", 3), ("machine-part", 2)] {
        let mesh = shape(name).expect("built in");
        let points = |refine_on_device| {
            let options = ModelOptions { refine, refine_on_device, ..ModelOptions::default() };
            Captured::new(&headless, &mesh, &options).expect("a model").control_points().expect("a capture")
        };
        let [host, device] = [false, true].map(points);
        let largest = common::largest_coordinate(&mesh) as f32;
        assert!(host.len() == device.len() && host.len() >= mesh.face_count() * 4usize.pow(refine), "{name}");
        for (host, device) in host.concat().concat().iter().zip(device.concat().concat()) {
            assert!((host - device).abs() < 2e-6 * largest, "{name}: {host} {device}");
        }
    }
    headless.finish_silent();
}

/// A compute shader of the caller's that scales positions.
struct Scaling {
    pipeline: Owned<vk::Pipeline>,
    layout: Owned<vk::PipelineLayout>,
    set_layout: SetLayout,
    pool: Arc<DescriptorPool>,
    rest: Buffer,
    count: u32,
}

impl Scaling {
    fn new(headless: &Headless, mesh: &ControlMesh) -> Self {
        let context = headless.context();
        let binding = (vk::DescriptorType::STORAGE_BUFFER, vk::ShaderStageFlags::COMPUTE);
        let set_layout = descriptor_set_layout(context, "scaled", &[binding; 2]).expect("a layout");
        let constants = [vk::PushConstantRange { stage_flags: vk::ShaderStageFlags::COMPUTE, offset: 0, size: 16 }];
        // SAFETY: the layout is of the device, the shader is for the layout.
        let (layout, pipeline) = unsafe {
            let layout = pipeline_layout(context, "scaled", &[set_layout.raw()], &constants).expect("a layout");
            let shader = Shader::compute(shaders::SCALED_COMP);
            let cache = vk::PipelineCache::null();
            let pipeline = ComputePipelineDesc { name: "scaled", layout: layout.raw(), shader, cache }.create(context);
            (layout, pipeline.expect("a pipeline"))
        };
        let rest: Vec<[f32; 4]> = mesh.positions_f32().iter().map(|&[x, y, z]| [x, y, z, 1.0]).collect();
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let pool = DescriptorPool::new(context, "scaled", &[&set_layout]);
        let rest = Buffer::with_data(context, "rest", usage, &rest).expect("a buffer");
        Self { pipeline, layout, set_layout, pool, rest, count: mesh.vertex_count() as u32 }
    }

    /// Records it, and gives the set, to be kept until the frame is done.
    fn cmd_scale(&self, headless: &Headless, cmd: vk::CommandBuffer, to: DevicePositions, scale: f32) -> DescriptorSet {
        let moved = vk::DescriptorBufferInfo { buffer: to.buffer, offset: 0, range: vk::WHOLE_SIZE };
        let (device, point) = (headless.device(), vk::PipelineBindPoint::COMPUTE);
        let words = [scale.to_bits(), self.count, to.offset as u32 / 4, to.stride / 4].map(u32::to_ne_bytes).concat();
        // SAFETY: the set is of the layout; `cmd` is being recorded.
        unsafe {
            let buffers = [self.rest.descriptor(), moved];
            let set = DescriptorSet::of_buffers(&self.pool, &self.set_layout, "scaled", &buffers).expect("a set");
            device.cmd_bind_pipeline(cmd, point, self.pipeline.raw());
            device.cmd_bind_descriptor_sets(cmd, point, self.layout.raw(), 0, &[set.raw()], &[]);
            device.cmd_push_constants(cmd, self.layout.raw(), vk::ShaderStageFlags::COMPUTE, 0, &words);
            device.cmd_dispatch(cmd, self.count.div_ceil(64), 1, 1);
            set
        }
    }
}

/// What a frame on the device uses.
struct Flight {
    target: Offscreen,
    pool: vk::CommandPool,
    fence: vk::Fence,
    used: Vec<DescriptorSet>,
    scale: Option<f32>,
}

/// Three frames are on the device at once, each with other positions, written by compute of the caller's into the crate's buffer or
/// into one of the caller's for all frames: no picture has positions of another frame.
#[test]
fn frames_in_flight_have_their_own_positions() {
    let stage = Stage::new();
    let (headless, device) = (&stage.headless, stage.headless.device());
    let mesh = shape("cube").expect("built in");
    let scaling = Scaling::new(headless, &mesh);
    let view = Stage::view();
    for (way, options) in [
        ModelOptions::default(),
        ModelOptions::evaluated(Evaluation::Compute),
        ModelOptions { refine: 1, refine_on_device: true, ..ModelOptions::default() },
    ]
    .into_iter()
    .enumerate()
    {
        let mut renderer = stage.renderer(&Options { frames_in_flight: 3, ..Options::default() });
        let model = renderer.add_model(&mesh, &options).expect("a model");
        let item = DrawItem::new(model, with_segments(&mut renderer, model, options.evaluation, SEGMENTS));
        let own = BufferDesc {
            name: "moved",
            size: 12 * mesh.vertex_count() as u64,
            usage: vk::BufferUsageFlags::STORAGE_BUFFER,
            location: MemoryLocation::DeviceLocal,
        };
        let own = Buffer::new(headless.context(), &own).expect("a buffer");
        let own_positions = DevicePositions { buffer: own.raw(), offset: 0, stride: 12, size: own.size() };
        let rooms = [0; 3].map(|_| {
            let frame = begin(&mut renderer);
            let room = renderer.device_positions(model, frame).expect("room");
            room.offset..room.offset + u64::from(room.stride) * mesh.vertex_count() as u64
        });
        let are_apart = |i: usize, k: usize| rooms[i].end <= rooms[k].start || rooms[k].end <= rooms[i].start;
        assert!(are_apart(0, 1) && are_apart(0, 2) && are_apart(1, 2), "{rooms:?}");
        let expected = expected(&stage, &mesh, &options);
        let mut flights: Vec<Flight> = (0..3).map(|_| flight(&stage)).collect();
        let finish = |flight: &mut Flight| {
            // SAFETY: the fence is of the device.
            unsafe {
                device.wait_for_fences(&[flight.fence], true, u64::MAX).expect("done");
                device.reset_fences(&[flight.fence]).expect("reset");
                device.reset_command_pool(flight.pool, Default::default()).expect("reset");
            }
            flight.used.clear();
            let picture = flight.target.pixels().expect("pixels");
            let number = flight.scale.take().map(|scale| SCALES.iter().position(|s| *s == scale).expect("one of them"));
            number.is_none_or(|number| picture == expected[number])
        };
        for number in 0..12 {
            let flight = &mut flights[number % 3];
            if flight.scale.is_some() {
                assert!(finish(flight), "way {way}, frame {number}");
            }
            let frame = begin(&mut renderer);
            let scale = SCALES[number % SCALES.len()];
            flight.scale = Some(scale);
            // SAFETY: handles are of the device; what is recorded is submitted, and its fence is waited for.
            unsafe {
                let info = vk::CommandBufferAllocateInfo::default().command_pool(flight.pool).command_buffer_count(1);
                let cmd = device.allocate_command_buffers(&info).expect("commands")[0];
                device.begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default()).expect("begun");
                let to = match number / 6 {
                    0 => renderer.device_positions(model, frame).expect("room"),
                    _ => {
                        // The frame before reads them in the compute stage.
                        let compute = vk::PipelineStageFlags::COMPUTE_SHADER;
                        device.cmd_pipeline_barrier(cmd, compute, compute, Default::default(), &[], &[], &[]);
                        own_positions
                    }
                };
                flight.used.push(scaling.cmd_scale(headless, cmd, to, scale));
                renderer.set_device_positions(model, frame, to).expect("positions");
                renderer.cmd_prepare(cmd, frame).expect("prepared");
                flight.target.cmd_begin(cmd, [0.0; 4]);
                renderer.cmd_draw(cmd, frame, &view, &[item]).expect("drawn");
                flight.target.cmd_end(cmd);
                flight.target.cmd_read_back(cmd);
                device.end_command_buffer(cmd).expect("ended");
                let commands = [cmd];
                let submit = vk::SubmitInfo::default().command_buffers(&commands);
                headless.with_queue(|queue| device.queue_submit(queue, &[submit], flight.fence)).expect("submitted");
            }
        }
        assert!(flights.iter_mut().all(finish), "way {way}");
        for flight in flights {
            // SAFETY: the device is done with them.
            unsafe {
                device.destroy_command_pool(flight.pool, None);
                device.destroy_fence(flight.fence, None);
            }
        }
    }
    drop(scaling);
    stage.finish();
}

const SCALES: [f32; 4] = [1.0, 0.25, 0.75, 0.5];

fn flight(stage: &Stage) -> Flight {
    let (headless, device) = (&stage.headless, stage.headless.device());
    let info = vk::CommandPoolCreateInfo::default().queue_family_index(headless.queue_family());
    Flight {
        target: Offscreen::new(headless, stage.target.desc()).expect("an image"),
        // SAFETY: the descriptions are valid.
        pool: unsafe { device.create_command_pool(&info, None) }.expect("a pool"),
        fence: unsafe { device.create_fence(&Default::default(), None) }.expect("a fence"),
        used: Vec::new(),
        scale: None,
    }
}

/// The pictures of the scales, where the host sets positions, one frame after the other.
fn expected(stage: &Stage, mesh: &ControlMesh, options: &ModelOptions) -> Vec<Vec<u8>> {
    let mut renderer = stage.renderer(&Options::default());
    let model = renderer.add_model(mesh, options).expect("a model");
    let item = DrawItem::new(model, with_segments(&mut renderer, model, options.evaluation, SEGMENTS));
    let picture = |scale: f32| {
        let frame = begin(&mut renderer);
        let positions: Vec<_> = mesh.positions_f32().iter().map(|p| p.map(|x| scale * x)).collect();
        renderer.set_positions(model, frame, &positions).expect("positions");
        stage.prepare(&mut renderer, frame);
        stage.draw(&mut renderer, frame, &[item]).expect("a picture")
    };
    let pictures: Vec<_> = SCALES.into_iter().map(picture).collect();
    assert!((1..SCALES.len()).all(|i| pictures[i] != pictures[0]));
    pictures
}

/// Of frames that are lost, or not prepared, nothing is left; a copy of the caller's is waited for as compute is.
#[test]
fn lost_positions_are_forgotten() {
    let stage = Stage::new();
    let mesh = shape("cube").expect("built in");
    let mut renderer = stage.renderer(&Options { frames_in_flight: 1, ..Options::default() });
    let cached = ModelOptions { construction: Construction::Cached, ..ModelOptions::default() };
    let model = renderer.add_model(&mesh, &cached).expect("a model");
    let item = DrawItem::new(model, Factor::Uniform(4.0));
    let (staged, given) = buffer(&stage.headless, &moved(&mesh, 0.5), 0, 16);
    let picture = |renderer: &mut Renderer, frame| stage.draw(renderer, frame, &[item]).expect("a picture");
    let frame = stage.frame(&mut renderer);
    let rest = picture(&mut renderer, frame);
    // Not prepared, then lost.
    let frame = begin(&mut renderer);
    give(&mut renderer, model, frame, given).expect("positions");
    let frame = begin(&mut renderer);
    give(&mut renderer, model, frame, given).expect("positions");
    // SAFETY: recorded outside rendering, and never run.
    stage.headless.record(|cmd| unsafe { renderer.cmd_prepare(cmd, frame) }).expect("recorded");
    renderer.frame_lost(frame).expect("the newest");
    let frame = stage.frame(&mut renderer);
    assert!(picture(&mut renderer, frame) == rest);
    // What the host set before is not lost with them.
    let frame = begin(&mut renderer);
    renderer.set_positions(model, frame, &moved(&mesh, 0.8)).expect("positions");
    let frame = begin(&mut renderer);
    give(&mut renderer, model, frame, given).expect("positions");
    // SAFETY: as above.
    stage.headless.record(|cmd| unsafe { renderer.cmd_prepare(cmd, frame) }).expect("recorded");
    renderer.frame_lost(frame).expect("the newest");
    let frame = stage.frame(&mut renderer);
    let host = picture(&mut renderer, frame);
    assert!(host != rest);
    // By a copy, in the same commands, twice.
    let frame = begin(&mut renderer);
    let room = renderer.device_positions(model, frame).expect("room");
    let region = vk::BufferCopy { src_offset: 0, dst_offset: room.offset, size: staged.size() };
    let record = |cmd| {
        for _ in 0..2 {
            // SAFETY: both buffers hold the range; the command buffer is being recorded. What read it before is waited for.
            unsafe {
                use vk::PipelineStageFlags as Stage;
                let (compute, copy) = (Stage::COMPUTE_SHADER, Stage::TRANSFER);
                let (device, none) = (stage.headless.device(), vk::DependencyFlags::empty());
                let written = vk::AccessFlags::TRANSFER_WRITE;
                let after = [vk::MemoryBarrier::default().src_access_mask(written).dst_access_mask(written)];
                device.cmd_pipeline_barrier(cmd, compute | copy, copy, none, &after, &[], &[]);
                device.cmd_copy_buffer(cmd, staged.raw(), room.buffer, &[region]);
                renderer.set_device_positions(model, frame, room)?;
                renderer.cmd_prepare(cmd, frame)?;
            }
        }
        Ok::<_, Error>(())
    };
    stage.headless.try_submit(record).expect("a frame");
    let drawn = picture(&mut renderer, frame);
    let frame = begin(&mut renderer);
    renderer.set_positions(model, frame, &moved(&mesh, 0.5)).expect("positions");
    stage.prepare(&mut renderer, frame);
    assert!(drawn == picture(&mut renderer, frame) && drawn != host);
    // Another mesh takes the place of both.
    let frame = begin(&mut renderer);
    give(&mut renderer, model, frame, given).expect("positions");
    renderer.set_mesh(model, &mesh).expect("the same");
    stage.prepare(&mut renderer, frame);
    assert!(picture(&mut renderer, frame) == rest);
    drop((renderer, staged));
    stage.finish();
}

#[test]
fn what_cannot_be_read_is_an_error() {
    let stage = Stage::new();
    let mesh = shape("cube").expect("built in");
    let mut renderer = stage.renderer(&Options::default());
    let model = renderer.add_model(&mesh, &ModelOptions::default()).expect("a model");
    let (buffer, given) = buffer(&stage.headless, &mesh.positions_f32(), 0, 12);
    let old = begin(&mut renderer);
    let frame = begin(&mut renderer);
    let told = |renderer: &mut Renderer, given| give(renderer, model, frame, given).unwrap_err().to_string();
    let layout = "are in bytes, multiples of 4, the stride from 12 up";
    for (offset, stride) in [(0, 8), (0, 0), (0, 14), (2, 16)] {
        let error = told(&mut renderer, DevicePositions { offset, stride, ..given });
        assert!(error.contains(&format!("the offset {offset} and the stride {stride} {layout}")), "{error}");
    }
    // Eight vertices.
    let error = told(&mut renderer, DevicePositions { size: 95, ..given });
    assert!(error.contains("the buffer has 95 bytes, but its positions end after 96"), "{error}");
    let error = told(&mut renderer, DevicePositions { offset: 4, ..given });
    assert!(error.contains("the buffer has 96 bytes, but its positions end after 100"), "{error}");
    let error = told(&mut renderer, DevicePositions { offset: u64::MAX - 3, ..given });
    assert!(error.contains("positions end after"), "{error}");
    let error = told(&mut renderer, DevicePositions { stride: u32::MAX - 3, size: u64::MAX, ..given });
    assert!(error.contains("positions on the device take"), "{error}");
    let error = told(&mut renderer, DevicePositions { buffer: vk::Buffer::null(), ..given });
    assert!(error.contains("DevicePositions::buffer is null"), "{error}");
    assert!(matches!(give(&mut renderer, model, old, given), Err(Error::OldFrame)));
    assert!(matches!(renderer.device_positions(model, old), Err(Error::OldFrame)));

    let rest = mesh.positions_f32();
    renderer.set_positions(model, frame, &rest).expect("positions");
    assert!(matches!(give(&mut renderer, model, frame, given), Err(Error::PositionsTwice { .. })));
    let frame = begin(&mut renderer);
    give(&mut renderer, model, frame, given).expect("positions");
    give(&mut renderer, model, frame, given).expect("positions");
    stage.prepare(&mut renderer, frame);
    assert!(matches!(renderer.set_positions(model, frame, &rest), Err(Error::PositionsTwice { .. })));

    let refined = ModelOptions { refine: 1, ..ModelOptions::default() };
    let refined = renderer.add_model(&mesh, &refined).expect("a model");
    let error = give(&mut renderer, refined, frame, given).unwrap_err();
    assert!(matches!(error, Error::RefinedOnHost { .. }), "{error}");
    assert!(matches!(renderer.device_positions(refined, frame), Err(Error::RefinedOnHost { .. })));
    let mut data = mesh.clone().into_data();
    data.edits = vec![Edit { face: 0, children: vec![0], change: Change::Offset { corner: 2, offset: [0.1; 3] } }];
    let edited = ControlMesh::new(data).expect("an edit");
    let on_device = ModelOptions { refine_on_device: true, ..ModelOptions::default() };
    let error = renderer.add_model(&edited, &on_device).unwrap_err();
    assert!(matches!(error, Error::Table(TableError::EditsOnDevice)), "{error}");
    renderer.add_model(&mesh, &on_device).expect("nothing to refine");
    let tables = ModelTables::new(&mesh, &on_device).expect("tables");
    let error = renderer.add_tables(tables, &rest, &ModelOptions::default()).unwrap_err();
    assert!(matches!(error, Error::OtherOption { option: "refine_on_device", built: true, .. }), "{error}");
    renderer.remove_model(model).expect("a model");
    assert!(matches!(give(&mut renderer, model, frame, given), Err(Error::NoSuchModel { .. })));
    drop((renderer, buffer));
    stage.finish();
}

/// A character that a shader of the caller's skins is where the CPU has it, and looks so.
#[test]
fn a_skinned_character_is_that_of_the_cpu() {
    let stage = Stage::new();
    let headless = &stage.headless;
    let tentacle = animated_shape("tentacle").expect("built in");
    let (mesh, animations) = (&tentacle.mesh, &tentacle.animations);
    let of_vertices = animations.influences();
    let most = of_vertices.iter().map(Vec::len).max().expect("vertices");
    assert!(most > 1 && of_vertices.len() == mesh.vertex_count());
    // What has no weight is there for every vertex to have as many.
    let padded = |of: &Vec<(u32, f32)>| [&of[..], &vec![(0, 0.0); most - of.len()]].concat();
    let influences: Vec<[u32; 2]> =
        of_vertices.iter().flat_map(padded).map(|(matrix, weight)| [matrix, weight.to_bits()]).collect();
    let view = Stage::view();
    let mut pictures = Vec::new();
    for number in 0..animations.len() {
        let mut renderer = stage.renderer(&Options::default());
        let [host, device] = [0; 2].map(|_| renderer.add_model(mesh, &ModelOptions::default()).expect("a model"));
        let seconds = 0.4;
        let mut expected = mesh.positions_f32();
        animations.positions(number, seconds, &mut expected).expect("a pose");
        let given = animations.skinning(number, seconds).expect("a pose");
        let frame = begin(&mut renderer);
        let room = renderer.device_positions(device, frame).expect("room");
        assert_eq!(room.stride, 16);
        let skinned = skin(headless, &given, (&influences, most as u32), room);
        let largest = common::largest_coordinate(mesh) as f32;
        for (skinned, expected) in skinned.iter().zip(&expected) {
            for axis in 0..3 {
                let away = (skinned[axis] - expected[axis]).abs();
                assert!(away < 2e-6 * largest, "animation {number}: {skinned:?} {expected:?}");
            }
        }
        give(&mut renderer, device, frame, room).expect("positions");
        renderer.set_positions(host, frame, &expected).expect("positions");
        stage.prepare(&mut renderer, frame);
        let view = View { light: view.light, ..View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0) };
        let [by_host, by_device] =
            [host, device].map(|id| draw(&stage, &mut renderer, frame, (&view, DrawItem::new(id, 6.0))));
        assert!(covered(&by_host) > 300, "{}", covered(&by_host));
        let far = |(a, b): (&u8, &u8)| a.abs_diff(*b) > 8;
        let differ = by_host.iter().zip(&by_device).filter(|&pair| far(pair)).count();
        assert!(differ < by_host.len() / 500, "animation {number}: {differ}");
        pictures.push(by_device);
    }
    assert!(pictures.len() > 1 && pictures.windows(2).all(|two| two[0] != two[1]));
    stage.finish();
}

/// Skins vertices into a room of the renderer's, with what each is bound to and what moves that, and reads them back.
fn skin(
    headless: &Headless,
    given: &Skinning,
    (influences, of_vertex): (&[[u32; 2]], u32),
    room: DevicePositions,
) -> Vec<[f32; 4]> {
    let (context, device) = (headless.context(), headless.device());
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let bound: Vec<[f32; 4]> = given.positions.iter().map(|&[x, y, z]| [x, y, z, 0.0]).collect();
    let bound_buffer = Buffer::with_data(context, "bound", usage, &bound).expect("a buffer");
    let influences = Buffer::with_data(context, "influences", usage, influences).expect("a buffer");
    let matrices = Buffer::with_data(context, "matrices", usage, &given.matrices).expect("a buffer");
    let bytes = 16 * bound.len() as u64;
    let to = vk::DescriptorBufferInfo { buffer: room.buffer, offset: room.offset, range: bytes };
    let binding = (vk::DescriptorType::STORAGE_BUFFER, vk::ShaderStageFlags::COMPUTE);
    let layout = descriptor_set_layout(context, "skin", &[binding; 4]).expect("a layout");
    let pool = DescriptorPool::new(context, "skin", &[&layout]);
    let constants = [vk::PushConstantRange { stage_flags: vk::ShaderStageFlags::COMPUTE, offset: 0, size: 8 }];
    let target = BufferDesc {
        name: "skinned",
        size: bytes,
        usage: vk::BufferUsageFlags::STORAGE_BUFFER,
        location: MemoryLocation::Readback,
    };
    let copy = Buffer::new(context, &target).expect("a buffer");
    let words = [of_vertex, bound.len() as u32].map(u32::to_ne_bytes).concat();
    // SAFETY: layouts and sets go with the shader; the submissions are waited for.
    unsafe {
        let pipeline_layout = pipeline_layout(context, "skin", &[layout.raw()], &constants).expect("a layout");
        let shader = Shader::compute(shaders::SKIN_COMP);
        let desc = ComputePipelineDesc {
            name: "skin",
            layout: pipeline_layout.raw(),
            shader,
            cache: vk::PipelineCache::null(),
        };
        let pipeline = desc.create(context).expect("a pipeline");
        for to in [to, copy.descriptor()] {
            let buffers = [bound_buffer.descriptor(), influences.descriptor(), matrices.descriptor(), to];
            let set = DescriptorSet::of_buffers(&pool, &layout, "skin", &buffers).expect("a set");
            let record = |cmd| {
                let point = vk::PipelineBindPoint::COMPUTE;
                device.cmd_bind_pipeline(cmd, point, pipeline.raw());
                device.cmd_bind_descriptor_sets(cmd, point, pipeline_layout.raw(), 0, &[set.raw()], &[]);
                device.cmd_push_constants(cmd, pipeline_layout.raw(), vk::ShaderStageFlags::COMPUTE, 0, &words);
                device.cmd_dispatch(cmd, (bound.len() as u32).div_ceil(64), 1, 1);
                let host = vk::MemoryBarrier::default()
                    .src_access_mask(vk::AccessFlags::SHADER_WRITE)
                    .dst_access_mask(vk::AccessFlags::HOST_READ);
                let (from, to) = (vk::PipelineStageFlags::COMPUTE_SHADER, vk::PipelineStageFlags::HOST);
                device.cmd_pipeline_barrier(cmd, from, to, Default::default(), &[host], &[], &[]);
                Ok::<(), Error>(())
            };
            headless.try_submit(record).expect("skinned");
        }
    }
    copy.read(0, bound.len()).expect("read back")
}
