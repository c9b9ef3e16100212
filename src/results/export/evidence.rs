//! `evidence.json`: what spoke for every candidate and against it, in natural logarithms.

use nalgebra::Point3;
use serde_json::{Value, json};

use super::format::{rounded, to_bytes, world};
use crate::base::evidence::{Candidates, Evidence, JudgedFacet, JudgedLine, WindowHistogram};
use crate::orienting::scene::Scene;

/// `evidence.json`: every matched line, every line in the finished model, every facet, every block
/// on a roof and every plane between parallel lines that was weighed, every surface of dense
/// matching, and the classes in which the windows of the facets are counted. World frame of the
/// input.
pub fn evidence_json(scene: &Scene, candidates: &Candidates) -> Vec<u8> {
    let line = |line: &JudgedLine| {
        json!({
            "p0": world(scene, &line.segment.p0),
            "p1": world(scene, &line.segment.p1),
            "probability": rounded(line.evidence.probability(), 4),
            "terms": terms(&line.evidence),
        })
    };
    let lines_of = |lines: &[JudgedLine]| lines.iter().map(line).collect::<Vec<_>>();
    let facets_of =
        |facets: &[JudgedFacet]| -> Vec<_> { facets.iter().map(|f| facet(scene, f)).collect() };
    let surfaces = candidates.surfaces.iter().map(|s| {
        let patches = s.patches.iter().map(|p| world(scene, p));
        json!({
            "patches": patches.collect::<Vec<_>>(),
            "building": terms(&s.building),
            "vegetation": terms(&s.vegetation),
        })
    });
    let correlations: Vec<f64> = (0..WindowHistogram::CORRELATIONS)
        .map(|class| rounded(class as f64 / 10.0 - 1.0, 1))
        .collect();
    to_bytes(&json!({
        "lines": lines_of(&candidates.lines),
        "model_lines": lines_of(&candidates.model_lines),
        "facets": facets_of(&candidates.facets),
        "obstructions": facets_of(&candidates.obstructions),
        "rectangles": facets_of(&candidates.rectangles),
        "surfaces": surfaces.collect::<Vec<_>>(),
        "window_classes": {
            "weights_below": WindowHistogram::WEIGHTS_BELOW.map(|w| rounded(f64::from(w), 2)),
            "correlations_from": correlations,
        },
    }))
}

fn facet(scene: &Scene, facet: &JudgedFacet) -> Value {
    let ring =
        |ring: &Vec<Point3<f64>>| -> Vec<_> { ring.iter().map(|p| world(scene, p)).collect() };
    let counts =
        |of: &WindowHistogram| -> Vec<Vec<u32>> { of.rows().map(<[u32]>::to_vec).collect() };
    let n = facet.plane.normal;
    json!({
        "outline": ring(&facet.outline),
        "holes": facet.holes.iter().map(ring).collect::<Vec<_>>(),
        "plane": [n.x, n.y, n.z, facet.plane.d - n.dot(&scene.origin)],
        "accepted": facet.accepted,
        "probability": rounded(facet.evidence.probability(), 4),
        "terms": terms(&facet.evidence),
        "windows": {
            "on": counts(&facet.windows.on),
            "beside": counts(&facet.windows.beside),
        },
    })
}

fn terms(evidence: &Evidence) -> Vec<Value> {
    let term = |t: &crate::base::evidence::EvidenceTerm| {
        json!({
            "feature": t.feature,
            "value": rounded(t.value, 6),
            "nats": rounded(t.nats, 4),
        })
    };
    evidence.terms.iter().map(term).collect()
}
