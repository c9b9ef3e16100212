//! The textured model, where its walls stand, and with them the files.

use nalgebra::{Point2, Point3, Vector2};
use serde::Serialize;

use super::{Findings, Results, Stage, StageDefinition};
use crate::base::error::listed;
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::results::texture::{TextureTrace, TexturedModel, texture_model};
use crate::roofs::buildings::{UncoveredRoof, uncovered_roofs};
use crate::roofs::model::{Building, BuildingWalls, RoofModel};
use crate::roofs::walls::place_walls;

/// Textures and walls of the model.
#[derive(Clone, Debug)]
pub struct Found {
    /// The textures.
    pub value: TexturedModel,
    /// How they came about.
    pub trace: TextureTrace,
    /// For each building where its walls stand.
    pub walls: Vec<BuildingWalls>,
    /// Where a roof may be and the model has none.
    pub uncovered: Vec<UncoveredRoof>,
}

pub(super) struct Model;

impl StageDefinition for Model {
    type Found = Found;

    const NAME: &'static str = "model";
    const TITLE: &'static str = "Model";
    const SECTION: &'static str = "walls, texture, files";
    const READS: &'static [&'static str] = &["texture"];
    const NEEDS: &'static [Stage] = &[Stage::Ground, Stage::Corrections];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let model = before.roof_model().expect("stages run in their order");
        let (value, trace) = texture_model(scene, model, &params.texture);
        Ok(Found {
            value,
            trace,
            walls: place_walls(scene, model, before.ground.as_ref()),
            uncovered: uncovered(model, before),
        })
    }

    fn summary(scene: &Scene, found: &Found, results: &Results) -> Findings {
        let faces = || found.value.faces.iter().flatten();
        let textured = faces().filter(|f| f.view.is_some()).count();
        Findings {
            counts: vec![
                ("faces", faces().count()),
                ("textured faces", textured),
                ("uncovered roofs", found.uncovered.len()),
            ],
            warnings: ground_warning(scene, &other_ground(scene, results)),
        }
    }
}

/// A building on the ground that the images show, since they contradict the terrain model there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(in super::super) struct OtherGround {
    /// Its name in the files.
    building: String,
    /// From the terrain model to its ground, metres up.
    up_m: f64,
}

/// The buildings that do not stand on the ground of a terrain model that counted.
pub(in super::super) fn other_ground(scene: &Scene, results: &Results) -> Vec<OtherGround> {
    let known = (results.roof_model())
        .zip(results.ground.as_ref())
        .zip(scene.known.terrain.as_ref());
    let Some(((model, ground), terrain)) = known else {
        return Vec::new();
    };
    let of_building = |(i, building): (usize, &Building)| {
        let facets = building.facets.iter().map(|f| &model.facets[f.index()]);
        let middle = |ring: &[Point3<f64>]| {
            let sum: Vector2<f64> = ring.iter().map(|p| p.coords.xy()).sum();
            Point2::from(sum / ring.len() as f64)
        };
        let places = facets.flat_map(|facet| {
            let corners = facet.outer.iter().map(|p| p.xy());
            corners.chain([middle(&facet.outer)])
        });
        let up_m = ground.above_terrain(terrain, places)?;
        let building = format!("building-{i}");
        Some(OtherGround { building, up_m })
    };
    (model.buildings.iter().enumerate())
        .filter_map(of_building)
        .collect()
}

fn ground_warning(scene: &Scene, buildings: &[OtherGround]) -> Vec<String> {
    let named = buildings.iter().map(|one| {
        let way = if one.up_m > 0.0 { "low" } else { "high" };
        format!("{} ({:.2} m too {way})", one.building, one.up_m.abs())
    });
    let names: Vec<String> = named.collect();
    let terrain = scene.known.terrain.as_ref().filter(|_| !names.is_empty());
    let words = terrain.map(|terrain| {
        format!(
            "the images contradict {} below {}: the ground that they show was used there",
            terrain.file,
            listed(&names)
        )
    });
    words.into_iter().collect()
}

fn uncovered(model: &RoofModel, before: &Results) -> Vec<UncoveredRoof> {
    let facets = before.facets.as_ref();
    let rejected = facets.map_or(&[][..], |found| &found.trace.facets.rejected);
    let dense = before.dense.as_ref();
    uncovered_roofs(
        model,
        rejected,
        dense.map(|found| (&found.value[..], &found.trace)),
    )
}
