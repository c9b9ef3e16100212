//! Real lines by plan position: which of them run along a border.

use nalgebra::Point2;
use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};

use crate::geometry::Segment3;
use crate::sorting::sort_by;

/// 3D lines by plan position.
pub struct LineIndex {
    lines: Vec<Segment3>,
    tree: RTree<GeomWithData<Rectangle<[f64; 2]>, usize>>,
}

/// A border lies on a line within this distance in plan, metres, and this sine of the angle.
const BESIDE_LINE: f64 = 0.25;
const LINE_SINE: f64 = 0.12;

impl LineIndex {
    /// Indexes the lines.
    pub fn new(lines: Vec<Segment3>) -> Self {
        let boxes = lines
            .iter()
            .enumerate()
            .map(|(i, l)| {
                let (a, b) = (l.p0, l.p1);
                let low = [a.x.min(b.x) - BESIDE_LINE, a.y.min(b.y) - BESIDE_LINE];
                let high = [a.x.max(b.x) + BESIDE_LINE, a.y.max(b.y) + BESIDE_LINE];
                GeomWithData::new(Rectangle::from_corners(low, high), i)
            })
            .collect();
        Self {
            lines,
            tree: RTree::bulk_load(boxes),
        }
    }

    /// Heights of the lines that run along a -> b at its middle, ascending.
    pub fn heights_along(&self, a: &Point2<f64>, b: &Point2<f64>) -> Vec<f64> {
        let middle = Point2::from((a.coords + b.coords) * 0.5);
        let d = (b - a) / (b - a).norm().max(1e-12);
        let mut heights: Vec<f64> = self
            .tree
            .locate_all_at_point(&[middle.x, middle.y])
            .filter_map(|g| {
                let line = &self.lines[g.data];
                let e = line.p1.xy() - line.p0.xy();
                let length = e.norm();
                if length < 1e-9 {
                    return None;
                }
                let u = e / length;
                let r = middle - line.p0.xy();
                let t = r.dot(&u) / length;
                let slack = BESIDE_LINE / length;
                ((-slack..=1.0 + slack).contains(&t)
                    && u.perp(&r).abs() < BESIDE_LINE
                    && u.perp(&d).abs() < LINE_SINE)
                    .then(|| line.at(t.clamp(0.0, 1.0)).z)
            })
            .collect();
        sort_by(&mut heights, f64::total_cmp);
        heights
    }
}
