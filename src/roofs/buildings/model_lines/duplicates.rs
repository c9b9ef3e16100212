//! Lines that show the same edge as a better one (B99 3.4).
//!
//! An eave that is visible in grey values and in colour is matched twice. Both lines take part in
//! the search for roofs as two observations; in the result an edge is one line. Two lines are
//! duplicates if each reprojects onto the edges of the other, and the better one runs along the
//! other.

use std::cmp::Ordering;

use crate::base::ids::LineId;
use crate::base::line_linker::LineLinker;
use crate::lines::lines3d::{Line3d, reprojects_onto};
use crate::orienting::scene::Scene;

/// The standing lines that duplicate better ones. Edges within `gate_px` and three standard
/// deviations of a line's image are on it.
pub(super) fn duplicate_lines(scene: &Scene, lines: &[Line3d], gate_px: f64) -> Vec<LineId> {
    let mut best_first: Vec<(LineId, &Line3d)> = Line3d::standing(lines)
        .filter(|(_, line)| !line.supports.is_empty())
        .collect();
    best_first.sort_by(|a, b| by_views_then_sigma(a.1, b.1).then(a.0.cmp(&b.0)));
    let mut kept: Vec<&Line3d> = Vec::new();
    let mut duplicates = Vec::new();
    for (id, line) in best_first {
        let is_duplicate_of = |better: &&Line3d| {
            LineLinker::duplicate().connects(&better.segment.ends(), &line.segment.ends())
                && reprojects(scene, better, line, gate_px)
                && reprojects(scene, line, better, gate_px)
        };
        if kept.iter().any(is_duplicate_of) {
            duplicates.push(id);
        } else {
            kept.push(line);
        }
    }
    duplicates.sort_unstable();
    duplicates
}

/// The line of more views first, then the more certain one.
fn by_views_then_sigma(a: &Line3d, b: &Line3d) -> Ordering {
    let views = b.supports.len().cmp(&a.supports.len());
    views.then(a.sigma_m.total_cmp(&b.sigma_m))
}

/// Does the image of a line lie on the edges of another?
fn reprojects(scene: &Scene, line: &Line3d, onto: &Line3d, gate_px: f64) -> bool {
    let nearer_end = |t: f64| line.covariance[usize::from(t > 0.5 * line.segment.length())];
    let linker = LineLinker::reprojected_duplicate(gate_px);
    reprojects_onto(scene, (&line.segment, nearer_end), &onto.supports, &linker)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::{Segment2, Segment3};
    use crate::base::ids::ViewId;
    use crate::lines::lines2d::{GuidedEdge, SegmentKind};
    use crate::lines::lines3d::planted;
    use crate::lines::lines3d::{LineContradiction, LineSupport, SupportKind};
    use crate::roofs::testing;

    /// A part of the planted roof's edge, `up_m` above it, as some views show it.
    fn line(scene: &Scene, [from, to]: [f64; 2], views: u32, sigma_m: f64, up_m: f64) -> Line3d {
        let up = nalgebra::Vector3::z() * up_m;
        let [p0, p1] = [from, to].map(|t| planted::edges()[2].at(t) + up);
        let support = |view: u32| {
            let camera = scene.camera(ViewId(view));
            let ends = [p0, p1].map(|p| camera.project(&p).expect("in front"));
            let stretch = Segment2::new(ends[0], ends[1]);
            LineSupport {
                view: ViewId(view),
                segments: Vec::new(),
                stretch,
                score: 0.9,
                kind: SupportKind::Matched,
                edge: Some(GuidedEdge {
                    view: ViewId(view),
                    kind: SegmentKind::Color,
                    segment: stretch,
                    covariance: nalgebra::Matrix2::identity(),
                    pieces: Vec::new(),
                }),
            }
        };
        Line3d {
            sigma_m,
            covariance: [nalgebra::Matrix3::from_diagonal_element(sigma_m * sigma_m); 2],
            segment: Segment3::new(p0, p1),
            supports: (0..views).map(support).collect(),
            ..testing::line(p0, p1)
        }
    }

    #[test]
    fn of_two_lines_on_an_edge_the_better_one_that_runs_along_the_other_stays() {
        let scene = planted::scene_without_photographs();
        let duplicates = |a: &Line3d, b: &Line3d| {
            let lines = [a.clone(), b.clone()];
            duplicate_lines(&scene, &lines, 1.0)
        };
        let whole = line(&scene, [0.0, 1.0], 5, 0.01, 0.0);
        let seen_by_four = line(&scene, [0.05, 1.0], 4, 0.01, 0.0);
        let vague = line(&scene, [0.0, 1.0], 5, 0.02, 0.0);
        for worse in [&seen_by_four, &vague] {
            assert_eq!(duplicates(&whole, worse), [LineId(1)]);
            assert_eq!(duplicates(worse, &whole), [LineId(0)]);
        }
        // A better one that is shorter does not replace it.
        let half = line(&scene, [0.0, 0.5], 5, 0.005, 0.0);
        assert_eq!(duplicates(&whole, &half), []);
        // 1.5 m above it are two pixels and more in every view, unless the line is as uncertain as
        // that.
        assert_eq!(
            duplicates(&whole, &line(&scene, [0.0, 1.0], 4, 0.01, 1.5)),
            []
        );
        let uncertain = line(&scene, [0.0, 1.0], 5, 1.0, 1.5);
        let certain = line(&scene, [0.0, 1.0], 5, 0.9, 0.0);
        assert_eq!(duplicates(&uncertain, &certain), [LineId(0)]);
        // A contradicted line has no duplicates, and one of no views, such as an intersection, is
        // not compared.
        let contradicted = Line3d {
            contradiction: Some(LineContradiction::Improbable),
            ..whole.clone()
        };
        assert_eq!(duplicates(&contradicted, &vague), []);
        assert_eq!(
            duplicates(&whole, &line(&scene, [0.0, 1.0], 0, 0.01, 0.0)),
            []
        );
    }
}
