//! The textured model, where its walls stand, and with them the files.

use super::{Findings, Results, Stage, StageDefinition};
use crate::base::execution::Sharded;
use crate::base::params::Params;
use crate::orienting::scene::Scene;
use crate::results::texture::{TextureTrace, TexturedModel, texture_model};
use crate::roofs::buildings::{OtherGround, UncoveredRoof, uncovered_roofs};
use crate::roofs::model::{BuildingWalls, RoofModel};
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
        let terrain = scene.known.terrain.as_ref();
        let other_ground = results.other_ground(scene);
        Findings {
            counts: vec![
                ("faces", faces().count()),
                ("textured faces", textured),
                ("uncovered roofs", found.uncovered.len()),
            ],
            warnings: (terrain.into_iter())
                .filter_map(|terrain| OtherGround::warning(&terrain.file, &other_ground))
                .collect(),
        }
    }
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
