//! Shared data of the two patches at an edge: its curve and one normal along it, from data of the edge alone
//! (patch_maths B, "One normal an edge").
//!
//! From either end the sums are the same to the bit, but for the sign of those that point along the edge or across it.

use super::scheme::Scheme;
use crate::blend::{
    Blend, CurveBasis, Frame, Point, RingValues, curve_point, curve_slope, scalar, seen_from_ends, unit_normal,
};

/// An edge from one vertex to another.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Edge<P> {
    /// The Bezier points of its curve.
    pub curve: [P; 4],
    /// Across the edge at either end, as its vertex sees it ([`RingValues::across`]).
    pub across: [P; 2],
    /// The transversal at either end, as its vertex sees it ([`Scheme::transversal`]).
    pub transversals: [P; 2],
}

impl<P: Point> Edge<P> {
    /// The same edge seen from its other end.
    pub fn reversed(self) -> Self {
        let Self { mut curve, mut across, mut transversals } = self;
        curve.reverse();
        across.reverse();
        transversals.reverse();
        Self { curve, across, transversals }
    }
}

impl<P: Point + Blend> Edge<P> {
    /// The edge that is edge `index[0]` of the ring at its start and edge `index[1]` of the one at its end; frames are those of
    /// the scheme.
    pub fn new(scheme: Scheme, rings: [&RingValues<P>; 2], frames: [&Frame<P>; 2], index: [usize; 2]) -> Self {
        let at = |end: usize| (rings[end], frames[end], index[end]);
        let point = |(ring, frame, j): (&RingValues<P>, &Frame<P>, usize)| ring.edge_point(frame, j);
        let transversal = |(ring, frame, j): (&RingValues<P>, &Frame<P>, usize)| scheme.transversal(ring, frame, j);
        let across = |(ring, frame, j): (&RingValues<P>, &Frame<P>, usize)| ring.across(frame, j);
        Self {
            curve: [frames[0].p, point(at(0)), point(at(1)), frames[1].p],
            across: [across(at(0)), across(at(1))],
            transversals: [transversal(at(0)), transversal(at(1))],
        }
    }
}

/// The point at `t` along an edge.
pub fn edge_position<P: Point>(edge: &Edge<P>, t: P::Scalar) -> P {
    curve_point(&CurveBasis::new::<P>(t), seen_from_ends(edge.curve))
}

/// The unit normal at `t` along an edge, of both its faces. Where curve and transversal are parallel it is along `facing`.
pub fn edge_normal<P: Point>(edge: &Edge<P>, t: P::Scalar, facing: P) -> P {
    let along = curve_slope(&CurveBasis::new::<P>(t), seen_from_ends(edge.curve));
    let [[across0, across1], [transversal0, transversal1]] = [edge.across, edge.transversals];
    unit_normal(along, edge_across(across0, transversal0, transversal1, across1, t), facing)
}

/// Across an edge at `t` from its start: the same from either end, but for its sign.
///
/// GLSL twin: `edge_across` in `glsl/lib/edges/edges.glsl`.
pub(crate) fn edge_across<P: Point>(across0: P, transversal0: P, transversal1: P, across1: P, t: P::Scalar) -> P {
    let (s, three) = (scalar::<P>(1.0) - t, scalar::<P>(3.0));
    let (ss, tt) = (s * s, t * t);
    (across0 * (ss * s) - across1 * (tt * t)) + (transversal0 * (three * ss * t) - transversal1 * (three * tt * s))
}
