//! What is measured of a facet, for the model that weighs it.

use super::displaced_plane::{PartVisibility, PlaneAgreement};
use super::interior::InteriorWindows;
use crate::base::evidence::WindowCounts;
use crate::base::math::{larger, ln};
use crate::orienting::scene::{Scene, excess_green};
use crate::roofs::facets::competing_planes::CompetingPlanes;
use crate::roofs::facets::delineation::Outline;
use crate::roofs::model::{Facet, Occluders};

/// Share of a facet that another plane must be able to cover to be its rival. Assumption.
const RIVAL_SHARE: f64 = 0.9;

/// Advantage of a facet that has no rival over its rivals, standard deviations: more than any has.
const NO_RIVAL: f64 = 12.0;

/// What was measured of a facet, where these views see it.
#[derive(Clone, Debug)]
pub(crate) struct Measured {
    facet: Facet,
    visibility: PartVisibility,
    /// In the order of the model.
    pub(super) features: [(&'static str, f64); 8],
    /// The windows inside it.
    pub(super) windows: WindowCounts,
}

impl Measured {
    /// Measures a facet between the other facets. `colours` are the photographs as they were taken.
    /// What was measured `before` holds as long as facet and views are the same.
    pub(super) fn of(
        competing: &CompetingPlanes,
        facet: &Facet,
        outline: &Outline,
        occluders: &Occluders,
        colours: &Scene,
        before: Option<&Self>,
    ) -> Self {
        let map = &competing.maps[outline.plane as usize];
        let hidden = competing.hidden_by(occluders);
        let visibility = PartVisibility::new(&competing.scene, facet, map.grid.step, &hidden);
        if let Some(before) = before.filter(|b| b.facet == *facet && b.visibility == visibility) {
            return before.clone();
        }
        let inside = InteriorWindows::of(facet, map);
        let agreement =
            PlaneAgreement::measure(&competing.scene, facet, map.grid.step, &visibility);
        let places = inside.places().map(|p| facet.plane.lift(p.x, p.y));
        let features = [
            // tau_real of B99 4.3.
            ("outline_on_lines", facet.real_ratio),
            ("displaced_plane_margin_sigmas", agreement.margin_sigmas),
            (
                "rival_plane_margin_sigmas",
                rival_margin(competing, outline, &inside),
            ),
            (
                "excess_green",
                excess_green(colours, &places.collect::<Vec<_>>()),
            ),
            ("ln_area_m2", ln(larger(facet.sloped_area(), 1e-3))),
            ("ln_1_plus_lines", ln(1.0 + facet.lines.len() as f64)),
            (
                "ln_1_plus_half_planes",
                ln(1.0 + facet.half_planes.len() as f64),
            ),
            ("cos_slope", facet.plane.normal.z),
        ];
        Self {
            facet: facet.clone(),
            visibility,
            features,
            windows: agreement.windows,
        }
    }
}

/// By how much the views agree better on a facet's plane than on the best other one that could
/// cover it, inside it, in standard deviations. A level plane through the ridges of two roofs has
/// more edges than the roof between them, and little else.
fn rival_margin(competing: &CompetingPlanes, outline: &Outline, inside: &InteriorWindows) -> f64 {
    let mut areas = vec![0.0; competing.planes.len()];
    for (plane, evidence) in (outline.cells.iter()).flat_map(|&c| competing.evidence.of_cell(c)) {
        areas[*plane as usize] += evidence.area;
    }
    let most = RIVAL_SHARE * areas[outline.plane as usize];
    let others = (0..competing.planes.len() as u32).filter(|p| *p != outline.plane);
    let rivals = others.filter(|p| areas[*p as usize] >= most);
    let advantages = rivals.map(|p| inside.advantage_of(&competing.maps[p as usize]));
    -advantages.fold(-NO_RIVAL, larger)
}
