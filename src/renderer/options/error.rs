use super::displacement::DisplacementId;
use super::id::ModelId;
use super::instances::INSTANCES;
use crate::gpu::GpuError;
use crate::mesh::MeshError;
use crate::table::TableError;
use crate::table::{Construction, Evaluation};
use crate::tessellator::Factor;
use ash::vk;

/// What can go wrong in the renderer.
#[allow(missing_docs, reason = "the messages say it")]
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    #[error(transparent)]
    Mesh(#[from] MeshError),
    #[error(transparent)]
    Table(#[from] TableError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error("{device}: missing {}: choose another device, or options that need less", missing.join(", "))]
    Unsupported { device: String, missing: Vec<String> },
    #[error("model {}: there is no such model: it was removed, or is another renderer's", id.number)]
    NoSuchModel { id: ModelId },
    #[error("displacement map {}: this renderer does not know it, or was told to forget it: call add_displacement first", id.0)]
    NoSuchDisplacement { id: DisplacementId },
    #[error("displacement map {}: model {} uses it: remove that first", id.0, model.number)]
    DisplacementInUse { id: DisplacementId, model: ModelId },
    #[error("model {}: {given} positions are given, but its control mesh has {needed} vertices", id.number)]
    PositionCount { id: ModelId, given: usize, needed: usize },
    #[error("model {}: its positions are given by the host and by the device in one frame: give one of them", id.number)]
    PositionsTwice { id: ModelId },
    #[error("model {}: DevicePositions::buffer is null: give the buffer that your shader writes, or ask for one by device_positions", id.number)]
    NoPositionBuffer { id: ModelId },
    #[error("model {}: DevicePositions: the offset {offset} and the stride {stride} are in bytes, multiples of 4, the stride from 12 up", id.number)]
    BadPositionLayout { id: ModelId, offset: u64, stride: u32 },
    #[error("model {}: DevicePositions: the buffer has {size} bytes, but its positions end after {needed}", id.number)]
    PositionBufferTooSmall { id: ModelId, size: u64, needed: u64 },
    #[error("model {}: its mesh is refined before patches are made, by the host: set ModelOptions::refine_on_device when you add it", id.number)]
    RefinedOnHost { id: ModelId },
    #[error("model {}: {} take {bytes} bytes, but a shader can see {max} at once on this device: {}", id.number, table.replace('_', " "), smaller(table))]
    TableTooLarge { id: ModelId, table: &'static str, bytes: u64, max: u64 },
    #[error("model {}: it was not yet prepared: record cmd_prepare after add_model and set_segments, and before cmd_draw", id.number)]
    NotPrepared { id: ModelId },
    #[error(
        "the frame is over: another one began since, it was lost, or it is another renderer's: name what begin_frame gave last"
    )]
    OldFrame,
    #[error("the frame was not prepared: record cmd_prepare before cmd_draw and cmd_cull, outside rendering")]
    FrameNotPrepared,
    #[error("{max} views were already drawn or culled in the frame: raise Options::views_per_frame")]
    TooManyViews { max: u32 },
    #[error(
        "Options: frames_in_flight times views_per_frame take {bytes} bytes for views, {max} are possible: ask for fewer"
    )]
    ViewsTooLarge { bytes: u64, max: u64 },
    #[error(
        "what can be seen was found in another frame, or by another renderer: call cmd_cull, and draw in the same frame"
    )]
    OtherFrame,
    #[error(
        "cmd_cull goes with Options::visible_lists only: set it, and make the device with what requirements lists then"
    )]
    NoVisibleLists,
    #[error("lists of patches that can be seen take {bytes} bytes in a frame, {max} at most: draw fewer items")]
    ListsTooLarge { bytes: u64, max: u64 },
    #[error("{given} items are drawn in a frame, {max} at most: draw fewer")]
    TooManyItems { given: u64, max: u64 },
    #[error("model {}: the buffer of its instances is null: give yours, or take Renderer::instances", id.number)]
    NoInstanceBuffer { id: ModelId },
    #[error("model {}: Instances: the offset {offset} and the stride {stride} are in bytes, multiples of 4, the stride from 80 up", id.number)]
    BadInstanceLayout { id: ModelId, offset: u64, stride: u32 },
    #[error("model {}: Instances: the buffer has {size} bytes, but its instances end after {needed}", id.number)]
    InstanceBufferTooSmall { id: ModelId, size: u64, needed: u64 },
    #[error("{given} instances are given at once, {max} at most on this device: give them in parts, each for an item")]
    TooManyInstances { given: usize, max: u64 },
    #[error("model {}: cmd_cull makes no lists of instances: draw them by cmd_draw, whose control shaders cull by DrawItem::cull, too", id.number)]
    CulledInstances { id: ModelId },
    #[error("style {given}: Options::styles has {count}")]
    NoSuchStyle { given: usize, count: usize },
    #[error("model {}: {factor:?}: a tessellation factor is a number from 1 up, pixels and scales are above 0", id.number)]
    BadFactor { id: ModelId, factor: Factor },
    #[error("model {}: factors in pixels and leaving out small patches need the size of the viewport: set View::viewport", id.number)]
    NoViewport { id: ModelId },
    #[error("deviations on the screen need its size in pixels: set View::viewport")]
    NoScreen,
    #[error("model {}: its edges have no factors: set ModelOptions::edge_factors when you add it, or draw with another Factor", id.number)]
    NoEdgeFactors { id: ModelId },
    #[error("model {}: {given} factors are given, but its patches have {needed} edges", id.number)]
    EdgeFactorCount { id: ModelId, given: usize, needed: usize },
    #[error("model {}: edge {edge}: the factor {factor} is no number", id.number)]
    BadEdgeFactor { id: ModelId, edge: usize, factor: f32 },
    #[error("model {}: displacement by {scale} and {bias} is not by finite numbers", id.number)]
    BadDisplacement { id: ModelId, scale: f32, bias: f32 },
    #[error("model {}: Evaluation::{evaluation:?} does not go with {what}: do without, or choose Evaluation::Tessellation", id.number)]
    NotEvaluatedBy { id: ModelId, evaluation: Evaluation, what: &'static str },
    #[error("model {}: Evaluation::{evaluation:?} goes with Construction::{}, not with {construction:?}", id.number, constructions(*evaluation))]
    NotConstructedBy { id: ModelId, evaluation: Evaluation, construction: Construction },
    #[error("model {}: its tables were built for Evaluation::{built:?}, not for {evaluation:?}: build them with the same options", id.number)]
    OtherTables { id: ModelId, built: Evaluation, evaluation: Evaluation },
    #[error("model {}: its tables were built {} ModelOptions::{option}, unlike its options: build them with the same options", id.number, if *built { "with" } else { "without" })]
    OtherOption { id: ModelId, option: &'static str, built: bool },
    #[error("model {}: Evaluation::{evaluation:?} needs {}: name it in Options::evaluations and make the device with what requirements lists then, or choose another evaluation", id.number, missing.join(" and "))]
    EvaluationNeeds { id: ModelId, evaluation: Evaluation, missing: Vec<&'static str> },
    #[error("model {}: {factor:?}: Evaluation::{evaluation:?} has one factor for all edges: draw with a uniform one", id.number)]
    NotUniform { id: ModelId, evaluation: Evaluation, factor: Factor },
    #[error("model {}: {factor:?}: Evaluation::{evaluation:?} with edges that have factors of their own takes these as they are: draw with Factor::Edges(1.0)", id.number)]
    NotOfEdges { id: ModelId, evaluation: Evaluation, factor: Factor },
    #[error("model {}: {factor:?}: subdivision has uniform factors of 1, 2, 4 and 8, for levels 0 to 3", id.number)]
    NoSuchLevel { id: ModelId, factor: Factor },
    #[error("model {}: Evaluation::{evaluation:?} takes its segments from DrawItem::factor: set_segments and Factor::Segments are for others", id.number)]
    NoSegments { id: ModelId, evaluation: Evaluation },
    #[error("model {}: no vertices of it are kept: set ModelOptions::evaluation to Compute", id.number)]
    NotComputed { id: ModelId },
    #[error("model {}: {given} segments: from 1 to {max} are possible along an edge", id.number)]
    BadSegments { id: ModelId, given: u32, max: u32 },
    #[error("model {}: {factor:?}: Evaluation::{evaluation:?} has the segments of set_segments: draw with Factor::Segments", id.number)]
    OwnSegments { id: ModelId, evaluation: Evaluation, factor: Factor },
    #[error("model {}: no segments are set: call set_segments before cmd_prepare", id.number)]
    SegmentsNotSet { id: ModelId },
    #[error("model {}: its edges have {segments} segments now, unlike when it was culled: call set_segments before cmd_prepare and cmd_cull", id.number)]
    OtherSegments { id: ModelId, segments: u32 },
    #[error("grid {given}: the tessellator of this device makes from 2 to {max} samples along a side")]
    BadGrid { given: u32, max: u32 },
    #[error("Options::shaders: {name}: fragment shaders are those of styles: set Style::fragment to Fragment::Spirv")]
    ShaderOfStyle { name: &'static str },
    #[error(
        "{what} is no SPIR-V: give whole modules, as words in this machine's order of bytes (the first is 0x07230203)"
    )]
    NotSpirv { what: String },
    #[error("{what} has no entry point `main` of its stage: compile it for that, and call its function main")]
    OtherStage { what: String },
    #[error(
        "{what}: the pipeline's layout has no such descriptor at set {set}, binding {binding}: sets 0 and 1 are the crate's, sets from 2 on those of Options::set_layouts"
    )]
    OtherBinding { what: String, set: u32, binding: u32 },
    #[error(
        "Target: {format:?} is given as the format of the {attachment} attachment, which it cannot be: name formats in the order of Pass::Dynamic"
    )]
    BadFormat { format: vk::Format, attachment: &'static str },
    #[error("Target::depth is {depth}, but Pass::Dynamic has {} format of a depth attachment: have both, or none", if *depth { "no" } else { "the" })]
    OtherDepth { depth: bool },
    #[error("Pass::RenderPass has a null render pass: give the one that is drawn in")]
    NoRenderPass,
    #[error("Target::samples is {}: give one number of samples, such as TYPE_1", if given.is_empty() { "empty".into() } else { format!("{given:?}") })]
    BadSamples { given: vk::SampleCountFlags },
    #[error("{what} of Options is {given}: it must be at least 1")]
    BadOption { what: &'static str, given: u32 },
}

/// The table that grows with segments.
pub(crate) const EVALUATED_VERTICES: &str = "evaluated vertices";

fn smaller(table: &str) -> &'static str {
    match table {
        EVALUATED_VERTICES => "have fewer segments, or split the mesh",
        INSTANCES => "draw them as several items",
        _ => "split the mesh",
    }
}

fn constructions(evaluation: Evaluation) -> String {
    let names: Vec<String> = evaluation.constructions().iter().map(|c| format!("{c:?}")).collect();
    names.join(" and ")
}
