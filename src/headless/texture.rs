//! Images for shaders to read, such as displacement maps.

use super::Headless;
#[cfg(feature = "png")]
use super::HeadlessError;
use crate::gpu::{Buffer, BufferDesc, GpuError, Image, ImageDesc, MemoryLocation, Owned, VkResultExt};
use ash::vk;

/// Bytes of a texel of four 32-bit channels.
#[cfg(feature = "png")]
const BYTES_A_TEXEL: u64 = 16;

/// Checks the texels of a picture.
///
/// # Errors
/// Reason, in words.
#[cfg(feature = "png")]
pub(super) fn check_size([width, height]: [u64; 2], max: u64) -> Result<(), String> {
    match width.checked_mul(height).is_some_and(|texels| texels <= max) {
        true => Ok(()),
        false => Err(format!(
            "it has {width} x {height} texels: at most {max} are read; make it smaller, or raise the limit"
        )),
    }
}

/// Texels: rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Texels {
    /// Texels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Numbers a texel: 1 for heights, 4 for vectors, whose last one is not looked at.
    pub channels: u32,
    /// Row by row.
    pub values: Vec<f32>,
}

impl Texels {
    /// The first channel between texels, as a sampler reads it: linear, and repeated beyond the edges.
    pub fn sample(&self, [u, v]: [f32; 2]) -> f32 {
        let along = |t: f32, count: u32| {
            let at = (t - t.floor()) * count as f32 - 0.5;
            let first = at.floor();
            let wrap = |i: f32| i.rem_euclid(count as f32) as usize;
            (wrap(first), wrap(first + 1.0), at - first)
        };
        let ((x0, x1, s), (y0, y1, t)) = (along(u, self.width), along(v, self.height));
        let texel = |x: usize, y: usize| self.values[(y * self.width as usize + x) * self.channels as usize];
        let row = |y: usize| (1.0 - s) * texel(x0, y) + s * texel(x1, y);
        (1.0 - t) * row(y0) + t * row(y1)
    }

    /// Texels that a picture has at most, unless more are asked for: 16384 x 16384.
    pub const MAX: u64 = 1 << 28;

    /// Reads a picture of up to [`Texels::MAX`] texels: heights (its red channel; of an EXR file without colours Y, Z, or whichever is the only one) or vectors.
    /// Integers become numbers from 0 to 1; EXR files (feature `exr`) are read as they are.
    ///
    /// # Errors
    /// [`HeadlessError::Picture`].
    #[cfg(feature = "png")]
    pub fn open(path: impl AsRef<std::path::Path>, vectors: bool) -> Result<Self, HeadlessError> {
        Self::open_up_to(path, vectors, Self::MAX)
    }

    /// The same with another limit of texels.
    ///
    /// # Errors
    /// [`HeadlessError::Picture`].
    #[cfg(feature = "png")]
    pub fn open_up_to(path: impl AsRef<std::path::Path>, vectors: bool, max: u64) -> Result<Self, HeadlessError> {
        let path = path.as_ref();
        let read = std::fs::read(path).map_err(|error| error.to_string());
        let texels = read.and_then(|bytes| Self::decode_up_to(&bytes, vectors, max));
        texels.map_err(|message| HeadlessError::Picture { path: path.to_owned(), message })
    }

    /// The same from the contents of a file.
    ///
    /// # Errors
    /// Reason, in words.
    #[cfg(feature = "png")]
    pub fn decode(bytes: &[u8], vectors: bool) -> Result<Self, String> {
        Self::decode_up_to(bytes, vectors, Self::MAX)
    }

    /// The same with another limit of texels, which is checked before memory is taken for them.
    ///
    /// # Errors
    /// Reason, in words.
    #[cfg(feature = "png")]
    pub fn decode_up_to(bytes: &[u8], vectors: bool, max: u64) -> Result<Self, String> {
        use image::{DynamicImage, ImageDecoder, ImageReader, Limits};
        #[cfg(feature = "exr")]
        if let Some(texels) = super::exr::heights(bytes, vectors, max)? {
            return texels.checked();
        }
        let mut reader =
            ImageReader::new(std::io::Cursor::new(bytes)).with_guessed_format().map_err(|e| e.to_string())?;
        // What a texel takes in the largest format, and some for the decoder.
        let mut limits = Limits::default();
        limits.max_alloc = Some(max.saturating_mul(BYTES_A_TEXEL).saturating_add(1 << 20));
        reader.limits(limits);
        let decoder = reader.into_decoder().map_err(|e| e.to_string())?;
        let (width, height) = decoder.dimensions();
        check_size([width, height].map(u64::from), max)?;
        Self::of_picture(&DynamicImage::from_decoder(decoder).map_err(|e| e.to_string())?, vectors).checked()
    }

    #[cfg(feature = "png")]
    fn checked(self) -> Result<Self, String> {
        let is_finite = self.values.iter().all(|x| x.is_finite());
        if is_finite { Ok(self) } else { Err("it has values that are no finite numbers".into()) }
    }

    #[cfg(feature = "png")]
    fn of_picture(picture: &image::DynamicImage, vectors: bool) -> Self {
        let (width, height) = (picture.width(), picture.height());
        let channels = if vectors { 4 } else { 1 };
        let mut values = Vec::with_capacity(width as usize * height as usize * channels);
        // By rows: as four floats a texel the picture would take much more memory than it does.
        for row in 0..height {
            let texels = picture.crop_imm(0, row, width, 1).into_rgba32f().into_raw();
            values.extend(texels.chunks_exact(4).flat_map(|texel| &texel[..channels]));
        }
        Self { width, height, channels: channels as u32, values }
    }

    /// The least and the largest value of what is looked at.
    pub fn range(&self) -> [f32; 2] {
        let used = self.channels.min(3) as usize;
        let values = self.values.chunks_exact(self.channels.max(1) as usize).flat_map(|texel| &texel[..used]);
        values.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], &x| [low.min(x), high.max(x)])
    }

    /// The same this many times side by side, and that many rows of it.
    pub fn tiled(&self, times: u32) -> Self {
        let row = (self.width * self.channels) as usize;
        let rows = self.values.chunks_exact(row.max(1)).flat_map(|row| row.repeat(times as usize));
        let values = rows.collect::<Vec<_>>().repeat(times as usize);
        Self { width: self.width * times, height: self.height * times, channels: self.channels, values }
    }

    /// Half as wide and high, each texel the mean of those it covers.
    fn halved(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let channels = self.channels as usize;
        // Which texels of `of` a texel of `count` covers.
        let covered = |i: u32, count: u32, of: u32| {
            let (first, end) = (u64::from(i) * u64::from(of), u64::from(i + 1) * u64::from(of));
            (first / u64::from(count)) as usize..end.div_ceil(u64::from(count)) as usize
        };
        let mut values = Vec::with_capacity(width as usize * height as usize * channels);
        for y in 0..height {
            for x in 0..width {
                let (rows, columns) = (covered(y, height, self.height), covered(x, width, self.width));
                let count = (rows.len() * columns.len()) as f32;
                for channel in 0..channels {
                    let at = |(row, column): (usize, usize)| {
                        self.values[(row * self.width as usize + column) * channels + channel]
                    };
                    let texels = rows.clone().flat_map(|row| columns.clone().map(move |column| (row, column)));
                    values.push(texels.map(at).sum::<f32>() / count);
                }
            }
        }
        Self { width, height, channels: self.channels, values }
    }
}

/// Texels on the device with all their mip levels, and a trilinear sampler that repeats.
#[derive(Debug)]
pub struct Texture {
    image: Image,
    sampler: Owned<vk::Sampler>,
    channels: u32,
    range: [f32; 2],
}

impl Texture {
    /// Makes the levels and copies them to the device.
    ///
    /// # Errors
    /// No memory, sizes the device does not have, other numbers of values, a device that does not filter 32-bit numbers.
    pub fn new(headless: &Headless, name: &str, texels: &Texels) -> Result<Self, GpuError> {
        let unsupported = |why: String| GpuError::Unsupported { object: name.to_owned(), why };
        let format = match texels.channels {
            1 => vk::Format::R32_SFLOAT,
            4 => vk::Format::R32G32B32A32_SFLOAT,
            other => return Err(unsupported(format!("{other} numbers a texel: 1 or 4 are possible"))),
        };
        let (width, height, max) = (texels.width, texels.height, headless.properties().max_image_size);
        if width == 0 || height == 0 || width > max || height > max {
            return Err(unsupported(format!("{width} x {height} texels: the device has images of 1 to {max} a side")));
        }
        let (given, needed) =
            (texels.values.len() as u64, u64::from(width) * u64::from(height) * u64::from(texels.channels));
        if given != needed {
            return Err(unsupported(format!("{given} values are given, but its texels have {needed}")));
        }
        // SAFETY: the physical device is of the instance.
        let known =
            unsafe { headless.instance().get_physical_device_format_properties(headless.physical_device(), format) };
        if !can_be_filtered(known) {
            return Err(unfiltered(name, &headless.properties().name, format));
        }
        let mut levels = vec![texels.clone()];
        while let Some(last) = levels.last().filter(|level| level.width.max(level.height) > 1) {
            levels.push(last.halved());
        }
        let context = headless.context();
        let extent = vk::Extent2D { width: texels.width, height: texels.height };
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let desc = ImageDesc { mip_levels: levels.len() as u32, ..ImageDesc::new(name, extent, format, usage) };
        let image = Image::new(context, &desc)?;
        upload(headless, &image, &levels)?;
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(vk::Filter::LINEAR)
            .min_filter(vk::Filter::LINEAR)
            .mipmap_mode(vk::SamplerMipmapMode::LINEAR)
            .max_lod(vk::LOD_CLAMP_NONE);
        // SAFETY: the description is valid, and the sampler is taken over by `Owned`.
        let sampler = unsafe {
            let raw = context.device().create_sampler(&info, None).of("vkCreateSampler", name)?;
            Owned::new(context, raw, name)
        };
        Ok(Self { image, sampler, channels: texels.channels, range: texels.range() })
    }

    /// The image with all its levels, in the layout `SHADER_READ_ONLY_OPTIMAL`.
    pub fn view(&self) -> vk::ImageView {
        self.image.view()
    }

    /// The sampler.
    pub fn sampler(&self) -> vk::Sampler {
        self.sampler.raw()
    }

    /// Numbers a texel: 1 or 4.
    pub fn channels(&self) -> u32 {
        self.channels
    }

    /// The least and the largest value of what is looked at.
    pub fn range(&self) -> [f32; 2] {
        self.range
    }
}

/// Copies all levels, and leaves the image as shaders read it.
fn upload(headless: &Headless, image: &Image, levels: &[Texels]) -> Result<(), GpuError> {
    use vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};
    let texels: Vec<f32> = levels.iter().flat_map(|level| &level.values).copied().collect();
    let mut staged = Buffer::new(
        headless.context(),
        &BufferDesc {
            name: "texels to copy",
            size: size_of_val(texels.as_slice()) as u64,
            usage: vk::BufferUsageFlags::TRANSFER_SRC,
            location: MemoryLocation::Upload,
        },
    )?;
    staged.write(0, &texels)?;
    let mut offset = 0;
    let regions: Vec<_> = levels
        .iter()
        .zip(0..)
        .map(|(level, mip)| {
            let layers = vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                mip_level: mip,
                base_array_layer: 0,
                layer_count: 1,
            };
            let region = vk::BufferImageCopy::default()
                .buffer_offset(offset)
                .image_subresource(layers)
                .image_extent(vk::Extent3D { width: level.width, height: level.height, depth: 1 });
            offset += 4 * level.values.len() as u64;
            region
        })
        .collect();
    let before = [image
        .barrier(Layout::UNDEFINED, Layout::TRANSFER_DST_OPTIMAL)
        .dst_stage_mask(Stage::COPY)
        .dst_access_mask(Access::TRANSFER_WRITE)];
    let after = [image
        .barrier(Layout::TRANSFER_DST_OPTIMAL, Layout::SHADER_READ_ONLY_OPTIMAL)
        .src_stage_mask(Stage::COPY)
        .src_access_mask(Access::TRANSFER_WRITE)
        .dst_stage_mask(Stage::ALL_GRAPHICS)
        .dst_access_mask(Access::SHADER_SAMPLED_READ)];
    // SAFETY: the command buffer is being recorded, the image is new, and the buffer holds all levels.
    headless.submit(|cmd| unsafe {
        let device = headless.device();
        device.cmd_pipeline_barrier2(cmd, &vk::DependencyInfo::default().image_memory_barriers(&before));
        device.cmd_copy_buffer_to_image(cmd, staged.raw(), image.raw(), Layout::TRANSFER_DST_OPTIMAL, &regions);
        device.cmd_pipeline_barrier2(cmd, &vk::DependencyInfo::default().image_memory_barriers(&after));
    })
}

/// Whether a texture can be made of images with these properties.
fn can_be_filtered(known: vk::FormatProperties) -> bool {
    let needed = vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR | vk::FormatFeatureFlags::TRANSFER_DST;
    known.optimal_tiling_features.contains(needed)
}

fn unfiltered(name: &str, device: &str, format: vk::Format) -> GpuError {
    GpuError::Unsupported { object: name.to_owned(), why: format!("{device} does not filter images of {format:?}") }
}

#[cfg(all(test, feature = "exr"))]
mod tests {
    use super::*;
    use image::{DynamicImage, ImageFormat};
    use std::io::Cursor;

    fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    /// A PNG file of which there is no more than the header.
    fn header(width: u32, height: u32) -> Vec<u8> {
        let (mut bytes, mut crc) = (b"\x89PNG\r\n\x1a\n\0\0\0\x0d".to_vec(), u32::MAX);
        let chunk = [b"IHDR".as_slice(), &width.to_be_bytes(), &height.to_be_bytes(), &[8, 0, 0, 0, 0]].concat();
        for byte in &chunk {
            crc ^= u32::from(*byte);
            (0..8).for_each(|_| crc = if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 });
        }
        bytes.extend(chunk);
        bytes.extend((!crc).to_be_bytes());
        // The beginning of the data, for whoever wants to see it before believing the size.
        bytes.extend(b"\0\0\0\x01IDAT\x78");
        bytes
    }

    #[test]
    fn pictures_beyond_the_limit_are_refused_by_their_header() {
        let expected = "it has 100000 x 100000 texels: at most 268435456 are read; make it smaller, or raise the limit";
        for vectors in [false, true] {
            assert_eq!(Texels::decode(&header(100_000, 100_000), vectors).unwrap_err(), expected);
            let error = Texels::decode(&header(u32::MAX, u32::MAX), vectors).unwrap_err();
            assert!(error.len() < 300, "{error}");
        }
        let mut png = std::io::Cursor::new(Vec::new());
        image::GrayImage::from_raw(3, 2, vec![0; 6]).unwrap().write_to(&mut png, ImageFormat::Png).unwrap();
        assert!(Texels::decode_up_to(png.get_ref(), false, 6).is_ok());
        let error = Texels::decode_up_to(png.get_ref(), false, 5).unwrap_err();
        assert_eq!(error, "it has 3 x 2 texels: at most 5 are read; make it smaller, or raise the limit");
    }

    #[test]
    fn pictures_of_8_16_and_32_bits_are_read() {
        let heights = |bytes: &[u8]| Texels::decode(bytes, false).unwrap();
        let eight = image::GrayImage::from_raw(2, 1, vec![0, 51]).unwrap();
        let eight = heights(&encoded(&eight.into(), ImageFormat::Png));
        assert!(eight.values[0] == 0.0 && (eight.values[1] - 0.2).abs() < 1e-6, "{eight:?}");
        let sixteen: image::ImageBuffer<image::Luma<u16>, _> =
            image::ImageBuffer::from_raw(2, 1, vec![1, 65535]).unwrap();
        let sixteen = heights(&encoded(&sixteen.into(), ImageFormat::Png));
        assert!((sixteen.values[0] - 1.0 / 65535.0).abs() < 1e-9 && sixteen.values[1] == 1.0, "{sixteen:?}");
        let values = vec![-2.5, 0.125, 7.0, 1.0, 3.0, 1e-3, 0.0, 1.0];
        let float = image::Rgba32FImage::from_raw(2, 1, values.clone()).unwrap();
        let bytes = encoded(&float.into(), ImageFormat::OpenExr);
        assert_eq!(heights(&bytes).values, [-2.5, 3.0]);
        assert_eq!(heights(&bytes).range(), [-2.5, 3.0]);
        let vectors = Texels::decode(&bytes, true).unwrap();
        assert_eq!((vectors.channels, &vectors.values), (4, &values));
        assert_eq!(vectors.range(), [-2.5, 7.0]);
        assert!(Texels::decode(b"no picture", false).is_err());
    }

    #[test]
    fn texels_are_read_in_between_and_repeat() {
        let texels = Texels { width: 2, height: 2, channels: 1, values: vec![0.0, 1.0, 4.0, 5.0] };
        for (at, value) in [([0.25, 0.25], 0.0), ([0.75, 0.25], 1.0), ([0.25, 0.75], 4.0), ([0.5, 0.5], 2.5)] {
            assert_eq!(texels.sample(at), value, "{at:?}");
            assert_eq!(texels.sample([at[0] + 1.0, at[1] - 2.0]), value, "{at:?}");
        }
        // Between the last texel and the first.
        assert_eq!(texels.sample([0.0, 0.25]), 0.5);
    }

    #[test]
    fn what_cannot_be_a_map_is_told() {
        let float = image::Rgba32FImage::from_raw(1, 2, vec![0.0, 1.0, 2.0, 1.0, f32::NAN, 1.0, 2.0, 1.0]).unwrap();
        let bytes = encoded(&float.into(), ImageFormat::OpenExr);
        for vectors in [false, true] {
            let error = Texels::decode(&bytes, vectors).unwrap_err();
            assert_eq!(error, "it has values that are no finite numbers");
        }
        use vk::FormatFeatureFlags as Can;
        let with = |optimal_tiling_features| vk::FormatProperties { optimal_tiling_features, ..Default::default() };
        assert!(can_be_filtered(with(Can::SAMPLED_IMAGE | Can::SAMPLED_IMAGE_FILTER_LINEAR | Can::TRANSFER_DST)));
        assert!(!can_be_filtered(with(Can::SAMPLED_IMAGE | Can::TRANSFER_DST)));
        let error = unfiltered("a map", "a device", vk::Format::R32_SFLOAT).to_string();
        assert_eq!(error, "a map: a device does not filter images of R32_SFLOAT");
    }

    #[test]
    fn levels_are_means() {
        let texels = Texels { width: 3, height: 2, channels: 1, values: vec![1.0, 2.0, 3.0, 5.0, 6.0, 7.0] };
        let half = texels.halved();
        assert_eq!((half.width, half.height, half.values.as_slice()), (1, 1, &[4.0][..]));
        let tiled = texels.tiled(2);
        assert_eq!((tiled.width, tiled.height), (6, 4));
        assert_eq!(tiled.values[..6], [1.0, 2.0, 3.0, 1.0, 2.0, 3.0]);
        assert_eq!(tiled.values[18..], [5.0, 6.0, 7.0, 5.0, 6.0, 7.0]);
    }
}
