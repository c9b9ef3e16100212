//! The LoD 2.3 solid of a CityJSON building: walls where they stand, undersides of eaves.

use nalgebra::Point3;
use serde_json::{Value, json};

use super::format::rounded;
use crate::roofs::model::{BuildingWalls, Solid, SolidFace, Surface, Wall};

/// A wall of a solid is one of those that were placed if its corners are this near to its line,
/// metres.
const CORNER_TOLERANCE_M: f64 = 0.02;

/// The geometry of a solid with walls, with the index in the file of each of its corners.
pub(super) fn walled_solid(walls: &BuildingWalls, solid: &Solid, corners: &[usize]) -> Value {
    let ring = |ring: &Vec<u32>| ring.iter().map(|v| corners[*v as usize]).collect();
    let boundary = |face: &SolidFace| face.rings.iter().map(ring).collect::<Vec<Vec<usize>>>();
    let boundaries: Vec<_> = solid.faces.iter().map(boundary).collect();
    let surfaces: Vec<Value> = (solid.faces.iter())
        .map(|face| surface(walls, solid, face))
        .collect();
    let values: Vec<usize> = (0..surfaces.len()).collect();
    json!({
        "type": "Solid",
        "lod": "2.3",
        "boundaries": [boundaries],
        "semantics": { "surfaces": surfaces, "values": [values] },
    })
}

/// What is known of the walls, as attributes of the building.
pub(super) fn add_attributes(attributes: &mut Value, walls: &BuildingWalls) {
    let seen = walls.walls.iter().filter(|wall| wall.seen).count();
    attributes["walls"] = json!(walls.walls.len());
    attributes["wallsSeen"] = json!(seen);
    if let Some(volume) = walls.volume_m3 {
        attributes["volumeWithinWalls"] = json!(rounded(volume, 3));
    }
}

fn surface(walls: &BuildingWalls, solid: &Solid, face: &SolidFace) -> Value {
    match face.surface {
        Surface::Roof(id) => json!({ "type": "RoofSurface", "facet": id.number() }),
        Surface::Ground => json!({ "type": "GroundSurface" }),
        Surface::Ceiling => json!({ "type": "OuterCeilingSurface" }),
        Surface::Wall => {
            let mut surface = json!({ "type": "WallSurface" });
            let corners: Vec<&Point3<f64>> = (face.rings.iter().flatten())
                .map(|v| &solid.vertices[*v as usize])
                .collect();
            if let Some(wall) = walls.walls.iter().find(|wall| stands_in(wall, &corners)) {
                surface["overhang"] = json!(rounded(wall.depth_m, 3));
                surface["seen"] = json!(wall.seen);
                if let Some(sigma) = wall.sigma_m {
                    surface["overhangSigma"] = json!(rounded(sigma, 3));
                }
                if let Some(probability) = wall.probability {
                    surface["probability"] = json!(rounded(probability, 4));
                }
            }
            surface
        }
    }
}

/// Do the corners of a face lie on the line of a wall, beside its side? The rim of the roof, which
/// lies on the side itself, is no wall unless the wall stands there.
fn stands_in(wall: &Wall, corners: &[&Point3<f64>]) -> bool {
    let start = wall.side.p0.xy();
    let side = (wall.side.p1 - wall.side.p0).xy();
    let along = side.normalize();
    corners.iter().all(|p| {
        let offset = p.xy() - start;
        let (s, depth) = (along.dot(&offset), along.perp(&offset));
        (depth - wall.depth_m).abs() < CORNER_TOLERANCE_M
            && s > -CORNER_TOLERANCE_M
            && s < side.norm() + CORNER_TOLERANCE_M
    })
}
