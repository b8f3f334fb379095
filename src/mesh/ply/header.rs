//! Header of a PLY file: elements and properties.

use super::format_error;
use crate::mesh::MeshError;

/// How numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    Little,
    Big,
}

/// A type of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

pub(super) struct Property {
    pub name: String,
    pub number: Number,
    /// The type of a list's length.
    pub length: Option<Number>,
}

pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
}

impl Number {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

impl Element {
    /// Where the number of this name is among those of a row that are no lists.
    pub(super) fn place_of(&self, name: &str) -> Option<usize> {
        self.properties.iter().filter(|property| property.length.is_none()).position(|property| property.name == name)
    }
}

/// Reads the header. Gives what comes after it.
pub(super) fn read(bytes: &[u8]) -> Result<(Header, &[u8]), MeshError> {
    let mut rest = bytes;
    let mut next_line = || {
        let end = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'))?;
        let line = String::from_utf8_lossy(&rest[..end]).trim().to_owned();
        let ending = if rest[end..].starts_with(b"\r\n") { 2 } else { 1 };
        rest = &rest[end + ending..];
        Some(line)
    };
    if next_line().as_deref() != Some("ply") {
        return Err(format_error("the file is not PLY: its first line must be \"ply\""));
    }
    let (mut encoding, mut elements) = (None, Vec::new());
    for number in 2.. {
        let line = next_line().ok_or_else(|| format_error("the header has no \"end_header\": the file is cut off"))?;
        let wrong = || format_error(format!("line {number}: \"{line}\" can't be read: write the file again"));
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words[..] {
            [] | ["comment" | "obj_info", ..] => {}
            ["format", name, _] => {
                encoding = Some(match name {
                    "ascii" => Encoding::Text,
                    "binary_little_endian" => Encoding::Little,
                    "binary_big_endian" => Encoding::Big,
                    _ => return Err(wrong()),
                });
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| wrong())?;
                elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", "list", length, number, name] => {
                let length = Some(Number::named(length).ok_or_else(wrong)?);
                let number = Number::named(number).ok_or_else(wrong)?;
                let element: &mut Element = elements.last_mut().ok_or_else(wrong)?;
                element.properties.push(Property { name: name.to_owned(), number, length });
            }
            ["property", number, name] => {
                let number = Number::named(number).ok_or_else(wrong)?;
                let element: &mut Element = elements.last_mut().ok_or_else(wrong)?;
                element.properties.push(Property { name: name.to_owned(), number, length: None });
            }
            ["end_header"] => break,
            _ => return Err(wrong()),
        }
    }
    let encoding = encoding.ok_or_else(|| format_error("the header has no \"format\": write the file again"))?;
    Ok((Header { encoding, elements }, rest))
}
