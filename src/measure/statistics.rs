//! Statistics of noisy measurements: medians, spreads, and how sure a difference is. Nothing here assumes a distribution:
//! times on a shared machine have none worth a name.

use statrs::distribution::{Binomial, ContinuousCDF, DiscreteCDF, Normal};

/// The chance that an interval of [`Estimate`] holds what it estimates.
pub const CONFIDENCE: f64 = 0.95;
/// The fewest values for which the interval of a median has that chance: with five, both ends are on the same side of it
/// in one case of sixteen.
pub const FEWEST: usize = 6;

/// The middle and the spread of some values, in their unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// As many are greater as are smaller.
    pub median: f64,
    /// The smallest.
    pub min: f64,
    /// The greatest.
    pub max: f64,
    /// The median distance from the median.
    pub mad: f64,
}

impl Summary {
    /// `None` if there are no values, or one of them is no number.
    pub fn of(values: &[f64]) -> Option<Self> {
        let sorted = sorted(values.to_vec())?;
        let median = middle(&sorted);
        let distances = sorted.iter().map(|x| (x - median).abs()).collect();
        let (min, max) = (*sorted.first()?, *sorted.last()?);
        Some(Self { median, min, max, mad: middle(&self::sorted(distances)?) })
    }
}

/// An estimate, and the interval that holds the true value with a chance of [`CONFIDENCE`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// The lower end of the interval.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
}

/// The median of `values` and its interval between two of them (the sign test turned round: Conover, *Practical
/// Nonparametric Statistics*, 3.2).
///
/// `None` for fewer than [`FEWEST`] values, or where one is no number.
pub fn median(values: &[f64]) -> Option<Estimate> {
    let sorted = sorted(values.to_vec())?;
    if sorted.len() < FEWEST {
        return None;
    }
    // The count of values below the true median: heads of as many coins.
    let below = Binomial::new(0.5, sorted.len() as u64).ok()?;
    let outside = (1.0 - CONFIDENCE) / 2.0;
    let out = (0..sorted.len() / 2).take_while(|&k| below.cdf(k as u64) <= outside).count();
    // With FEWEST values and more, the outermost of them are far enough apart.
    let low = out.checked_sub(1)?;
    Some(Estimate { value: middle(&sorted), low: sorted[low], high: sorted[sorted.len() - 1 - low] })
}

/// The median of `a[i] / b[i]`, for values measured in turns: what drifts slowly cancels in each pair.
///
/// `None` if there are not as many of both, at least [`FEWEST`], or a ratio is no number.
pub fn paired_ratio(a: &[f64], b: &[f64]) -> Option<Estimate> {
    paired(a, b, |a, b| a / b)
}

/// The median of `a[i] - b[i]`; else as [`paired_ratio`].
pub fn paired_difference(a: &[f64], b: &[f64]) -> Option<Estimate> {
    paired(a, b, |a, b| a - b)
}

fn paired(a: &[f64], b: &[f64], of: impl Fn(f64, f64) -> f64) -> Option<Estimate> {
    let values: Vec<f64> = a.iter().zip(b).map(|(&a, &b)| of(a, b)).collect();
    if a.len() == b.len() { median(&values) } else { None }
}

/// Difference of the values of two separate runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// New over old: the median of all ratios of a new value to an old one (Hodges and Lehmann 1963).
    pub ratio: Estimate,
    /// Confidence that there is a difference, from 0 to 1: one less the two-sided p-value of the rank-sum test (Mann
    /// and Whitney 1947), with the normal approximation.
    pub confidence: f64,
}

/// Compares positive values of two runs.
///
/// `None` with fewer than [`FEWEST`] values in one of them, or where one is not above zero.
pub fn change(old: &[f64], new: &[f64]) -> Option<Change> {
    if old.len().min(new.len()) < FEWEST || old.iter().chain(new).any(|x| !x.is_finite() || *x <= 0.0) {
        return None;
    }
    let ratios = sorted(new.iter().flat_map(|n| old.iter().map(move |o| n / o)).collect())?;
    let (m, n) = (old.len() as f64, new.len() as f64);
    let normal = Normal::standard();
    // Of all pairs, those in which the new value is greater; an even pair counts half.
    let greater: f64 = ratios.iter().map(|&r| if r > 1.0 { 1.0 } else { f64::from(r == 1.0) / 2.0 }).sum();
    let ties = tie_correction(old, new)?;
    let spread = (m * n / 12.0 * ((m + n + 1.0) - ties / ((m + n) * (m + n - 1.0)))).sqrt();
    // Half a pair nearer to the middle: counts are whole, the normal distribution is not.
    let off = ((greater - m * n / 2.0).abs() - 0.5).max(0.0);
    let confidence = if spread > 0.0 { 1.0 - 2.0 * (1.0 - normal.cdf(off / spread)) } else { 0.0 };
    let reach = normal.inverse_cdf(0.5 + CONFIDENCE / 2.0) * (m * n * (m + n + 1.0) / 12.0).sqrt();
    let low = (m * n / 2.0 - reach).floor().max(0.0) as usize;
    let ratio = Estimate { value: middle(&ratios), low: ratios[low], high: ratios[ratios.len() - 1 - low] };
    Some(Change { ratio, confidence })
}

/// The power of `x` by which `y` grows: the slope of a straight line through their logarithms, by least squares.
///
/// `None` with fewer than two different `x`, or where one of either is not above zero.
pub fn growth(points: &[(f64, f64)]) -> Option<f64> {
    if points.iter().any(|&(x, y)| !(x > 0.0 && y > 0.0)) {
        return None;
    }
    let count = points.len() as f64;
    let logs = || points.iter().map(|(x, y)| (x.ln(), y.ln()));
    let (x, y) = logs().fold((0.0, 0.0), |sum, (x, y)| (sum.0 + x / count, sum.1 + y / count));
    let (both, square) = logs().fold((0.0, 0.0), |sum, at| {
        let (dx, dy) = (at.0 - x, at.1 - y);
        (sum.0 + dx * dy, sum.1 + dx * dx)
    });
    (square > 0.0).then(|| both / square)
}

/// As [`growth`], with its interval: the median of the growth of each round, where round `i` has `y[i]` of every point.
///
/// `None` where one of the rounds has no growth, or there are fewer than [`FEWEST`].
pub fn growth_by_rounds(points: &[(f64, &[f64])]) -> Option<Estimate> {
    let rounds = points.iter().map(|(_, y)| y.len()).min()?;
    let of_round = |i: usize| growth(&points.iter().map(|&(x, y)| (x, y[i])).collect::<Vec<_>>());
    median(&(0..rounds).map(of_round).collect::<Option<Vec<_>>>()?)
}

/// From which `x` on a difference is below zero, and the interval of that: the first of [`Estimate`]'s three values, and
/// where its lower and upper ends are.
///
/// Each is found on the straight lines between points with rising `x`: the last place where they go below zero, or the
/// first `x` if they always are; `None` if they are not at the last.
pub fn below_zero_from(points: &[(f64, Estimate)]) -> [Option<f64>; 3] {
    let from = |of: fn(&Estimate) -> f64| {
        let y = |i: usize| of(&points[i].1);
        let below = (0..points.len()).rev().take_while(|&i| y(i) < 0.0).last()?;
        let Some(above) = below.checked_sub(1) else { return Some(points[below].0) };
        let (before, after) = (points[above].0, points[below].0);
        Some(before + (after - before) * y(above) / (y(above) - y(below)))
    };
    [from(|y| y.value), from(|y| y.low), from(|y| y.high)]
}

/// The sum of `t^3 - t` over groups of `t` equal values.
fn tie_correction(old: &[f64], new: &[f64]) -> Option<f64> {
    let all = sorted([old, new].concat())?;
    let groups = all.chunk_by(|a, b| a == b).map(|group| group.len() as f64);
    Some(groups.map(|t| t * t * t - t).sum())
}

fn sorted(mut values: Vec<f64>) -> Option<Vec<f64>> {
    values.sort_unstable_by(f64::total_cmp);
    (!values.is_empty() && values.iter().all(|x| !x.is_nan())).then_some(values)
}

/// The median of sorted values.
fn middle(sorted: &[f64]) -> f64 {
    let n = sorted.len();
    (sorted[(n - 1) / 2] + sorted[n / 2]) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn summaries() {
        let summary = Summary::of(&[9.0, 1.0, 4.0, 2.0]).unwrap();
        assert_eq!(summary, Summary { median: 3.0, min: 1.0, max: 9.0, mad: 1.5 });
        assert_eq!(Summary::of(&[7.0]), Some(Summary { median: 7.0, min: 7.0, max: 7.0, mad: 0.0 }));
        assert_eq!(Summary::of(&[]), None);
        assert_eq!(Summary::of(&[1.0, f64::NAN]), None);
    }

    #[test]
    fn intervals_of_medians_are_those_of_the_tables() {
        // Conover, table A3: the ranks for 95 %.
        for (n, low, high) in [(6, 1, 6), (8, 1, 8), (9, 2, 8), (15, 4, 12), (20, 6, 15), (21, 6, 16)] {
            let values: Vec<f64> = (1..=n).rev().map(f64::from).collect();
            let estimate = median(&values).unwrap();
            assert_eq!((estimate.low, estimate.high), (f64::from(low), f64::from(high)), "{n}");
            assert_eq!(estimate.value, (f64::from(n) + 1.0) / 2.0);
        }
        assert_eq!(median(&[1.0; 5]), None);
    }

    #[test]
    fn pairs_cancel_drift() {
        // The machine slows down threefold while both are measured in turns; b takes 1.2 times as long.
        let drift = |i: usize| 1.0 + 2.0 * i as f64 / 20.0;
        let a: Vec<f64> = (0..20).map(|i| 10.0 * drift(i)).collect();
        let b: Vec<f64> = (0..20).map(|i| 12.0 * drift(i)).collect();
        let ratio = paired_ratio(&b, &a).unwrap();
        assert!((ratio.value - 1.2).abs() < 1e-12 && ratio.high - ratio.low < 1e-12, "{ratio:?}");
        assert!(paired_difference(&b, &a).unwrap().low > 0.0);
        assert_eq!(paired_ratio(&b, &a[1..]), None);
    }

    #[test]
    fn changes_are_found_and_none_are_made_up() {
        let noise = |seed: u64, i: u64| {
            let bits = (seed + i).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            f64::from((bits >> 40) as u32) / f64::from(1 << 24)
        };
        let run = |seed, scale: f64| (0..15).map(|i| scale * (10.0 + noise(seed, i))).collect::<Vec<f64>>();
        let same = change(&run(1, 1.0), &run(500, 1.0)).unwrap();
        assert!(same.confidence < 0.9 && same.ratio.low < 1.0 && same.ratio.high > 1.0, "{same:?}");
        let slower = change(&run(1, 1.0), &run(500, 1.3)).unwrap();
        assert!(slower.confidence > 0.999 && (slower.ratio.value - 1.3).abs() < 0.05, "{slower:?}");
        assert!(slower.ratio.low > 1.0 && slower.ratio.high < 1.6);
        let faster = change(&run(500, 1.3), &run(1, 1.0)).unwrap();
        assert!((faster.ratio.value * slower.ratio.value - 1.0).abs() < 1e-9);
        let equal = change(&[2.0; 8], &[2.0; 8]).unwrap();
        assert_eq!((equal.confidence, equal.ratio.value), (0.0, 1.0));
        assert_eq!(change(&[1.0; 8], &[0.0; 8]), None);
        assert_eq!(change(&[1.0; 8], &[1.0; 5]), None);
    }

    #[test]
    fn growth_is_the_power() {
        let points = |power: f64| [1.0, 8.0, 64.0, 100.0].map(|x: f64| (x, 3.0 * x.powf(power)));
        for power in [0.0, 1.0, 1.7] {
            assert!((growth(&points(power)).unwrap() - power).abs() < 1e-12);
        }
        assert_eq!(growth(&[(2.0, 1.0), (2.0, 3.0)]), None);
        assert_eq!(growth(&[(2.0, 1.0), (3.0, 0.0)]), None);
    }

    #[test]
    fn growth_has_an_interval() {
        // Each round its own power, from 0.9 to 1.1.
        let of = |x: f64| (0..9).map(|i| x.powf(0.9 + f64::from(i) / 40.0)).collect::<Vec<f64>>();
        let (few, many) = (of(10.0), of(1000.0));
        let growth = growth_by_rounds(&[(10.0, &few), (1000.0, &many)]).unwrap();
        assert!((growth.value - 1.0).abs() < 1e-9 && growth.low < 0.95 && growth.high > 1.05, "{growth:?}");
        assert_eq!(growth_by_rounds(&[(10.0, &few[..5]), (1000.0, &many)]), None);
        assert_eq!(growth_by_rounds(&[(10.0, &few), (10.0, &many)]), None);
        assert_eq!(growth_by_rounds(&[]), None);
    }

    #[test]
    fn differences_go_below_zero() {
        let estimate = |value: f64| Estimate { value, low: value - 1.0, high: value + 1.0 };
        let points = |values: &[f64]| (1..).map(f64::from).zip(values.iter().map(|&y| estimate(y))).collect::<Vec<_>>();
        let of = |values: &[f64]| below_zero_from(&points(values));
        // The middle crosses between 2 and 3, the lower end at 2, the upper between 3 and 4.
        assert_eq!(of(&[2.0, 1.0, -1.0, -2.0]), [Some(2.5), Some(2.0), Some(3.0)]);
        assert_eq!(of(&[-2.0, -3.0]), [Some(1.0); 3]);
        assert_eq!(of(&[3.0, 2.0]), [None; 3]);
        assert_eq!(of(&[1.5, -0.5]), [Some(1.75), Some(1.25), None]);
        // What comes back does not count.
        assert_eq!(of(&[-4.0, 4.0, -4.0])[0], Some(2.5));
        assert_eq!(below_zero_from(&[]), [None; 3]);
    }

    #[test]
    fn confidence_is_that_of_the_rank_sum() {
        // Counted by hand: in 32 of 36 pairs the new value is greater; the expected count is 18, its variance 39.
        let (old, new) = ([1.0, 2.0, 3.0, 4.0, 5.0, 6.5], [6.0, 7.0, 8.0, 9.0, 10.0, 3.5]);
        let confidence = change(&old, &new).unwrap().confidence;
        // The normal distribution at 13.5 / sqrt(39) = 2.1617, from a table.
        assert!((confidence - 0.96936).abs() < 1e-5, "{confidence}");
    }
}
