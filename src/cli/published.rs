//! Published errors of the same schemes, to stand beside ours.

use super::error::CliError;
use super::output::{self, Table};
use ash_subdiv::Scheme;
use ash_subdiv::measure::{ErrorReport, FaceErrors};

/// Position and normal error of a scheme.
type Row = (Scheme, f64, f64);

/// Loop, Schaefer, Ni, Castaño, *Approximating Subdivision Surfaces with Gregory Patches for Hardware Tessellation*
/// (2009), table 3: for meshes whose file name contains the first word.
const TABLE: [(&str, [Row; 3]); 2] = [
    ("frog", [(Scheme::Acc, 0.146, 0.0148), (Scheme::Pm, 0.079, 0.0111), (Scheme::Gregory, 0.090, 0.0108)]),
    ("bigguy", [(Scheme::Acc, 0.096, 0.0109), (Scheme::Pm, 0.072, 0.00783), (Scheme::Gregory, 0.082, 0.00710)]),
];

const NOTE: &str = "\
published: Loop, Schaefer, Ni, Castaño (2009), table 3, position in the paper's own unit: compare the ratios to gregory.
Metro (Cignoni et al. 1998) compares two triangle meshes: both surfaces were tessellated first, and what that changes is in
the figures. It samples vertices, edges and faces of each mesh by area, keeps each direction apart and reports the larger,
and counts points that find the other side of a thin part. Here points of the surfaces themselves are measured against a
dense mesh of the other, both ways in one mean, without those points. The public bigguy is not the paper's mesh.";

/// The table for the mesh of this name.
pub(super) fn rows(mesh: &str) -> Result<&'static [Row; 3], CliError> {
    let name = mesh.to_lowercase();
    let found = TABLE.iter().find(|(word, _)| name.contains(word)).map(|(_, rows)| rows);
    found.ok_or_else(|| {
        CliError::Usage(format!("--published: there are figures for the monster frog and for bigguy, not for {mesh:?}"))
    })
}

/// Writes them beside what was measured, each also over that of the scheme gregory.
pub(super) fn print(rows: &[Row; 3], report: &ErrorReport) -> Result<(), CliError> {
    let measured = |scheme| -> Option<FaceErrors> {
        let found = report.schemes.iter().find(|(s, _)| *s == scheme)?;
        Some(found.1.as_ref().ok()?.all)
    };
    let (_, position_unit, normal_unit) = rows[2];
    let unit = measured(Scheme::Gregory);
    let mut table = Table::new(&[1, 2, 3, 4, 5, 6, 7, 8]);
    table.row([&"", &"published", &"", &"", &"", &"here", &"", &"", &""]);
    table.row([&"scheme", &"position", &"ratio", &"normal", &"ratio", &"nearest", &"ratio", &"normal", &"ratio"]);
    for &(scheme, position, normal) in rows {
        let ratio = |value: Option<f64>, unit: Option<f64>| match (value, unit) {
            (Some(value), Some(unit)) => format!("{:.2}", value / unit),
            _ => "-".into(),
        };
        let number = |value: Option<f64>| value.map_or("-".into(), output::short);
        let errors = measured(scheme);
        let nearest = |errors: Option<FaceErrors>| Some(errors?.nearest?.rms);
        let angle = |errors: Option<FaceErrors>| Some(errors?.normal.rms);
        table.row([
            &scheme.name(),
            &position,
            &ratio(Some(position), Some(position_unit)),
            &normal,
            &ratio(Some(normal), Some(normal_unit)),
            &number(nearest(errors)),
            &ratio(nearest(errors), nearest(unit)),
            &number(angle(errors)),
            &ratio(angle(errors), angle(unit)),
        ]);
    }
    output::with_stdout(|out| Ok(writeln!(out)?))?;
    table.print()?;
    output::with_stdout(|out| Ok(writeln!(out, "{NOTE}")?))
}
