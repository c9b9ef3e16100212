//! The labelling of least energy, by alpha-expansion (Boykov, Veksler, Zabih 2001).

use std::sync::atomic::{AtomicU32, Ordering};

use super::cut::MinimumCut;
use super::energy::{AnyEnergy, Energy, NO_PLANE, PairwiseCosts};
use super::graph::{CellGraph, in_order_of_neighbours};

/// How far from a change, in cells, others may move with it. Assumption: what needs more cells to
/// pay than those around a change did not pay before it. Measured: 4, 10 and all give labellings
/// that score alike; all of them take ten times as long.
const RINGS: usize = 4;

/// A labelling on its way to the least energy. It records which expansions were tried, so that
/// after a small change only the planes and cells around it are tried again.
pub(crate) struct Labelling {
    borders: Box<dyn PairwiseCosts>,
    graph: CellGraph,
    /// The cell in here of each cell of the energy.
    cells: Vec<u32>,
    clock: ExpansionHistory,
    labels: Vec<u32>,
    /// What each cell's label costs there.
    costs: Vec<f64>,
    /// The node of each cell in a cut that is being made, or [`NO_NODE`]; cuts that are made at a
    /// time have no cell in common.
    nodes: Vec<AtomicU32>,
    /// The place of each cell among the candidates of the plane that was expanded there last.
    places: Vec<AtomicU32>,
}

/// The cell is in no cut.
const NO_NODE: u32 = u32::MAX;
/// No plane was expanded there.
const NO_PLACE: u32 = u32::MAX;

/// A cell that may change to the plane of an expansion.
struct Movable {
    cell: usize,
    /// What that plane costs there.
    change: f64,
}

impl Labelling {
    /// No plane covers any cell; `planes` is the number of planes.
    pub(crate) fn new<B: PairwiseCosts + 'static>(energy: Energy<B>, planes: u32) -> Self {
        Self::of(energy.of_any_borders(), planes)
    }

    fn of(energy: AnyEnergy, planes: u32) -> Self {
        let (energy, cells) = in_order_of_neighbours(energy);
        let none = |unset: u32| cells.iter().map(|_| AtomicU32::new(unset)).collect();
        Self {
            graph: CellGraph::new(&energy, planes),
            clock: ExpansionHistory::new(cells.len(), planes),
            labels: vec![NO_PLANE; cells.len()],
            costs: vec![0.0; cells.len()],
            nodes: none(NO_NODE),
            places: none(NO_PLACE),
            borders: energy.borders,
            cells,
        }
    }

    /// The plane of each cell, or [`NO_PLANE`].
    pub(crate) fn labels(&self) -> Vec<u32> {
        let of_cells = self.cells.iter().map(|&c| self.labels[c as usize]);
        of_cells.collect()
    }

    /// Goes on until no single expansion around a change improves: plane by plane, in their order.
    pub(crate) fn minimise(&mut self) {
        // Every round that goes on lowers the energy; this bounds the time. Assumption.
        const ROUNDS: usize = 8;
        for _ in 0..ROUNDS {
            let start = self.clock.now;
            for planes in 0..self.graph.independent_planes.len() {
                let planes = self.graph.independent_planes[planes].clone();
                self.expand_independent(&planes, start);
            }
            let last = start + 1 + self.graph.planes() as u32;
            let changed = self.expand(NO_PLANE);
            self.clock.tried(NO_PLANE, &changed, last);
            if !self.clock.changed_since(start) {
                break;
            }
        }
    }

    /// Expands planes that have no cell in common: it does not matter in which order.
    fn expand_independent(&mut self, planes: &[u32], start: u32) {
        let moves = crate::base::execution::map(planes, |_, &plane| self.expansion(plane));
        for (&plane, moves) in planes.iter().zip(moves) {
            let changed = self.apply(plane, moves);
            self.clock.tried(plane, &changed, start + 1 + plane);
        }
    }

    /// Sets the labels to others.
    pub(crate) fn relabel(&mut self, labels: Vec<u32>) {
        let mut changed = Vec::new();
        for (&cell, label) in self.cells.iter().zip(labels) {
            let cell = cell as usize;
            if self.labels[cell] != label {
                self.labels[cell] = label;
                self.costs[cell] = self.graph.candidates.cost(cell, label);
                changed.push(cell);
            }
        }
        self.clock.changed(&changed);
    }

    /// The plane may no longer cover the cells; no plane does for now.
    pub(crate) fn exclude(&mut self, plane: u32, cells: &[usize]) {
        let cells: Vec<usize> = cells.iter().map(|&c| self.cells[c] as usize).collect();
        for &cell in &cells {
            self.graph.candidates.exclude(cell, plane);
            self.labels[cell] = NO_PLANE;
            self.costs[cell] = 0.0;
        }
        self.clock.changed(&cells);
    }

    /// Makes the best move to `alpha`; returns the cells that change.
    fn expand(&mut self, alpha: u32) -> Vec<usize> {
        let moves = self.expansion(alpha);
        self.apply(alpha, moves)
    }

    /// The best move in which cells around what is new to `alpha` may change to it: those that do.
    fn expansion(&self, alpha: u32) -> Vec<Movable> {
        let mut movable = self.movable_around_news(alpha);
        if movable.is_empty() {
            return movable;
        }
        let mut moves = self.cut(alpha, &movable).solve().into_iter();
        for &Movable { cell, .. } in &movable {
            self.nodes[cell].store(NO_NODE, Ordering::Relaxed);
        }
        movable.retain(|_| moves.next() == Some(true));
        movable
    }

    fn apply(&mut self, alpha: u32, moves: Vec<Movable>) -> Vec<usize> {
        let mut changed = Vec::with_capacity(moves.len());
        for Movable { cell, change } in moves {
            self.labels[cell] = alpha;
            self.costs[cell] = change;
            changed.push(cell);
        }
        changed
    }

    /// The cells that may change to `alpha`, as nodes in the order of the list: those that changed
    /// themselves since it was last tried or lie beside one, and what is connected with them by
    /// such cells, some rings far.
    fn movable_around_news(&self, alpha: u32) -> Vec<Movable> {
        let graph = &self.graph;
        let surroundings = graph.surroundings_of(alpha).iter();
        let is_news = |cell: &&u32| self.clock.is_news(**cell, alpha);
        let mut news = surroundings.filter(is_news).peekable();
        if news.peek().is_none() {
            return Vec::new();
        }
        for (place, cell) in graph.paying(alpha) {
            self.places[cell as usize].store(place as u32, Ordering::Relaxed);
        }
        let candidates = graph.candidates.of(alpha);
        let cost = |cell: usize| {
            let place = self.places[cell].load(Ordering::Relaxed) as usize;
            let is_candidate = candidates.contains(&place);
            is_candidate.then(|| graph.candidates.costs[place])
        };
        let change = |cell: usize| {
            if self.labels[cell] == alpha {
                return None;
            }
            let change = if alpha == NO_PLANE { 0.0 } else { cost(cell)? };
            let bound = graph.border_bound[cell];
            // Most cells of a plane's region are nothing like the plane and could not, whatever
            // their neighbours do; where it costs more than all borders, no plane is always better.
            (self.costs[cell] - change + bound >= 0.0 && change <= bound).then_some(change)
        };
        let mut movable = Vec::new();
        let reach = |cell: usize, movable: &mut Vec<Movable>| {
            if self.node(cell).is_none()
                && let Some(change) = change(cell)
            {
                self.nodes[cell].store(movable.len() as u32, Ordering::Relaxed);
                movable.push(Movable { cell, change });
            }
        };
        for &cell in news {
            reach(cell as usize, &mut movable);
            let beside = graph.beside(cell as usize).iter();
            beside.for_each(|b| reach(b.cell as usize, &mut movable));
        }
        let mut outermost = 0..movable.len();
        for _ in 0..RINGS {
            let end = outermost.end;
            for at in outermost {
                let beside = graph.beside(movable[at].cell).iter();
                beside.for_each(|b| reach(b.cell as usize, &mut movable));
            }
            outermost = end..movable.len();
        }
        movable
    }

    /// The costs of moves of some cells to `alpha`, where all others stay.
    fn cut(&self, alpha: u32, movable: &[Movable]) -> MinimumCut {
        let mut cut = MinimumCut::new(movable.len());
        for (n, &Movable { cell, change }) in movable.iter().enumerate() {
            cut.unary(n, self.costs[cell], change);
            for beside in self.graph.beside(cell) {
                let mut labels = [cell, beside.cell as usize].map(|c| self.labels[c]);
                if !beside.is_second {
                    labels.reverse();
                }
                let [left, right] = labels;
                let between = |left, right| self.borders.between(beside.edge as usize, left, right);
                let stay = || between(left, right);
                // What a border costs depends on which side of it a plane lies.
                let first_moves = || between(alpha, right);
                let second_moves = || between(left, alpha);
                match self.node(beside.cell as usize) {
                    // Both may move: handle the edge once, from its first cell.
                    Some(other) if beside.is_second => {
                        cut.pair(n, other as usize, stay(), second_moves(), first_moves());
                    }
                    Some(_) => {}
                    None if beside.is_second => cut.unary(n, stay(), first_moves()),
                    None => cut.unary(n, stay(), second_moves()),
                }
            }
        }
        cut
    }

    /// The node of a cell in the cut that is being made.
    fn node(&self, cell: usize) -> Option<u32> {
        let node = self.nodes[cell].load(Ordering::Relaxed);
        (node != NO_NODE).then_some(node)
    }
}

/// When each cell last changed its label and each plane was last tried, in tries.
struct ExpansionHistory {
    now: u32,
    changed: Vec<u32>,
    tried: Vec<u32>,
}

impl ExpansionHistory {
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

    /// Did the cell change since the plane was last tried?
    fn is_news(&self, cell: u32, plane: u32) -> bool {
        self.changed[cell as usize] > self.tried[self.slot(plane)]
    }

    fn changed(&mut self, cells: &[usize]) {
        self.now += 1;
        cells.iter().for_each(|&c| self.changed[c] = self.now);
    }

    /// The plane was tried at `time`, as the one after all before it in the list.
    fn tried(&mut self, plane: u32, changed: &[usize], time: u32) {
        self.now = self.now.max(time);
        changed.iter().for_each(|&c| self.changed[c] = time);
        // The plane's own changes are no reason to try it again.
        let slot = self.slot(plane);
        self.tried[slot] = time;
    }

    fn changed_since(&self, time: u32) -> bool {
        self.changed.iter().any(|&c| c > time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::testing::uniform;

    /// Per edge: the cost when nothing supports it, and of pairs of labels that something supports.
    #[derive(Clone)]
    struct Table(Vec<Row>);

    type Row = (f64, Vec<(u32, u32, f64)>);

    impl PairwiseCosts for Table {
        fn cost(&self, edge: usize, left: u32, right: u32) -> f64 {
            let (unsupported, supported) = &self.0[edge];
            (supported.iter())
                .find(|s| [(s.0, s.1), (s.1, s.0)].contains(&(left, right)))
                .map_or(*unsupported, |s| s.2)
        }

        fn reorder(&mut self, order: &[usize]) {
            self.0 = order.iter().map(|&edge| self.0[edge].clone()).collect();
        }

        fn upper_bound(&self, edge: usize) -> f64 {
            let (unsupported, supported) = &self.0[edge];
            supported.iter().fold(*unsupported, |most, s| most.max(s.2))
        }
    }

    /// What a border costs may depend on which of two planes lies to its left.
    #[derive(Clone)]
    struct Directed(Vec<[[f64; 4]; 4]>);

    impl PairwiseCosts for Directed {
        fn cost(&self, edge: usize, left: u32, right: u32) -> f64 {
            let [left, right] = [left, right].map(|label| label.min(3) as usize);
            self.0[edge][left][right]
        }

        fn reorder(&mut self, order: &[usize]) {
            self.0 = order.iter().map(|&edge| self.0[edge]).collect();
        }

        fn upper_bound(&self, _: usize) -> f64 {
            1.0
        }
    }

    #[test]
    fn no_expansion_raises_the_energy_where_borders_have_a_left_and_a_right() {
        for seed in 1..60u32 {
            let mut next = uniform(seed.wrapping_mul(2_654_435_761));
            let unary = (0..16)
                .map(|_| (0..3).map(|p| (p, 2.0 * next() - 1.0)).collect())
                .collect();
            let borders = (0..15).map(|_| [[0.0; 4]; 4].map(|row| row.map(|_| next())));
            let energy = Energy {
                unary,
                edges: (1..16).map(|i| [i - 1, i]).collect(),
                borders: Directed(borders.collect()),
            };
            let mut labelling = Labelling::new(energy.clone(), 3);
            let mut before = energy.of(&labelling.labels());
            for plane in [0, 1, 2, NO_PLANE, 0, 1, 2, NO_PLANE] {
                let (changed, time) = (labelling.expand(plane), labelling.clock.now + 1);
                labelling.clock.tried(plane, &changed, time);
                let after = energy.of(&labelling.labels());
                assert!(after < before + 1e-4, "seed {seed}: {before} to {after}");
                before = after;
            }
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
        let mut labelling = Labelling::new(energy.clone(), 2);
        labelling.minimise();
        labelling.labels()
    }

    #[test]
    fn an_undecided_cell_follows_the_cheaper_border() {
        // Cells 0 - 1 - 2; plane 0 fits cell 0, plane 1 fits cell 2, cell 1 fits both equally; only
        // the border between 1 and 2 is supported.
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
            let mut next = uniform(seed.wrapping_mul(2_654_435_761).wrapping_add(12345));
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
    fn what_is_not_tried_again_would_not_have_helped() {
        for seed in 1..40u32 {
            let mut next = uniform(seed.wrapping_mul(2_654_435_761));
            let unary = (0..12)
                .map(|_| (0..4).map(|p| (p, 2.0 * next() - 1.2)).collect())
                .collect();
            let borders = (0..11).map(|_| (0.1 + 0.3 * next(), vec![])).collect();
            let energy: Energy<Table> = row(unary, borders);
            let mut labelling = Labelling::new(energy.clone(), 4);
            labelling.minimise();
            let labels = labelling.labels();
            let excluded = labels[6];
            let its = |c: &usize| labels[*c] == excluded;
            let cells: Vec<usize> = (0..12).filter(its).collect();
            labelling.exclude(excluded, &cells);
            labelling.minimise();
            let found = energy.of(&labelling.labels());
            labelling.clock = ExpansionHistory::new(12, 4);
            labelling.minimise();
            assert_eq!(energy.of(&labelling.labels()), found, "seed {seed}");
        }
    }

    #[test]
    fn the_order_of_cells_and_edges_does_not_matter() {
        const CELLS: usize = 30;
        for seed in 1..40u32 {
            let mut next = uniform(seed.wrapping_mul(2_654_435_761));
            let mut draw = |below: usize| (next() * below as f64) as usize;
            // By place: a row, and pairs across it, so that not all are one behind the other.
            let row = (1..CELLS).map(|i| [i - 1, i]);
            let across = (0..CELLS).map(|i| [i, (i + 2 + i * seed as usize % 5) % CELLS]);
            let edges: Vec<[usize; 2]> = row.chain(across).collect();
            let mut shuffled = |count: usize| {
                let mut order: Vec<usize> = (0..count).collect();
                (1..count).for_each(|i| order.swap(i, draw(i + 1)));
                order
            };
            let (place_of, edge_of) = (shuffled(CELLS), shuffled(edges.len()));
            let unary = |_| (0..4).map(|p| (p, 2.0 * next() - 1.2)).collect();
            let unary: Vec<Vec<(u32, f64)>> = (0..CELLS).map(unary).collect();
            let borders = edges
                .iter()
                .map(|_| [[0.0; 4]; 4].map(|row| row.map(|_| 0.4 * next())));
            let borders: Vec<[[f64; 4]; 4]> = borders.collect();
            let other = Energy {
                unary: place_of.iter().map(|&place| unary[place].clone()).collect(),
                edges: (edge_of.iter())
                    .map(|&e| edges[e].map(|p| place_of.iter().position(|q| *q == p).unwrap()))
                    .collect(),
                borders: Directed(edge_of.iter().map(|&e| borders[e]).collect()),
            };
            let energy = Energy {
                unary,
                edges,
                borders: Directed(borders),
            };
            let mut labellings = [energy, other].map(|energy| Labelling::new(energy, 4));
            let compare = |[a, b]: &[Labelling; 2], part: &str| {
                let (a, b) = (a.labels(), b.labels());
                let a: Vec<u32> = place_of.iter().map(|&place| a[place]).collect();
                assert_eq!(a, b, "{part}, seed {seed}");
                b
            };
            labellings.iter_mut().for_each(Labelling::minimise);
            let found = compare(&labellings, "minimised");
            // By cell of the second energy.
            let its: Vec<usize> = (0..CELLS).filter(|&c| found[c] == found[6]).collect();
            labellings[0].exclude(
                found[6],
                &its.iter().map(|&c| place_of[c]).collect::<Vec<_>>(),
            );
            labellings[1].exclude(found[6], &its);
            compare(&labellings, "excluded");
            labellings.iter_mut().for_each(Labelling::minimise);
            let found_again = compare(&labellings, "minimised again");
            let is_back = |&c: &usize| found[c] != NO_PLANE && found_again[c] == found[c];
            assert!(!its.iter().any(is_back), "seed {seed}");
        }
    }

    #[test]
    fn planes_of_a_group_have_no_cell_in_common_and_keep_their_order_elsewhere() {
        let near = |cell: usize, plane: u32| cell.abs_diff(3 * plane as usize % 20) < 3;
        let unary = (0..22).map(|c| (0..20).filter(|&p| near(c, p)).map(|p| (p, -1.0)).collect());
        let energy = row(unary.collect(), vec![(1.0, vec![]); 21]);
        let graph = CellGraph::new(&energy.of_any_borders(), 20);
        let groups = &graph.independent_planes;
        assert!(groups.len() < 20);
        let mut group_of = [usize::MAX; 20];
        for (i, group) in groups.iter().enumerate() {
            group.iter().for_each(|&p| group_of[p as usize] = i);
        }
        for later in 0..20 {
            let cells = graph.surroundings_of(later);
            for earlier in 0..later {
                let is_shared = cells
                    .iter()
                    .any(|c| graph.surroundings_of(earlier).contains(c));
                let in_order = group_of[earlier as usize] < group_of[later as usize];
                assert!(!is_shared || in_order, "{earlier} and {later}");
            }
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
