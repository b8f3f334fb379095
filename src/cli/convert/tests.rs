use super::*;
use ash_subdiv::shape;

#[test]
fn tags_that_are_lost_are_named() {
    assert_eq!(lost(shape("torus").unwrap().data(), Format::Glb), [""; 0]);
    let data = MeshData { holes: vec![1], boundary: ash_subdiv::mesh::BoundaryRule::None, ..MeshData::default() };
    assert_eq!(lost(&data, Format::Ply), ["holes", "rules of subdivision"]);
    assert_eq!(lost(&data, Format::Obj), [""; 0]);
}
