//! What a rule of setbacks leaves of a facet: strips along its edges are cut out of it, and what
//! stands on it with a margin.
//!
//! ```text
//! strip = { p + s a + t n : -d <= s <= l + d, 0 <= t <= d }         on the facet's plane
//! ```
//!
//! p is the beginning of a stretch of the outline, a its direction, l its length, n the direction
//! inwards and d its setback. Strips go on by d at both ends, so that two of them meet in a corner.
//! What is left has borders that move with the sides of the facet, and with its planes it tilts:
//! so its area is as uncertain as they are. That strips are a little wider in plan on a facet that
//! is less steep is not counted.

use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::edges::{RoofEdge, SHORT_PIECE_M, TURN_SINE, gradient};
use super::setbacks::SetbackRule;
use super::shape::{Part, Shape, Stretch};
use crate::base::geometry::{Polygon, convex_hull, depth, sides};
use crate::roofs::model::Facet;

/// What a rule leaves of a facet in plan, and how its area follows from the numbers of the shape.
pub(super) fn usable_part(
    shape: &Shape,
    index: usize,
    facet: &Facet,
    edges: &[&RoofEdge],
    rule: &SetbackRule,
) -> (Polygon, Part) {
    let strips: Vec<Strip> = (shape.stretches(index))
        .map(|stretch| Strip::along(stretch, facet, edges, rule))
        .collect();
    let margin = rule.around_obstructions(gradient(facet).norm());
    let obstructions = facet
        .obstructions
        .iter()
        .map(|o| widened(&o.outline, margin));
    let kept_clear = strips.iter().filter_map(Strip::plan).chain(obstructions);
    let kept_clear: Vec<Polygon> = kept_clear.collect();
    let whole = facet.plan();
    let left = (kept_clear.iter()).fold(whole, |left, clear| left.without(clear));
    let borders = left.sides().filter_map(|ends| {
        let [p, q] = ends.map(|p| facet.plane.lift(p.x, p.y));
        let strip = Strip::beside(&strips, &p, &q)?;
        let length = (ends[1] - ends[0]).norm();
        Some((strip.stretch.side, strip.stretch.grows * length))
    });
    let part = Part {
        plan_area: left.signed_area(),
        borders: borders.collect(),
    };
    (left, part)
}

/// An outline with a margin around it: of a rectangle all that is as near to each of its sides.
fn widened(outline: &[Point2<f64>], margin: f64) -> Polygon {
    let first = sides(outline).next();
    let along = first.and_then(|[p, q]| (q - p).try_normalize(0.0));
    let along = along.unwrap_or(Vector2::x()) * margin;
    let across = Vector2::new(-along.y, along.x);
    let corners = [
        along + across,
        along - across,
        across - along,
        -along - across,
    ];
    let around = outline.iter().flat_map(|p| corners.map(|by| p + by));
    convex_hull(&around.collect::<Vec<_>>()).into()
}

/// What is kept clear along a stretch of the outline.
struct Strip {
    stretch: Stretch,
    along: Vector3<f64>,
    inward: Vector3<f64>,
    width: f64,
}

impl Strip {
    /// Its width is that of the edge to which the stretch belongs, the nearest one.
    fn along(stretch: Stretch, facet: &Facet, edges: &[&RoofEdge], rule: &SetbackRule) -> Self {
        let middle = stretch.segment.at(0.5).xy();
        let distance = |edge: &&&RoofEdge| {
            let ends = edge.segment.ends().map(|p| p.xy());
            depth([ends], &middle).abs()
        };
        let edge = edges
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let slope = gradient(facet).norm();
        let along = stretch.segment.direction();
        Self {
            inward: facet.plane.normal.cross(&along),
            width: edge.map_or(0.0, |edge| rule.of(edge.kind, slope)),
            along,
            stretch,
        }
    }

    /// Its outline from above; `None` where nothing is kept clear.
    fn plan(&self) -> Option<Polygon> {
        let (out, in_) = (self.along * self.width, self.inward * self.width);
        let [p, q] = self.stretch.segment.ends();
        let ring = [p - out, q + out, q + out + in_, p - out + in_];
        (self.width > 0.0).then(|| ring.map(|p| p.xy()).to_vec().into())
    }

    /// The strip whose inner border a side of what is left is.
    fn beside<'a>(strips: &'a [Self], p: &Point3<f64>, q: &Point3<f64>) -> Option<&'a Self> {
        let (middle, direction) = (nalgebra::center(p, q), (q - p).try_normalize(0.0)?);
        let gap = |strip: &Self| {
            let at = middle - strip.stretch.segment.p0;
            let (along, reach) = (strip.along.dot(&at), strip.width + SHORT_PIECE_M);
            let is_beside = -reach < along && along < strip.stretch.segment.length() + reach;
            let is_parallel = strip.along.cross(&direction).norm() < TURN_SINE;
            let gap = (strip.inward.dot(&at) - strip.width).abs();
            (is_beside && is_parallel && gap < SHORT_PIECE_M).then_some(gap)
        };
        let gaps = strips.iter().filter_map(|strip| Some((strip, gap(strip)?)));
        let nearest = gaps.min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.map(|(strip, _)| strip)
    }
}
