//! What pipelines of draws are made of, but for the style.

use super::vertex_input::VertexInput;
use crate::gpu::{DeviceProperties, GpuError, Shader, Spacing, Specialization};
use crate::renderer::shader::{Capture, ShaderCode, ShaderKey, Source, reads_texels, spaced, without_instances};
use ash::vk;

/// A shader, with its constants.
pub(crate) struct RecipeStage {
    pub key: ShaderKey,
    pub constants: Vec<Specialization>,
    /// The spacing, of a tessellation evaluation shader.
    pub spacing: Spacing,
}

impl RecipeStage {
    pub(crate) fn new(key: ShaderKey, constants: &[Specialization]) -> Self {
        Self { key, constants: constants.to_vec(), spacing: Spacing::Equal }
    }

    /// The SPIR-V.
    ///
    /// # Errors
    /// As [`ShaderCode::find`].
    pub(crate) fn code(&self, shaders: &ShaderCode) -> Result<Vec<u32>, GpuError> {
        let code = shaders.find(self.key)?;
        Ok(if self.spacing == Spacing::Equal { code.to_vec() } else { spaced(code, self.spacing) })
    }

    /// The SPIR-V for draws that are not of instances; `is_last` if rasterization follows.
    ///
    /// # Errors
    /// As [`ShaderCode::find`].
    pub(crate) fn code_of_one(&self, shaders: &ShaderCode, is_last: bool) -> Result<Vec<u32>, GpuError> {
        let code = self.code(shaders)?;
        Ok(without_instances(&code, self.shader(&code, &[]).stage, is_last))
    }

    /// Its constants, and one more.
    pub(crate) fn with(&self, constant: Specialization) -> Vec<Specialization> {
        self.constants.iter().copied().chain([constant]).collect()
    }

    /// The shader with its SPIR-V and constants.
    pub(crate) fn shader<'s>(&self, code: &'s [u32], constants: &'s [Specialization]) -> Shader<'s> {
        let shader = match self.key.source.stage() {
            "tesc" => Shader::tess_control(code),
            "tese" => Shader::tess_evaluation(code),
            "geom" => Shader::geometry(code),
            _ => Shader::vertex(code),
        };
        shader.specialized(constants)
    }
}

/// A pipeline, but for the style.
pub(crate) struct Recipe {
    /// The debug name.
    pub name: String,
    /// The stages before the fragment shader.
    pub stages: Vec<RecipeStage>,
    /// Control points that go into a control shader, or 0.
    pub input_points: u32,
    pub topology: vk::PrimitiveTopology,
    /// Whether draws set the topology.
    pub topology_is_dynamic: bool,
    pub input: VertexInput,
    /// Whether the fragment shader has to displace normals.
    pub displaced: bool,
}

impl Recipe {
    /// Triangles of some stages.
    pub(crate) fn new(name: impl Into<String>, stages: Vec<RecipeStage>) -> Self {
        Self {
            name: name.into(),
            stages,
            input_points: 0,
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            topology_is_dynamic: false,
            input: VertexInput::default(),
            displaced: false,
        }
    }

    /// The control mesh: its vertices as they are.
    pub(crate) fn control_mesh(made_for: &MadeFor, topology: vk::PrimitiveTopology) -> Self {
        let vertex = RecipeStage::new(ShaderKey::of(Source::ControlMeshVert), &[reads_texels(made_for.properties)]);
        Self { topology, ..Self::new("control mesh", vec![vertex]) }
    }
}

/// What recipes depend on, of a renderer.
#[derive(Clone, Copy)]
pub(crate) struct MadeFor<'r> {
    pub properties: &'r DeviceProperties,
    pub capture: Capture,
    /// Whether the fragment stage gets texture coordinates.
    pub texcoords: bool,
}
