//! Where vertices are on the control mesh.

/// A point of the control mesh: parameters as of [`LimitSurface`](crate::limit::LimitSurface).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Place {
    /// The face.
    pub face: u32,
    /// -1 on a quad; on any other face the corner around which `u` and `v` count.
    pub sub: i32,
    /// From 0 to 1.
    pub u: f32,
    /// From 0 to 1.
    pub v: f32,
}

/// A point of the facet at corner `corner` of a face with so many corners.
pub(super) fn place(face: u32, corner: u32, corners: u32, [u, v]: [f32; 2]) -> Place {
    if corners != 4 {
        return Place { face, sub: corner as i32, u, v };
    }
    let (a, b) = (u / 2.0, v / 2.0);
    let [u, v] = match corner {
        0 => [a, b],
        1 => [1.0 - b, a],
        2 => [1.0 - a, 1.0 - b],
        _ => [b, 1.0 - a],
    };
    Place { face, sub: -1, u, v }
}
