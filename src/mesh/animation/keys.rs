//! Values at times, and what is between them.

use glam::DQuat;

/// What is between two keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Interpolation {
    Linear,
    Step,
    CubicSpline,
}

impl Interpolation {
    /// Values a key: with tangents a cubic spline has three, that into the key, the value and that out of it.
    pub(crate) fn values_a_key(self) -> usize {
        if self == Self::CubicSpline { 3 } else { 1 }
    }
}

/// Values of some width at strictly increasing times.
#[derive(Debug, Clone)]
pub(crate) struct Keys {
    interpolation: Interpolation,
    times: Vec<f64>,
    /// Key by key, `width` numbers a value.
    values: Vec<f64>,
    width: usize,
}

impl Keys {
    /// `None` unless there is a key, times are finite and increase, and there are as many values as they need.
    pub(crate) fn new(interpolation: Interpolation, times: Vec<f64>, values: Vec<f64>, width: usize) -> Option<Self> {
        let increase = times.iter().all(|time| time.is_finite()) && times.windows(2).all(|pair| pair[0] < pair[1]);
        let needed = times.len().checked_mul(interpolation.values_a_key() * width)?;
        let fits = !times.is_empty() && increase && values.len() == needed;
        fits.then_some(Self { interpolation, times, values, width })
    }

    /// The last time.
    pub(crate) fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// Numbers of a value.
    pub(crate) fn width(&self) -> usize {
        self.width
    }

    /// One of the values of a key: of a cubic spline that into it (0), at it (1) or out of it (2).
    fn value(&self, key: usize, which: usize) -> &[f64] {
        let first = (key * self.interpolation.values_a_key() + which) * self.width;
        &self.values[first..first + self.width]
    }

    /// The value at a key.
    fn at(&self, key: usize) -> &[f64] {
        self.value(key, self.interpolation.values_a_key() / 2)
    }

    /// The key before a time and the one after it, and how far the time is from one to the other.
    fn between(&self, seconds: f64) -> Result<(usize, f64, f64), usize> {
        let after = self.times.partition_point(|&time| time <= seconds);
        if after == 0 || after == self.times.len() {
            return Err(after.saturating_sub(1));
        }
        let [from, to] = [self.times[after - 1], self.times[after]];
        Ok((after - 1, (seconds - from) / (to - from), to - from))
    }

    /// Numbers at a time, each on its own.
    pub(crate) fn sample(&self, seconds: f64, out: &mut [f64]) {
        let (key, t, span) = match self.between(seconds) {
            Err(key) => return out.copy_from_slice(self.at(key)),
            Ok((key, ..)) if self.interpolation == Interpolation::Step => return out.copy_from_slice(self.at(key)),
            Ok(between) => between,
        };
        let [from, to] = [self.at(key), self.at(key + 1)];
        if self.interpolation == Interpolation::Linear {
            (0..self.width).for_each(|i| out[i] = (1.0 - t) * from[i] + t * to[i]);
            return;
        }
        let [leaving, arriving] = [self.value(key, 2), self.value(key + 1, 0)];
        let (t2, t3) = (t * t, t * t * t);
        let weights = [2.0 * t3 - 3.0 * t2 + 1.0, span * (t3 - 2.0 * t2 + t), 3.0 * t2 - 2.0 * t3, span * (t3 - t2)];
        let values = [from, leaving, to, arriving];
        (0..self.width).for_each(|i| out[i] = (0..4).map(|k| weights[k] * values[k][i]).sum());
    }

    /// A rotation at a time: on the shorter way from key to key.
    pub(crate) fn rotation(&self, seconds: f64) -> DQuat {
        let turn = |value: &[f64]| unit(DQuat::from_slice(value));
        match self.between(seconds) {
            Ok((key, t, _)) if self.interpolation == Interpolation::Linear => {
                slerp(turn(self.at(key)), turn(self.at(key + 1)), t)
            }
            _ => {
                let mut value = [0.0; 4];
                self.sample(seconds, &mut value);
                turn(&value)
            }
        }
    }
}

/// Files have unit quaternions only to their precision; a quaternion of zero turns nothing.
pub(crate) fn unit(rotation: DQuat) -> DQuat {
    if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY }
}

/// At even speed on the shorter way: a quaternion and its opposite turn alike.
fn slerp(from: DQuat, to: DQuat, t: f64) -> DQuat {
    let to = if from.dot(to) < 0.0 { -to } else { to };
    let angle = 2.0 * (to - from).length().atan2((to + from).length());
    if angle < 1e-9 {
        return (from * (1.0 - t) + to * t).normalize();
    }
    (from * ((1.0 - t) * angle).sin() + to * (t * angle).sin()) / angle.sin()
}
