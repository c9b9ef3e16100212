//! A first look at the model: the pipeline on smaller photographs, done long before the run itself.
//! It is shown until the run's own facets are there, and goes into no file and no later stage.

use serde::{Deserialize, Serialize};

use super::{PackedView, Run, Stage};
use crate::base::execution::progress;
use crate::base::params::{Method, Params};
use crate::orienting::scene::Scene;
use crate::roofs::model::RoofModel;

/// Photographs are reduced until all views together have no more pixels. A first look then takes
/// 1.2 to 1.8 s of one core in wasm with four or five buildings, and 3 s with fifteen: 1 s a
/// megapixel up to the half-planes, the rest for the facets.
const PIXELS: usize = 600_000;
/// A scene of fewer pixels is reconstructed as it is within 3 s, at 2.3 s a megapixel.
const ENOUGH_PIXELS: usize = 1_000_000;
/// The shorter side of a photograph keeps so many pixels, ten times the shortest segment.
const LEAST_SIDE: usize = 150;

/// What an instance needs for a first look, and no file or result of the run.
#[derive(Serialize, Deserialize)]
struct PackedPreliminary {
    region: Option<[f64; 4]>,
    views: Vec<PackedView>,
}

impl Run {
    /// The reduced views, for [`Self::of_preliminary`] of another instance, which may work beside
    /// this one; empty where the run itself is done soon, or the views are too small to be reduced.
    ///
    /// Terrain and footprints that are known are left out: the ground is measured in the images.
    pub fn pack_preliminary(&self) -> Vec<u8> {
        let Some(factor) = reduction(&self.scene) else {
            return Vec::new();
        };
        let scene = self.scene.reduced_in_colour(factor);
        let view = |i| PackedView::new(&scene, i, true);
        let packed = PackedPreliminary {
            region: scene.region,
            views: (0..scene.views.len()).filter_map(view).collect(),
        };
        postcard::to_stdvec(&packed).expect("bytes can be written to memory")
    }

    /// A run on views that another instance reduced, with the parameters of its run; `None` where
    /// the bytes are not that.
    pub fn of_preliminary(bytes: &[u8], params: &Params) -> Option<Self> {
        let packed: PackedPreliminary = postcard::from_bytes(bytes).ok()?;
        let mut run = Self::of_packed(packed.views, preliminary_params(params));
        run.scene.region = packed.region;
        Some(run)
    }

    /// Runs the stages up to the first model, and returns it.
    pub fn first_look(&mut self) -> RoofModel {
        let models = [Stage::Refinement, Stage::Rectangles];
        let stages = self.stages();
        if let Some(last) = models.into_iter().find(|stage| stages.contains(stage)) {
            self.step(last, &progress::silent());
        }
        self.results.found_model().cloned().unwrap_or_default()
    }
}

/// The whole factor by which photographs are reduced; `None` where that is not worth while.
fn reduction(scene: &Scene) -> Option<usize> {
    let sizes = || (scene.views.iter()).map(|v| [v.gray.width, v.gray.height]);
    let pixels: usize = sizes().map(|[width, height]| width * height).sum();
    let shorter = sizes().flatten().min()?;
    let wanted = (2..=shorter).find(|factor| pixels <= PIXELS * factor * factor)?;
    let factor = wanted.min(shorter / LEAST_SIDE);
    (pixels > ENOUGH_PIXELS && factor > 1).then_some(factor)
}

/// The parameters of a run without what takes time and moves facets by less than a large pixel.
/// Lengths in pixels stay: noise, windows and the accuracy of edges are as large in a mean of
/// pixels as in pixels.
fn preliminary_params(params: &Params) -> Params {
    let mut params = params.clone();
    if params.method == Method::Combined {
        params.method = Method::Lines;
    }
    params.dense.enabled = false;
    params.roof.refine.refine = false;
    params.corrections.clear();
    params
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::synthetic::l_scene;

    #[test]
    fn photographs_are_reduced_to_the_work_of_a_second_or_two() {
        let of = |size: u32| {
            let (mut scene, _) = l_scene(32);
            for view in &mut scene.views {
                view.gray.width = size as usize;
                view.gray.height = size as usize;
            }
            reduction(&scene)
        };
        // Six views: 0.6 megapixels are soon done, 2 are halved, 8.6 and 600 take a quarter and
        // what leaves 150 pixels.
        assert_eq!([320, 600, 1200].map(of), [None, Some(2), Some(4)]);
        assert_eq!(of(10_000), Some(32));
    }
}
