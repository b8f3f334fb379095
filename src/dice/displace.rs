//! Height maps, baked into the vertices.

use super::error::DiceError;
use super::real::{Real, Vector, cross, subtract, unit};
use super::tessellation::Tessellation;

impl<T: Real> Tessellation<T> {
    /// Moves every vertex along its normal by `height` of its texture coordinates, in object space, and makes the normals those of
    /// the faces, weighted by their areas.
    ///
    /// A vertex that several copies share moves by the normal and the texture coordinates of its owner, so that no crack opens.
    /// [`Tessellation::update`] undoes it.
    ///
    /// # Errors
    /// [`DiceError::NoTexcoords`].
    pub fn displace(&mut self, height: impl Fn([f32; 2]) -> T) -> Result<(), DiceError> {
        let Self { plan, positions, normals, texcoords, quads, triangles } = self;
        let texcoords = texcoords.as_deref().ok_or(DiceError::NoTexcoords)?;
        let owned = plan.layout.owned as usize;
        for ((position, normal), &texcoord) in positions.iter_mut().zip(&*normals).zip(texcoords).take(owned) {
            let height = height(texcoord);
            (0..3).for_each(|axis| position[axis] = position[axis] + height * normal[axis]);
        }
        let sources = &plan.layout.sources;
        for (copy, source) in (owned..).zip(sources) {
            positions[copy] = positions[source.position as usize];
        }
        normals.fill([T::zero(); 3]);
        let group = |vertex: u32| match (vertex as usize).checked_sub(owned) {
            Some(copy) => sources[copy].normal as usize,
            None => vertex as usize,
        };
        let mut add = |face: &[u32], normal: Vector<T>| {
            for &vertex in face {
                let sum = &mut normals[group(vertex)];
                (0..3).for_each(|axis| sum[axis] = sum[axis] + normal[axis]);
            }
        };
        let side = |from: u32, to: u32| subtract(positions[to as usize], positions[from as usize]);
        for face in &*quads {
            add(face, cross(side(face[0], face[2]), side(face[1], face[3])));
        }
        for face in &*triangles {
            add(face, cross(side(face[0], face[1]), side(face[0], face[2])));
        }
        normals.iter_mut().for_each(|normal| *normal = unit(*normal));
        for (copy, source) in (owned..).zip(sources) {
            normals[copy] = normals[source.normal as usize];
        }
        Ok(())
    }
}
