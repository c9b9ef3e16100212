//! What several files say of roofs in numbers.

use crate::base::ids::FacetId;
use crate::orienting::orientation::FrameSigma;
use crate::orienting::scene::Scene;
use crate::results::roof_report::{BuildingReport, FacetReport, roof_report, views_of_facets};
use crate::roofs::model::RoofModel;

/// Buildings in a frame that is known as well as this, where that is stated.
pub(super) fn in_frame(
    buildings: Vec<BuildingReport>,
    frame: Option<&FrameSigma>,
) -> Vec<BuildingReport> {
    match frame {
        Some(frame) => buildings.into_iter().map(|b| b.in_frame(frame)).collect(),
        None => buildings,
    }
}

/// The measures of a model, and the photographs that show it.
pub(super) struct Measured {
    pub(super) buildings: Vec<BuildingReport>,
    /// Names, per facet of the model.
    pub(super) photographs: Vec<Vec<String>>,
}

impl Measured {
    pub(super) fn new(scene: &Scene, model: &RoofModel) -> Self {
        let names = |views: Vec<crate::base::ids::ViewId>| {
            let names = views.into_iter().map(|v| scene.view(v).name.clone());
            names.collect()
        };
        Self {
            buildings: in_frame(roof_report(model, &[]), scene.survey.frame_sigma.as_ref()),
            photographs: (views_of_facets(scene, model).into_iter())
                .map(names)
                .collect(),
        }
    }

    /// The measures of a facet; `None` for one that is in no building.
    pub(super) fn facet(&self, id: FacetId) -> Option<&FacetReport> {
        let facets = self.buildings.iter().flat_map(|b| &b.facets);
        facets.into_iter().find(|f| f.facet == id)
    }
}
