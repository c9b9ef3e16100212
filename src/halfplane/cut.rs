//! The best of all moves in which cells keep their plane or take a new one: a minimum cut.
//!
//! One expansion of [`super::labelling`]. Costs become integers, so that the cut is exact and the same on every machine; what can be
//! decided without a cut is, and the rest is cut one connected part after the other.

use std::collections::BTreeMap;

use ac_library::{Dsu, MfGraph};

/// Capacities are integers, so that the cut is exact: a millionth of a square metre.
const UNIT: f64 = 1e6;

/// A minimum cut over binary moves: 0 keeps the label, 1 takes the new one.
pub struct Cut {
    /// (cost of keeping, cost of moving) per node.
    unaries: Vec<(f64, f64)>,
    /// (from, to, capacity): paid when `from` keeps and `to` moves.
    arcs: Vec<(usize, usize, f64)>,
}

impl Cut {
    /// No costs yet.
    pub fn new(nodes: usize) -> Self {
        Self {
            unaries: vec![(0.0, 0.0); nodes],
            arcs: Vec::new(),
        }
    }

    /// Costs of one node by itself.
    pub fn unary(&mut self, node: usize, keep: f64, change: f64) {
        self.unaries[node].0 += keep;
        self.unaries[node].1 += change;
    }

    /// Costs of (keep, keep), (keep, move), (move, keep); (move, move) is 0.
    pub fn pair(&mut self, i: usize, j: usize, stay: f64, j_moves: f64, i_moves: f64) {
        // stay = A, j_moves = B, i_moves = C, D = 0. Submodular when A <= B + C; a border
        // that is cheap twice is made as dear as needed.
        let stay = stay.min(j_moves + i_moves);
        self.unaries[i].0 += stay;
        self.unaries[i].1 += i_moves;
        self.unaries[j].1 -= i_moves;
        self.arcs.push((i, j, j_moves + i_moves - stay));
    }

    /// For each node: does it move? Decides what needs no cut first. A tie moves, unless nothing else is gained: a
    /// labelling must not go round in circles.
    pub fn solve(self) -> Vec<bool> {
        let units = |c: f64| (c * UNIT).round() as i64;
        let mut open = OpenNodes {
            gain: (self.unaries.iter())
                .map(|(keep, change)| units(*keep) - units(*change))
                .collect(),
            arcs: (self.arcs.iter())
                .map(|&(i, j, c)| (i, j, units(c)))
                .filter(|a| a.2 > 0)
                .collect(),
            moves: vec![None; self.unaries.len()],
        };
        let gain = open.gain.clone();
        open.decide();
        let (moves, arcs) = open.cut();
        let saved: i64 = gain.iter().zip(&moves).filter(|g| *g.1).map(|g| g.0).sum();
        let torn = arcs.iter().filter(|(i, j, _)| !moves[*i] && moves[*j]);
        if saved > torn.map(|a| a.2).sum() {
            moves
        } else {
            vec![false; moves.len()]
        }
    }
}

/// From, to, capacity in units: paid when `from` keeps and `to` moves.
type Arc = (usize, usize, i64);

/// Which arcs begin or end at each node, in one list.
struct ArcsOfNodes {
    /// The arcs of node i are `arcs[starts[i]..starts[i + 1]]`, ascending.
    starts: Vec<usize>,
    arcs: Vec<usize>,
}

impl ArcsOfNodes {
    fn new(nodes: usize, arcs: &[Arc]) -> Self {
        let mut starts = vec![0; nodes + 1];
        for node in arcs.iter().flat_map(|a| [a.0, a.1]) {
            starts[node + 1] += 1;
        }
        for node in 0..nodes {
            starts[node + 1] += starts[node];
        }
        let (mut next, mut of_nodes) = (starts.clone(), vec![0; 2 * arcs.len()]);
        for (k, arc) in arcs.iter().enumerate() {
            for node in [arc.0, arc.1] {
                of_nodes[next[node]] = k;
                next[node] += 1;
            }
        }
        Self {
            starts,
            arcs: of_nodes,
        }
    }

    fn of(&self, node: usize) -> &[usize] {
        &self.arcs[self.starts[node]..self.starts[node + 1]]
    }
}

/// The nodes of a cut that nothing has decided yet.
struct OpenNodes {
    /// What moving saves in unaries, units.
    gain: Vec<i64>,
    arcs: Vec<Arc>,
    moves: Vec<Option<bool>>,
}

impl OpenNodes {
    /// Fixes every node whose own cost outweighs all its arcs, whatever its neighbours do, charges the
    /// neighbours for it, and goes on with them. Most cells of a plane's region are nothing like the plane:
    /// few are left for the cut, whose result is the same.
    fn decide(&mut self) {
        let n = self.gain.len();
        let arcs_of = ArcsOfNodes::new(n, &self.arcs);
        let (mut saved, mut paid) = (vec![0i64; n], vec![0i64; n]);
        for &(i, j, capacity) in &self.arcs {
            saved[i] += capacity;
            paid[j] += capacity;
        }
        let mut queue: std::collections::VecDeque<usize> = (0..n).collect();
        while let Some(i) = queue.pop_front() {
            if self.moves[i].is_some() {
                continue;
            }
            let moves = if self.gain[i] + saved[i] < 0 {
                false
            } else if self.gain[i] - paid[i] >= 0 {
                true
            } else {
                continue;
            };
            self.moves[i] = Some(moves);
            for &k in arcs_of.of(i) {
                let (from, to, capacity) = self.arcs[k];
                let other = if from == i { to } else { from };
                if self.moves[other].is_some() {
                    continue;
                }
                if from == i {
                    paid[to] -= capacity;
                    self.gain[to] -= if moves { 0 } else { capacity };
                } else {
                    saved[from] -= capacity;
                    self.gain[from] += if moves { capacity } else { 0 };
                }
                queue.push_back(other);
            }
        }
    }

    /// The minimum cut of the undecided nodes, one connected part after the other.
    fn cut(mut self) -> (Vec<bool>, Vec<Arc>) {
        let open: Vec<bool> = self.moves.iter().map(Option::is_none).collect();
        let arcs = || self.arcs.iter().filter(|(i, j, _)| open[*i] && open[*j]);
        let mut connected = Dsu::new(self.gain.len());
        for (i, j, _) in arcs() {
            connected.merge(*i, *j);
        }
        let mut parts: BTreeMap<usize, Part> = BTreeMap::new();
        for i in (0..self.gain.len()).filter(|&i| open[i]) {
            parts.entry(connected.leader(i)).or_default().nodes.push(i);
        }
        for arc in arcs() {
            let part = parts.entry(connected.leader(arc.0)).or_default();
            part.arcs.push(*arc);
        }
        for part in parts.values() {
            for (i, moves) in part.nodes.iter().zip(part.cut(&self.gain)) {
                self.moves[*i] = Some(moves);
            }
        }
        let moves = self.moves.iter().map(|m| *m == Some(true)).collect();
        (moves, self.arcs)
    }
}

/// A connected part of the undecided nodes.
#[derive(Default)]
struct Part {
    /// Ascending.
    nodes: Vec<usize>,
    arcs: Vec<Arc>,
}

impl Part {
    /// For each node: does it move?
    fn cut(&self, gain: &[i64]) -> Vec<bool> {
        let n = self.nodes.len();
        let (source, sink) = (n, n + 1);
        let mut graph = MfGraph::<i64>::new(n + 2);
        // The source side keeps, the sink side moves.
        for (place, &i) in self.nodes.iter().enumerate() {
            if gain[i] < 0 {
                graph.add_edge(source, place, -gain[i]);
            } else if gain[i] > 0 {
                graph.add_edge(place, sink, gain[i]);
            }
        }
        let of = |i: usize| (self.nodes.binary_search(&i)).expect("both ends are in the part");
        for &(i, j, capacity) in &self.arcs {
            graph.add_edge(of(i), of(j), capacity);
        }
        graph.flow(source, sink);
        // Nodes that residual capacity still reaches from the source keep their label.
        graph.min_cut(source)[..n]
            .iter()
            .map(|keeps| !keeps)
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::uniform;

    /// Costs of keeping and moving, and per pair those of staying, of the second moving and of the first moving.
    type Pair = (usize, usize, [f64; 3]);

    fn cut(unaries: &[(f64, f64)], pairs: &[Pair]) -> Cut {
        let mut cut = Cut::new(unaries.len());
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
            assert!(found < least + 1e-4, "{found} against {least}");
        }
    }

    #[test]
    fn what_gains_nothing_does_not_move() {
        let pair: Pair = (0, 1, [0.0, 1.0, 1.0]);
        let solved = |unaries: &[(f64, f64)]| cut(unaries, &[pair]).solve();
        assert_eq!(solved(&[(2.0, 2.0), (1.0, 1.0)]), [false, false]);
        assert_eq!(solved(&[(2.0, 1.9), (1.0, 1.0)]), [true, true]);
    }
}
