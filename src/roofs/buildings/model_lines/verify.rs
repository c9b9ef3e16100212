//! The lines of the result: matched lines weighed in the finished model, and new ones.

use serde::Serialize;

use super::duplicates::duplicate_lines;
use super::judge::judge_lines;
use super::new_lines::new_lines;
use crate::base::evidence::Evidence;
use crate::base::ids::LineId;
use crate::base::params::Params;
use crate::lines::lines3d::{Line3d, LineContradiction};
use crate::orienting::scene::Scene;
use crate::planes::terrain::Ground;
use crate::roofs::model::RoofModel;

/// What the finished model says of the lines. Ids and positions count the given lines and then the
/// new ones.
#[derive(Clone, Debug, Default, Serialize)]
pub struct VerifiedLines {
    /// Lines that the model adds to the given ones (B99 4.2, 4.3).
    pub new_lines: Vec<Line3d>,
    /// What speaks for each line and against it.
    pub evidence: Vec<Evidence>,
    /// The lines that the model contradicts or finds twice.
    pub contradicted: Vec<(LineId, LineContradiction)>,
}

/// Weighs the lines in a finished model, finds duplicates among those that stand, and measures the
/// edges of the model that none of them explains.
pub fn verify_lines(
    scene: &Scene,
    lines: &[Line3d],
    model: &RoofModel,
    ground: &Ground,
    params: &Params,
) -> VerifiedLines {
    let mut facets_on_lines = vec![0; lines.len()];
    for line in model.facets.iter().flat_map(|f| &f.lines) {
        facets_on_lines[line.index()] += 1;
    }
    let least = params.lines3d.least_nats;
    let improbable = |evidence: &[Evidence], first: usize| {
        let judged = evidence.iter().enumerate();
        let rejected = judged.filter(|(_, evidence)| !evidence.accepts(least));
        let ids = rejected.map(|(i, _)| LineId::from_index(first + i));
        ids.map(|id| (id, LineContradiction::Improbable))
            .collect::<Vec<_>>()
    };
    let on_it = |i: usize| facets_on_lines[i];
    let mut evidence = judge_lines(scene, lines, on_it, &model.facets, ground);
    let mut contradicted = improbable(&evidence, 0);
    let mut remaining = lines.to_vec();
    for (id, why) in &contradicted {
        remaining[id.index()].contradiction = Some(*why);
    }
    for id in duplicate_lines(scene, &remaining, params.matching.gate_px) {
        contradicted.push((id, LineContradiction::Duplicate));
        remaining[id.index()].contradiction = Some(LineContradiction::Duplicate);
    }
    let new_lines = new_lines(scene, &remaining, model, &params.matching, &params.lines3d);
    let of_new = judge_lines(scene, &new_lines, |_| 0, &model.facets, ground);
    contradicted.extend(improbable(&of_new, lines.len()));
    evidence.extend(of_new);
    VerifiedLines {
        new_lines,
        evidence,
        contradicted,
    }
}
