use crate::mesh::MeshError;

pub(super) fn format_error(message: impl Into<String>) -> MeshError {
    MeshError::Format { message: message.into() }
}
