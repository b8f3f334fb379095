//! Batches: patches that one draw instance may hold.

use crate::named::named;
use ash::vk;

/// The domain of a tessellation evaluation shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Domain {
    /// Four-cornered patches, with four outer factors and two inner ones.
    Quads,
    /// Three-cornered patches, with three outer factors and an inner one.
    Triangles,
}

named! {
    /// Rounding of a tessellation factor to a whole number of segments.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum Spacing {
        /// `equal_spacing`: rounded up.
        #[default]
        Equal = "equal",
        /// `fractional_odd_spacing`: rounded up to an odd number.
        FractionalOdd = "odd",
        /// `fractional_even_spacing`: rounded up to an even number.
        FractionalEven = "even",
    }
}

impl Spacing {
    /// The segments of an edge with tessellation factor `level`, on a device whose largest level is `max_level`
    /// (Vulkan 1.3, "Tessellation Primitive Spacing"). A factor that is no number counts as the smallest.
    pub fn segments(self, level: f32, max_level: u32) -> u32 {
        // `as` takes NaN to 0 and everything else into range.
        let up = (level.ceil() as u32).min(max_level);
        match self {
            Self::Equal => up.clamp(1, max_level.max(1)),
            Self::FractionalOdd => (up | 1).clamp(1, max_level.max(2) - 1),
            Self::FractionalEven => up.next_multiple_of(2).clamp(2, max_level.max(2)),
        }
    }
}

/// The tessellation-evaluation vertices of a patch whose factors are all `level`; no patch whose factors are at most
/// `level` has more.
pub fn tessellated_vertices(domain: Domain, spacing: Spacing, level: f32, max_level: u32) -> u32 {
    let n = spacing.segments(level, max_level);
    match domain {
        Domain::Quads => (n + 1) * (n + 1),
        // Rings of 3n, 3(n-2), ... vertices; an even number ends in a point, an odd one in a triangle.
        Domain::Triangles if n.is_multiple_of(2) => 1 + 3 * (n / 2) * (n / 2 + 1),
        Domain::Triangles => 3 * n.div_ceil(2) * n.div_ceil(2),
    }
}

/// Division of a draw's patches into instances on a device.
///
/// A draw of many patches is `vkCmdDraw(k * control_points, instances, 0, first_instance)` with `k` patches an instance:
/// the patch of a vertex is `gl_InstanceIndex * k + gl_VertexIndex / control_points`. Shaders never use
/// `gl_PrimitiveID`, which lavapipe restarts within a draw (lavapipe bug B), so this form serves every device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum PatchBatch {
    /// Any number of patches in one instance.
    Unlimited,
    /// Limits on one instance; at least one patch always goes.
    Limited {
        /// The most tessellation-evaluation vertices.
        max_vertices: u32,
        /// The most control points.
        max_control_points: u32,
        /// Tessellation-evaluation vertices that the processor keeps near while it is at an instance: more are slower.
        near_vertices: u32,
        /// Those up to which two patches go into an instance nevertheless: beyond, clipping by the frustum is slow.
        good_vertices: u32,
    },
}

impl PatchBatch {
    /// **The workaround for lavapipe bugs A and B** (Mesa's llvmpipe driver, seen in 22.3.6): more than 65 536
    /// tessellation-evaluation vertices in an instance give a wrong picture without any error, an instance is cut every
    /// 4096 control points, and clipping costs the square of the patches in an instance.
    pub const LAVAPIPE: Self =
        Self::Limited { max_vertices: 65_535, max_control_points: 4096, near_vertices: 150, good_vertices: 600 };

    /// The rule for a driver.
    pub fn of_driver(driver: vk::DriverId) -> Self {
        if driver == vk::DriverId::MESA_LLVMPIPE { Self::LAVAPIPE } else { Self::Unlimited }
    }

    /// Patches per instance, of `patches`, where one patch has `control_points` control points and at
    /// most `vertices` tessellation-evaluation vertices (see [`tessellated_vertices`]). At least 1.
    pub fn patches_per_instance(self, patches: u32, control_points: u32, vertices: u32) -> u32 {
        let most = match self {
            // The number of vertices of a draw is a u32.
            Self::Unlimited => u32::MAX / control_points.max(1),
            Self::Limited { max_vertices, max_control_points, near_vertices, good_vertices } => {
                let of = |all: u32| all / vertices.max(1);
                of(near_vertices)
                    .max(of(good_vertices).min(2))
                    .max(1)
                    .min(of(max_vertices))
                    .min(max_control_points / control_points.max(1))
            }
        };
        patches.min(most).max(1)
    }

    /// The draws for `patches` patches: one of whole instances, and one for the rest if there is a rest.
    pub fn draws(self, patches: u32, control_points: u32, vertices: u32) -> impl Iterator<Item = PatchDraw> {
        let k = self.patches_per_instance(patches, control_points, vertices);
        let (whole, rest) = (patches / k, patches % k);
        let draw = |patches: u32, instances, first_instance| PatchDraw {
            vertex_count: patches * control_points,
            instance_count: instances,
            first_instance,
            patches_per_instance: k,
        };
        [(whole > 0).then(|| draw(k, whole, 0)), (rest > 0).then(|| draw(rest, 1, whole))].into_iter().flatten()
    }
}

/// One `vkCmdDraw(vertex_count, instance_count, 0, first_instance)`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PatchDraw {
    /// Vertices of an instance: control points of all its patches.
    pub vertex_count: u32,
    /// Instances drawn.
    pub instance_count: u32,
    /// The number of the first.
    pub first_instance: u32,
    /// Multiplier of `gl_InstanceIndex` in the vertex shader; the same in all draws of one call.
    pub patches_per_instance: u32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_round_up() {
        use Spacing::*;
        let segments =
            |spacing: Spacing, levels: &[f32]| levels.iter().map(|&l| spacing.segments(l, 64)).collect::<Vec<_>>();
        let levels = [f32::NAN, 0.5, 1.0, 1.1, 2.0, 2.5, 8.0, 9.0, 63.0, 63.5, 64.0, 99.0, f32::INFINITY];
        assert_eq!(segments(Equal, &levels), [1, 1, 1, 2, 2, 3, 8, 9, 63, 64, 64, 64, 64]);
        assert_eq!(segments(FractionalOdd, &levels), [1, 1, 1, 3, 3, 3, 9, 9, 63, 63, 63, 63, 63]);
        assert_eq!(segments(FractionalEven, &levels), [2, 2, 2, 2, 2, 4, 8, 10, 64, 64, 64, 64, 64]);
    }

    #[test]
    fn vertices_of_a_patch() {
        let count = |domain, spacing, level| tessellated_vertices(domain, spacing, level, 64);
        assert_eq!(count(Domain::Quads, Spacing::Equal, 16.0), 289);
        assert_eq!(count(Domain::Quads, Spacing::Equal, 64.0), 4225);
        assert_eq!(count(Domain::Quads, Spacing::FractionalOdd, 8.0), 100);
        assert_eq!(count(Domain::Quads, Spacing::FractionalEven, 64.0), 4225);
        assert_eq!([1.0, 2.0, 3.0, 4.0].map(|l| count(Domain::Triangles, Spacing::Equal, l)), [3, 7, 12, 19]);
        assert_eq!(count(Domain::Triangles, Spacing::Equal, 64.0), 1 + 3 * 32 * 33);
    }

    #[test]
    fn lavapipe_instances_stay_small() {
        let rule = PatchBatch::of_driver(vk::DriverId::MESA_LLVMPIPE);
        let k = |level: f32, points| {
            let vertices = tessellated_vertices(Domain::Quads, Spacing::Equal, level, 64);
            rule.patches_per_instance(10_000, points, vertices)
        };
        assert_eq!(k(64.0, 4), 1);
        assert_eq!(k(24.0, 4), 1);
        assert_eq!(k(16.0, 4), 2);
        assert_eq!(k(8.0, 4), 2);
        assert_eq!(k(4.0, 4), 6);
        assert_eq!(k(1.0, 4), 37);
        assert_eq!(k(1.0, 128), 32);
        // Limits hold whatever is asked of them.
        for vertices in [1, 3, 4, 9, 289, 4225, 65_535] {
            for points in [1, 3, 4, 16, 32] {
                let k = rule.patches_per_instance(u32::MAX, points, vertices);
                assert!(k >= 1 && k * vertices <= 65_535 && k * points <= 4096, "{vertices} vertices, {points} points");
            }
        }
    }

    #[test]
    fn draws_cover_every_patch_once() {
        for rule in [PatchBatch::LAVAPIPE, PatchBatch::Unlimited] {
            for patches in [0, 1, 2, 3, 74, 75, 76, 1000] {
                let mut seen = Vec::new();
                for draw in rule.draws(patches, 4, 25) {
                    for instance in draw.first_instance..draw.first_instance + draw.instance_count {
                        for vertex in (0..draw.vertex_count).step_by(4) {
                            seen.push(instance * draw.patches_per_instance + vertex / 4);
                        }
                    }
                }
                assert_eq!(seen, (0..patches).collect::<Vec<_>>(), "{rule:?}");
            }
        }
        assert_eq!(PatchBatch::Unlimited.draws(5000, 16, 4225).count(), 1);
    }
}
