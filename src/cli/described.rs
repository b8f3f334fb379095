//! Descriptions of what `--json` writes: help and comma-separated values are derived from the types that are written.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Form of a written value.
pub(super) enum Shape {
    /// A number, a text or a truth.
    Scalar,
    /// Values in order.
    List(Box<Shape>),
    /// Values by name.
    Map(Box<Shape>),
    /// The fields of a type.
    Fields(&'static str, Vec<Field>),
}

/// A field of a type.
pub(super) struct Field {
    name: &'static str,
    /// Whether the fields of its type stand in its place.
    flat: bool,
    shape: Shape,
    /// `[..]` and `{..}` stand for the shape, other notes behind it.
    note: &'static str,
}

/// A type whose JSON is known before there is a value.
pub(super) trait Described {
    fn shape() -> Shape;
}

/// Structs that describe themselves; a field may have a note: `name: Type = "note"`.
macro_rules! described {
    ($(
        $(#[$attribute:meta])*
        $visible:vis struct $type:ident $(<$life:lifetime>)? {
            $($(#[$of_field:meta])* $field_visible:vis $field:ident: $field_type:ty $(= $note:literal)?,)+
        }
    )+) => {$(
        $(#[$attribute])*
        $visible struct $type $(<$life>)? {
            $($(#[$of_field])* $field_visible $field: $field_type,)+
        }

        impl $(<$life>)? crate::cli::described::Described for $type $(<$life>)? {
            fn shape() -> crate::cli::described::Shape {
                use crate::cli::described::{Described, Field, Shape};
                Shape::Fields(stringify!($type), vec![$(Field::new(
                    stringify!($field),
                    &[$(stringify!($of_field)),*],
                    <$field_type as Described>::shape(),
                    concat!($($note)?),
                )),+])
            }
        }
    )+};
}
pub(super) use described;

impl Field {
    /// `attributes` are those of the field, of which serde's say what it is called.
    pub(super) fn new(name: &'static str, attributes: &[&'static str], shape: Shape, note: &'static str) -> Self {
        let of_serde = || attributes.iter().filter(|attribute| attribute.starts_with("serde"));
        let flat = of_serde().any(|attribute| attribute.contains("flatten"));
        let renamed = of_serde().find_map(|attribute| attribute.split_once("rename = \"")?.1.split('"').next());
        Self { name: renamed.unwrap_or(name), flat, shape, note }
    }
}

impl Shape {
    /// The keys, a type's fields spelled out once.
    fn keys(&self, known: &mut BTreeSet<&'static str>) -> String {
        match self {
            Self::Scalar => String::new(),
            Self::List(of) => format!("[{}]", of.keys(known)),
            Self::Map(of) => format!("{{name{}}}", of.keys(known)),
            Self::Fields(..) => format!("{{{}}}", self.fields(known)),
        }
    }

    /// The keys of a type, without braces.
    fn fields(&self, known: &mut BTreeSet<&'static str>) -> String {
        let Self::Fields(name, fields) = self else { return self.keys(known) };
        if !known.insert(name) {
            return "..".into();
        }
        let key = |Field { name, flat, shape, note }: &Field| match (flat, note.starts_with(['[', '{'])) {
            (true, _) => shape.fields(known),
            (false, true) => format!("{name}{note}"),
            (false, false) if note.is_empty() => format!("{name}{}", shape.keys(known)),
            (false, false) => format!("{name}{} ({note})", shape.keys(known)),
        };
        fields.iter().map(key).collect::<Vec<_>>().join(", ")
    }

    /// The paths of what a table has columns for: scalars, and of maps the `total`.
    fn columns(&self, path: &[&'static str], columns: &mut Vec<Vec<&'static str>>) {
        match self {
            Self::Scalar => columns.push(path.to_vec()),
            Self::List(_) => {}
            Self::Map(of) => of.columns(&[path, &["total"]].concat(), columns),
            Self::Fields(_, fields) => fields.iter().for_each(|Field { name, flat, shape, .. }| {
                let own = if *flat { &[][..] } else { std::slice::from_ref(name) };
                shape.columns(&[path, own].concat(), columns);
            }),
        }
    }

    /// Whether a value is of this shape: it has no key that is not described.
    fn holds(&self, value: &Value) -> bool {
        match (self, value) {
            (_, Value::Null) => true,
            (Self::List(of), Value::Array(values)) => values.iter().all(|value| of.holds(value)),
            (Self::Map(of), Value::Object(values)) => values.values().all(|value| of.holds(value)),
            (Self::Fields(..), Value::Object(values)) => {
                values.iter().all(|(key, value)| self.field(key).is_some_and(|shape| shape.holds(value)))
            }
            (Self::Scalar, value) => !value.is_array() && !value.is_object(),
            _ => false,
        }
    }

    fn field(&self, key: &str) -> Option<&Self> {
        let Self::Fields(_, fields) = self else { return None };
        fields.iter().find_map(|field| match field.flat {
            true => field.shape.field(key),
            false => (field.name == key).then_some(&field.shape),
        })
    }
}

/// Help for what follows the options: `before`, the keys of `T`, and `after`.
pub(super) fn help<T: Described>(before: &str, after: &str) -> String {
    let mut lines = vec!["JSON:".to_owned()];
    let mut keys = T::shape().fields(&mut BTreeSet::new());
    if keys.contains("..") {
        keys += " (.. is as where it first stands)";
    }
    for word in keys.split(' ') {
        match lines.last_mut().filter(|line| line.len() + 1 + word.len() < WIDTH) {
            Some(line) => *line += &format!(" {word}"),
            None => lines.push(word.to_owned()),
        }
    }
    format!("{before}{}{after}", lines.join("\n"))
}

/// Columns of help.
const WIDTH: usize = 100;

/// Whether a written value is what its type's description says.
pub(super) fn holds<T: Described>(value: &Value) -> bool {
    T::shape().holds(value)
}

/// Names and paths of the columns of a table of `T`: keys joined by `_`, where `value` and `total` go without saying.
pub(super) fn columns<T: Described>() -> Vec<(String, Vec<&'static str>)> {
    let mut columns = Vec::new();
    T::shape().columns(&[], &mut columns);
    let name = |path: &[&str]| {
        let said: Vec<_> = path.iter().copied().filter(|key| !["value", "total"].contains(key)).collect();
        said.join("_")
    };
    columns.into_iter().map(|path| (name(&path), path)).collect()
}

macro_rules! scalars {
    ($($type:ty),+) => {
        $(impl Described for $type {
            fn shape() -> Shape {
                Shape::Scalar
            }
        })+
    };
}

scalars!(bool, u32, u64, usize, i64, f32, f64, String, str);

impl<T: Described + ?Sized> Described for &T {
    fn shape() -> Shape {
        T::shape()
    }
}

impl<T: Described> Described for Option<T> {
    fn shape() -> Shape {
        T::shape()
    }
}

impl<T: Described> Described for [T] {
    fn shape() -> Shape {
        Shape::List(Box::new(T::shape()))
    }
}

impl<T: Described> Described for Vec<T> {
    fn shape() -> Shape {
        <[T]>::shape()
    }
}

impl<T: Described, const N: usize> Described for [T; N] {
    fn shape() -> Shape {
        <[T]>::shape()
    }
}

impl<K, T: Described> Described for BTreeMap<K, T> {
    fn shape() -> Shape {
        Shape::Map(Box::new(T::shape()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Serialize;

    described! {
        #[derive(Serialize)]
        struct Inner {
            value: f32,
            low: Option<u32>,
        }

        #[derive(Serialize)]
        struct Outer<'a> {
            #[serde(flatten)]
            inner: Inner,
            #[serde(rename = "type")]
            kind: &'a str = "a or b",
            ratio: Option<Inner>,
            size: [u32; 2] = "[width, height]",
            all: Vec<Inner>,
            bytes: BTreeMap<u32, u64>,
        }
    }

    #[test]
    fn keys_are_those_that_are_written() {
        let inner = || Inner { value: 1.0, low: None };
        let bytes = [(1, 2)].into();
        let outer = Outer { inner: inner(), kind: "a", ratio: None, size: [1, 2], all: vec![inner()], bytes };
        let mut value = serde_json::to_value(&outer).unwrap();
        assert!(holds::<Outer>(&value));
        value["all"][0]["lowest"] = Value::Null;
        assert!(!holds::<Outer>(&value));
        let keys = "JSON: value, low, type (a or b), ratio{..}, size[width, height], all[{..}], bytes{name} \
                    (.. is as\nwhere it first stands).\n\nMore";
        assert_eq!(help::<Outer>("", ".\n\nMore"), keys);
        let names: Vec<_> = columns::<Outer>().into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["", "low", "type", "ratio", "ratio_low", "bytes"]);
    }
}
