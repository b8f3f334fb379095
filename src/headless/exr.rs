//! EXR files without colours: height maps of one channel.

use super::Texels;
use super::texture::check_size;
use ::exr::meta::MetaData;
use ::exr::prelude::{ReadChannels, ReadLayers, read};
use std::io::Cursor;

/// First bytes of every EXR file.
const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
/// Channels of heights, the first that there is; and of files that are read as colours.
const HEIGHTS: [&str; 2] = ["Y", "Z"];
const COLOURS: [&str; 3] = ["R", "G", "B"];

/// The heights of an EXR file that has no colours; `None` for other pictures, and for `vectors`. Checks its size in any case.
///
/// # Errors
/// Reason, in words.
pub(super) fn heights(bytes: &[u8], vectors: bool, max: u64) -> Result<Option<Texels>, String> {
    if !bytes.starts_with(&MAGIC) {
        return Ok(None);
    }
    check(bytes, max)?;
    if vectors {
        return Ok(None);
    }
    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let layer = reader.from_buffered(Cursor::new(bytes)).map_err(|error| error.to_string())?.layer_data;
    let channels = &layer.channel_data.list;
    let named = |name: &str| channels.iter().find(|channel| channel.name.eq(name));
    if COLOURS.iter().all(|name| named(name).is_some()) {
        return Ok(None);
    }
    let only = || if let [only] = channels.as_slice() { Some(only) } else { None };
    let Some(channel) = named("R").or_else(|| HEIGHTS.iter().find_map(|name| named(name))).or_else(only) else {
        let names: Vec<String> = channels.iter().map(|channel| channel.name.to_string()).collect();
        let names = names.join(", ");
        return Err(format!("it has the channels {names}, of which none is R, Y or Z: write heights to one of these"));
    };
    let (width, height) = (layer.size.width() as u32, layer.size.height() as u32);
    let values: Vec<f32> = channel.sample_data.values_as_f32().collect();
    if values.len() as u64 != u64::from(width) * u64::from(height) {
        return Err(format!("its channel {} has fewer texels than the picture: write it in full size", channel.name));
    }
    Ok(Some(Texels { width, height, channels: 1, values }))
}

/// Checks the texels of all layers together, before any is read.
fn check(bytes: &[u8], max: u64) -> Result<(), String> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|error| error.to_string())?;
    let mut values = 0u64;
    for header in &meta.headers {
        let size = [header.layer_size.width(), header.layer_size.height()].map(|side| side as u64);
        check_size(size, max)?;
        values = values.saturating_add((size[0] * size[1]).saturating_mul(header.channels.list.len() as u64));
    }
    // As many as a picture of colours has.
    let most = max.saturating_mul(4);
    if values <= most {
        return Ok(());
    }
    Err(format!(
        "it has {values} values in all channels: at most {most} are read; leave channels out, or raise the limit"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, WritableImage};

    fn file(channels: &[(&str, FlatSamples)]) -> Vec<u8> {
        let list = channels.iter().map(|(name, samples)| AnyChannel::new(*name, samples.clone())).collect();
        let image = Image::from_channels((2, 1), AnyChannels::sort(list));
        let mut bytes = Cursor::new(Vec::new());
        image.write().to_buffered(&mut bytes).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn one_channel_of_any_name_is_heights() {
        let samples = || FlatSamples::F32(vec![-0.5, 7.25]);
        for name in ["Y", "Z", "R", "height", "depth.V"] {
            let texels = Texels::decode(&file(&[(name, samples())]), false).unwrap();
            assert_eq!((texels.width, texels.height, texels.channels), (2, 1, 1), "{name}");
            assert_eq!(texels.values, [-0.5, 7.25], "{name}");
        }
        let other = || FlatSamples::F32(vec![1.0, 1.0]);
        for name in ["Y", "Z", "R"] {
            let texels = Texels::decode(&file(&[(name, samples()), ("A", other())]), false).unwrap();
            assert_eq!(texels.values, [-0.5, 7.25], "{name} beside another");
        }
        let error = Texels::decode(&file(&[("u", samples()), ("v", other())]), false).unwrap_err();
        assert_eq!(error, "it has the channels u, v, of which none is R, Y or Z: write heights to one of these");
        let nan = FlatSamples::F32(vec![0.0, f32::NAN]);
        let error = Texels::decode(&file(&[("Y", nan)]), false).unwrap_err();
        assert_eq!(error, "it has values that are no finite numbers");
    }

    #[test]
    fn files_beyond_the_limit_are_refused_by_their_header() {
        let samples = || FlatSamples::F32(vec![1.0, 2.0]);
        let small = file(&[("Y", samples())]);
        assert!(Texels::decode_up_to(&small, false, 2).is_ok());
        for vectors in [false, true] {
            let error = Texels::decode_up_to(&small, vectors, 1).unwrap_err();
            assert_eq!(error, "it has 2 x 1 texels: at most 1 are read; make it smaller, or raise the limit");
        }
        let five = ["a", "b", "c", "d", "Y"].map(|name| (name, samples()));
        let error = Texels::decode_up_to(&file(&five), false, 2).unwrap_err();
        let expected = "it has 10 values in all channels: at most 8 are read; leave channels out, or raise the limit";
        assert_eq!(error, expected);
        // The window of the data, of which little is there.
        let mut large = small.clone();
        let name = b"dataWindow\0box2i\0";
        let window = large.windows(name.len()).position(|bytes| bytes == name).unwrap() + name.len() + 4;
        large[window + 8..window + 16].copy_from_slice(&[99_999u32.to_le_bytes(); 2].concat());
        let error = Texels::decode(&large, false).unwrap_err();
        assert_eq!(
            error,
            "it has 100000 x 100000 texels: at most 268435456 are read; make it smaller, or raise the limit"
        );
    }

    #[test]
    fn what_is_cut_off_is_an_error() {
        let mut bytes = file(&[("Y", FlatSamples::F32(vec![1.0, 2.0]))]);
        bytes.truncate(bytes.len() - 4);
        assert!(Texels::decode(&bytes, false).is_err());
    }
}
