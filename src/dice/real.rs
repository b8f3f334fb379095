//! The two precisions of a tessellation.

use std::fmt::Debug;

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// The number type of a tessellation's arrays: `f32` or `f64`.
pub trait Real: num_traits::Float + Default + Debug + Send + Sync + sealed::Sealed + 'static {
    /// The nearest number of the type.
    fn of(x: f64) -> Self;
    /// The same number.
    fn wide(self) -> f64;
}

impl Real for f32 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x as f32
    }

    #[inline(always)]
    fn wide(self) -> f64 {
        self.into()
    }
}

impl Real for f64 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn wide(self) -> f64 {
        self
    }
}

/// Three coordinates.
pub(super) type Vector<T> = [T; 3];

#[inline]
pub(super) fn cross<T: Real>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline]
pub(super) fn subtract<T: Real>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The vector made one long, unless it is zero.
pub(super) fn unit<T: Real>(a: Vector<T>) -> Vector<T> {
    // Made about one first, for squares of short vectors vanish.
    let largest = a[0].abs().max(a[1].abs()).max(a[2].abs());
    if largest <= T::zero() {
        return [T::zero(); 3];
    }
    let a = a.map(|x| x / largest);
    let length = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt();
    a.map(|x| x / length)
}
