//! 3D lines from matched image segments (B99 3.2, figure 4).
//!
//! ```text
//! fit           four parameters, Levenberg-Marquardt on the distances of the measured segments
//!    -> extent  end points: the union of what the views support
//! ```

mod extent;
mod fit;
mod projection;
mod theta_frame;
mod track;

pub(crate) use extent::doubly_covered;
pub use fit::{Carrier, LineFit, Observation, conditioning, fit_line, fit_line_on, line_of_planes};
pub(crate) use fit::{Weighted, line_frame};
pub use projection::{Gate, ProjectedLine};
pub use theta_frame::{Side, ThetaFrame};
pub use track::{LineMatch, LineSupport, SupportKind};

use nalgebra::{Matrix3, Point3};
use serde::{Deserialize, Serialize};

use crate::geometry::Segment3;
use crate::ids::LineId;
use crate::params::Lines3dParams;
use crate::scene::Scene;

/// How a 3D line was found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LineOrigin {
    /// From image segments that belong together (B99 3, W96 3.5).
    #[default]
    Matched,
    /// Adopted of the other method (W96 3.5) beside lines of this one.
    Clustered,
    /// Where two planes intersect (B99 4.2, new lines).
    Intersection,
    /// The border of a facet, found again in the images (B99 4.3).
    Border,
}

impl LineOrigin {
    /// One lower-case word, as in the files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Matched => "matched",
            Self::Clustered => "clustered",
            Self::Intersection => "intersection",
            Self::Border => "border",
        }
    }
}

/// Why the finished model leaves a line out ([`crate::buildings::judge_lines`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Refutation {
    /// Roofs hide it from all but two of its views.
    Hidden,
    /// One end lies in the ground, the other does not.
    Underground,
    /// It lies on no surface, and the views are not certain enough of it to be believed alone.
    Afloat,
    /// Three views show it where six can see it.
    TooFewViews,
    /// Another line runs along it and is seen by more views, or is more certain.
    Repeated,
}

/// A reconstructed 3D line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line3d {
    /// How it was found.
    pub origin: LineOrigin,
    /// End points, metres, local frame. Every support's stretch runs the same way.
    pub segment: Segment3,
    /// Standard deviation of the line's position across itself, metres, the larger of both ends.
    pub sigma_m: f64,
    /// Covariance of the start and of the end point across the line, m^2 (3 x 3 each; zero along
    /// the line).
    pub covariance: [Matrix3<f64>; 2],
    /// The views that support it.
    pub supports: Vec<LineSupport>,
    /// Why it cannot be after all; no file shows it then.
    pub refuted: Option<Refutation>,
}

impl Line3d {
    /// The lines that stand, with their ids.
    pub fn standing(lines: &[Self]) -> impl Iterator<Item = (LineId, &Self)> + Clone {
        let numbered = lines.iter().enumerate();
        numbered
            .filter(|(_, line)| line.refuted.is_none())
            .map(|(i, line)| (LineId::from_index(i), line))
    }

    /// A point of the line, `t` from 0 to 1.
    pub fn at(&self, t: f64) -> Point3<f64> {
        self.segment.at(t)
    }
}

/// What became of a match.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "fate", rename_all = "snake_case")]
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
}

/// The trace of [`reconstruct_lines`].
#[derive(Clone, Debug, Default, Serialize)]
pub struct LineTrace {
    /// One for each match.
    pub outcomes: Vec<LineOutcome>,
    /// Total length of the lines, metres.
    pub length_m: f64,
}

/// Reconstructs a 3D line from the measured edges of each match.
pub fn reconstruct_lines(
    scene: &Scene,
    matches: &[LineMatch],
    params: &Lines3dParams,
) -> (Vec<Line3d>, LineTrace) {
    let results =
        crate::execution::map_part(matches, 0.0..1.0, |_, m| reconstruct(scene, m, params));
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

/// One line and its residual, or why there is none.
fn reconstruct(
    scene: &Scene,
    matched: &LineMatch,
    params: &Lines3dParams,
) -> Result<(Line3d, f64), LineOutcome> {
    let observations: Vec<Observation> = matched
        .supports
        .iter()
        .filter_map(|s| s.edge.as_ref())
        .map(|edge| Observation::of(edge, scene.camera(edge.view)))
        .collect();
    let start = line_of_planes(&observations).ok_or(LineOutcome::NoFit)?;
    let fit = fit_line(&observations, &start, params).ok_or(LineOutcome::NoFit)?;
    let (t0, t1) =
        extent::extent_of(scene, &fit.line, &matched.supports).ok_or(LineOutcome::NoExtent)?;
    let (d, length) = (fit.line.direction(), fit.line.length());
    let segment = Segment3::new(fit.line.p0 + d * t0, fit.line.p0 + d * t1);
    let (f0, f1) = (t0 / length, t1 / length);
    let sigma_m = fit.sigma_at(f0).max(fit.sigma_at(f1));
    let camera = scene.camera(matched.supports[0].view);
    let pixel_m = camera.ground_pixel(&segment.p0);
    if sigma_m > params.largest_sigma_px(segment.length() / pixel_m) * pixel_m {
        return Err(LineOutcome::IllConditioned { sigma_m });
    }
    let meant = Lines3dParams {
        position_floor_px: params.edge_floor_px,
        ..params.clone()
    };
    let stated = fit_line(&observations, &fit.line, &meant).ok_or(LineOutcome::NoFit)?;
    let squares: f64 = fit.residuals.iter().map(|r| r * r).sum();
    let line = Line3d {
        origin: LineOrigin::Matched,
        segment: along_supports(scene, segment, &matched.supports),
        sigma_m: stated.sigma_at(f0).max(stated.sigma_at(f1)),
        covariance: [f0, f1].map(|f| stated.covariance_at(f)),
        supports: matched.supports.clone(),
        refuted: None,
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
    use super::track::SupportKind;
    use super::*;
    use crate::geometry::Segment2;
    use crate::ids::ViewId;
    use crate::linematch::planted;
    use crate::lines2d::GuidedEdge;
    use crate::lines2d::SegmentKind;
    use nalgebra::Matrix2;

    /// The support of a view by an edge whose offset at the middle and angle times length have these variances, px^2.
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

    /// What becomes of the part of an eave whose edges are measured this exactly in three views, px.
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
        let matched = LineMatch {
            supports: [0, 1, 2].map(support).to_vec(),
            score: 1.0,
        };
        let (_, trace) = reconstruct_lines(&scene, &[matched], &Lines3dParams::default());
        trace.outcomes.into_iter().next().unwrap()
    }

    /// Edge 0 of the planted roof, measured in all views at ends that are `sigma_px` off, and stated to be `known_px` off.
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
        let matched = LineMatch {
            supports: (0..5).map(support).collect(),
            score: 1.0,
        };
        let (lines, _) = reconstruct_lines(&scene, &[matched], &Lines3dParams::default());
        lines.into_iter().next().expect("a line")
    }

    #[test]
    fn two_thirds_of_the_ends_lie_within_the_sigma_that_a_line_states() {
        // What the images show lies beside what is meant by more than the measurement knows.
        let floor = Lines3dParams::default().edge_floor_px;
        let known = 0.05;
        // The floor is one of the offset at the middle, and of the ends against each other.
        let sigma = (known * known + 2.0 * floor * floor).sqrt();
        let mut next = crate::testing::uniform(3);
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
