//! Keys, what is between them, and what moves nodes.

use super::*;

const TIMES: [f32; 3] = [0.5, 1.5, 3.5];

/// The first vertex of the square, which is at the origin, at some times: it is where the node is.
fn origin(file: File, times: &[f64]) -> Vec<[f64; 3]> {
    let animated = file.animated();
    times.iter().map(|&seconds| positions(&animated, seconds)[0]).collect()
}

#[test]
fn linear_and_step_and_the_ends() {
    let moved = |interpolation| {
        let mut file = square_at_node();
        let output = file.floats(&[[1.0f32, 2.0, 3.0], [3.0, 2.0, -1.0], [7.0, 0.0, 0.0]]);
        file.channel(0, "translation", &TIMES, output, interpolation);
        origin(file, &[-1.0, 0.0, 0.5, 1.0, 1.5, 2.0, 3.5, 100.0])
    };
    let (first, middle, last) = ([1., 2., 3.], [3., 2., -1.], [7., 0., 0.]);
    let expected = [first, first, first, [2., 2., 1.], middle, [4., 1.5, -0.75], last, last];
    assert_near(&moved("LINEAR"), &expected, 1e-15);
    let expected = [first, first, first, first, middle, middle, last, last];
    assert_near(&moved("STEP"), &expected, 0.0);
}

#[test]
fn linear_if_nothing_else_is_said() {
    let mut file = square_at_node();
    let output = file.floats(&[[0.0f32; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    file.channel(0, "translation", &TIMES, output, "LINEAR");
    file.json["animations"][0]["samplers"][0].as_object_mut().unwrap().remove("interpolation");
    assert_near(&origin(file, &[1.0]), &[[0.5, 0., 0.]], 1e-15);
}

/// A cubic between two keys by its Bezier points, halved again and again towards t.
fn bezier<const N: usize>(key: [[f64; N]; 2], tangents: [[f64; N]; 2], span: f64, t: f64) -> [f64; N] {
    let third = |i: usize, sign: f64| std::array::from_fn(|c| key[i][c] + sign * span * tangents[i][c] / 3.0);
    let mut points: Vec<[f64; N]> = vec![key[0], third(0, 1.0), third(1, -1.0), key[1]];
    while points.len() > 1 {
        let between = |pair: &[[f64; N]]| std::array::from_fn(|c| (1.0 - t) * pair[0][c] + t * pair[1][c]);
        points = points.windows(2).map(between).collect();
    }
    points[0]
}

#[test]
fn cubic_splines_have_tangents_in_units_a_second() {
    let values = [[0., 1., 2.], [4., -1., 0.], [1., 1., 1.]];
    let into = [[9., 9., 9.], [1., 2., -1.], [0.5, 0., 3.]];
    let out = [[-2., 1., 0.], [3., -3., 1.], [9., 9., 9.]];
    let mut file = square_at_node();
    let elements: Vec<[f32; 3]> =
        (0..3).flat_map(|k| [into[k], values[k], out[k]]).map(|v| v.map(|x: f64| x as f32)).collect();
    let output = file.floats(&elements);
    file.channel(0, "translation", &TIMES, output, "CUBICSPLINE");
    let expected = [
        values[0],
        values[0],
        bezier([values[0], values[1]], [out[0], into[1]], 1.0, 0.25),
        values[1],
        bezier([values[1], values[2]], [out[1], into[2]], 2.0, 0.75),
        values[2],
    ];
    assert_near(&origin(file, &[0.0, 0.5, 0.75, 1.5, 3.0, 4.0]), &expected, 1e-14);
}

/// The square turns about an axis from angle to angle; quaternions are multiplied with the signs.
fn turning(angles: [f64; 3], signs: [f32; 3]) -> Animated {
    let mut file = square_at_node();
    let keys: Vec<[f32; 4]> = (0..3).map(|k| quaternion(AXIS, angles[k]).map(|x| signs[k] * x)).collect();
    let output = file.floats(&keys);
    file.channel(0, "rotation", &TIMES, output, "LINEAR");
    file.animated()
}

#[test]
fn rotations_turn_at_even_speed_whatever_the_sign_of_their_quaternions() {
    let angles = [0.3, 2.1, -0.6];
    for signs in [[1., 1., 1.], [1., -1., 1.], [-1., 1., -1.], [-1., -1., 1.]] {
        let animated = turning(angles, signs);
        for t in [0.0, 0.2, 0.5, 0.9, 1.0] {
            for (k, span) in [(0, 1.0), (1, 2.0)] {
                let angle = (1.0 - t) * angles[k] + t * angles[k + 1];
                let expected = SQUARE.map(|p| apply(turn(AXIS, angle), p.map(f64::from)));
                // Files have quaternions in single precision.
                assert_near(&positions(&animated, f64::from(TIMES[k]) + t * span), &expected, 3e-7);
            }
        }
    }
}

#[test]
fn rotations_go_the_shorter_way_and_small_ones_are_even_too() {
    // From 170 to -170 degrees it is 20 degrees by way of 180.
    let animated = turning([170f64.to_radians(), -170f64.to_radians(), -170f64.to_radians()], [1.0; 3]);
    let expected = SQUARE.map(|p| apply(turn(AXIS, 180f64.to_radians()), p.map(f64::from)));
    assert_near(&positions(&animated, 1.0), &expected, 3e-7);
    // Equal keys, and nearly equal ones.
    for angle in [0.0, 1e-3, 0.05] {
        let animated = turning([0.0, angle, angle], [1.0, -1.0, 1.0]);
        let expected = SQUARE.map(|p| apply(turn(AXIS, 0.25 * angle), p.map(f64::from)));
        assert_near(&positions(&animated, 0.75), &expected, 1e-7 * angle + 1e-9);
    }
}

#[test]
fn cubic_rotations_are_made_unit() {
    let values = [quaternion(AXIS, 0.2), quaternion([0., 1., 0.], 1.0)];
    let (out, into) = ([0.5f32, -0.25, 1.0, 0.5], [0.0f32, 1.0, 0.5, -1.0]);
    let mut file = square_at_node();
    let output = file.floats(&[[9.0; 4], values[0], out, into, values[1], [9.0; 4]]);
    file.channel(0, "rotation", &[1.0, 3.0], output, "CUBICSPLINE");
    let double = |q: [f32; 4]| q.map(f64::from);
    let [x, y, z, w] = bezier(values.map(double), [double(out), double(into)], 2.0, 0.375);
    let length = (x * x + y * y + z * z).sqrt();
    let expected = turn([x / length, y / length, z / length], 2.0 * length.atan2(w));
    let expected = SQUARE.map(|p| apply(expected, p.map(f64::from)));
    assert_near(&positions(&file.animated(), 1.75), &expected, 1e-14);
}

#[test]
fn nodes_move_their_children_and_a_matrix_can_be_moved() {
    let mut file = square_at_node();
    let parent = times(translation([1., 2., 3.]), scale([2., 2., 2.]));
    let by_columns: Vec<f64> = (0..16).map(|i| parent[i % 4][i / 4]).collect();
    file.json["nodes"] = json!([
        { "mesh": 0, "translation": [0, 0, 5], "scale": [1, 3, 1] },
        { "children": [0], "matrix": by_columns },
    ]);
    file.json["scenes"] = json!([{ "nodes": [1] }]);
    let output = file.floats(&[quaternion(AXIS, 0.0), quaternion(AXIS, 1.0)]);
    file.channel(1, "rotation", &[0.0, 1.0], output, "LINEAR");
    let output = file.floats(&[[1.0f32, 3.0, 1.0], [3.0, 1.0, 1.0]]);
    file.channel(0, "scale", &[0.0, 1.0], output, "LINEAR");
    let child = times(translation([0., 0., 5.]), scale([2., 2., 1.]));
    let global = times(translation([1., 2., 3.]), times(turn(AXIS, 0.5), times(scale([2., 2., 2.]), child)));
    let expected = SQUARE.map(|p| apply(global, p.map(f64::from)));
    assert_near(&positions(&file.animated(), 0.5), &expected, 2e-6);
}

#[test]
fn numbers_of_all_kinds() {
    // Rotations in shorts, as quantized files have them.
    let mut file = square_at_node();
    let quarter = (0.5f64.sqrt() * 32767.0).round() as i16;
    let bytes: Vec<u8> =
        [[0, 0, 0, i16::MAX], [0, 0, quarter, quarter]].as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    let output = file.accessor(&bytes, 2, "VEC4", 5122);
    file.json["accessors"][output]["normalized"] = json!(true);
    file.channel(0, "rotation", &[0.0, 1.0], output, "LINEAR");
    let expected = SQUARE.map(|p| apply(turn([0., 0., 1.], 90f64.to_radians() / 2.0), p.map(f64::from)));
    assert_near(&positions(&file.animated(), 0.5), &expected, 1e-14);
}

#[test]
fn animations_are_found_by_name_and_number() {
    let mut file = square_at_node();
    let output = file.floats(&[[0.0f32; 3], [1.0; 3]]);
    file.channel(0, "translation", &[0.0, 2.0], output, "LINEAR");
    let mut second = file.json["animations"][0].clone();
    second["name"] = json!("Walk");
    file.json["animations"].as_array_mut().unwrap().push(second);
    let Animated { animations, .. } = file.animated();
    assert_eq!((animations.len(), animations.name(0), animations.name(1)), (2, None, Some("Walk")));
    assert_eq!((animations.duration(0), animations.duration(2)), (2.0, 0.0));
    assert_eq!((animations.find("0"), animations.find("1"), animations.find("Walk")), (Ok(0), Ok(1), Ok(1)));
    let error = |name: &str| animations.find(name).unwrap_err().to_string();
    assert_eq!(error("Run"), "there is no animation \"Run\": choose one of 0, \"Walk\"");
    assert_eq!(error("2"), "there is no animation \"2\": choose one of 0, \"Walk\"");
    assert_eq!(Animations::default().find("0").unwrap_err().to_string(), "there is no animation \"0\": it has none");
    let mut positions = [[0.0f32; 3]; 4];
    let error = |result: Result<(), MeshError>| result.unwrap_err().to_string();
    assert_eq!(
        error(animations.positions(0, 0.0, &mut positions[..3])),
        "3 positions are to be filled, but the mesh has 4 vertices"
    );
    assert_eq!(
        error(animations.positions(0, f64::NAN, &mut positions)),
        "NaN is no time of an animation: it must be a finite number of seconds"
    );
    assert!(error(animations.positions(2, 0.0, &mut positions)).starts_with("there is no animation \"2\": "));
}

#[test]
fn files_without_animations_have_none() {
    let animated = File::square().animated();
    assert!(animated.animations.is_empty() && animated.mesh.vertex_count() == 4);
}
