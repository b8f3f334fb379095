//! Shadings: the pipeline states and colours of each kind of shading.

use super::parse::Colour;
use ash::vk;
use ash_subdiv::gpu::{Blend, DepthBias, DepthState};
use ash_subdiv::measure::Quantity;
use ash_subdiv::renderer::{Fragment, Geometry};
use ash_subdiv::{DrawItem, Style};
use clap::ValueEnum;

/// Content of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Shading {
    /// The smooth surface in one colour.
    Lit,
    /// The direction of the normal as a colour.
    Normals,
    /// The kinds of patches: regular gold, irregular quads purple, triangles green, pentagons red.
    Patches,
    /// The tessellated triangles as lines over the surface.
    Wireframe,
    /// The edges of the control mesh as lines around the surface.
    Cage,
    /// The control mesh itself: its faces flat, and its edges.
    ControlMesh,
    /// The distance from the exact surface, at the same parameters, as a colour with a legend.
    ErrorPosition,
    /// The angle to the normal of the exact surface, as a colour with a legend.
    ErrorNormal,
    /// The leaves of --adaptive by level and kind, with a legend: light where a crease is followed, dark at end caps.
    Levels,
    /// Stripes that the surface reflects: they are as smooth as its normals are.
    ReflectionLines,
}

/// The program's own shaders.
mod shaders {
    #![allow(dead_code, reason = "their list is for the library")]
    include!(concat!(env!("OUT_DIR"), "/cli_shaders.rs"));
}

const CLAY: Colour = Colour::rgb(0xddd3c6);
/// Regular patches, irregular quads, triangles, pentagons.
const KINDS: [Colour; 4] = [Colour::rgb(0xe3b448), Colour::rgb(0x8a63b8), Colour::rgb(0x5aa469), Colour::rgb(0xc8553d)];
const WIRE: Colour = Colour([0x1c, 0x20, 0x28, 110]);
const CAGE: Colour = Colour::rgb(0x1f5fae);
/// Where it runs inside the surface or behind it.
const HIDDEN_CAGE: Colour = Colour([0x1f, 0x5f, 0xae, 56]);
const EDGES: Colour = Colour::rgb(0x2a2d33);

/// One style and the colours it is drawn in, by kind of patch.
struct Layer {
    style: Style,
    colours: [Colour; 4],
}

impl Layer {
    fn surface(fragment: Fragment, colours: [Colour; 4]) -> Self {
        Self { style: Style { fragment, ..Style::default() }, colours }
    }

    fn lines(style: Style, colour: Colour) -> Self {
        Self { style: Style { blend: Blend::Alpha, ..style }, colours: [colour; 4] }
    }
}

impl Shading {
    /// Whether the control mesh is seen, and not only the surface.
    pub(super) fn shows_control_mesh(self) -> bool {
        matches!(self, Self::Cage | Self::ControlMesh)
    }

    /// The error that is shown.
    pub(super) fn quantity(self) -> Option<Quantity> {
        match self {
            Self::ErrorPosition => Some(Quantity::Position),
            Self::ErrorNormal => Some(Quantity::Normal),
            _ => None,
        }
    }

    /// Whether there is a map that is painted on the surface, with a legend.
    pub(super) fn is_painted(self) -> bool {
        self.quantity().is_some() || self == Self::Levels
    }

    /// Whether vertices with normals are all that is drawn.
    pub(super) fn is_of_vertices(self) -> bool {
        matches!(self, Self::Lit | Self::Normals | Self::Wireframe | Self::ReflectionLines)
    }

    pub(super) fn name(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }

    /// Format that stores colours. Normals are numbers, not light: they are stored as they are.
    pub(super) fn format(self) -> vk::Format {
        if self == Self::Normals { vk::Format::R8G8B8A8_UNORM } else { vk::Format::R8G8B8A8_SRGB }
    }

    /// Layers, one over the other.
    fn layers(self, displaced: bool) -> Vec<Layer> {
        let lit = |colours| Layer::surface(Fragment::Lit, colours);
        let own = |shader: &[u32]| vec![Layer::surface(Fragment::Spirv(shader.to_vec()), [CLAY; 4])];
        match self {
            Self::Lit => vec![lit([CLAY; 4])],
            Self::Normals => vec![Layer::surface(Fragment::Normals, [CLAY; 4])],
            Self::Patches => vec![lit(KINDS)],
            Self::Wireframe => vec![lit([CLAY; 4]), Layer::lines(Style::wireframe(), WIRE)],
            Self::Cage => {
                let cage = Style { depth: Some(DepthState::LESS_OR_EQUAL), ..Style::cage() };
                vec![lit([CLAY; 4]), Layer::lines(Style::cage(), HIDDEN_CAGE), Layer::lines(cage, CAGE)]
            }
            Self::ControlMesh => {
                let faces = Style {
                    geometry: Geometry::ControlFaces,
                    // Behind the edges, which bias does not move: they are lines.
                    depth_bias: Some(DepthBias { constant: 4.0, slope: 2.0 }),
                    ..Style::default()
                };
                let edges = Style { depth: Some(DepthState::LESS_OR_EQUAL), ..Style::cage() };
                vec![Layer { style: faces, colours: [CLAY; 4] }, Layer::lines(edges, EDGES)]
            }
            Self::ErrorPosition | Self::ErrorNormal => own(shaders::ERROR_FRAG),
            Self::Levels => own(shaders::LEVELS_FRAG),
            Self::ReflectionLines if displaced => own(shaders::REFLECTION_LINES_FRAG_DISPLACED),
            Self::ReflectionLines => own(shaders::REFLECTION_LINES_FRAG),
        }
    }

    /// The styles of the layers.
    pub(super) fn styles(self, displaced: bool) -> Vec<Style> {
        self.layers(displaced).into_iter().map(|layer| layer.style).collect()
    }

    /// The colour of each layer, where there are no kinds of patches.
    pub(super) fn colours(self) -> Vec<[f32; 4]> {
        self.layers(false).into_iter().map(|layer| layer.colours[0].linear()).collect()
    }

    /// A draw for each layer, in order, else like this one.
    pub(super) fn draws(self, item: DrawItem) -> Vec<DrawItem> {
        let draw =
            |(style, layer): (usize, Layer)| DrawItem { style, colors: layer.colours.map(Colour::linear), ..item };
        self.layers(false).into_iter().enumerate().map(draw).collect()
    }
}
