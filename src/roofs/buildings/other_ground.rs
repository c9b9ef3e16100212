//! Buildings that do not stand on the ground of a terrain model: the images contradict it there.

use nalgebra::{Point2, Point3, Vector2};
use serde::Serialize;

use crate::base::error::listed;
use crate::base::ids::BuildingId;
use crate::orienting::known::Terrain;
use crate::planes::terrain::Ground;
use crate::roofs::model::{Building, RoofModel};

/// A building on the ground that the images show, since they contradict the terrain model there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OtherGround {
    /// Its name in the files.
    pub building: String,
    /// From the terrain model to its ground, metres up.
    pub up_m: f64,
}

/// The buildings of a model, on this ground, below which the images contradict a terrain model.
pub fn other_ground(model: &RoofModel, ground: &Ground, terrain: &Terrain) -> Vec<OtherGround> {
    let middle = |ring: &[Point3<f64>]| {
        let sum: Vector2<f64> = ring.iter().map(|p| p.coords.xy()).sum();
        Point2::from(sum / ring.len() as f64)
    };
    let of_building = |(i, building): (usize, &Building)| {
        let facets = building.facets.iter().map(|f| &model.facets[f.index()]);
        let places = facets.flat_map(|facet| {
            let corners = facet.outer.iter().map(|p| p.xy());
            corners.chain([middle(&facet.outer)])
        });
        let up_m = ground.above_terrain(terrain, places)?;
        let building = BuildingId::from_index(i).name();
        Some(OtherGround { building, up_m })
    };
    let buildings = model.buildings.iter().enumerate();
    buildings.filter_map(of_building).collect()
}

impl OtherGround {
    /// What the user should know of all of them.
    pub fn warning(file: &str, buildings: &[Self]) -> Option<String> {
        let named = buildings.iter().map(|one| {
            let way = if one.up_m > 0.0 { "low" } else { "high" };
            format!("{} ({:.2} m too {way})", one.building, one.up_m.abs())
        });
        let names = listed(named);
        (!buildings.is_empty()).then(|| {
            format!(
                "the images contradict {file} below {names}: the ground that they show was used \
                 there"
            )
        })
    }
}
