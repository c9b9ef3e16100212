//! The least rectangle around a surface.

use nalgebra::{Point2, Vector2};

use crate::base::geometry::{Plane, bounds};

/// The least rectangle in plan around some points and a margin, one side along the contour lines
/// of a plane or along x.
pub(crate) fn least_rectangle(
    points: &[Point2<f64>],
    margin: f64,
    plane: &Plane,
) -> [Point2<f64>; 4] {
    let directions = (0..18).map(|i| {
        let (s, c) = crate::base::math::sin_cos(f64::from(i) * std::f64::consts::PI / 36.0);
        Vector2::new(c, s)
    });
    let level = Vector2::new(-plane.normal.y, plane.normal.x).try_normalize(0.05);
    let boxes = directions.chain(level).map(|along| {
        let across = Vector2::new(-along.y, along.x);
        let [low, high] = bounds(
            points
                .iter()
                .map(|p| Point2::new(p.coords.dot(&along), p.coords.dot(&across))),
        );
        let (low, high) = (
            low.coords.add_scalar(-margin),
            high.coords.add_scalar(margin),
        );
        let at = |t: f64, u: f64| Point2::from(along * t + across * u);
        let corners = [
            at(low.x, low.y),
            at(high.x, low.y),
            at(high.x, high.y),
            at(low.x, high.y),
        ];
        ((high - low).product(), corners)
    });
    let least = boxes.min_by(|a, b| a.0.total_cmp(&b.0));
    least.expect("there are directions").1
}
