//! What a device cannot hold or make is an error that says so.

use crate::common::stage::Stage;
use ash::vk::{Format, SampleCountFlags};
use ash_subdiv::capture::Captured;
use ash_subdiv::headless::{Headless, HeadlessOptions};
use ash_subdiv::renderer::Evaluation;
use ash_subdiv::{Construction, ControlMesh, ModelOptions, Options, Renderer, Target, grid_torus, shape};

#[test]
fn a_table_that_no_shader_can_see_is_an_error() {
    let options = HeadlessOptions { validation: true, storage_tables: true, ..HeadlessOptions::default() };
    let headless = Headless::new(&options).unwrap();
    let max = headless.properties().max_storage_buffer_range;
    // A ring of four faces has eight entries of four bytes: a mesh just too large, where one of these can be made at all.
    let side = (max as f64 / 32.0).sqrt().ceil() as u32 + 1;
    if max < 1 << 28 {
        let target = Target::dynamic(Format::R8G8B8A8_UNORM, Format::D32_SFLOAT, SampleCountFlags::TYPE_1);
        // SAFETY: nothing is recorded.
        let mut renderer = unsafe { Renderer::new(headless.context(), &target, &Options::default()) }.unwrap();
        let mesh = ControlMesh::new(grid_torus(side, side)).unwrap();
        let error = renderer.add_model(&mesh, &ModelOptions::default()).unwrap_err().to_string();
        let (before, after) =
            ("model 0: tables read as storage buffers take ", " at once on this device: split the mesh");
        let told = error.strip_prefix(before).and_then(|rest| rest.strip_suffix(after)).expect(&error);
        let (bytes, seen) = told.split_once(" bytes, but a shader can see ").expect(&error);
        assert!(bytes.parse::<u64>().unwrap() > max && seen == max.to_string(), "{error}");
        // The renderer is as it was before.
        assert_eq!(renderer.memory_usage().total(), renderer.memory_usage().views);
        renderer.add_model(&shape("cube").unwrap(), &ModelOptions::default()).unwrap();
    }
    headless.finish_silent();
}

#[test]
fn vertices_that_no_shader_can_see_are_an_error() {
    let stage = Stage::new();
    let max = stage.headless.properties().max_storage_buffer_range;
    let mut renderer = stage.renderer(&Options::default());
    let (construction, evaluation) = (Construction::Cached, Evaluation::Compute);
    let options = ModelOptions { construction, evaluation, ..ModelOptions::default() };
    let model = renderer.add_model(&shape("creature").unwrap(), &options).unwrap();
    let bytes = 24 * 1320 * 1025_u64.pow(2);
    if bytes > max {
        let error = renderer.set_segments(model, 1024).unwrap_err().to_string();
        let told = format!(
            "model 0: evaluated vertices take {bytes} bytes, but a shader can see {max} at once on this device: have fewer segments, or split the mesh"
        );
        assert_eq!(error, told);
    }
    drop(renderer);
    stage.finish();
}

/// Where texel buffers are too small for tables these are read as storage buffers, with the same results to the bit.
#[test]
fn tables_are_read_either_way() {
    let [texels, storage] = [false, true].map(|storage_tables| {
        let options = HeadlessOptions { validation: true, storage_tables, ..HeadlessOptions::default() };
        let headless = Headless::new(&options).unwrap();
        let large = headless.properties().max_texel_buffer_elements >= 1 << 27;
        assert_eq!(headless.properties().reads_texels, large && !storage_tables);
        let mut captured = Vec::new();
        let tessellated = Construction::ALL.map(|construction| (construction, Evaluation::Tessellation));
        for (construction, evaluation) in tessellated.into_iter().chain([(Construction::Cached, Evaluation::Instanced)])
        {
            // Meshes last, so that both can use the same pipelines.
            for name in ["creature-mixed", "cloth"] {
                let mesh = shape(name).unwrap();
                let options =
                    ModelOptions { construction, evaluation, shared_normals: true, ..ModelOptions::default() };
                let of_model = Captured::new(&headless, &mesh, &options).unwrap();
                let mut vertices = of_model.vertices(3.0).unwrap();
                vertices.sort_by_key(|v| (v.patch, v.coordinate.map(f32::to_bits)));
                captured.push((of_model.control_points().unwrap(), vertices));
            }
        }
        headless.finish_silent();
        captured
    });
    assert_eq!(texels.len(), 8);
    for ((points, vertices), (other_points, other_vertices)) in texels.iter().zip(&storage) {
        assert!(points == other_points && vertices == other_vertices);
    }
}

#[test]
fn a_grid_that_the_tessellator_cannot_make_is_an_error() {
    let headless = Headless::new(&HeadlessOptions { validation: true, ..HeadlessOptions::default() }).unwrap();
    let captured = Captured::new(&headless, &shape("cube").unwrap(), &ModelOptions::default()).unwrap();
    let max = headless.properties().max_tessellation_level + 1;
    for grid in [1, max + 1] {
        let error = captured.grid(grid).unwrap_err().to_string();
        assert_eq!(
            error,
            format!("grid {grid}: the tessellator of this device makes from 2 to {max} samples along a side")
        );
    }
    headless.finish_silent();
}
