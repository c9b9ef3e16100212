//! Real lines by plan position: which of them run along a border.

use nalgebra::Point2;

use crate::geometry::Segment3;
use crate::math::{larger, smaller};
use crate::plan_index::PlanIndex;

/// 3D lines by plan position.
pub(crate) struct LineIndex {
    lines: Vec<Segment3>,
    index: PlanIndex,
}

/// A border lies on a line within this distance in plan, metres, and this sine of the angle.
const BESIDE_LINE: f64 = 0.25;
const LINE_SINE: f64 = 0.12;
/// A place beside a line is no farther beyond its ends along a border that runs along it, metres.
pub(super) const FAR_BESIDE_LINE: f64 = (1.0 + 2.0 * LINE_SINE) * BESIDE_LINE;

impl LineIndex {
    /// Indexes the lines.
    pub(crate) fn new(lines: Vec<Segment3>) -> Self {
        let index = PlanIndex::new(lines.iter().map(|l| [l.p0.xy(), l.p1.xy()]));
        Self { lines, index }
    }

    /// Heights of the lines that run along a -> b at its middle, ascending.
    pub(crate) fn heights_along(&self, a: &Point2<f64>, b: &Point2<f64>) -> Vec<f64> {
        let middle = Point2::from((a.coords + b.coords) * 0.5);
        heights_at(&middle, self.along([a, b], [middle; 2], BESIDE_LINE))
    }

    /// The lines that run along a -> b near a part of it.
    fn along<'s>(
        &'s self,
        [a, b]: [&Point2<f64>; 2],
        part: [Point2<f64>; 2],
        margin: f64,
    ) -> impl Iterator<Item = &'s Segment3> + use<'s> {
        let d = (b - a) / (b - a).norm().max(1e-12);
        let lines = self.index.touching(part, margin);
        lines.map(|i| &self.lines[i as usize]).filter(move |line| {
            let along = line.p1.xy() - line.p0.xy();
            along.norm() > 1e-9 && along.perp(&d).abs() < LINE_SINE * along.norm()
        })
    }

    /// The lines that run along a -> b, with all those that may lie beside a part of it.
    pub(super) fn along_part<'s>(
        &'s self,
        ends: [&'s Point2<f64>; 2],
        part: [Point2<f64>; 2],
    ) -> impl Iterator<Item = &'s Segment3> + 's {
        // Those beside the whole are what there is.
        let is_beside = move |line: &&Segment3| {
            let [p, q] = [line.p0.xy(), line.p1.xy()];
            touch(ends, [&p, &q], BESIDE_LINE)
        };
        self.along(ends, part, 2.0 * BESIDE_LINE).filter(is_beside)
    }
}

/// Do two boxes, between corners, touch when one is widened by `margin` on all sides?
fn touch([a, b]: [&Point2<f64>; 2], [c, d]: [&Point2<f64>; 2], margin: f64) -> bool {
    (0..2).all(|k| {
        let (low, high) = (smaller(a[k], b[k]) - margin, larger(a[k], b[k]) + margin);
        smaller(c[k], d[k]) <= high && larger(c[k], d[k]) >= low
    })
}

/// Heights of lines beside a place, ascending.
fn heights_at<'l>(place: &Point2<f64>, lines: impl Iterator<Item = &'l Segment3>) -> Vec<f64> {
    let mut heights: Vec<f64> = lines.filter_map(|l| height_at(place, l)).collect();
    heights.sort_by(f64::total_cmp);
    heights
}

/// Height of a line beside a place; `None` where it is not.
pub(super) fn height_at(place: &Point2<f64>, line: &Segment3) -> Option<f64> {
    let along = line.p1.xy() - line.p0.xy();
    let length = along.norm();
    let (u, r) = (along / length, place - line.p0.xy());
    let t = r.dot(&u) / length;
    let slack = BESIDE_LINE / length;
    ((-slack..=1.0 + slack).contains(&t) && u.perp(&r).abs() < BESIDE_LINE)
        .then(|| line.at(t.clamp(0.0, 1.0)).z)
}
