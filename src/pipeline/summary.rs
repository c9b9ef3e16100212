//! What a stage found, in numbers and warnings that a person reads.

use serde::{Serialize, Serializer};

use super::stage::Stage;
use super::{Outcome, Results};
use crate::lines3d::SupportKind;
use crate::scene::Scene;

/// The outcome of one stage in numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StageSummary {
    /// The stage.
    pub stage: Stage,
    /// What it counted, by name; the most important first.
    #[serde(serialize_with = "as_map")]
    pub counts: Vec<(&'static str, usize)>,
    /// What the user should know; each says what to do.
    pub warnings: Vec<String>,
}

/// The summary of a stage that has just run.
pub(crate) fn summarise(stage: Stage, scene: &Scene, results: &Results) -> StageSummary {
    let (counts, warnings) = match stage {
        Stage::Segments => segments(scene, results),
        Stage::Matches => matches(results),
        Stage::Lines => lines(results),
        Stage::HalfPlanes => half_planes(results),
        Stage::Facets => facets(results),
        Stage::Regions => regions(scene, results),
        Stage::Directions => directions(results),
        Stage::Clusters => clusters(results),
        Stage::Rectangles => rectangles(results),
        Stage::Model => model(results),
    };
    StageSummary {
        stage,
        counts,
        warnings,
    }
}

type Found = (Vec<(&'static str, usize)>, Vec<String>);

fn segments(scene: &Scene, results: &Results) -> Found {
    let per_view = results.segments.as_ref().map_or(&[][..], |s| &s.value);
    let warnings = scene
        .views
        .iter()
        .zip(per_view)
        .filter(|(_, segments)| segments.is_empty())
        .map(|(view, _)| {
            format!(
                "{}: no straight edge found; leave this view out, or lower segments.edgels.high",
                view.name
            )
        })
        .collect();
    let total = per_view.iter().map(Vec::len).sum();
    (
        vec![("views", scene.views.len()), ("segments", total)],
        warnings,
    )
}

fn matches(results: &Results) -> Found {
    let matches = results.matches.as_ref().map_or(&[][..], |m| &m.value);
    let supports = || matches.iter().flat_map(|m| &m.supports);
    let of_kind = |kind| supports().filter(|s| s.kind == kind).count();
    let counts = vec![
        ("matches", matches.len()),
        ("supports", supports().count()),
        (
            "matched segments",
            supports().map(|s| s.segments.len()).sum(),
        ),
        ("merged supports", of_kind(SupportKind::Merged)),
        ("grown supports", of_kind(SupportKind::Grown)),
    ];
    let none = "no line was matched over three views; check that the orientation belongs to these \
                images (angle units, order of rotations, pixel size) and that the views overlap";
    (counts, warn_if(matches.is_empty(), none))
}

fn lines(results: &Results) -> Found {
    let lines = results.lines.as_ref().map_or(&[][..], |l| &l.value);
    let none = "none of the matches is long and well enough seen to give a 3D line";
    (
        vec![("lines", lines.len())],
        warn_if(lines.is_empty() && some(&results.matches), none),
    )
}

fn half_planes(results: &Results) -> Found {
    let found = results.half_planes.as_ref().map_or(&[][..], |h| &h.value);
    let correlations = results
        .half_planes
        .as_ref()
        .map_or(0, |h| h.trace.correlations);
    let correlations = usize::try_from(correlations).unwrap_or(usize::MAX);
    let none = "no half-plane was accepted; the surfaces may have too little texture: try a lower \
                sweep.min_similarity";
    (
        vec![("half-planes", found.len()), ("correlations", correlations)],
        warn_if(found.is_empty() && some(&results.lines), none),
    )
}

fn facets(results: &Results) -> Found {
    let Some(roof) = &results.roof else {
        return (Vec::new(), Vec::new());
    };
    let model = &roof.value;
    let counts = vec![
        ("facets", model.facets.len()),
        ("buildings", model.buildings.len()),
        ("refuted lines", roof.trace.refuted_lines.len()),
    ];
    let none = "no roof facet was found: the model is empty";
    let warnings = warn_if(model.facets.is_empty() && some(&results.half_planes), none);
    (counts, warnings)
}

fn regions(scene: &Scene, results: &Results) -> Found {
    let Some(found) = &results.regions else {
        return (Vec::new(), Vec::new());
    };
    let regions = found.trace.iter().map(|s| s.regions.len()).sum();
    let lines = found.value.iter().map(Vec::len).sum();
    let empty = scene
        .views
        .iter()
        .zip(&found.value)
        .filter(|(_, l)| l.is_empty());
    let warnings = empty.map(|(view, _)| {
        format!(
            "{}: no straight region boundary found; leave this view out",
            view.name
        )
    });
    let counts = vec![
        ("views", scene.views.len()),
        ("regions", regions),
        ("lines", lines),
    ];
    (counts, warnings.collect())
}

fn directions(results: &Results) -> Found {
    let windows = results.directions.as_ref().map_or(&[][..], |d| &d.value);
    let pairs = windows.iter().map(|w| w.directions.len()).sum();
    let none = "no main direction was found: the lines run all ways; try method lines";
    (
        vec![("windows", windows.len()), ("pairs of directions", pairs)],
        warn_if(pairs == 0, none),
    )
}

fn clusters(results: &Results) -> Found {
    let lines = results.clusters.as_ref().map_or(&[][..], |c| &c.value);
    let none = "no 3D line was found; check that the orientation belongs to these images and that the views overlap";
    (
        vec![("lines", lines.len())],
        warn_if(lines.is_empty() && some(&results.directions), none),
    )
}

fn rectangles(results: &Results) -> Found {
    let Some(found) = &results.rectangles else {
        return (Vec::new(), Vec::new());
    };
    let counts = vec![
        ("facets", found.value.facets.len()),
        ("buildings", found.value.buildings.len()),
        ("candidates", found.trace.candidates.len()),
        ("pairs of lines", found.trace.pairs.len()),
    ];
    let none = "no plane between parallel lines was accepted: the model is empty";
    let empty = found.value.facets.is_empty() && some(&results.clusters);
    (counts, warn_if(empty, none))
}

fn model(results: &Results) -> Found {
    let Some(textured) = &results.textured else {
        return (Vec::new(), Vec::new());
    };
    let faces = || textured.value.faces.iter().flatten();
    let counts = vec![
        ("faces", faces().count()),
        (
            "textured faces",
            faces().filter(|f| f.view.is_some()).count(),
        ),
    ];
    (counts, Vec::new())
}

/// Did the stage before find anything? Where it did not, it has warned already.
fn some<V, T>(outcome: &Option<Outcome<Vec<V>, T>>) -> bool {
    outcome.as_ref().is_some_and(|o| !o.value.is_empty())
}

/// An object whose members keep their order.
fn as_map<S: Serializer>(
    counts: &[(&'static str, usize)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(counts.iter().copied())
}

fn warn_if(condition: bool, warning: &str) -> Vec<String> {
    condition.then(|| warning.to_owned()).into_iter().collect()
}
