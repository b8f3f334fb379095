//! Nodes, transforms, and the choice by name.

use super::*;

/// Nodes on the square, all of them in the scene unless they are children.
fn scene(nodes: Value, roots: Value) -> File {
    let mut file = File::square();
    file.json["meshes"][0]["name"] = json!("Square");
    file.json["nodes"] = nodes;
    file.json["scenes"] = json!([{ "nodes": roots }]);
    file.json["scene"] = json!(0);
    file
}

#[test]
fn transforms_of_the_hierarchy() {
    let half_turn_about_x = json!([1, 0, 0, 0]);
    let data = scene(
        json!([
            { "translation": [10, 0, 0], "children": [1] },
            { "rotation": half_turn_about_x, "scale": [1, 2, 3], "children": [2] },
            { "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1], "mesh": 0 },
        ]),
        json!([0]),
    )
    .read();
    // (x, y, z) -> (-y, x, z + 5) -> (., 2 ., 3 .) -> (., -., -.) -> (. + 10, ., .)
    assert_eq!(data.positions, [[10., 0., -15.], [10., -2., -15.], [9., -2., -15.], [9., 0., -15.]]);
    assert_eq!(data.face_vertices, [0, 1, 2, 3]);
}

#[test]
fn transforms_of_skinned_nodes_are_not_applied() {
    let node = json!({ "translation": [100, 0, 0], "scale": [2, 2, 2], "mesh": 0, "skin": 0 });
    let mut file = scene(json!([{ "translation": [0, 7, 0], "children": [1] }, node]), json!([0]));
    file.json["skins"] = json!([{ "joints": [0] }]);
    assert_eq!(file.read().positions, File::square().read().positions);
}

#[test]
fn mirrored_faces_are_turned_round() {
    let file = |scale: Value| {
        let mut file = scene(json!([{ "scale": scale, "mesh": 0 }]), json!([0]));
        let texcoords = file.floats(&[[0., 0.], [1., 0.], [2., 0.], [3., 0.]]);
        let normals = file.floats(&[[0.6, 0., 0.8]; 4]);
        file.primitive_mut()["attributes"]["TEXCOORD_0"] = json!(texcoords);
        file.primitive_mut()["attributes"]["NORMAL"] = json!(normals);
        file.read()
    };
    let data = file(json!([-1, 1, 1]));
    assert_eq!(data.positions, [[0., 0., 0.], [-1., 0., 0.], [-1., 1., 0.], [0., 1., 0.]]);
    assert_eq!(data.face_vertices, [0, 3, 2, 1]);
    assert_eq!(data.texcoords.unwrap().indices, [0, 3, 2, 1]);
    let normals = data.normals.unwrap();
    assert_eq!((normals.values, normals.indices), (vec![[-0.6, 0., 0.8]; 4], vec![0, 3, 2, 1]));
    // Normals follow the inverse transpose: along x they shrink as the surface grows.
    let data = file(json!([2, 1, 1]));
    let expected = glam::Vec3::new(0.3, 0., 0.8).normalize();
    assert!(data.normals.unwrap().values.iter().all(|&n| glam::Vec3::from(n).distance(expected) < 1e-6));
    let data = file(json!([-1, -1, -1]));
    assert_eq!(data.normals.unwrap().values, vec![[-0.6, 0., -0.8]; 4]);
}

/// Two nodes with the square, one of them moved, and one node with a triangle.
fn three_nodes() -> File {
    let mut file = scene(
        json!([
            { "mesh": 0 },
            { "mesh": 0, "name": "Moved", "translation": [1, 0, 0] },
            { "mesh": 1, "name": "Three" },
        ]),
        json!([0, 2, 1]),
    );
    let triangle = file.primitive(&[[5., 0., 0.], [6., 0., 0.], [5., 1., 0.]], &[0, 1, 2]);
    file.push("meshes", json!({ "name": "Triangle", "primitives": [triangle] }));
    file
}

#[test]
fn all_meshes_are_taken_as_one_in_the_order_of_the_nodes() {
    let data = three_nodes().read();
    assert_eq!(data.face_sizes, [4, 3, 4]);
    // Where instances touch they are not welded.
    assert_eq!(data.positions.len(), 11);
    assert_eq!(data.face_vertices, (0..11).collect::<Vec<_>>());
    assert_eq!(data.positions[7], [1., 0., 0.]);
    let mut file = three_nodes();
    file.json["nodes"][2]["children"] = json!([1, 0]);
    file.json["scenes"][0]["nodes"] = json!([2]);
    let data = file.read();
    assert_eq!(data.face_sizes, [3, 4, 4]);
    assert_eq!(data.positions[3], [1., 0., 0.]);
}

#[test]
fn meshes_are_chosen_by_the_name_of_mesh_or_node() {
    let sizes = |name| three_nodes().try_read(Some(name)).unwrap().face_sizes;
    assert_eq!(sizes("Square"), [4, 4]);
    assert_eq!(sizes("Triangle"), [3]);
    assert_eq!(sizes("Three"), [3]);
    assert_eq!(three_nodes().try_read(Some("Moved")).unwrap().positions[0], [1., 0., 0.]);
    let error = three_nodes().try_read(Some("square")).unwrap_err();
    let expected = "there is no mesh or node named \"square\" in the scene: \
                    choose one of \"Moved\", \"Square\", \"Three\", \"Triangle\"";
    assert_eq!(error.to_string(), expected);
    let error = File::square().try_read(Some("a")).unwrap_err();
    let expected = "there is no mesh or node named \"a\" in the scene: \
                    its meshes have no names; leave the name out to read them all";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn the_scene_is_the_default_the_first_or_all_meshes() {
    let file = |change: fn(&mut Value)| {
        let mut file = three_nodes();
        file.json["scenes"] = json!([{ "nodes": [1] }, { "nodes": [2] }]);
        change(&mut file.json);
        file.read().face_sizes
    };
    assert_eq!(file(|json| json["scene"] = json!(1)), [3]);
    assert_eq!(file(|json| drop(json.as_object_mut().unwrap().remove("scene"))), [4]);
    let without_scenes = |json: &mut Value| {
        json.as_object_mut().unwrap().retain(|key, _| key != "scene" && key != "scenes");
    };
    assert_eq!(file(without_scenes), [4, 3]);
}

#[test]
fn scenes_that_are_wrong() {
    let mut file = scene(json!([{ "mesh": 0 }]), json!([0]));
    file.json["scene"] = json!(1);
    file.assert_error("scene 1 does not exist, but is the default scene");
    scene(json!([{ "mesh": 0 }]), json!([3])).assert_error("node 3 does not exist, but the scene names it");
    scene(json!([{ "mesh": 2 }]), json!([0])).assert_error("mesh 2 does not exist, but node 0 names it");
    let twice = "node 0 is reached twice: give a node one parent";
    scene(json!([{ "mesh": 0 }, { "children": [0] }]), json!([0, 1])).assert_error(twice);
    scene(json!([{ "children": [1] }, { "children": [0] }]), json!([0])).assert_error(twice);
    scene(json!([]), json!([])).assert_error("the scene has no triangles: points and lines have no surface");
}

#[test]
fn a_rotation_of_zero_is_none() {
    let data = scene(json!([{ "mesh": 0, "rotation": [0, 0, 0, 0] }]), json!([0])).read();
    assert_eq!(data.positions, SQUARE.map(|p| p.map(f64::from)));
}
