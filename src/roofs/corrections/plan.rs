//! Regions of the plan.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use nalgebra::{Point2, Point3, Vector2};

use crate::base::geometry::{Plane, bounds};
use crate::roofs::model::{Facet, inside};

/// Parts of a region below this area are rounding, m^2: a sliver of 1 mm along an eave.
const SLIVER_M2: f64 = 0.02;

/// A place this far beside a line is on that side of it, metres: less than the width of any facet.
pub(super) const SIDE_OFFSET_M: f64 = 0.01;
/// An edge is longer, metres.
pub(super) const SHORTEST_EDGE_M: f64 = 0.1;

/// Rings in plan, filled by the even-odd rule.
#[derive(Clone, Debug, Default)]
pub(super) struct Region(Vec<Vec<[f64; 2]>>);

impl Region {
    pub(super) fn of(facet: &Facet) -> Self {
        let rings = std::iter::once(&facet.outer).chain(&facet.holes);
        Self(
            rings
                .map(|ring| ring.iter().map(|p| [p.x, p.y]).collect())
                .collect(),
        )
    }

    pub(super) fn ring(ring: &[Point2<f64>]) -> Self {
        Self(vec![ring.iter().map(|p| [p.x, p.y]).collect()])
    }

    pub(super) fn and(&self, other: &Self) -> Self {
        self.overlay(other, OverlayRule::Intersect)
    }

    pub(super) fn without(&self, other: &Self) -> Self {
        self.overlay(other, OverlayRule::Difference)
    }

    pub(super) fn or(&self, other: &Self) -> Self {
        self.overlay(other, OverlayRule::Union)
    }

    fn overlay(&self, other: &Self, rule: OverlayRule) -> Self {
        let shapes = self.0.overlay_as::<i64>(&other.0, rule, FillRule::EvenOdd);
        Self(shapes.into_iter().flatten().collect())
    }

    /// The part to the left of a line through `at` along `direction`.
    pub(super) fn left_of(&self, at: &Point2<f64>, direction: &Vector2<f64>) -> Self {
        let corners = self.0.iter().flatten().map(|&[x, y]| Point2::new(x, y));
        let [low, high] = bounds(corners.chain([*at]));
        let Some(along) = direction.try_normalize(1e-9) else {
            return Self::default();
        };
        let reach = along * (2.0 * (high - low).norm() + 1.0);
        let left = Vector2::new(-reach.y, reach.x);
        let half = [at - reach, at + reach, at + reach + left, at - reach + left];
        self.and(&Self::ring(&half))
    }

    /// The connected part at a place, with its holes; nothing where the region is not.
    pub(super) fn connected_at(&self, p: &Point2<f64>) -> Self {
        let parts = self.parts().into_iter();
        let ring_is_about = |ring: &Vec<[f64; 2]>| {
            let lifted: Vec<Point3<f64>> =
                (ring.iter().map(|&[x, y]| Point3::new(x, y, 0.0))).collect();
            inside(&lifted, p)
        };
        let mut at = parts.filter(|part| part.iter().filter(|r| ring_is_about(r)).count() % 2 == 1);
        at.next().map(Self).unwrap_or_default()
    }

    pub(super) fn area(&self) -> f64 {
        self.parts()
            .iter()
            .map(|part| Self::signed_area(part))
            .sum()
    }

    fn signed_area(part: &[Vec<[f64; 2]>]) -> f64 {
        part.iter().map(|ring| ring_area(ring)).sum()
    }

    /// Its connected parts: an outer ring counter-clockwise, then holes clockwise.
    fn parts(&self) -> Vec<Vec<Vec<[f64; 2]>>> {
        let none: Vec<Vec<[f64; 2]>> = Vec::new();
        self.0
            .overlay_as::<i64>(&none, OverlayRule::Subject, FillRule::EvenOdd)
    }

    /// Its parts, without slivers, as rings on a plane: the outer one, then holes.
    pub(super) fn rings_on(&self, plane: &Plane) -> Vec<Vec<Vec<Point3<f64>>>> {
        let lift = |ring: Vec<[f64; 2]>| ring.into_iter().map(|[x, y]| plane.lift(x, y)).collect();
        let parts = self.parts().into_iter();
        let large = parts.filter(|part| Self::signed_area(part) > SLIVER_M2);
        large
            .map(|part| part.into_iter().map(lift).collect())
            .collect()
    }
}

fn ring_area(ring: &[[f64; 2]]) -> f64 {
    let Some(&[x0, y0]) = ring.first() else {
        return 0.0;
    };
    let next = ring.iter().cycle().skip(1);
    let twice =
        |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - x0) * (b[1] - y0) - (b[0] - x0) * (a[1] - y0);
    0.5 * ring.iter().zip(next).map(twice).sum::<f64>()
}
