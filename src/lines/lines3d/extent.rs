//! The end points of a 3D line from the stretches that its views support (B99 3.3): their union.

use super::projection::ProjectedLine;
use super::track::LineSupport;
use crate::base::geometry::Segment3;
use crate::orienting::scene::Scene;

/// The outermost places along the line that a view supports, metres from its start.
///
/// One view is enough, because the images of the others may end before; which places a support
/// reaches, growing has decided. `None` without supports, or where one does not see the line.
pub(super) fn extent_of(
    scene: &Scene,
    line: &Segment3,
    supports: &[LineSupport],
) -> Option<(f64, f64)> {
    let mut union = (f64::INFINITY, f64::NEG_INFINITY);
    for support in supports {
        let image = ProjectedLine::new(scene.camera(support.view), line)?;
        for end in [&support.stretch.p0, &support.stretch.p1] {
            let t = image.t_of(end);
            union = (union.0.min(t), union.1.max(t));
        }
    }
    (union.1 > union.0).then_some(union)
}

/// First and last place where two intervals overlap, from their starts (+1) and ends (-1).
pub(crate) fn doubly_covered(mut ends: Vec<(f64, i32)>) -> Option<(f64, f64)> {
    // At the same place an interval starts before another ends.
    ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    let (mut covered, mut first, mut last) = (0, None, None);
    for (t, change) in ends {
        covered += change;
        if change > 0 && covered == 2 {
            first = first.or(Some(t));
        }
        if change < 0 && covered == 1 {
            last = Some(t);
        }
    }
    Some((first?, last?)).filter(|(f, l)| l > f)
}

#[cfg(test)]
mod tests {
    use super::super::track::SupportKind;
    use super::*;
    use crate::base::ids::ViewId;
    use crate::lines::lines3d::planted;

    fn ends(intervals: &[(f64, f64)]) -> Vec<(f64, i32)> {
        intervals
            .iter()
            .flat_map(|(s, e)| [(*s, 1), (*e, -1)])
            .collect()
    }

    /// The extent of the planted roof's first edge from supports by parts of it, one part a view.
    fn extent(parts: &[(f64, f64)]) -> Option<(f64, f64)> {
        let scene = planted::scene_without_photographs();
        let edge = planted::edges()[0];
        let support = |(view, &(from, to)): (usize, &(f64, f64))| LineSupport {
            view: ViewId(view as u32),
            segments: Vec::new(),
            stretch: planted::part_of(&scene, view, 0, from, to),
            score: 1.0,
            kind: SupportKind::Matched,
            edge: None,
        };
        let supports: Vec<LineSupport> = parts.iter().enumerate().map(support).collect();
        let (from, to) = extent_of(&scene, &edge, &supports)?;
        Some((from / edge.length(), to / edge.length()))
    }

    #[test]
    fn a_line_reaches_as_far_as_any_of_its_views_supports_it() {
        let (from, to) = extent(&[(0.2, 0.6), (0.1, 0.5), (0.3, 0.9)]).expect("a stretch");
        assert!((from - 0.1).abs() < 1e-9 && (to - 0.9).abs() < 1e-9);
        // A stretch may run either way.
        assert_eq!(extent(&[(0.6, 0.2)]).map(|(f, t)| f < t), Some(true));
        assert_eq!(extent(&[]), None);
    }

    #[test]
    fn one_over_long_segment_is_cut() {
        let covered = doubly_covered(ends(&[(0.0, 10.0), (1.0, 30.0), (-5.0, 9.0)]));
        assert_eq!(covered, Some((0.0, 10.0)));
    }

    #[test]
    fn intervals_apart_have_no_common_extent() {
        assert_eq!(doubly_covered(ends(&[(0.0, 1.0), (2.0, 3.0)])), None);
        assert_eq!(doubly_covered(ends(&[(0.0, 1.0)])), None);
    }
}
