//! The model as plain meshes: OBJ with its material, and PLY with the 3D lines as edges.
//!
//! Coordinates are those of the input's world frame, metres, Z up. A program that reads them into
//! single precision should take off the scene origin first; both files state it in a comment.

use nalgebra::Point3;

use super::format::{ATLAS_FILE, MATERIAL_FILE, push_line, world};
use crate::base::ids::{BuildingId, LineId};
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::results::texture::TexturedModel;
use crate::roofs::model::{RoofModel, Surface, triangulate};

/// The textured model as OBJ: an object per building, a group per surface, triangles.
pub fn obj(scene: &Scene, model: &RoofModel, textured: &TexturedModel) -> Vec<u8> {
    let mut text = comment("# ", scene);
    push_line(&mut text, format_args!("mtllib {MATERIAL_FILE}"));
    // OBJ counts from one, over the whole file.
    let (mut first_vertex, mut first_uv) = (1, 1);
    for (i, (building, textures)) in model.buildings.iter().zip(&textured.faces).enumerate() {
        let solid = &building.solid;
        push_line(
            &mut text,
            format_args!("o {}", BuildingId::from_index(i).name()),
        );
        for p in &solid.vertices {
            let [x, y, z] = world(scene, p);
            push_line(&mut text, format_args!("v {x} {y} {z}"));
        }
        push_line(&mut text, format_args!("usemtl photographs"));
        for (face, texture) in solid.faces.iter().zip(textures) {
            push_line(&mut text, format_args!("g {}", group(face.surface)));
            for [u, v] in texture.uv.iter().flatten() {
                // The atlas has its origin at the top, OBJ at the bottom.
                push_line(&mut text, format_args!("vt {u} {}", 1.0 - v));
            }
            let corners: Vec<u32> = face.rings.iter().flatten().copied().collect();
            for triangle in triangulate(solid, face) {
                let [a, b, c] = triangle
                    .map(|i| format!("{}/{}", first_vertex + corners[i as usize], first_uv + i));
                push_line(&mut text, format_args!("f {a} {b} {c}"));
            }
            first_uv += corners.len() as u32;
        }
        first_vertex += solid.vertices.len() as u32;
    }
    text.into_bytes()
}

/// The material of the OBJ file: the atlas, as bright as it is.
pub fn mtl() -> Vec<u8> {
    format!("newmtl photographs\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nillum 0\nmap_Kd {ATLAS_FILE}\n")
        .into_bytes()
}

/// The model and the 3D lines as PLY (ASCII): triangles of the solids, and edges.
pub fn ply(scene: &Scene, model: &RoofModel, lines: &[Line3d]) -> Vec<u8> {
    let mut vertices: Vec<Point3<f64>> = Vec::new();
    let mut triangles: Vec<[usize; 3]> = Vec::new();
    for building in &model.buildings {
        let (solid, first) = (&building.solid, vertices.len());
        for face in &solid.faces {
            let corners: Vec<u32> = face.rings.iter().flatten().copied().collect();
            let found = triangulate(solid, face);
            triangles.extend(
                found
                    .iter()
                    .map(|t| t.map(|i| first + corners[i as usize] as usize)),
            );
        }
        vertices.extend(&solid.vertices);
    }
    let first_end = vertices.len();
    let ends = |(_, l): (LineId, &Line3d)| [l.segment.p0, l.segment.p1];
    vertices.extend(Line3d::standing(lines).flat_map(ends));
    let edges = (vertices.len() - first_end) / 2;

    let mut text = "ply\nformat ascii 1.0\n".to_owned();
    text.push_str(&comment("comment ", scene));
    push_line(&mut text, format_args!("element vertex {}", vertices.len()));
    text.push_str("property double x\nproperty double y\nproperty double z\n");
    push_line(&mut text, format_args!("element face {}", triangles.len()));
    text.push_str("property list uchar int vertex_indices\n");
    push_line(&mut text, format_args!("element edge {edges}"));
    text.push_str("property int vertex1\nproperty int vertex2\nend_header\n");
    for p in &vertices {
        let [x, y, z] = world(scene, p);
        push_line(&mut text, format_args!("{x} {y} {z}"));
    }
    for [a, b, c] in triangles {
        push_line(&mut text, format_args!("3 {a} {b} {c}"));
    }
    for i in 0..edges {
        let a = first_end + 2 * i;
        push_line(&mut text, format_args!("{a} {}", a + 1));
    }
    text.into_bytes()
}

fn comment(start: &str, scene: &Scene) -> String {
    let [x, y, z] = world(scene, &Point3::origin());
    let mut text = format!("{start}metres, Z up; origin of the local frame {x} {y} {z}\n");
    if let Some(system) = scene.survey.describe() {
        push_line(&mut text, format_args!("{start}coordinates: {system}"));
    }
    text
}

fn group(surface: Surface) -> String {
    match surface {
        Surface::Roof(facet) => facet.name(),
        Surface::Wall => "wall".to_owned(),
        Surface::Ceiling => "ceiling".to_owned(),
        Surface::Ground => "ground".to_owned(),
    }
}
