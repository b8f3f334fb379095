//! What evaluations go with.

use crate::gpu::{Features, Spacing};
use crate::renderer::options::{Error, ModelId, ModelOptions};
use crate::table::{Evaluation, ModelTables, Sharing};

/// Tells what a model has that its evaluation does not go with, or what the device lacks for it.
pub(crate) fn check_evaluation(
    id: ModelId,
    options: &ModelOptions,
    tables: &ModelTables,
    features: Features,
) -> Result<(), Error> {
    let ModelOptions { evaluation, construction, .. } = *options;
    let missing = features.missing(evaluation.features());
    if !missing.is_empty() {
        return Err(Error::EvaluationNeeds { id, evaluation, missing });
    }
    let tables_of = |evaluation| [Evaluation::GeometryTwoPass, Evaluation::Subdivision].map(|own| evaluation == own);
    if tables_of(tables.options().evaluation) != tables_of(evaluation) {
        return Err(Error::OtherTables { id, built: tables.options().evaluation, evaluation });
    }
    let displaced = tables.sharing() == Sharing::Displacement;
    for (option, built, asked) in [
        ("displacement", displaced, options.displacement.is_some()),
        // Displacement shares normals in any case.
        ("shared_normals", tables.sharing() != Sharing::Positions, displaced || options.shared_normals),
        ("refine_on_device", tables.options().refine_on_device, options.refine_on_device),
        ("edge_factors", tables.edges().is_some(), options.edge_factors),
    ] {
        if built != asked {
            return Err(Error::OtherOption { id, option, built });
        }
    }
    if !evaluation.constructions().contains(&construction) {
        return Err(Error::NotConstructedBy { id, evaluation, construction });
    }
    if evaluation == Evaluation::Tessellation {
        return Ok(());
    }
    if tables.options().is_by_leaves() {
        return Err(Error::NotEvaluatedBy { id, evaluation, what: "patches by leaves" });
    }
    let shares = evaluation.shares(construction);
    let stencils = evaluation == Evaluation::Geometry;
    let what = match tables.sharing() {
        Sharing::Displacement if !shares && stencils => "displacement of Construction::Stencil",
        Sharing::Displacement if !shares => "displacement",
        Sharing::Normals if !shares && stencils => "shared normals of Construction::Stencil",
        Sharing::Normals if !shares => "shared normals",
        _ if evaluation != Evaluation::Subdivision && options.spacing != Spacing::Equal => "fractional spacing",
        _ if evaluation == Evaluation::Subdivision && tables.edges().is_some() => "factors of edges",
        _ => return Ok(()),
    };
    Err(Error::NotEvaluatedBy { id, evaluation, what })
}
