//! Points in the two precisions in which patches are evaluated.

use glam::{DVec3, Vec3};
use std::ops::{Add, Mul, Sub};

/// A point or vector in space: [`Vec3`] as on the GPU, [`DVec3`] as reference.
pub trait Point:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<Self::Scalar, Output = Self> + Send + Sync
{
    /// Of its coordinates.
    type Scalar: num_traits::Float + Send + Sync;

    /// The cross product.
    fn cross(self, other: Self) -> Self;
    /// The scalar product.
    fn dot(self, other: Self) -> Self::Scalar;
}

impl Point for Vec3 {
    type Scalar = f32;

    fn cross(self, other: Self) -> Self {
        Vec3::cross(self, other)
    }

    fn dot(self, other: Self) -> f32 {
        Vec3::dot(self, other)
    }
}

impl Point for DVec3 {
    type Scalar = f64;

    fn cross(self, other: Self) -> Self {
        DVec3::cross(self, other)
    }

    fn dot(self, other: Self) -> f64 {
        DVec3::dot(self, other)
    }
}

/// A point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample<P> {
    /// Object space.
    pub position: P,
    /// Of length one, towards the side from which the patch is counter-clockwise.
    pub normal: P,
}

/// The number `x` as a scalar of `P`.
pub(crate) fn scalar<P: Point>(x: f64) -> P::Scalar {
    // Every f64 converts to f32 and f64, at worst to infinity.
    num_traits::cast(x).unwrap_or_else(num_traits::Float::nan)
}

/// The unit vector along `du x dv`; where the derivatives are parallel, along `fallback`.
///
/// GLSL twin: `unit_normal` in `glsl/lib/evaluate/patch.glsl`.
pub(crate) fn unit_normal<P: Point>(du: P, dv: P, fallback: P) -> P {
    use num_traits::Float;
    let normal = du.cross(dv);
    let (squared, zero) = (normal.dot(normal), scalar::<P>(0.0));
    // Within 1e-5 rad of each other: what is left of the cross product is rounding.
    let least = scalar::<P>(1e-10) * (du.dot(du) * dv.dot(dv));
    let (normal, squared) = if squared > least { (normal, squared) } else { (fallback, fallback.dot(fallback)) };
    if squared > zero { normal * squared.sqrt().recip() } else { normal }
}
