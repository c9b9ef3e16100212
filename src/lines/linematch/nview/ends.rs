//! Ends of a line to a pixel.
//!
//! Support (B99 3.3) is known by pieces of some pixels, and a piece in which the edge ends counts
//! as a whole. The end of a stretch is therefore located edgel by edgel: the step across the line,
//! averaged over the views with the edge, falls there from its size inside to zero. The end lies
//! where it passes through half.

use super::profile::{LineProfile, ViewProfile};
use crate::lines::lines2d::PIECE_PX;
use crate::orienting::scene::Scene;

/// Range about the end of a stretch in which the edge may end, edgels: the piece before it, and
/// half a piece beyond it.
const EDGELS_BEFORE: usize = PIECE_PX as usize + 1;
const EDGELS_BEYOND: usize = PIECE_PX as usize / 2;
/// Number of edgels farther inside from which the size of the step is taken. Assumption: three
/// pieces.
const EDGELS_INSIDE: usize = 3 * PIECE_PX as usize;
/// Fewest of them: a piece.
const LEAST_EDGELS_INSIDE: usize = PIECE_PX as usize;
/// Half the base of the step across the line, px.
const BASE_PX: f64 = 1.0;

/// The stretch between the located ends of the edge. One that is too short to have an inside stays
/// as it is.
pub(super) fn located_ends(
    scene: &Scene,
    profile: &LineProfile,
    (start, end): (usize, usize),
) -> (usize, usize) {
    if end - start < 2 * EDGELS_BEFORE + LEAST_EDGELS_INSIDE {
        return (start, end);
    }
    let inner = (end - EDGELS_BEFORE)
        .saturating_sub(EDGELS_INSIDE)
        .max(start + EDGELS_BEFORE);
    let last = (end + EDGELS_BEYOND).min(profile.t.len() - 1);
    let forward: Vec<usize> = (inner..=last).collect();
    let outer = (start + EDGELS_BEFORE + EDGELS_INSIDE).min(end - EDGELS_BEFORE);
    let first = start.saturating_sub(EDGELS_BEYOND);
    let backward: Vec<usize> = (first..=outer).rev().collect();
    let ends_at = |edgels: &[usize], inside: usize| {
        let steps = steps(scene, profile, edgels, inside)?;
        Some(edgels[last_of_edge(&steps)])
    };
    (
        ends_at(&backward, outer + 1 - start - EDGELS_BEFORE).unwrap_or(start),
        ends_at(&forward, end + 1 - EDGELS_BEFORE - inner).unwrap_or(end),
    )
}

/// The step across the line at some edgels, relative to its mean over the first `inside` of them,
/// averaged with the step as weight. `None` where no view shows all of them.
fn steps(
    scene: &Scene,
    profile: &LineProfile,
    edgels: &[usize],
    inside: usize,
) -> Option<Vec<f64>> {
    let mut sums = vec![0.0; edgels.len()];
    let mut total = 0.0;
    for view in &profile.views {
        let Some(steps) = steps_in(scene, profile, view, edgels) else {
            continue;
        };
        let mean = steps[..inside].iter().sum::<f64>() / inside as f64;
        total += mean * mean;
        for (sum, step) in sums.iter_mut().zip(steps) {
            *sum += mean * step;
        }
    }
    (total > 0.0).then(|| sums.into_iter().map(|s| s / total).collect())
}

/// The step that one view shows across its measured edge; `None` without one, or where it leaves
/// the image.
fn steps_in(
    scene: &Scene,
    profile: &LineProfile,
    view: &ViewProfile,
    edgels: &[usize],
) -> Option<Vec<f64>> {
    let edge = view.edge.as_ref()?;
    let (image, _) = scene.view(view.view).channel(edge.kind.channel());
    let (line, normal) = (edge.segment.line(), edge.segment.normal());
    let step = |&edgel: &usize| {
        let p = view.image.at(profile.t[edgel])?;
        let on_edge = p - normal * line.dot(&p.to_homogeneous());
        let beside = |by: f64| {
            let q = on_edge + normal * by;
            image.sample(q.x as f32, q.y as f32).map(f64::from)
        };
        let (left, right) = (beside(-BASE_PX)?, beside(BASE_PX)?);
        Some(right - left)
    };
    edgels.iter().map(step).collect()
}

/// Index of the last edgel of an edge that begins inside: the best place of a fall of `steps` from
/// one to zero.
fn last_of_edge(steps: &[f64]) -> usize {
    let (mut sum, mut most, mut last) = (0.0, f64::NEG_INFINITY, 0);
    for (k, step) in steps.iter().enumerate() {
        sum += step - 0.5;
        if sum > most {
            (most, last) = (sum, k);
        }
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lines::lines2d::{SegmentKind, measure_edge};
    use crate::lines::lines3d::ProjectedLine;
    use crate::lines::lines3d::planted;

    #[test]
    fn an_edge_ends_where_its_step_falls_to_half() {
        assert_eq!(last_of_edge(&[1.1, 0.9, 1.0, 0.8, 0.3, 0.1, -0.1]), 3);
        assert_eq!(last_of_edge(&[1.0, 0.9, 0.4, 0.9, 1.0]), 4, "a faint place");
        assert_eq!(last_of_edge(&[1.0, 0.2, 0.1, 0.7, 0.0]), 0);
    }

    #[test]
    fn a_stretch_that_reaches_past_the_corners_of_a_roof_ends_at_them() {
        let scene = planted::scene();
        let edge = planted::edges()[1];
        let pixel = 0.1 / edge.length();
        let longer = |by: f64| {
            let (from, to) = (-by * pixel, 1.0 + by * pixel);
            crate::base::geometry::Segment3::new(edge.at(from), edge.at(to))
        };
        let reached = longer(3.0);
        let views: Vec<ViewProfile> = (scene.view_ids())
            .map(|view| {
                let image = ProjectedLine::new(scene.camera(view), &reached).expect("in front");
                let expected = planted::part_of(&scene, view.index(), 1, 0.0, 1.0);
                let core = [0.0, expected.length()];
                let kind = SegmentKind::Edge;
                let seen = scene.view(view).channel(kind.channel());
                let edge = measure_edge(view, seen, kind, &expected, core, false);
                ViewProfile {
                    view,
                    image,
                    segments: Vec::new(),
                    edge: Some(edge.expect("the edge of the roof")),
                    detected: Vec::new(),
                    inside: Vec::new(),
                    correlation: Vec::new(),
                    agreement: 1.0,
                }
            })
            .collect();
        let count = (reached.length() / 0.1) as usize;
        let t: Vec<f64> = (0..count).map(|k| (k as f64 + 0.5) * 0.1).collect();
        let profile = LineProfile {
            t,
            reference: 0,
            views,
        };
        let (start, end) = located_ends(&scene, &profile, (0, count - 1));
        assert!(start.abs_diff(3) <= 1, "starts at {start}");
        assert!(end.abs_diff(count - 4) <= 1, "ends at {end} of {count}");
        assert_eq!(
            located_ends(&scene, &profile, (4, count - 5)),
            (start, end),
            "and from a pixel too short"
        );
        assert_eq!(
            located_ends(&scene, &profile, (40, 50)),
            (40, 50),
            "too short"
        );
    }
}
