//! The tables of a model on the GPU: all in one buffer.

use crate::constants::FACE_WORDS;
use crate::gpu::{Buffer, DeviceContext, MAX_OFFSET_ALIGNMENT};
use crate::renderer::options::{Error, ModelId};
use crate::renderer::shader::TABLE_TEXELS;
use crate::table::Evaluation;
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use std::sync::Arc;

/// Tables of a model.
const TABLES: usize = 17;
/// The table of refined faces among them.
const FACES: usize = TABLES - 1;

/// The word where each table starts: a uniform block. GLSL twin: `glsl/lib/draw/tables.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct TableStarts([u32; TABLES]);

/// Tables one after the other, and where each is.
pub(crate) struct Tables {
    pub buffer: Buffer,
    /// Bytes of the buffer that shaders see as a storage buffer, from its start on.
    pub storage: u64,
    /// In the buffer, each table that shaders see as a texel buffer.
    pub texels: [Range<u64>; TABLE_TEXELS.len()],
    /// In the buffer, [`TableStarts`].
    pub starts: Range<u64>,
}

impl Tables {
    /// Room for some tables in the order of [`ModelTables::bindings`](crate::table::ModelTables::bindings), and the staging buffer
    /// with what is to be copied there. `first_refined` is the first patch of a refined face.
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        (id, name): (ModelId, &str),
        evaluation: Evaluation,
        arrays: &[(&'static str, &[u8]); TABLES],
        first_refined: u32,
    ) -> Result<(Self, Buffer), Error> {
        let properties = context.properties();
        // Fans are read as storage buffers only.
        let reads_texels = properties.reads_texels && evaluation != Evaluation::Subdivision;
        let mut end = 0;
        let mut ranges = [const { 0..0 }; TABLES];
        let mut storage = 0;
        // Those that can be texel buffers come last: if they are, no shader sees them as storage buffers.
        for table in (TABLE_TEXELS.len()..TABLES).chain(0..TABLE_TEXELS.len()) {
            let (what, array) = arrays[table];
            // An empty table has a texel, for its view to be of something.
            let range = end..end + (array.len() as u64).max(16);
            end = range.end.next_multiple_of(MAX_OFFSET_ALIGNMENT);
            let (what, bytes, max) = match TABLE_TEXELS.get(table) {
                Some((_, texel)) if reads_texels => {
                    (what, array.len() as u64, properties.max_texel_buffer_elements * texel)
                }
                _ => {
                    storage = range.end;
                    // One descriptor shows them all.
                    ("tables read as storage buffers", range.end, properties.max_storage_buffer_range)
                }
            };
            if bytes > max {
                return Err(Error::TableTooLarge { id, table: what, bytes, max });
            }
            ranges[table] = range;
        }
        let mut starts = TableStarts(ranges.each_ref().map(|range| (range.start / 4) as u32));
        // As if all patches were refined.
        starts.0[FACES] = starts.0[FACES].wrapping_sub(FACE_WORDS * first_refined);
        let starts_range = end..end + size_of::<TableStarts>() as u64;

        let mut staged = Buffer::upload(context, &format!("{name}: tables to copy"), starts_range.end)?;
        for ((_, array), range) in arrays.iter().zip(&ranges) {
            staged.write(range.start, array)?;
        }
        staged.write(starts_range.start, &[starts])?;
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::UNIFORM_TEXEL_BUFFER | Usage::UNIFORM_BUFFER;
        let buffer = Buffer::device_local(context, &format!("{name}: tables"), starts_range.end, usage)?;
        let texels = std::array::from_fn(|table| ranges[table].clone());
        Ok((Self { buffer, storage, texels, starts: starts_range }, staged))
    }
}
