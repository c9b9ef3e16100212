//! The outlines that a plane between two lines may have: quadrilaterals between two ends, and
//! triangles.

use nalgebra::Point3;

use super::ends::{POSITION_M, PlaneEnd, side_support};
use super::plane_evidence::plan_area;
use super::strip::PlaneStrip;
use crate::base::ids::ViewId;

/// Least distance of the two lines, metres. Assumption.
pub(super) const LEAST_WIDTH_M: f64 = 1.2;
/// Least share of an outline that image lines cover, mean over the views, for it to be looked
/// at. Assumption.
const LEAST_SUPPORT: f64 = 0.25;

/// A line in the frame of its direction.
pub(crate) struct StripLine {
    pub range: [f64; 2],
    /// (across, height).
    pub place: [f64; 2],
    /// What its image lines cover.
    pub stretches: Vec<(ViewId, [f64; 2])>,
}

/// A polygon in a strip.
pub(crate) struct StripPolygon {
    /// (u, w) of the corners.
    corners: Vec<[f64; 2]>,
    /// Length of the outline, metres.
    pub length_m: f64,
    /// Share of it that image lines cover, mean over the views.
    pub support: f64,
}

impl StripPolygon {
    /// With sides of given (length, support); `None` where too little of them is seen.
    fn new(corners: Vec<[f64; 2]>, sides: &[[f64; 2]]) -> Option<Self> {
        let length_m: f64 = sides.iter().map(|s| s[0]).sum();
        let support = sides.iter().map(|s| s[0] * s[1]).sum::<f64>() / length_m;
        (support >= LEAST_SUPPORT).then_some(Self {
            corners,
            length_m,
            support,
        })
    }

    /// Its corners in the world, counter-clockwise seen from above.
    pub(super) fn ring(&self, strip: &PlaneStrip) -> Vec<Point3<f64>> {
        let point = |c: &[f64; 2]| strip.point(c[0], c[1]);
        let mut ring: Vec<_> = self.corners.iter().map(point).collect();
        if plan_area(&ring) < 0.0 {
            ring.reverse();
        }
        ring
    }
}

/// Quadrilaterals between two ends whose outline is supported well enough.
pub(crate) fn quadrilaterals(
    strip: &PlaneStrip,
    lines: [&StripLine; 2],
    ends: &[PlaneEnd],
    views: usize,
) -> Vec<StripPolygon> {
    let pairs = ends
        .iter()
        .flat_map(|left| ends.iter().map(move |right| [left, right]));
    pairs
        .filter_map(|pair| quadrilateral(strip, lines, pair, views))
        .collect()
}

fn quadrilateral(
    strip: &PlaneStrip,
    [a, b]: [&StripLine; 2],
    [left, right]: [&PlaneEnd; 2],
    views: usize,
) -> Option<StripPolygon> {
    let [p, q] = [0, 1].map(|k| [left.at[k], right.at[k]]);
    let lengths = [p[1] - p[0], q[1] - q[0]];
    // Shorter ones are for triangles.
    const SHORTEST_SIDE_M: f64 = 0.3;
    let long = lengths[0].min(lengths[1]) >= SHORTEST_SIDE_M
        && lengths[0].max(lengths[1]) >= LEAST_WIDTH_M;
    long.then_some(())?;
    let sides = [
        [lengths[0], side_support(&a.stretches, p, views)],
        [lengths[1], side_support(&b.stretches, q, views)],
        [slant_m(left, strip), left.support],
        [slant_m(right, strip), right.support],
    ];
    let corners = vec![
        [p[0], 0.0],
        [p[1], 0.0],
        [q[1], strip.width],
        [q[0], strip.width],
    ];
    StripPolygon::new(corners, &sides)
}

/// The triangle over a line with its tip at `top` on the other border of the strip, between the
/// best ends to either side. Both slants are fixed by the tip: no parameter of their own.
pub(crate) fn triangle(
    strip: &PlaneStrip,
    base: &StripLine,
    top: f64,
    ends: &[PlaneEnd],
    views: usize,
) -> Option<StripPolygon> {
    // The tip is at least so far from either end of the base.
    const TIP_INSET_M: f64 = 0.5;
    let best = |side: f64| {
        let to_tip = |e: &&PlaneEnd| {
            (e.at[1] - top).abs() <= 2.0 * POSITION_M && side * (e.at[0] - top) > TIP_INSET_M
        };
        let on_side = ends.iter().filter(to_tip);
        on_side.max_by(|a, b| a.support.total_cmp(&b.support))
    };
    let (left, right) = (best(-1.0)?, best(1.0)?);
    let bottom = [left.at[0], right.at[0]];
    let slant = |e: &PlaneEnd| {
        let at = [e.at[0], top];
        [slant_m(&PlaneEnd { at, ..*e }, strip), e.support]
    };
    let below = side_support(&base.stretches, bottom, views);
    let sides = [[bottom[1] - bottom[0], below], slant(left), slant(right)];
    let corners = vec![[bottom[0], 0.0], [bottom[1], 0.0], [top, strip.width]];
    StripPolygon::new(corners, &sides)
}

/// Length of an end across the strip, metres.
fn slant_m(end: &PlaneEnd, strip: &PlaneStrip) -> f64 {
    crate::base::math::hypot(strip.width, end.at[1] - end.at[0])
}
