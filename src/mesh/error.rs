use std::path::PathBuf;

/// Why a control mesh could not be made: what is wrong, where, and what to do about it.
///
/// Face, vertex and corner numbers count from zero; `line` numbers from one. A reader that knows the line of the
/// offending element wraps the error in [`MeshError::AtLine`].
#[allow(missing_docs, reason = "the messages say it")]
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    #[error("the mesh has no {what}: a control mesh needs at least one face")]
    Empty { what: &'static str },
    #[error("vertex {vertex} is at ({}, {}, {}): positions must be finite numbers of at most 3.4e38", position[0], position[1], position[2])]
    NotFinite { vertex: u32, position: [f64; 3] },
    #[error("vertex {vertex} is at ({}, {}, {}): the limit surface needs coordinates up to {max:e}", position[0], position[1], position[2])]
    TooFar { vertex: u32, position: [f64; 3], max: f64 },
    #[error("face {face} has {size} vertices: a face needs at least three")]
    FaceTooSmall { face: u32, size: usize },
    #[error("face {face} names vertex {vertex}, but the mesh has {count} vertices (0 to {})", count - 1)]
    IndexOutOfRange { face: u32, vertex: u32, count: usize },
    #[error("face {face} names vertex {vertex} twice: remove the repeated vertex, or split the face there")]
    RepeatedVertex { face: u32, vertex: u32 },
    #[error("vertex {vertex} belongs to no face: remove it, or read the file with isolated vertices dropped")]
    IsolatedVertex { vertex: u32 },
    #[error(
        "face {face} is the third face at the edge {}-{}: an edge has one or two faces; separate the surfaces there",
        edge[0],
        edge[1]
    )]
    NonManifoldEdge { face: u32, edge: [u32; 2] },
    #[error(
        "faces {other} and {face} both run along the edge {}-{} in the same direction: turn one of them round so that all faces are counter-clockwise from outside",
        edge[0],
        edge[1]
    )]
    InconsistentOrientation { face: u32, other: u32, edge: [u32; 2] },
    #[error("crease {crease} names the edge {}-{}, which is no edge of any face", edge[0], edge[1])]
    NoSuchEdge { crease: usize, edge: [u32; 2] },
    #[error(
        "{what} {index} has sharpness {sharpness}: sharpness is a number from 0 up (10 and more is infinitely sharp)"
    )]
    BadSharpness { what: &'static str, index: usize, sharpness: f32 },
    #[error("sharpness of {given} {what} is given, but the mesh has {needed}")]
    SharpnessCount { what: &'static str, given: usize, needed: usize },
    #[error("corner {corner} names vertex {vertex}, but the mesh has {count} vertices")]
    NoSuchVertex { corner: usize, vertex: u32, count: usize },
    #[error("hole tag names face {face}, but the mesh has {count} faces")]
    NoSuchFace { face: u32, count: usize },
    #[error("edit {edit}: {message}")]
    BadEdit { edit: usize, message: String },
    #[error("{what} are given for {given} face corners, but the mesh has {corners}")]
    CornerCount { what: &'static str, given: usize, corners: usize },
    #[error("corner {corner} names {what} {index}, but there are {count}")]
    CornerIndex { what: &'static str, corner: usize, index: u32, count: usize },
    #[error("{what} {index} is not a finite number")]
    AttributeNotFinite { what: &'static str, index: usize },
    #[error("the mesh has {count} {what}: at most {max} can be addressed")]
    TooLarge { what: &'static str, count: usize, max: usize },

    #[error(
        "the file has {count} {what} or more: at most {max} are read; raise the limit \"{limit}\" if they are meant"
    )]
    BeyondLimit { limit: &'static str, what: &'static str, count: u64, max: u64 },

    #[error("line {line}: {error}")]
    AtLine { line: usize, error: Box<MeshError> },
    #[error("line {line}: {message}")]
    Syntax { line: usize, message: String },
    #[error("{}: {message}", path.display())]
    Unreadable { path: PathBuf, message: String },
    #[error("{}: {error}", path.display())]
    InFile { path: PathBuf, error: Box<MeshError> },
    #[error("{message}")]
    Format { message: String },
    #[error("there is no mesh or node named \"{name}\" in the scene: {known}")]
    UnknownMesh { name: String, known: String },
    #[error("there is no animation \"{name}\": {known}")]
    UnknownAnimation { name: String, known: String },
    #[error("{given} positions are to be filled, but the mesh has {count} vertices")]
    PositionCount { given: usize, count: usize },
    #[error("{seconds} is no time of an animation: it must be a finite number of seconds")]
    BadTime { seconds: f64 },
    #[error("there is no shape named \"{name}\": choose one of {known}")]
    UnknownShape { name: String, known: String },
}

impl MeshError {
    /// The face that is to blame, if one is.
    pub fn face(&self) -> Option<u32> {
        match self {
            Self::FaceTooSmall { face, .. }
            | Self::IndexOutOfRange { face, .. }
            | Self::RepeatedVertex { face, .. }
            | Self::NonManifoldEdge { face, .. }
            | Self::InconsistentOrientation { face, .. } => Some(*face),
            Self::AtLine { error, .. } | Self::InFile { error, .. } => error.face(),
            _ => None,
        }
    }

    /// Puts other numbers of vertices and faces into the error.
    pub(super) fn renumber(&mut self, vertex: impl Fn(u32) -> u32, face: impl Fn(u32) -> u32) {
        let put = |number: &mut u32, of: &dyn Fn(u32) -> u32| *number = of(*number);
        match self {
            Self::NotFinite { vertex: v, .. } | Self::IsolatedVertex { vertex: v } => put(v, &vertex),
            Self::FaceTooSmall { face: f, .. } => put(f, &face),
            Self::RepeatedVertex { face: f, vertex: v } => {
                put(f, &face);
                put(v, &vertex);
            }
            Self::NonManifoldEdge { face: f, edge } => {
                put(f, &face);
                edge.iter_mut().for_each(|v| put(v, &vertex));
            }
            Self::InconsistentOrientation { face: f, other, edge } => {
                put(f, &face);
                put(other, &face);
                edge.iter_mut().for_each(|v| put(v, &vertex));
            }
            Self::NoSuchEdge { edge, .. } => edge.iter_mut().for_each(|v| put(v, &vertex)),
            _ => {}
        }
    }
}

/// A message as long as a message may be: files can hold words of any length.
pub(super) fn shortened(message: String) -> String {
    const HEAD: usize = 400;
    const TAIL: usize = 200;
    // A byte length, so that short messages cost nothing.
    if message.len() <= HEAD + TAIL {
        return message;
    }
    let head: String = message.chars().take(HEAD).collect();
    let tail: Vec<char> = message.chars().rev().take(TAIL).collect();
    let tail: String = tail.iter().rev().collect();
    format!("{head} … {tail}")
}
