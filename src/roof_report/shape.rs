//! The shape of a building as a function of uncertain numbers, and what their errors do.
//!
//! ```text
//! z_f(p) = z_f(m) + u sigma_f + (g_f + t_f) . (p - m)
//! sigma^2 of f(x) = sum_i (f(x + sigma_i e_i) - f(x - sigma_i e_i))^2 / 4
//! ```
//!
//! The numbers x are x and y of every corner, the place s of every straight side across it, the tilt
//! t_f of every facet along its steepest direction and across it, and one number u by which all
//! facets are too high. Their standard deviations are those that the adjustment states of corners,
//! sides, slopes and heights in the middle m. Areas and volumes depend on sides, by their lengths
//! l: dA = sum_k l_k s_k; lengths depend on corners.
//!
//! Assumption: the numbers are not correlated, and a facet tilts as easily across its steepest
//! direction as along it. Only the variances leave the adjustment; sides that go on into each other
//! in a straight line are one. Heights are taken as one: what they have in common (orientation,
//! forward overlap) is most of their error, so that volumes are not made too certain.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Point2, Vector2};

use super::edges::{RoofEdge, STRAIGHT_SINE, gradient, key};
use super::estimate::Estimate;
use crate::geometry::mean_point;
use crate::ids::FacetId;
use crate::math::atan2;
use crate::model::Facet;

/// Step of a number whose standard deviation is not known: it only shows what depends on it.
const PROBE: f64 = 1e-3;

/// Effects below this are rounding.
const NO_EFFECT: f64 = 1e-9;

/// A building whose corners and planes can be moved.
pub(super) struct Shape<'a> {
    facets: Vec<ShapeFacet<'a>>,
    /// The values of all numbers, and their standard deviations where they are known.
    values: Vec<f64>,
    sigmas: Vec<Option<f64>>,
    nodes: BTreeMap<[i64; 2], usize>,
    /// The number of the first tilt.
    first_tilt: usize,
    ground_z: f64,
}

struct ShapeFacet<'a> {
    id: FacetId,
    facet: &'a Facet,
    /// Corners, by ring.
    rings: Vec<Vec<usize>>,
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

/// A stretch of an outline between two corners.
struct OutlinePiece {
    /// The number of the straight side on which it lies.
    side: usize,
    /// Length in plan, metres; negative where the facet shrinks when the side's number grows.
    length: f64,
    middle: Point2<f64>,
}

impl<'a> Shape<'a> {
    pub(super) fn new(facets: &[(FacetId, &'a Facet)], ground_z: f64) -> Self {
        let mut shape = Self {
            facets: Vec::new(),
            values: Vec::new(),
            sigmas: Vec::new(),
            nodes: BTreeMap::new(),
            first_tilt: 0,
            ground_z,
        };
        for &(id, facet) in facets {
            let rings = std::iter::once(&facet.outer).chain(&facet.holes);
            let rings: Vec<_> = rings.map(|ring| shape.nodes_of(facet, ring)).collect();
            let gradient = gradient(facet);
            let steepest = gradient.try_normalize(1e-3).unwrap_or_else(Vector2::x);
            let middle = mean_point(&facet.outer).xy();
            let (area, moment) = shape.area_and_moment(&rings, &middle);
            shape.facets.push(ShapeFacet {
                id,
                facet,
                rings,
                pieces: Vec::new(),
                gradient,
                axes: [steepest, Vector2::new(-steepest.y, steepest.x)],
                middle,
                middle_z: facet.plane.z_at(middle.x, middle.y),
                area,
                moment,
            });
        }
        shape.add_sides();
        shape.first_tilt = shape.values.len();
        for facet in &shape.facets {
            let known = facet.facet.uncertainty.as_ref();
            // d atan(s) = ds / (1 + s^2).
            let stretch = 1.0 + facet.gradient.norm_squared();
            let tilt = known.map(|u| u.slope_deg.to_radians() * stretch);
            shape.values.extend([0.0, 0.0]);
            shape.sigmas.extend([tilt, tilt]);
        }
        let all_known = facets.iter().all(|(_, f)| f.uncertainty.is_some());
        shape.values.push(0.0);
        shape.sigmas.push(all_known.then_some(1.0));
        shape
    }

    /// Adds a number for every straight side, with the largest standard deviation that its facets
    /// state.
    fn add_sides(&mut self) {
        let first = self.values.len();
        let straights = Straights::of(self);
        self.values.resize(first + straights.directions.len(), 0.0);
        self.sigmas.resize(self.values.len(), None);
        for facet in 0..self.facets.len() {
            let of = &self.facets[facet];
            let pieces = ring_pieces(&of.rings).map(|nodes| {
                let straight = straights.of_piece[&sorted(nodes)];
                let [p, q] = nodes.map(|node| self.corner(&self.values, node));
                let is_along = (q - p).dot(&straights.directions[straight]) > 0.0;
                // A number moves its side to the left, where a facet has its inside.
                let sign = if is_along { -1.0 } else { 1.0 };
                OutlinePiece {
                    side: first + straight,
                    length: sign * (q - p).norm(),
                    middle: nalgebra::center(&p, &q),
                }
            });
            let pieces: Vec<OutlinePiece> = pieces.collect();
            if let Some(known) = &of.facet.uncertainty {
                for piece in &pieces {
                    if let Some(side) = known.side(&piece.middle) {
                        let stated = &mut self.sigmas[piece.side];
                        *stated = Some(stated.map_or(side.sigma_m, |s| s.max(side.sigma_m)));
                    }
                }
            }
            self.facets[facet].pieces = pieces;
        }
    }

    /// Area of rings as they are, and its first moment about a place.
    fn area_and_moment(&self, rings: &[Vec<usize>], about: &Point2<f64>) -> (f64, Vector2<f64>) {
        let (mut area, mut moment) = (0.0, Vector2::zeros());
        for nodes in ring_pieces(rings) {
            let [p, q] = nodes.map(|node| self.corner(&self.values, node) - about);
            area += p.perp(&q) / 2.0;
            moment += (p + q) * p.perp(&q) / 6.0;
        }
        (area, moment)
    }

    /// The corners of a ring, with the largest standard deviations that its facets state.
    fn nodes_of(&mut self, facet: &Facet, ring: &[nalgebra::Point3<f64>]) -> Vec<usize> {
        let known = facet.uncertainty.as_ref();
        ring.iter()
            .map(|p| {
                let next = self.values.len() / 2;
                let node = *self.nodes.entry(key(p)).or_insert(next);
                if node == next {
                    self.values.extend([p.x, p.y]);
                    self.sigmas.extend([None, None]);
                }
                if let Some(sigma) = known.and_then(|u| u.at(p)) {
                    for axis in 0..2 {
                        let stated = &mut self.sigmas[2 * node + axis];
                        *stated = Some(stated.map_or(sigma[axis], |s| s.max(sigma[axis])));
                    }
                }
                node
            })
            .collect()
    }

    /// The value of a function of the numbers, and its standard deviation by first-order
    /// propagation; `None` if it depends on one that has none.
    pub(super) fn estimate(&self, f: &dyn Fn(&[f64]) -> f64) -> Estimate {
        let mut x = self.values.clone();
        let value = f(&x);
        let mut variance = Some(0.0);
        for (i, sigma) in self.sigmas.iter().enumerate() {
            let step = sigma.unwrap_or(PROBE);
            x[i] = self.values[i] + step;
            let above = f(&x);
            x[i] = self.values[i] - step;
            let effect = (above - f(&x)) / 2.0;
            x[i] = self.values[i];
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

    fn corner(&self, x: &[f64], node: usize) -> Point2<f64> {
        Point2::new(x[2 * node], x[2 * node + 1])
    }

    /// The first of both tilts of a facet.
    fn tilt(&self, facet: usize) -> usize {
        self.first_tilt + 2 * facet
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

    /// Volume between a facet and the ground, cubic metres.
    pub(super) fn volume_below(&self, x: &[f64], facet: usize) -> f64 {
        let of = &self.facets[facet];
        let known = of.facet.uncertainty.as_ref();
        let raised = x.last().expect("u is the last number") * known.map_or(1.0, |k| k.height_m);
        let height = of.middle_z + raised - self.ground_z;
        let grown = |p: &OutlinePiece| (p.middle - of.middle) * (p.length * x[p.side]);
        let moment = of
            .pieces
            .iter()
            .map(grown)
            .fold(of.moment, |sum, m| sum + m);
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
        let ends = [edge.segment.p0, edge.segment.p1];
        let [a, b] = ends.map(|p| self.corner(x, self.nodes[&key(&p)]));
        let rise = self.gradient(x, facet).dot(&(b - a));
        crate::math::hypot((b - a).norm(), rise)
    }
}

/// The straight sides of a building: pieces of outlines that go on into each other.
struct Straights {
    /// Unit vectors.
    directions: Vec<Vector2<f64>>,
    /// For every piece, by its corners in order, its straight side.
    of_piece: BTreeMap<[usize; 2], usize>,
}

impl Straights {
    fn of(shape: &Shape) -> Self {
        let rings = shape.facets.iter().flat_map(|f| ring_pieces(&f.rings));
        let mut at: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        let pieces: BTreeSet<[usize; 2]> = rings.map(sorted).collect();
        for &[p, q] in &pieces {
            at.entry(p).or_default().insert(q);
            at.entry(q).or_default().insert(p);
        }
        let direction = |[p, q]: [usize; 2]| {
            let [p, q] = [p, q].map(|node| shape.corner(&shape.values, node));
            (q - p).try_normalize(0.0).unwrap_or_else(Vector2::x)
        };
        let mut straights = Self {
            directions: Vec::new(),
            of_piece: BTreeMap::new(),
        };
        for &piece in &pieces {
            if straights.of_piece.contains_key(&piece) {
                continue;
            }
            let straight = straights.directions.len();
            straights.directions.push(direction(piece));
            let mut ahead = vec![piece, [piece[1], piece[0]]];
            straights.of_piece.insert(piece, straight);
            while let Some([from, to]) = ahead.pop() {
                let along = direction([from, to]);
                for &next in &at[&to] {
                    let on = direction([to, next]);
                    let is_straight = along.dot(&on) > 0.0 && along.perp(&on).abs() < STRAIGHT_SINE;
                    if is_straight && !straights.of_piece.contains_key(&sorted([to, next])) {
                        straights.of_piece.insert(sorted([to, next]), straight);
                        ahead.push([to, next]);
                    }
                }
            }
        }
        straights
    }
}

fn sorted([p, q]: [usize; 2]) -> [usize; 2] {
    [p.min(q), p.max(q)]
}

/// From each corner of rings to the next.
fn ring_pieces(rings: &[Vec<usize>]) -> impl Iterator<Item = [usize; 2]> + '_ {
    rings.iter().flat_map(|ring| {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(&p, &q)| [p, q])
    })
}
