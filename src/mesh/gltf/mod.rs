//! glTF 2.0 and GLB.
//!
//! Only the JSON types of the crate `gltf` are used: its accessors, and even its validation, panic on files whose
//! indices are wrong, so ranges are checked here where they are used.

mod accessor;
mod animated;
mod container;
mod cost;
mod error;
mod motion;
mod polygons;
mod scene;
mod skinned;

/// An index is one of a position.
fn check_index(index: u32, positions: &Accessor) -> Result<(), MeshError> {
    match positions.count() {
        count if index as usize >= count => {
            Err(format_error(format!("an index is {index}, but POSITION has {count} elements")))
        }
        _ => Ok(()),
    }
}

/// An attribute has as many elements as there are positions.
fn check_count(name: &str, accessor: &Accessor, positions: &Accessor) -> Result<(), MeshError> {
    let (given, needed) = (accessor.count(), positions.count());
    match given == needed {
        true => Ok(()),
        false => Err(format_error(format!("{name} has {given} elements, but POSITION has {needed}"))),
    }
}

#[cfg(test)]
mod tests;

use super::repair::{quads, weld};
use super::{ControlMesh, FaceVarying, Limits, MeshData, MeshError, RepairOptions, Repairs};
use ::gltf::json;
use accessor::Accessor;
use error::format_error;
use glam::{DMat3, DVec3};
use json::accessor::Type;
use json::mesh::{Primitive, Semantic};
use json::validation::Checked;
use scene::Instance;
use std::borrow::Cow;
use std::collections::HashMap;
use std::path::PathBuf;

/// How [`ControlMesh::from_gltf_bytes`] reads.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct GltfOptions {
    /// Only the mesh of this name, or the mesh of the node of this name; all as one mesh if `None`.
    pub mesh: Option<String>,
    /// Where files that the glTF names are looked for.
    pub folder: Option<PathBuf>,
    /// Put quads together that were split into triangles, as exporters do: by their order in the file, or else by shape. Only where
    /// most triangles are parts of quads, and never across seams of texture coordinates or materials.
    pub quads: bool,
    /// The most that is read: few bytes can draw a mesh any number of times.
    pub limits: Limits,
}

const NGONS: &str = "FB_ngon_encoding";
const DRACO: &str = "KHR_draco_mesh_compression";

/// Extensions that a file may require: those that are understood here.
const EXTENSIONS: [&str; 2] = [NGONS, "KHR_mesh_quantization"];
/// How the names of others begin: those of looks, animations and metadata, none of which change the shape.
const EXTENSIONS_OF_LOOKS: [&str; 10] = [
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_xmp",
    "KHR_animation_",
    "KHR_audio",
    "MSFT_packing_",
];

impl ControlMesh {
    /// Reads a glTF 2.0 or GLB file: all triangles of the default scene, or of the mesh that `options` name.
    ///
    /// * Polygons are those that the extension `FB_ngon_encoding` marks: triangles in a row that share their first
    ///   corner and go on where the last ended. Without it, triangles, strips and fans give triangles. Points, lines
    ///   and triangles with two corners at one place are passed over.
    /// * Edges of one mesh that lie on one another (their ends are equal in every bit) become one edge, so that seams of texture
    ///   coordinates, normals or materials are no boundaries of the surface. Where more than two lie on one another, each is joined
    ///   with the one that bounds the same solid. A sheet and its back are not joined, nor are pieces that only touch. `TEXCOORD_0` and `NORMAL` are kept a face corner;
    ///   where only some primitives have them, the others get (0, 0) and (0, 0, 0).
    /// * The transforms of the nodes are applied; one that mirrors turns the faces round. That of a node with a skin is
    ///   not, as the format has it. Skins and morph targets are not applied: [`ControlMesh::from_gltf_bytes_animated`] reads them.
    ///
    /// Vertices that no face uses do not count. Faces that repeat a vertex after welding are errors.
    ///
    /// # Errors
    /// [`MeshError::Format`] for a file that is broken or requires extensions that change the shape,
    /// [`MeshError::UnknownMesh`], and those of [`ControlMesh::new`].
    pub fn from_gltf_bytes(bytes: &[u8], options: &GltfOptions) -> Result<Self, MeshError> {
        Self::new(read(bytes, options)?.0)
    }

    /// As [`ControlMesh::from_gltf_bytes`], with what is odd about the file mended: see [`repair`](super::repair).
    ///
    /// # Errors
    /// As [`ControlMesh::from_gltf_bytes`], for what can't be mended.
    pub fn from_gltf_bytes_repaired(
        bytes: &[u8],
        options: &GltfOptions,
        repair: &RepairOptions,
    ) -> Result<(Self, Repairs), MeshError> {
        let (data, rebuilt_quads) = read(bytes, options)?;
        let (mesh, repairs) = Self::repaired(data, repair)?;
        Ok((mesh, Repairs { rebuilt_quads, ..repairs }))
    }
}

/// The data of a file, and how many quads were put together.
pub(super) fn read(bytes: &[u8], options: &GltfOptions) -> Result<(MeshData, usize), MeshError> {
    let file = File::open(bytes, options)?;
    let built = file.build(&file.instances(options)?, options)?;
    Ok((built.data, built.rebuilt_quads))
}

/// A file whose numbers can be read.
struct File<'b> {
    json: &'b [u8],
    root: json::Root,
    buffers: Vec<Cow<'b, [u8]>>,
}

/// The mesh of a file, before it is mended.
struct Built {
    data: MeshData,
    rebuilt_quads: usize,
    /// Where each vertex comes from.
    sources: Vec<Source>,
}

/// A vertex of a primitive of an instance.
#[derive(Clone, Copy)]
struct Source {
    instance: u32,
    primitive: u32,
    index: u32,
}

impl<'b> File<'b> {
    fn open(bytes: &'b [u8], options: &GltfOptions) -> Result<Self, MeshError> {
        let (json, binary) = container::split(bytes)?;
        let root = container::parse(json, &options.limits)?;
        check_extensions(&root)?;
        let buffers = container::buffers(&root, binary, options)?;
        Ok(Self { json, root, buffers })
    }

    /// The meshes that are asked for.
    fn instances(&self, options: &GltfOptions) -> Result<Vec<Instance<'_>>, MeshError> {
        let instances = scene::instances(&self.root)?;
        match &options.mesh {
            Some(name) => scene::choose(instances, name),
            None => Ok(instances),
        }
    }

    fn build(&self, instances: &[Instance<'_>], options: &GltfOptions) -> Result<Built, MeshError> {
        cost::check(self, instances, &options.limits)?;
        let mut builder = Builder::default();
        for (instance, number) in instances.iter().zip(0..) {
            builder.add_instance(self, instance, number, &options.limits)?;
        }
        if builder.data.face_sizes.is_empty() {
            return Err(format_error("the scene has no triangles: points and lines have no surface"));
        }
        let groups = std::mem::take(&mut builder.groups);
        let (mut data, sources) = builder.finish();
        let rebuilt_quads = if options.quads { quads::rebuild(&mut data, &groups) } else { 0 };
        Ok(Built { data, rebuilt_quads, sources })
    }
}

fn check_extensions(root: &json::Root) -> Result<(), MeshError> {
    let known =
        |name: &str| EXTENSIONS.contains(&name) || EXTENSIONS_OF_LOOKS.iter().any(|looks| name.starts_with(looks));
    match root.extensions_required.iter().find(|name| !known(name)) {
        None => Ok(()),
        Some(name) => Err(unsupported(name)),
    }
}

fn unsupported(extension: &str) -> MeshError {
    format_error(format!("the file requires the extension {extension}, which is not supported: export it without"))
}

/// Gathers the faces of one instance after the other.
#[derive(Default)]
struct Builder {
    data: MeshData,
    /// Of every pair of mesh and vertex of a primitive that a face uses.
    texcoords: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    /// Of every face corner, into both of the above.
    attributes: Vec<u32>,
    has_texcoords: bool,
    has_normals: bool,
    /// Of every vertex, the first one of its instance that has its position.
    places: Vec<u32>,
    /// Of every face, the number of its primitive; `u32::MAX` where the file says which triangles are polygons.
    groups: Vec<u32>,
    primitives: u32,
    /// Of every vertex.
    sources: Vec<Source>,
}

/// What a vertex of a primitive became.
#[derive(Clone, Copy)]
struct Local {
    vertex: u32,
    attribute: u32,
}

impl Builder {
    fn add_instance(
        &mut self,
        file: &File<'_>,
        instance: &Instance<'_>,
        number: u32,
        limits: &Limits,
    ) -> Result<(), MeshError> {
        let mut places = HashMap::new();
        for (primitive, index) in instance.mesh.primitives.iter().zip(0..) {
            let first = self.sources.len();
            self.add_primitive(&file.root, &file.buffers, instance, primitive, &mut places)?;
            limits.check_vertices(self.data.positions.len() as u64)?;
            limits.check_faces(self.data.face_sizes.len() as u64)?;
            self.sources[first..].iter_mut().for_each(|s| (s.instance, s.primitive) = (number, index));
        }
        Ok(())
    }

    fn add_primitive(
        &mut self,
        root: &json::Root,
        buffers: &[Cow<'_, [u8]>],
        instance: &Instance<'_>,
        primitive: &Primitive,
        places: &mut HashMap<[u64; 3], u32>,
    ) -> Result<(), MeshError> {
        let Some(corners) = Corners::open(root, buffers, primitive)? else {
            // Allowed, and nothing is to be drawn.
            return Ok(());
        };
        let Corners { mode, ngons, positions, texcoords, normals, indices } = corners;

        let linear = DMat3::from_mat4(instance.transform);
        let mirrored = linear.determinant() < 0.0;
        let normal_transform = cofactors(linear) * if mirrored { -1.0 } else { 1.0 };
        let group = if ngons { u32::MAX } else { self.primitives };
        self.primitives += 1;
        let mut locals: HashMap<u32, Local> = HashMap::new();
        polygons::for_each_face(&indices, mode, ngons, |corners| {
            let first = self.data.face_vertices.len();
            corners.iter().try_for_each(|&corner| check_index(corner, &positions))?;
            // A triangle with two corners at one place draws nothing, as engines have them at the poles of spheres.
            let place = |corner: u32| -> [u64; 3] { positions.get(corner as usize).map(|x| (x + 0.0).to_bits()) };
            if let &[a, b, c] = corners
                && (place(a) == place(b) || place(b) == place(c) || place(c) == place(a))
            {
                return Ok(());
            }
            for &corner in corners {
                let local = *locals.entry(corner).or_insert_with(|| {
                    let vertex = self.add_vertex(positions.get(corner as usize), instance, places);
                    self.sources.push(Source { instance: 0, primitive: 0, index: corner });
                    let texcoord = texcoords.as_ref().map_or([0.0; 2], |texcoords| texcoords.get(corner as usize));
                    let normal = normals.as_ref().map_or([0.0; 3], |normals| normals.get(corner as usize));
                    let normal = (normal_transform * DVec3::from(normal)).normalize_or_zero();
                    self.texcoords.push(texcoord.map(|x| x as f32));
                    self.normals.push(normal.as_vec3().to_array());
                    Local { vertex, attribute: self.texcoords.len() as u32 - 1 }
                });
                self.data.face_vertices.push(local.vertex);
                self.attributes.push(local.attribute);
            }
            if mirrored {
                // All but the first corner, which stays the first.
                self.data.face_vertices[first + 1..].reverse();
                self.attributes[first + 1..].reverse();
            }
            self.data.face_sizes.push(corners.len() as u32);
            self.groups.push(group);
            Ok(())
        })?;
        self.has_texcoords |= texcoords.is_some();
        self.has_normals |= normals.is_some();
        Ok(())
    }

    /// Adds a vertex of an instance's mesh, and notes which others have its position.
    fn add_vertex(&mut self, position: [f64; 3], instance: &Instance<'_>, places: &mut HashMap<[u64; 3], u32>) -> u32 {
        let vertex = self.data.positions.len() as u32;
        // Adding zero makes -0 and 0 the same.
        self.places.push(*places.entry(position.map(|x| (x + 0.0).to_bits())).or_insert(vertex));
        let position = DVec3::from(position);
        let placed = instance.transform.transform_point3(position);
        // An infinite coordinate would make the others NaN, and hide from the message what is wrong.
        let placed = if position.is_finite() { placed } else { position };
        self.data.positions.push(placed.to_array());
        vertex
    }

    /// Joins what the file split, edge by edge. Of vertices that are joined the first is the source.
    fn finish(mut self) -> (MeshData, Vec<Source>) {
        let kept = weld::join(&mut self.data, &self.places);
        let sources = kept.into_iter().map(|vertex| self.sources[vertex as usize]).collect();
        if self.has_texcoords {
            self.data.texcoords = Some(FaceVarying { values: self.texcoords, indices: self.attributes.clone() });
        }
        if self.has_normals {
            self.data.normals = Some(FaceVarying { values: self.normals, indices: self.attributes });
        }
        (self.data, sources)
    }
}

/// The corners of a primitive's faces.
struct Corners<'a> {
    mode: json::mesh::Mode,
    /// Whether triangles are parts of larger faces.
    ngons: bool,
    positions: Accessor<'a>,
    texcoords: Option<Accessor<'a>>,
    normals: Option<Accessor<'a>>,
    indices: Vec<u32>,
}

impl<'a> Corners<'a> {
    /// None without positions.
    fn open(root: &json::Root, buffers: &'a [Cow<'_, [u8]>], primitive: &Primitive) -> Result<Option<Self>, MeshError> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err(format_error("a primitive has an unknown mode: it must be 0 to 6"));
        };
        let attribute = |semantic: Semantic, kind| {
            let index = primitive.attributes.get(&Checked::Valid(semantic));
            index.map(|index| Accessor::open(root, buffers, index.value(), kind)).transpose()
        };
        let Some(positions) = attribute(Semantic::Positions, Type::Vec3)? else { return Ok(None) };
        let texcoords = attribute(Semantic::TexCoords(0), Type::Vec2)?;
        let normals = attribute(Semantic::Normals, Type::Vec3)?;
        for (name, accessor) in [("TEXCOORD_0", &texcoords), ("NORMAL", &normals)] {
            accessor.as_ref().map_or(Ok(()), |accessor| check_count(name, accessor, &positions))?;
        }
        let has = |name| primitive.extensions.as_ref().is_some_and(|extensions| extensions.others.contains_key(name));
        if has(DRACO) && !positions.is_backed() {
            return Err(unsupported(DRACO));
        }
        let indices = indices(root, buffers, primitive, &positions)?;
        Ok(Some(Self { mode, ngons: has(NGONS), positions, texcoords, normals, indices }))
    }
}

/// The vertices that a primitive draws, in order.
fn indices(
    root: &json::Root,
    buffers: &[Cow<'_, [u8]>],
    primitive: &Primitive,
    positions: &Accessor<'_>,
) -> Result<Vec<u32>, MeshError> {
    // Elements without data cost no bytes in the file, so there could be any number of them to go through.
    let unbacked = |what| format_error(format!("{what} need a buffer view: write the file again"));
    let Some(index) = primitive.indices else {
        if !positions.is_backed() {
            return Err(unbacked("positions that are drawn without indices"));
        }
        return Ok((0..positions.count() as u32).collect());
    };
    let accessor = Accessor::open(root, buffers, index.value(), Type::Scalar)?;
    if !accessor.is_backed() {
        return Err(unbacked("indices"));
    }
    if !accessor.is_unsigned() {
        return Err(format_error(format!("accessor {index} has indices that are not unsigned integers")));
    }
    // Exact: every u32 is an f64.
    Ok((0..accessor.count()).map(|i| accessor.get::<1>(i)[0] as u32).collect())
}

/// Turns normals as `linear` turns surfaces, up to length and (where it mirrors) sign.
fn cofactors(linear: DMat3) -> DMat3 {
    DMat3::from_cols(
        linear.y_axis.cross(linear.z_axis),
        linear.z_axis.cross(linear.x_axis),
        linear.x_axis.cross(linear.y_axis),
    )
}
