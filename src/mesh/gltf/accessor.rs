//! Reading numbers out of buffers, with every range checked: nothing in a file can make this panic or allocate more
//! than the file is long.

use super::error::format_error;
use crate::mesh::MeshError;
use ::gltf::json;
use json::accessor::{ComponentType, Type};
use json::validation::Checked;
use std::borrow::Cow;

/// An array of `N` numbers an element.
pub(super) struct Accessor<'a> {
    base: Option<Elements<'a>>,
    sparse: Option<Sparse<'a>>,
    count: usize,
    component: ComponentType,
    normalized: bool,
}

/// Elements that stand in a buffer at equal distances.
#[derive(Clone, Copy)]
struct Elements<'a> {
    data: &'a [u8],
    stride: usize,
}

/// Elements that replace those of the base.
struct Sparse<'a> {
    /// Strictly increasing.
    indices: Vec<u64>,
    values: Elements<'a>,
}

impl<'a> Accessor<'a> {
    /// Opens the accessor `index` for elements of type `kind`.
    pub fn open(root: &json::Root, buffers: &'a [Cow<'_, [u8]>], index: usize, kind: Type) -> Result<Self, MeshError> {
        let wrong = |what: &str| format_error(format!("accessor {index} {what}"));
        let accessor = root.accessors.get(index).ok_or_else(|| wrong("does not exist, but something names it"))?;
        match accessor.type_ {
            Checked::Valid(found) if found == kind => {}
            Checked::Valid(found) => {
                return Err(wrong(&format!("is a {}, but a {} is needed", type_name(found), type_name(kind))));
            }
            Checked::Invalid => return Err(wrong("has an unknown type")),
        }
        let Checked::Valid(component) = accessor.component_type else {
            return Err(wrong("has an unknown component type"));
        };
        let component = component.0;
        let count = usize::try_from(accessor.count.0).map_err(|_| wrong("has too many elements"))?;
        let size = component.size() * kind.multiplicity();
        let out_of_range = || wrong("reaches beyond its buffer view");
        let elements = |view: json::Index<json::buffer::View>, offset: u64, count: usize, size: usize| {
            elements(root, buffers, view.value(), offset, count, size).ok_or_else(out_of_range)
        };

        let offset = accessor.byte_offset.unwrap_or_default().0;
        let base = accessor.buffer_view.map(|view| elements(view, offset, count, size)).transpose()?;
        let sparse = match &accessor.sparse {
            None => None,
            Some(sparse) => {
                let replaced = usize::try_from(sparse.count.0).map_err(|_| out_of_range())?;
                let Checked::Valid(index_type) = sparse.indices.component_type else {
                    return Err(wrong("has sparse indices of unknown type"));
                };
                let (view, offset) = (sparse.indices.buffer_view, sparse.indices.byte_offset.0);
                let places = elements(view, offset, replaced, index_type.0.size())?;
                let indices: Vec<u64> =
                    (0..replaced).map(|i| places.number(i, 0, index_type.0, false) as u64).collect();
                let increasing = indices.is_sorted_by(|a, b| a < b);
                if !increasing || indices.last().is_some_and(|&last| last >= count as u64) {
                    return Err(wrong("has sparse indices that do not increase or are out of range"));
                }
                let values = elements(sparse.values.buffer_view, sparse.values.byte_offset.0, replaced, size)?;
                Some(Sparse { indices, values })
            }
        };
        Ok(Self { base, sparse, count, component, normalized: accessor.normalized })
    }

    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether there is data behind every element. Without it, `count` may be any number.
    pub fn is_backed(&self) -> bool {
        self.base.is_some() || self.count == 0
    }

    /// Whether the elements can be indices.
    pub fn is_unsigned(&self) -> bool {
        matches!(self.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32)
    }

    /// The element `index`, which must be below the count.
    pub fn get<const N: usize>(&self, index: usize) -> [f64; N] {
        let replaced = self.sparse.as_ref().and_then(|sparse| {
            let place = sparse.indices.binary_search(&(index as u64)).ok()?;
            Some((sparse.values, place))
        });
        let element = replaced.or(self.base.map(|base| (base, index)));
        std::array::from_fn(|component| match element {
            Some((elements, index)) => elements.number(index, component, self.component, self.normalized),
            None => 0.0,
        })
    }
}

/// The elements in a buffer view, if all of them lie in it.
fn elements<'a>(
    root: &json::Root,
    buffers: &'a [Cow<'_, [u8]>],
    view: usize,
    offset: u64,
    count: usize,
    size: usize,
) -> Option<Elements<'a>> {
    let view = root.buffer_views.get(view)?;
    let start = usize::try_from(view.byte_offset.unwrap_or_default().0).ok()?;
    let end = start.checked_add(usize::try_from(view.byte_length.0).ok()?)?;
    let data = buffers.get(view.buffer.value())?.get(start..end)?.get(usize::try_from(offset).ok()?..)?;
    // A stride of zero stands for none in files of some writers.
    let stride = view.byte_stride.map(|stride| stride.0).filter(|&stride| stride > 0).unwrap_or(size);
    let needed = if count == 0 { 0 } else { stride.checked_mul(count - 1)?.checked_add(size)? };
    (stride >= size && needed <= data.len()).then_some(Elements { data, stride })
}

impl Elements<'_> {
    fn number(&self, index: usize, component: usize, kind: ComponentType, normalized: bool) -> f64 {
        let bytes = &self.data[index * self.stride + component * kind.size()..];
        let (number, full) = match kind {
            ComponentType::I8 => (f64::from(bytes[0] as i8), f64::from(i8::MAX)),
            ComponentType::U8 => (f64::from(bytes[0]), f64::from(u8::MAX)),
            ComponentType::I16 => (f64::from(i16::from_le_bytes([bytes[0], bytes[1]])), f64::from(i16::MAX)),
            ComponentType::U16 => (f64::from(u16::from_le_bytes([bytes[0], bytes[1]])), f64::from(u16::MAX)),
            ComponentType::U32 => {
                (f64::from(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])), f64::from(u32::MAX))
            }
            ComponentType::F32 => {
                return f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
            }
        };
        // The most negative integer has no positive counterpart and counts as -1.
        if normalized { (number / full).max(-1.0) } else { number }
    }
}

fn type_name(kind: Type) -> &'static str {
    match kind {
        Type::Scalar => "SCALAR",
        Type::Vec2 => "VEC2",
        Type::Vec3 => "VEC3",
        Type::Vec4 => "VEC4",
        Type::Mat2 => "MAT2",
        Type::Mat3 => "MAT3",
        Type::Mat4 => "MAT4",
    }
}
