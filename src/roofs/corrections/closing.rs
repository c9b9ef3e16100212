//! The place of a deleted facet, divided between its neighbours.
//!
//! Either one neighbour goes on over all of it, or all do and meet where they cross: the lowest
//! there (ridges, hips) or the highest (valleys). That surface is taken which fits the neighbours
//! best along the outline: least area of steps.

use nalgebra::Point2;

use super::draft::DraftFacet;
use crate::base::geometry::{Plane, Polygon, plan_sides};
use crate::roofs::model::{Facet, WELD_M};

/// A stretch of the outline of a facet with what lies beyond it.
struct Side {
    ends: [Point2<f64>; 2],
    beyond: Option<usize>,
}

/// Which planes cover the place.
#[derive(Clone, Debug)]
enum Surface {
    /// That of one facet.
    One(usize),
    /// The lowest of these facets.
    Lowest(Vec<usize>),
    /// The highest of these facets.
    Highest(Vec<usize>),
}

/// How much of a facet's outline its neighbours share, 0 to 1.
pub(super) fn shared_outline(facets: &[DraftFacet], gone: usize) -> f64 {
    let sides = sides(facets, gone);
    let sum = |all: &mut dyn Iterator<Item = &Side>| -> f64 {
        all.map(|s| (s.ends[1] - s.ends[0]).norm()).sum()
    };
    let shared = sum(&mut sides.iter().filter(|s| s.beyond.is_some()));
    shared / sum(&mut sides.iter()).max(f64::MIN_POSITIVE)
}

/// The facets of a building without one of them, whose neighbours go on over its place.
pub(super) fn closed_over(facets: &[DraftFacet], gone: usize) -> Vec<DraftFacet> {
    let sides = sides(facets, gone);
    let mut neighbours: Vec<usize> = sides.iter().filter_map(|s| s.beyond).collect();
    neighbours.sort_unstable();
    neighbours.dedup();
    let plane = |i: usize| &facets[i].facet.plane;
    let ones = neighbours.iter().map(|&i| Surface::One(i));
    let both = [
        Surface::Lowest(neighbours.clone()),
        Surface::Highest(neighbours.clone()),
    ];
    let steps = |surface: &Surface| steps(surface, &sides, &plane);
    // The first of the best: one neighbour, where all fit alike.
    let mut best: Option<(f64, Surface)> = None;
    for surface in ones.chain(both) {
        let area = steps(&surface);
        if best.as_ref().is_none_or(|(least, _)| area < least - 1e-6) {
            best = Some((area, surface));
        }
    }
    let place = facets[gone].facet.plan();
    let gains = |i: usize| best.as_ref().map(|(_, s)| s.part_of(i, &place, &plane));
    let mut left = Vec::new();
    for (i, facet) in facets.iter().enumerate().filter(|(i, _)| *i != gone) {
        match gains(i).flatten() {
            Some(part) => left.extend(facet.over(&facet.facet.plan().or(&part))),
            None => left.push(facet.clone()),
        }
    }
    left
}

impl Surface {
    fn height<'a>(&self, p: &Point2<f64>, plane: &dyn Fn(usize) -> &'a Plane) -> f64 {
        let heights =
            |of: &[usize]| -> Vec<f64> { of.iter().map(|&i| plane(i).z_at(p.x, p.y)).collect() };
        match self {
            Self::One(i) => plane(*i).z_at(p.x, p.y),
            Self::Lowest(of) => heights(of).into_iter().fold(f64::INFINITY, f64::min),
            Self::Highest(of) => heights(of).into_iter().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// The part of a region that a facet covers; `None` for none of it.
    fn part_of<'a>(
        &self,
        facet: usize,
        region: &Polygon,
        plane: &dyn Fn(usize) -> &'a Plane,
    ) -> Option<Polygon> {
        let (of, sign) = match self {
            Self::One(i) => return (*i == facet).then(|| region.clone()),
            Self::Lowest(of) => (of, 1.0),
            Self::Highest(of) => (of, -1.0),
        };
        of.contains(&facet).then(|| {
            let others = of.iter().filter(|&&j| j != facet);
            others.fold(region.clone(), |part, &j| {
                where_lower(&part, plane(facet), plane(j), sign)
            })
        })
    }
}

/// The part of a region where one plane lies below another (`sign` 1) or above it (-1).
fn where_lower(region: &Polygon, plane: &Plane, other: &Plane, sign: f64) -> Polygon {
    let rise = |p: &Plane| -p.normal.xy() / p.normal.z;
    let by = (rise(plane) - rise(other)) * sign;
    let at_origin = (plane.z_at(0.0, 0.0) - other.z_at(0.0, 0.0)) * sign;
    let steep = by.norm_squared();
    if steep < 1e-12 {
        return if at_origin <= 0.0 {
            region.clone()
        } else {
            Polygon::default()
        };
    }
    // On the line by . p + at_origin = 0; the difference falls to the left of this direction.
    let at = Point2::from(-by * (at_origin / steep));
    region.left_of(&at, &nalgebra::Vector2::new(-by.y, by.x))
}

/// Area of the steps between a surface and the facets beyond the outline, square metres.
fn steps<'a>(surface: &Surface, sides: &[Side], plane: &dyn Fn(usize) -> &'a Plane) -> f64 {
    /// Places along a side.
    const SAMPLES: usize = 8;
    let of_side = |side: &Side| {
        let Some(beyond) = side.beyond else {
            return 0.0;
        };
        let [a, b] = side.ends;
        let step = |k: usize| {
            let p = a + (b - a) * ((k as f64 + 0.5) / SAMPLES as f64);
            (surface.height(&p, plane) - plane(beyond).z_at(p.x, p.y)).abs()
        };
        (b - a).norm() * (0..SAMPLES).map(step).sum::<f64>() / SAMPLES as f64
    };
    sides.iter().map(of_side).sum()
}

/// The sides of a facet, in the order of its rings.
fn sides(facets: &[DraftFacet], of: usize) -> Vec<Side> {
    let runs = |facet: &Facet, from: &Point2<f64>, to: &Point2<f64>| {
        let mut sides = facet.rings().flat_map(|ring| plan_sides(ring));
        sides.any(|[p, q]| is_same(&p, from) && is_same(&q, to))
    };
    let side = |ends: [Point2<f64>; 2]| Side {
        ends,
        beyond: (0..facets.len()).find(|&i| i != of && runs(&facets[i].facet, &ends[1], &ends[0])),
    };
    facets[of].facet.plan().sides().map(side).collect()
}

fn is_same(p: &Point2<f64>, q: &Point2<f64>) -> bool {
    (p - q).norm() < WELD_M
}
