//! The Vulkan base on a real device, with the validation layer listening: every test ends in `finish_silent`.

use ash::vk;
use ash_subdiv::gpu::{Features, GpuError, MemoryLocation, PatchDraw, Spacing};
use ash_subdiv::headless::objects::{
    Buffer, BufferDesc, ComputePipelineDesc, Domain, GraphicsPipelineDesc, Image, ImageDesc, Owned, Shader,
    Specialization, VkResultExt, descriptor_set_layout, pipeline_layout, tessellated_vertices,
};
use ash_subdiv::headless::{Headless, HeadlessError, HeadlessOptions, Offscreen, OffscreenDesc, Statistics, devices};

#[allow(dead_code)]
mod shaders {
    include!(concat!(env!("OUT_DIR"), "/test_shaders.rs"));
}

fn headless() -> Headless {
    let needs = Features { statistics: true, ..Features::NONE };
    Headless::new(&HeadlessOptions { validation: true, needs, ..HeadlessOptions::default() }).unwrap()
}

fn offscreen(headless: &Headless, width: u32, height: u32, samples: vk::SampleCountFlags) -> Offscreen {
    let color = vk::Format::R8G8B8A8_UNORM;
    Offscreen::new(headless, &OffscreenDesc { samples, color, ..OffscreenDesc::new(width, height) }).unwrap()
}

/// A row of square patches from left to right, each a colour of its own.
struct Row {
    pipeline: Owned<vk::Pipeline>,
    _layout: Owned<vk::PipelineLayout>,
    draws: Vec<PatchDraw>,
}

impl Row {
    fn new(headless: &Headless, target: &Offscreen, patches: u32, level: f32, vert: &[u32], tese: &[u32]) -> Self {
        // Enough for every domain and spacing used here.
        let vertices = tessellated_vertices(Domain::Quads, Spacing::FractionalEven, level + 1.0, 64);
        let draws: Vec<_> = headless.properties().patch_batch.draws(patches, 4, vertices).collect();
        let vertex = [Specialization::uint(0, draws[0].patches_per_instance), Specialization::uint(1, patches)];
        let control = [Specialization::float(0, level)];
        let shaders = [
            Shader::vertex(vert).specialized(&vertex),
            Shader::tess_control(shaders::QUAD_PATCH_TESC).specialized(&control),
            Shader::tess_evaluation(tese),
            Shader::fragment(shaders::PATCH_COLOR_FRAG),
        ];
        unsafe {
            let layout = pipeline_layout(headless.context(), "row of patches", &[], &[]).unwrap();
            let desc = GraphicsPipelineDesc {
                patch_control_points: 4,
                samples: target.desc().samples,
                depth: Some(ash_subdiv::gpu::DepthState::LESS),
                ..GraphicsPipelineDesc::new("row of patches", layout.raw(), target.target(), &shaders)
            };
            Self { pipeline: desc.create(headless.context()).unwrap(), _layout: layout, draws }
        }
    }

    fn cmd_draw(&self, headless: &Headless, cmd: vk::CommandBuffer) {
        let device = headless.device();
        unsafe {
            device.cmd_bind_pipeline(cmd, vk::PipelineBindPoint::GRAPHICS, self.pipeline.raw());
            for draw in &self.draws {
                device.cmd_draw(cmd, draw.vertex_count, draw.instance_count, 0, draw.first_instance);
            }
        }
    }

    fn pixels(&self, headless: &Headless, target: &Offscreen) -> Vec<u8> {
        let drawn: Result<_, GpuError> = target.draw(headless, [0.0, 1.0, 0.0, 1.0], |cmd| {
            self.cmd_draw(headless, cmd);
            Ok(())
        });
        drawn.unwrap()
    }

    fn statistics(&self, headless: &Headless, target: &Offscreen) -> Statistics {
        let counted: Result<_, GpuError> = headless.counted(|cmd| {
            unsafe {
                target.cmd_begin(cmd, [0.0; 4]);
                self.cmd_draw(headless, cmd);
                target.cmd_end(cmd);
            }
            Ok(())
        });
        counted.unwrap()
    }
}

fn pixel(pixels: &[u8], width: u32, x: u32, y: u32) -> [u8; 4] {
    let start = 4 * (y * width + x) as usize;
    pixels[start..start + 4].try_into().unwrap()
}

#[test]
fn clears_to_the_colour() {
    let headless = headless();
    let target = offscreen(&headless, 5, 3, vk::SampleCountFlags::TYPE_1);
    // Twice: an image that was read back can be drawn into again.
    for _ in 0..2 {
        let pixels: Result<_, GpuError> = target.draw(&headless, [1.0, 0.0, 0.2, 1.0], |_| Ok(()));
        assert_eq!(pixels.unwrap(), [255, 0, 51, 255].repeat(15));
    }
    drop(target);
    headless.finish_silent();
}

#[test]
fn tessellated_patches_have_their_pixels() {
    let headless = headless();
    let target = offscreen(&headless, 8, 4, vk::SampleCountFlags::TYPE_1);
    let row = Row::new(&headless, &target, 1, 3.0, shaders::QUAD_PATCH_VERT_NARROW, shaders::QUAD_PATCH_TESE);
    let pixels = row.pixels(&headless, &target);
    for (x, y) in (0..4).flat_map(|y| (0..8).map(move |x| (x, y))) {
        let inside = (2..6).contains(&x) && (1..3).contains(&y);
        assert_eq!(pixel(&pixels, 8, x, y), if inside { [0, 0, 255, 255] } else { [0, 255, 0, 255] }, "({x}, {y})");
    }
    drop((row, target));
    headless.finish_silent();
}

/// More patches than lavapipe can hold in one instance, and an uneven rest: every patch is where its number says.
#[test]
fn many_patches_are_all_drawn_once() {
    let headless = headless();
    let patches = 1030;
    let target = offscreen(&headless, patches, 2, vk::SampleCountFlags::TYPE_1);
    let row = Row::new(&headless, &target, patches, 9.0, shaders::QUAD_PATCH_VERT, shaders::QUAD_PATCH_TESE);
    let pixels = row.pixels(&headless, &target);
    for x in 0..patches {
        assert_eq!(pixel(&pixels, patches, x, 1), [x as u8, (x >> 8) as u8, 255, 255], "patch {x}");
    }
    drop((row, target));
    headless.finish_silent();
}

#[test]
fn four_samples_are_resolved() {
    let headless = headless();
    let target = offscreen(&headless, 6, 6, vk::SampleCountFlags::TYPE_4);
    // The patch covers pixels 1.5 to 4.5 both ways: half of the pixels at its edges, all of those within.
    let row = Row::new(&headless, &target, 1, 2.0, shaders::QUAD_PATCH_VERT_NARROW, shaders::QUAD_PATCH_TESE);
    let pixels = row.pixels(&headless, &target);
    assert_eq!(pixel(&pixels, 6, 0, 0), [0, 255, 0, 255]);
    assert_eq!(pixel(&pixels, 6, 3, 3), [0, 0, 255, 255]);
    // Two of four samples, whichever way the device rounds 127.5.
    let [r, g, b, a] = pixel(&pixels, 6, 1, 3);
    assert!(r == 0 && (127..=128).contains(&g) && (127..=128).contains(&b) && a == 255, "{r} {g} {b} {a}");
    drop((row, target));
    headless.finish_silent();
}

/// The formula for the vertices of a patch, against what the device counts.
#[test]
fn the_device_counts_as_many_vertices_as_we_do() {
    let headless = headless();
    let target = offscreen(&headless, 4, 4, vk::SampleCountFlags::TYPE_1);
    let cases = [
        (shaders::QUAD_PATCH_TESE, Domain::Quads, Spacing::Equal),
        (shaders::QUAD_PATCH_TESE_ODD, Domain::Quads, Spacing::FractionalOdd),
        (shaders::QUAD_PATCH_TESE_EVEN, Domain::Quads, Spacing::FractionalEven),
        (shaders::QUAD_PATCH_TESE_TRIANGLES, Domain::Triangles, Spacing::Equal),
    ];
    for (tese, domain, spacing) in cases {
        for level in [1.0, 2.0, 3.0, 7.5, 64.0] {
            let patches = 3;
            let row = Row::new(&headless, &target, patches, level, shaders::QUAD_PATCH_VERT, tese);
            let statistics = row.statistics(&headless, &target);
            let vertices = tessellated_vertices(domain, spacing, level, headless.properties().max_tessellation_level);
            let what = format!("{domain:?}, {spacing:?}, level {level}");
            assert_eq!(statistics.evaluation_invocations, u64::from(patches * vertices), "{what}");
            assert_eq!(statistics.control_patches, u64::from(patches), "{what}");
            assert_eq!(statistics.vertex_invocations, u64::from(4 * patches), "{what}");
        }
    }
    drop(target);
    headless.finish_silent();
}

#[test]
fn compute_doubles_a_buffer() {
    let headless = headless();
    let context = headless.context();
    let values: Vec<u32> = (0..1000).collect();
    let buffer = Buffer::with_data(context, "values", vk::BufferUsageFlags::STORAGE_BUFFER, &values).unwrap();
    let device = headless.device();
    unsafe {
        let binding = (vk::DescriptorType::STORAGE_BUFFER, vk::ShaderStageFlags::COMPUTE);
        let set_layout = descriptor_set_layout(context, "double", &[binding]).unwrap();
        let layout = pipeline_layout(context, "double", &[set_layout.raw()], &[]).unwrap();
        let desc = ComputePipelineDesc {
            name: "double",
            layout: layout.raw(),
            shader: Shader::compute(shaders::DOUBLE_COMP),
            cache: vk::PipelineCache::null(),
        };
        let pipeline = desc.create(context).unwrap();
        let sizes = [vk::DescriptorPoolSize { ty: vk::DescriptorType::STORAGE_BUFFER, descriptor_count: 1 }];
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        let pool = device.create_descriptor_pool(&info, None).of("vkCreateDescriptorPool", "double").unwrap();
        let pool = Owned::new(context, pool, "double");
        let set_layouts = [set_layout.raw()];
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool.raw()).set_layouts(&set_layouts);
        let sets = device.allocate_descriptor_sets(&info).unwrap();
        let infos = [buffer.descriptor()];
        let write = vk::WriteDescriptorSet::default()
            .dst_set(sets[0])
            .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
            .buffer_info(&infos);
        device.update_descriptor_sets(&[write], &[]);
        let record = |cmd| {
            device.cmd_bind_pipeline(cmd, vk::PipelineBindPoint::COMPUTE, pipeline.raw());
            device.cmd_bind_descriptor_sets(cmd, vk::PipelineBindPoint::COMPUTE, layout.raw(), 0, &sets, &[]);
            device.cmd_dispatch(cmd, 16, 1, 1);
            Ok::<(), GpuError>(())
        };
        let statistics = headless.counted(record).unwrap();
        assert_eq!(statistics.compute_invocations, 1024);
        let timing = headless.timed(record).unwrap();
        assert!(timing.device <= timing.host, "{timing:?}");
    }
    assert_eq!(buffer.read::<u32>(4 * 998, 2).unwrap(), [998 * 4, 999 * 4]);
    drop(buffer);
    headless.finish_silent();
}

#[test]
fn buffers_copy_and_check_their_bounds() {
    let headless = headless();
    let context = headless.context();
    let source =
        Buffer::with_data(context, "source", vk::BufferUsageFlags::TRANSFER_SRC, &[1.5_f32, 2.5, 3.5]).unwrap();
    let usage = vk::BufferUsageFlags::TRANSFER_DST | vk::BufferUsageFlags::TRANSFER_SRC;
    let desc = BufferDesc { name: "device", size: 12, usage, location: MemoryLocation::DeviceLocal };
    let device = Buffer::new(context, &desc).unwrap();
    let mut target =
        Buffer::new(context, &BufferDesc { name: "target", location: MemoryLocation::Readback, ..desc }).unwrap();
    let region = [vk::BufferCopy { src_offset: 0, dst_offset: 0, size: 12 }];
    headless
        .submit(|cmd| unsafe {
            headless.device().cmd_copy_buffer(cmd, source.raw(), device.raw(), &region);
            let barrier = [vk::MemoryBarrier2::default()
                .src_stage_mask(vk::PipelineStageFlags2::COPY)
                .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
                .dst_stage_mask(vk::PipelineStageFlags2::COPY)
                .dst_access_mask(vk::AccessFlags2::TRANSFER_READ)];
            let dependency = vk::DependencyInfo::default().memory_barriers(&barrier);
            headless.device().cmd_pipeline_barrier2(cmd, &dependency);
            headless.device().cmd_copy_buffer(cmd, device.raw(), target.raw(), &region);
        })
        .unwrap();
    assert_eq!(target.read::<f32>(0, 3).unwrap(), [1.5, 2.5, 3.5]);
    assert!(target.read::<f32>(12, 0).unwrap().is_empty());

    let text = |error: GpuError| error.to_string();
    assert_eq!(
        text(target.read::<f32>(4, 3).unwrap_err()),
        "target: bytes 4 to 16 are out of range: the buffer holds 12 bytes"
    );
    assert!(target.read::<f32>(u64::MAX, 1).is_err());
    assert!(target.write(8, &[1_u64]).is_err());
    // Where all memory can be mapped the allocator may map this too.
    if device.read::<u8>(0, 1).is_err() {
        assert!(text(device.read::<u8>(0, 1).unwrap_err()).starts_with("device: not mapped"));
    }
    let empty = Buffer::with_data::<f32>(context, "empty", usage, &[]).unwrap();
    assert_eq!(empty.size(), 4);
    drop((source, device, target, empty));
    headless.finish_silent();
}

#[test]
fn what_the_device_cannot_do_is_said() {
    let headless = headless();
    let context = headless.context();
    let huge = OffscreenDesc::new(1 << 20, 1);
    let error = Offscreen::new(&headless, &huge).err().unwrap().to_string();
    assert!(error.starts_with("offscreen colour: 1048576 x 1 pixels: the device has images of 1 to "), "{error}");

    let color = vk::ImageUsageFlags::COLOR_ATTACHMENT;
    let base = ImageDesc::new("picture", vk::Extent2D { width: 8, height: 3 }, vk::Format::R8G8B8A8_UNORM, color);
    assert!(Image::new(context, &ImageDesc { mip_levels: 4, ..base }).is_ok());
    let depth = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
    let transient = vk::ImageUsageFlags::TRANSIENT_ATTACHMENT;
    const NONE_SUCH: &str = " has no such images of the format R8G8B8A8_UNORM for DEPTH_STENCIL_ATTACHMENT: 8 x 3 pixels, 1 samples, 1 mip levels";
    for (desc, why) in [
        (ImageDesc { mip_levels: 0, ..base }, "0 mip levels: 8 x 3 pixels have 1 to 4"),
        (ImageDesc { mip_levels: 5, ..base }, "5 mip levels: 8 x 3 pixels have 1 to 4"),
        (ImageDesc { usage: vk::ImageUsageFlags::empty(), ..base }, "it is for no use of a view"),
        (ImageDesc { usage: vk::ImageUsageFlags::TRANSFER_DST, ..base }, "it is for no use of a view"),
        (ImageDesc { usage: color | transient | vk::ImageUsageFlags::SAMPLED, ..base }, "a transient attachment"),
        (ImageDesc { samples: vk::SampleCountFlags::empty(), ..base }, "samples are "),
        (
            ImageDesc { samples: vk::SampleCountFlags::TYPE_4, mip_levels: 2, ..base },
            "2 mip levels with several samples",
        ),
        (ImageDesc { usage: depth, ..base }, NONE_SUCH),
    ] {
        let error = Image::new(context, &desc).map(drop).unwrap_err().to_string();
        let told =
            if why == NONE_SUCH { error.contains(NONE_SUCH) } else { error.starts_with(&format!("picture: {why}")) };
        assert!(told, "{error}");
    }
    let no_use =
        BufferDesc { name: "idle", size: 4, usage: vk::BufferUsageFlags::empty(), location: MemoryLocation::Upload };
    let error = Buffer::new(context, &no_use).map(drop).unwrap_err().to_string();
    assert_eq!(error, "idle: it is for no use: name at least one");

    let target = offscreen(&headless, 4, 4, vk::SampleCountFlags::TYPE_1);
    let shaders = [Shader::vertex(shaders::QUAD_PATCH_VERT), Shader::fragment(shaders::PATCH_COLOR_FRAG)];
    let range = |stages, offset| vk::PushConstantRange { stage_flags: stages, offset, size: 16 };
    let both = [range(vk::ShaderStageFlags::COMPUTE, 0), range(vk::ShaderStageFlags::VERTEX, 16)];
    unsafe {
        let error = pipeline_layout(context, "mixed", &[], &both).unwrap_err().to_string();
        assert_eq!(error, "mixed: push constants for compute and for graphics: make two layouts");

        let layout = pipeline_layout(context, "plain", &[], &[]).unwrap();
        let base = GraphicsPipelineDesc::new("lone patches", layout.raw(), target.target(), &shaders);
        let error = GraphicsPipelineDesc { patch_control_points: 4, ..base.clone() }.create(context).unwrap_err();
        assert!(error.to_string().starts_with("lone patches: a tessellating pipeline has a TCS, a TES"), "{error}");
        for width in [1e9, 0.25, -1.0, f32::NAN] {
            let error = GraphicsPipelineDesc { line_width: width, ..base.clone() }.create(context).unwrap_err();
            assert!(error.to_string().starts_with(&format!("lone patches: lines of {width} pixels")), "{error}");
        }
    }
    drop(target);
    headless.finish_silent();
}

#[test]
fn validation_speaks_up() {
    let headless = headless();
    // A hazard that only synchronization validation sees: two writes of one buffer without a barrier.
    let desc = BufferDesc {
        name: "contended",
        size: 16,
        usage: vk::BufferUsageFlags::TRANSFER_DST,
        location: MemoryLocation::DeviceLocal,
    };
    let buffer = Buffer::new(headless.context(), &desc).unwrap();
    headless
        .submit(|cmd| unsafe {
            headless.device().cmd_fill_buffer(cmd, buffer.raw(), 0, 16, 1);
            headless.device().cmd_fill_buffer(cmd, buffer.raw(), 0, 16, 2);
        })
        .unwrap();
    let hazards = headless.validation_messages();
    assert!(hazards.iter().any(|m| m.contains("SYNC-HAZARD-WRITE-AFTER-WRITE")), "{hazards:?}");

    // A leak, heard when the device is destroyed.
    let info = vk::FenceCreateInfo::default();
    let leaked = unsafe { headless.device().create_fence(&info, None) }.unwrap();
    headless.context().set_name(leaked, "forgotten fence");
    drop(buffer);
    let all = headless.finish();
    assert!(all[hazards.len()..].iter().any(|m| m.contains("forgotten fence")), "{all:?}");
}

#[test]
fn objects_that_outlive_the_device_are_reported_and_harmless() {
    let headless = headless();
    let kept = Buffer::with_data(headless.context(), "kept", vk::BufferUsageFlags::TRANSFER_SRC, &[0_u32]).unwrap();
    let messages = headless.finish();
    assert_eq!(messages, ["the device is still in use: 2 references to its context are left"]);
    assert_eq!(kept.read::<u32>(0, 1).unwrap(), [0]);
}

#[test]
fn devices_are_listed_and_chosen() {
    let all = devices().unwrap();
    assert!(!all.is_empty());
    for device in &all {
        assert!(!device.properties.name.is_empty() && !device.api_version().is_empty());
    }
    let wanted = |device: &str| {
        let device = Some(device.to_owned());
        Headless::new(&HeadlessOptions { validation: true, device, ..HeadlessOptions::default() })
    };
    let usable = all.iter().find(|device| device.missing.is_empty()).unwrap();
    for name in [usable.index.to_string(), usable.properties.name.to_uppercase()] {
        let headless = wanted(&name).unwrap();
        assert_eq!(headless.properties().name, usable.properties.name);
        headless.finish_silent();
    }
    let error = wanted("no such GPU").err().unwrap();
    assert!(matches!(error, HeadlessError::NoSuchDevice { .. }));
    assert!(error.to_string().starts_with("device \"no such GPU\""), "{error}");
}

#[test]
fn devices_live_side_by_side() {
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for _ in 0..3 {
                    let headless = headless();
                    headless.submit(|_| ()).unwrap();
                    headless.finish_silent();
                }
            });
        }
    });
}
