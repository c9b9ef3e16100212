//! The end points of a 3D line from the stretches that its views support.

use super::ProjectedLine;
use crate::geometry::Segment3;
use crate::linematch::LineSupport;
use crate::scene::Scene;
use crate::sorting::sort_by;

/// The outermost places along the line (metres from its start) that at least two views support, so
/// that one over-long segment does not lengthen the line. `None` without such a place.
pub fn common_extent(
    scene: &Scene,
    line: &Segment3,
    supports: &[LineSupport],
) -> Option<(f64, f64)> {
    let mut ends: Vec<(f64, i32)> = Vec::with_capacity(2 * supports.len());
    for support in supports {
        let image = ProjectedLine::new(scene.camera(support.view), line)?;
        let (t0, t1) = (
            image.t_of(&support.stretch.p0),
            image.t_of(&support.stretch.p1),
        );
        ends.push((t0.min(t1), 1));
        ends.push((t0.max(t1), -1));
    }
    doubly_covered(ends)
}

/// First and last place where two intervals overlap, from their starts (+1) and ends (-1).
pub fn doubly_covered(mut ends: Vec<(f64, i32)>) -> Option<(f64, f64)> {
    // At the same place an interval starts before another ends.
    sort_by(&mut ends, |a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
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
    use super::*;

    fn ends(intervals: &[(f64, f64)]) -> Vec<(f64, i32)> {
        intervals
            .iter()
            .flat_map(|(s, e)| [(*s, 1), (*e, -1)])
            .collect()
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
