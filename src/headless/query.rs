//! Timestamps and pipeline statistics.

use std::sync::Arc;
use std::time::{Duration, Instant};

use ash::vk;

use super::Headless;
use crate::gpu::{DeviceContext, GpuError, Owned, VkResultExt};

/// Invocations of the shader stages. Counts of stages that the device cannot count are 0.
///
/// lavapipe counts tessellation evaluations exactly, and fragments too often.
#[allow(missing_docs, reason = "named as in Vulkan")]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct Statistics {
    pub input_vertices: u64,
    pub input_primitives: u64,
    pub vertex_invocations: u64,
    pub geometry_invocations: u64,
    pub geometry_primitives: u64,
    /// Primitives that reached clipping: what the tessellator, or the geometry shader, made.
    pub clipping_invocations: u64,
    /// Primitives that clipping left.
    pub clipping_primitives: u64,
    pub fragment_invocations: u64,
    /// Patches that reached the tessellation control stage.
    pub control_patches: u64,
    pub evaluation_invocations: u64,
    pub compute_invocations: u64,
}

impl Statistics {
    /// From the results of a query with these flags: they come in the order of the bits, without gaps.
    fn from_results(flags: vk::QueryPipelineStatisticFlags, results: &[u64]) -> Self {
        let mut results = results.iter().copied();
        let mut next = |bit: u32| match flags.as_raw() & (1 << bit) {
            0 => 0,
            _ => results.next().unwrap_or(0),
        };
        Self {
            input_vertices: next(0),
            input_primitives: next(1),
            vertex_invocations: next(2),
            geometry_invocations: next(3),
            geometry_primitives: next(4),
            clipping_invocations: next(5),
            clipping_primitives: next(6),
            fragment_invocations: next(7),
            control_patches: next(8),
            evaluation_invocations: next(9),
            compute_invocations: next(10),
        }
    }
}

/// A query that counts shader invocations.
pub struct StatisticsQuery {
    flags: vk::QueryPipelineStatisticFlags,
    pool: Owned<vk::QueryPool>,
    context: Arc<DeviceContext>,
}

impl StatisticsQuery {
    /// Makes the query.
    ///
    /// # Errors
    /// The device has no `pipelineStatisticsQuery`; failed Vulkan calls.
    pub fn new(headless: &Headless) -> Result<Self, GpuError> {
        let context = headless.context();
        if !context.features().statistics {
            let why = "pipelineStatisticsQuery is not enabled on the device".to_owned();
            return Err(GpuError::Unsupported { object: "statistics".into(), why });
        }
        let mut flags = vk::QueryPipelineStatisticFlags::from_raw((1 << 11) - 1);
        if !context.features().geometry {
            flags &= !(vk::QueryPipelineStatisticFlags::GEOMETRY_SHADER_INVOCATIONS
                | vk::QueryPipelineStatisticFlags::GEOMETRY_SHADER_PRIMITIVES);
        }
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::PIPELINE_STATISTICS)
            .query_count(1)
            .pipeline_statistics(flags);
        Ok(Self { flags, pool: query_pool(context, &info, "statistics")?, context: context.clone() })
    }

    /// Counts from here on.
    ///
    /// # Safety
    ///
    /// `cmd` is being recorded, outside rendering.
    pub unsafe fn cmd_begin(&self, cmd: vk::CommandBuffer) {
        // SAFETY: as the caller promises.
        unsafe {
            self.context.device().cmd_reset_query_pool(cmd, self.pool.raw(), 0, 1);
            self.context.device().cmd_begin_query(cmd, self.pool.raw(), 0, vk::QueryControlFlags::empty());
        }
    }

    /// Counts up to here.
    ///
    /// # Safety
    ///
    /// `cmd` is being recorded, outside rendering, and the query was begun in it.
    pub unsafe fn cmd_end(&self, cmd: vk::CommandBuffer) {
        // SAFETY: as the caller promises.
        unsafe { self.context.device().cmd_end_query(cmd, self.pool.raw(), 0) };
    }

    /// Waits for the counts; the commands must have been submitted.
    pub fn read(&self) -> Result<Statistics, GpuError> {
        let mut results = [[0_u64; 11]; 1];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: there is room for all results.
        unsafe { self.context.device().get_query_pool_results(self.pool.raw(), 0, &mut results, flags) }
            .of("vkGetQueryPoolResults", "statistics")?;
        Ok(Statistics::from_results(self.flags, &results[0]))
    }
}

/// Points in time on the device. lavapipe's are sound at the boundaries of render passes, and not within one.
pub struct Timestamps {
    count: u32,
    /// Bits of a timestamp that the queue writes; it starts anew where they end.
    mask: u64,
    pool: Owned<vk::QueryPool>,
    context: Arc<DeviceContext>,
}

impl Timestamps {
    /// Room for `count` points in time.
    ///
    /// # Errors
    /// The queue writes no timestamps; failed Vulkan calls.
    pub fn new(headless: &Headless, count: u32) -> Result<Self, GpuError> {
        let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(count);
        let (context, mask) = (headless.context(), timestamp_mask(headless)?);
        Ok(Self { count, mask, pool: query_pool(context, &info, "timestamps")?, context: context.clone() })
    }

    /// Forgets earlier points; before any is written.
    ///
    /// # Safety
    ///
    /// `cmd` is being recorded, outside rendering.
    pub unsafe fn cmd_reset(&self, cmd: vk::CommandBuffer) {
        // SAFETY: as the caller promises.
        unsafe { self.context.device().cmd_reset_query_pool(cmd, self.pool.raw(), 0, self.count) };
    }

    /// Writes point `index` when all commands before it are done.
    ///
    /// # Safety
    ///
    /// `cmd` is being recorded, and the points were reset since `index` was last written.
    pub unsafe fn cmd_write(&self, cmd: vk::CommandBuffer, index: u32) {
        let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
        // SAFETY: as the caller promises.
        unsafe { self.context.device().cmd_write_timestamp2(cmd, stage, self.pool.raw(), index) };
    }

    /// Waits for all points; returns the times from each to the next, a tick of the device at least. All must have been written
    /// and submitted.
    pub fn read(&self) -> Result<Vec<Duration>, GpuError> {
        let mut ticks = vec![0_u64; self.count as usize];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: there is room for all results.
        unsafe { self.context.device().get_query_pool_results(self.pool.raw(), 0, &mut ticks, flags) }
            .of("vkGetQueryPoolResults", "timestamps")?;
        let period = f64::from(self.context.properties().timestamp_period);
        let time = |pair: &[u64]| Duration::from_secs_f64(ticks_between(pair, self.mask) as f64 * period / 1e9);
        Ok(ticks.windows(2).map(time).collect())
    }
}

/// The bits of a timestamp that the queue writes.
fn timestamp_mask(headless: &Headless) -> Result<u64, GpuError> {
    let (device, family) = (headless.physical_device(), headless.queue_family() as usize);
    // SAFETY: the device is of this instance.
    let families = unsafe { headless.instance.get_physical_device_queue_family_properties(device) };
    mask_of(families.get(family).map_or(0, |family| family.timestamp_valid_bits), family)
}

fn mask_of(bits: u32, family: usize) -> Result<u64, GpuError> {
    let why = || format!("the device's queue family {family} writes no timestamps");
    u64::MAX
        .checked_shr(64 - bits.min(64))
        .ok_or_else(|| GpuError::Unsupported { object: "timestamps".into(), why: why() })
}

/// From one timestamp to the next, at least one.
fn ticks_between(pair: &[u64], mask: u64) -> u64 {
    (pair[1].wrapping_sub(pair[0]) & mask).max(1)
}

fn query_pool(
    context: &Arc<DeviceContext>,
    info: &vk::QueryPoolCreateInfo<'_>,
    name: &str,
) -> Result<Owned<vk::QueryPool>, GpuError> {
    // SAFETY: the description is valid, and the pool is taken over by `Owned`.
    unsafe {
        let raw = context.device().create_query_pool(info, None).of("vkCreateQueryPool", name)?;
        Ok(Owned::new(context, raw, name))
    }
}

/// Duration of commands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Timing {
    /// On the device, from the first command to the last.
    pub device: Duration,
    /// On the host's clock, with recording, submission and waiting.
    pub host: Duration,
}

impl Headless {
    /// Runs commands and says how long they took.
    pub fn timed<E: From<GpuError>>(
        &self,
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), E>,
    ) -> Result<Timing, E> {
        let timestamps = Timestamps::new(self, 2)?;
        let start = Instant::now();
        // SAFETY: the command buffer is being recorded, outside rendering.
        self.try_submit(|cmd| unsafe {
            timestamps.cmd_reset(cmd);
            timestamps.cmd_write(cmd, 0);
            record(cmd)?;
            timestamps.cmd_write(cmd, 1);
            Ok::<(), E>(())
        })?;
        let host = start.elapsed();
        Ok(Timing { device: timestamps.read()?[0], host })
    }

    /// Runs commands and counts what the shader stages were called for.
    pub fn counted<E: From<GpuError>>(
        &self,
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), E>,
    ) -> Result<Statistics, E> {
        let query = StatisticsQuery::new(self)?;
        // SAFETY: the command buffer is being recorded, outside rendering.
        self.try_submit(|cmd| unsafe {
            query.cmd_begin(cmd);
            record(cmd)?;
            query.cmd_end(cmd);
            Ok::<(), E>(())
        })?;
        Ok(query.read()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn timestamps_may_start_anew() {
        let of_36_bits = mask_of(36, 0).unwrap();
        assert_eq!((of_36_bits, mask_of(64, 0).unwrap()), (0xf_ffff_ffff, u64::MAX));
        let none = mask_of(0, 2).unwrap_err().to_string();
        assert_eq!(none, "timestamps: the device's queue family 2 writes no timestamps");
        assert_eq!(ticks_between(&[of_36_bits - 2, 7], of_36_bits), 10);
        assert_eq!(ticks_between(&[5, 5], of_36_bits), 1);
        assert_eq!(ticks_between(&[u64::MAX, 1 << 40], u64::MAX), (1 << 40) + 1);
    }

    #[test]
    fn results_without_geometry_stages_have_no_gaps() {
        let flags = vk::QueryPipelineStatisticFlags::from_raw(0b111_1110_0111);
        let statistics = Statistics::from_results(flags, &[1, 2, 3, 6, 7, 8, 9, 10, 11]);
        assert_eq!((statistics.geometry_invocations, statistics.geometry_primitives), (0, 0));
        assert_eq!((statistics.clipping_invocations, statistics.evaluation_invocations), (6, 10));
        assert_eq!(statistics.compute_invocations, 11);
    }
}
