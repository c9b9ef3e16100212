//! Where a plane between two parallel lines ends: clusters of crossing image lines (W96 3.6,
//! figures 10 and 11).
//!
//! Every image line inside the projected window of a plane hypothesis is cut with the plane. If it
//! lies in the plane at all, views agree on where it crosses the two parallel lines; the image
//! lines of a false plane scatter. A crossing at right angles has one parameter, its position along
//! the lines: the paper's rectangles. The slanted ones have two, and make parallelograms,
//! trapezoids and the ends of hips.

use serde::{Deserialize, Serialize};

use super::strip::PlaneStrip;
use crate::base::geometry::covered;
use crate::base::ids::ViewId;
use crate::planes::objectspace::clusters::overlap;
use crate::planes::objectspace::image_lines::ImageLine;

/// By how much the window of a plane is enlarged, metres. W96 3.6: "appr. 0.5 m".
const MARGIN_M: f64 = 0.5;
/// Shortest stretch across the plane that a crossing image line covers, metres. Assumption.
const LEAST_CROSSING_M: f64 = 0.8;
/// A crossing within this of a right angle is one, degrees. Assumption.
const RIGHT_ANGLE_DEG: f64 = 3.0;
/// Crossings within this along the lines are one end, metres. Assumption.
pub(super) const POSITION_M: f64 = 0.3;
/// Most ends of a pair of lines that are tested. W96: two. Assumption.
const MOST_ENDS: usize = 8;

/// An image line cut with the plane: where its line crosses the two lines, and the stretch across
/// that it covers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Crossing {
    /// The view.
    pub view: ViewId,
    /// Positions along the first and the second line, metres.
    pub at: [f64; 2],
    /// Stretch covered across, metres from the first line.
    pub across: [f64; 2],
    /// Contrast, 0 to 1.
    pub contrast: f64,
}

/// A cluster of crossings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlaneEnd {
    /// Positions along the first and the second line, metres.
    pub at: [f64; 2],
    /// Share of the width covered, mean over the views that see it.
    pub support: f64,
}

/// The image lines inside the window of a strip that cross it.
pub(crate) fn crossings(strip: &PlaneStrip, image_lines: &[ImageLine]) -> Vec<Crossing> {
    let m = MARGIN_M;
    let inside = |p: &[f64; 2]| {
        p[0] >= strip.range[0] - m
            && p[0] <= strip.range[1] + m
            && p[1] >= -m
            && p[1] <= strip.width + m
    };
    image_lines
        .iter()
        .filter_map(|s| {
            let [p, q] = s.rays.map(|ray| strip.cut(&s.camera.center, &ray));
            let (p, q) = (p?, q?);
            (inside(&p) && inside(&q)).then_some(())?;
            let (p, q) = if p[1] <= q[1] { (p, q) } else { (q, p) };
            let (du, dw) = (q[0] - p[0], q[1] - p[1]);
            // Flatter ones than 20 degrees run along the lines rather than across.
            (dw > 0.36 * du.abs() && dw >= LEAST_CROSSING_M.min(0.5 * strip.width)).then_some(())?;
            let slope = du / dw;
            Some(Crossing {
                view: s.view,
                at: [p[0] - slope * p[1], p[0] + slope * (strip.width - p[1])],
                across: [p[1].max(0.0), q[1].min(strip.width)],
                contrast: s.contrast,
            })
        })
        .collect()
}

/// The clusters of the crossings and, as further places where a plane may end, the ends of its two
/// lines.
pub(crate) fn ends(
    strip: &PlaneStrip,
    crossings: &[Crossing],
    line_ends: &[f64],
    views: usize,
) -> Vec<PlaneEnd> {
    let mut proposals: Vec<[f64; 2]> = Vec::new();
    let square = |c: &Crossing| (c.at[1] - c.at[0]).abs() <= square_tolerance(c, strip);
    for c in crossings {
        if square(c) {
            let middle = 0.5 * (c.across[0] + c.across[1]) / strip.width;
            let at = c.at[0] + (c.at[1] - c.at[0]) * middle;
            proposals.push([at, at]);
        } else {
            proposals.push(c.at);
        }
    }
    proposals.extend(line_ends.iter().map(|&u| [u, u]));
    distinct(strip, crossings, proposals, views)
}

/// The clusters of the slanted crossings and of further proposals.
pub(crate) fn slanted_ends(
    strip: &PlaneStrip,
    crossings: &[Crossing],
    starts: &[[f64; 2]],
    views: usize,
) -> Vec<PlaneEnd> {
    let proposals = crossings
        .iter()
        .map(|c| c.at)
        .chain(starts.iter().copied())
        .collect();
    distinct(strip, crossings, proposals, views)
}

/// Settles the proposals and keeps the best, each place once.
fn distinct(
    strip: &PlaneStrip,
    crossings: &[Crossing],
    proposals: Vec<[f64; 2]>,
    views: usize,
) -> Vec<PlaneEnd> {
    let mut found: Vec<PlaneEnd> = proposals
        .into_iter()
        .map(|p| settle(strip, crossings, p, views))
        .collect();
    found.sort_by(|a, b| {
        b.support
            .total_cmp(&a.support)
            .then(a.at[0].total_cmp(&b.at[0]))
            .then(a.at[1].total_cmp(&b.at[1]))
    });
    let mut kept: Vec<PlaneEnd> = Vec::new();
    for end in found {
        let same = |k: &PlaneEnd| (0..2).all(|i| (k.at[i] - end.at[i]).abs() < POSITION_M);
        if !kept.iter().any(same) && kept.len() < MOST_ENDS {
            kept.push(end);
        }
    }
    kept
}

/// How far the two positions of a crossing at right angles may be apart, metres: the direction of a
/// short image line is uncertain.
fn square_tolerance(c: &Crossing, strip: &PlaneStrip) -> f64 {
    let length = c.across[1] - c.across[0];
    strip.width * (RIGHT_ANGLE_DEG.to_radians() + POSITION_M / length.max(POSITION_M)).min(0.35)
}

/// Moves a proposal to the weighted mean of the crossings near it (W96: "weighted by the 2D lengths
/// of the lines").
fn settle(strip: &PlaneStrip, crossings: &[Crossing], start: [f64; 2], views: usize) -> PlaneEnd {
    let square = start[0] == start[1];
    let mut at = start;
    let mut near: Vec<&Crossing> = Vec::new();
    // Assumption: what crosses near the second mean crosses near the third.
    const SETTLING_ROUNDS: usize = 3;
    for _ in 0..SETTLING_ROUNDS {
        near = crossings.iter().filter(|c| lies_on(c, at, strip)).collect();
        if near.is_empty() {
            break;
        }
        at = if square {
            mean_position(strip, &near)
        } else {
            mean_line(strip, &near).unwrap_or(at)
        };
    }
    let within = [0.0, strip.width];
    let support: f64 = (0..views)
        .map(|v| {
            let own = near.iter().filter(|c| c.view.index() == v);
            covered(own.map(|c| c.across), within) / strip.width
        })
        .sum();
    PlaneEnd {
        at,
        support: support / views.max(1) as f64,
    }
}

/// Does the stretch of the crossing lie on the line between two positions?
fn lies_on(c: &Crossing, at: [f64; 2], strip: &PlaneStrip) -> bool {
    c.across.iter().all(|w| {
        let f = w / strip.width;
        let own = c.at[0] + (c.at[1] - c.at[0]) * f;
        let line = at[0] + (at[1] - at[0]) * f;
        (own - line).abs() <= POSITION_M
    })
}

fn mean_position(strip: &PlaneStrip, near: &[&Crossing]) -> [f64; 2] {
    let (mut sum, mut weights) = (0.0, 0.0);
    for c in near {
        let length = c.across[1] - c.across[0];
        let middle = 0.5 * (c.across[0] + c.across[1]) / strip.width;
        sum += length * (c.at[0] + (c.at[1] - c.at[0]) * middle);
        weights += length;
    }
    [sum / weights, sum / weights]
}

/// A line by least squares through the ends of the stretches.
fn mean_line(strip: &PlaneStrip, near: &[&Crossing]) -> Option<[f64; 2]> {
    let (mut n, mut sw, mut su, mut sww, mut swu) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for c in near {
        let weight = c.across[1] - c.across[0];
        for w in c.across {
            let u = c.at[0] + (c.at[1] - c.at[0]) * w / strip.width;
            n += weight;
            sw += weight * w;
            su += weight * u;
            sww += weight * w * w;
            swu += weight * w * u;
        }
    }
    let spread = sww - sw * sw / n;
    (spread > 1e-9).then(|| {
        let slope = (swu - sw * su / n) / spread;
        let base = (su - slope * sw) / n;
        [base, base + slope * strip.width]
    })
}

/// Share of a stretch of a 3D line that its views cover, mean over the views.
pub(crate) fn side_support(
    stretches: &[(ViewId, [f64; 2])],
    within: [f64; 2],
    views: usize,
) -> f64 {
    let length = within[1] - within[0];
    if length <= 0.0 {
        return 0.0;
    }
    let sum: f64 = (0..views)
        .map(|v| {
            let own = stretches
                .iter()
                .filter(|s| s.0.index() == v && overlap(s.1, within) > 0.0);
            covered(own.map(|s| s.1), within) / length
        })
        .sum();
    sum / views.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::Segment3;
    use crate::planes::objectspace::clusters::ClusterAxes;
    use crate::planes::objectspace::fixture::{planted_lines, rig};
    use crate::planes::objectspace::image_lines::image_lines;
    use nalgebra::Vector3;

    /// A roof plane that rises along Y from an eave at y = 0, z = 3 to a ridge at y = 4, z = 6.
    fn strip() -> PlaneStrip {
        PlaneStrip::new(
            &ClusterAxes::new(&Vector3::x()),
            [0.0, 3.0],
            [4.0, 6.0],
            [-8.0, 8.0],
        )
        .unwrap()
    }

    fn found(uv: &[[f64; 2]]) -> Vec<PlaneEnd> {
        let (scene, strip) = (rig(6), strip());
        let truth: Vec<Segment3> = uv
            .iter()
            .map(|[a, b]| Segment3::new(strip.point(*a, 0.0), strip.point(*b, strip.width)))
            .collect();
        let lines = planted_lines(&scene, &truth, 0.3, &[2]);
        let crossings = crossings(&strip, &image_lines(&scene, &lines));
        ends(&strip, &crossings, &[], 6)
    }

    #[test]
    fn a_plane_with_a_gap_has_four_ends() {
        let planted = [-7.0, -2.0, 1.5, 6.0];
        let ends = found(&planted.map(|u| [u, u]));
        for u in planted {
            let end = ends.iter().find(|e| (e.at[0] - u).abs() < 0.1).unwrap();
            // One of six views does not see them.
            assert!(
                end.at[0] == end.at[1] && end.support > 0.75 && end.support < 0.9,
                "{end:?}"
            );
        }
    }

    #[test]
    fn slanted_ends_keep_both_positions() {
        let ends = found(&[[-7.0, -3.0], [6.0, 6.0]]);
        let hip = ends
            .iter()
            .find(|e| e.at[0] != e.at[1] && e.support > 0.7)
            .unwrap();
        assert!(
            (hip.at[0] + 7.0).abs() < 0.15 && (hip.at[1] + 3.0).abs() < 0.15,
            "{hip:?}"
        );
    }

    #[test]
    fn lines_off_the_plane_scatter() {
        // 2 m above the plane: seen from six places it crosses at six.
        let (scene, strip) = (rig(6), strip());
        let up = Vector3::z() * 2.0;
        let truth = [Segment3::new(
            strip.point(1.0, 0.0) + up,
            strip.point(1.0, strip.width) + up,
        )];
        let lines = planted_lines(&scene, &truth, 0.0, &[]);
        let crossings = crossings(&strip, &image_lines(&scene, &lines));
        let best = ends(&strip, &crossings, &[], 6);
        assert!(best.first().is_none_or(|e| e.support < 0.6), "{best:?}");
    }
}
