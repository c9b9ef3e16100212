//! Method "rectangles": from the chosen planes between parallel lines to closed buildings (W96
//! 3.6).

use crate::base::ids::{BuildingId, LineId, ProposalOrigin};
use crate::planes::objectspace::{PlaneCandidate, RectangleTrace};
use crate::planes::terrain::Ground;
use crate::roofs::model::{Facet, RoofModel};
use crate::roofs::solids::close_above;

/// The buildings below the chosen planes.
pub fn roofs_of_rectangles(found: &RectangleTrace, ground: &Ground) -> RoofModel {
    let chosen = found.chosen.iter().map(|&k| facet(k, &found.candidates[k]));
    close_above(&chosen.collect::<Vec<_>>(), ground).0
}

fn facet(index: usize, candidate: &PlaneCandidate) -> Facet {
    Facet {
        proposals: vec![ProposalOrigin::Rectangle(index as u32)],
        obstructions: Vec::new(),
        building: BuildingId(0),
        plane: candidate.plane,
        outer: candidate.ring.clone(),
        holes: Vec::new(),
        similarity: candidate.correlation,
        real_ratio: candidate.features.outline_on_lines,
        uncertainty: None,
        probability: candidate.features.evidence().probability(),
        lines: candidate
            .lines
            .iter()
            .map(|&k| LineId::from_index(k))
            .collect(),
        half_planes: Vec::new(),
    }
}
