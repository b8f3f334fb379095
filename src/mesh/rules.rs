//! The rules of subdivision that a mesh may choose, and what other packages choose.

use crate::named::named;

named! {
    /// Rule of the surface at boundaries.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum BoundaryRule {
        /// Faces that touch the boundary shape the surface but are not drawn.
        None = "none",
        /// Boundary edges are infinitely sharp: the surface ends in a B-spline curve.
        EdgeOnly = "edge-only",
        /// As [`BoundaryRule::EdgeOnly`]; boundary vertices with one face are interpolated.
        #[default]
        EdgeAndCorner = "edge-and-corner",
    }
}

/// How semi-sharp creases lose sharpness when they are subdivided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CreaseMethod {
    /// One less on every level.
    #[default]
    Uniform,
    /// Mixed with the neighbours along the crease (Chaikin's rule), then one less.
    Chaikin,
}

/// The weights of triangles under subdivision.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TriangleRule {
    /// Catmull and Clark's rule for every face.
    #[default]
    CatmullClark,
    /// OpenSubdiv's smoother edge points next to triangles.
    Smooth,
}

named! {
    /// Where face-varying data is interpolated linearly (OpenSubdiv's six rules): which values stay where they are, apart
    /// from those at vertices that stay themselves. Seams (edges where two faces disagree) and boundaries are otherwise
    /// smooth curves.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum FaceVaryingRule {
        /// Smooth everywhere.
        None = "none",
        /// Smooth inside and along seams; linear at the corners of regions.
        CornersOnly = "corners-only",
        /// As `CornersOnly`, and linear where three or more regions meet.
        CornersPlus1 = "corners-plus1",
        /// As `CornersPlus1`, and linear at darts and concave corners.
        CornersPlus2 = "corners-plus2",
        /// Linear along every seam and boundary.
        Boundaries = "boundaries",
        /// Linear everywhere.
        #[default]
        All = "all",
    }
}

named! {
    /// A package, by the rules that a mesh has there if nobody chooses others.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[non_exhaustive]
    pub enum Package {
        /// The Subdivision Surface modifier: smooth boundaries with their corners, texture coordinates that keep boundaries.
        ///
        /// Blender's Python API, `SubsurfModifier`: `boundary_smooth` is `ALL`, `uv_smooth` `PRESERVE_BOUNDARIES`.
        Blender = "blender",
        /// Smooth Mesh Preview and Mesh > Smooth by OpenSubdiv: sharp corners, texture coordinates that keep boundaries.
        ///
        /// Autodesk's help on the node `polySmoothFace`: Vertex Boundary is by default Sharp edges and corners; `osdFvarBoundary` is 3
        /// in a new node, the "Maya smooth internal only" of Pixar's page on `osdPolySmooth`.
        Maya = "maya",
        /// Meshes from USD and from the bridges to other packages: sharp corners, texture coordinates linear at corners and where three
        /// regions meet. RIB without an `interpolateboundary` tag has no boundaries at all instead.
        ///
        /// RenderMan's wiki, Subdivision Surfaces, has 0 as the renderer's own default and 1 as that of the bridges; the rule for texture
        /// coordinates, which a site may set, is that of USD's `UsdGeomMesh` (`faceVaryingLinearInterpolation`, `cornersPlus1`).
        Renderman = "renderman",
        /// Texture coordinates linear at corners. What boundaries do is not documented: they are left as the mesh has them.
        ///
        /// `kick -info polymesh`: `subdiv_uv_smoothing` is `pin_corners`.
        Arnold = "arnold",
        /// Geometry drawn as OpenSubdiv: sharp corners, texture coordinates that keep boundaries.
        ///
        /// Object parameters: `vm_osd_vtxinterp` is 2, Edges and Corners, and `vm_osd_fvarinterp` 4, Sharpen all boundaries.
        Houdini = "houdini",
        /// The library's own: faces at boundaries are not drawn, texture coordinates are linear.
        ///
        /// `opensubdiv/sdc/options.h`: the constructor of `Options` has `VTX_BOUNDARY_NONE` and `FVAR_LINEAR_ALL`.
        OpenSubdiv = "opensubdiv",
    }
}

impl Package {
    /// Rule of the surface at boundaries; `None` where it is not documented.
    pub fn boundary(self) -> Option<BoundaryRule> {
        match self {
            Self::Blender => Some(BoundaryRule::EdgeOnly),
            Self::Maya | Self::Renderman | Self::Houdini => Some(BoundaryRule::EdgeAndCorner),
            Self::Arnold => None,
            Self::OpenSubdiv => Some(BoundaryRule::None),
        }
    }

    /// How texture coordinates are refined.
    pub fn face_varying(self) -> FaceVaryingRule {
        match self {
            Self::Blender | Self::Maya | Self::Houdini => FaceVaryingRule::Boundaries,
            Self::Renderman => FaceVaryingRule::CornersPlus1,
            Self::Arnold => FaceVaryingRule::CornersOnly,
            Self::OpenSubdiv => FaceVaryingRule::All,
        }
    }
}
