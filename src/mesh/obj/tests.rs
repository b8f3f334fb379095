use super::*;
use crate::mesh::{BoundaryRule, Change, Corner, Crease, CreaseMethod, Edit, FaceVaryingRule, TriangleRule};

const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

fn read(text: &str) -> ControlMesh {
    ControlMesh::from_obj_str(text, &ObjOptions::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn read_dropping(text: &str) -> ControlMesh {
    ControlMesh::from_obj_str(text, &ObjOptions { drop_isolated: true }).unwrap_or_else(|error| panic!("{error}"))
}

/// The error of a text, which must not depend on whether isolated vertices are dropped.
#[track_caller]
fn assert_error(text: &str, expected: &str) {
    for drop_isolated in [false, true] {
        let error = ControlMesh::from_obj_str(text, &ObjOptions { drop_isolated }).unwrap_err();
        assert_eq!(error.to_string(), expected, "drop_isolated: {drop_isolated}");
    }
}

/// The error of statements that come after a quad, from line 6 on.
#[track_caller]
fn assert_error_after_quad(text: &str, expected: &str) {
    assert_error(&format!("{QUAD}{text}"), expected);
}

fn read_after_quad(text: &str) -> MeshData {
    read(&format!("{QUAD}{text}")).into_data()
}

#[test]
fn polygons_are_kept_and_statements_of_other_kinds_passed_over() {
    let mesh = read(
        "# a comment\n mtllib a b.mtl\no object\ng group\nvp 0.5\n\
         v 0 0 0\nv 1 0 0\nv 1 1 0 # corner\nv 0 1 0\nv 0 2 0\n  v\t-1.5e0  .5 1e-3  \n\
         s off\nusemtl stone\nf 1 2 3 4\n\nl 1 2\np 1\nnonsense here\ng other\nf 4 3 5\nf 1 4 5 6",
    );
    assert_eq!(mesh.data().face_sizes, [4, 3, 4]);
    assert_eq!(mesh.data().face_vertices, [0, 1, 2, 3, 3, 2, 4, 0, 3, 4, 5]);
    assert_eq!(mesh.data().positions[5], [-1.5, 0.5, 0.001]);
    assert_eq!((&mesh.data().texcoords, &mesh.data().normals), (&None, &None));
}

#[test]
fn positions_are_read_in_double_precision() {
    assert_eq!(read(&QUAD.replace("v 1 1 0", "v 0.1 1.2345678901234567 0")).data().positions[2][1], 1.2345678901234567);
}

#[test]
fn windows_lines_byte_order_mark_and_missing_last_newline() {
    let text = format!("\u{feff}{}", QUAD.trim_end().replace('\n', "\r\n"));
    assert_eq!(read(&text), read(QUAD));
}

#[test]
fn backslash_continues_a_line() {
    let text = "v 0 0 \\\n 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 \\ # comment\r\n 3 \\\r\n 4\n";
    assert_eq!(read(text), read(QUAD));
    assert_eq!(read(&format!("{}\\", QUAD.trim_end())), read(QUAD), "at the end of the file");
    assert_eq!(read(&format!("# C:\\dir\\\n{QUAD}")), read(QUAD), "not in a comment");
    // A statement is on the line that it begins on.
    assert_error_after_quad(
        "\nf 1 \\\n2 \\\n0\n",
        "line 7: \"0\" is not the index of a vertex: indices count from 1, or back from -1",
    );
}

#[test]
fn further_components_are_accepted() {
    let text = QUAD.replace(" 0\n", " 0 1 0.5 0.5\n");
    assert_eq!(read(&text), read(QUAD));
    let data = read_after_quad("v 2 0 0\nvt 0.5\nvt 0.5 0.25\nvt 0.5 0.25 9\nf 3/1 2/2 5/3\n");
    assert_eq!(data.texcoords.unwrap().values[..3], [[0.5, 1.0], [0.5, 0.75], [0.5, 0.75]], "v runs up the image");
}

#[test]
fn face_corners_of_every_form() {
    let attributes = "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n";
    let quad = |face: &str| read(&QUAD.replace("f 1 2 3 4", &format!("{attributes}f {face}"))).into_data();
    let texcoords = Some(FaceVarying { values: vec![[0., 1.], [1., 1.], [1., 0.]], indices: vec![0, 1, 2, 0] });
    let normals = Some(FaceVarying { values: vec![[0., 0., 1.]], indices: vec![0; 4] });
    for (face, has_texcoords, has_normals) in [
        ("1 2 3 4", false, false),
        ("1/1 2/2 3/3 4/1", true, false),
        ("1//1 2//1 3//1 4//1", false, true),
        ("1/1/1 2/2/1 3/3/1 4/1/1", true, true),
        ("-4/-3/-1 -3/-2/-1 -2/-1/-1 -1/-3/-1", true, true),
        // Some writers leave slashes behind.
        ("1/ 2/ 3// 4//", false, false),
        ("1/1/ 2/2/ 3/3/ 4/1/", true, false),
    ] {
        let data = quad(face);
        assert_eq!(data.face_vertices, [0, 1, 2, 3], "{face}");
        assert_eq!(data.texcoords, texcoords.clone().filter(|_| has_texcoords), "{face}");
        assert_eq!(data.normals, normals.clone().filter(|_| has_normals), "{face}");
    }
}

#[test]
fn negative_indices_count_back_from_their_line() {
    let text = format!("{QUAD}v 2 0 0\nv 2 1 0\nf -5 -2 -1 -4\nv 3 0 0\nv 3 1 0\nf -4 -2 -1 -3");
    assert_eq!(read(&text).data().face_vertices, [0, 1, 2, 3, 1, 4, 5, 2, 4, 6, 7, 5]);
}

#[test]
fn indices_may_point_forward() {
    assert_eq!(read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0").data().face_vertices, [0, 1, 2]);
}

#[test]
fn faces_without_attributes_get_zero_where_others_have_them() {
    let data = read_after_quad("v 2 0 0\nvt 1 1\nvn 1 0 0\nf 3/1/1 2/1/1 5/1/1\n");
    let texcoords = FaceVarying { values: vec![[1., 0.], [0., 0.]], indices: vec![1, 1, 1, 1, 0, 0, 0] };
    assert_eq!(data.texcoords, Some(texcoords));
    let normals = FaceVarying { values: vec![[1., 0., 0.], [0., 0., 0.]], indices: vec![1, 1, 1, 1, 0, 0, 0] };
    assert_eq!(data.normals, Some(normals));
}

#[test]
fn tags() {
    let data = read_after_quad(
        "t crease 2/1/0 1 0 2.5\nt crease 4/1/0 0 1 2 3 10\nt crease 3/2/0 1 2 3 1 inf\n\
         t corner 1/1/0 2 3\nt corner 2/1/0 0 1 4\nt corner 2/2/0 0 1 5 6\n\
         t hole 1/0/0 0\nt interpolateboundary 1/0/0 2\nt creasemethod 0/0/1 chaikin\n\
         t smoothtriangles 0/0/1 smooth\nt facevaryinginterpolateboundary 1/0/0 3\nt unknown 1/1/1 -7 x y\n",
    );
    let crease = |a, b, sharpness| Crease { vertices: [a, b], sharpness };
    let chain = [crease(0, 1, 10.), crease(1, 2, 10.), crease(2, 3, 10.)];
    assert_eq!(data.creases[0], crease(1, 0, 2.5));
    assert_eq!(data.creases[1..4], chain);
    assert_eq!(data.creases[4..], [crease(1, 2, 1.), crease(2, 3, f32::INFINITY)]);
    let corner = |vertex, sharpness| Corner { vertex, sharpness };
    assert_eq!(data.corners, [corner(2, 3.), corner(0, 4.), corner(1, 4.), corner(0, 5.), corner(1, 6.)]);
    assert_eq!(data.holes, [0]);
    assert_eq!((data.boundary, data.crease_method), (BoundaryRule::EdgeOnly, CreaseMethod::Chaikin));
    assert_eq!((data.triangle_rule, data.face_varying_rule), (TriangleRule::Smooth, FaceVaryingRule::CornersPlus2));
}

#[test]
fn every_value_of_the_tags() {
    use BoundaryRule::{EdgeAndCorner, EdgeOnly};
    for (value, rule) in [BoundaryRule::None, EdgeAndCorner, EdgeOnly].into_iter().enumerate() {
        assert_eq!(read_after_quad(&format!("t interpolateboundary 1/0/0 {value}")).boundary, rule);
    }
    use FaceVaryingRule::{All, Boundaries, CornersOnly, CornersPlus1, CornersPlus2};
    let rules = [FaceVaryingRule::None, CornersOnly, CornersPlus1, CornersPlus2, Boundaries, All];
    for (value, rule) in rules.into_iter().enumerate() {
        assert_eq!(read_after_quad(&format!("t facevaryinginterpolateboundary 1/0/0 {value}")).face_varying_rule, rule);
    }
    for (value, method) in [("chaikin", CreaseMethod::Chaikin), ("normal", CreaseMethod::Uniform)] {
        let text = format!("t creasemethod 0/0/1 chaikin\nt creasemethod 0/0/1 {value}");
        assert_eq!(read_after_quad(&text).crease_method, method);
    }
    for (value, rule) in [("smooth_triangle", TriangleRule::Smooth), ("catmark", TriangleRule::CatmullClark)] {
        let text = format!("t smoothtriangles 0/0/1 smooth\nt smoothtriangles 0/0/1 {value}");
        assert_eq!(read_after_quad(&text).triangle_rule, rule);
    }
}

#[test]
fn edits() {
    let data = read_after_quad(
        "t vertexedit 9/6/3 4 0 1 2 3 3 0 0 1 1 2 3 4 5 6 add P value\nt vertexedit 4/4/3 3 0 3 2 1 2 3 9 subtract P value\n\
         t vertexedit 4/3/3 3 0 1 2 0.5 0 -1 set P value\nt vertexedit 4/1/3 3 0 1 2 inf set P sharpness\n\
         t edgeedit 8/2/3 3 0 1 2 3 0 0 3 1.5 10 set P sharpness\nt faceedit 4/0/1 3 0 3 2 hole\n",
    );
    let edit = |children: &[u32], change| Edit { face: 0, children: children.to_vec(), change };
    let expected = [
        edit(&[1, 2], Change::Offset { corner: 3, offset: [1., 2., 3.] }),
        edit(&[0], Change::Offset { corner: 1, offset: [4., 5., 6.] }),
        edit(&[3], Change::Offset { corner: 2, offset: [-1., -2., -3.] }),
        edit(&[1], Change::Position { corner: 2, position: [0.5, 0., -1.] }),
        edit(&[1], Change::CornerSharpness { corner: 2, sharpness: f32::INFINITY }),
        edit(&[1], Change::EdgeSharpness { edge: 2, sharpness: 1.5 }),
        edit(&[0], Change::EdgeSharpness { edge: 3, sharpness: 10. }),
        edit(&[3, 2], Change::Hole),
    ];
    assert_eq!(data.edits, expected);
    // At level 0 they are made.
    let data = read_after_quad("t vertexedit 3/3/3 2 0 2 1 1 1 add P value\nt faceedit 2/0/1 1 0 hole");
    assert_eq!((data.positions[2], data.holes, data.edits), ([2., 2., 1.], vec![0], vec![]));
}

#[test]
fn errors_of_edits() {
    let few = "line 6: the tag \"vertexedit\" names 2 paths, needing 6 numbers (3 each), but has 5";
    assert_error_after_quad("t vertexedit 8/5/3 3 0 1 2 3 0 1 3 1 2 3 4 5 add P value", few);
    let none = "line 6: the tag \"edgeedit\" names 1 path, needing 1 number (1 each), but has 0";
    assert_error_after_quad("t edgeedit 4/0/3 3 0 1 2 set P sharpness", none);
    let choices = "add P value, subtract P value, set P value or set P sharpness";
    let value = format!("line 6: \"add P sharpness\" is no value of the tag \"vertexedit\": use {choices}");
    assert_error_after_quad("t vertexedit 4/1/3 3 0 1 2 1 add P sharpness", &value);
    let value = "line 6: \"set P value\" is no value of the tag \"edgeedit\": use set P sharpness";
    assert_error_after_quad("t edgeedit 4/3/3 3 0 1 2 1 2 3 set P value", value);
    let value = "line 6: \"\" is no value of the tag \"faceedit\": use hole";
    assert_error_after_quad("t faceedit 3/0/0 2 0 1", value);
    let announces = "line 6: path 1 announces 3 numbers, but 2 follow";
    assert_error_after_quad("t faceedit 6/0/1 2 0 1 3 0 1 hole", announces);
    let least = "line 6: path 0 has 1 number: a path of \"vertexedit\" is a face and its corner or edge at least";
    assert_error_after_quad("t vertexedit 2/3/3 1 0 1 2 3 add P value", least);
    let least = "line 6: path 0 has 0 numbers: a path of \"faceedit\" is a face at least";
    assert_error_after_quad("t faceedit 1/0/1 0 hole", least);
    let shape = "takes one path or more, each led by its length (such as 3/3/3)";
    let shape = format!("line 6: the tag \"faceedit\" has 0/0/1 arguments, but {shape}");
    assert_error_after_quad("t faceedit 0/0/1 hole", &shape);
    let number = "line 6: \"-1\" in a path is no number: paths are made of numbers from 0";
    assert_error_after_quad("t faceedit 3/0/1 2 0 -1 hole", number);
    let child = "line 7: edit 1: level 2: there is no child 4: the face has 4 (0 to 3)";
    assert_error_after_quad("t faceedit 3/0/1 2 0 1 hole\nt faceedit 4/0/1 3 0 1 4 hole", child);
    let corner = "line 6: edit 0: level 1: there is no corner 7: the face has 4 (0 to 3)";
    assert_error_after_quad("t vertexedit 4/3/3 3 0 1 7 1 2 3 add P value", corner);
    let face = "line 6: edit 0: level 0: it names face 1, but the mesh has 1 faces";
    assert_error_after_quad("t faceedit 3/0/1 2 1 0 hole", face);
    let number = "line 6: \"x\" is not a finite number: write it like 1.5 or -2e3";
    assert_error_after_quad("t vertexedit 4/3/3 3 0 1 2 1 2 x add P value", number);
}

#[test]
fn isolated_vertices() {
    let text = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 8 8 8\nv 1 1 0\nv 0 1 0\nv 7 7 7\nf 2 3 5 6\n\
                t crease 2/1/0 2 4 3\nt corner 1/1/0 0 1\nt corner 1/1/0 5 2\nt hole 1/0/0 0\n";
    let error = ControlMesh::from_obj_str(text, &ObjOptions::default()).unwrap_err();
    let expected = "line 1: vertex 0 belongs to no face: remove it, or read the file with isolated vertices dropped";
    assert_eq!(error.to_string(), expected);

    let data = read_dropping(text).into_data();
    assert_eq!(data.positions, read(QUAD).data().positions);
    assert_eq!(data.face_vertices, [0, 1, 2, 3]);
    assert_eq!(data.creases, [Crease { vertices: [1, 2], sharpness: 3. }]);
    assert_eq!(data.corners, [Corner { vertex: 3, sharpness: 2. }]);
    assert_eq!(read_dropping(QUAD), read(QUAD));
}

#[test]
fn errors_after_dropping_have_the_numbers_of_the_file() {
    let error = |text: &str| {
        let text = format!("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\n{text}");
        ControlMesh::from_obj_str(&text, &ObjOptions { drop_isolated: true }).unwrap_err().to_string()
    };
    let crease = "line 8: crease 0 names the edge 1-3, which is no edge of any face";
    assert_eq!(error("f 2 3 4 5\nt crease 2/1/0 1 3 1"), crease);
    let dropped = "line 8: crease 0 names the edge 0-1, which is no edge of any face";
    assert_eq!(error("f 2 3 4 5\nt crease 2/1/0 0 1 1"), dropped);
    let repeated = "line 7: face 0 names vertex 3 twice: remove the repeated vertex, or split the face there";
    assert_eq!(error("f 2 3 4 4 5"), repeated);
    let turned = "line 8: faces 0 and 1 both run along the edge 1-2 in the same direction: \
                  turn one of them round so that all faces are counter-clockwise from outside";
    assert_eq!(error("f 2 3 4\nf 2 3 5"), turned);
    let third = "line 9: face 2 is the third face at the edge 1-2: \
                 an edge has one or two faces; separate the surfaces there";
    assert_eq!(error("f 2 3 4\nf 3 2 5\nf 2 3 5"), third);
    let corner = "line 8: corner 0 names vertex 6, but the mesh has 6 vertices";
    assert_eq!(error("f 2 3 4 5\nt corner 1/1/0 6 1"), corner);
}

#[test]
fn errors_of_statements() {
    assert_error("v 1 2", "line 1: \"v\" needs 3 numbers, but has 2");
    assert_error("\nv 1 2,5 3", "line 2: \"2,5\" is not a finite number: write it like 1.5 or -2e3");
    assert_error("v 1 nan 3", "line 1: \"nan\" is not a finite number: write it like 1.5 or -2e3");
    assert_error("v 1 1e999 3", "line 1: \"1e999\" is not a finite number: write it like 1.5 or -2e3");
    assert_error("vt", "line 1: \"vt\" needs one number or more, but has none");
    assert_error("vt 1e39", "line 1: \"1e39\" is too large: at most 3.4028235e38");
    assert_error("vt 0 a", "line 1: \"a\" is not a finite number: write it like 1.5 or -2e3");
    assert_error("vn 0 1", "line 1: \"vn\" needs 3 numbers, but has 2");
    let index = "is not the index of a vertex: indices count from 1, or back from -1";
    assert_error_after_quad("f 1 0 2", &format!("line 6: \"0\" {index}"));
    assert_error_after_quad("f 1 x 2", &format!("line 6: \"x\" {index}"));
    assert_error_after_quad("f 1 4294967296 2", &format!("line 6: \"4294967296\" {index}"));
    assert_error_after_quad("f 1 99999999999999999999 2", &format!("line 6: \"99999999999999999999\" {index}"));
    let index = "indices count from 1, or back from -1";
    assert_error_after_quad("f 1/a 2 3", &format!("line 6: \"a\" is not the index of a texture coordinate: {index}"));
    assert_error_after_quad("f 1//0 2 3", &format!("line 6: \"0\" is not the index of a normal: {index}"));
    assert_error_after_quad("f 1 -5 2", "line 6: vertex -5 counts back too far: 4 come before this line");
    assert_error_after_quad("f 1/-1 2 3", "line 6: texture coordinate -1 counts back too far: 0 come before this line");
    let corner = "is not a face corner: write v, v/vt, v//vn or v/vt/vn";
    assert_error_after_quad("f 1 2 3/1/1/1", &format!("line 6: \"3/1/1/1\" {corner}"));
    assert_error_after_quad("f 1 2 /1", &format!("line 6: \"/1\" {corner}"));
    let mixed = "line 8: some corners of the face have a texture coordinate and some have none: give it to all or none";
    assert_error_after_quad("vt 0 0\nvt 0 1\nf 1/1 3/2 4", mixed);
    let mixed = "line 7: some corners of the face have a normal and some have none: give it to all or none";
    assert_error_after_quad("vn 0 0 1\nf 1 3//1 4//1", mixed);
}

#[test]
fn errors_of_meshes_have_the_line() {
    assert_error("", "the mesh has no vertices: a control mesh needs at least one face");
    assert_error("f 1 2 3", "the mesh has no vertices: a control mesh needs at least one face");
    assert_error("v 0 0 0", "the mesh has no faces: a control mesh needs at least one face");
    assert_error_after_quad("f 1 2", "line 6: face 1 has 2 vertices: a face needs at least three");
    assert_error_after_quad("\nf", "line 7: face 1 has 0 vertices: a face needs at least three");
    let range = "line 6: face 1 names vertex 4, but the mesh has 4 vertices (0 to 3)";
    assert_error_after_quad("f 2 1 5", range);
    assert_error_after_quad("vt 0 0\nf 2/1 1/1 4/2", "line 7: corner 6 names texture coordinate 1, but there are 1");
    assert_error_after_quad("f 2//1 1//1 4//1", "line 6: corner 4 names normal 0, but there are 0");
    let repeated = "line 6: face 1 names vertex 0 twice: remove the repeated vertex, or split the face there";
    assert_error_after_quad("f 2 1 4 1", repeated);
    let turned = "line 7: faces 0 and 1 both run along the edge 1-2 in the same direction: \
                  turn one of them round so that all faces are counter-clockwise from outside";
    assert_error_after_quad("v 2 0 0\nf 2 3 5", turned);
    let third = "line 8: face 2 is the third face at the edge 1-2: \
                 an edge has one or two faces; separate the surfaces there";
    assert_error_after_quad("v 2 0 0\nf 3 2 5\nf 2 3 5", third);
}

#[test]
fn errors_of_tags() {
    let name = "line 6: a tag needs a name and the number of its arguments, such as \"t crease 2/1/0\"";
    assert_error_after_quad("t", name);
    assert_error_after_quad("t crease", name);
    let counts = "is not a number of arguments: write integers/floats/strings, such as 2/1/0";
    assert_error_after_quad("t crease 2/1 0 1 3", &format!("line 6: \"2/1\" {counts}"));
    assert_error_after_quad("t crease 2/1/-1 0 1 3", &format!("line 6: \"2/1/-1\" {counts}"));
    let follow = "line 6: the tag \"crease\" announces 2/1/0 arguments, but 2 follow";
    assert_error_after_quad("t crease 2/1/0 0 1", follow);
    let huge = "18446744073709551615/1/0";
    let follow = format!("line 6: the tag \"any\" announces {huge} arguments, but 0 follow");
    assert_error_after_quad(&format!("t any {huge}"), &follow);
    let takes = "takes two or more vertices and one sharpness for all edges or one for each (such as 2/1/0)";
    for (counts, arguments) in [("1/1/0", "0 1"), ("2/0/0", "0 1"), ("4/2/0", "0 1 2 3 1 1"), ("2/1/1", "0 1 1 x")] {
        let expected = format!("line 6: the tag \"crease\" has {counts} arguments, but {takes}");
        assert_error_after_quad(&format!("t crease {counts} {arguments}"), &expected);
    }
    let takes = "takes one or more vertices and one sharpness for all or one for each (such as 1/1/0)";
    for (counts, arguments) in [("0/1/0", "1"), ("1/0/0", "1"), ("3/2/0", "0 1 2 1 1"), ("1/1/1", "0 1 x")] {
        let expected = format!("line 6: the tag \"corner\" has {counts} arguments, but {takes}");
        assert_error_after_quad(&format!("t corner {counts} {arguments}"), &expected);
    }
    for (counts, arguments) in [("0/0/0", ""), ("1/1/0", "0 1"), ("1/0/1", "0 x")] {
        let expected =
            format!("line 6: the tag \"hole\" has {counts} arguments, but takes one or more faces (such as 1/0/0)");
        assert_error_after_quad(&format!("t hole {counts} {arguments}"), &expected);
    }
    let takes = "line 6: the tag \"interpolateboundary\" has 2/0/0 arguments, but takes one integer (such as 1/0/0)";
    assert_error_after_quad("t interpolateboundary 2/0/0 1 1", takes);
    let takes = "line 6: the tag \"creasemethod\" has 1/0/0 arguments, but takes one string (such as 0/0/1)";
    assert_error_after_quad("t creasemethod 1/0/0 1", takes);
    let value = "line 6: \"3\" is no value of the tag \"interpolateboundary\": use 0 (none), 1 (edge and corner) or 2 (edge only)";
    assert_error_after_quad("t interpolateboundary 1/0/0 3", value);
    let value = "line 6: \"6\" is no value of the tag \"facevaryinginterpolateboundary\": \
                 use 0 (none), 1 (corners only), 2 (corners plus 1), 3 (corners plus 2), 4 (boundaries) or 5 (all)";
    assert_error_after_quad("t facevaryinginterpolateboundary 1/0/0 6", value);
    let value = "line 6: \"sharp\" is no value of the tag \"creasemethod\": use normal or chaikin";
    assert_error_after_quad("t creasemethod 0/0/1 sharp", value);
    let value = "line 6: \"no\" is no value of the tag \"smoothtriangles\": use catmark or smooth";
    assert_error_after_quad("t smoothtriangles 0/0/1 no", value);
    let index = "line 6: \"-1\" is not an index: vertices and faces in tags count from 0";
    assert_error_after_quad("t crease 2/1/0 -1 1 1", index);
    assert_error_after_quad("t hole 1/0/0 -1", index);
    let number = "line 6: \"x\" is not a finite number: write it like 1.5 or -2e3";
    assert_error_after_quad("t corner 1/1/0 1 x", number);
    let edge = "line 7: crease 1 names the edge 0-2, which is no edge of any face";
    assert_error_after_quad("t crease 2/1/0 1 2 3\nt crease 2/1/0 0 2 1", edge);
    let edge = "line 6: crease 0 names the edge 0-9, which is no edge of any face";
    assert_error_after_quad("t crease 2/1/0 0 9 1", edge);
    assert_error_after_quad("t corner 1/1/0 4 1", "line 6: corner 0 names vertex 4, but the mesh has 4 vertices");
    assert_error_after_quad("t hole 2/0/0 0 1", "line 6: hole tag names face 1, but the mesh has 1 faces");
    let sharpness = "has sharpness -1: sharpness is a number from 0 up (10 and more is infinitely sharp)";
    assert_error_after_quad("t corner 1/1/0 1 -1", &format!("line 6: corner 0 {sharpness}"));
    assert_error_after_quad("t crease 2/1/0 0 1 -1", &format!("line 6: crease 0 {sharpness}"));
}

#[test]
fn text_in_any_encoding() {
    let read_bytes = |bytes: &[u8]| ControlMesh::from_obj_bytes(bytes, &ObjOptions::default());
    assert_eq!(read_bytes(QUAD.as_bytes()), Ok(read(QUAD)));
    // Latin-1, in a comment and in a name.
    let latin = [b"# gr\xfcn\no B\xe4r\n", QUAD.as_bytes()].concat();
    assert_eq!(read_bytes(&latin), Ok(read(QUAD)));
    let units = || std::iter::once(0xfeff).chain(QUAD.encode_utf16());
    let little: Vec<u8> = units().flat_map(u16::to_le_bytes).collect();
    let big: Vec<u8> = units().flat_map(u16::to_be_bytes).collect();
    assert_eq!([read_bytes(&little), read_bytes(&big)], [Ok(read(QUAD)), Ok(read(QUAD))]);
    let error = read_bytes(b"v 0 0 0\nv 1 0 \xb2\n").unwrap_err().to_string();
    assert!(
        error.starts_with("line 2: ") && error.ends_with("is not a finite number: write it like 1.5 or -2e3"),
        "{error}"
    );
}

#[test]
fn lines_end_as_they_do_anywhere() {
    for end in ["\r", "\r\n", "\n"] {
        assert_eq!(read(&QUAD.replace('\n', end)), read(QUAD), "{end:?}");
        let error = ControlMesh::from_obj_str(&format!("# one{end}v 1 2{end}"), &ObjOptions::default()).unwrap_err();
        assert_eq!(error.to_string(), "line 2: \"v\" needs 3 numbers, but has 2");
    }
}

/// Found by fuzzing: there was a panic.
#[test]
fn errors_about_vertices_know_their_line_where_others_are_dropped() {
    let text = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 1e308 0 1\nf 2 3 4";
    let error = ControlMesh::from_obj_str(text, &ObjOptions { drop_isolated: true }).unwrap_err();
    let position = [1e308, 0.0, 1.0];
    assert_eq!(error, MeshError::AtLine { line: 4, error: Box::new(MeshError::NotFinite { vertex: 3, position }) });
}
