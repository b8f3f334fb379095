//! OBJ's lines, words and numbers.

use crate::mesh::MeshError;

/// Calls `visit` with the line (from one) and the text of every statement that is not empty: comments are taken off,
/// and lines that end in a backslash are joined with the next; the line is then that of the first. The text may be in any encoding
/// that writes ASCII as it is: it is decoded line by line, for a copy of nonsense would be three times as long.
pub(super) fn for_each_statement(
    text: &[u8],
    mut visit: impl FnMut(usize, &str) -> Result<(), MeshError>,
) -> Result<(), MeshError> {
    // Editors on Windows put a byte order mark before the first line.
    let text = text.strip_prefix("\u{feff}".as_bytes()).unwrap_or(text);
    let mut joined = Vec::new();
    let mut first = None;
    let mut visit = |line, statement: &[u8]| match statement.first() {
        // All that is read begins so.
        Some(b'f' | b'v' | b't') => visit(line, &String::from_utf8_lossy(statement)),
        _ => Ok(()),
    };
    // Lines end as Unix, Windows or old Macs have it.
    let lines = text
        .split(|&byte| byte == b'\n')
        .flat_map(|line| line.strip_suffix(b"\r").unwrap_or(line).split(|&byte| byte == b'\r'));
    for (index, line) in lines.enumerate() {
        let end = line.iter().position(|&byte| byte == b'#').unwrap_or(line.len());
        let line = line[..end].trim_ascii();
        if let Some(part) = line.strip_suffix(b"\\") {
            first.get_or_insert(index + 1);
            joined.extend_from_slice(part);
            joined.push(b' ');
        } else if let Some(first) = first.take() {
            joined.extend_from_slice(line);
            visit(first, joined.trim_ascii_start())?;
            joined.clear();
        } else {
            visit(index + 1, line)?;
        }
    }
    match first {
        Some(first) => visit(first, joined.trim_ascii_start()),
        None => Ok(()),
    }
}

/// A finite number.
pub(super) fn number(word: &str) -> Result<f64, String> {
    match word.parse() {
        Ok(number) if f64::is_finite(number) => Ok(number),
        _ => Err(format!("\"{word}\" is not a finite number: write it like 1.5 or -2e3")),
    }
}

/// A number; what writers put in place of one is none.
pub(super) fn number_or_none(word: &str) -> Result<f64, String> {
    const NONE: [&str; 3] = ["nan", "inf", "ind"];
    let lower = word.to_ascii_lowercase();
    if NONE.iter().any(|none| lower.contains(none)) { Ok(f64::NAN) } else { number(word) }
}

/// A finite number in single precision.
pub(super) fn number_f32(word: &str) -> Result<f32, String> {
    let number = number(word)? as f32;
    if number.is_finite() { Ok(number) } else { Err(format!("\"{word}\" is too large: at most {:e}", f32::MAX)) }
}

/// Index of a part of a face corner that is not written.
pub(super) const ABSENT: u32 = u32::MAX;
/// Index in the place of one that names nothing, where that is mended.
pub(super) const NOTHING: u32 = ABSENT - 1;

/// The vertex, texture coordinate and normal of a face corner, counted from zero, [`ABSENT`] where not given.
///
/// `counts` tells how many of each came before, for indices that count back. With `mend`, texture coordinates and normals may
/// name nothing.
pub(super) fn face_corner(word: &str, counts: [usize; 3], mend: bool) -> Result<[u32; 3], String> {
    let mut corner = [ABSENT; 3];
    let mut parts = word.split('/');
    for ((index, what), count) in corner.iter_mut().zip(["vertex", "texture coordinate", "normal"]).zip(counts) {
        match parts.next() {
            None | Some("") => {}
            Some(part) => {
                *index = match face_index(part, what, count) {
                    Err(_) if mend && what != "vertex" => NOTHING,
                    other => other?,
                }
            }
        }
    }
    if corner[0] == ABSENT || parts.next().is_some() {
        return Err(format!("\"{word}\" is not a face corner: write v, v/vt, v//vn or v/vt/vn"));
    }
    Ok(corner)
}

fn face_index(word: &str, what: &str, count: usize) -> Result<u32, String> {
    let wrong = || format!("\"{word}\" is not the index of a {what}: indices count from 1, or back from -1");
    match word.parse::<i64>().map_err(|_| wrong())? {
        0 => Err(wrong()),
        index @ 1.. => u32::try_from(index - 1).ok().filter(|&index| index < NOTHING).ok_or_else(wrong),
        back => usize::try_from(back.unsigned_abs())
            .ok()
            .and_then(|back| count.checked_sub(back))
            .and_then(|index| u32::try_from(index).ok())
            .ok_or_else(|| format!("{what} {word} counts back too far: {count} come before this line")),
    }
}
