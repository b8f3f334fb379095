//! Items that cannot be drawn: whoever records something of them says so, in the same words.

use crate::common::stage::Stage;
use ash_subdiv::renderer::{Cull, Evaluation, Factor};
use ash_subdiv::{DrawItem, Error, ModelOptions, Options, Renderer, View, shape};

/// What `cmd_draw` refuses, `cmd_cull` refuses, so that nothing is left for `cmd_draw_visible` to refuse.
#[test]
fn items_are_refused_before_they_are_culled() {
    let stage = Stage::new();
    let mesh = shape("cube").expect("built in");
    let options = Options { visible_lists: true, views_per_frame: 64, ..Options::default() };
    let mut renderer = stage.renderer(&options);
    let add = |renderer: &mut Renderer, evaluation| {
        renderer.add_model(&mesh, &ModelOptions::evaluated(evaluation)).expect("a model")
    };
    let [tessellated, removed] = [0; 2].map(|_| add(&mut renderer, Evaluation::Tessellation));
    let instanced = add(&mut renderer, Evaluation::Instanced);
    let [geometry, subdivision] = [Evaluation::Geometry, Evaluation::Subdivision].map(|e| add(&mut renderer, e));
    renderer.remove_model(removed).expect("a model");
    let frame = stage.frame(&mut renderer);
    let late = add(&mut renderer, Evaluation::Tessellation);
    let item = |model, factor| DrawItem { cull: Cull::ALL, ..DrawItem::new(model, factor) };
    let plain = item(tessellated, Factor::Uniform(2.0));
    let (sized, unsized_) = (Stage::view().sized(96, 96), View { viewport: [0.0; 2], ..Stage::view() });
    for (view, item) in [
        (sized, item(removed, Factor::Uniform(2.0))),
        (sized, item(late, Factor::Uniform(2.0))),
        (sized, DrawItem { style: 1, ..plain }),
        (sized, item(tessellated, Factor::Uniform(0.5))),
        (sized, item(tessellated, Factor::Uniform(f32::NAN))),
        (sized, item(tessellated, Factor::Pixels(0.0))),
        (unsized_, item(tessellated, Factor::Pixels(4.0))),
        (unsized_, plain),
        (sized, DrawItem { displacement: [f32::INFINITY, 0.0], ..plain }),
        (sized, item(tessellated, Factor::Edges(1.0))),
        (sized, item(tessellated, Factor::Segments)),
        (sized, item(instanced, Factor::Segments)),
        (sized, item(instanced, Factor::Uniform(2.0))),
        (sized, item(geometry, Factor::Pixels(4.0))),
        (sized, item(geometry, Factor::Uniform(5000.0))),
        (sized, item(subdivision, Factor::Uniform(3.0))),
    ] {
        // SAFETY: the command buffer is being recorded.
        let culled = stage.headless.try_submit(|cmd| unsafe { renderer.cmd_cull(cmd, frame, &view, &[item]) });
        let draw = |cmd| {
            // SAFETY: as above, inside rendering.
            unsafe { renderer.cmd_draw(cmd, frame, &view, &[item]) }
        };
        let drawn: Result<_, Error> = stage.target.draw(&stage.headless, [0.0; 4], draw);
        match (culled, drawn) {
            (Err(culled), Err(drawn)) => assert_eq!(culled.to_string(), drawn.to_string()),
            (culled, drawn) => panic!("{item:?}: culled: {}, drawn: {}", culled.is_ok(), drawn.is_ok()),
        }
    }
    // And what is fine is drawn.
    let visible = stage.headless.try_submit(|cmd| {
        // SAFETY: as above.
        unsafe { renderer.cmd_cull(cmd, frame, &sized, &[plain]) }
    });
    let visible = visible.expect("lists");
    // SAFETY: as above, inside rendering.
    let record = |cmd| unsafe { renderer.cmd_draw_visible(cmd, frame, &visible) };
    let picture = stage.target.draw(&stage.headless, [0.0; 4], record).expect("a picture");
    assert!(picture.chunks(4).filter(|pixel| pixel[3] > 0).count() > 500);
    drop(renderer);
    stage.finish();
}
