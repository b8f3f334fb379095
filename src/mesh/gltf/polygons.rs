//! From index lists to polygons.

use ::gltf::json::mesh::Mode;

/// Calls `visit` with the corners of every face that `indices` draw. Points and lines have none.
///
/// With `ngons` (the extension FB_ngon_encoding), triangles that follow one another are one polygon as long as they
/// share their first corner and each begins its second edge where the last ended: a fan. A triangle that shares the
/// first corner without going on from the last one can't be of the same polygon, and begins another.
pub(super) fn for_each_face<E>(
    indices: &[u32],
    mode: Mode,
    ngons: bool,
    mut visit: impl FnMut(&[u32]) -> Result<(), E>,
) -> Result<(), E> {
    match mode {
        Mode::Triangles => {
            let mut polygon: Vec<u32> = Vec::new();
            for triangle in indices.chunks_exact(3) {
                if ngons && polygon.first() == Some(&triangle[0]) && polygon.last() == Some(&triangle[1]) {
                    polygon.push(triangle[2]);
                } else {
                    if !polygon.is_empty() {
                        visit(&polygon)?;
                    }
                    polygon.clear();
                    polygon.extend_from_slice(triangle);
                }
            }
            if polygon.is_empty() { Ok(()) } else { visit(&polygon) }
        }
        Mode::TriangleStrip => indices.windows(3).enumerate().try_for_each(|(i, corners)| {
            let [a, b, c] = [corners[0], corners[1], corners[2]];
            // Strips are joined by triangles with a repeated corner, which draw nothing.
            if a == b || b == c || c == a {
                return Ok(());
            }
            visit(&if i % 2 == 0 { [a, b, c] } else { [a, c, b] })
        }),
        Mode::TriangleFan => match indices.split_first() {
            Some((&hub, rim)) => rim.windows(2).try_for_each(|edge| visit(&[hub, edge[0], edge[1]])),
            None => Ok(()),
        },
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Ok(()),
    }
}
