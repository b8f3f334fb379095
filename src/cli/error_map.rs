//! The error of a surface, as what is painted on it.

use super::error::CliError;
use super::legend::{self, COLOURS};
use ash::vk;
use ash_subdiv::gpu::{
    Buffer, BufferDesc, DescriptorPool, DescriptorSet, DeviceContext, MemoryLocation, SetLayout, descriptor_set_layout,
};
use ash_subdiv::headless::Headless;
use ash_subdiv::measure::{Quantity, error_field};
use ash_subdiv::mesh::{FaceVarying, MeshData};
use ash_subdiv::table::{CpuSurface, grid_parameters};
use ash_subdiv::{ControlMesh, MeshError, Renderer};
use std::sync::Arc;

/// Samples of the error over all patches, about: a second's work.
const SAMPLES: f64 = 1.5e6;

/// This part of all samples is below the top of the scale, if not told otherwise.
const BELOW_TOP: f64 = 0.99;

/// Errors on a square tile for each patch, and the mesh whose texture coordinates say where in which tile.
pub(super) struct ErrorMap {
    /// The mesh that the patches are of.
    pub mesh: ControlMesh,
    /// The error that has the last colour: of positions over the diagonal, of normals in radians.
    pub top: f64,
    /// The largest there is.
    pub largest: f64,
    side: u32,
    columns: u32,
    values: Vec<f32>,
}

impl ErrorMap {
    /// Measures the patches of `surface`. Distances are over `diagonal`.
    pub(super) fn new(
        surface: &CpuSurface,
        quantity: Quantity,
        diagonal: f64,
        top: Option<f32>,
    ) -> Result<Self, MeshError> {
        let patches = surface.plan().patches();
        let count = patches.len().max(1);
        let side = ((SAMPLES / count as f64).sqrt() as u32).clamp(5, 33);
        let field = error_field(surface, quantity, side)?;
        // A mesh without extent is one point.
        let unit = if quantity == Quantity::Position && diagonal > 0.0 { diagonal } else { 1.0 };
        let columns = (count as f64).sqrt().ceil() as u32;
        let tile = (side * side) as usize;
        let mut values = vec![0.0; tile * count];
        let mesh = surface.prepared().mesh();
        let mut places = vec![[0.0; 2]; mesh.corner_count()];
        for ((number, patch), errors) in patches.iter().enumerate().zip(&field) {
            let corners = mesh.face_corners(patch.face);
            let tiles = &mut values[number * tile..][..tile];
            for (&[u, v], error) in grid_parameters(patch.kind, side).iter().zip(errors) {
                // In a triangle the second and the third barycentric coordinate are x and y.
                let at = if corners.len() == 3 { [v, 1.0 - u - v] } else { [u, v] };
                let [x, y] = at.map(|x| (x * f64::from(side - 1)).round() as usize);
                tiles[y * side as usize + x] = (error / unit) as f32;
            }
            let ends: &[[f32; 2]] = match corners.len() {
                3 => &[[0.25, 0.25], [0.75, 0.25], [0.25, 0.75]],
                _ => &[[0.25, 0.25], [0.75, 0.25], [0.75, 0.75], [0.25, 0.75]],
            };
            let origin = [number as u32 % columns, number as u32 / columns].map(|x| x as f32);
            for (corner, end) in corners.zip(ends) {
                places[corner] = [origin[0] + end[0], origin[1] + end[1]];
            }
        }
        let mut all: Vec<f64> = field.concat().iter().map(|error| error / unit).collect();
        let largest = all.iter().copied().fold(0.0, f64::max);
        let top = top.map_or_else(|| scale_for(&mut all, quantity), f64::from);
        let texcoords = FaceVarying { indices: (0..places.len() as u32).collect(), values: places };
        let mesh = ControlMesh::new(MeshData { texcoords: Some(texcoords), ..mesh.data().clone() })?;
        Ok(Self { mesh, top, largest, side, columns, values })
    }

    /// Bytes that the shader reads.
    fn bytes(&self) -> Vec<u8> {
        let header = [self.side, self.columns, (self.top as f32).to_bits(), 0];
        let colours: Vec<[f32; 4]> = (0..COLOURS).map(|number| legend::colour(number).linear()).collect();
        [bytemuck::cast_slice(&header), bytemuck::cast_slice(&colours), bytemuck::cast_slice(&self.values)].concat()
    }
}

/// A round number that most errors are below; not so small that rounding would be seen.
fn scale_for(errors: &mut [f64], quantity: Quantity) -> f64 {
    let smallest: f64 = match quantity {
        Quantity::Position => 1e-6,
        Quantity::Normal => 1e-4,
    };
    if errors.is_empty() {
        return smallest;
    }
    let place = (BELOW_TOP * (errors.len() - 1) as f64) as usize;
    let (_, &mut high, _) = errors.select_nth_unstable_by(place, f64::total_cmp);
    round_up(high.max(smallest))
}

/// The next number of two digits that is easy to halve.
fn round_up(value: f64) -> f64 {
    let exponent = value.log10().floor() as i32;
    let digits = [1.0, 1.2, 1.6, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    let ceiling = digits.into_iter().find(|&digit| digit * 10f64.powi(exponent) >= value * (1.0 - 1e-9));
    // As it is read, not as it is multiplied: 3 * 10^-4 is not 3e-4.
    format!("{}e{exponent}", ceiling.unwrap_or(10.0)).parse().unwrap_or(value)
}

/// The errors on the device, with the descriptor set that the fragment shader finds them in.
pub(super) struct ErrorSet {
    pub layout: SetLayout,
    pub set: DescriptorSet,
    _buffer: Buffer,
}

impl ErrorSet {
    pub(super) fn new(context: &Arc<DeviceContext>, map: &ErrorMap) -> Result<Self, CliError> {
        const NAME: &str = "error map";
        let bytes = map.bytes();
        let max = context.properties().max_storage_buffer_range;
        if bytes.len() as u64 > max {
            let (name, size) = (&context.properties().name, bytes.len());
            return Err(CliError::Work(format!(
                "the map of errors has {size} bytes, and a shader of {name} can see {max}: refine less"
            )));
        }
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let desc = BufferDesc { name: NAME, size: bytes.len() as u64, usage, location: MemoryLocation::Upload };
        let mut buffer = Buffer::new(context, &desc)?;
        buffer.write(0, &bytes)?;
        let ty = vk::DescriptorType::STORAGE_BUFFER;
        let layout = descriptor_set_layout(context, NAME, &[(ty, vk::ShaderStageFlags::FRAGMENT)])?;
        let pool = DescriptorPool::new(context, NAME, &[&layout]);
        // SAFETY: the layout is that of the pool, with this descriptor; the buffer goes with the set.
        let set = unsafe { DescriptorSet::of_buffers(&pool, &layout, NAME, &[buffer.descriptor()])? };
        Ok(Self { layout, set, _buffer: buffer })
    }

    /// Binds the set where the shaders look for it.
    ///
    /// # Safety
    /// `cmd` is being recorded; `renderer` has the layout; this outlives the submission.
    pub(super) unsafe fn cmd_bind(&self, headless: &Headless, cmd: vk::CommandBuffer, renderer: &Renderer) {
        let (point, layout) = (vk::PipelineBindPoint::GRAPHICS, renderer.pipeline_layout());
        let sets = [self.set.raw()];
        // SAFETY: as the caller promises.
        unsafe { headless.device().cmd_bind_descriptor_sets(cmd, point, layout, 2, &sets, &[]) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_end_at_round_numbers() {
        for (value, rounded) in [(2.4e-4, 2.4e-4), (2.41e-4, 3e-4), (0.0101, 0.012), (9.0, 10.0), (1.0, 1.0)] {
            assert_eq!(round_up(value), rounded);
        }
        let mut errors: Vec<f64> = (0..=1000).map(|i| f64::from(i) / 1000.0).collect();
        assert_eq!(scale_for(&mut errors, Quantity::Normal), 1.0);
        errors[..995].fill(0.0);
        assert_eq!(scale_for(&mut errors[..], Quantity::Position), 1e-6);
        assert_eq!(scale_for(&mut [], Quantity::Position), 1e-6);
    }
}
