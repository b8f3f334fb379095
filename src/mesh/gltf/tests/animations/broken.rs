//! Animations that are wrong: an error for who asks for them, and none for who does not.

use super::*;

/// The square, which moves.
fn moving() -> File {
    let mut file = square_at_node();
    let output = file.floats(&[[0.0f32; 3], [1.0; 3]]);
    file.channel(0, "translation", &[0.0, 1.0], output, "LINEAR");
    file
}

/// Breaks a file in one place.
#[track_caller]
fn assert_broken(change: impl Fn(&mut File), expected: &str) {
    let broken = || {
        let mut file = moving();
        change(&mut file);
        file
    };
    assert_eq!(broken().try_animated().map(|_| ()).unwrap_err().to_string(), expected);
    assert_eq!(broken().read().positions.len(), 4, "the mesh itself is read");
}

#[test]
fn nodes() {
    let children = |children: [Value; 2]| {
        move |file: &mut File| {
            let nodes = file.json["nodes"].as_array_mut().unwrap();
            nodes.extend(children.clone().map(|children| json!({ "children": children })));
        }
    };
    let missing = "node 9 does not exist, but is a child of node 1";
    assert_broken(children([json!([9]), json!([0])]), missing);
    // Beside the scene, which has a root.
    let circle = "nodes are each other's children: give the scene a root";
    assert_broken(children([json!([2]), json!([1])]), circle);
}

#[test]
fn channels_and_samplers() {
    let channel = |key: &'static str, value: Value| {
        move |file: &mut File| file.json["animations"][0]["channels"][0][key] = value.clone()
    };
    let sampler = |key: &'static str, value: Value| {
        move |file: &mut File| file.json["animations"][0]["samplers"][0][key] = value.clone()
    };
    assert_broken(channel("sampler", json!(3)), "animation 0, channel 0: sampler 3 does not exist");
    let target = json!({ "node": 7, "path": "scale" });
    assert_broken(channel("target", target), "animation 0, channel 0: node 7 does not exist");
    let target = json!({ "node": 0, "path": "rotation" });
    assert_broken(channel("target", target), "accessor 2 is a VEC3, but a VEC4 is needed");
    assert_broken(
        sampler("interpolation", json!("SMOOTH")),
        "animation 0, channel 0: interpolation \"SMOOTH\" is unknown: use LINEAR, STEP or CUBICSPLINE",
    );
    assert_broken(
        sampler("interpolation", json!("CUBICSPLINE")),
        "animation 0, channel 0: 2 values do not go with 2 times and 3 values a key",
    );
    assert_broken(sampler("output", json!(99)), "accessor 99 does not exist, but something names it");
    let times = |times: &'static [f32]| {
        move |file: &mut File| {
            let input = file.floats(&times.iter().map(|&time| [time]).collect::<Vec<_>>());
            file.json["animations"][0]["samplers"][0]["input"] = json!(input);
        }
    };
    let expected = "animation 0, channel 0: its times must be finite numbers that increase, one at least";
    assert_broken(times(&[1.0, 1.0]), expected);
    assert_broken(times(&[2.0, 1.0]), expected);
    assert_broken(times(&[0.0, f32::NAN]), expected);
    let nothing = |file: &mut File| {
        let huge = json!({ "componentType": 5126, "count": 1u64 << 40, "type": "SCALAR" });
        let input = file.push("accessors", huge);
        file.json["animations"][0]["samplers"][0]["input"] = json!(input);
    };
    assert_broken(nothing, "animation 0, channel 0: times and values need a buffer view: write the file again");
    let infinite = |file: &mut File| {
        let output = file.floats(&[[0.0f32; 3], [f32::INFINITY; 3]]);
        file.json["animations"][0]["samplers"][0]["output"] = json!(output);
    };
    assert_broken(infinite, "animation 0, channel 0: a value is not a finite number");
    let mut file = moving();
    file.json["animations"] = json!([{ "channels": 3 }]);
    let error = file.try_animated().unwrap_err().to_string();
    assert!(error.starts_with("animations and skins: invalid type: integer `3`, expected a sequence"), "{error}");
}

#[test]
fn skins_and_targets() {
    let skin = |skin: Value| {
        move |file: &mut File| {
            file.json["skins"] = json!([skin]);
            file.json["nodes"][0]["skin"] = json!(0);
        }
    };
    assert_broken(skin(json!({ "joints": [4] })), "skin 0 names node 4 as a joint, but there are 1");
    let short = |file: &mut File| {
        let matrices = file.matrices(&[translation([0.0; 3])]);
        skin(json!({ "joints": [0, 0], "inverseBindMatrices": matrices }))(file);
    };
    assert_broken(short, "skin 0 has 1 inverse bind matrices, but 2 joints");
    assert_broken(|file| file.json["nodes"][0]["skin"] = json!(2), "skin 2 does not exist, but a node names it");
    let bound = |weight: f32, joint: u8, count: usize| {
        move |file: &mut File| {
            skin(json!({ "joints": [0] }))(file);
            let joints = file.accessor(&[joint, 0, 0, 0].repeat(count), count, "VEC4", 5121);
            let weights = file.floats(&[[weight, 0.0, 0.0, 0.0]; 4]);
            file.primitive_mut()["attributes"]["JOINTS_0"] = json!(joints);
            file.primitive_mut()["attributes"]["WEIGHTS_0"] = json!(weights);
        }
    };
    assert_broken(bound(-0.5, 0, 4), "vertex 0 has a joint's weight -0.5: weights are numbers from 0 to 1");
    assert_broken(bound(f32::NAN, 0, 4), "vertex 0 has a joint's weight NaN: weights are numbers from 0 to 1");
    assert_broken(bound(1.0, 1, 4), "vertex 0 names joint 1, but the skin has 1");
    assert_broken(bound(1.0, 0, 3), "JOINTS_0 has 3 elements, but POSITION has 4");
    let target = |file: &mut File| {
        let offsets = file.floats(&[[0.0f32; 3]; 3]);
        file.primitive_mut()["targets"] = json!([{ "POSITION": offsets }]);
    };
    assert_broken(target, "POSITION of a morph target has 3 elements, but POSITION has 4");
}

#[test]
fn positions_that_leave_single_precision() {
    let mut file = moving();
    let output = file.floats(&[[0.0f32; 3], [f32::MAX, 0.0, 0.0]]);
    file.json["animations"][0]["samplers"][0]["output"] = json!(output);
    file.json["nodes"][0]["scale"] = json!([1e30, 1, 1]);
    let output = file.floats(&[[1e38f32, 1.0, 1.0], [f32::MAX, 1.0, 1.0]]);
    file.channel(0, "scale", &[0.0, 1.0], output, "LINEAR");
    let animated = file.animated();
    let error = animated.animations.positions(0, 1.0, &mut [[0.0f32; 3]; 4]).unwrap_err();
    assert!(error.to_string().starts_with("vertex 1 is at ("), "{error}");
}

#[test]
fn what_extensions_move_is_passed_over() {
    let mut file = moving();
    let channels = file.json["animations"][0]["channels"].as_array_mut().unwrap();
    channels.push(json!({ "sampler": 0, "target": { "path": "pointer" } }));
    channels.push(json!({ "sampler": 0, "target": { "node": 0, "path": "visibility" } }));
    let animated = file.animated();
    assert_eq!(animated.animations.notes(), ["animation 0, channel 2 moves \"visibility\" and is passed over"]);
    assert_eq!(positions(&animated, 1.0)[0], [1.0; 3]);
}
