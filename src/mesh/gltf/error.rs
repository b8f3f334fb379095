use crate::mesh::MeshError;
use crate::mesh::error::shortened;

pub(super) fn format_error(message: impl Into<String>) -> MeshError {
    MeshError::Format { message: shortened(message.into()) }
}
