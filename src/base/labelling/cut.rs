//! The best of all moves in which cells keep their plane or take a new one: a minimum cut.
//!
//! One expansion of [`super::expansion`]. Costs become integers, so that the cut is exact and the
//! same on every machine.

use super::flow::Flow;

/// Capacities are integers, so that the cut is exact: a millionth of a square metre.
const UNIT: f64 = 1e6;

/// What moves must save to be made, in units. Between labels that cost the same, cells would
/// oscillate with the rounding.
const LEAST_SAVED: i64 = 1000;

/// A minimum cut over binary moves: 0 keeps the label, 1 takes the new one.
pub(super) struct MinimumCut {
    /// (cost of keeping, cost of moving) per node.
    unaries: Vec<(f64, f64)>,
    /// (from, to, capacity): paid when `from` keeps and `to` moves.
    arcs: Vec<(usize, usize, f64)>,
}

impl MinimumCut {
    /// No costs yet.
    pub(super) fn new(nodes: usize) -> Self {
        Self {
            unaries: vec![(0.0, 0.0); nodes],
            arcs: Vec::new(),
        }
    }

    /// Costs of one node by itself.
    pub(super) fn unary(&mut self, node: usize, keep: f64, change: f64) {
        self.unaries[node].0 += keep;
        self.unaries[node].1 += change;
    }

    /// Costs of (keep, keep), (keep, move), (move, keep); (move, move) is 0.
    pub(super) fn pair(&mut self, i: usize, j: usize, stay: f64, j_moves: f64, i_moves: f64) {
        // stay = A, j_moves = B, i_moves = C, D = 0. Submodular when A <= B + C; a border
        // that is cheap twice is made as dear as needed.
        let stay = stay.min(j_moves + i_moves);
        self.unaries[i].0 += stay;
        self.unaries[i].1 += i_moves;
        self.unaries[j].1 -= i_moves;
        self.arcs.push((i, j, j_moves + i_moves - stay));
    }

    /// For each node: does it move? A tie moves, unless hardly anything is gained: a labelling must
    /// not go round in circles.
    pub(super) fn solve(self) -> Vec<bool> {
        let units = |c: f64| (c * UNIT).round() as i64;
        let costs = self.unaries.iter();
        let surplus = costs.map(|(keep, change)| units(*change) - units(*keep));
        let arcs = self.arcs.iter().map(|&(i, j, c)| (i, j, units(c)));
        let arcs: Vec<_> = arcs.filter(|a| a.2 > 0).collect();
        let mut flow = Flow::new(surplus.collect(), &arcs);
        // The deficit that no surplus meets is what the moves save.
        if flow.run() < LEAST_SAVED {
            return vec![false; self.unaries.len()];
        }
        flow.reached().iter().map(|keeps| !keeps).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::testing::uniform;

    /// Costs of keeping and moving, and per pair those of staying, of the second moving and of the
    /// first moving.
    type Pair = (usize, usize, [f64; 3]);

    fn cut(unaries: &[(f64, f64)], pairs: &[Pair]) -> MinimumCut {
        let mut cut = MinimumCut::new(unaries.len());
        for (n, (keep, change)) in unaries.iter().enumerate() {
            cut.unary(n, *keep, *change);
        }
        for (i, j, [stay, j_moves, i_moves]) in pairs {
            cut.pair(*i, *j, *stay, *j_moves, *i_moves);
        }
        cut
    }

    fn cost(unaries: &[(f64, f64)], pairs: &[Pair], moves: &[bool]) -> f64 {
        let own = unaries
            .iter()
            .zip(moves)
            .map(|(u, m)| if *m { u.1 } else { u.0 });
        let joint =
            pairs.iter().map(
                |(i, j, [stay, j_moves, i_moves])| match (moves[*i], moves[*j]) {
                    (false, false) => *stay,
                    (false, true) => *j_moves,
                    (true, false) => *i_moves,
                    (true, true) => 0.0,
                },
            );
        own.sum::<f64>() + joint.sum::<f64>()
    }

    #[test]
    fn no_other_choice_of_moves_is_cheaper() {
        let mut next = uniform(7);
        for _ in 0..50 {
            let unaries: Vec<(f64, f64)> = (0..7).map(|_| (next(), next())).collect();
            let pairs: Vec<Pair> = (0..10)
                .map(|k| {
                    (
                        k % 6,
                        (k % 6) + 1,
                        [0.3 * next(), 0.2 + 0.4 * next(), 0.2 + 0.4 * next()],
                    )
                })
                .collect();
            let found = cost(&unaries, &pairs, &cut(&unaries, &pairs).solve());
            let all = (0..128u32).map(|k| (0..7).map(|n| k >> n & 1 == 1).collect::<Vec<bool>>());
            let least = all
                .map(|m| cost(&unaries, &pairs, &m))
                .fold(f64::INFINITY, f64::min);
            let least_saved = LEAST_SAVED as f64 / UNIT;
            assert!(found < least + 1.1 * least_saved, "{found} against {least}");
        }
    }

    #[test]
    fn what_gains_nothing_does_not_move() {
        let pair: Pair = (0, 1, [0.0, 1.0, 1.0]);
        let solved = |unaries: &[(f64, f64)]| cut(unaries, &[pair]).solve();
        assert_eq!(solved(&[(2.0, 2.0), (1.0, 1.0)]), [false, false]);
        assert_eq!(solved(&[(2.0, 1.9), (1.0, 1.0)]), [true, true]);
        // No more than costs differ by when they are rounded.
        assert_eq!(solved(&[(2.0, 2.0 - 3.0 / UNIT), (1.0, 1.0)]), [false; 2]);
    }
}
