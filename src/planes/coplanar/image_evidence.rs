//! Back-projection: what the photographs say of a polygon in a plane (B99 2), in nats.
//!
//! It is the energy of [`crate::roofs::facets`] for one facet alone: the windows inside are
//! compared in all views, and each metre of the outline costs what a border costs there, a tenth of
//! it where the views show an edge. So a polygon is verified by the same numbers that decide later.

use nalgebra::{Point2, Point3};

use super::hypothesis::relation_nats;
use crate::base::evidence::ON_LINE;
use crate::base::evidence::{UncertaintyTable, WindowEvidenceTable};
use crate::base::geometry::{Plane, Segment3, bounds, covered, depth, sides};
use crate::base::ids::ViewId;
use crate::base::params::RoofParams;
use crate::base::plan_index::PlanIndex;
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::ProjectedLine;
use crate::orienting::scene::Scene;
use crate::planes::photoconsistency::{WINDOW, WindowMatcher};

/// Windows so far apart are independent, metres: each speaks for its square.
const SPACING_M: f64 = 1.0;
/// Width beside a side in which an edge may lie, metres: as many as a window is wide.
const BESIDE_M: f64 = 1.0;

/// The photographs, ready to be asked.
pub(crate) struct ImageEvidence<'s> {
    scene: &'s Scene,
    matcher: WindowMatcher<'s>,
    segments: &'s [Vec<ImageSegment>],
    /// Per view the boxes around its segments, pixels.
    index: Vec<PlanIndex>,
    /// Half the side of a window, metres.
    half_window_m: f64,
    border_nats_per_m: f64,
}

impl<'s> ImageEvidence<'s> {
    /// Of a scene with its segments; the windows have cells of `step_m` metres, `reduced`
    /// pixels about as far apart as their samples.
    pub(crate) fn new(
        scene: &'s Scene,
        reduced: &'s Scene,
        step_m: f64,
        segments: &'s [Vec<ImageSegment>],
        params: &RoofParams,
    ) -> Self {
        let boxes = |view: &Vec<ImageSegment>| {
            PlanIndex::new(view.iter().map(|s| [s.segment.p0, s.segment.p1]))
        };
        Self {
            scene,
            matcher: WindowMatcher::new(reduced, step_m),
            segments,
            index: segments.iter().map(boxes).collect(),
            half_window_m: 0.5 * WINDOW as f64 * step_m,
            border_nats_per_m: params.border_nats_per_m,
        }
    }

    /// What the windows wholly inside a convex ring (counter-clockwise in plan), but not inside
    /// another one, say of a plane.
    pub(crate) fn inside(&self, plane: &Plane, ring: &[Point2<f64>], but: &[Point2<f64>]) -> f64 {
        let [low, high] = bounds(ring.iter().copied());
        let first = |v: f64| (v / SPACING_M).floor() as i64;
        let table = WindowEvidenceTable::fitted();
        let mut nats = 0.0;
        for row in first(low.y)..=first(high.y) {
            for column in first(low.x)..=first(high.x) {
                let p = Point2::new(column as f64 + 0.5, row as f64 + 0.5) * SPACING_M;
                let holds = |ring: &[Point2<f64>]| depth(sides(ring), &p) >= self.half_window_m;
                if !holds(ring) || holds(but) {
                    continue;
                }
                let views = self.matcher.views_of(&plane.lift(p.x, p.y));
                if let Some(seen) = self.matcher.agreement(&views, plane, &p) {
                    let prior = f64::from(seen.weight) * table.prior;
                    nats += table.nats_of(seen.weight, seen.correlation) + prior;
                }
            }
        }
        nats * SPACING_M * SPACING_M
    }

    /// What the border of a polygon costs, nats, at most 0.
    pub(crate) fn outline(&self, corners: &[Point3<f64>]) -> f64 {
        let cost = |[a, b]: [Point3<f64>; 2]| {
            let side = Segment3::new(a, b);
            let shown = self.shown(&side);
            -self.border_nats_per_m * side.length() * (1.0 - (1.0 - ON_LINE) * shown)
        };
        sides(corners).map(cost).sum()
    }

    /// Share of a side along which the views show an edge, 0 to 1: the mean over the better half of
    /// the views that can show it, for the others may be hidden from it.
    pub(crate) fn shown(&self, side: &Segment3) -> f64 {
        let mut shares: Vec<f64> = (self.scene.view_ids())
            .filter_map(|view| self.shown_in(view, side))
            .collect();
        shares.sort_by(|a, b| b.total_cmp(a));
        let better = &shares[..shares.len().div_ceil(2)];
        better.iter().sum::<f64>() / better.len().max(1) as f64
    }

    /// The same in one view; `None` where it does not show all of the side.
    fn shown_in(&self, view: ViewId, side: &Segment3) -> Option<f64> {
        let camera = self.scene.camera(view);
        let image = ProjectedLine::new(camera, side)?;
        let ends = [0.0, side.length()].map(|t| image.at(t));
        let [Some(a), Some(b)] = ends else {
            return None;
        };
        (camera.contains(&a, 0.0) && camera.contains(&b, 0.0)).then_some(())?;
        let pixel = camera.ground_pixel(&side.at(0.5));
        let beside = BESIDE_M / pixel;
        let sigma = UncertaintyTable::fitted().height.of(0.0, 1.0);
        let is_on = |p: &Point2<f64>| relation_nats(image.distance(p), sigma * sigma, beside, 0.5);
        let on_side = self.index[view.index()]
            .touching([a, b], 0.0)
            .filter_map(|k| {
                let s = &self.segments[view.index()][k as usize].segment;
                (is_on(&s.p0) + is_on(&s.p1) > 0.0).then(|| {
                    let [t0, t1] = [s.p0, s.p1].map(|p| image.t_of(&p));
                    [t0.min(t1), t0.max(t1)]
                })
            });
        let length = side.length();
        Some(covered(on_side, [0.0, length]) / length)
    }
}
