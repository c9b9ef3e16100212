//! 3D lines as the segments alone show them (B99 3.3, figures 5 to 8): before fragments were merged
//! and ends grown.

use crate::base::geometry::Segment3;
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::{Line3d, ProjectedLine};
use crate::orienting::scene::Scene;

/// The stretches of a 3D line that detected segments of at least two views cover, in their order
/// along the line.
pub fn detected_stretches(
    scene: &Scene,
    segments: &[Vec<ImageSegment>],
    line: &Line3d,
) -> Vec<Segment3> {
    let length = line.segment.length();
    let along = covered_twice(detected(scene, segments, line));
    let inside = along
        .into_iter()
        .map(|[from, to]| [from.max(0.0), to.min(length)])
        .filter(|[from, to]| to > from);
    let direction = line.segment.direction();
    let at = |t: f64| line.segment.p0 + direction * t;
    inside
        .map(|[from, to]| Segment3::new(at(from), at(to)))
        .collect()
}

/// Where the segments of all supports lie along the line, metres: view by view, so that fragments
/// of one view that overlap count once.
fn detected(scene: &Scene, segments: &[Vec<ImageSegment>], line: &Line3d) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    for support in &line.supports {
        let Some(image) = ProjectedLine::new(scene.camera(support.view), &line.segment) else {
            continue;
        };
        let stretches = support.segments.iter().filter_map(|id| {
            let detected = segments.get(support.view.index())?.get(id.index())?;
            let (s, e) = (
                image.t_of(&detected.segment.p0),
                image.t_of(&detected.segment.p1),
            );
            Some([s.min(e), s.max(e)])
        });
        found.extend(united(stretches.collect()));
    }
    found
}

/// The union of intervals.
fn united(mut intervals: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    intervals.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut out: Vec<[f64; 2]> = Vec::new();
    for interval in intervals {
        match out.last_mut() {
            Some(last) if interval[0] <= last[1] => last[1] = last[1].max(interval[1]),
            _ => out.push(interval),
        }
    }
    out
}

/// Where at least two intervals overlap.
fn covered_twice(intervals: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let mut ends: Vec<(f64, i32)> = intervals
        .iter()
        .flat_map(|&[from, to]| [(from, 1), (to, -1)])
        .collect();
    // At the same place an interval starts before another ends.
    ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    let (mut depth, mut start, mut out) = (0, 0.0, Vec::new());
    for (t, change) in ends {
        if change > 0 && depth == 1 {
            start = t;
        }
        if change < 0 && depth == 2 {
            out.push([start, t]);
        }
        depth += change;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_that_two_views_share_stays_open() {
        let covered = covered_twice(vec![[0.0, 4.0], [1.0, 3.0], [6.0, 9.0], [5.0, 8.0]]);
        assert_eq!(covered, vec![[1.0, 3.0], [6.0, 8.0]]);
        assert_eq!(covered_twice(vec![[0.0, 1.0]]), Vec::<[f64; 2]>::new());
    }

    #[test]
    fn fragments_of_one_view_are_no_second_view() {
        assert_eq!(
            united(vec![[2.0, 5.0], [0.0, 3.0], [7.0, 8.0]]),
            [[0.0, 5.0], [7.0, 8.0]]
        );
    }
}
