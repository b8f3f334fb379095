//! The tags of hierarchical edits: `t vertexedit|edgeedit|faceedit`.

use super::statements::number;
use super::tags::{Tag, sharpness};
use crate::mesh::{Change, Edit};

/// Operation that the strings of a tag name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Operation {
    Add,
    Subtract,
    Position,
    Sharpness,
    Hole,
}

/// The edits of a tag, one a path.
pub(super) fn read(tag: &Tag) -> Result<Vec<Edit>, String> {
    let operation = operation(tag)?;
    let stride = match operation {
        Operation::Add | Operation::Subtract | Operation::Position => 3,
        Operation::Sharpness => 1,
        Operation::Hole => 0,
    };
    let paths = paths(tag)?;
    let needed = paths.len() * stride;
    if tag.floats.len() < needed {
        let (name, count, given) = (tag.name, paths.len(), tag.floats.len());
        return Err(format!(
            "the tag \"{name}\" names {}, needing {} ({stride} each), but has {given}",
            counted(count, "path"),
            counted(needed, "number")
        ));
    }
    let of_path = |(index, path): (usize, Vec<u32>)| edit(tag, operation, path, &tag.floats[stride * index..]);
    paths.into_iter().enumerate().map(of_path).collect()
}

fn operation(tag: &Tag) -> Result<Operation, String> {
    match (tag.name, tag.strings.as_slice()) {
        ("faceedit", ["hole"]) => Ok(Operation::Hole),
        ("vertexedit", ["add", "P", "value"]) => Ok(Operation::Add),
        ("vertexedit", ["subtract", "P", "value"]) => Ok(Operation::Subtract),
        ("vertexedit", ["set", "P", "value"]) => Ok(Operation::Position),
        ("vertexedit" | "edgeedit", ["set", "P", "sharpness"]) => Ok(Operation::Sharpness),
        (name, strings) => Err(tag.value(
            &strings.join(" "),
            match name {
                "faceedit" => "hole",
                "edgeedit" => "set P sharpness",
                _ => "add P value, subtract P value, set P value or set P sharpness",
            },
        )),
    }
}

/// A count with its noun.
fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// The integers of each path.
fn paths(tag: &Tag) -> Result<Vec<Vec<u32>>, String> {
    let integers = tag.integers.iter().map(|word| {
        word.parse::<u32>().map_err(|_| format!("\"{word}\" in a path is no number: paths are made of numbers from 0"))
    });
    let integers = integers.collect::<Result<Vec<u32>, String>>()?;
    // A face, and but for faces the corner or edge.
    let (least, what) = if tag.name == "faceedit" { (1, "a face") } else { (2, "a face and its corner or edge") };
    let mut paths = Vec::new();
    let mut rest = integers.as_slice();
    while let Some((&length, numbers)) = rest.split_first() {
        let number = paths.len();
        if (length as usize) < least {
            return Err(format!(
                "path {number} has {}: a path of \"{}\" is {what} at least",
                counted(length as usize, "number"),
                tag.name
            ));
        }
        let Some((path, others)) = numbers.split_at_checked(length as usize) else {
            let left = numbers.len();
            return Err(format!("path {number} announces {}, but {left} follow", counted(length as usize, "number")));
        };
        paths.push(path.to_vec());
        rest = others;
    }
    if paths.is_empty() {
        return Err(tag.shape("one path or more, each led by its length", "3/3/3"));
    }
    Ok(paths)
}

fn edit(tag: &Tag, operation: Operation, mut path: Vec<u32>, floats: &[&str]) -> Result<Edit, String> {
    let part = if operation == Operation::Hole { 0 } else { path.pop().unwrap_or_default() };
    let vector = |sign: f64| -> Result<[f64; 3], String> {
        Ok([sign * number(floats[0])?, sign * number(floats[1])?, sign * number(floats[2])?])
    };
    let change = match operation {
        Operation::Add => Change::Offset { corner: part, offset: vector(1.0)? },
        Operation::Subtract => Change::Offset { corner: part, offset: vector(-1.0)? },
        Operation::Position => Change::Position { corner: part, position: vector(1.0)? },
        Operation::Sharpness if tag.name == "edgeedit" => {
            Change::EdgeSharpness { edge: part, sharpness: sharpness(floats[0])? }
        }
        Operation::Sharpness => Change::CornerSharpness { corner: part, sharpness: sharpness(floats[0])? },
        Operation::Hole => Change::Hole,
    };
    let face = path.remove(0);
    Ok(Edit { face, children: path, change })
}
