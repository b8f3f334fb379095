//! Pictures and captures through the public module.
use ash_subdiv::headless::*;
use ash_subdiv::*;

#[test]
fn smoke() {
    let headless = Headless::new(&HeadlessOptions { validation: true, ..Default::default() }).unwrap();
    let target = Offscreen::new(&headless, &OffscreenDesc::new(512, 512)).unwrap();
    for name in
        ["creature", "creature-mixed", "valences", "machine-part", "cloth", "polygons", "cube", "tetrahedron", "fan"]
    {
        for construction in [Construction::TwoStage, Construction::Stencil] {
            let mesh = shape(name).unwrap();
            let options = Options {
                styles: vec![Style { cull: ash::vk::CullModeFlags::BACK, ..Style::default() }, Style::wireframe()],
                ..Options::default()
            };
            let t = ash_subdiv::renderer::Target::dynamic(
                target.desc().color,
                ash::vk::Format::D32_SFLOAT,
                ash::vk::SampleCountFlags::TYPE_1,
            );
            let mut renderer = unsafe { Renderer::new(headless.context(), &t, &options) }.unwrap();
            let model = renderer.add_model(&mesh, &ModelOptions { construction, ..Default::default() }).unwrap();
            headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, 0) }).unwrap();
            let view = View::framing(mesh.bounds(), [-0.5, 0.3, 1.0], 1.0);
            let colours = [[0.9, 0.6, 0.1, 1.0], [0.45, 0.2, 0.6, 1.0], [0.1, 0.5, 0.2, 1.0]];
            let mut item = DrawItem::new(model, 6.0);
            item.colours = colours;
            let pixels = target
                .draw(&headless, [0.1, 0.1, 0.1, 1.0], |cmd| unsafe { renderer.cmd_draw(cmd, 0, &view, &[item]) })
                .unwrap();
            let _ = pixels;
            target.save_png(format!("target/smoke/{name}-{}.png", construction.name())).unwrap();
            drop(renderer);
        }
    }
    drop(target);
    println!("{:?}", headless.validation_messages());
    headless.finish_silent();
}
