//! Golden pictures of every built-in shape, every style and every scheme, with both constructions against the same picture.
//!
//! Compared on the drivers of [`golden::DRIVERS`]; elsewhere the tests fail, unless told `GOLDENS=skip`. `UPDATE_GOLDENS=1`
//! rewrites the pictures.
#![cfg(feature = "png")]

mod studio;

use crate::common;
use crate::common::golden;
use ash::vk;
use ash_subdiv::adaptive::{AdaptiveOptions, DrawnBy};
use ash_subdiv::glam::{DVec3, Vec3};
use ash_subdiv::gpu::{Blend, DepthBias, DepthState};
use ash_subdiv::mesh::Crease;
use ash_subdiv::renderer::{Evaluation, Factor, Fragment, Geometry};
use ash_subdiv::{Construction, ControlMesh, MeshData, Scheme, Spacing, Style, View, shape, shapes};
use studio::{Studio, draw_in_pass};

const SIDE: u32 = 192;
const EXTENT: vk::Extent2D = vk::Extent2D { width: SIDE, height: SIDE };
const PAPER: [f32; 4] = [0.8, 0.8, 0.8, 1.0];
const CLAY: [f32; 4] = [0.7, 0.6, 0.5, 1.0];
const INK: [f32; 4] = [0.02, 0.03, 0.1, 0.6];

/// One thing drawn over the other: styles and the colors of the kinds of patches.
#[derive(Clone)]
struct Layer {
    style: Style,
    colors: [[f32; 4]; 4],
}

fn surface(fragment: Fragment) -> Layer {
    Layer { style: Style { fragment, ..Style::default() }, colors: [CLAY; 4] }
}

fn lines(style: Style) -> Layer {
    Layer { style: Style { blend: Blend::Alpha, ..style }, colors: [INK; 4] }
}

/// Opaque lines: the constructions draw patches in different orders, and an edge of two triangles is drawn twice.
fn wire() -> Vec<Layer> {
    let wire = Layer { style: Style::wireframe(), colors: [[0.02, 0.03, 0.1, 1.0]; 4] };
    vec![surface(Fragment::Lit), wire]
}

#[derive(Clone)]
pub struct Picture {
    pub name: String,
    shape: &'static str,
    layers: Vec<Layer>,
    samples: vk::SampleCountFlags,
    format: vk::Format,
    clear: [f32; 4],
    scheme: Scheme,
    /// What the picture shows of the shape: all, or this much around a vertex of the highest valence.
    around: Option<f32>,
    factor: Factor,
    spacing: Spacing,
    /// By the built-in height map, this part of the diagonal.
    displacement: Option<f32>,
    evaluation: Evaluation,
    /// Of patches on uniform grids, which the tessellator draws otherwise.
    of_uniform_grid: bool,
    /// Of an adaptive surface.
    adaptive: Option<AdaptiveOptions>,
    /// Seen from behind: what is left out when it is seen from the front.
    culled: bool,
}

impl Picture {
    fn lit(shape: &'static str) -> Self {
        Self {
            name: format!("lit-{shape}"),
            shape,
            layers: vec![surface(Fragment::Lit)],
            samples: vk::SampleCountFlags::TYPE_1,
            format: vk::Format::R8G8B8A8_SRGB,
            clear: PAPER,
            scheme: Scheme::Gregory,
            around: None,
            factor: Factor::Uniform(6.0),
            spacing: Spacing::Equal,
            displacement: None,
            evaluation: Evaluation::Tessellation,
            of_uniform_grid: false,
            adaptive: None,
            culled: false,
        }
    }

    /// An adaptive surface.
    fn of_leaves(shape: &'static str, depth: u32, factor: f32) -> Self {
        let (name, factor) = (format!("leaves-{shape}"), Factor::Uniform(factor));
        let adaptive = Some(AdaptiveOptions { depth, ..AdaptiveOptions::default() });
        Self { name, adaptive, factor, ..Self::lit(shape) }
    }

    fn by_leaves(self) -> Self {
        let adaptive = self.adaptive.map(|adaptive| AdaptiveOptions { drawn_by: DrawnBy::Leaves, ..adaptive });
        Self { adaptive, ..self }
    }

    /// Normals, in which schemes differ most.
    fn of_scheme(scheme: Scheme, shape: &'static str, around: Option<f32>) -> Self {
        Self {
            name: format!("scheme-{}-{shape}", scheme.name()),
            layers: vec![surface(Fragment::Normals)],
            format: vk::Format::R8G8B8A8_UNORM,
            scheme,
            around,
            ..Self::lit(shape)
        }
    }

    /// Faces that are subdivided, without patches.
    fn subdivided(name: &str, shape: &'static str, factor: f32) -> Self {
        let factor = Factor::Uniform(factor);
        Self { name: name.into(), evaluation: Evaluation::Subdivision, factor, ..Self::lit(shape) }
    }

    pub fn has_lines(&self) -> bool {
        self.layers.iter().any(|layer| layer.style.wireframe || layer.style.geometry == Geometry::ControlEdges)
    }

    /// A shape with all three kinds of patches.
    fn of_style(name: &str, layers: Vec<Layer>) -> Self {
        Self { name: format!("style-{name}"), layers, ..Self::lit("creature-mixed") }
    }
}

// Longer than a screen: a list.
pub fn pictures() -> Vec<Picture> {
    let mut pictures: Vec<Picture> = shapes().iter().map(|info| Picture::lit(info.name)).collect();
    let kinds = [[0.9, 0.5, 0.05, 1.0], [0.25, 0.1, 0.5, 1.0], [0.05, 0.4, 0.1, 1.0], [0.5, 0.05, 0.05, 1.0]];
    let faces = Style {
        geometry: Geometry::ControlFaces,
        // Behind the edges, which are lines and so not moved.
        depth_bias: Some(DepthBias { constant: 4.0, slope: 2.0 }),
        ..Style::default()
    };
    let edges = Style { depth: Some(DepthState::LESS_OR_EQUAL), ..Style::cage() };
    pictures.extend([
        Picture {
            format: vk::Format::R8G8B8A8_UNORM,
            ..Picture::of_style("normals", vec![surface(Fragment::Normals)])
        },
        Picture::of_style("patches", vec![Layer { colors: kinds, ..surface(Fragment::Lit) }]),
        Picture::of_style("flat", vec![Layer { colors: kinds, ..surface(Fragment::Flat) }]),
        // Opaque lines: the constructions draw patches in different orders, and an edge of two triangles is drawn twice.
        // Of quads and of triangles.
        Picture { layers: wire(), name: "wireframe-cube".into(), ..Picture::lit("cube") },
        Picture { layers: wire(), name: "wireframe-fan".into(), ..Picture::lit("fan") },
        Picture::of_style("cage", vec![surface(Fragment::Lit), lines(Style::cage())]),
        Picture::of_style("control-mesh", vec![Layer { style: faces, colors: [CLAY; 4] }, lines(edges)]),
        Picture { name: "samples-4".into(), samples: vk::SampleCountFlags::TYPE_4, ..Picture::lit("machine-part") },
        Picture {
            name: "displaced-creature".into(),
            displacement: Some(0.012),
            factor: Factor::Uniform(12.0),
            ..Picture::lit("creature")
        },
        // Pieces of the atlas end here: the pattern breaks off, the surface does not.
        Picture {
            name: "displaced-seams".into(),
            displacement: Some(0.012),
            factor: Factor::Uniform(24.0),
            around: Some(0.08),
            ..Picture::lit("creature")
        },
        Picture {
            name: "adaptive".into(),
            layers: wire(),
            factor: Factor::Curvature(1.5),
            spacing: Spacing::FractionalOdd,
            around: Some(0.25),
            ..Picture::lit("creature-mixed")
        },
        Picture { name: "culled".into(), culled: true, ..Picture::lit("creature") },
        // No finite sharpness is rounded.
        Picture::subdivided("subdivided-semi-sharp", "semi-sharp", 8.0),
        Picture { layers: wire(), ..Picture::subdivided("subdivided-wireframe", "cube", 4.0) },
        Picture { around: Some(0.25), ..Picture::subdivided("subdivided-creature-mixed", "creature-mixed", 4.0) },
        // Creases of every sharpness, as they were authored.
        Picture::of_leaves("semi-sharp", 5, 24.0),
        Picture::of_leaves("ridges", 0, 12.0),
        Picture::of_leaves("sharpness", 8, 16.0),
        // Cracks would show the paper through a closed surface.
        Picture { displacement: Some(0.012), around: Some(0.25), ..Picture::of_leaves("creature", 3, 12.0) },
        Picture {
            layers: vec![surface(Fragment::Normals)],
            format: vk::Format::R8G8B8A8_UNORM,
            around: Some(0.15),
            ..Picture::of_leaves("valences", 5, 32.0)
        },
        // Leaves beside finer ones are fans.
        Picture { name: "by-leaves-wires".into(), layers: wire(), ..Picture::of_leaves("cube", 3, 8.0).by_leaves() },
        Picture {
            name: "by-leaves-creature".into(),
            displacement: Some(0.012),
            around: Some(0.25),
            factor: Factor::Curvature(1.0),
            spacing: Spacing::FractionalOdd,
            ..Picture::of_leaves("creature", 3, 12.0).by_leaves()
        },
        Picture { name: "transparent".into(), clear: [0.0; 4], ..Picture::lit("cloth") },
        Picture::of_scheme(Scheme::GregoryFitted, "creature-mixed", Some(0.2)),
        Picture::of_scheme(Scheme::Acc, "cube", None),
        Picture::of_scheme(Scheme::Pm, "valences", Some(0.15)),
        Picture::of_scheme(Scheme::Pm, "creature-mixed", None),
        Picture::of_scheme(Scheme::CPatch, "creature", Some(0.2)),
        Picture::of_scheme(Scheme::Pm, "pentagons", None),
        Picture { layers: wire(), name: "wireframe-pentagons".into(), scheme: Scheme::Pm, ..Picture::lit("pentagons") },
        Picture { of_uniform_grid: true, name: "uniform-grid-fan".into(), layers: wire(), ..Picture::lit("fan") },
        Picture {
            of_uniform_grid: true,
            name: "uniform-grid-polygons".into(),
            layers: wire(),
            factor: Factor::Uniform(2.0),
            ..Picture::lit("polygons")
        },
        Picture {
            of_uniform_grid: true,
            name: "uniform-grid-pentagons".into(),
            layers: wire(),
            scheme: Scheme::Pm,
            ..Picture::lit("pentagons")
        },
        // Its triangles fall back to Gregory patches.
        Picture::of_scheme(Scheme::Acc, "creature-mixed", Some(0.15)),
    ]);
    pictures
}

/// A vertex of the highest valence there is.
fn extraordinary_vertex(mesh: &ControlMesh) -> DVec3 {
    let mut valences = vec![0; mesh.vertex_count()];
    mesh.data().face_vertices.iter().for_each(|&v| valences[v as usize] += 1);
    let vertex = (0..valences.len()).max_by_key(|&v| valences[v]).expect("a vertex");
    mesh.position(vertex as u32)
}

/// A cube whose edges are sharp to one level, two and for ever.
fn semi_sharp() -> ControlMesh {
    let mut data = shape("cube").expect("built in").into_data();
    let top = data.face_vertices[..4].to_vec();
    let sharpness = [1.0, 2.0, 1.5, 10.0];
    let edge = |(k, sharpness)| Crease { vertices: [top[k], top[(k + 1) % 4]], sharpness };
    data.creases = sharpness.into_iter().enumerate().map(edge).collect();
    ControlMesh::new(data).expect("tags only")
}

/// Four ridges, each sharper than the one behind it: 0, 0.9, 1.8, 2.7.
fn ridges() -> ControlMesh {
    let mut data = MeshData::default();
    let (across, along) = (7, 5);
    for ridge in 0..4 {
        let first = data.positions.len() as u32;
        let vertex = |i: u32, j: u32| first + j * across + i;
        for (j, i) in (0..along).flat_map(|j| (0..across).map(move |i| (j, i))) {
            let height = if i == across / 2 { 4.0 } else { 0.0 };
            let (i, j) = (f64::from(i), f64::from(j));
            data.positions.push([1.2 * i + 2.0 * f64::from(ridge), height, -j + 4.5 * f64::from(ridge)]);
        }
        for (j, i) in (1..along).flat_map(|j| (1..across).map(move |i| (j, i))) {
            data.face_sizes.push(4);
            data.face_vertices.extend([vertex(i - 1, j - 1), vertex(i, j - 1), vertex(i, j), vertex(i - 1, j)]);
        }
        let crease =
            |j| Crease { vertices: [vertex(across / 2, j - 1), vertex(across / 2, j)], sharpness: 0.9 * ridge as f32 };
        data.creases.extend((1..along).map(crease).filter(|crease| crease.sharpness > 0.0));
    }
    ControlMesh::new(data).expect("a mesh")
}

/// Nine cubes, row by row from the top: the edges of the upper face are ever sharper.
fn sharpness() -> ControlMesh {
    let cube = shape("cube").expect("built in").into_data();
    let top = cube.positions.iter().map(|p| p[1]).fold(f64::MIN, f64::max);
    let upper = cube.face_vertices.chunks(4).find(|face| face.iter().all(|&v| cube.positions[v as usize][1] == top));
    let upper = upper.expect("an upper face");
    let mut data = MeshData::default();
    for (i, sharpness) in [0.0, 0.5, 1.0, 1.5, 2.0, 2.75, 4.0, 6.0, 8.0].into_iter().enumerate() {
        let first = data.positions.len() as u32;
        let [column, row] = [i % 3, i / 3].map(|k| 2.0 * k as f64 - 2.0);
        // Away from the eye as much as up, as the eye looks down.
        data.positions.extend(cube.positions.iter().map(|[x, y, z]| [x + column, y - row, z + 0.5 * row]));
        data.face_sizes.extend(&cube.face_sizes);
        data.face_vertices.extend(cube.face_vertices.iter().map(|v| first + v));
        let edge = |k: usize| Crease { vertices: [first + upper[k], first + upper[(k + 1) % 4]], sharpness };
        data.creases.extend((0..4).map(edge).filter(|crease| crease.sharpness > 0.0));
    }
    ControlMesh::new(data).expect("a mesh")
}

/// About this much around a point, with nothing cut off in front of it.
fn close_up(point: Vec3, towards: Vec3, half: f32) -> View {
    let eye = point + towards * (5.0 * half);
    View::perspective(eye.into(), point.into(), [0.0, 1.0, 0.0], 0.6, 1.0, [half, 60.0 * half])
}

#[test]
fn pictures_are_as_they_were() {
    let headless = common::headless();
    if let Some(goldens) = golden::of(&headless) {
        let (mut studio, mut wrong) = (Studio::new(&headless), Vec::new());
        for picture in pictures().into_iter().filter(|picture| !picture.of_uniform_grid) {
            for construction in Construction::ALL {
                let pixels = studio.draw(&picture, construction);
                let writes = construction == Construction::TwoStage;
                wrong.extend(goldens.check(&picture.name, construction.name(), [SIDE; 2], pixels, writes).err());
            }
        }
        // In a render pass the picture is the one of dynamic rendering.
        for shape in ["creature-mixed", "tetrahedron"] {
            let pixels = draw_in_pass(&headless, &Picture::lit(shape));
            wrong.extend(goldens.check(&format!("lit-{shape}"), "render-pass", [SIDE; 2], pixels, false).err());
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
    headless.finish_silent();
}

/// Every evaluation on a uniform grid with every construction that it goes with.
fn uniform_grid_ways() -> impl Iterator<Item = (Evaluation, Construction)> {
    let on_uniform_grids = Evaluation::ALL
        .into_iter()
        .filter(|&evaluation| !matches!(evaluation, Evaluation::Tessellation | Evaluation::Subdivision));
    on_uniform_grids.flat_map(|evaluation| evaluation.constructions().iter().map(move |&c| (evaluation, c)))
}

/// Within triangles the uniform grid has vertices elsewhere than the tessellator: these pictures are left out, but for those that
/// are of uniform grids anyway.
#[test]
fn pictures_evaluated_on_uniform_grids_are_the_same() {
    let headless = common::headless();
    if let Some(goldens) = golden::of(&headless) {
        let (mut studio, mut wrong) = (Studio::new(&headless), Vec::new());
        let mut compared = 0;
        for picture in pictures() {
            let fits = picture.displacement.is_none()
                && matches!(picture.factor, Factor::Uniform(_))
                && picture.evaluation == Evaluation::Tessellation
                && picture.adaptive.is_none_or(|adaptive| adaptive.drawn_by == DrawnBy::Faces)
                && !picture.culled;
            if !fits || !(picture.of_uniform_grid || quads_only(picture.shape)) {
                continue;
            }
            for (evaluation, construction) in uniform_grid_ways() {
                let pixels = studio.draw(&Picture { evaluation, ..picture.clone() }, construction);
                let variant = format!("{}-{}", evaluation.name(), construction.name());
                let writes = picture.of_uniform_grid && evaluation == Evaluation::Compute;
                wrong.extend(goldens.check(&picture.name, &variant, [SIDE; 2], pixels, writes).err());
            }
            compared += 1;
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
        assert!(compared >= 12, "{compared}");
    }
    headless.finish_silent();
}

/// Whether no patch is a triangle.
fn quads_only(name: &str) -> bool {
    shape(name).is_ok_and(|mesh| mesh.data().face_sizes.iter().all(|&size| size == 4))
}

/// Schemes differ little: a golden of one that another passes for proves nothing. (c-patches are the Pm-patches of quads.)
#[test]
fn goldens_of_schemes_fail_with_other_schemes() {
    let headless = common::headless();
    if golden::of(&headless).is_some() {
        let mut studio = Studio::new(&headless);
        for picture in pictures().into_iter().filter(|p| p.scheme != Scheme::Gregory && !p.of_uniform_grid) {
            let golden = golden::load(&golden::folder().join(&picture.name).with_extension("png"));
            let others: &[_] = match (picture.shape, picture.scheme) {
                ("creature-mixed" | "pentagons", _) => &[Scheme::Gregory],
                (_, Scheme::Acc) => &[Scheme::Gregory, Scheme::Pm],
                _ => &[Scheme::Gregory, Scheme::Acc],
            };
            for &scheme in others {
                let name = &picture.name;
                let pixels = studio.draw(&Picture { scheme, ..picture.clone() }, Construction::TwoStage);
                let other = image::RgbaImage::from_raw(SIDE, SIDE, pixels).expect("four bytes a pixel");
                let differ = golden::pixels_that_differ(&golden, &other);
                assert!(differ > 1000, "{name} and the same picture of {scheme:?} differ in {differ} pixels only");
            }
        }
    }
    headless.finish_silent();
}
