//! What vertex shaders read besides tables: vertices that compute evaluated, or control points, for each instance anew.

use crate::renderer::shader::PatchStages;
use crate::table::Sharing;
use ash::vk;

/// Bytes of a vertex: position, normal, and the texture coordinate if there is one. Where the surface is displaced there is one,
/// and after it which way, where in the map, and at which of its levels. GLSL twin: `VERTEX_WORDS` in
/// `glsl/evaluate/uniform_grid.comp`.
pub(crate) fn vertex_bytes(texcoords: bool, sharing: Sharing) -> u32 {
    match (sharing, texcoords) {
        (Sharing::Displacement, _) => 56,
        (_, true) => 32,
        (_, false) => 24,
    }
}

/// What the parts of a vertex are, and where, in the order of their locations: all that are not beyond its end.
const VERTEX_PARTS: [(u32, vk::Format); 5] = [
    (0, vk::Format::R32G32B32_SFLOAT),
    (12, vk::Format::R32G32B32_SFLOAT),
    (24, vk::Format::R32G32_SFLOAT),
    (32, vk::Format::R32G32B32_SFLOAT),
    (44, vk::Format::R32G32B32_SFLOAT),
];

/// What a vertex shader reads of vertices or instances.
#[derive(Default)]
pub(crate) struct VertexInput {
    pub bindings: Vec<vk::VertexInputBindingDescription>,
    pub attributes: Vec<vk::VertexInputAttributeDescription>,
}

impl VertexInput {
    /// Vertices that compute evaluated.
    pub(crate) fn of_vertices(texcoords: bool, sharing: Sharing) -> Self {
        let stride = vertex_bytes(texcoords, sharing);
        let parts = VERTEX_PARTS.into_iter().filter(|(offset, _)| *offset < stride);
        Self::of(vk::VertexInputRate::VERTEX, stride, parts)
    }

    /// Control points of instances.
    pub(crate) fn of_instances(patch: PatchStages) -> Self {
        let parts = patch.attribute_offsets().map(|offset| (offset, vk::Format::R32G32B32A32_SFLOAT));
        Self::of(vk::VertexInputRate::INSTANCE, patch.patch_bytes(), parts)
    }

    /// Of parts at an offset, in the order of their locations.
    fn of(input_rate: vk::VertexInputRate, stride: u32, parts: impl Iterator<Item = (u32, vk::Format)>) -> Self {
        let attributes = (0..).zip(parts).map(|(location, (offset, format))| vk::VertexInputAttributeDescription {
            location,
            binding: 0,
            format,
            offset,
        });
        let bindings = vec![vk::VertexInputBindingDescription { binding: 0, stride, input_rate }];
        Self { bindings, attributes: attributes.collect() }
    }
}
