//! Real lines by plan position: which of them run along a border.

use nalgebra::{Point2, Vector2};

use crate::base::geometry::Segment3;
use crate::base::line_linker::LineLinker;
use crate::base::plan_index::PlanIndex;

/// 3D lines by plan position.
#[derive(Clone, Debug)]
pub(crate) struct LineIndex {
    lines: Vec<Segment3>,
    index: PlanIndex,
}

/// When a border lies on a line.
const ON_LINE: LineLinker = LineLinker::border_on_line();
/// Largest distance in plan at which it does, metres.
pub(super) const BESIDE_LINE: f64 = ON_LINE.apart;

impl LineIndex {
    /// Indexes the lines.
    pub(crate) fn new(lines: Vec<Segment3>) -> Self {
        let index = PlanIndex::new(lines.iter().map(|l| [l.p0.xy(), l.p1.xy()]));
        Self { lines, index }
    }

    /// Heights of the lines that run along a -> b at its middle, ascending.
    pub(crate) fn heights_along(&self, a: &Point2<f64>, b: &Point2<f64>) -> Vec<f64> {
        let middle = Point2::from((a.coords + b.coords) * 0.5);
        let along = (b - a) / (b - a).norm().max(1e-12);
        heights_at(&middle, self.along(&along, [middle; 2]))
    }

    /// The lines in a direction, a unit vector, that may lie beside what is between two positions.
    pub(super) fn along<'s>(
        &'s self,
        direction: &Vector2<f64>,
        ends: [Point2<f64>; 2],
    ) -> impl Iterator<Item = &'s Segment3> + use<'s> {
        // A place beyond the end of a slanting line may be a little farther from its box.
        let lines = self.index.touching(ends, 2.0 * BESIDE_LINE);
        let direction = *direction;
        lines.map(|i| &self.lines[i as usize]).filter(move |line| {
            let along = line.p1.xy() - line.p0.xy();
            along.norm() > 1e-9 && ON_LINE.angle(&direction, &along) >= 0.0
        })
    }
}

/// Heights of lines beside a place, ascending.
fn heights_at<'l>(place: &Point2<f64>, lines: impl Iterator<Item = &'l Segment3>) -> Vec<f64> {
    let mut heights: Vec<f64> = lines.filter_map(|l| height_at(place, l)).collect();
    heights.sort_by(f64::total_cmp);
    heights
}

/// Height of a line beside a place; `None` where it is not.
fn height_at(place: &Point2<f64>, line: &Segment3) -> Option<f64> {
    let along = line.p1.xy() - line.p0.xy();
    let length = along.norm();
    let t = (place - line.p0.xy()).dot(&(along / length)) / length;
    let in_plan = line.ends().map(|p| p.xy());
    ON_LINE
        .passes(&in_plan, place)
        .then(|| line.at(t.clamp(0.0, 1.0)).z)
}
