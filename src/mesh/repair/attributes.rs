//! Normals and texture coordinates that are not there or not finite.

use super::{Place, RepairKind, Work};
use crate::mesh::FaceVarying;

pub(super) fn mend(work: &mut Work) {
    let Work { data, repairs } = work;
    let sizes = &data.face_sizes;
    let mut report = |kind, (count, corner): (usize, Option<usize>)| {
        repairs.add(kind, count, corner.map(|corner| Place::Face(face_of(sizes, corner))));
    };
    report(RepairKind::Normals, data.normals.as_mut().map_or((0, None), zeroed));
    report(RepairKind::TextureCoordinates, data.texcoords.as_mut().map_or((0, None), zeroed));
}

/// Makes zero what is missing or not finite. Gives the number of corners that have it, and the first.
fn zeroed<const N: usize>(attribute: &mut FaceVarying<[f32; N]>) -> (usize, Option<usize>) {
    let is_bad = |value: &[f32; N]| value.iter().any(|x| !x.is_finite());
    let bad: Vec<bool> = attribute.values.iter().map(is_bad).collect();
    attribute.values.iter_mut().filter(|value| is_bad(value)).for_each(|value| *value = [0.0; N]);
    let (mut count, mut first) = (0, None);
    let zero = attribute.values.len() as u32;
    for (corner, index) in attribute.indices.iter_mut().enumerate() {
        let is_missing = *index >= zero;
        if is_missing {
            *index = zero;
        }
        if is_missing || bad[*index as usize] {
            count += 1;
            first.get_or_insert(corner);
        }
    }
    if attribute.indices.contains(&zero) {
        attribute.values.push([0.0; N]);
    }
    (count, first)
}

/// The face of a corner.
fn face_of(sizes: &[u32], corner: usize) -> u32 {
    let ends = sizes.iter().scan(0, |end, &size| {
        *end += size as usize;
        Some(*end)
    });
    ends.take_while(|&end| end <= corner).count() as u32
}
