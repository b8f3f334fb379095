use super::*;

const TEXT: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 5\nproperty float x\nproperty float y\n\
    property uchar red\nproperty double z\nproperty float s\nproperty float t\nelement face 2\nproperty uchar flags\n\
    property list uchar int vertex_indices\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n\
    0 0 255 0 0 0\n1 0 255 0.5 1 0\n1 1 255 0 1 1\n0 1 255 0 0 1\n2 0.5 9 1e-3 0.5 0.25\n7 4 0 1 2 3\n7 3 1 4 2\n0 1\n";

fn error(bytes: &[u8]) -> String {
    ControlMesh::from_ply_bytes(bytes).unwrap_err().to_string()
}

#[test]
fn text_is_read_with_any_line_end() {
    let mesh = ControlMesh::from_ply_bytes(TEXT.as_bytes()).unwrap();
    assert_eq!((mesh.face(0), mesh.face(1)), (&[0, 1, 2, 3][..], &[1, 4, 2][..]));
    assert_eq!(mesh.data().positions[1..], [[1., 0., 0.5], [1., 1., 0.], [0., 1., 0.], [2., 0.5, 1e-3]]);
    let texcoords = mesh.data().texcoords.as_ref().unwrap();
    // v runs up from the bottom of the image.
    assert_eq!(texcoords.values[texcoords.indices[5] as usize], [0.5, 0.75]);
    assert_eq!(mesh.data().normals, None);
    for ending in ["\r\n", "\r"] {
        assert!(ControlMesh::from_ply_bytes(TEXT.replace('\n', ending).as_bytes()).unwrap() == mesh, "{ending:?}");
    }
}

#[test]
fn binary_of_both_byte_orders_and_all_types_is_read() {
    for (name, big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let mut bytes = format!(
            "ply\nformat {name} 1.0\nelement vertex 3\nproperty short x\nproperty double y\nproperty int8 z\nproperty float nx\n\
             property float ny\nproperty float nz\nelement face 1\nproperty list uint16 uint32 vertex_index\nend_header\n"
        )
        .into_bytes();
        let mut put = |mut little: Vec<u8>| {
            if big {
                little.reverse();
            }
            bytes.extend(little);
        };
        for (x, y, z) in [(-300i16, 0.1, 1i8), (2, 2.5, -7), (0, -1e300_f64.recip(), 0)] {
            put(x.to_le_bytes().into());
            put(y.to_le_bytes().into());
            put(z.to_le_bytes().into());
            [0.0f32, 0.0, 1.0].iter().for_each(|n| put(n.to_le_bytes().into()));
        }
        put(3u16.to_le_bytes().into());
        [2u32, 0, 1].iter().for_each(|vertex| put(vertex.to_le_bytes().into()));
        let mesh = ControlMesh::from_ply_bytes(&bytes).unwrap();
        assert_eq!(mesh.face(0), [2, 0, 1]);
        assert_eq!(mesh.data().positions[..2], [[-300., 0.1, 1.], [2., 2.5, -7.]]);
        assert_eq!(mesh.data().normals.as_ref().unwrap().values, [[0., 0., 1.]; 3]);
        bytes.pop();
        assert_eq!(error(&bytes), "element \"face\", row 0: the file ends there: write or copy it again");
    }
}

#[test]
fn what_is_wrong_is_told() {
    let with = |from: &str, to: &str| error(TEXT.replace(from, to).as_bytes());
    assert_eq!(error(b"v 0 0 0\n"), "the file is not PLY: its first line must be \"ply\"");
    assert_eq!(error(b"ply\nformat ascii 1.0\n"), "the header has no \"end_header\": the file is cut off");
    assert_eq!(with("format ascii 1.0\n", ""), "the header has no \"format\": write the file again");
    assert_eq!(with("ascii", "utf8"), "line 2: \"format utf8 1.0\" can't be read: write the file again");
    assert_eq!(with("float x", "half x"), "line 5: \"property half x\" can't be read: write the file again");
    assert_eq!(
        with("float x", "float X"),
        "the element \"vertex\" has no x, y and z: write positions with these names"
    );
    assert_eq!(
        with("vertex_indices", "corners"),
        "the element \"face\" has no list \"vertex_indices\": write it again"
    );
    assert_eq!(
        with("element face 2", "element faces 2"),
        "the file has no element \"face\": points alone have no surface"
    );
    assert_eq!(with("0 1 255 0 0 1", "0 one 255 0 0 1"), "element \"vertex\", row 3: \"one\" is not a number");
    assert_eq!(with("7 3 1 4 2", "7 3 1 -4 2"), "face 1 names vertex -4: vertices count from 0");
    assert_eq!(with("7 3 1 4 2", "7 3 1 5 2"), "face 1 names vertex 5, but the mesh has 5 vertices (0 to 4)");
    assert_eq!(
        with("7 3 1 4 2", "7 0.5 1 4 2"),
        "element \"face\", row 1: a list of 0.5 numbers can't be: write the file again"
    );
    // Counts without bytes behind them are not believed.
    let huge = with("element vertex 5", "element vertex 1073741824");
    assert!(huge.starts_with("element \"vertex\", row 7"), "{huge}");
    let empty =
        TEXT.replace("element edge 1\nproperty int vertex1\nproperty int vertex2", "element edge 18446744073709551615");
    assert!(ControlMesh::from_ply_bytes(empty.as_bytes()).is_ok());
}

#[test]
fn vertices_split_for_texture_coordinates_are_joined() {
    let text = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n\
        property float t\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n1 0 0 0 0\n2 0 0 1 0\n2 1 0 1 1\n1 1 0 0 1\n4 0 1 2 3\n4 4 5 6 7\n";
    let mesh = ControlMesh::from_ply_bytes(text.as_bytes()).unwrap();
    assert_eq!((mesh.vertex_count(), mesh.boundary_edge_count()), (6, 6));
    let texcoords = mesh.data().texcoords.as_ref().unwrap();
    assert_eq!(texcoords.indices, [0, 1, 2, 3, 4, 5, 6, 7]);
    let without = text.replace("property float s\nproperty float t\n", "property float q\nproperty float r\n");
    assert_eq!(ControlMesh::from_ply_bytes(without.as_bytes()).unwrap().vertex_count(), 8);
}
