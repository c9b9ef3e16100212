//! The textured model, and with it the files.

use super::{Findings, Outcome, Results, Stage, StageDefinition};
use crate::execution::Sharded;
use crate::params::Params;
use crate::scene::Scene;
use crate::texture::{TextureTrace, TexturedModel, texture_model};

/// Textures of the model.
pub(super) type Found = Outcome<TexturedModel, TextureTrace>;

pub(super) struct Model;

impl StageDefinition for Model {
    type Found = Found;

    const NAME: &'static str = "model";
    const TITLE: &'static str = "Model";
    const SECTION: &'static str = "walls, texture, files";
    const READS: &'static [&'static str] = &["texture"];
    const NEEDS: &'static [Stage] = &[Stage::Corrections];

    fn run(scene: &Scene, params: &Params, before: &Results) -> Sharded<Found> {
        let model = before.roof_model().expect("stages run in their order");
        Ok(texture_model(scene, model, &params.texture).into())
    }

    fn summary(_: &Scene, found: &Found, _: &Results) -> Findings {
        let faces = || found.value.faces.iter().flatten();
        let textured = faces().filter(|f| f.view.is_some()).count();
        Findings {
            counts: vec![("faces", faces().count()), ("textured faces", textured)],
            warnings: Vec::new(),
        }
    }
}
