//! glTF 2.0 in one binary file.
//!
//! Y is up: world (x, y, z) becomes (x, z, -y). Coordinates stay local, because f32 cannot hold a
//! national grid; the scene origin, to be added before the axes are turned, is in `extras.origin`
//! of the asset's scene.
//!
//! ```text
//! scene
//!  └ building-1           extras { building }
//!     ├ facet-1           extras { building, facet, surface: "roof" }
//!     ├ facet-2           ...
//!     ├ walls             extras { building, surface: "wall" }
//!     └ ground            extras { building, surface: "ground" }
//! ```

use std::ops::Range;

use glam::{DVec3, Vec3};
use gltf_json::accessor::{ComponentType, GenericComponentType, Type};
use gltf_json::buffer::Target;
use gltf_json::mesh::{Mode, Semantic};
use gltf_json::texture::{MagFilter, MinFilter, WrappingMode};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{self as gltf, Index};
use nalgebra::{Point3, Vector3};
use serde_json::{Value, json};

use crate::base::geometry::vector_area;
use crate::base::ids::BuildingId;
use crate::orienting::scene::Scene;
use crate::results::texture::{FaceTexture, TexturedModel};
use crate::roofs::model::{Building, RoofModel, SolidFace, Surface, triangulate};

/// The model as a GLB file with the atlas, given as JPEG, inside.
pub fn glb(scene: &Scene, model: &RoofModel, textured: &TexturedModel, atlas: &[u8]) -> Vec<u8> {
    glb_of(
        scene,
        model,
        0..model.buildings.len(),
        (&textured.faces, atlas),
    )
}

/// Some buildings of a model, which follow each other, with the textures of their faces and the
/// atlas of these alone; their numbers are those of the model.
pub fn glb_of(
    scene: &Scene,
    model: &RoofModel,
    buildings: Range<usize>,
    (faces, atlas): (&[Vec<FaceTexture>], &[u8]),
) -> Vec<u8> {
    let mut file = GlbFile::default();
    let mut nodes = Vec::new();
    if !buildings.is_empty() {
        file.add_material(atlas);
    }
    for (i, textures) in buildings.zip(faces) {
        nodes.push(file.add_building(BuildingId::from_index(i), model, textures));
    }
    file.finish(nodes, scene)
}

/// A grey that stands out from tiles and gravel, linear.
const OBSTRUCTION_COLOUR: [f32; 4] = [0.25, 0.27, 0.3, 1.0];

/// Z up as everywhere here, Y up as the format has it.
fn y_up(v: &Vector3<f64>) -> Vec3 {
    DVec3::new(v.x, v.z, -v.y).as_vec3()
}

/// A glTF file in the making.
#[derive(Default)]
struct GlbFile {
    root: gltf::Root,
    bin: Vec<u8>,
}

/// Vertices and triangles of a mesh.
#[derive(Default)]
struct MeshBuffers {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uv: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

impl MeshBuffers {
    fn add(&mut self, building: &Building, face: &SolidFace, texture: &FaceTexture) {
        let solid = &building.solid;
        let first = self.positions.len() as u32;
        let area = solid.vector_area(&face.rings);
        let Some(normal) = area.try_normalize(1e-12) else {
            return;
        };
        for (&v, uv) in face.rings.iter().flatten().zip(texture.uv.iter().flatten()) {
            self.positions
                .push(y_up(&solid.vertices[v as usize].coords));
            self.normals.push(y_up(&normal));
            self.uv.push(*uv);
        }
        self.indices
            .extend(triangulate(solid, face).iter().flatten().map(|i| first + i));
    }
}

impl MeshBuffers {
    /// A convex face.
    fn add_untextured(&mut self, ring: &[Point3<f64>]) {
        let Some(normal) = vector_area(ring.iter().copied()).try_normalize(1e-12) else {
            return;
        };
        let first = self.positions.len() as u32;
        self.positions.extend(ring.iter().map(|p| y_up(&p.coords)));
        self.normals.extend(ring.iter().map(|_| y_up(&normal)));
        self.uv.extend(ring.iter().map(|_| [0.0; 2]));
        let fan = (2..ring.len() as u32).flat_map(|k| [0, k - 1, k]);
        self.indices.extend(fan.map(|k| first + k));
    }
}

impl GlbFile {
    /// The only material: the atlas, unlit, since photographs hold the light already.
    fn add_material(&mut self, atlas: &[u8]) {
        let view = self.add_bytes(atlas, None);
        let image = self.root.push(gltf::Image {
            buffer_view: Some(view),
            mime_type: Some(gltf::image::MimeType("image/jpeg".into())),
            name: Some("atlas".into()),
            uri: None,
            extensions: None,
            extras: None,
        });
        let sampler = self.root.push(gltf::texture::Sampler {
            mag_filter: Some(Checked::Valid(MagFilter::Linear)),
            min_filter: Some(Checked::Valid(MinFilter::LinearMipmapLinear)),
            wrap_s: Checked::Valid(WrappingMode::ClampToEdge),
            wrap_t: Checked::Valid(WrappingMode::ClampToEdge),
            ..Default::default()
        });
        let texture = self.root.push(gltf::Texture {
            name: None,
            sampler: Some(sampler),
            source: image,
            extensions: None,
            extras: None,
        });
        let info = gltf::texture::Info {
            index: texture,
            tex_coord: 0,
            extensions: None,
            extras: None,
        };
        let unlit = gltf::extensions::material::Material {
            unlit: Some(gltf::extensions::material::Unlit {}),
        };
        let surface = gltf::material::PbrMetallicRoughness {
            base_color_texture: Some(info),
            // What a viewer without the extension takes: no mirror.
            metallic_factor: gltf::material::StrengthFactor(0.0),
            ..Default::default()
        };
        self.root.push(gltf::Material {
            name: Some("photographs".into()),
            pbr_metallic_roughness: surface,
            extensions: Some(unlit),
            ..Default::default()
        });
        self.root.extensions_used.push("KHR_materials_unlit".into());
    }

    /// The material of what stands on roofs, which is added with the first of it.
    fn plain_material(&mut self) -> Index<gltf::Material> {
        if self.root.materials.len() < 2 {
            let surface = gltf::material::PbrMetallicRoughness {
                base_color_factor: gltf::material::PbrBaseColorFactor(OBSTRUCTION_COLOUR),
                metallic_factor: gltf::material::StrengthFactor(0.0),
                ..Default::default()
            };
            self.root.push(gltf::Material {
                name: Some("obstructions".into()),
                pbr_metallic_roughness: surface,
                ..Default::default()
            });
        }
        Index::new(1)
    }

    /// The node of a building, with a child for each facet, one for the walls, one for the ground
    /// and one for what stands on the roof.
    fn add_building(
        &mut self,
        id: BuildingId,
        model: &RoofModel,
        textures: &[FaceTexture],
    ) -> Index<gltf::Node> {
        let building = &model.buildings[id.index()];
        let number = id.number();
        let faces = || building.solid.faces.iter().zip(textures);
        let mut children = Vec::new();
        let photographs = Index::new(0);
        for (face, texture) in faces() {
            if let Surface::Roof(facet) = face.surface {
                let mut triangles = MeshBuffers::default();
                triangles.add(building, face, texture);
                let extras =
                    json!({ "building": number, "facet": facet.number(), "surface": "roof" });
                children.extend(self.add_mesh(&facet.name(), &extras, triangles, photographs));
            }
        }
        for (surface, name) in [(Surface::Wall, "wall"), (Surface::Ground, "ground")] {
            let mut triangles = MeshBuffers::default();
            for (face, texture) in faces().filter(|(face, _)| face.surface == surface) {
                triangles.add(building, face, texture);
            }
            let extras = json!({ "building": number, "surface": name });
            children.extend(self.add_mesh(name, &extras, triangles, photographs));
        }
        let mut triangles = MeshBuffers::default();
        for facet in building.facets.iter().map(|f| &model.facets[f.index()]) {
            let faces = facet.obstructions.iter().flat_map(|o| facet.faces_of(o));
            faces.for_each(|ring| triangles.add_untextured(&ring));
        }
        if !triangles.indices.is_empty() {
            let material = self.plain_material();
            let extras = json!({ "building": number, "surface": "obstruction" });
            children.extend(self.add_mesh("obstructions", &extras, triangles, material));
        }
        self.root.push(gltf::Node {
            name: Some(id.name()),
            // The format forbids an empty list.
            children: (!children.is_empty()).then_some(children),
            extras: raw(&json!({ "building": number })),
            ..Default::default()
        })
    }

    /// A node with a mesh; `None` when there is no triangle.
    fn add_mesh(
        &mut self,
        name: &str,
        extras: &Value,
        triangles: MeshBuffers,
        material: Index<gltf::Material>,
    ) -> Option<Index<gltf::Node>> {
        if triangles.indices.is_empty() {
            return None;
        }
        let MeshBuffers {
            positions,
            normals,
            uv,
            indices,
        } = triangles;
        let bounds = |pick: fn(Vec3, Vec3) -> Vec3| {
            let found = positions.iter().copied().reduce(pick);
            found.map(|p| json!(p.to_array()))
        };
        let (min, max) = (bounds(Vec3::min), bounds(Vec3::max));
        let position = self.add_floats(&positions, Type::Vec3);
        self.root.accessors[position.value()].min = min;
        self.root.accessors[position.value()].max = max;
        let normal = self.add_floats(&normals, Type::Vec3);
        let uv = self.add_floats(&uv, Type::Vec2);
        let index = self.add_indices(&indices);
        let attributes = [
            (Semantic::Positions, position),
            (Semantic::Normals, normal),
            (Semantic::TexCoords(0), uv),
        ];
        let mesh = self.root.push(gltf::Mesh {
            primitives: vec![gltf::mesh::Primitive {
                attributes: attributes.map(|(s, a)| (Checked::Valid(s), a)).into(),
                indices: Some(index),
                material: Some(material),
                mode: Checked::Valid(Mode::Triangles),
                targets: None,
                extensions: None,
                extras: None,
            }],
            name: Some(name.into()),
            weights: None,
            extensions: None,
            extras: None,
        });
        let (name, extras) = (Some(name.into()), raw(extras));
        Some(self.root.push(gltf::Node {
            mesh: Some(mesh),
            name,
            extras,
            ..Default::default()
        }))
    }

    fn add_floats<const N: usize>(
        &mut self,
        values: &[impl Copy + Into<[f32; N]>],
        kind: Type,
    ) -> Index<gltf::Accessor> {
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|&v| v.into().map(f32::to_le_bytes).into_iter().flatten())
            .collect();
        let component = GenericComponentType(ComponentType::F32);
        self.add_accessor(&bytes, values.len(), component, kind, Target::ArrayBuffer)
    }

    fn add_indices(&mut self, indices: &[u32]) -> Index<gltf::Accessor> {
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        let component = GenericComponentType(ComponentType::U32);
        self.add_accessor(
            &bytes,
            indices.len(),
            component,
            Type::Scalar,
            Target::ElementArrayBuffer,
        )
    }

    fn add_accessor(
        &mut self,
        bytes: &[u8],
        count: usize,
        component: GenericComponentType,
        kind: Type,
        target: Target,
    ) -> Index<gltf::Accessor> {
        let view = self.add_bytes(bytes, Some(target));
        self.root.push(gltf::Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: USize64::from(count),
            component_type: Checked::Valid(component),
            type_: Checked::Valid(kind),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
            extensions: None,
            extras: None,
        })
    }

    /// Appends bytes to the buffer, on a multiple of four.
    fn add_bytes(&mut self, bytes: &[u8], target: Option<Target>) -> Index<gltf::buffer::View> {
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.root.push(gltf::buffer::View {
            buffer: Index::new(0),
            byte_length: USize64::from(bytes.len()),
            byte_offset: Some(USize64::from(offset)),
            byte_stride: None,
            name: None,
            target: target.map(Checked::Valid),
            extensions: None,
            extras: None,
        })
    }

    /// Adds the scene and puts header, JSON and buffer together.
    fn finish(mut self, nodes: Vec<Index<gltf::Node>>, scene: &Scene) -> Vec<u8> {
        self.root.asset.generator = Some(format!("ridgeline {}", env!("CARGO_PKG_VERSION")));
        let mut origin =
            json!({ "origin": scene.origin.as_slice(), "axes": "(x, y, z) -> (x, z, -y)" });
        if let Some(system) = scene.survey.describe() {
            origin["coordinates"] = json!(system);
        }
        // The format forbids empty lists: a model without buildings is an asset without a scene.
        if nodes.is_empty() {
            self.root.extras = raw(&origin);
        } else {
            let scene = gltf::Scene {
                nodes,
                name: None,
                extensions: None,
                extras: raw(&origin),
            };
            self.root.scene = Some(self.root.push(scene));
            self.root.push(gltf::Buffer {
                byte_length: USize64::from(self.bin.len()),
                name: None,
                uri: None,
                extensions: None,
                extras: None,
            });
        }
        let json = self
            .root
            .to_vec()
            .expect("a glTF root has string keys only");
        container(json, &self.bin)
    }
}

/// Header and chunks of a GLB file.
fn container(mut json: Vec<u8>, bin: &[u8]) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let chunks: Vec<(&[u8; 4], &[u8])> = [(b"JSON", json.as_slice()), (b"BIN\0", bin)]
        .into_iter()
        .filter(|(_, bytes)| !bytes.is_empty())
        .collect();
    let length = 12
        + chunks
            .iter()
            .map(|(_, bytes)| 8 + bytes.len())
            .sum::<usize>();
    let word = |n: usize| u32::try_from(n).expect("a file below 4 GB").to_le_bytes();
    let mut out = Vec::with_capacity(length);
    out.extend_from_slice(b"glTF");
    out.extend_from_slice(&word(2));
    out.extend_from_slice(&word(length));
    for (kind, bytes) in chunks {
        out.extend_from_slice(&word(bytes.len()));
        out.extend_from_slice(kind);
        out.extend_from_slice(bytes);
    }
    out
}

/// A JSON value as glTF extras.
fn raw(value: &Value) -> gltf::Extras {
    serde_json::value::to_raw_value(value).ok()
}
