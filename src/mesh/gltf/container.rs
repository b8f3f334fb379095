//! From the bytes of a file to its JSON and its buffers.

use super::GltfOptions;
use super::error::format_error;
use crate::mesh::read::{Unread, bytes_of};
use crate::mesh::{Limits, MeshError};
use ::gltf::json;
use base64::Engine as _;
use std::borrow::Cow;
use std::path::Path;

const GLB_HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

/// The JSON of a glTF file, and the binary chunk if it is a GLB.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), MeshError> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let cut_off = || format_error("the GLB file is cut off: write or copy it again");
    let version = u32_at(bytes, 4).ok_or_else(cut_off)?;
    if version != 2 {
        return Err(format_error(format!("GLB version {version} can't be read: save the file as glTF 2.0")));
    }
    let length = u32_at(bytes, 8).ok_or_else(cut_off)? as usize;
    let bytes = bytes.get(..length).ok_or_else(cut_off)?;
    let mut chunks = bytes.get(GLB_HEADER..).ok_or_else(cut_off)?;
    let (mut json, mut binary) = (None, None);
    while !chunks.is_empty() {
        let length = u32_at(chunks, 0).ok_or_else(cut_off)? as usize;
        let kind = chunks.get(4..CHUNK_HEADER).ok_or_else(cut_off)?;
        let rest = &chunks[CHUNK_HEADER..];
        let chunk = rest.get(..length).ok_or_else(cut_off)?;
        // Chunks of other kinds belong to extensions and are to be passed over.
        match kind {
            b"JSON" => json = json.or(Some(chunk)),
            b"BIN\0" => binary = binary.or(Some(chunk)),
            _ => {}
        }
        chunks = &rest[length..];
    }
    Ok((json.ok_or_else(|| format_error("the GLB file has no JSON chunk: write it again"))?, binary))
}

fn u32_at(bytes: &[u8], offset: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(offset..)?.first_chunk()?))
}

/// What concerns only looks or movement. It is taken out before the JSON is given its types, so that nothing wrong
/// with it (or unknown to us) stands in the way of the meshes.
const NOT_GEOMETRY: [&str; 7] = ["animations", "cameras", "images", "materials", "samplers", "skins", "textures"];

/// The JSON with types, none of its indices checked.
pub(super) fn parse(json: &[u8], limits: &Limits) -> Result<json::Root, MeshError> {
    limits.check_json_values(values(json))?;
    let not_gltf = |error: serde_json::Error| format_error(format!("the file is not glTF 2.0: {error}"));
    let mut value: serde_json::Value = serde_json::from_slice(json).map_err(not_gltf)?;
    if let Some(object) = value.as_object_mut() {
        NOT_GEOMETRY.iter().for_each(|part| drop(object.remove(*part)));
    }
    serde_json::from_value(value).map_err(not_gltf)
}

/// At least as many values as the JSON has: each but the first follows a bracket or a comma.
fn values(json: &[u8]) -> u64 {
    let (mut count, mut in_string, mut escaped) = (1, false, false);
    for &byte in json {
        match byte {
            _ if escaped => escaped = false,
            b'\\' => escaped = in_string,
            b'"' => in_string = !in_string,
            b'[' | b'{' | b',' if !in_string => count += 1,
            _ => {}
        }
    }
    count
}

/// The contents of every buffer: the binary chunk, a data URI, or a file in `folder`.
pub(super) fn buffers<'a>(
    root: &json::Root,
    binary: Option<&'a [u8]>,
    options: &GltfOptions,
) -> Result<Vec<Cow<'a, [u8]>>, MeshError> {
    let mut buffers = Vec::with_capacity(root.buffers.len());
    // A file may be named by any number of buffers.
    let mut fetched_bytes = 0;
    for (index, buffer) in root.buffers.iter().enumerate() {
        let contents = match (&buffer.uri, binary) {
            (Some(uri), _) => {
                let fetched = fetch(uri, options.folder.as_deref(), fetched_bytes, &options.limits).map_err(
                    |error| match error {
                        Unfetched::Why(why) => format_error(format!("buffer {index}: {why}")),
                        Unfetched::Mesh(error) => error,
                    },
                )?;
                fetched_bytes += fetched.len() as u64;
                Cow::Owned(fetched)
            }
            (None, Some(binary)) if index == 0 => Cow::Borrowed(binary),
            (None, _) => return Err(format_error(format!("buffer {index} has no data: give it a URI or use GLB"))),
        };
        let (given, needed) = (contents.len() as u64, buffer.byte_length.0);
        if given < needed {
            return Err(format_error(format!("buffer {index} has {given} bytes, but {needed} are announced")));
        }
        buffers.push(contents);
    }
    Ok(buffers)
}

/// Why a buffer has no bytes.
enum Unfetched {
    Why(String),
    Mesh(MeshError),
}

impl<S: Into<String>> From<S> for Unfetched {
    fn from(why: S) -> Self {
        Self::Why(why.into())
    }
}

fn fetch(uri: &str, folder: Option<&Path>, before: u64, limits: &Limits) -> Result<Vec<u8>, Unfetched> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (_, encoded) = data.split_once(";base64,").ok_or("the data URI is not in base64: encode it so")?;
        // Encoders disagree about the padding at the end.
        let padding = base64::engine::DecodePaddingMode::Indifferent;
        let config = base64::engine::GeneralPurposeConfig::new().with_decode_padding_mode(padding);
        let engine = base64::engine::GeneralPurpose::new(&base64::alphabet::STANDARD, config);
        // Four digits are three bytes.
        limits.check_bytes(before.saturating_add(encoded.len() as u64 / 4 * 3)).map_err(Unfetched::Mesh)?;
        return Ok(engine.decode(encoded).map_err(|error| format!("the data URI is not valid base64: {error}"))?);
    }
    // Some exporters write names as they are, with a `%` in them.
    let decoded = percent_decoded(uri).filter(|decoded| {
        let is_there = |name: &str| folder.is_some_and(|folder| folder.join(name).is_file());
        is_there(decoded) || !is_there(uri)
    });
    let name = decoded.unwrap_or_else(|| uri.to_owned());
    let relative = Path::new(&name);
    if uri.contains("://") || relative.has_root() {
        return Err(format!("\"{uri}\" is not a relative file name: put the file next to this one").into());
    }
    let folder = folder.ok_or_else(|| format!("\"{uri}\" can't be found from memory: read the file by its path"))?;
    let path = folder.join(relative);
    // Reading a device or a pipe could go on for ever.
    if !path.is_file() {
        return Err(format!("there is no file \"{name}\" next to this one").into());
    }
    bytes_of(&path, before, limits).map_err(|error| match error {
        Unread::Io(error) => format!("\"{name}\": {error}").into(),
        Unread::Mesh(error) => Unfetched::Mesh(error),
    })
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut decoded = Vec::with_capacity(uri.len());
    let mut bytes = uri.bytes();
    while let Some(byte) = bytes.next() {
        decoded.push(match byte {
            b'%' => {
                let mut digit = || char::from(bytes.next()?).to_digit(16);
                (digit()? * 16 + digit()?) as u8
            }
            other => other,
        });
    }
    String::from_utf8(decoded).ok()
}
