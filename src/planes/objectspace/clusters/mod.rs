//! 3D lines of a main direction, by clustering in the plane across it (W96 3.5, figures 6 to 8).
//!
//! Seen along a main direction, a line of that direction is a point of the cluster plane (across,
//! height), and the interpretation plane of an image line is a line in it. Where the lines of
//! several images meet, there may be a 3D line. All images take part at once: two image lines only
//! propose a place, every other one then votes.
//!
//! The description length selects (Axelsson's principle). Without a 3D line each image line is
//! coded by a position of its own; a 3D line in the place of many costs its two coordinates once:
//!
//! ```text
//! gain = sum over views  c (B - r^2 / (2 s^2 ln 2)) e
//!        - miss (views that should see it and do not) - K
//!
//! c    share of the line's extent that the view's image lines cover
//! B    position_bits, what an image line costs on its own
//! r    distance of the image lines from the projected line, s = sigma_px
//! e    log2(1 + extent in metres) / 2: long chance alignments are less likely than short ones
//! K    line_bits
//! ```
//!
//! The best cluster takes its image lines away from all others (contradictions), and so on while
//! there is a gain. A view in which the line is hidden costs `miss_bits`; W96 demands all views.
//! Endless lines are truncated where fewer than the least number of views support them; gaps up to
//! `max_gap_m` are bridged (a chimney), longer ones part a line.
//!
//! ```text
//! cluster_plane  axes of the plane, and image lines in it
//! cluster_line   a 3D line found, and the plot of a cluster plane
//! search         votes, ends and gain of a cluster
//! proposals      intersections of image lines of different views
//! selection      the best clusters without contradictions
//! ```
//!
//! Invariant: an image line supports one 3D line at most.

mod cluster_line;
mod cluster_plane;
mod proposals;
mod search;
mod selection;

pub use cluster_line::{ClusterLine, ClusterTrace};
pub(crate) use cluster_plane::{ClusterAxes, END_PX, PARALLEL_DEG, overlap};
pub(crate) use search::{LEAST_COVERAGE, SIGMA_PX};

use nalgebra::Vector3;

use self::cluster_plane::PlaneRay;
use self::search::{ClusterCandidate, ClusterSearch};
use super::image_lines::ImageLine;
use crate::base::params::ClusterParams;
use crate::orienting::scene::Scene;

/// Finds the 3D lines of one direction between two heights.
pub fn cluster_lines(
    scene: &Scene,
    image_lines: &[ImageLine],
    direction: &Vector3<f64>,
    z_range: [f64; 2],
    params: &ClusterParams,
) -> (Vec<ClusterLine>, ClusterTrace) {
    let axes = ClusterAxes::new(direction);
    let rays: Vec<PlaneRay> = (0..image_lines.len())
        .filter_map(|k| PlaneRay::new(k, &image_lines[k], &axes, z_range))
        .collect();
    let search = ClusterSearch {
        scene,
        image_lines,
        axes,
        rays,
        z_range,
        params,
    };
    let (proposals, proposed) = search.proposals();
    let mut candidates: Vec<ClusterCandidate> =
        crate::base::execution::map(&proposals, |_, p| search.grow(p))
            .into_iter()
            .flatten()
            .collect();
    let mut trace = ClusterTrace {
        azimuth: crate::base::math::atan2(direction.y, direction.x),
        lines: search
            .rays
            .iter()
            .map(|r| (image_lines[r.image_line].view, r.drawn(z_range)))
            .collect(),
        proposals: [proposed, proposals.len()],
        ..ClusterTrace::default()
    };
    let selected = search.select(&mut candidates, &mut trace);
    (selected, trace)
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{planted_lines, rig};
    use super::super::image_lines::image_lines;
    use super::*;
    use crate::base::geometry::Segment3;
    use crate::base::params::ClusterParams;
    use nalgebra::Point3;

    fn planted() -> [Segment3; 3] {
        [[1.0, 6.0], [-4.0, 3.0], [5.5, 4.0]]
            .map(|[y, z]| Segment3::new(Point3::new(-5.0, y, z), Point3::new(5.0, y, z)))
    }

    /// Three planted lines among as many unrelated ones, six views.
    fn found() -> Vec<ClusterLine> {
        let scene = rig(6);
        let lines = planted_lines(&scene, &planted(), 0.5, &[]);
        let image_lines = image_lines(&scene, &lines);
        let params = ClusterParams::default();
        cluster_lines(&scene, &image_lines, &Vector3::x(), [0.0, 12.0], &params).0
    }

    #[test]
    fn lines_are_found_among_as_many_outliers() {
        let lines = found();
        for truth in planted() {
            let near = |l: &&ClusterLine| {
                let [p, q] = [l.segment.p0, truth.p0];
                (p.y - q.y).abs() < 0.1 && (p.z - q.z).abs() < 0.1
            };
            let best = lines
                .iter()
                .find(near)
                .expect("a line where one is planted");
            for p in [best.segment.p0, best.segment.p1] {
                assert!((p.x.abs() - 5.0).abs() < 0.3, "{p}");
            }
            assert_eq!(best.coverage.len(), 6);
        }
    }

    #[test]
    fn a_line_hidden_in_two_views_is_found_at_a_cost() {
        let scene = rig(6);
        let truth = Segment3::new(Point3::new(-5.0, 1.0, 6.0), Point3::new(5.0, 1.0, 6.0));
        let best = |hidden: &[usize]| {
            let lines = planted_lines(&scene, &[truth], 0.0, hidden);
            let image_lines = image_lines(&scene, &lines);
            cluster_lines(
                &scene,
                &image_lines,
                &Vector3::x(),
                [0.0, 12.0],
                &ClusterParams::default(),
            )
            .0
        };
        let (all, four, two) = (best(&[]), best(&[1, 4]), best(&[0, 1, 3, 4]));
        assert_eq!((all.len(), four.len(), two.len()), (1, 1, 0));
        assert!(four[0].gain_bits < all[0].gain_bits);
    }

    #[test]
    fn an_image_line_supports_one_3d_line_only() {
        let lines = found();
        let mut used: Vec<usize> = lines.iter().flat_map(|l| l.supports.clone()).collect();
        let count = used.len();
        used.sort_unstable();
        used.dedup();
        assert_eq!(used.len(), count);
    }
}
