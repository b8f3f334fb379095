//! The rules of subdivision that are asked for.

use super::error::CliError;
use super::{output, parse};
use ash_subdiv::mesh::{BoundaryRule, FaceVaryingRule, Package};
use ash_subdiv::{ControlMesh, MeshData};
use clap::Args;

/// Instead of those of the file.
#[derive(Debug, Args)]
pub(super) struct RulesArgs {
    /// Rules for boundaries and texture coordinates as this package has them if nobody chooses others.
    #[arg(long, value_name = "PACKAGE", help_heading = "Rules of subdivision", value_parser = parse::one_of(Package::ALL, Package::name))]
    rules: Option<Package>,
    /// What open boundaries do: nothing, so that faces there are not drawn, end in smooth curves, or end in curves with sharp corners.
    #[arg(long, value_name = "RULE", help_heading = "Rules of subdivision", value_parser = parse::one_of(BoundaryRule::ALL, BoundaryRule::name))]
    boundary: Option<BoundaryRule>,
    /// Where texture coordinates are linear: nowhere, at corners, also where three regions meet, also at darts and concave corners,
    /// along all seams and boundaries, or everywhere.
    #[arg(long, value_name = "RULE", help_heading = "Rules of subdivision", value_parser = parse::one_of(FaceVaryingRule::ALL, FaceVaryingRule::name))]
    uv: Option<FaceVaryingRule>,
}

impl RulesArgs {
    /// The mesh with these rules: those that are named, else those of the package, else its own. Notes where a file has chosen others.
    pub(super) fn apply(&self, mesh: ControlMesh) -> Result<ControlMesh, CliError> {
        let boundary = self.boundary.or_else(|| self.rules.and_then(Package::boundary));
        let uv = self.uv.or_else(|| self.rules.map(Package::face_varying));
        let data = mesh.data();
        let (own_boundary, own_uv) = (data.boundary, data.face_varying_rule);
        let (boundary, uv) = (boundary.unwrap_or(own_boundary), uv.unwrap_or(own_uv));
        if (boundary, uv) == (own_boundary, own_uv) {
            return Ok(mesh);
        }
        // Without a tag a mesh has the usual rules.
        if boundary != own_boundary && own_boundary != BoundaryRule::default() {
            output::note(format!(
                "boundary rule {} takes the place of the file's {}",
                boundary.name(),
                own_boundary.name()
            ));
        }
        if uv != own_uv && own_uv != FaceVaryingRule::default() {
            output::note(format!(
                "texture coordinate rule {} takes the place of the file's {}",
                uv.name(),
                own_uv.name()
            ));
        }
        Ok(ControlMesh::new(MeshData { boundary, face_varying_rule: uv, ..mesh.into_data() })?)
    }
}
