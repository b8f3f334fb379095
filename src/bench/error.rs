use crate::gpu::GpuError;
use crate::mesh::MeshError;
use crate::renderer::Error;
use crate::table::TableError;

/// Why nothing could be measured.
#[allow(missing_docs, reason = "the messages say it")]
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BenchError {
    #[error(transparent)]
    Renderer(#[from] Error),
    #[error("{mesh}: it has no {subset} patches: choose others")]
    NoPatches { mesh: String, subset: &'static str },
    #[error(
        "the path {path} is not recorded by the renderer alone: measure one that is, such as tessellation or compute"
    )]
    NotRecorded { path: &'static str },
    #[error("{what} is {given}: it must be at least {least}")]
    BadOption { what: &'static str, given: u32, least: u32 },
}

impl From<GpuError> for BenchError {
    fn from(error: GpuError) -> Self {
        Self::Renderer(error.into())
    }
}

impl From<TableError> for BenchError {
    fn from(error: TableError) -> Self {
        Self::Renderer(error.into())
    }
}

impl From<MeshError> for BenchError {
    fn from(error: MeshError) -> Self {
        Self::Renderer(error.into())
    }
}

impl BenchError {
    /// Whether it is only one contestant that cannot do it: it has no patches for the mesh, or takes what the device has
    /// not.
    pub fn leaves_out(&self) -> bool {
        use GpuError as Gpu;
        let Self::Renderer(error) = self else { return false };
        match error {
            Error::Table(TableError::Undefined(_))
            | Error::TableTooLarge { .. }
            | Error::NotEvaluatedBy { .. }
            | Error::NoSuchLevel { .. }
            | Error::EvaluationNeeds { .. } => true,
            Error::Gpu(error) => {
                matches!(error, Gpu::Unsupported { .. } | Gpu::Allocation { .. } | Gpu::OutOfMemory { .. })
            }
            _ => false,
        }
    }
}
