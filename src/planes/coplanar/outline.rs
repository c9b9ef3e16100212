//! The outline of a set of coplanar lines: from the convex hull of their ends (B99 2: Leuven) to a
//! polygon whose sides lie on lines, with its gaps closed.
//!
//! Ends are not where lines end: they stop short of a corner or overshoot it. So a corner is where
//! two sides meet, as far as their ends may lie off; a side without a line, which only closes the
//! hull, may be square to its neighbour or mirror the one across. Each is weighed against the hull
//! as it is, by the ends' errors and by the photographs.

use nalgebra::{Point2, Point3, Vector2};
use serde::Serialize;

use super::hypothesis::{SQUARE, log_end_error, log_normal, log_odds};
use super::image_evidence::ImageEvidence;
use super::sets::{LineSet, LineSpace};
use crate::base::evidence::UncertaintyTable;
use crate::base::geometry::Plane;
use crate::base::ids::LineId;
use crate::base::math::ln;

/// A polygon in plan, counter-clockwise, with the lines on its sides; side k runs from corner k to
/// the next.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Outline {
    /// Corners, metres.
    pub corners: Vec<Point2<f64>>,
    /// Per side the lines of the set on it; none where the side only closes the hull.
    pub sides: Vec<Vec<LineId>>,
}

/// What was supposed of a side without a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum ClosingKind {
    /// It is square to its neighbours.
    Square,
    /// It mirrors the side across.
    Mirrored,
}

/// A closing side that was moved.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ClosingSide {
    /// Where it is now, metres, local frame.
    pub segment: [Point3<f64>; 2],
    /// What is supposed of it.
    pub kind: ClosingKind,
    /// How much likelier that is than the hull as it was.
    pub nats: f64,
}

impl Outline {
    /// The hull of a set, its sides joined to the lines on them; `None` without an area.
    pub(super) fn of_hull(space: &LineSpace, set: &LineSet) -> Option<Self> {
        let corners = space.hull(&set.lines);
        (corners.len() >= 3).then_some(())?;
        let n = corners.len();
        let side = |k: usize| {
            let on = |l: &&LineId| is_along(space, **l, &corners, k);
            set.lines.iter().filter(on).copied().collect()
        };
        let sides: Vec<Vec<LineId>> = (0..n).map(side).collect();
        let mut outline = Self { corners, sides };
        while let Some(k) = outline.bend_in_a_line() {
            let later = outline.sides.remove(k);
            outline.corners.remove(k);
            let before = (k + outline.sides.len() - 1) % outline.sides.len();
            let joined = &mut outline.sides[before];
            joined.extend(later);
            joined.sort();
            joined.dedup();
        }
        (outline.corners.len() >= 3).then_some(outline)
    }

    /// A corner inside a straight line: its sides share one.
    fn bend_in_a_line(&self) -> Option<usize> {
        let n = self.corners.len();
        let shares = |k: &usize| {
            let before = &self.sides[(k + n - 1) % n];
            before.iter().any(|l| self.sides[*k].contains(l))
        };
        (0..n).find(shares).filter(|_| n > 3)
    }

    /// Number of sides.
    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }

    /// Corner `k`, counted around.
    pub(super) fn corner(&self, k: usize) -> Point2<f64> {
        self.corners[k % self.len()]
    }

    /// From the first to the last end of side `k`.
    pub(super) fn along(&self, k: usize) -> Vector2<f64> {
        self.corner(k + 1) - self.corner(k)
    }

    /// The corners on a plane.
    pub(super) fn lifted(&self, plane: &Plane) -> Vec<Point3<f64>> {
        self.corners.iter().map(|p| plane.lift(p.x, p.y)).collect()
    }

    /// Is it convex and counter-clockwise?
    fn is_convex(&self) -> bool {
        (0..self.len()).all(|k| {
            let (before, after) = (self.along(k + self.len() - 1), self.along(k));
            after.norm() > 1e-3 && before.perp(&after) >= 0.0
        })
    }

    /// Closes corners: where two sides with lines are joined by one without, the lines may meet.
    pub(super) fn with_closed_corners(mut self) -> Self {
        while let Some((k, corner)) = (0..self.len()).find_map(|k| Some((k, self.meeting(k)?))) {
            let n = self.len();
            self.corners[(k + 1) % n] = corner;
            self.corners.remove(k);
            self.sides.remove(k);
        }
        self
    }

    /// Where the sides around side `k`, which has no line, meet, if that is likelier than that they
    /// end where they are seen to end.
    fn meeting(&self, k: usize) -> Option<Point2<f64>> {
        let n = self.len();
        let (before, after) = ((k + n - 1) % n, (k + 1) % n);
        let has_lines = |side: usize| !self.sides[side].is_empty();
        (n > 3 && !has_lines(k) && has_lines(before) && has_lines(after)).then_some(())?;
        let (p, q) = (self.corner(k), self.corner(k + 1));
        let (u, v) = (self.along(before), self.along(after));
        let cross = u.perp(&v);
        (cross > 0.0).then_some(())?;
        let at = p + u * ((q - p).perp(&v) / cross);
        let nats = |end: &Point2<f64>, side: &Vector2<f64>| {
            log_end_error((at - end).norm()) + ln(side.norm())
        };
        (nats(&p, &u) + nats(&q, &v) > 0.0).then_some(at)
    }

    /// Moves each side without a line to where it most likely is: square to its neighbours,
    /// mirrored, or as it was.
    pub(super) fn with_closing_sides(
        mut self,
        plane: &Plane,
        images: &ImageEvidence,
    ) -> (Self, Vec<ClosingSide>) {
        let seen = |outline: &Self| {
            let corners = outline.lifted(plane);
            images.inside(plane, &outline.corners, &[]) + images.outline(&corners)
        };
        let mut moved = Vec::new();
        for k in 0..self.len() {
            if self.len() == 3 || !self.sides[k].is_empty() {
                continue;
            }
            let as_it_is = seen(&self);
            let weighed = self
                .alternatives(k)
                .into_iter()
                .map(|(kind, nats, outline)| {
                    let nats = nats + seen(&outline) - as_it_is;
                    (kind, nats, outline)
                });
            let best = weighed.max_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((kind, nats, outline)) = best.filter(|b| b.1 > 0.0) {
                self = outline;
                let segment = [k, k + 1].map(|i| self.corner(i));
                let segment = segment.map(|p| plane.lift(p.x, p.y));
                moved.push(ClosingSide {
                    segment,
                    kind,
                    nats,
                });
            }
        }
        (self, moved)
    }

    /// Other places of side `k`, with what the ends of the lines say of them, nats.
    fn alternatives(&self, k: usize) -> Vec<(ClosingKind, f64, Self)> {
        let n = self.len();
        let (p, q) = (self.corner(k), self.corner(k + 1));
        let (u, v) = (self.along(k + n - 1), self.along(k + 1));
        let longer = if u.norm() >= v.norm() { u } else { v };
        // Where a line through `from` square to the longer neighbour meets the one through `on`.
        let square = |from: &Point2<f64>, on: &Point2<f64>, along: &Vector2<f64>| {
            let rate = along.dot(&longer);
            let at = on + along * ((from - on).dot(&longer) / rate);
            (rate.abs() > 0.5 * along.norm() * longer.norm()).then_some(at)
        };
        let mirrored = |p: &Point2<f64>, base: [Point2<f64>; 2]| {
            let axis = (base[1] - base[0]).try_normalize(1e-9)?;
            let middle = nalgebra::center(&base[0], &base[1]);
            Some(p - axis * (2.0 * (p - middle).dot(&axis)))
        };
        let (far_p, far_q) = (self.corner(k + n - 1), self.corner(k + 2));
        use ClosingKind::{Mirrored, Square};
        // The corner that moves, where it moves to, and the side along which it does.
        let places = [
            (Square, k + 1, square(&p, &q, &v), v),
            (Square, k, square(&q, &p, &u), u),
            (Mirrored, k + 1, mirrored(&far_q, [far_p, p]), v),
            (Mirrored, k, mirrored(&far_p, [q, far_q]), u),
        ];
        let moved = places.into_iter().filter_map(|(kind, corner, at, side)| {
            let (at, corner) = (at?, corner % n);
            // What is not square mirrors the other side.
            let prior = match kind {
                Square => log_odds(SQUARE),
                Mirrored => -log_odds(SQUARE),
            };
            let error = (at - self.corners[corner]).norm();
            let nats = prior + log_end_error(error) + ln(side.norm());
            let mut outline = self.clone();
            outline.corners[corner] = at;
            outline.is_convex().then_some((kind, nats, outline))
        });
        moved.collect()
    }
}

/// Is it likelier that a line lies along side `k` of a hull than that its ends lie anywhere in the
/// hull?
fn is_along(space: &LineSpace, line: LineId, corners: &[Point2<f64>], k: usize) -> bool {
    let n = corners.len();
    let (a, b) = (corners[k], corners[(k + 1) % n]);
    let Some(along) = (b - a).try_normalize(1e-6) else {
        return false;
    };
    let across = Vector2::new(-along.y, along.x);
    let depth = |p: &Point2<f64>| (p - a).dot(&across);
    let range = corners.iter().map(depth).fold(space.pixel_m, f64::max);
    let line = space.line(line);
    let ends = [line.segment.p0.xy(), line.segment.p1.xy()];
    let of_end = |(p, covariance): (Point2<f64>, nalgebra::Matrix3<f64>)| {
        let in_plan = covariance.fixed_view::<2, 2>(0, 0);
        let sigma = across.dot(&(in_plan * across)).max(0.0).sqrt();
        let sigma = UncertaintyTable::fitted().height.of(sigma, space.pixel_m);
        // The side is as uncertain as the ends that it joins.
        log_normal(depth(&p), 2.0 * sigma * sigma) + ln(range)
    };
    let [t0, t1] = ends.map(|p| (p - a).dot(&along));
    let overlaps = t0.max(t1) > 0.0 && t0.min(t1) < (b - a).norm();
    let [e0, e1] = [0, 1].map(|i| of_end((ends[i], line.covariance[i])));
    // A chance line has its ends at any depth, but seldom runs across its own length.
    overlaps && e0 > 0.0 && e1 > 0.0
}
