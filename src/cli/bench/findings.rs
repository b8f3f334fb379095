//! Findings over several rows: the growth of time, the passes from which on compute wins, the cost of a view that clips.

use super::super::described::described;
use super::facts::{MeshOut, original_name, sharpness_in_name};
use super::row::{GEOMETRY, GPU, Interval, NONE, Row, Setting, Who};
use ash_subdiv::Construction;
use ash_subdiv::bench::Path;
use ash_subdiv::measure::statistics::{below_zero_from, growth, growth_by_rounds, paired_difference, paired_ratio};
use serde::{Deserialize, Serialize};
use std::fmt;

described! {
    /// Lists are empty where the rows do not say anything of it.
    #[derive(Debug, Default, Serialize, Deserialize)]
    pub(super) struct Findings {
        /// The powers of patches by which time and bytes grow, over copies of one mesh.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        pub growth: Vec<Finding>,
        /// The passes from which on evaluation by compute is faster than this contestant, on straight lines between the
        /// counts that were measured.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        pub break_even: Vec<Finding>,
        /// The time of a triangle that clipping leaves, over that in the first view.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        pub views: Vec<Finding>,
        /// Time and bytes with this sharpness of creases, over those with the least.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        pub sharpness: Vec<Finding>,
    }
}

described! {
    #[derive(Debug, Serialize, Deserialize)]
    pub(super) struct Finding {
        /// Of growth with the mesh that the others are copies of; of the counts of passes together with none.
        #[serde(flatten)]
        pub setting: Setting,
        #[serde(flatten)]
        pub who: Who,
        pub factor: f32,
        pub geometry: Bounds,
        pub gpu: Bounds,
        /// Of growth: the power of patches by which bytes grow. Of sharpness: bytes over those with the least.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub bytes: Option<f64>,
    }
}

described! {
    /// An estimate with its interval of 95 %; `None` where it is more than what was measured can tell.
    #[derive(Debug, Clone, Copy, Serialize, Deserialize)]
    pub(super) struct Bounds {
        pub value: Option<f64>,
        pub low: Option<f64>,
        pub high: Option<f64>,
        /// The least that what was measured can tell, if it is not the least there is: a number that is no more may be less.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub least: Option<f64>,
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |x: Option<f64>| match x {
            None => "more".to_owned(),
            Some(x) if self.least.is_some_and(|least| x <= least) => format!("{x} or fewer"),
            Some(x) => format!("{x:.2}"),
        };
        write!(f, "{} ({} to {})", number(self.value), number(self.low), number(self.high))
    }
}

impl From<Interval> for Bounds {
    fn from(Interval { value, low, high }: Interval) -> Self {
        Self { value: Some(value), low: Some(low), high: Some(high), least: None }
    }
}

impl Findings {
    pub(super) fn of(rows: &[Row], meshes: &[MeshOut]) -> Self {
        let mut findings = Self::default();
        for (setting, alike) in groups(rows, |setting| any_size(setting, meshes)) {
            findings.growth.extend(growth_of(&setting, &alike));
        }
        for (setting, alike) in groups(rows, any_passes) {
            if alike[0].who.path == Path::Tessellation.name() {
                findings.break_even.extend(break_even(&setting, &alike, rows));
            }
        }
        for (_, alike) in groups(rows, any_view) {
            let base = alike.iter().find(|other| other.setting.view == rows[0].setting.view);
            findings.views.extend(alike.iter().filter_map(|row| of_view(row, base?)));
        }
        for (_, alike) in groups(rows, |setting| any_sharpness(setting, meshes)) {
            if alike[0].who.is_floor() {
                continue;
            }
            findings.sharpness.extend(alike[1..].iter().filter_map(|row| of_sharpness(row, alike[0])));
        }
        findings
    }

    /// The lists, each with what it is about.
    pub(super) fn lists(&self) -> [(&'static str, &[Finding]); 4] {
        [
            ("time grows as patches^", &self.growth),
            ("compute wins from so many passes on", &self.break_even),
            ("time of a visible triangle, to the first view", &self.views),
            ("time and bytes, to the least sharpness", &self.sharpness),
        ]
    }
}

/// The same for all copies of a mesh.
pub(super) fn any_size(setting: &Setting, meshes: &[MeshOut]) -> Setting {
    Setting { mesh: original_name(meshes, &setting.mesh).to_owned(), ..setting.clone() }
}

/// The same for all sharpness of a mesh.
pub(super) fn any_sharpness(setting: &Setting, meshes: &[MeshOut]) -> Setting {
    let sharpness = meshes.iter().find(|mesh| mesh.name == setting.mesh).and_then(|mesh| mesh.sharpness);
    let mesh = match sharpness {
        Some(sharpness) => setting.mesh.replacen(&sharpness_in_name(sharpness), "", 1),
        None => setting.mesh.clone(),
    };
    Setting { mesh, ..setting.clone() }
}

pub(super) fn any_passes(setting: &Setting) -> Setting {
    Setting { passes: 0, ..setting.clone() }
}

fn any_view(setting: &Setting) -> Setting {
    Setting { view: String::new(), ..setting.clone() }
}

/// Rows of one contestant and factor, together where `same` makes their settings the same: with that setting.
fn groups(rows: &[Row], same: impl Fn(&Setting) -> Setting) -> Vec<(Setting, Vec<&Row>)> {
    let mut groups: Vec<(Setting, Vec<&Row>)> = Vec::new();
    for row in rows {
        let setting = same(&row.setting);
        let is_same = |(of, alike): &&mut (Setting, Vec<&Row>)| {
            *of == setting && (&alike[0].who, alike[0].factor) == (&row.who, row.factor)
        };
        match groups.iter_mut().find(is_same) {
            Some((_, alike)) => alike.push(row),
            None => groups.push((setting, vec![row])),
        }
    }
    groups
}

/// Finding of both kinds of time.
fn finding(setting: &Setting, row: &Row, of: impl Fn(&str) -> Option<Bounds>) -> Option<Finding> {
    Some(Finding {
        setting: setting.clone(),
        who: row.who.clone(),
        factor: row.factor,
        geometry: of(GEOMETRY)?,
        gpu: of(GPU)?,
        bytes: None,
    })
}

fn growth_of(setting: &Setting, rows: &[&Row]) -> Option<Finding> {
    let of = |what: &str| {
        let points: Vec<_> = rows.iter().map(|row| (row.patches as f64, row.frames(what))).collect();
        growth_by_rounds(&points).map(|power| Interval::from(power).into())
    };
    let bytes: Vec<_> = rows.iter().map(|row| (row.patches as f64, row.total_bytes() as f64)).collect();
    Some(Finding { bytes: growth(&bytes), ..finding(setting, rows[0], of)? })
}

/// `rows` are of one that tessellates in every pass.
fn break_even(setting: &Setting, rows: &[&Row], all: &[Row]) -> Option<Finding> {
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
        let fewest = f64::from(pairs.first()?.0.setting.passes);
        Some(Bounds { value, low, high, least: Some(fewest).filter(|&fewest| fewest > 1.0) })
    };
    // One count says nothing of others.
    pairs.get(1)?;
    finding(setting, rows[0], of)
}

/// A row of another view than the first, `base`.
fn of_view(row: &Row, base: &Row) -> Option<Finding> {
    let visible = |row: &Row| row.visible_triangles.filter(|&count| count > 0).map(|count| count as f64);
    let fewer = visible(base)? / visible(row)?;
    let of = |what: &str| {
        let ratio = paired_ratio(row.frames(what), base.frames(what))?;
        Some(Interval { value: ratio.value * fewer, low: ratio.low * fewer, high: ratio.high * fewer }.into())
    };
    if row.setting.view == base.setting.view { None } else { finding(&row.setting, row, of) }
}

/// A row of a sharper mesh than that of `base`.
fn of_sharpness(row: &Row, base: &Row) -> Option<Finding> {
    let of = |what: &str| paired_ratio(row.frames(what), base.frames(what)).map(|ratio| Interval::from(ratio).into());
    let bytes = row.total_bytes() as f64 / base.total_bytes() as f64;
    Some(Finding { bytes: Some(bytes).filter(|bytes| bytes.is_finite()), ..finding(&row.setting, row, of)? })
}
