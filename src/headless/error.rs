use crate::gpu::GpuError;

/// Why there is no device of our own, or why it failed.
#[allow(missing_docs, reason = "the messages say it")]
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HeadlessError {
    #[error("no Vulkan loader: {message}; install it (Debian and Ubuntu: apt install libvulkan1)")]
    NoLoader { message: String },
    #[error("the Vulkan loader has version {version}, and 1.3 is needed: install a newer libvulkan1")]
    OldLoader { version: String },
    #[error(
        "no Vulkan device: install a driver (Debian and Ubuntu: apt install mesa-vulkan-drivers, which draws on the CPU where there is no GPU)"
    )]
    NoDevice,
    #[error("device \"{wanted}\" (SUBDIV_DEVICE or --device): there is none of that number or name; there are {known}")]
    NoSuchDevice { wanted: String, known: String },
    #[error("no device can be used: {reasons}")]
    Unfit { reasons: String },
    #[error(
        "the layer VK_LAYER_KHRONOS_validation is missing: install it (Debian and Ubuntu: apt install vulkan-validationlayers), or unset SUBDIV_VALIDATION"
    )]
    NoValidationLayer,
    #[error("{}: {message}", path.display())]
    Picture { path: std::path::PathBuf, message: String },
    #[error(transparent)]
    Gpu(#[from] GpuError),
}
