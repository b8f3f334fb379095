//! Values of options.

use ash_subdiv::mesh::{Limits, SHARPNESS_INFINITE};
use ash_subdiv::renderer::Evaluation;
use ash_subdiv::{Fallback, Scheme};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use glam::DVec3;

/// One of `all` by its name.
pub(super) fn one_of<T, const N: usize>(all: [T; N], name: fn(T) -> &'static str) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    PossibleValuesParser::new(all.map(name)).map(move |given| {
        // The parser lets none but these names through.
        all.into_iter().find(|&one| name(one) == given).unwrap_or(all[0])
    })
}

/// A limit by its name, and its count.
pub(super) fn limit(text: &str) -> Result<(&'static str, u64), String> {
    let of_names = || format!("write NAME=COUNT, with one of {}", Limits::NAMES.join(", "));
    let (name, count) = text.split_once('=').ok_or_else(of_names)?;
    let name = Limits::NAMES.into_iter().find(|known| *known == name).ok_or_else(of_names)?;
    Ok((name, count.parse().map_err(|_| format!("\"{count}\" is no count: write it like 200000000"))?))
}

/// A scheme to fall back to, by its name.
pub(super) fn fallback() -> impl TypedValueParser<Value = Fallback> {
    one_of([Fallback::Gregory], |_| Scheme::Gregory.name())
}

/// A scheme by its name, or the limit surface as [`LIMIT`].
pub(super) fn scheme_or_limit() -> impl TypedValueParser<Value = Surface> {
    let names = Scheme::ALL.map(Scheme::name).into_iter().chain([LIMIT]);
    PossibleValuesParser::new(names)
        .map(|given| Scheme::ALL.into_iter().find(|s| s.name() == given).map_or(Surface::Limit, Surface::Patches))
}

/// Surface that can be sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Surface {
    /// The patches of a scheme.
    Patches(Scheme),
    /// The limit surface itself.
    Limit,
}

/// Name of the limit surface in [`scheme_or_limit`].
pub(super) const LIMIT: &str = "limit";

/// Maker of the vertices that are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Maker {
    /// The device, out of patches.
    Device(Evaluation),
    /// The CPU, as points of the limit surface.
    Cpu,
}

impl Maker {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Device(evaluation) => evaluation.name(),
            Self::Cpu => "cpu",
        }
    }
}

/// A maker of vertices by its name.
pub(super) fn maker() -> impl TypedValueParser<Value = Maker> {
    // Subdivision has --level.
    use Evaluation::{Compute, Geometry, GeometryTwoPass, Instanced, Tessellation};
    let [a, b, c, d, e] = [Tessellation, Compute, Instanced, Geometry, GeometryTwoPass].map(Maker::Device);
    one_of([a, b, c, d, e, Maker::Cpu], Maker::name)
}

/// The largest tessellation factor that every device has.
pub(super) const MAX_FACTOR: f32 = 64.0;

/// A tessellation factor.
pub(super) fn factor(text: &str) -> Result<f32, String> {
    number(text).filter(|f| (1.0..=MAX_FACTOR).contains(f)).ok_or_else(|| "it must be a number from 1 to 64".into())
}

/// A tessellation factor, or segments per edge without the tessellation stages.
pub(super) fn segments(text: &str) -> Result<f32, String> {
    number(text).filter(|f| (1.0..=1024.0).contains(f)).ok_or_else(|| {
        "it must be a number from 1 to 64, or to 1024 without the tessellation stages (--evaluation)".into()
    })
}

/// A full angle of view, in degrees.
pub(super) fn fov(text: &str) -> Result<f32, String> {
    number(text).filter(|f| (1.0..=170.0).contains(f)).ok_or_else(|| "it must be a number from 1 to 170".into())
}

/// An angle in degrees.
pub(super) fn angle(text: &str) -> Result<f32, String> {
    number(text).ok_or_else(|| "it must be a number of degrees".into())
}

/// A count, such as 1000000 or 1e6.
pub(super) fn count(text: &str) -> Result<u64, String> {
    let whole = |x: &f64| (0.0..1e15).contains(x) && x.fract() == 0.0;
    let number = text.parse().ok().filter(whole).map(|x: f64| x as u64);
    number.ok_or_else(|| "it must be a whole number, such as 1000000 or 1e6".into())
}

/// A time.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    let time = text.parse().ok().filter(|time: &f64| time.is_finite());
    time.ok_or_else(|| "it must be a number of seconds".into())
}

/// Frames a second.
pub(super) fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate: &f64| rate.is_finite() && *rate > 0.0);
    rate.ok_or_else(|| "it must be a number above 0".into())
}

/// Frames from the first to the one before the end.
pub(super) fn frames(text: &str) -> Result<std::ops::Range<u32>, String> {
    let ends = text.split_once("..").and_then(|(first, end)| Some(first.parse().ok()?..end.parse().ok()?));
    ends.filter(|frames| !frames.is_empty())
        .ok_or_else(|| "it must be FIRST..END, such as 0..60 for frames 0 to 59".into())
}

/// Something above zero.
pub(super) fn positive(text: &str) -> Result<f32, String> {
    number(text).filter(|&f| f > 0.0).ok_or_else(|| "it must be a number above 0".into())
}

/// A part of a size within which vertices are joined.
pub(super) fn weld(text: &str) -> Result<f64, String> {
    let part = text.parse().ok().filter(|part| (0.0..=0.1).contains(part));
    part.ok_or_else(|| "it must be a part of the diagonal, from 0 to 0.1, such as 1e-6".into())
}

fn number(text: &str) -> Option<f32> {
    text.parse().ok().filter(|f: &f32| f.is_finite())
}

/// `x,y,z`.
pub(super) fn triple(text: &str) -> Result<DVec3, String> {
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|n| n.trim().parse().ok().filter(|x: &f64| x.is_finite())).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        _ => Err("it must be three numbers with commas between, such as 1,2.5,-3".into()),
    }
}

/// Sharpness of creases that are not infinitely sharp.
pub(super) fn sharpness(text: &str) -> Result<f32, String> {
    let fits = |sharpness: &f32| (0.0..SHARPNESS_INFINITE).contains(sharpness);
    let error = || format!("it must be a number from 0 to less than {SHARPNESS_INFINITE}");
    text.parse().ok().filter(fits).ok_or_else(error)
}

/// `WxH` in pixels.
pub(super) fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    sides.filter(|sides| !sides.contains(&0)).ok_or_else(|| "it must be WxH in pixels, such as 1024x768".into())
}

/// A colour as sRGB bytes; the last is opacity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Colour(pub [u8; 4]);

impl Colour {
    /// From `0xRRGGBB`.
    pub(super) const fn rgb(hex: u32) -> Self {
        let [_, r, g, b] = hex.to_be_bytes();
        Self([r, g, b, 255])
    }

    /// Whether there is nothing to be seen of it.
    pub(super) fn is_transparent(self) -> bool {
        self.0[3] == 0
    }

    /// Linear RGB and opacity, not premultiplied.
    pub(super) fn linear(self) -> [f32; 4] {
        let [r, g, b, a] = self.0;
        let [r, g, b] = [r, g, b].map(|c| super::picture::decode_srgb(f32::from(c) / 255.0));
        [r, g, b, f32::from(a) / 255.0]
    }
}

/// `R,G,B` from 0 to 255, `#rrggbb`, or `transparent`.
pub(super) fn colour(text: &str) -> Result<Colour, String> {
    let error = || "it must be R,G,B from 0 to 255, #rrggbb, or transparent".to_owned();
    if text == "transparent" {
        return Ok(Colour([0; 4]));
    }
    if let Some(digits) = text.strip_prefix('#') {
        let all_hex = digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit());
        let hex = u32::from_str_radix(digits, 16).ok().filter(|_| all_hex);
        return hex.map(Colour::rgb).ok_or_else(error);
    }
    let parts: Option<Vec<u8>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match parts.as_deref() {
        Some(&[r, g, b]) => Ok(Colour([r, g, b, 255])),
        _ => Err(error()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_or_refused() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        for bad in ["640", "0x480", "640x", "-1x3", "4x4x4", "99999999999x1", ""] {
            assert!(size(bad).is_err(), "{bad}");
        }
        assert_eq!(colour("#ff8000"), Ok(Colour([255, 128, 0, 255])));
        assert_eq!(colour("1, 2,3"), Ok(Colour([1, 2, 3, 255])));
        assert_eq!(colour("transparent"), Ok(Colour([0; 4])));
        for bad in ["#fff", "#+12345", "#ff80001", "256,0,0", "1,2", "red", "#ééé"] {
            assert!(colour(bad).is_err(), "{bad}");
        }
        assert_eq!(triple("1,-2.5, 3e1"), Ok(DVec3::new(1.0, -2.5, 30.0)));
        for bad in ["1,2", "1,2,3,4", "a,b,c", "nan,0,0", "inf,0,0", ""] {
            assert!(triple(bad).is_err(), "{bad}");
        }
        assert_eq!(factor("64"), Ok(64.0));
        for bad in ["0", "0.99", "64.1", "nan", "inf", "-3", "x"] {
            assert!(factor(bad).is_err(), "{bad}");
        }
        assert!(positive("0").is_err() && positive("1e-3").is_ok());
        assert!(fov("0").is_err() && fov("180").is_err() && angle("inf").is_err());
    }
}
