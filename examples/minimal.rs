//! One smooth surface in a Vulkan program of its own: plain `ash` and `gpu-allocator`, no window, a PNG at the end.
//!
//!     cargo run --example minimal -- creature.png
//!
//! `subdiv:` marks what the crate adds. An error ends the program without tidying up.
#![allow(unsafe_op_in_unsafe_fn, reason = "nearly every line is a Vulkan call")]

use ash::vk::{
    self, AccessFlags as Access, ImageLayout as Layout, ImageUsageFlags as Usage, PipelineStageFlags as Stage,
};
use ash_subdiv::{DeviceContext, DrawItem, ModelOptions, Options, Renderer, Target, View, shape};
use gpu_allocator::{MemoryLocation, vulkan as ga, vulkan::AllocationScheme};
use std::error::Error;
use std::sync::{Arc, Mutex};

const EXTENT: vk::Extent2D = vk::Extent2D { width: 1024, height: 768 };
const COLOR: vk::Format = vk::Format::R8G8B8A8_SRGB; // the shaders write linear colours: let the format encode them
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
const SAMPLES: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_4;

fn main() -> Result<(), Box<dyn Error>> {
    // SAFETY: all calls in it are valid; the validation layer says so too.
    unsafe { draw(&std::env::args().nth(1).unwrap_or("creature.png".into())) }
}

pub(crate) unsafe fn draw(path: &str) -> Result<(), Box<dyn Error>> {
    // subdiv: what to draw into and in which styles; from that follows what the device must have.
    let target = Target::dynamic(COLOR, DEPTH, SAMPLES);
    let options = Options { frames_in_flight: 1, ..Options::default() };
    let needs = ash_subdiv::requirements(&target, &options);
    let entry = ash::Entry::load()?;
    let application = vk::ApplicationInfo::default().api_version(needs.api_version);
    let info = vk::InstanceCreateInfo::default().application_info(&application);
    let instance = entry.create_instance(&info, None)?;
    let physical_device = *instance.enumerate_physical_devices()?.first().ok_or("there is no Vulkan device")?;
    // subdiv: the error names everything that is missing. Of several devices, take one that passes.
    ash_subdiv::check(&instance, physical_device, &target, &options)?;
    let families = instance.get_physical_device_queue_family_properties(physical_device);
    let family = families.iter().position(|family| family.queue_flags.contains(vk::QueueFlags::GRAPHICS));
    let family = family.ok_or("the device does not draw")? as u32;
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
    let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues);
    // subdiv: `chain` makes the structures that turn the features on.
    let device = needs.features.chain(|f| instance.create_device(physical_device, &info.push_next(f), None))?;
    let queue = device.get_device_queue(family, 0);
    let allocator = Arc::new(Mutex::new(ga::Allocator::new(&ga::AllocatorCreateDesc {
        instance: instance.clone(),
        device: device.clone(),
        physical_device,
        debug_settings: Default::default(),
        buffer_device_address: false,
        allocation_sizes: Default::default(),
    })?));

    // The images to draw into: the samples, the picture they are resolved to, depth; and a buffer to read from.
    let allocate = |requirements, location| -> Result<ga::Allocation, Box<dyn Error>> {
        let (linear, allocation_scheme) = (location != MemoryLocation::GpuOnly, AllocationScheme::GpuAllocatorManaged);
        let desc = ga::AllocationCreateDesc { name: "target", requirements, location, linear, allocation_scheme };
        Ok(allocator.lock().map_err(|_| "a thread panicked")?.allocate(&desc)?)
    };
    let attachment = |format, aspect_mask, samples, usage| -> Result<_, Box<dyn Error>> {
        let info = vk::ImageCreateInfo::default().image_type(vk::ImageType::TYPE_2D).extent(EXTENT.into());
        let info = info.format(format).mip_levels(1).array_layers(1).samples(samples).usage(usage);
        let image = device.create_image(&info, None)?;
        let memory = allocate(device.get_image_memory_requirements(image), MemoryLocation::GpuOnly)?;
        device.bind_image_memory(image, memory.memory(), memory.offset())?;
        let range = vk::ImageSubresourceRange { aspect_mask, level_count: 1, layer_count: 1, ..Default::default() };
        let info = vk::ImageViewCreateInfo::default().image(image).view_type(vk::ImageViewType::TYPE_2D);
        let view = device.create_image_view(&info.format(format).subresource_range(range), None)?;
        Ok((image, view, range, memory))
    };
    let (is_color, single) = (vk::ImageAspectFlags::COLOR, vk::SampleCountFlags::TYPE_1);
    let samples = attachment(COLOR, is_color, SAMPLES, Usage::COLOR_ATTACHMENT)?;
    let picture = attachment(COLOR, is_color, single, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC)?;
    let depth = attachment(DEPTH, vk::ImageAspectFlags::DEPTH, SAMPLES, Usage::DEPTH_STENCIL_ATTACHMENT)?;
    let size = 4 * u64::from(EXTENT.width * EXTENT.height);
    let info = vk::BufferCreateInfo::default().size(size).usage(vk::BufferUsageFlags::TRANSFER_DST);
    let buffer = device.create_buffer(&info, None)?;
    let pixels = allocate(device.get_buffer_memory_requirements(buffer), MemoryLocation::GpuToCpu)?;
    device.bind_buffer_memory(buffer, pixels.memory(), pixels.offset())?;

    // subdiv: the renderer, on our device and with our allocator, and a model in it.
    let context = DeviceContext::new(&instance, physical_device, &device, allocator.clone(), needs.context_options());
    let mut renderer = Renderer::new(&context, &target, &options)?;
    let mesh = shape("creature")?;
    let model = renderer.add_model(&mesh, &ModelOptions::default())?;
    let view = View::framing(mesh.bounds(), [-0.5, 0.3, 1.0], EXTENT.width as f32 / EXTENT.height as f32);
    let item = DrawItem::new(model, 16.0).color([0.8, 0.45, 0.25, 1.0]);
    let pool = device.create_command_pool(&vk::CommandPoolCreateInfo::default().queue_family_index(family), None)?;
    let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
    let cmd = device.allocate_command_buffers(&info)?[0];
    device.begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())?;
    // subdiv: a frame, and its copies and barriers before rendering begins.
    let frame = renderer.begin_frame();
    renderer.cmd_prepare(cmd, frame)?;
    // Each barrier is for everything: a program that does more than this says more closely what waits for what.
    let (all, written, used) = (Stage::ALL_COMMANDS, Access::MEMORY_WRITE, Access::MEMORY_READ | Access::MEMORY_WRITE);
    let memory = [vk::MemoryBarrier::default().src_access_mask(written).dst_access_mask(used)];
    let barrier = |changes: &[vk::ImageMemoryBarrier]| {
        device.cmd_pipeline_barrier(cmd, all, all | Stage::HOST, Default::default(), &memory, &[], changes);
    };
    let change = |&(image, _, range, _): &(_, _, _, ga::Allocation), from, to| {
        let barrier = vk::ImageMemoryBarrier::default().image(image).subresource_range(range);
        barrier.src_access_mask(written).dst_access_mask(used).old_layout(from).new_layout(to)
    };
    let (color, near) = (Layout::COLOR_ATTACHMENT_OPTIMAL, Layout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    let layouts = [(&samples, color), (&picture, color), (&depth, near)];
    barrier(&layouts.map(|(attachment, layout)| change(attachment, Layout::UNDEFINED, layout)));
    let cleared = vk::RenderingAttachmentInfo::default().load_op(vk::AttachmentLoadOp::CLEAR);
    let background = vk::ClearValue { color: vk::ClearColorValue { float32: [0.02, 0.02, 0.03, 1.0] } };
    let far = vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 1.0, stencil: 0 } };
    let drawn = cleared.image_view(samples.1).image_layout(color).clear_value(background);
    let drawn = drawn.resolve_mode(vk::ResolveModeFlags::AVERAGE).resolve_image_view(picture.1);
    let (drawn, nearest) = ([drawn.resolve_image_layout(color)], cleared.image_view(depth.1).image_layout(near));
    let area = vk::Rect2D::default().extent(EXTENT);
    let info = vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&drawn);
    device.cmd_begin_rendering(cmd, &info.depth_attachment(&nearest.clear_value(far)));
    let (width, height) = (EXTENT.width as f32, EXTENT.height as f32);
    device.cmd_set_viewport(cmd, 0, &[vk::Viewport { width, height, max_depth: 1.0, ..Default::default() }]);
    device.cmd_set_scissor(cmd, 0, &[area]);
    // subdiv: among draws of our own, if there were any; viewport and scissor are ours too.
    renderer.cmd_draw(cmd, frame, &view, &[item])?;
    device.cmd_end_rendering(cmd);
    barrier(&[change(&picture, color, Layout::TRANSFER_SRC_OPTIMAL)]);
    let layers = vk::ImageSubresourceLayers::default().aspect_mask(is_color).layer_count(1);
    let region = vk::BufferImageCopy::default().image_subresource(layers).image_extent(EXTENT.into());
    device.cmd_copy_image_to_buffer(cmd, picture.0, Layout::TRANSFER_SRC_OPTIMAL, buffer, &[region]);
    barrier(&[]);
    device.end_command_buffer(cmd)?;
    device.queue_submit(queue, &[vk::SubmitInfo::default().command_buffers(&[cmd])], vk::Fence::null())?;
    device.queue_wait_idle(queue)?; // where there are more frames, each has a fence
    let bytes = &pixels.mapped_slice().ok_or("the pixels are not mapped")?[..size as usize];
    image::save_buffer(path, bytes, EXTENT.width, EXTENT.height, image::ColorType::Rgba8)?;

    // subdiv: the renderer goes when its last frame is done, and before the allocator, the device and the instance.
    drop((renderer, context));
    device.destroy_command_pool(pool, None);
    device.destroy_buffer(buffer, None);
    let mut allocator = Arc::into_inner(allocator).ok_or("the allocator is still in use")?.into_inner()?;
    allocator.free(pixels)?;
    for (image, view, _, memory) in [samples, picture, depth] {
        device.destroy_image_view(view, None);
        device.destroy_image(image, None);
        allocator.free(memory)?;
    }
    drop(allocator);
    device.destroy_device(None);
    instance.destroy_instance(None);
    Ok(())
}
