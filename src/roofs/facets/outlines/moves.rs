//! The moves that make outlines simpler, with the energy that each takes away.
//!
//! After a move most chains are as they were, and of most of the others the views say what they
//! said: only ways across the area that changed hands are summed again.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use nalgebra::Point2;

use super::area::PlanArea;
use super::energy::OutlineEnergy;
use super::rings::{Chain, ChainPlace, Links, Rings};
use super::ways;
use crate::base::evidence::CornerTable;
use crate::base::evidence::ON_LINE;
use crate::base::geometry::bounds;
use crate::base::math::larger;
use crate::roofs::facets::borders::charged_length;

/// Places along an outline are told apart by so much, metres: as far as lines beside it may lie.
const PLACE_M: f64 = 0.25;

/// Energies that differ by less are the same, nats: likelihoods a hundredth apart decide nothing.
const ENERGY_TOLERANCE_NATS: f64 = 0.01;

/// A simpler way between two vertices of a chain.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Move {
    /// From this vertex of the chain to that one.
    pub stretch: [usize; 2],
    /// The positions along the simpler way, with its ends.
    pub way: Vec<Point2<f64>>,
}

impl Move {
    /// The vertices between the ends.
    pub(super) fn between(&self) -> &[Point2<f64>] {
        &self.way[1..self.way.len() - 1]
    }

    /// The outline of the area that changes hands.
    pub(super) fn outline(&self, chain: &Chain, rings: &Rings) -> Vec<Point2<f64>> {
        outline(chain.way(rings, self.stretch), self.between())
    }
}

fn outline(mut old: Vec<Point2<f64>>, between: &[Point2<f64>]) -> Vec<Point2<f64>> {
    old.extend(between.iter().rev());
    old
}

/// A move, with what is known of the energy that it takes away.
struct RatedMove {
    to_make: Move,
    /// By how much the energy falls, nats, but for what the views say and what the new sides cost.
    without_area_and_sides: f64,
    /// What the views say, nats; `None` where the move may not be made for their sake.
    area: Option<f64>,
    /// Corners of a box around the area that changes hands.
    around: [Point2<f64>; 2],
    /// What the new sides cost, nats, once it is known.
    sides: Option<f64>,
}

/// The moves of all chains.
#[derive(Default)]
pub(super) struct KnownMoves {
    chains: BTreeMap<ChainPlace, Vec<RatedMove>>,
    /// Boxes around what changed hands since the moves were rated.
    changed: Vec<[Point2<f64>; 2]>,
}

impl KnownMoves {
    /// The chains of all rings, and for each the move that takes most energy away.
    pub(super) fn best_of_chains(
        &mut self,
        energy: &OutlineEnergy,
        rings: &Rings,
        area: &PlanArea,
    ) -> Vec<(Chain, Option<Move>)> {
        let links = rings.links();
        let mut known = std::mem::take(&mut self.chains);
        let with_moves = |chain: Chain| {
            let place = chain.place(rings, &links);
            let moves = known.remove(&place);
            (chain, place, Mutex::new(moves))
        };
        let chains: Vec<_> = rings.chains().into_iter().map(with_moves).collect();
        // Each is locked once.
        let best = crate::base::execution::map(&chains, |_, (chain, _, moves)| {
            let mut moves = moves.lock().unwrap_or_else(PoisonError::into_inner);
            let chain = RatedChain {
                energy,
                chain,
                rings,
                area,
            };
            match moves.as_mut() {
                Some(moves) => chain.rate_changed(moves, &self.changed),
                None => *moves = Some(chain.moves(&links)),
            }
            moves.as_mut().and_then(|moves| chain.best(moves))
        });
        self.changed.clear();
        let keep = |((chain, place, moves), best): ((Chain, ChainPlace, Mutex<_>), _)| {
            let moves: Option<_> = moves.into_inner().unwrap_or_else(PoisonError::into_inner);
            self.chains.extend(moves.map(|moves| (place, moves)));
            (chain, best)
        };
        chains.into_iter().zip(best).map(keep).collect()
    }

    /// What the views say of all moves.
    #[cfg(test)]
    pub(super) fn areas(&self) -> Vec<Option<f64>> {
        self.chains.values().flatten().map(|m| m.area).collect()
    }

    /// Gives the area within an outline to the other facet of a chain; what the views say of moves
    /// across it is no longer known.
    pub(super) fn change_hands(
        &mut self,
        area: &mut PlanArea,
        chain: &Chain,
        outline: Vec<Point2<f64>>,
    ) {
        area.change_hands(chain, &area.inside(std::slice::from_ref(&outline)));
        self.changed.push(bounds(outline));
    }
}

/// A chain with all that its moves are rated by.
struct RatedChain<'a> {
    energy: &'a OutlineEnergy<'a>,
    chain: &'a Chain,
    rings: &'a Rings,
    area: &'a PlanArea<'a>,
}

impl RatedChain<'_> {
    /// All moves along it.
    fn moves(&self, links: &Links) -> Vec<RatedMove> {
        let (chain, rings) = (self.chain, self.rings);
        let own = chain.way(rings, [0, chain.vertices.len() - 1]);
        let sides: Vec<f64> = own.windows(2).map(|side| self.side(side)).collect();
        let mut moves = Vec::new();
        for [from, to] in chain.stretches() {
            let (old, stretch) = (&own[from..=to], [from, to]);
            let before = sides[from..to].iter().sum::<f64>() + corners(old, chain, stretch, rings);
            for between in ways::simpler(chain, stretch, rings, links) {
                let outline = outline(old.to_vec(), &between);
                let mut way = vec![old[0]];
                way.extend(between);
                way.push(old[old.len() - 1]);
                moves.push(RatedMove {
                    without_area_and_sides: before - corners(&way, chain, stretch, rings),
                    area: self
                        .area
                        .gain(chain, &self.area.inside(std::slice::from_ref(&outline))),
                    around: bounds(outline),
                    to_make: Move { stretch, way },
                    sides: None,
                });
            }
        }
        moves
    }

    /// Rates the moves again that go across what `changed` hands.
    fn rate_changed(&self, moves: &mut [RatedMove], changed: &[[Point2<f64>; 2]]) {
        for rated in moves {
            if changed
                .iter()
                .any(|c| self.area.have_samples_in_common(c, &rated.around))
            {
                let outline = rated.to_make.outline(self.chain, self.rings);
                rated.area = self.area.gain(self.chain, &self.area.inside(&[outline]));
            }
        }
    }

    /// The move that takes most energy away.
    fn best(&self, moves: &mut [RatedMove]) -> Option<Move> {
        let mut best: Option<(f64, usize)> = None;
        for (i, rated) in moves.iter_mut().enumerate() {
            let Some(nats) = rated.area else {
                continue;
            };
            let Move { stretch, way } = &rated.to_make;
            // Of two ways that cost the same the one with fewer vertices is taken.
            let fewer = way.len() < stretch[1] - stretch[0] + 1;
            let needed = if fewer {
                -ENERGY_TOLERANCE_NATS
            } else {
                ENERGY_TOLERANCE_NATS
            };
            let so_far = best.map_or(needed, |(gain, _)| larger(gain, needed));
            let most = rated.without_area_and_sides + nats;
            // Whatever lines run along it, the way costs something.
            if most - self.least(way) <= so_far {
                continue;
            }
            let sides = *rated.sides.get_or_insert_with(|| self.sides(way));
            let gain = most - sides;
            if gain > so_far && !ways::meets_others(way, self.chain, *stretch, self.rings) {
                best = Some((gain, i));
            }
        }
        best.map(|(_, i)| moves[i].to_make.clone())
    }

    /// What the sides of a way cost at least, nats.
    fn least(&self, way: &[Point2<f64>]) -> f64 {
        let length: f64 = way.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
        ON_LINE * length * self.energy.border_nats_per_m
    }

    /// What the sides of a way cost, nats.
    fn sides(&self, way: &[Point2<f64>]) -> f64 {
        way.windows(2).map(|w| self.side(w)).sum()
    }

    /// What a side costs, by its two ends, nats: V of the labelling.
    fn side(&self, ends: &[Point2<f64>]) -> f64 {
        let plane = |facet: usize| &self.energy.planes[self.area.label(facet) as usize];
        let (left, right) = (plane(self.chain.left), self.chain.right.map(plane));
        let ends = [&ends[0], &ends[1]];
        charged_length(self.energy.lines, ends, Some(left), right) * self.energy.border_nats_per_m
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
    let turn = crate::base::math::atan2(into.perp(&out), into.dot(&out)).abs();
    CornerTable::fitted().cost(turn.to_degrees(), PLACE_M)
}
