//! Which plane, if any, covers each cell of the plan (B99 4.3: delineation, verification and conflicts).
//!
//! B99 closes an outline per plane, verifies it over the images and resolves conflicts between overlapping
//! faces one pair at a time by S(P) = area x share of real lines. Here the same evidence competes at
//! once, cell by cell, as the least of
//!
//! ```text
//! E(l) = sum_cells D(cell, l)  +  sum_edges length x V(edge, l, l')
//! ```
//!
//! D is the mismatch of the images under the plane against that of "no plane" (0), weighted by what the
//! texture can tell, minus what accepted half-planes at the cell's borders earn. V is small where a
//! reconstructed line or the intersection of the two planes supports the border, so outlines follow
//! real lines (tau_real) and area counts as in S(P). The minimum is found by alpha-expansion
//! (Boykov, Veksler, Zabih 2001), each expansion a minimum cut.

use std::collections::BTreeMap;

use ac_library::{Dsu, MfGraph};

/// No plane covers the cell.
pub const NO_PLANE: u32 = u32::MAX;

/// What different labels on both sides of a border cost.
pub trait Borders {
    /// Cost of `left` and `right`, which differ, on the first and second cell of an edge.
    fn cost(&self, edge: usize, left: u32, right: u32) -> f64;

    /// The most that any two labels can cost there.
    fn most(&self, edge: usize) -> f64;
}

/// The energy over cells and planes.
#[derive(Clone, Debug)]
pub struct Energy<B> {
    /// Per cell: (plane, D) for the planes that may cover it, ascending by plane. "No plane" costs 0.
    pub unary: Vec<Vec<(u32, f64)>>,
    /// Pairs of neighbouring cells.
    pub edges: Vec<[usize; 2]>,
    /// The costs of the edges.
    pub borders: B,
}

impl<B: Borders> Energy<B> {
    fn border(&self, edge: usize, left: u32, right: u32) -> f64 {
        if left == right {
            return 0.0;
        }
        self.borders.cost(edge, left, right)
    }

    fn unary(&self, cell: usize, label: u32) -> Option<f64> {
        if label == NO_PLANE {
            return Some(0.0);
        }
        self.unary[cell]
            .binary_search_by_key(&label, |u| u.0)
            .ok()
            .map(|i| self.unary[cell][i].1)
    }

    #[cfg(test)]
    /// The energy of a labelling; infinite when a cell has a plane that may not cover it.
    fn of(&self, labels: &[u32]) -> f64 {
        let data: f64 = labels
            .iter()
            .enumerate()
            .map(|(c, &l)| self.unary(c, l).unwrap_or(f64::INFINITY))
            .sum();
        let borders: f64 = self
            .edges
            .iter()
            .enumerate()
            .map(|(e, cells)| self.border(e, labels[cells[0]], labels[cells[1]]))
            .sum();
        data + borders
    }

    /// A labelling that no single expansion improves, starting from `labels`.
    pub fn minimise(&self, planes: u32, mut labels: Vec<u32>) -> Vec<u32> {
        let graph = CellGraph::new(self, planes);
        let mut clock = Clock::new(self.unary.len(), planes);
        const ROUNDS: usize = 8;
        for _ in 0..ROUNDS {
            let start = clock.now;
            for plane in (0..planes).chain([NO_PLANE]) {
                // Nothing changed where this plane may lie since it was last tried: it would fail again.
                if clock.worth_trying(plane, &graph) {
                    let changed = self.expand(plane, &graph, &mut labels);
                    clock.tried(plane, &changed);
                }
            }
            if clock.changed_since(start) {
                continue;
            }
            break;
        }
        labels
    }

    /// The best move in which cells may change to `alpha`; returns those that do.
    fn expand(&self, alpha: u32, graph: &CellGraph, labels: &mut [u32]) -> Vec<usize> {
        let movable: Vec<usize> = (graph.cells_of(alpha).iter().copied())
            .filter(|&c| labels[c] != alpha && self.may_gain(c, alpha, graph, labels))
            .collect();
        // Ascending, so that a cell's node is found by bisection.
        let node = |cell: usize| movable.binary_search(&cell).ok();
        let mut cut = Cut::new(movable.len());
        for (n, &c) in movable.iter().enumerate() {
            let keep = self.unary(c, labels[c]).unwrap_or(BLOCKED);
            let change = self.unary(c, alpha).unwrap_or(BLOCKED);
            cut.unary(n, keep, change);
            for &e in &graph.edges_of_cell[c] {
                let [i, j] = self.edges[e];
                let (li, lj) = (labels[i], labels[j]);
                let stay = self.border(e, li, lj);
                match node(if c == i { j } else { i }) {
                    // Both may move: handle the edge once, from its first cell.
                    Some(other) if c == i => {
                        let (j_moves, i_moves) =
                            (self.border(e, li, alpha), self.border(e, alpha, lj));
                        cut.pair(n, other, stay, j_moves, i_moves);
                    }
                    Some(_) => {}
                    None if c == i => cut.unary(n, stay, self.border(e, alpha, lj)),
                    None => cut.unary(n, stay, self.border(e, li, alpha)),
                }
            }
        }
        let changed: Vec<usize> = movable
            .iter()
            .zip(cut.solve())
            .filter(|(_, moves)| *moves)
            .map(|(&c, _)| c)
            .collect();
        changed.iter().for_each(|&c| labels[c] = alpha);
        changed
    }

    /// Could the cell gain by `alpha` with all its borders? Most cells of a plane's region are nothing like the
    /// plane and could not, whatever their neighbours do.
    fn may_gain(&self, cell: usize, alpha: u32, graph: &CellGraph, labels: &[u32]) -> bool {
        let keep = self.unary(cell, labels[cell]).unwrap_or(BLOCKED);
        let change = self.unary(cell, alpha).unwrap_or(BLOCKED);
        keep - change + graph.most_by_borders[cell] >= 0.0
    }
}

/// Which cells a plane may cover, and which edges a cell has.
struct CellGraph {
    cells_of_plane: Vec<Vec<usize>>,
    /// The planes' cells and the cells beside them: where a change concerns the plane.
    surroundings_of_plane: Vec<Vec<usize>>,
    all: Vec<usize>,
    edges_of_cell: Vec<Vec<usize>>,
    /// The most that a cell's borders can cost.
    most_by_borders: Vec<f64>,
}

impl CellGraph {
    fn new<B: Borders>(energy: &Energy<B>, planes: u32) -> Self {
        let mut cells_of_plane = vec![Vec::new(); planes as usize];
        for (cell, candidates) in energy.unary.iter().enumerate() {
            for (plane, _) in candidates {
                cells_of_plane[*plane as usize].push(cell);
            }
        }
        let mut edges_of_cell = vec![Vec::new(); energy.unary.len()];
        for (i, e) in energy.edges.iter().enumerate() {
            edges_of_cell[e[0]].push(i);
            edges_of_cell[e[1]].push(i);
        }
        let surroundings_of_plane = cells_of_plane
            .iter()
            .map(|cells| {
                let beside = cells
                    .iter()
                    .flat_map(|&c| &edges_of_cell[c])
                    .flat_map(|&e| energy.edges[e]);
                let mut around: Vec<usize> = cells.iter().copied().chain(beside).collect();
                around.sort_unstable();
                around.dedup();
                around
            })
            .collect();
        Self {
            cells_of_plane,
            surroundings_of_plane,
            all: (0..energy.unary.len()).collect(),
            most_by_borders: (edges_of_cell.iter())
                .map(|edges| edges.iter().map(|&e| energy.borders.most(e)).sum())
                .collect(),
            edges_of_cell,
        }
    }

    fn cells_of(&self, plane: u32) -> &[usize] {
        self.cells_of_plane.get(plane as usize).unwrap_or(&self.all)
    }

    fn surroundings_of(&self, plane: u32) -> &[usize] {
        self.surroundings_of_plane
            .get(plane as usize)
            .unwrap_or(&self.all)
    }
}

/// When each cell last changed its label and each plane was last tried, in tries.
struct Clock {
    now: u32,
    changed: Vec<u32>,
    tried: Vec<u32>,
}

impl Clock {
    fn new(cells: usize, planes: u32) -> Self {
        Self {
            now: 1,
            changed: vec![1; cells],
            tried: vec![0; planes as usize + 1],
        }
    }

    fn slot(&self, plane: u32) -> usize {
        (plane as usize).min(self.tried.len() - 1)
    }

    fn worth_trying(&self, plane: u32, graph: &CellGraph) -> bool {
        let last = self.tried[self.slot(plane)];
        graph
            .surroundings_of(plane)
            .iter()
            .any(|&c| self.changed[c] > last)
    }

    fn tried(&mut self, plane: u32, changed: &[usize]) {
        // The plane's own changes do not make it worth trying again.
        self.now += 1;
        changed.iter().for_each(|&c| self.changed[c] = self.now);
        let slot = self.slot(plane);
        self.tried[slot] = self.now;
    }

    fn changed_since(&self, time: u32) -> bool {
        self.changed.iter().any(|&c| c > time)
    }
}

/// More than any sum of real costs.
const BLOCKED: f64 = 1e6;
/// Capacities are integers, so that the cut is exact: a millionth of a square metre.
const UNIT: f64 = 1e6;

/// A minimum cut over binary moves: 0 keeps the label, 1 takes the new one.
struct Cut {
    /// (cost of keeping, cost of moving) per node.
    unaries: Vec<(f64, f64)>,
    /// (from, to, capacity): paid when `from` keeps and `to` moves.
    arcs: Vec<(usize, usize, f64)>,
}

impl Cut {
    fn new(nodes: usize) -> Self {
        Self {
            unaries: vec![(0.0, 0.0); nodes],
            arcs: Vec::new(),
        }
    }

    fn unary(&mut self, node: usize, keep: f64, change: f64) {
        self.unaries[node].0 += keep;
        self.unaries[node].1 += change;
    }

    /// Costs of (keep, keep), (keep, move), (move, keep); (move, move) is 0.
    fn pair(&mut self, i: usize, j: usize, stay: f64, j_moves: f64, i_moves: f64) {
        // stay = A, j_moves = B, i_moves = C, D = 0. Submodular when A <= B + C; a border
        // that is cheap twice is made as dear as needed.
        let stay = stay.min(j_moves + i_moves);
        self.unaries[i].0 += stay;
        self.unaries[i].1 += i_moves;
        self.unaries[j].1 -= i_moves;
        self.arcs.push((i, j, j_moves + i_moves - stay));
    }

    /// For each node: does it move? Decides what needs no cut first; a tie moves.
    fn solve(self) -> Vec<bool> {
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
        open.decide();
        open.cut()
    }
}

/// The nodes of a cut that nothing has decided yet.
struct OpenNodes {
    /// What moving saves in unaries, units.
    gain: Vec<i64>,
    /// (from, to, capacity): paid when `from` keeps and `to` moves.
    arcs: Vec<(usize, usize, i64)>,
    moves: Vec<Option<bool>>,
}

impl OpenNodes {
    /// Fixes every node whose own cost outweighs all its arcs, whatever its neighbours do, charges the
    /// neighbours for it, and goes on with them. Most cells of a plane's region are nothing like the plane:
    /// few are left for the cut, whose result is the same.
    fn decide(&mut self) {
        let n = self.gain.len();
        let mut arcs_of = vec![Vec::new(); n];
        let (mut saved, mut paid) = (vec![0i64; n], vec![0i64; n]);
        for (k, &(i, j, capacity)) in self.arcs.iter().enumerate() {
            arcs_of[i].push(k);
            arcs_of[j].push(k);
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
            for &k in &arcs_of[i] {
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
    fn cut(mut self) -> Vec<bool> {
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
        self.moves.iter().map(|m| *m == Some(true)).collect()
    }
}

/// A connected part of the undecided nodes.
#[derive(Default)]
struct Part {
    /// Ascending.
    nodes: Vec<usize>,
    /// As in [`OpenNodes`].
    arcs: Vec<(usize, usize, i64)>,
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

    /// Per edge: the cost when nothing supports it, and of pairs of labels that something supports.
    struct Table(Vec<Row>);

    type Row = (f64, Vec<(u32, u32, f64)>);

    impl Borders for Table {
        fn cost(&self, edge: usize, left: u32, right: u32) -> f64 {
            let (unsupported, supported) = &self.0[edge];
            (supported.iter())
                .find(|s| (s.0, s.1) == (left, right))
                .map_or(*unsupported, |s| s.2)
        }

        fn most(&self, edge: usize) -> f64 {
            let (unsupported, supported) = &self.0[edge];
            supported.iter().fold(*unsupported, |most, s| most.max(s.2))
        }
    }

    /// A row of cells, each beside the next.
    fn row(unary: Vec<Vec<(u32, f64)>>, borders: Vec<Row>) -> Energy<Table> {
        Energy {
            edges: (1..unary.len()).map(|i| [i - 1, i]).collect(),
            unary,
            borders: Table(borders),
        }
    }

    fn from_nothing(energy: &Energy<Table>) -> Vec<u32> {
        energy.minimise(2, vec![NO_PLANE; energy.unary.len()])
    }

    #[test]
    fn an_undecided_cell_follows_the_cheaper_border() {
        // Cells 0 - 1 - 2; plane 0 fits cell 0, plane 1 fits cell 2, cell 1 fits both equally; only the border
        // between 1 and 2 is supported.
        let energy = row(
            vec![
                vec![(0, -5.0), (1, 5.0)],
                vec![(0, -1.0), (1, -1.0)],
                vec![(0, 5.0), (1, -5.0)],
            ],
            vec![(1.0, vec![]), (1.0, vec![(0, 1, 0.1)])],
        );
        assert_eq!(from_nothing(&energy), [0, 0, 1]);
    }

    #[test]
    fn expansion_reaches_the_global_minimum_of_small_chains() {
        // All labellings of five cells and three labels, compared.
        for seed in 0..40u32 {
            let mut state = seed.wrapping_mul(2_654_435_761).wrapping_add(12345);
            let mut next = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(state >> 16) / 65536.0
            };
            let unary = (0..5)
                .map(|_| (0..2).map(|p| (p, 2.0 * next() - 1.0)).collect())
                .collect();
            let borders = (0..4).map(|_| (0.2 + 0.5 * next(), vec![])).collect();
            let energy = row(unary, borders);
            let best = (0..243)
                .map(|k: u32| {
                    let labels: Vec<u32> = (0..5)
                        .map(|i| [0, 1, NO_PLANE][(k / 3u32.pow(i) % 3) as usize])
                        .collect();
                    energy.of(&labels)
                })
                .fold(f64::INFINITY, f64::min);
            let found = energy.of(&from_nothing(&energy));
            assert!(found <= best + 0.05, "seed {seed}: {found} against {best}");
        }
    }

    #[test]
    fn a_plane_never_covers_a_cell_that_it_may_not() {
        let energy = row(
            vec![vec![(0, -5.0)], vec![(1, 0.5)], vec![(0, -5.0)]],
            vec![(3.0, vec![]), (3.0, vec![])],
        );
        assert!(energy.of(&from_nothing(&energy)).is_finite());
    }
}
