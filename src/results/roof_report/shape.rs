//! The shape of a building as a function of uncertain numbers, and what their errors do.
//!
//! ```text
//! z_f(p) = z_f(m) + u sigma_f + (g_f + t_f) . (p - m)
//! dA     = sum_k l_k s_k                     area in plan; l length of a piece of the outline
//! dl     = s_b / sin(b) - s_a / sin(a) + s (cot(a) + cot(b))      length of an edge between sides
//! sigma^2 of f(x) = sum_i (f(x + sigma_i e_i) - f(x - sigma_i e_i))^2 / 4
//! ```
//!
//! The numbers x are the place s of every straight side across it, the tilt t_f of every facet
//! along its steepest direction and across it, and one number u by which all facets are too high.
//! Their standard deviations are those that the adjustment states of sides, slopes and heights in
//! the middle m.
//!
//! Assumption: the numbers are not correlated, and a facet tilts as easily across its steepest
//! direction as along it. Only the variances leave the adjustment; pieces of outlines that go on
//! into each other are one side. Heights are taken as one: what they have in common (orientation,
//! forward overlap) is most of their error, so that volumes are not made too certain.

use nalgebra::{Point2, Vector2};

use super::edges::{RoofEdge, gradient};
use super::estimate::Estimate;
use super::straight_sides::{Corners, StraightSides, ring_pieces};
use crate::base::geometry::{Segment3, mean_point};
use crate::base::ids::FacetId;
use crate::base::math::{atan2, larger};
use crate::roofs::model::Facet;

/// Step of a number whose standard deviation is not known: it only shows what depends on it.
const PROBE: f64 = 1e-3;

/// Effects below this are rounding.
const NO_EFFECT: f64 = 1e-9;

/// Sine of the angle between an edge and a side below which the side does not end it (15 degrees).
const ENDING_SINE: f64 = 0.2588;
/// No angle between an edge and what ends it has a smaller sine (3 degrees).
const LEAST_ANGLE_SINE: f64 = 0.05;

/// A building whose sides and planes can be moved.
pub(super) struct Shape<'a> {
    facets: Vec<ShapeFacet<'a>>,
    corners: Corners,
    sides: StraightSides,
    /// Standard deviations of all numbers, where they are known: sides, tilts, u.
    sigmas: Vec<Option<f64>>,
    ground_z: f64,
}

struct ShapeFacet<'a> {
    id: FacetId,
    facet: &'a Facet,
    /// Of the outline, from corner to corner.
    pieces: Vec<OutlinePiece>,
    gradient: Vector2<f64>,
    /// The steepest direction, and that to the left of it.
    axes: [Vector2<f64>; 2],
    middle: Point2<f64>,
    middle_z: f64,
    /// Area in plan as it is, square metres, and its first moment about the middle, cubic metres.
    area: f64,
    moment: Vector2<f64>,
}

/// A stretch of a facet's outline, the facet to its left.
pub(super) struct Stretch {
    /// Its ends on the facet's plane.
    pub(super) segment: Segment3,
    /// The straight side on which it lies.
    pub(super) side: usize,
    /// 1 where the facet grows with the side's number, -1 where it shrinks.
    pub(super) grows: f64,
}

/// A part of a facet, some of whose borders move with straight sides.
pub(super) struct Part {
    /// Area in plan as it is, square metres.
    pub(super) plan_area: f64,
    /// Sides, and the length in plan that moves with each, metres; negative where the part shrinks
    /// when the side's number grows.
    pub(super) borders: Vec<(usize, f64)>,
}

/// A stretch of an outline between two corners.
struct OutlinePiece {
    ends: [usize; 2],
    /// The straight side on which it lies.
    side: usize,
    /// Length in plan, metres; negative where the facet shrinks when the side's number grows.
    length: f64,
    middle: Point2<f64>,
}

impl<'a> Shape<'a> {
    pub(super) fn new(facets: &[(FacetId, &'a Facet)], ground_z: f64) -> Self {
        let (corners, rings) = Corners::of(facets.iter().map(|(_, facet)| *facet));
        let sides = StraightSides::of(&corners, rings.iter().flatten());
        let mut sigmas = vec![None; sides.len()];
        let mut shape_facets = Vec::new();
        for (&(id, facet), rings) in facets.iter().zip(&rings) {
            let gradient = gradient(facet);
            let steepest = gradient.try_normalize(1e-3).unwrap_or_else(Vector2::x);
            let middle = mean_point(&facet.outer).xy();
            let plan = facet.plan();
            let area = plan.signed_area();
            let centroid = plan.centroid().unwrap_or(middle);
            let piece = |ends: [usize; 2]| {
                let [p, q] = ends.map(|corner| corners.at(corner));
                let side = sides.of_piece(ends);
                // A number moves its side to the left, where a facet has its inside.
                let is_along = (q - p).dot(&sides.direction(side)) > 0.0;
                OutlinePiece {
                    ends,
                    side,
                    length: if is_along { -1.0 } else { 1.0 } * (q - p).norm(),
                    middle: nalgebra::center(&p, &q),
                }
            };
            let pieces: Vec<OutlinePiece> = ring_pieces(rings).map(piece).collect();
            // A side that facets share is as uncertain as the largest of what they state.
            for piece in &pieces {
                let known = facet.uncertainty.as_ref();
                if let Some(side) = known.and_then(|known| known.side(&piece.middle)) {
                    let stated: &mut Option<f64> = &mut sigmas[piece.side];
                    *stated = Some(stated.map_or(side.sigma_m, |s| s.max(side.sigma_m)));
                }
            }
            shape_facets.push(ShapeFacet {
                id,
                facet,
                pieces,
                gradient,
                axes: [steepest, Vector2::new(-steepest.y, steepest.x)],
                middle,
                middle_z: facet.plane.z_at(middle.x, middle.y),
                area,
                moment: (centroid - middle) * area,
            });
        }
        for facet in &shape_facets {
            let known = facet.facet.uncertainty.as_ref();
            // d atan(s) = ds / (1 + s^2).
            let stretch = 1.0 + facet.gradient.norm_squared();
            let tilt = known.map(|u| u.slope_deg.to_radians() * stretch);
            sigmas.extend([tilt, tilt]);
        }
        let all_known = facets.iter().all(|(_, f)| f.uncertainty.is_some());
        sigmas.push(all_known.then_some(1.0));
        Self {
            facets: shape_facets,
            corners,
            sides,
            sigmas,
            ground_z,
        }
    }

    /// The value of a function of the numbers, and its standard deviation by first-order
    /// propagation; `None` if it depends on one that has none.
    pub(super) fn estimate(&self, f: &dyn Fn(&[f64]) -> f64) -> Estimate {
        let mut x = vec![0.0; self.sigmas.len()];
        let value = f(&x);
        let mut variance = Some(0.0);
        for (i, sigma) in self.sigmas.iter().enumerate() {
            let step = sigma.unwrap_or(PROBE);
            x[i] = step;
            let above = f(&x);
            x[i] = -step;
            let effect = (above - f(&x)) / 2.0;
            x[i] = 0.0;
            if sigma.is_none() && effect.abs() > NO_EFFECT {
                variance = None;
            }
            variance = variance.map(|v: f64| v + effect * effect);
        }
        Estimate {
            value,
            sigma: variance.map(f64::sqrt),
        }
    }

    /// The first of both tilts of a facet.
    fn tilt(&self, facet: usize) -> usize {
        self.sides.len() + 2 * facet
    }

    fn gradient(&self, x: &[f64], facet: usize) -> Vector2<f64> {
        let ShapeFacet { gradient, axes, .. } = &self.facets[facet];
        let tilt = self.tilt(facet);
        gradient + axes[0] * x[tilt] + axes[1] * x[tilt + 1]
    }

    /// Area in plan, square metres.
    pub(super) fn plan_area(&self, x: &[f64], facet: usize) -> f64 {
        let ShapeFacet { area, pieces, .. } = &self.facets[facet];
        area + pieces.iter().map(|p| p.length * x[p.side]).sum::<f64>()
    }

    /// Area on the plane, square metres.
    pub(super) fn area(&self, x: &[f64], facet: usize) -> f64 {
        let slope = self.gradient(x, facet).norm_squared();
        self.plan_area(x, facet) * (1.0 + slope).sqrt()
    }

    /// The stretches of a facet's outline.
    pub(super) fn stretches(&self, facet: usize) -> impl Iterator<Item = Stretch> {
        let ShapeFacet { facet, pieces, .. } = &self.facets[facet];
        pieces.iter().map(|piece| {
            let [p, q] = piece.ends.map(|corner| self.corners.at(corner));
            let [p, q] = [p, q].map(|p| facet.plane.lift(p.x, p.y));
            Stretch {
                segment: Segment3::new(p, q),
                side: piece.side,
                grows: piece.length.signum(),
            }
        })
    }

    /// Area of a part of a facet on its plane, square metres.
    pub(super) fn area_of_part(&self, x: &[f64], facet: usize, part: &Part) -> f64 {
        let grown = part.borders.iter().map(|&(side, length)| length * x[side]);
        let slope = self.gradient(x, facet).norm_squared();
        (part.plan_area + grown.sum::<f64>()) * (1.0 + slope).sqrt()
    }

    /// Volume between a facet and the ground, cubic metres.
    pub(super) fn volume_below(&self, x: &[f64], facet: usize) -> f64 {
        let of = &self.facets[facet];
        let known = of.facet.uncertainty.as_ref();
        let raised = x.last().expect("u is the last number") * known.map_or(1.0, |k| k.height_m);
        let height = of.middle_z + raised - self.ground_z;
        let grown = |p: &OutlinePiece| (p.middle - of.middle) * (p.length * x[p.side]);
        let moment = (of.pieces.iter()).fold(of.moment, |sum, piece| sum + grown(piece));
        // The integral of a linear function: its value in the middle, and what it rises from there.
        height * self.plan_area(x, facet) + self.gradient(x, facet).dot(&moment)
    }

    /// The direction of the steepest fall, degrees clockwise from north, 0 to 360.
    pub(super) fn azimuth_deg(&self, facet: usize) -> f64 {
        let fall = -self.facets[facet].gradient;
        let degrees = atan2(fall.x, fall.y).to_degrees();
        if degrees < 0.0 {
            degrees + 360.0
        } else {
            degrees
        }
    }

    /// By how much the steepest direction is turned, degrees.
    pub(super) fn turn_deg(&self, x: &[f64], facet: usize) -> f64 {
        let (from, to) = (self.facets[facet].gradient, self.gradient(x, facet));
        atan2(from.perp(&to), from.dot(&to)).to_degrees()
    }

    /// Length of an edge in space, metres, on the facet whose slope is known better.
    pub(super) fn length(&self, x: &[f64], edge: &RoofEdge) -> f64 {
        let sigma = |f: &usize| self.sigmas[self.tilt(*f)].unwrap_or(f64::INFINITY);
        let of_edge = |f: &usize| {
            let id = self.facets[*f].id;
            edge.facet == id || edge.borders_on(id)
        };
        let facet = (0..self.facets.len()).filter(of_edge);
        let facet = facet.min_by(|a, b| sigma(a).total_cmp(&sigma(b)));
        let facet = facet.expect("an edge has a facet of the building");
        let [p, q] = [&edge.segment.p0, &edge.segment.p1];
        let run = q.xy() - p.xy();
        let along = run.try_normalize(0.0).unwrap_or_else(Vector2::x);
        let [from, to] = [p, q].map(|end| match self.corners.find(end) {
            Some(corner) => self.end_shift(x, corner, &along),
            None => 0.0,
        });
        let moved = run + along * (to - from);
        crate::base::math::hypot(moved.norm(), self.gradient(x, facet).dot(&moved))
    }

    /// By how much the end of an edge at a corner moves along it, metres, with the edge's own side
    /// and with the side that ends it: of all that meet there the one that is known best.
    fn end_shift(&self, x: &[f64], corner: usize, along: &Vector2<f64>) -> f64 {
        let left = |v: Vector2<f64>| Vector2::new(-v.y, v.x);
        let pieces = self.facets.iter().flat_map(|f| &f.pieces);
        // Per side the shares of its shift across itself that lie along the edge and across it.
        let sides: Vec<(usize, f64, f64)> = (pieces.filter(|p| p.ends.contains(&corner)))
            .map(|p| (p.side, left(self.sides.direction(p.side))))
            .map(|(side, normal)| (side, normal.dot(along), normal.dot(&left(*along))))
            .collect();
        let sigma = |side: usize| self.sigmas[side].unwrap_or(f64::INFINITY);
        let spread = |s: &(usize, f64, f64)| sigma(s.0) / s.1.abs();
        let own = sides.iter().min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let ending = sides.iter().filter(|s| s.1.abs() > ENDING_SINE);
        let ending = (ending.min_by(|a, b| spread(a).total_cmp(&spread(b))))
            // A corner that no side ends clearly.
            .or_else(|| sides.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())));
        let (Some(own), Some(ending)) = (own, ending) else {
            return 0.0;
        };
        // Both sides still meet there: s_e = (a n_o s_o + b along) . n_e.
        let aside = x[own.0] * own.2;
        (x[ending.0] - aside * ending.2)
            / larger(ending.1.abs(), LEAST_ANGLE_SINE).copysign(ending.1)
    }
}
