//! Cluster lines for the other method: those whose image lines its matched lines do not explain.
//!
//! A cluster takes its image lines away from all others (`clusters`), and so does a matched line,
//! which is more accurate. What they leave of a cluster must still be seen in as many views, and
//! cover as much of it there, as W96 3.5 requires of any line.
//!
//! Tried without gain: to measure the lines that stay again in all views, as borders of facets are.
//! Edges that only regions show are weak, and what lies along one is often another.

use nalgebra::Point2;

use super::clusters::{END_PX, LEAST_COVERAGE, PARALLEL_DEG};
use super::oris::RegionLine;
use super::stages::{FoundLine, world_lines};
use crate::base::geometry::{Segment2, Segment3};
use crate::base::ids::ViewId;
use crate::base::line_linker::LineLinker;
use crate::base::params::ClusterParams;
use crate::lines::lines3d::{Line3d, LineOrigin, ProjectedLine};
use crate::orienting::scene::Scene;

/// The cluster lines that the matched lines do not explain. They name no image lines: those of
/// regions are not the segments of the other method.
pub fn adopted_lines(
    scene: &Scene,
    regions: &[Vec<RegionLine>],
    found: &[FoundLine],
    matched: &[Line3d],
    params: &ClusterParams,
) -> Vec<Line3d> {
    let open = unexplained(scene, regions, matched, params);
    let mut lines = world_lines(scene, regions, found);
    lines.retain(|line| is_new(line, &open, params));
    for line in &mut lines {
        line.origin = LineOrigin::Clustered;
        line.supports.iter_mut().for_each(|s| s.segments.clear());
    }
    lines
}

/// Is enough of the line unexplained in enough views?
fn is_new(line: &Line3d, open: &[Vec<f64>], params: &ClusterParams) -> bool {
    let views = line.supports.iter().filter(|s| {
        let own = s.segments.iter();
        let own = own.map(|id| open[s.view.index()][id.index()]);
        own.sum::<f64>() >= LEAST_COVERAGE * s.stretch.length()
    });
    views.count() >= params.min_views
}

/// Of each region line of each view the length that no matched line explains, pixels.
fn unexplained(
    scene: &Scene,
    regions: &[Vec<RegionLine>],
    matched: &[Line3d],
    params: &ClusterParams,
) -> Vec<Vec<f64>> {
    let views: Vec<ViewId> = scene.view_ids().collect();
    crate::base::execution::map(&views, |_, &view| {
        let image = |l: &Line3d| projected(scene, view, &l.segment);
        let images: Vec<Segment2> = matched.iter().filter_map(image).collect();
        let lines = regions[view.index()].iter();
        lines
            .map(|l| open_length(&l.line.segment, &images, params))
            .collect()
    })
}

/// The image of a line in a view.
fn projected(scene: &Scene, view: ViewId, line: &Segment3) -> Option<Segment2> {
    let image = ProjectedLine::new(scene.camera(view), line)?;
    Some(Segment2::new(image.at(0.0)?, image.at(line.length())?))
}

/// The length of an image line beside which none of the others runs, pixels.
fn open_length(line: &Segment2, others: &[Segment2], params: &ClusterParams) -> f64 {
    // A short line's direction is as uncertain as its ends.
    let of_ends = END_PX / line.length().max(1e-9);
    let sine = of_ends.max(crate::base::math::sin(PARALLEL_DEG.to_radians()));
    let linker = LineLinker::explained_image_line(sine, params.gate_px);
    let direction = line.direction();
    let beside: Vec<[Point2<f64>; 2]> = (others.iter().map(Segment2::ends))
        .filter(|[p, q]| linker.angle(&direction, &(q - p)) >= 0.0)
        .collect();
    let samples = line.length().ceil().max(1.0);
    let at = |i: usize| line.at((i as f64 + 0.5) / samples);
    let open = (0..samples as usize)
        .map(at)
        .filter(|p| !beside.iter().any(|line| linker.passes(line, p)));
    open.count() as f64 / samples * line.length()
}

#[cfg(test)]
mod tests {
    use super::super::clusters::ClusterLine;
    use super::super::fixture::{planted_lines, rig};
    use super::*;
    use nalgebra::Point3;

    /// Two eaves of 8 m, seen in all views, as clusters.
    fn eaves() -> (Scene, Vec<Vec<RegionLine>>, Vec<FoundLine>) {
        let scene = rig(6);
        let eave = |y: f64| Segment3::new(Point3::new(-4.0, y, 5.0), Point3::new(4.0, y, 5.0));
        let truth = [eave(-3.0), eave(3.0)];
        let regions = planted_lines(&scene, &truth, 0.0, &[]);
        let cluster = |(k, segment): (usize, &Segment3)| ClusterLine {
            segment: *segment,
            supports: (0..6).map(|view| 2 * view + k).collect(),
            gain_bits: 20.0,
            coverage: scene.view_ids().map(|view| (view, 1.0)).collect(),
            sigma_m: 0.05,
        };
        let found = truth.iter().enumerate().map(|line| FoundLine {
            window: 0,
            direction: [0, 0],
            line: cluster(line),
        });
        let found = found.collect();
        (scene, regions, found)
    }

    /// The places y of the adopted lines, where lines are matched from -4 m as far as `to_m` at y =
    /// -3 m.
    fn adopted(to_m: f64) -> Vec<f64> {
        let (scene, regions, found) = eaves();
        let mut matched = world_lines(&scene, &regions, &found[..1]);
        matched[0].segment.p1.x = to_m;
        let params = ClusterParams::default();
        let lines = adopted_lines(&scene, &regions, &found, &matched, &params);
        let supports = || lines.iter().flat_map(|l| &l.supports);
        assert!(lines.iter().all(|l| l.origin == LineOrigin::Clustered));
        assert!(supports().count() > 0 && supports().all(|s| s.segments.is_empty()));
        lines.iter().map(|l| l.segment.p0.y).collect()
    }

    #[test]
    fn what_matched_lines_show_is_not_adopted() {
        assert_eq!(adopted(4.0), [3.0]);
        // 7 m of 8 m: what is left is too little to be a line of its own.
        assert_eq!(adopted(3.0), [3.0]);
    }

    #[test]
    fn what_matched_lines_show_in_part_is_adopted() {
        assert_eq!(adopted(0.0), [-3.0, 3.0]);
    }
}
