//! Built-in control meshes, by name: something to draw without a file, and material for tests.
//!
//! Shapes are made in code, the same on every call. They stand with y up around the origin, 2 to 4 units large, faces
//! counter-clockwise from outside.
//!
//! ```
//! let creature = ash_subdiv::mesh::shape("creature")?;
//! assert_eq!(creature.boundary_edge_count(), 0);
//! # Ok::<(), ash_subdiv::MeshError>(())
//! ```

mod atlas;
mod creature;
mod machine;
mod polygons;
mod replicate;
mod sculpt;
mod simple;
mod tentacle;
#[cfg(test)]
mod tests;

pub use replicate::replicate;
pub use simple::grid_torus;

use super::{Animated, Animations, ControlMesh, MeshData, MeshError, Repairs};

/// A built-in shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct ShapeInfo {
    /// What [`shape`] calls it.
    pub name: &'static str,
    /// One line about it.
    pub summary: &'static str,
}

/// The built-in shapes.
pub fn shapes() -> &'static [ShapeInfo] {
    const fn info(name: &'static str, summary: &'static str) -> ShapeInfo {
        ShapeInfo { name, summary }
    }
    const SHAPES: &[ShapeInfo] = &[
        info("creature", "a young dragon of 1320 quads, over half of them irregular, with a texture atlas"),
        info("creature-mixed", "the creature with a third of its quads split into triangles"),
        info("machine-part", "a flanged hub with bosses and ribs: sharp and semi-sharp creases, corners"),
        info("polygons", "a ball of triangles, quads, pentagons and hexagons"),
        info("valences", "knobs on a slab: vertices of every valence from 3 to 12"),
        info("cloth", "an open sheet with a concave boundary and a hole"),
        info("tentacle", "an animated tube of 136 quads: it waves, curls and swallows"),
        info("torus", "16 x 8 quads, all regular"),
        info("cube", "6 quads"),
        info("tetrahedron", "4 triangles"),
        info("strip", "an open strip, 8 quads long and one wide"),
        info("fan", "9 triangles around a pole, open"),
        info("single-quad", "one quad"),
    ];
    SHAPES
}

/// Makes a built-in shape.
///
/// # Errors
/// [`MeshError::UnknownShape`] if [`shapes`] has no such name.
pub fn shape(name: &str) -> Result<ControlMesh, MeshError> {
    match name {
        "creature" => creature::creature(),
        "creature-mixed" => ControlMesh::new(creature::mixed(creature::creature()?.data())),
        "machine-part" => with_atlas(machine::build()?),
        "polygons" => ControlMesh::new(polygons::polygons()),
        "valences" => with_atlas(polygons::valences()),
        "cloth" => ControlMesh::new(simple::cloth()),
        "tentacle" => tentacle::mesh(),
        "torus" => ControlMesh::new(simple::torus()),
        "cube" => ControlMesh::new(simple::cube()),
        "tetrahedron" => ControlMesh::new(simple::tetrahedron()),
        "strip" => ControlMesh::new(simple::strip()),
        "fan" => ControlMesh::new(simple::fan()),
        "single-quad" => ControlMesh::new(simple::single_quad()),
        _ => {
            let known = shapes().iter().map(|shape| shape.name).collect::<Vec<_>>().join(", ");
            Err(MeshError::UnknownShape { name: name.to_owned(), known })
        }
    }
}

/// Makes a built-in shape with its animations, if it has any.
///
/// # Errors
/// As [`shape`].
pub fn animated_shape(name: &str) -> Result<Animated, MeshError> {
    match name {
        "tentacle" => tentacle::animated(),
        _ => Ok(Animated { mesh: shape(name)?, repairs: Repairs::default(), animations: Animations::default() }),
    }
}

/// A mesh of quads, with texture coordinates.
fn with_atlas(data: MeshData) -> Result<ControlMesh, MeshError> {
    let mesh = ControlMesh::new(data)?;
    let texcoords = Some(atlas::unwrap_quads(&mesh));
    ControlMesh::new(MeshData { texcoords, ..mesh.into_data() })
}
