use glam::DVec3;

/// A point of a limit surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitSample {
    /// In object space.
    pub position: DVec3,
    /// Derivative by u.
    pub du: DVec3,
    /// Derivative by v.
    pub dv: DVec3,
    /// Unit vector along `du x dv`, or zero where there is none.
    pub normal: DVec3,
}
