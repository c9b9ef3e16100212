//! The lines of the result: matched lines checked against the finished model, and new ones.

use super::contradicted::contradicted_lines;
use super::duplicates::duplicate_lines;
use super::new_lines::new_lines;
use crate::ids::LineId;
use crate::lines3d::{Line3d, LineContradiction};
use crate::model::RoofModel;
use crate::params::Params;
use crate::scene::Scene;
use crate::terrain::Ground;

/// The new lines of a finished model, and the lines that it contradicts or finds twice. Ids count
/// the given lines and then the new ones. Edges that only contradicted lines explain are measured
/// again.
pub fn verify_lines(
    scene: &Scene,
    lines: &[Line3d],
    model: &RoofModel,
    ground: &Ground,
    params: &Params,
) -> (Vec<Line3d>, Vec<(LineId, LineContradiction)>) {
    let contradicted_among =
        |lines: &[Line3d]| contradicted_lines(scene, lines, &model.facets, ground, params);
    let mut rejected = contradicted_among(lines);
    let mut remaining = lines.to_vec();
    for (id, why) in &rejected {
        remaining[id.index()].contradiction = Some(*why);
    }
    for id in duplicate_lines(scene, &remaining, params.matching.gate_px) {
        rejected.push((id, LineContradiction::Duplicate));
        remaining[id.index()].contradiction = Some(LineContradiction::Duplicate);
    }
    let new = new_lines(scene, &remaining, model, &params.matching, &params.lines3d);
    let id_of_new = |id: LineId| LineId::from_index(lines.len() + id.index());
    let among_new = contradicted_among(&new).into_iter();
    rejected.extend(among_new.map(|(id, why)| (id_of_new(id), why)));
    (new, rejected)
}
