//! glTF.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use ridgeline::roofs::model::Surface;
use serde_json::Value;

use crate::planted::{files_of, planted_models, scene};

#[test]
fn glb_reads_back_with_the_area_of_the_model() {
    for (name, model, _) in planted_models() {
        let files = files_of(&scene(), &model);
        let (document, buffers, images) = gltf::import_slice(&files["model.glb"]).unwrap();
        assert_eq!(images.len(), 1);
        let container = gltf::binary::Glb::from_slice(&files["model.glb"]).unwrap();
        let json: Value = serde_json::from_slice(&container.json).unwrap();
        assert!(json["materials"][0]["extensions"]["KHR_materials_unlit"].is_object());
        let mut area: BTreeMap<String, Vector3<f64>> = BTreeMap::new();
        for node in document.nodes() {
            let Some(mesh) = node.mesh() else {
                continue;
            };
            let extras: Value =
                serde_json::from_str(node.extras().as_ref().unwrap().get()).unwrap();
            let key = format!(
                "{} {}",
                extras["surface"].as_str().unwrap(),
                extras["facet"]
            );
            for primitive in mesh.primitives() {
                let reader = primitive.reader(|b| Some(&buffers[b.index()]));
                // Back from Y up: (x, z, -y).
                let corners: Vec<Vector3<f64>> = reader
                    .read_positions()
                    .unwrap()
                    .map(|[x, y, z]| Vector3::new(x.into(), (-z).into(), y.into()))
                    .collect();
                let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
                let sum = area.entry(key.clone()).or_default();
                for t in indices.chunks_exact(3) {
                    let [a, b, c] = [t[0], t[1], t[2]].map(|i| corners[i as usize]);
                    *sum += (b - a).cross(&(c - a)) / 2.0;
                }
            }
        }
        for building in &model.buildings {
            for face in &building.solid.faces {
                let wanted = building.solid.vector_area(&face.rings);
                if let Surface::Roof(id) = face.surface {
                    let found = area[&format!("roof {}", id.number())];
                    assert!(
                        (found - wanted).norm() < 1e-4,
                        "{name}: {found} for {wanted}"
                    );
                }
            }
        }
        // A closed surface: all vector areas together vanish.
        let total: Vector3<f64> = area.values().sum();
        assert!(total.norm() < 1e-4, "{name}: {total}");
    }
}
