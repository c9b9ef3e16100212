//! The stage: a 3D line from the measured edges of each line track (B99 3.2, figure 4).

use serde::Serialize;

use super::extent::extent_of;
use super::fit::fit_line;
use super::line::{Line3d, LineOrigin};
use super::observation::Observation;
use super::plane_intersection::line_of_planes;
use super::projection::ProjectedLine;
use super::track::{LineSupport, LineTrack};
use crate::base::geometry::Segment3;
use crate::base::math::{larger, smaller};
use crate::base::params::Lines3dParams;
use crate::orienting::scene::Scene;

/// The outcome of one line track.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum LineOutcome {
    /// It is a 3D line.
    Reconstructed {
        /// Index of the line.
        line: u32,
        /// Root mean square of the weighted residuals, standard deviations.
        residual: f64,
    },
    /// Fewer than two measured segments, or planes that fix no line.
    NoFit,
    /// Less certain across itself than `max_sigma_px`.
    IllConditioned {
        /// Standard deviation, metres.
        sigma_m: f64,
    },
    /// No stretch that a view supports.
    NoExtent,
    /// No part of it lies in the region of interest.
    OutsideRegion,
}

/// The trace of [`reconstruct_lines`].
#[derive(Clone, Debug, Default, Serialize)]
pub struct LineTrace {
    /// One for each track.
    pub outcomes: Vec<LineOutcome>,
    /// Total length of the lines, metres.
    pub length_m: f64,
}

/// Reconstructs a 3D line from the measured edges of each track.
pub fn reconstruct_lines(
    scene: &Scene,
    tracks: &[LineTrack],
    params: &Lines3dParams,
) -> (Vec<Line3d>, LineTrace) {
    let results = crate::base::execution::map_part(tracks, 0.0..1.0, |_, track| {
        reconstruct(scene, track, params)
    });
    let mut lines: Vec<Line3d> = Vec::new();
    let mut trace = LineTrace::default();
    for result in results {
        trace.outcomes.push(match result {
            Ok((line, residual)) => {
                trace.length_m += line.segment.length();
                lines.push(line);
                LineOutcome::Reconstructed {
                    line: lines.len() as u32 - 1,
                    residual,
                }
            }
            Err(outcome) => outcome,
        });
    }
    (lines, trace)
}

/// Does some part of a stretch lie in a rectangle x0, y0, x1, y1 of the plan?
fn reaches_into(segment: &Segment3, [x0, y0, x1, y1]: [f64; 4]) -> bool {
    let along = segment.p1 - segment.p0;
    let (mut from, mut to) = (0.0, 1.0);
    for (at, step, low, high) in [
        (segment.p0.x, along.x, x0, x1),
        (segment.p0.y, along.y, y0, y1),
    ] {
        if step == 0.0 {
            if at < low || at > high {
                return false;
            }
            continue;
        }
        let (a, b) = ((low - at) / step, (high - at) / step);
        from = larger(from, a.min(b));
        to = smaller(to, a.max(b));
    }
    from <= to
}

/// One line and its residual, or why there is none.
fn reconstruct(
    scene: &Scene,
    track: &LineTrack,
    params: &Lines3dParams,
) -> Result<(Line3d, f64), LineOutcome> {
    let observations: Vec<Observation> = track
        .supports
        .iter()
        .filter_map(|s| s.edge.as_ref())
        .map(|edge| Observation::of(edge, scene.camera(edge.view)))
        .collect();
    let start = line_of_planes(&observations).ok_or(LineOutcome::NoFit)?;
    let fit = fit_line(&observations, &start, params).ok_or(LineOutcome::NoFit)?;
    let (t0, t1) = extent_of(scene, &fit.line, &track.supports).ok_or(LineOutcome::NoExtent)?;
    let (d, length) = (fit.line.direction(), fit.line.length());
    let segment = Segment3::new(fit.line.p0 + d * t0, fit.line.p0 + d * t1);
    if scene
        .region
        .is_some_and(|region| !reaches_into(&segment, region))
    {
        return Err(LineOutcome::OutsideRegion);
    }
    let (f0, f1) = (t0 / length, t1 / length);
    let sigma_m = fit.sigma_at(f0).max(fit.sigma_at(f1));
    let camera = scene.camera(track.supports[0].view);
    let pixel_m = camera.ground_pixel(&segment.p0);
    if sigma_m > params.largest_sigma_px(segment.length() / pixel_m) * pixel_m {
        return Err(LineOutcome::IllConditioned { sigma_m });
    }
    // The stated covariance is that of the roof's edge, not only of the edge in the images.
    let of_roof_edge = Lines3dParams {
        position_floor_px: params.edge_floor_px,
        ..params.clone()
    };
    let stated = fit_line(&observations, &fit.line, &of_roof_edge).ok_or(LineOutcome::NoFit)?;
    let squares: f64 = fit.residuals.iter().map(|r| r * r).sum();
    let line = Line3d {
        origin: LineOrigin::Matched,
        segment: along_supports(scene, segment, &track.supports),
        sigma_m: stated.sigma_at(f0).max(stated.sigma_at(f1)),
        covariance: [f0, f1].map(|f| stated.covariance_at(f)),
        probability: track.evidence.probability(),
        supports: track.supports.clone(),
        contradiction: None,
    };
    Ok((line, (squares / (2.0 * fit.residuals.len() as f64)).sqrt()))
}

/// The segment directed as its supports' stretches are.
fn along_supports(scene: &Scene, segment: Segment3, supports: &[LineSupport]) -> Segment3 {
    let along = supports.iter().find_map(|s| {
        let image = ProjectedLine::new(scene.camera(s.view), &segment)?;
        Some(image.direction.dot(&s.stretch.direction()))
    });
    match along {
        Some(d) if d < 0.0 => Segment3::new(segment.p1, segment.p0),
        _ => segment,
    }
}

#[cfg(test)]
mod tests {
    use super::super::track::SupportKind;
    use super::*;
    use crate::base::evidence::Evidence;
    use crate::base::geometry::Segment2;
    use crate::base::ids::ViewId;
    use crate::lines::lines2d::{GuidedEdge, SegmentKind};
    use crate::lines::lines3d::planted;
    use nalgebra::Matrix2;

    #[test]
    fn lines_reach_into_a_region_where_a_part_of_them_lies_in_it() {
        let region = [0.0, 0.0, 4.0, 2.0];
        let line = |a: [f64; 2], b: [f64; 2]| {
            let point = |[x, y]: [f64; 2]| nalgebra::Point3::new(x, y, 5.0);
            reaches_into(&Segment3::new(point(a), point(b)), region)
        };
        assert!(line([1.0, 1.0], [9.0, 9.0]), "an end");
        assert!(line([-1.0, 1.0], [5.0, 1.5]), "across");
        assert!(line([2.0, -1.0], [2.0, 3.0]), "across, along an axis");
        assert!(
            !line([5.0, 0.0], [5.0, 2.0]) && !line([-1.0, -1.0], [9.0, -1.0]),
            "beside"
        );
        assert!(!line([3.0, 4.0], [6.0, 1.0]), "past a corner");
    }

    fn certain() -> Evidence {
        Evidence {
            prior: 20.0,
            terms: Vec::new(),
        }
    }

    /// The support of a view by an edge whose offset at the middle and angle times length have
    /// these variances, px^2.
    fn support(view: usize, stretch: Segment2, [offset, turn]: [f64; 2]) -> LineSupport {
        let length = stretch.length();
        let edge = GuidedEdge {
            view: ViewId(view as u32),
            kind: SegmentKind::Edge,
            segment: stretch,
            covariance: Matrix2::new(offset, 0.0, 0.0, turn / (length * length)),
            pieces: vec![stretch],
        };
        LineSupport {
            view: edge.view,
            segments: Vec::new(),
            stretch,
            score: 1.0,
            kind: SupportKind::Matched,
            edge: Some(edge),
        }
    }

    /// The outcome of a part of an eave measured in three views with this standard deviation, px.
    fn outcome(from: f64, to: f64, sigma_px: f64) -> LineOutcome {
        let scene = planted::scene();
        let support = |view: usize| {
            let stretch = planted::part_of(&scene, view, 1, from, to);
            support(
                view,
                stretch,
                [sigma_px * sigma_px, 4.0 * sigma_px * sigma_px],
            )
        };
        let track = LineTrack {
            supports: [0, 1, 2].map(support).to_vec(),
            score: 1.0,
            evidence: certain(),
        };
        let params = Lines3dParams {
            max_sigma_px: 1.5,
            ..Lines3dParams::default()
        };
        let (_, trace) = reconstruct_lines(&scene, &[track], &params);
        trace.outcomes.into_iter().next().unwrap()
    }

    /// Edge 0 of the planted roof, measured in all views with errors of `sigma_px` at its ends and
    /// a stated covariance of `known_px`.
    fn reconstructed(sigma_px: f64, known_px: f64, next: &mut impl FnMut() -> f64) -> Line3d {
        let scene = planted::scene_without_photographs();
        let mut off = || {
            let twelve: f64 = (0..12).map(|_| next()).sum();
            sigma_px * (twelve - 6.0)
        };
        let support = |view: usize| {
            let exact = planted::part_of(&scene, view, 0, 0.0, 1.0);
            let normal = exact.normal();
            let stretch = Segment2::new(exact.p0 + normal * off(), exact.p1 + normal * off());
            support(
                view,
                stretch,
                [0.5 * known_px * known_px, 2.0 * known_px * known_px],
            )
        };
        let track = LineTrack {
            supports: (0..5).map(support).collect(),
            score: 1.0,
            evidence: certain(),
        };
        let (lines, _) = reconstruct_lines(&scene, &[track], &Lines3dParams::default());
        lines.into_iter().next().expect("a line")
    }

    #[test]
    fn two_thirds_of_the_ends_lie_within_the_sigma_that_a_line_states() {
        // The edge in the images lies off the edge of the roof by more than the measured
        // covariance.
        let floor = Lines3dParams::default().edge_floor_px;
        let known = 0.05;
        // The floor is one of the offset at the middle, and of the ends against each other.
        let sigma = (known * known + 2.0 * floor * floor).sqrt();
        let mut next = crate::roofs::testing::uniform(3);
        let (mut within, mut count) = (0, 0);
        for _ in 0..300 {
            let line = reconstructed(sigma, known, &mut next);
            let edge = planted::edges()[0];
            let mut largest = 0.0f64;
            let ends = [line.segment.p0, line.segment.p1];
            for (end, covariance) in ends.iter().zip(&line.covariance) {
                let eigen = covariance.symmetric_eigen();
                let worst = eigen.eigenvalues.imax();
                let across = eigen.eigenvectors.column(worst).into_owned();
                let stated = eigen.eigenvalues[worst].sqrt();
                let d = edge.direction();
                let foot = edge.p0 + d * (end - edge.p0).dot(&d);
                within += usize::from((end - foot).dot(&across).abs() <= stated);
                count += 1;
                largest = largest.max(stated);
            }
            assert!(
                (line.sigma_m - largest).abs() < 1e-9,
                "that of the worse end"
            );
        }
        let share = within as f64 / f64::from(count);
        assert!((0.64..0.72).contains(&share), "{share} of the ends");
    }

    #[test]
    fn a_long_line_may_be_less_certain_than_a_short_one() {
        let is_line = |outcome| matches!(outcome, LineOutcome::Reconstructed { .. });
        let uncertain = |outcome| matches!(outcome, LineOutcome::IllConditioned { .. });
        assert!(is_line(outcome(0.4, 0.6, 0.1)));
        assert!(
            uncertain(outcome(0.4, 0.6, 0.4)),
            "{:?}",
            outcome(0.4, 0.6, 0.4)
        );
        assert!(
            is_line(outcome(0.0, 1.0, 0.4)),
            "{:?}",
            outcome(0.0, 1.0, 0.4)
        );
        assert!(uncertain(outcome(0.0, 1.0, 1.0)));
    }
}
