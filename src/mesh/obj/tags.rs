//! OpenSubdiv's tags: `t name integers/floats/strings arguments…`.

use super::{Lines, edits, statements};
use crate::mesh::{BoundaryRule, Corner, Crease, CreaseMethod, FaceVaryingRule, MeshData, TriangleRule};
use std::str::FromStr;

/// A tag whose arguments are as many as it announces.
pub(super) struct Tag<'a> {
    pub(super) name: &'a str,
    /// The announcement, as written.
    counts: &'a str,
    pub(super) integers: Vec<&'a str>,
    pub(super) floats: Vec<&'a str>,
    pub(super) strings: Vec<&'a str>,
}

/// Reads the tag made of `words` (those after the `t`). Tags of unknown name are passed over.
pub(super) fn read<'a>(
    words: impl Iterator<Item = &'a str>,
    line: usize,
    data: &mut MeshData,
    lines: &mut Lines,
) -> Result<(), String> {
    let tag = parse(words)?;
    match tag.name {
        "crease" => tag.add_creases(line, data, lines)?,
        "corner" => tag.add_corners(line, data, lines)?,
        "hole" => tag.add_holes(line, data, lines)?,
        "vertexedit" | "edgeedit" | "faceedit" => {
            data.edits.extend(edits::read(&tag)?);
            lines.edits.resize(data.edits.len(), line);
        }
        "interpolateboundary" => {
            data.boundary = match tag.only_integer()? {
                "0" => BoundaryRule::None,
                "1" => BoundaryRule::EdgeAndCorner,
                "2" => BoundaryRule::EdgeOnly,
                other => return Err(tag.value(other, "0 (none), 1 (edge and corner) or 2 (edge only)")),
            }
        }
        "facevaryinginterpolateboundary" => {
            data.face_varying_rule = match tag.only_integer()? {
                "0" => FaceVaryingRule::None,
                "1" => FaceVaryingRule::CornersOnly,
                "2" => FaceVaryingRule::CornersPlus1,
                "3" => FaceVaryingRule::CornersPlus2,
                "4" => FaceVaryingRule::Boundaries,
                "5" => FaceVaryingRule::All,
                other => {
                    let rules =
                        "0 (none), 1 (corners only), 2 (corners plus 1), 3 (corners plus 2), 4 (boundaries) or 5 (all)";
                    return Err(tag.value(other, rules));
                }
            }
        }
        "creasemethod" => {
            data.crease_method = match tag.only_string()? {
                "normal" => CreaseMethod::Uniform,
                "chaikin" => CreaseMethod::Chaikin,
                other => return Err(tag.value(other, "normal or chaikin")),
            }
        }
        "smoothtriangles" => {
            data.triangle_rule = match tag.only_string()? {
                "catmark" => TriangleRule::CatmullClark,
                "smooth" | "smooth_triangle" => TriangleRule::Smooth,
                other => return Err(tag.value(other, "catmark or smooth")),
            }
        }
        _ => {}
    }
    Ok(())
}

fn parse<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<Tag<'a>, String> {
    let (Some(name), Some(counts)) = (words.next(), words.next()) else {
        return Err("a tag needs a name and the number of its arguments, such as \"t crease 2/1/0\"".into());
    };
    let numbers: Result<Vec<usize>, _> = counts.split('/').map(usize::from_str).collect();
    let Ok([integers, floats, strings]) = numbers.as_deref() else {
        return Err(format!("\"{counts}\" is not a number of arguments: write integers/floats/strings, such as 2/1/0"));
    };
    let mut arguments: Vec<&str> = words.collect();
    let announced = integers.checked_add(*floats).and_then(|sum| sum.checked_add(*strings));
    if announced != Some(arguments.len()) {
        return Err(format!("the tag \"{name}\" announces {counts} arguments, but {} follow", arguments.len()));
    }
    let strings = arguments.split_off(integers + floats);
    let floats = arguments.split_off(*integers);
    Ok(Tag { name, counts, integers: arguments, floats, strings })
}

impl<'a> Tag<'a> {
    fn add_creases(&self, line: usize, data: &mut MeshData, lines: &mut Lines) -> Result<(), String> {
        let edges = self.integers.len().saturating_sub(1);
        if edges == 0 || !self.strings.is_empty() || ![1, edges].contains(&self.floats.len()) {
            return Err(self.shape("two or more vertices and one sharpness for all edges or one for each", "2/1/0"));
        }
        let vertices = indices(&self.integers)?;
        for (edge, pair) in vertices.windows(2).enumerate() {
            let sharpness = sharpness(self.floats[edge.min(self.floats.len() - 1)])?;
            data.creases.push(Crease { vertices: [pair[0], pair[1]], sharpness });
            lines.creases.push(line);
        }
        Ok(())
    }

    fn add_corners(&self, line: usize, data: &mut MeshData, lines: &mut Lines) -> Result<(), String> {
        let count = self.integers.len();
        if count == 0 || !self.strings.is_empty() || ![1, count].contains(&self.floats.len()) {
            return Err(self.shape("one or more vertices and one sharpness for all or one for each", "1/1/0"));
        }
        for (index, vertex) in indices(&self.integers)?.into_iter().enumerate() {
            let sharpness = sharpness(self.floats[index.min(self.floats.len() - 1)])?;
            data.corners.push(Corner { vertex, sharpness });
            lines.corners.push(line);
        }
        Ok(())
    }

    fn add_holes(&self, line: usize, data: &mut MeshData, lines: &mut Lines) -> Result<(), String> {
        if self.integers.is_empty() || !self.floats.is_empty() || !self.strings.is_empty() {
            return Err(self.shape("one or more faces", "1/0/0"));
        }
        for face in indices(&self.integers)? {
            data.holes.push(face);
            lines.holes.push((face, line));
        }
        Ok(())
    }

    fn only_integer(&self) -> Result<&'a str, String> {
        match (self.integers.as_slice(), self.floats.as_slice(), self.strings.as_slice()) {
            (&[integer], [], []) => Ok(integer),
            _ => Err(self.shape("one integer", "1/0/0")),
        }
    }

    fn only_string(&self) -> Result<&'a str, String> {
        match (self.integers.as_slice(), self.floats.as_slice(), self.strings.as_slice()) {
            ([], [], &[string]) => Ok(string),
            _ => Err(self.shape("one string", "0/0/1")),
        }
    }

    /// The message for arguments of the wrong kind or number.
    pub(super) fn shape(&self, takes: &str, example: &str) -> String {
        format!("the tag \"{}\" has {} arguments, but takes {takes} (such as {example})", self.name, self.counts)
    }

    /// The message for an argument that is not among the choices.
    pub(super) fn value(&self, value: &str, choices: &str) -> String {
        format!("\"{value}\" is no value of the tag \"{}\": use {choices}", self.name)
    }
}

fn indices(words: &[&str]) -> Result<Vec<u32>, String> {
    let index = |word: &&str| {
        word.parse().map_err(|_| format!("\"{word}\" is not an index: vertices and faces in tags count from 0"))
    };
    words.iter().map(index).collect()
}

/// Anything from ten up is infinitely sharp, so "inf" is welcome here.
pub(super) fn sharpness(word: &str) -> Result<f32, String> {
    match word.parse::<f32>() {
        Ok(f32::INFINITY) => Ok(f32::INFINITY),
        _ => statements::number_f32(word),
    }
}
