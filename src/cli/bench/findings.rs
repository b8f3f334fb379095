//! What rows say together: how time grows, from how many passes on compute wins, what a view that clips costs.

use super::results::{GEOMETRY, GPU, Interval, NONE, Row, Setting, Who};
use ash_subdiv::Construction;
use ash_subdiv::bench::Path;
use ash_subdiv::measure::statistics::{below_zero_from, growth, growth_by_rounds, paired_difference, paired_ratio};
use serde::{Deserialize, Serialize};
use std::fmt;

/// Lists are empty where the rows do not say anything of it.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Findings {
    /// The powers of patches by which time and bytes grow, over meshes of several sizes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub growth: Vec<Finding>,
    /// The passes from which on evaluation by compute is faster than this contestant, on straight lines between the
    /// counts that were measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub break_even: Vec<Finding>,
    /// The time of a triangle that clipping leaves, over that in the first view.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub views: Vec<Finding>,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Finding {
    /// Of the last row that it is drawn from.
    #[serde(flatten)]
    pub setting: Setting,
    #[serde(flatten)]
    pub who: Who,
    pub factor: f32,
    pub geometry: Bounds,
    pub gpu: Bounds,
    /// Of growth: the power of patches by which bytes grow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bytes: Option<f64>,
}

/// An estimate with its interval of 95 %; `None` where it is more than what was measured can tell.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Bounds {
    pub value: Option<f64>,
    pub low: Option<f64>,
    pub high: Option<f64>,
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |x: Option<f64>| x.map_or("more".to_owned(), |x| format!("{x:.2}"));
        write!(f, "{} ({} to {})", number(self.value), number(self.low), number(self.high))
    }
}

impl From<Interval> for Bounds {
    fn from(Interval { value, low, high }: Interval) -> Self {
        Self { value: Some(value), low: Some(low), high: Some(high) }
    }
}

impl Findings {
    pub(super) fn of(rows: &[Row]) -> Self {
        let mut findings = Self::default();
        // Each of those that differ in nothing but the mesh, the passes or the view is looked at once, with the first.
        let first = |row: &Row, same: fn(&Setting) -> Setting| {
            let alike = |other: &&Row| is_same(row, other, same);
            rows.iter().find(alike).is_some_and(|first| std::ptr::eq(first, row))
        };
        for row in rows {
            let alike = |same: fn(&Setting) -> Setting| rows.iter().filter(move |other| is_same(row, other, same));
            if first(row, any_mesh) {
                findings.growth.extend(growth_of(&alike(any_mesh).collect::<Vec<_>>()));
            }
            if first(row, any_passes) && row.who.path == Path::Tessellation.name() {
                findings.break_even.extend(break_even(&alike(any_passes).collect::<Vec<_>>(), rows));
            }
            let base = alike(any_view).find(|other| other.setting.view == rows[0].setting.view);
            findings.views.extend(base.and_then(|base| of_view(row, base)));
        }
        findings
    }

    /// The lists, each with what it is about.
    pub(super) fn lists(&self) -> [(&'static str, &[Finding]); 3] {
        [
            ("time grows as patches^", &self.growth),
            ("compute wins from so many passes on", &self.break_even),
            ("time of a visible triangle, to the first view", &self.views),
        ]
    }
}

fn any_mesh(setting: &Setting) -> Setting {
    Setting { mesh: String::new(), ..setting.clone() }
}

fn any_passes(setting: &Setting) -> Setting {
    Setting { passes: 0, ..setting.clone() }
}

fn any_view(setting: &Setting) -> Setting {
    Setting { view: String::new(), ..setting.clone() }
}

/// Whether two rows are of one contestant, and of one setting but for what `same` takes out.
fn is_same(a: &Row, b: &Row, same: fn(&Setting) -> Setting) -> bool {
    (&a.who, a.factor, same(&a.setting)) == (&b.who, b.factor, same(&b.setting))
}

/// Of both kinds of time.
fn finding(last: &Row, of: impl Fn(&str) -> Option<Bounds>) -> Option<Finding> {
    Some(Finding {
        setting: last.setting.clone(),
        who: last.who.clone(),
        factor: last.factor,
        geometry: of(GEOMETRY)?,
        gpu: of(GPU)?,
        bytes: None,
    })
}

fn growth_of(rows: &[&Row]) -> Option<Finding> {
    let of = |what: &str| {
        let points: Vec<_> = rows.iter().map(|row| (row.patches as f64, row.frames(what))).collect();
        growth_by_rounds(&points).map(|power| Interval::from(power).into())
    };
    let bytes: Vec<_> = rows.iter().map(|row| (row.patches as f64, row.total_bytes() as f64)).collect();
    Some(Finding { bytes: growth(&bytes), ..finding(rows.last()?, of)? })
}

/// `rows` are of one that tessellates in every pass.
fn break_even(rows: &[&Row], all: &[Row]) -> Option<Finding> {
    let by_compute = |row: &Row| {
        let wanted = Who {
            construction: Construction::Cached.name().to_owned(),
            path: Path::Compute.name().to_owned(),
            cull: NONE.to_owned(),
            ..row.who.clone()
        };
        let computes = |other: &&Row| other.who == wanted;
        all.iter().filter(|other| other.is_beside(row)).find(computes)
    };
    let mut pairs: Vec<_> = rows.iter().filter_map(|&row| Some((row, by_compute(row)?))).collect();
    pairs.sort_unstable_by_key(|(row, _)| row.setting.passes);
    let of = |what: &str| {
        let point = |(row, other): &(&Row, &Row)| {
            let more = paired_difference(other.frames(what), row.frames(what))?;
            Some((f64::from(row.setting.passes), more))
        };
        let [value, low, high] = below_zero_from(&pairs.iter().map(point).collect::<Option<Vec<_>>>()?);
        Some(Bounds { value, low, high })
    };
    // One count says nothing of others.
    let (last, _) = pairs.get(1..)?.last()?;
    finding(last, of)
}

/// A row of another view than the first, `base`.
fn of_view(row: &Row, base: &Row) -> Option<Finding> {
    let visible = |row: &Row| row.visible_triangles.filter(|&count| count > 0).map(|count| count as f64);
    let fewer = visible(base)? / visible(row)?;
    let of = |what: &str| {
        let ratio = paired_ratio(row.frames(what), base.frames(what))?;
        Some(Interval { value: ratio.value * fewer, low: ratio.low * fewer, high: ratio.high * fewer }.into())
    };
    if row.setting.view == base.setting.view { None } else { finding(row, of) }
}
