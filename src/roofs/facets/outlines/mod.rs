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
//! with the first two terms of the labelling ([`crate::base::labelling`]) and, for every corner,
//! minus the logarithm of how often roofs turn so ([`crate::base::evidence::CornerTable`]). The
//! labelling cannot have the last one, because a corner is no matter of two cells. Ways between two
//! facets, or between a facet and what is no roof, are replaced by simpler ones as long as E falls:
//! by the straight way, and by ways that go on from one end and meet what comes from the other.
//!
//! ```text
//! energy  what the energy of outlines is made of
//! rings   the outlines of all facets, and the chains of sides that they share
//! ways    simpler ways between two vertices of a chain
//! moves   what each of them takes away, kept as long as nothing around it changes
//! area    what the views say of the area between two ways
//! ```
//!
//! Invariant: no side meets another one but in a vertex; vertices that facets share stay shared.

mod area;
mod energy;
mod moves;
mod rings;
mod ways;

use std::collections::BTreeSet;

use self::area::PlanArea;
pub(super) use self::energy::OutlineEnergy;
use self::moves::{KnownMoves, Move};
use self::rings::{Chain, Rings};
use super::delineation::{Delineation, Outline};

impl OutlineEnergy<'_> {
    /// The outlines, those that are `accepted` with the corners of least energy.
    pub(super) fn simplify(&self, found: Delineation, accepted: &[bool]) -> Delineation {
        let mut rings = Rings::new(&found, accepted);
        let labels: Vec<u32> = found.outlines.iter().map(|o| o.plane).collect();
        let Some(mut area) = PlanArea::new(self, labels, &rings) else {
            return found;
        };
        let mut known = KnownMoves::default();
        // Every move takes energy or a vertex away, so that this ends; the bound guards against
        // rounding.
        const MOST_ROUNDS: usize = 50;
        for _ in 0..MOST_ROUNDS {
            let best = known.best_of_chains(self, &rings, &area);
            if !make(best, &mut rings, &mut area, &mut known) {
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
}

/// Makes the best moves of the chains, as far as they have no facet in common; false where none is
/// made.
fn make(
    best: Vec<(Chain, Option<Move>)>,
    rings: &mut Rings,
    area: &mut PlanArea,
    known: &mut KnownMoves,
) -> bool {
    let mut changed = BTreeSet::new();
    for (chain, best) in best {
        // A chain knows places in the rings as they were when the round began.
        let is_known = !chain.facets().any(|f| changed.contains(&f));
        if let Some(best) = best.filter(|_| is_known)
            && !ways::meets_others(&best.way, &chain, best.stretch, rings)
        {
            let outline = best.outline(&chain, rings);
            rings.replace(&chain, best.stretch, best.between());
            known.change_hands(area, &chain, outline);
            changed.extend(chain.facets());
        }
    }
    !changed.is_empty()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::{Plane, signed_area};
    use crate::base::labelling::NO_PLANE;
    use crate::roofs::facets::borders::{Arrangement, Border, BorderKind, LineIndex};
    use crate::roofs::facets::delineation::delineate;
    use nalgebra::{Point2, Vector2};

    fn frame([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> impl Iterator<Item = Border> {
        let c = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
        (0..4).map(move |i| Border {
            kind: BorderKind::Real,
            a: c[i].into(),
            b: c[(i + 1) % 4].into(),
        })
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
        let planes = [Plane::level(5.0), Plane::level(8.0)];
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
        assert_what_is_known_holds(&energy, &found, &accepted);
        assert_area_is_summed_again(&energy, &found, &accepted);
        let simple = energy.simplify(found, &accepted);
        let ring = |o: &Outline| o.outer.iter().map(|&v| simple.vertices[v]).collect();
        simple.outlines.iter().map(ring).collect()
    }

    /// When area changes hands, what is known of the moves across it does not hold, although all
    /// vertices are as they were.
    fn assert_area_is_summed_again(energy: &OutlineEnergy, found: &Delineation, accepted: &[bool]) {
        let rings = Rings::new(found, accepted);
        let labels = found.outlines.iter().map(|o| o.plane).collect();
        let mut area = PlanArea::new(energy, labels, &rings).expect("there are rings");
        let mut known = KnownMoves::default();
        let mut best = known.best_of_chains(energy, &rings, &area).into_iter();
        let Some((chain, best)) = best.find_map(|(chain, best)| Some((chain, best?))) else {
            return;
        };
        let outline = best.outline(&chain, &rings);
        known.change_hands(&mut area, &chain, outline);
        known.best_of_chains(energy, &rings, &area);
        let mut anew = KnownMoves::default();
        anew.best_of_chains(energy, &rings, &area);
        assert_eq!(known.areas(), anew.areas());
    }

    /// In every round what is known gives the moves that rating all of them anew gives.
    fn assert_what_is_known_holds(energy: &OutlineEnergy, found: &Delineation, accepted: &[bool]) {
        let mut rings = Rings::new(found, accepted);
        let labels = found.outlines.iter().map(|o| o.plane).collect();
        let mut area = PlanArea::new(energy, labels, &rings).expect("there are rings");
        let mut known = KnownMoves::default();
        loop {
            let mut fresh = KnownMoves::default();
            let anew = fresh.best_of_chains(energy, &rings, &area);
            let best = known.best_of_chains(energy, &rings, &area);
            let moves = |all: &[(Chain, Option<Move>)]| -> Vec<Option<Move>> {
                all.iter().map(|(_, best)| best.clone()).collect()
            };
            assert_eq!(moves(&best), moves(&anew));
            assert_eq!(known.areas(), fresh.areas());
            if !make(best, &mut rings, &mut area, &mut known) {
                break;
            }
        }
    }

    fn area(ring: &[Point2<f64>]) -> f64 {
        signed_area(ring.iter().copied())
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
    fn a_jog_between_two_roofs_goes() {
        let beside = ([10.0, 0.0], [16.0, 6.0], 1);
        let found = outlines(&[beside, ([9.6, 2.0], [10.0, 4.0], 1)], 0.0);
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [4, 4]);
    }

    #[test]
    fn a_hole_stays_within_its_facet() {
        let found = outlines(&[([4.0, 2.0], [6.0, 4.0], NO_PLANE)], -3.0);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].len(), 4);
    }
}
