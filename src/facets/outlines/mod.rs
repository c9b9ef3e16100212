//! Outlines with the corners that roofs have (B99 4.3).
//!
//! Labelled cells end where the views cease to agree: at a tree over an eave, at the shadow of a
//! chimney, at a piece of gutter. Their outlines turn at every such place. What roofs look like
//! says that few of these corners exist, and that those turn by a right angle, as a rule. An
//! outline is the one of least
//!
//! ```text
//! E = - sum over area  nats(views | plane)  +  sum over sides  length x V  +  sum over corners
//! ```
//!
//! with the first two terms of the labelling ([`crate::labelling`]) and, for every corner, minus
//! the logarithm of how often roofs turn so ([`crate::evidence::CornerTable`]). The labelling
//! cannot have the last one, because a corner is no matter of two cells. Ways between two facets,
//! or between a facet and what is no roof, are replaced by simpler ones as long as E falls: by the
//! straight way, and by ways that go on from one end and meet what comes from the other.
//!
//! ```text
//! energy  what the energy of outlines is made of
//! rings   the outlines of all facets, and the chains of sides that they share
//! ways    simpler ways between two vertices of a chain
//! area    what the views say of the area between two ways
//! ```
//!
//! Invariant: no side meets another one but in a vertex; vertices that facets share stay shared.

mod area;
mod energy;
mod rings;
mod ways;

use nalgebra::{Point2, Vector2};

use self::area::PlanArea;
pub(super) use self::energy::OutlineEnergy;
use self::rings::{Chain, Links, Rings};
use super::borders::border_share;
use super::delineation::{Delineation, Outline};
use crate::evidence::CornerTable;

/// Sides are rated in pieces of this length, metres: lines that are no farther away run along them.
const PIECE_M: f64 = 0.25;

/// Energies that differ by less are the same, nats.
const ROUNDING_NATS: f64 = 1e-6;

/// A simpler way between two vertices of a chain.
struct Move {
    /// By how much the energy falls, nats.
    gain: f64,
    /// From this vertex of the chain to that one.
    stretch: [usize; 2],
    /// The vertices between them.
    between: Vec<Point2<f64>>,
    /// Samples of the area that changes hands.
    samples: Vec<usize>,
}

impl OutlineEnergy<'_> {
    /// The outlines, those that are `accepted` with the corners of least energy.
    pub(super) fn simplify(&self, found: Delineation, accepted: &[bool]) -> Delineation {
        let mut rings = Rings::new(&found, accepted);
        let labels: Vec<u32> = found.outlines.iter().map(|o| o.plane).collect();
        let Some(mut area) = PlanArea::new(self, labels, &rings) else {
            return found;
        };
        // Every move takes energy or a vertex away, so that this ends; the bound guards against
        // rounding.
        const MOST_ROUNDS: usize = 50;
        for _ in 0..MOST_ROUNDS {
            let mut changed = vec![false; found.outlines.len()];
            let links = rings.links();
            for chain in rings.chains() {
                // A chain knows places in the rings as they were when the round began.
                if chain.facets().any(|f| changed[f]) {
                    continue;
                }
                if let Some(best) = self.best(&chain, &rings, &links, &area) {
                    rings.replace(&chain, best.stretch, &best.between);
                    area.change_hands(&chain, &best.samples);
                    chain.facets().for_each(|f| changed[f] = true);
                }
            }
            if !changed.contains(&true) {
                break;
            }
        }
        let Delineation { outlines, .. } = found;
        let simpler = |(i, outline): (usize, Outline)| match rings.of(i) {
            Some((outer, holes)) => Outline {
                outer,
                holes,
                ..outline
            },
            None => outline,
        };
        let outlines = outlines.into_iter().enumerate().map(simpler).collect();
        Delineation {
            outlines,
            vertices: rings.vertices,
        }
    }

    /// The move along a chain that takes most energy away.
    fn best(&self, chain: &Chain, rings: &Rings, links: &Links, area: &PlanArea) -> Option<Move> {
        let mut best: Option<Move> = None;
        for [from, to] in chain.stretches() {
            let old = chain.way(rings, [from, to]);
            let costs = |way: &[Point2<f64>]| {
                self.sides(way, chain, area) + corners(way, chain, [from, to], rings)
            };
            let before = costs(&old);
            for between in ways::simpler(chain, [from, to], rings, links) {
                let mut way = vec![old[0]];
                way.extend(&between);
                way.push(old[old.len() - 1]);
                let saved = before - costs(&way);
                let mut outline = old.clone();
                outline.extend(between.iter().rev());
                let samples = area.inside(&[outline]);
                let Some(gain) = area.gain(chain, &samples).map(|nats| saved + nats) else {
                    continue;
                };
                // Of two ways that cost the same the one with fewer vertices is taken.
                let fewer = between.len() + 2 < old.len();
                let so_far = match &best {
                    Some(best) => best.gain,
                    None if fewer => -ROUNDING_NATS,
                    None => ROUNDING_NATS,
                };
                if gain > so_far && !ways::meets_others(&way, chain, [from, to], rings) {
                    best = Some(Move {
                        gain,
                        stretch: [from, to],
                        between,
                        samples,
                    });
                }
            }
        }
        best
    }

    /// What the sides of a way cost, nats: V of the labelling.
    fn sides(&self, way: &[Point2<f64>], chain: &Chain, area: &PlanArea) -> f64 {
        let plane = |facet: usize| &self.planes[area.label(facet) as usize];
        let (left, right) = (plane(chain.left), chain.right.map(plane));
        let side = |w: &[Point2<f64>]| {
            let along: Vector2<f64> = w[1] - w[0];
            let pieces = (along.norm() / PIECE_M).ceil().max(1.0);
            let at = |k: usize| w[0] + along * (k as f64 / pieces);
            let share = |k: usize| border_share(self.lines, [at(k), at(k + 1)], Some(left), right);
            let shares: f64 = (0..pieces as usize).map(share).sum();
            shares * along.norm() / pieces * self.border_nats_per_m
        };
        way.windows(2).map(side).sum()
    }
}

/// What the corners of a way cost, nats, with those at its ends: in the mean over the facets on
/// both sides of it.
fn corners(way: &[Point2<f64>], chain: &Chain, stretch: [usize; 2], rings: &Rings) -> f64 {
    let around = rings.around(chain, stretch);
    let of_facet = |[before, after]: &[Point2<f64>; 2]| {
        let mut all = vec![*before];
        all.extend(way);
        all.push(*after);
        all.windows(3)
            .map(|w| corner(w[0], w[1], w[2]))
            .sum::<f64>()
    };
    around.iter().map(of_facet).sum::<f64>() / around.len() as f64
}

fn corner(a: Point2<f64>, b: Point2<f64>, c: Point2<f64>) -> f64 {
    let (into, out) = (b - a, c - b);
    let turn = crate::math::atan2(into.perp(&out), into.dot(&out)).abs();
    CornerTable::fitted().cost(turn.to_degrees(), PIECE_M)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facets::borders::{Arrangement, Border, BorderKind, LineIndex};
    use crate::facets::delineation::delineate;
    use crate::geometry::Plane;
    use crate::labelling::NO_PLANE;
    use nalgebra::Vector3;

    fn frame([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> impl Iterator<Item = Border> {
        let c = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
        (0..4).map(move |i| Border {
            kind: BorderKind::Real,
            a: c[i].into(),
            b: c[(i + 1) % 4].into(),
        })
    }

    fn level(z: f64) -> Plane {
        Plane {
            normal: Vector3::z(),
            d: -z,
        }
    }

    /// The outlines of a roof of 10 m by 6 m, with rectangles of it that have another label, and of
    /// what lies in those; `nats` speak for the first plane on every square metre of them.
    fn outlines(others: &[([f64; 2], [f64; 2], u32)], nats: f64) -> Vec<Vec<Point2<f64>>> {
        let others_borders = others.iter().flat_map(|&(low, high, _)| frame(low, high));
        let borders: Vec<Border> = frame([-10.0, -10.0], [20.0, 16.0])
            .chain(frame([0.0, 0.0], [10.0, 6.0]))
            .chain(others_borders)
            .collect();
        let arrangement = Arrangement::new(&borders);
        let middle = |cell: usize| {
            let of_cell = |t: &&([usize; 3], usize)| t.1 == cell;
            let (corners, _) = arrangement.triangles.iter().find(of_cell).unwrap();
            let sum: Vector2<f64> = corners
                .iter()
                .map(|&v| arrangement.vertices[v].coords)
                .sum();
            sum / 3.0
        };
        let within = |p: &Vector2<f64>, low: [f64; 2], high: [f64; 2]| {
            (0..2).all(|i| low[i] < p[i] && p[i] < high[i])
        };
        let label = |cell: usize| {
            let p = middle(cell);
            let mut at = others
                .iter()
                .filter(|(low, high, _)| within(&p, *low, *high));
            match at.next() {
                Some((.., label)) => *label,
                None if within(&p, [0.0, 0.0], [10.0, 6.0]) => 0,
                None => NO_PLANE,
            }
        };
        let labels: Vec<u32> = (0..arrangement.cells).map(label).collect();
        let planes = [level(5.0), level(8.0)];
        let cost = |cell: usize, plane: u32| {
            let per_m2 = match (labels[cell], plane) {
                (own, plane) if own == plane => -3.0,
                (_, 0) if within(&middle(cell), [0.0, 0.0], [10.0, 6.0]) => -nats,
                _ => 3.0,
            };
            Some(per_m2 * arrangement.areas[cell])
        };
        let energy = OutlineEnergy {
            arrangement: &arrangement,
            planes: &planes,
            lines: &LineIndex::new(Vec::new()),
            border_nats_per_m: 1.25,
            cost: &cost,
        };
        let found = delineate(&arrangement, &labels, &planes);
        let accepted = vec![true; found.outlines.len()];
        let simple = energy.simplify(found, &accepted);
        let ring = |o: &Outline| o.outer.iter().map(|&v| simple.vertices[v]).collect();
        simple.outlines.iter().map(ring).collect()
    }

    fn area(ring: &[Point2<f64>]) -> f64 {
        let next = ring.iter().cycle().skip(1);
        0.5 * ring
            .iter()
            .zip(next)
            .map(|(a, b)| a.coords.perp(&b.coords))
            .sum::<f64>()
    }

    #[test]
    fn a_bite_about_which_the_views_say_nothing_is_closed() {
        for bite in [([3.0, -1.0], [6.0, 2.0]), ([8.0, -1.0], [11.0, 2.5])] {
            let found = outlines(&[(bite.0, bite.1, NO_PLANE)], 0.0);
            assert_eq!(found.len(), 1);
            assert_eq!(found[0].len(), 4, "{found:?}");
            assert!((area(&found[0]) - 60.0).abs() < 1e-6);
        }
    }

    #[test]
    fn a_bite_that_the_views_show_stays() {
        let found = outlines(&[([3.0, -1.0], [6.0, 2.0], NO_PLANE)], -3.0);
        assert_eq!(found[0].len(), 8, "{found:?}");
        assert!((area(&found[0]) - 54.0).abs() < 1e-6);
    }

    #[test]
    fn neighbours_go_on_sharing_their_vertices() {
        // A second roof bites into the first where the views say as much for either.
        let beyond = ([10.0, 0.0], [14.0, 6.0], 1);
        let bite = ([8.0, 2.0], [11.0, 4.0], 1);
        let found = outlines(&[bite, beyond], 3.0);
        assert_eq!(
            found.iter().map(Vec::len).collect::<Vec<_>>(),
            [4, 4],
            "{found:?}"
        );
        let total: f64 = found.iter().map(|ring| area(ring)).sum();
        assert!((total - 84.0).abs() < 1e-6, "{total}");
        let shared = found[0].iter().filter(|p| found[1].contains(p)).count();
        assert_eq!(shared, 2);
    }

    #[test]
    fn a_hole_stays_within_its_facet() {
        let found = outlines(&[([4.0, 2.0], [6.0, 4.0], NO_PLANE)], -3.0);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].len(), 4);
    }
}
