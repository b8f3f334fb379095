//! The rows of a PLY file. Nothing is believed that has no bytes behind it.

use super::format_error;
use super::header::{Element, Encoding, Number};
use crate::mesh::MeshError;

/// Unread part of a file.
pub(super) struct Body<'b> {
    encoding: Encoding,
    rest: &'b [u8],
}

/// A row of an element: its numbers, and the lists.
#[derive(Default)]
pub(super) struct Row {
    /// Values of properties that are no lists.
    pub numbers: Vec<f64>,
    lists: Vec<f64>,
    /// Where each list ends.
    ends: Vec<usize>,
}

impl Row {
    /// The list of this number.
    pub(super) fn list(&self, number: usize) -> &[f64] {
        let start = if number == 0 { 0 } else { self.ends[number - 1] };
        &self.lists[start..self.ends[number]]
    }
}

impl<'b> Body<'b> {
    pub(super) fn new(encoding: Encoding, rest: &'b [u8]) -> Self {
        Self { encoding, rest }
    }

    /// Reads the rows of an element, one after the other.
    pub(super) fn for_each_row(
        &mut self,
        element: &Element,
        mut visit: impl FnMut(&Row) -> Result<(), MeshError>,
    ) -> Result<(), MeshError> {
        // Rows without properties have no bytes: there may be any number of them.
        if element.properties.is_empty() {
            return Ok(());
        }
        let mut row = Row::default();
        for number in 0..element.count {
            row.numbers.clear();
            row.lists.clear();
            row.ends.clear();
            self.read_row(element, &mut row)
                .map_err(|what| format_error(format!("element \"{}\", row {number}: {what}", element.name)))?;
            visit(&row)?;
        }
        Ok(())
    }

    fn read_row(&mut self, element: &Element, row: &mut Row) -> Result<(), String> {
        for property in &element.properties {
            match property.length {
                None => row.numbers.push(self.number(property.number)?),
                Some(length) => {
                    let length = self.number(length)?;
                    if !(0.0..=f64::from(u32::MAX)).contains(&length) || length.fract() != 0.0 {
                        return Err(format!("a list of {length} numbers can't be: write the file again"));
                    }
                    for _ in 0..length as u64 {
                        row.lists.push(self.number(property.number)?);
                    }
                    row.ends.push(row.lists.len());
                }
            }
        }
        Ok(())
    }

    fn number(&mut self, number: Number) -> Result<f64, String> {
        let cut_off = "the file ends there: write or copy it again";
        if self.encoding == Encoding::Text {
            self.rest = self.rest.trim_ascii_start();
            let end = self.rest.iter().position(u8::is_ascii_whitespace).unwrap_or(self.rest.len());
            let (word, rest) = self.rest.split_at(end);
            self.rest = rest;
            if word.is_empty() {
                return Err(cut_off.into());
            }
            let word = String::from_utf8_lossy(word);
            return word.parse().map_err(|_| format!("\"{word}\" is not a number"));
        }
        let (bytes, rest) = self.rest.split_at_checked(number.size()).ok_or(cut_off)?;
        self.rest = rest;
        let mut ordered = [0; 8];
        let ordered = &mut ordered[..bytes.len()];
        ordered.copy_from_slice(bytes);
        if self.encoding == Encoding::Big {
            ordered.reverse();
        }
        Ok(of_little(number, ordered))
    }
}

/// A number of bytes in little-endian order, as many as its type has.
fn of_little(number: Number, bytes: &[u8]) -> f64 {
    let mut wide = [0; 8];
    wide[..bytes.len()].copy_from_slice(bytes);
    let [a, b, c, d, ..] = wide;
    match number {
        Number::I8 => f64::from(a as i8),
        Number::U8 => f64::from(a),
        Number::I16 => f64::from(i16::from_le_bytes([a, b])),
        Number::U16 => f64::from(u16::from_le_bytes([a, b])),
        Number::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
        Number::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
        Number::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
        Number::F64 => f64::from_le_bytes(wide),
    }
}
