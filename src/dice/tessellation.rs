//! A tessellation with arrays of its own.

use super::error::DiceError;
use super::fill::VerticesMut;
use super::options::DiceOptions;
use super::place::Place;
use super::plan::{Plan, Sizes};
use super::real::{Real, Vector};
use crate::topology::Topology;
use glam::DVec3;

/// The limit surface as a mesh, in arrays that are filled again when control vertices move.
pub struct Tessellation<T = f32> {
    pub(super) plan: Plan<T>,
    pub(super) positions: Vec<[T; 3]>,
    pub(super) normals: Vec<[T; 3]>,
    pub(super) texcoords: Option<Vec<[f32; 2]>>,
    pub(super) quads: Vec<[u32; 4]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// A quad with corners at these positions, cut along the shorter diagonal.
pub(super) fn halves<T: Real>([a, b, c, d]: [u32; 4], corners: [Vector<T>; 4]) -> [[u32; 3]; 2] {
    let distance = |i: usize, j: usize| {
        let [a, b] = [corners[i], corners[j]];
        (0..3).fold(T::zero(), |sum, axis| sum + (a[axis] - b[axis]) * (a[axis] - b[axis]))
    };
    match distance(0, 2) <= distance(1, 3) {
        true => [[a, b, c], [a, c, d]],
        false => [[a, b, d], [b, c, d]],
    }
}

impl<T: Real> Tessellation<T> {
    /// Tessellates a mesh.
    ///
    /// # Errors
    /// [`DiceError`]: options that make no sense, and tessellations that are too large.
    pub fn new(topology: &Topology, options: &DiceOptions) -> Result<Self, DiceError> {
        let plan = Plan::new(topology, options)?;
        Self::of(plan, &topology.mesh().data().positions)
    }

    /// The sizes of a tessellation, before any array is made.
    ///
    /// # Errors
    /// As [`Tessellation::new`].
    pub fn size_of(topology: &Topology, options: &DiceOptions) -> Result<Sizes, DiceError> {
        Ok(Plan::<T>::new(topology, options)?.sizes())
    }

    /// Tessellates the mesh of a plan with control vertices at these positions.
    ///
    /// # Errors
    /// [`DiceError::Count`] if there are not as many positions as control vertices.
    pub fn of(plan: Plan<T>, control: &[[f64; 3]]) -> Result<Self, DiceError> {
        let Sizes { vertices, quads, triangles, .. } = plan.sizes();
        let zero = [T::zero(); 3];
        let mut tessellation = Self {
            positions: vec![zero; vertices],
            normals: vec![zero; vertices],
            texcoords: plan.has_texcoords().then(|| vec![[0.0; 2]; vertices]),
            quads: vec![[0; 4]; quads],
            triangles: vec![[0; 3]; triangles],
            plan,
        };
        let Self { plan, texcoords, quads, triangles, .. } = &mut tessellation;
        plan.fill_faces(quads, triangles)?;
        if let Some(texcoords) = texcoords {
            plan.fill_texcoords(texcoords)?;
        }
        let (count, given) = (plan.control_vertices, control.len());
        if count != given {
            return Err(DiceError::Count { what: "control positions", given, count });
        }
        let control: Vec<DVec3> = control.iter().map(|&p| p.into()).collect();
        let out = VerticesMut { positions: &mut tessellation.positions, normals: &mut tessellation.normals };
        tessellation.plan.fill_from(&control, out)?;
        Ok(tessellation)
    }

    /// Moves control vertices: positions and normals are filled again; faces and depths stay.
    ///
    /// # Errors
    /// [`DiceError::Count`] if there are not as many positions as control vertices.
    pub fn update(&mut self, control: &[[T; 3]]) -> Result<(), DiceError> {
        let out = VerticesMut { positions: &mut self.positions, normals: &mut self.normals };
        self.plan.fill(control, out)
    }

    /// What stays.
    pub fn plan(&self) -> &Plan<T> {
        &self.plan
    }

    /// Object space, on the limit surface but for rounding.
    pub fn positions(&self) -> &[[T; 3]] {
        &self.positions
    }

    /// Of length one, outwards; zero where the surface has none.
    pub fn normals(&self) -> &[[T; 3]] {
        &self.normals
    }

    /// One a vertex, if the mesh has texture coordinates.
    pub fn texcoords(&self) -> Option<&[[f32; 2]]> {
        self.texcoords.as_deref()
    }

    /// Faces of four vertices, counter-clockwise.
    pub fn quads(&self) -> &[[u32; 4]] {
        &self.quads
    }

    /// Faces of three vertices, where facets of different depths meet; counter-clockwise.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// All faces as triangles, quads cut along their shorter diagonals.
    pub fn all_triangles(&self) -> Vec<[u32; 3]> {
        let cut = |&quad: &[u32; 4]| halves(quad, quad.map(|vertex| self.positions[vertex as usize]));
        self.quads.iter().flat_map(cut).chain(self.triangles.iter().copied()).collect()
    }

    /// Where on the control mesh each vertex is.
    pub fn places(&self) -> Vec<Place> {
        self.plan.places()
    }
}
