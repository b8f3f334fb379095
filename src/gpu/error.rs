use ash::vk;

use super::AllocatorError;

/// Errors between the crate and a Vulkan device. Each error names the object it happened to.
#[allow(missing_docs, reason = "the messages say it")]
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// The device is gone: everything made from it must be dropped and made anew on a new device.
    #[error("{object}: the device was lost in {call}: drop everything made from it, and create the device again")]
    DeviceLost { call: &'static str, object: String },
    /// Memory ran out inside a Vulkan call: on the device, or on the host if `host`.
    #[error("{object}: {} memory ran out in {call}: free something, or draw less", if *host { "host" } else { "device" })]
    OutOfMemory { call: &'static str, object: String, host: bool },
    /// Any other failure of a Vulkan call.
    #[error("{object}: {call} failed: {result}")]
    Call { call: &'static str, object: String, result: vk::Result },
    /// The allocator had no memory for a buffer or an image.
    #[error("{object}: the allocator gave no memory for {size} bytes: {source}")]
    Allocation { object: String, size: u64, source: AllocatorError },
    /// Memory that the host reads or writes is not mapped.
    #[error("{object}: not mapped: only buffers for upload and readback can be {access} by the host")]
    NotMapped { object: String, access: &'static str },
    /// A range reaches past the end of a buffer.
    #[error("{object}: bytes {offset} to {} are out of range: the buffer holds {size} bytes", offset.saturating_add(*bytes))]
    OutOfBounds { object: String, offset: u64, bytes: u64, size: u64 },
    /// The device cannot do what was asked; `why` names the limit or the feature.
    #[error("{object}: {why}")]
    Unsupported { object: String, why: String },
    /// A pipeline description contradicts itself.
    #[error("{object}: {message}")]
    BadPipeline { object: String, message: String },
}

impl GpuError {
    /// Sorts the result of a Vulkan call into the error it stands for.
    pub fn from_result(result: vk::Result, call: &'static str, object: &str) -> Self {
        let object = object.to_owned();
        match result {
            vk::Result::ERROR_DEVICE_LOST => Self::DeviceLost { call, object },
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => Self::OutOfMemory { call, object, host: false },
            vk::Result::ERROR_OUT_OF_HOST_MEMORY => Self::OutOfMemory { call, object, host: true },
            result => Self::Call { call, object, result },
        }
    }
}

/// Says which Vulkan call failed, and for which object.
pub trait VkResultExt<T> {
    /// `device.create_buffer(..).of("vkCreateBuffer", name)?`
    fn of(self, call: &'static str, object: &str) -> Result<T, GpuError>;
}

impl<T> VkResultExt<T> for Result<T, vk::Result> {
    fn of(self, call: &'static str, object: &str) -> Result<T, GpuError> {
        self.map_err(|result| GpuError::from_result(result, call, object))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_object_and_the_call() {
        let text = |result| GpuError::from_result(result, "vkCreateBuffer", "positions of frog").to_string();
        assert_eq!(
            text(vk::Result::ERROR_DEVICE_LOST),
            "positions of frog: the device was lost in vkCreateBuffer: drop everything made from it, and create the device again"
        );
        assert_eq!(
            text(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY),
            "positions of frog: device memory ran out in vkCreateBuffer: free something, or draw less"
        );
        assert!(text(vk::Result::ERROR_OUT_OF_HOST_MEMORY).contains("host memory ran out"));
        assert!(text(vk::Result::ERROR_UNKNOWN).starts_with("positions of frog: vkCreateBuffer failed: "));
        let error = GpuError::OutOfBounds { object: "ring table".into(), offset: 8, bytes: 16, size: 20 };
        assert_eq!(error.to_string(), "ring table: bytes 8 to 24 are out of range: the buffer holds 20 bytes");
    }
}
