//! Colours of a picture, from the numbers that are drawn to those in a PNG file.

/// Linear light from an sRGB value; both from 0 to 1.
pub(super) fn decode_srgb(value: f32) -> f32 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// An sRGB value from linear light; both from 0 to 1.
pub(super) fn encode_srgb(value: f32) -> f32 {
    if value <= 0.003_130_8 { value * 12.92 } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
}

/// Divides colours by opacity, as PNG wants them.
///
/// Drawing over nothing leaves colours multiplied by coverage where the samples of a pixel differ: in linear light if
/// they are stored as `srgb`.
pub(super) fn unpremultiply(rgba: &mut [u8], srgb: bool) {
    let decode = |value| if srgb { decode_srgb(value) } else { value };
    let encode = |value| if srgb { encode_srgb(value) } else { value };
    for pixel in rgba.chunks_exact_mut(4) {
        let alpha = f32::from(pixel[3]) / 255.0;
        if alpha == 0.0 || alpha == 1.0 {
            continue;
        }
        for channel in &mut pixel[..3] {
            let whole = decode(f32::from(*channel) / 255.0) / alpha;
            *channel = (255.0 * encode(whole.min(1.0))).round() as u8;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_half_covered_pixel_keeps_its_colour() {
        let colour = [200u8, 100, 30];
        let half = colour.map(|c| (255.0 * encode_srgb(decode_srgb(f32::from(c) / 255.0) / 2.0)).round() as u8);
        let mut pixels = [half[0], half[1], half[2], 128, 7, 8, 9, 255, 0, 0, 0, 0];
        unpremultiply(&mut pixels, true);
        for (got, want) in pixels.iter().zip(colour) {
            assert!(got.abs_diff(want) <= 2, "{pixels:?}");
        }
        assert_eq!(pixels[3..], [128, 7, 8, 9, 255, 0, 0, 0, 0]);
        let mut pixel = [50, 100, 20, 128];
        unpremultiply(&mut pixel, false);
        assert_eq!(pixel, [100, 199, 40, 128]);
    }
}
