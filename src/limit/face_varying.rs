//! Refinement of what may differ at one vertex from face to face.

use super::step::refine_vertices;
use crate::mesh::{
    BoundaryRule, ControlMesh, Corner, Crease, FaceVarying, FaceVaryingRule, MeshData, MeshError, NO_TWIN,
    SHARPNESS_INFINITE,
};
use crate::topology::Topology;
use std::collections::HashMap;

/// Linearly within each face.
pub(super) fn refine_linearly<const N: usize>(
    topology: &Topology,
    coarse: &FaceVarying<[f32; N]>,
) -> FaceVarying<[f32; N]> {
    let value = |h: u32| coarse.values[coarse.indices[h as usize] as usize];
    let mean =
        |values: &[[f32; N]]| std::array::from_fn(|i| values.iter().map(|v| v[i]).sum::<f32>() / values.len() as f32);
    let mut values = Vec::with_capacity(4 * coarse.indices.len());
    for face in 0..topology.mesh().face_count() as u32 {
        let corners = topology.mesh().face_corners(face);
        let around: Vec<_> = corners.clone().map(|h| value(h as u32)).collect();
        for h in corners {
            let h = h as u32;
            let (here, next, prev) = (value(h), value(topology.next(h)), value(topology.prev(h)));
            values.extend([here, mean(&[here, next]), mean(&around), mean(&[here, prev])]);
        }
    }
    FaceVarying { indices: (0..values.len() as u32).collect(), values }
}

/// By the mesh's rule. A seam is an edge whose faces have different indices at an end of it.
///
/// But for [`FaceVaryingRule::All`] the values are refined as the positions of a mesh of their own, cut open along the
/// seams. Other than in OpenSubdiv, where two values meet of which one has a semi-sharp edge, the other one does not
/// become as sharp (under [`FaceVaryingRule::CornersPlus1`] and [`FaceVaryingRule::CornersPlus2`]).
pub(super) fn refine_texcoords(
    topology: &Topology,
    coarse: &FaceVarying<[f32; 2]>,
) -> Result<FaceVarying<[f32; 2]>, MeshError> {
    if topology.mesh().data().face_varying_rule == FaceVaryingRule::All {
        return Ok(refine_linearly(topology, coarse));
    }
    let values = value_mesh(topology, coarse)?;
    let value_topology = Topology::new(&values);
    let (refined, _) = refine_vertices(&value_topology);
    // Where a value is in several places around a vertex, refinement has set them apart. They stay one value, and are
    // known by that in the next step.
    let split = value_topology.vertex_count() as u32;
    let joined = |vertex| if vertex < split { value_topology.source(vertex) } else { vertex };
    // Both meshes have the same faces, so their refinements have the same corners.
    Ok(FaceVarying {
        values: refined.positions.iter().map(|&[u, v, _]| [u as f32, v as f32]).collect(),
        indices: refined.face_vertices.into_iter().map(joined).collect(),
    })
}

/// A mesh with the faces of the mesh itself, whose vertices are the values at its vertices.
pub(crate) fn value_mesh(topology: &Topology, coarse: &FaceVarying<[f32; 2]>) -> Result<ControlMesh, MeshError> {
    let mesh = topology.mesh();
    let data = mesh.data();
    // Two vertices may have the same value; that does not connect them.
    let mut numbers = HashMap::new();
    let mut positions = Vec::new();
    let mut face_vertices = Vec::with_capacity(coarse.indices.len());
    for (&vertex, &index) in data.face_vertices.iter().zip(&coarse.indices) {
        face_vertices.push(*numbers.entry((vertex, index)).or_insert_with(|| {
            let [u, v] = coarse.values[index as usize].map(f64::from);
            positions.push([u, v, 0.0]);
            positions.len() as u32 - 1
        }));
    }
    let values = ControlMesh::new(MeshData {
        positions,
        face_sizes: data.face_sizes.clone(),
        face_vertices,
        // Which corners are sharp is told by tags.
        boundary: BoundaryRule::EdgeOnly,
        crease_method: data.crease_method,
        triangle_rule: data.triangle_rule,
        ..MeshData::default()
    })?;
    let mut creases = Vec::new();
    for h in (0..mesh.corner_count() as u32).filter(|&h| (h + 1..NO_TWIN).contains(&values.twins()[h as usize])) {
        let (vertices, sharpness) = ([h, topology.next(h)], topology.sharpness(h));
        let vertices = vertices.map(|h| values.data().face_vertices[h as usize]);
        creases.extend((sharpness > 0.0).then_some(Crease { vertices, sharpness }));
    }
    let corners = sharp_values(topology, &values);
    ControlMesh::new(MeshData { creases, corners, ..values.into_data() })
}

/// Values at one vertex of the mesh.
#[derive(Default)]
struct Values {
    /// Each with the number of faces around the vertex that have it.
    faces: Vec<(u32, usize)>,
    /// Whether there is a seam or a boundary at the vertex.
    open: bool,
    /// Whether one value is there in several places, or there is an infinitely sharp edge between two of its faces.
    divided: bool,
}

impl Values {
    fn face_count(&self) -> usize {
        self.faces.iter().map(|(_, faces)| faces).sum()
    }
}

/// The values that stay where they are, and those at vertices that are sharp themselves.
fn sharp_values(topology: &Topology, values: &ControlMesh) -> Vec<Corner> {
    let data = topology.mesh().data();
    let value_topology = Topology::new(values);
    let mut at_vertices: Vec<Values> = std::iter::repeat_with(Values::default).take(data.positions.len()).collect();
    let mut on_boundary = vec![false; data.positions.len()];
    for h in 0..topology.mesh().corner_count() as u32 {
        let value = values.data().face_vertices[h as usize];
        let next = topology.next(h);
        let ends = [h, next].map(|h| topology.mesh_vertex(h));
        let here = &mut at_vertices[ends[0] as usize];
        match here.faces.iter_mut().find(|(v, _)| *v == value) {
            Some((_, faces)) => *faces += 1,
            None => here.faces.push((value, 1)),
        }
        here.divided |= value_topology.source(value_topology.vertex(h)) != value_topology.vertex(h);
        let infinite = topology.sharpness(h) >= SHARPNESS_INFINITE;
        for end in ends {
            let there = &mut at_vertices[end as usize];
            there.open |= value_topology.twin(h).is_none();
            there.divided |= value_topology.twin(h).is_some() && infinite;
            on_boundary[end as usize] |= topology.twin(h).is_none();
        }
    }
    let rule = data.face_varying_rule;
    let depends = matches!(rule, FaceVaryingRule::CornersPlus1 | FaceVaryingRule::CornersPlus2);
    let mut corners = Vec::new();
    for (vertex, at) in at_vertices.iter().enumerate() {
        let of_one_face = |(_, faces): &(u32, usize)| *faces == 1;
        let all_sharp = topology.touches(vertex as u32)
            || match at.faces.len() {
                1 if rule == FaceVaryingRule::CornersPlus2 => at.open && !on_boundary[vertex],
                1 => false,
                2 if depends && at.divided => true,
                2 => rule == FaceVaryingRule::CornersPlus2 && at.faces.iter().any(of_one_face),
                _ => depends,
            }
            || (rule == FaceVaryingRule::Boundaries && at.open);
        let lone = at.face_count() == 1 && data.boundary == BoundaryRule::EdgeAndCorner;
        for (value, faces) in &at.faces {
            let corner = *faces == 1 && (rule != FaceVaryingRule::None || lone);
            let own = topology.mesh().vertex_sharpness(vertex as u32);
            let sharpness = if all_sharp || corner { SHARPNESS_INFINITE } else { own };
            corners.extend((sharpness > 0.0).then_some(Corner { vertex: *value, sharpness }));
        }
    }
    corners
}
