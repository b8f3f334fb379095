//! Tessellation factors.
//!
//! The factor of an edge comes from the edge alone, by sums that are the same from either end.

use super::MeasuredDraw;
use super::draw::exact_dot;
use super::factor::Factor;
use crate::blend::{Basis, cubic};
use glam::{Vec3, Vec3Swizzles};

/// Weight of a bend towards the eye: it is seen in the shading only. GLSL twin: `DEPTH_WEIGHT` in
/// `glsl/lib/edges/factors.glsl`.
const DEPTH_WEIGHT: f32 = 0.25;

/// The factors of a patch. Of a triangle and a pentagon the second inner factor is the first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PatchFactors {
    /// Of each edge, from the first corner's plus edge on, not yet within limits; zeros beyond the corners.
    pub asked: [f32; 5],
    /// Of each edge, within limits; zeros beyond the corners.
    pub outer: [f32; 5],
    /// Of the inside.
    pub inner: [f32; 2],
    /// Whether the patch is culled.
    pub culled: bool,
}

/// GLSL twin: `pixel_distance` in `glsl/lib/edges/factors.glsl`.
fn pixel_distance(a: Vec3, b: Vec3) -> f32 {
    let d = a.xy() - b.xy();
    (d.x * d.x + d.y * d.y).sqrt()
}

/// The level of the displacement map at which an edge of so many `segments` has as many texels; `length` is the edge's over that of
/// the map's longer side, `texels` that of this side.
///
/// GLSL twin: `map_lod` in `glsl/lib/displace/map_lod.glsl`.
pub fn map_lod(length: f32, segments: f32, texels: f32) -> f32 {
    (length * texels / segments).log2().max(0.0)
}

impl MeasuredDraw {
    /// The length in pixels of an edge's curve, as that of a polyline.
    ///
    /// GLSL twin: `edge_pixels` in `glsl/lib/edges/factors.glsl`.
    pub fn edge_pixels(&self, p0: Vec3, e0: Vec3, e1: Vec3, p1: Vec3) -> f32 {
        let at = |t: f32| self.to_pixels(cubic(&Basis::new::<Vec3>(t), &[p0, e0, e1, p1]));
        let (a, e) = (self.to_pixels(p0), self.to_pixels(p1));
        let [b, c, d] = [0.25, 0.5, 0.75].map(at);
        (pixel_distance(a, b) + pixel_distance(d, e)) + (pixel_distance(b, c) + pixel_distance(c, d))
    }

    /// The largest distance in pixels of an edge's curve from its chord: a bend seen from the side counts fully, one towards
    /// the eye in part.
    ///
    /// GLSL twin: `bend_pixels` in `glsl/lib/edges/factors.glsl`.
    fn bend_pixels(&self, p0: Vec3, p1: Vec3, bend: Vec3) -> f32 {
        let middle = 0.5 * (p0 + p1);
        let at = self.to_pixels(middle);
        let moved = middle + bend;
        let across = pixel_distance(self.to_pixels(moved), at);
        let d = self.to_world(moved) - self.to_world(middle);
        let scale = 0.5 * self.viewport.y * self.viewport.w / at.z;
        across.max(DEPTH_WEIGHT * scale * exact_dot(d, d).sqrt())
    }

    /// The segments that an edge's metric asks for, not yet within limits.
    ///
    /// GLSL twin: `edge_factor` in `glsl/lib/edges/factors.glsl`.
    pub fn edge_factor(&self, p0: Vec3, e0: Vec3, e1: Vec3, p1: Vec3) -> f32 {
        if matches!(self.factor, Factor::Pixels(_)) {
            return self.edge_pixels(p0, e0, e1, p1) / self.draw_factor();
        }
        // A cubic lies within max |P_i - 2 P_i+1 + P_i+2| * 6 / 8 of its chord, and within 1/n^2 of that in n segments.
        let bend0 = 0.75 * ((p0 + e1) - 2.0 * e0);
        let bend1 = 0.75 * ((p1 + e0) - 2.0 * e1);
        let bend = self.bend_pixels(p0, p1, bend0).max(self.bend_pixels(p1, p0, bend1));
        // A segment shorter than a pixel shows nothing.
        (bend / self.draw_factor()).sqrt().min(self.edge_pixels(p0, e0, e1, p1))
    }

    /// The factor of edges at a vertex with the limit point `p` and the tangent frame `a`, `b`: the mean length of its tangents.
    ///
    /// GLSL twin: `vertex_factor` in `glsl/lib/edges/factors.glsl`.
    pub fn vertex_factor(&self, p: Vec3, a: Vec3, b: Vec3) -> f32 {
        let mut factor = self.draw_factor();
        if matches!(self.factor, Factor::Pixels(_) | Factor::Curvature(_)) {
            let from = self.to_pixels(p);
            let along = [a, b].map(|tangent| pixel_distance(self.to_pixels(p + 3.0 * tangent), from));
            factor = along[0].max(along[1]) / factor;
        }
        factor.max(1.0).min(self.max_factor)
    }

    /// The level of the displacement map for a corner: see [`map_lod`] and [`MeasuredDraw::vertex_factor`].
    ///
    /// GLSL twin: `corner_lod` in `glsl/lib/displace/corner_lod.glsl`.
    pub fn corner_lod(&self, length: f32, texels: f32, [p, a, b]: [Vec3; 3]) -> f32 {
        map_lod(length, self.vertex_factor(p, a, b), texels)
    }

    /// The factor of the edge from corner `k` to the next, not yet within limits. `owned` are the control points of each
    /// corner ([`Scheme::corner_slots`](crate::patch::Scheme::corner_slots)), `of_corners` the edge factors of [`Factor::Edges`].
    ///
    /// GLSL twin: `plus_factor` in `glsl/lib/edges/edge_factors.glsl`.
    pub fn plus_factor(&self, owned: &[Vec<Vec3>], of_corners: &[f32], k: usize) -> f32 {
        let next = (k + 1) % owned.len();
        match self.factor {
            Factor::Uniform(factor) => factor,
            Factor::Edges(factor) => factor * of_corners[k],
            Factor::Segments => 1.0,
            Factor::Pixels(_) | Factor::Curvature(_) => {
                self.edge_factor(owned[k][0], owned[k][1], owned[next][2], owned[next][0])
            }
        }
    }

    /// What is no number counts as 1.
    ///
    /// GLSL twin: `within_limits` in `glsl/lib/edges/edge_factors.glsl`.
    fn within_limits(&self, factor: f32) -> f32 {
        if factor > 1.0 { factor.min(self.max_factor) } else { 1.0 }
    }

    /// The factors of a patch, and whether it is culled; arguments as of [`MeasuredDraw::plus_factor`].
    ///
    /// GLSL twin: `finish_patch` in `glsl/lib/construct/control.glsl`.
    pub fn patch_factors(&self, owned: &[Vec<Vec3>], of_corners: &[f32]) -> PatchFactors {
        let mut factors = PatchFactors::default();
        let (mut largest, mut smallest) = (1.0f32, self.max_factor);
        for k in 0..owned.len() {
            factors.asked[k] = self.plus_factor(owned, of_corners, k);
            factors.outer[k] = self.within_limits(factors.asked[k]);
            largest = largest.max(factors.outer[k]);
            smallest = smallest.min(factors.outer[k]);
        }
        factors.culled = self.is_culled(owned, 1.0 / smallest);
        // With fractional spacing an inner factor of nearly 1 would put vertices of the inside on the edge.
        let uniform = matches!(self.factor, Factor::Uniform(_));
        let least = if largest > 1.0 && !uniform { self.max_factor.min(1.5) } else { 1.0 };
        let [a, b, c, d, _] = factors.outer;
        factors.inner = match owned.len() {
            4 => [a.max(c).max(least), b.max(d).max(least)],
            _ => [largest.max(least); 2],
        };
        factors
    }
}
