//! The labelling of least energy, by alpha-expansion (Boykov, Veksler, Zabih 2001).

use super::cut::MinimumCut;
use super::energy::{Energy, NO_PLANE, PairwiseCosts};

/// A labelling on its way to the least energy. It records which expansions were tried, so that
/// after a small change only the planes around it are tried again.
pub(crate) struct Labelling<B> {
    energy: Energy<B>,
    graph: CellGraph,
    clock: ExpansionHistory,
    labels: Vec<u32>,
    /// What each cell's label costs there.
    costs: Vec<f64>,
    /// The node of each cell in the cut that is being made; none between cuts.
    nodes: Vec<Option<usize>>,
}

impl<B: PairwiseCosts> Labelling<B> {
    /// No plane covers any cell; `planes` is the number of planes.
    pub(crate) fn new(energy: Energy<B>, planes: u32) -> Self {
        let cells = energy.unary.len();
        Self {
            graph: CellGraph::new(&energy, planes),
            clock: ExpansionHistory::new(cells, planes),
            labels: vec![NO_PLANE; cells],
            costs: vec![0.0; cells],
            nodes: vec![None; cells],
            energy,
        }
    }

    /// The plane of each cell, or [`NO_PLANE`].
    pub(crate) fn labels(&self) -> &[u32] {
        &self.labels
    }

    /// Goes on until no single expansion improves.
    pub(crate) fn minimise(&mut self) {
        const ROUNDS: usize = 8;
        let planes = self.graph.cells_of_plane.len() as u32;
        for _ in 0..ROUNDS {
            let start = self.clock.now;
            for plane in (0..planes).chain([NO_PLANE]) {
                // Nothing changed where this plane may lie since it was last tried: it would fail
                // again.
                if self.clock.may_improve(plane, &self.graph) {
                    let changed = self.expand(plane);
                    self.clock.tried(plane, &changed);
                }
            }
            if !self.clock.changed_since(start) {
                break;
            }
        }
    }

    /// Sets the labels to others.
    pub(crate) fn relabel(&mut self, labels: Vec<u32>) {
        let differs = |c: &usize| labels[*c] != self.labels[*c];
        let changed: Vec<usize> = (0..labels.len()).filter(differs).collect();
        self.clock.changed(&changed);
        self.labels = labels;
        for cell in changed {
            let cost = self.energy.unary(cell, self.labels[cell]);
            self.costs[cell] = cost.unwrap_or(BLOCKED);
        }
    }

    /// The plane may no longer cover the cells; no plane does for now.
    pub(crate) fn exclude(&mut self, plane: u32, cells: &[usize]) {
        for &cell in cells {
            self.energy.unary[cell].retain(|u| u.0 != plane);
            self.graph.block(cell, plane);
            self.labels[cell] = NO_PLANE;
            self.costs[cell] = 0.0;
        }
        self.clock.changed(cells);
    }

    /// The best move in which cells may change to `alpha`; returns those that do.
    fn expand(&mut self, alpha: u32) -> Vec<usize> {
        let (energy, graph, labels) = (&self.energy, &self.graph, &self.labels);
        let may_gain = |c: usize, change: f64| {
            // Most cells of a plane's region are nothing like the plane and could not, whatever
            // their neighbours do.
            labels[c] != alpha && self.costs[c] - change + graph.border_bound[c] >= 0.0
        };
        let movable: Vec<(usize, f64)> = (graph.cells_of(alpha).iter().copied())
            .filter(|&(c, change)| may_gain(c, change))
            .collect();
        let nodes = &mut self.nodes;
        (movable.iter().enumerate()).for_each(|(n, &(c, _))| nodes[c] = Some(n));
        let mut cut = MinimumCut::new(movable.len());
        for (n, &(c, change)) in movable.iter().enumerate() {
            cut.unary(n, self.costs[c], change);
            for &e in &graph.edges_of_cell[c] {
                let [i, j] = energy.edges[e];
                let (li, lj) = (labels[i], labels[j]);
                let stay = || energy.border(e, li, lj);
                match nodes[if c == i { j } else { i }] {
                    // Both may move: handle the edge once, from its first cell.
                    Some(other) if c == i => {
                        let j_moves = energy.border(e, li, alpha);
                        let i_moves = match li == lj {
                            true => j_moves,
                            false => energy.border(e, alpha, lj),
                        };
                        cut.pair(n, other, stay(), j_moves, i_moves);
                    }
                    Some(_) => {}
                    None if c == i => cut.unary(n, stay(), energy.border(e, alpha, lj)),
                    None => cut.unary(n, stay(), energy.border(e, li, alpha)),
                }
            }
        }
        movable.iter().for_each(|&(c, _)| nodes[c] = None);
        let mut changed = Vec::new();
        for (&(c, change), moves) in movable.iter().zip(cut.solve()) {
            if moves {
                self.labels[c] = alpha;
                self.costs[c] = change;
                changed.push(c);
            }
        }
        changed
    }
}

/// More than any sum of real costs.
const BLOCKED: f64 = 1e6;

/// Which cells a plane may cover, and which edges a cell has.
struct CellGraph {
    /// The cells that each plane may cover at all, ascending, with what it costs there.
    cells_of_plane: Vec<Vec<(usize, f64)>>,
    /// The planes' cells and the cells beside them: where a change concerns the plane.
    surroundings_of_plane: Vec<Vec<u32>>,
    /// All cells, and the same with what no plane costs there.
    all: Vec<u32>,
    cells_of_no_plane: Vec<(usize, f64)>,
    edges_of_cell: Vec<Vec<usize>>,
    /// The most that a cell's borders can cost.
    border_bound: Vec<f64>,
}

impl CellGraph {
    fn new<B: PairwiseCosts>(energy: &Energy<B>, planes: u32) -> Self {
        let mut edges_of_cell = vec![Vec::new(); energy.unary.len()];
        for (i, e) in energy.edges.iter().enumerate() {
            edges_of_cell[e[0]].push(i);
            edges_of_cell[e[1]].push(i);
        }
        let bound = |edges: &Vec<usize>| edges.iter().map(|&e| energy.borders.upper_bound(e)).sum();
        let border_bound: Vec<f64> = edges_of_cell.iter().map(bound).collect();
        // Where a plane costs more than all borders of the cell, no plane is always better.
        let may_cover = |cell: usize, cost: f64| cost <= border_bound[cell];
        let mut cells_of_plane = vec![Vec::new(); planes as usize];
        for (cell, candidates) in energy.unary.iter().enumerate() {
            for &(plane, cost) in candidates.iter().filter(|c| may_cover(cell, c.1)) {
                cells_of_plane[plane as usize].push((cell, cost));
            }
        }
        // Cells and those beside them, each once: a plane of a large region has many.
        let mut listed_for = vec![NO_PLANE; energy.unary.len()];
        let mut surroundings = |plane: usize, cells: &[(usize, f64)]| {
            let beside =
                (cells.iter().flat_map(|&(c, _)| &edges_of_cell[c])).flat_map(|&e| energy.edges[e]);
            let own = cells.iter().map(|c| c.0);
            let mut around = Vec::with_capacity(cells.len());
            for cell in own.chain(beside) {
                if listed_for[cell] != plane as u32 {
                    listed_for[cell] = plane as u32;
                    around.push(cell as u32);
                }
            }
            around.shrink_to_fit();
            around
        };
        let surroundings_of_plane = (cells_of_plane.iter().enumerate())
            .map(|(plane, cells)| surroundings(plane, cells))
            .collect();
        Self {
            cells_of_plane,
            surroundings_of_plane,
            all: (0..energy.unary.len() as u32).collect(),
            cells_of_no_plane: (0..energy.unary.len()).map(|c| (c, 0.0)).collect(),
            border_bound,
            edges_of_cell,
        }
    }

    fn cells_of(&self, plane: u32) -> &[(usize, f64)] {
        (self.cells_of_plane.get(plane as usize)).unwrap_or(&self.cells_of_no_plane)
    }

    /// The plane may no longer cover the cell.
    fn block(&mut self, cell: usize, plane: u32) {
        // "No plane" may cover any.
        let Some(cells) = self.cells_of_plane.get_mut(plane as usize) else {
            return;
        };
        if let Ok(at) = cells.binary_search_by_key(&cell, |c| c.0) {
            cells[at].1 = BLOCKED;
        }
    }

    fn surroundings_of(&self, plane: u32) -> &[u32] {
        self.surroundings_of_plane
            .get(plane as usize)
            .unwrap_or(&self.all)
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

    fn may_improve(&self, plane: u32, graph: &CellGraph) -> bool {
        let last = self.tried[self.slot(plane)];
        graph
            .surroundings_of(plane)
            .iter()
            .any(|&c| self.changed[c as usize] > last)
    }

    fn changed(&mut self, cells: &[usize]) {
        self.now += 1;
        cells.iter().for_each(|&c| self.changed[c] = self.now);
    }

    fn tried(&mut self, plane: u32, changed: &[usize]) {
        self.changed(changed);
        // The plane's own changes are no reason to try it again.
        let slot = self.slot(plane);
        self.tried[slot] = self.now;
    }

    fn changed_since(&self, time: u32) -> bool {
        self.changed.iter().any(|&c| c > time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::uniform;

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

        fn upper_bound(&self, edge: usize) -> f64 {
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
        let mut labelling = Labelling::new(energy.clone(), 2);
        labelling.minimise();
        labelling.labels
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
            let mut labelling = Labelling::new(energy, 4);
            labelling.minimise();
            let excluded = labelling.labels[6];
            let its = |c: &usize| labelling.labels[*c] == excluded;
            let cells: Vec<usize> = (0..12).filter(its).collect();
            labelling.exclude(excluded, &cells);
            labelling.minimise();
            let found = labelling.energy.of(&labelling.labels);
            labelling.clock = ExpansionHistory::new(12, 4);
            labelling.minimise();
            assert_eq!(labelling.energy.of(&labelling.labels), found, "seed {seed}");
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
