//! What lies along the edges of a patch: the same from both its sides.

use crate::blend::{CurveBasis, curve_slope};
use crate::patch::edge::edge_across;
use crate::patch::{Sample, unit_normal};
use crate::table::SharedTexcoord;
use glam::{Vec2, Vec3};

/// A corner of a patch with what it shares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharingCorner {
    /// As [`share_corner`](super::share_corner) gives it.
    pub with: [Vec3; 6],
    /// Whether the faces at the plus edge are lit with normals of their own.
    pub is_sharp: bool,
    /// The limit point and, as seen from there, the edge points along the plus and the minus edge.
    pub owned: [Vec3; 3],
    /// The patch's own texture coordinate.
    pub texcoord: [f32; 2],
    /// The shared ones.
    pub shared_texcoord: SharedTexcoord,
    /// The level of the displacement map: [`MeasuredDraw::corner_lod`](super::MeasuredDraw::corner_lod).
    pub lod: f32,
}

/// A point of the surface as all patches there have it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharedSample {
    /// Object space.
    pub position: Vec3,
    /// Of length one.
    pub normal: Vec3,
    /// The direction of displacement: the normal, but at creases.
    pub direction: Vec3,
    /// Where the displacement is looked up.
    pub texcoord: Vec2,
    /// At which level.
    pub lod: f32,
}

/// The edge from corner `k` to `n`, `way` along it.
struct OnEdge<'c> {
    k: &'c SharingCorner,
    n: &'c SharingCorner,
    way: f32,
}

/// The edge that (u, v) of a quad or (u, v, w) of a triangle lies on, the first where there are two.
fn on_edge(at: Vec3, corners: &[SharingCorner]) -> Option<OnEdge<'_>> {
    let edges = match corners.len() {
        3 => vec![(at.z == 0.0, at.y), (at.x == 0.0, at.z), (at.y == 0.0, at.x)],
        _ => vec![(at.y == 0.0, at.x), (at.x == 1.0, at.y), (at.y == 1.0, 1.0 - at.x), (at.x == 0.0, 1.0 - at.y)],
    };
    let k = edges.iter().position(|(on, _)| *on)?;
    Some(OnEdge { k: &corners[k], n: &corners[(k + 1) % corners.len()], way: edges[k].1 })
}

/// Numbers or vectors of the corners at a point of the patch.
///
/// GLSL twin: `INTERPOLATED` in `glsl/lib/evaluate/patch.glsl`.
fn interpolated(of: &[Vec2], at: Vec3) -> Vec2 {
    let mix = |a: Vec2, b: Vec2, t: f32| a * (1.0 - t) + b * t;
    match of {
        [a, b, c] => at.x * *a + at.y * *b + at.z * *c,
        _ => mix(mix(of[0], of[1], at.x), mix(of[3], of[2], at.x), at.y),
    }
}

/// The surface with what is shared in the place of what the patch alone makes of it; `own` is the patch's at `at`, which is
/// (u, v, 0) of a quad, (u, v, w) of a triangle.
///
/// GLSL twin: `share` in `glsl/lib/edges/edges.glsl`.
pub fn share(own: Sample<Vec3>, at: Vec3, corners: &[SharingCorner]) -> SharedSample {
    let pairs: Vec<_> = corners.iter().map(|corner| corner.texcoord.into()).collect();
    let lods: Vec<_> = corners.iter().map(|corner| Vec2::splat(corner.lod)).collect();
    let mut surface = SharedSample {
        position: own.position,
        normal: own.normal,
        direction: own.normal,
        texcoord: interpolated(&pairs, at),
        lod: interpolated(&lods, at).x,
    };
    let Some(OnEdge { k, n, way }) = on_edge(at, corners) else { return surface };
    let [across0, transversal0, .., normal0, direction0] = k.with;
    let [_, _, across1, transversal1, normal1, direction1] = n.with;
    let across = edge_across(across0, transversal0, transversal1, across1, way);
    let along = curve_slope(&CurveBasis::new::<Vec3>(way), [k.owned[0], k.owned[1], n.owned[2], n.owned[0]]);
    // A sum of two is the same both ways.
    let facing = direction0 + direction1;
    let of_edge = unit_normal(along, across, facing);
    let pick = |start: Vec3, end: Vec3| match way {
        0.0 => start,
        1.0 => end,
        _ => of_edge,
    };
    surface.direction = pick(direction0, direction1);
    if way == 0.0 || way == 1.0 || !k.is_sharp {
        let normal = pick(normal0, normal1);
        surface.normal = if way == 0.0 || way == 1.0 { super::draw::unit(normal) } else { normal };
    }
    let s = 1.0 - way;
    let at_end = |texcoord: [f32; 2]| Vec2::from(texcoord);
    surface.texcoord = match way {
        0.0 => at_end(k.shared_texcoord.corner),
        1.0 => at_end(n.shared_texcoord.corner),
        _ => s * at_end(k.shared_texcoord.plus) + way * at_end(n.shared_texcoord.minus),
    };
    surface.lod = s * k.lod + way * n.lod;
    surface
}
