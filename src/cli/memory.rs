//! The process's memory.

/// Has the process keep memory that it is likely to need again.
///
/// A driver that draws on the CPU takes and frees memory within each draw, and by default glibc gives much of it back to the system
/// each time, or does not, as it happens to lie: lavapipe then takes a tenth longer in one run than in the next, up to a third where
/// threads have memory of their own, whose parts are given back in any case.
pub(super) fn keep_freed() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        const MIB: libc::c_int = 1 << 20;
        for (setting, value) in [
            (libc::M_TRIM_THRESHOLD, 1024 * MIB),
            // The most that glibc takes.
            (libc::M_MMAP_THRESHOLD, 32 * MIB),
            (libc::M_TOP_PAD, 16 * MIB),
            // One for all threads.
            (libc::M_ARENA_MAX, 1),
        ] {
            // SAFETY: a setting of the allocator, with a number that it takes. What it refuses stays as it was.
            unsafe { libc::mallopt(setting, value) };
        }
    }
}
