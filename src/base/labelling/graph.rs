//! The cells and edges of an energy as expansions need them.

use super::energy::{AnyEnergy, Energy, NO_PLANE};

/// More than any sum of real costs.
const BLOCKED: f64 = 1e6;

/// A cell beside another one, and the edge between them.
#[derive(Clone, Copy, Default)]
pub(super) struct Beside {
    pub edge: u32,
    pub cell: u32,
    /// Is it the second cell of the edge?
    pub is_second: bool,
}

/// What lies beside each cell.
struct Neighbours {
    /// What lies beside cell c is `beside[starts[c]..starts[c + 1]]`.
    starts: Vec<u32>,
    beside: Vec<Beside>,
}

impl Neighbours {
    fn new(cells: usize, edges: &[[usize; 2]]) -> Self {
        let mut starts = vec![0u32; cells + 1];
        for &cell in edges.iter().flatten() {
            starts[cell + 1] += 1;
        }
        for cell in 0..cells {
            starts[cell + 1] += starts[cell];
        }
        let mut next = starts.clone();
        let mut beside = vec![Beside::default(); 2 * edges.len()];
        for (edge, &[i, j]) in (0u32..).zip(edges) {
            for (cell, other, is_second) in [(i, j, true), (j, i, false)] {
                beside[next[cell] as usize] = Beside {
                    edge,
                    cell: other as u32,
                    is_second,
                };
                next[cell] += 1;
            }
        }
        Self { starts, beside }
    }

    fn of(&self, cell: usize) -> &[Beside] {
        &self.beside[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// The cells in the order in which a search from the first one reaches them (Cuthill and McKee
    /// 1969).
    fn order(&self) -> Vec<u32> {
        let cells = self.starts.len() - 1;
        let mut order: Vec<u32> = Vec::with_capacity(cells);
        let mut is_reached = vec![false; cells];
        let mut at = 0;
        for start in 0..cells as u32 {
            let mut reach = |cell: u32, order: &mut Vec<u32>| {
                if !std::mem::replace(&mut is_reached[cell as usize], true) {
                    order.push(cell);
                }
            };
            reach(start, &mut order);
            while at < order.len() {
                let beside = self.of(order[at] as usize).iter();
                beside.for_each(|b| reach(b.cell, &mut order));
                at += 1;
            }
        }
        order
    }
}

/// The energy with its cells in an order in which neighbours lie near each other in memory, and
/// the new place of each cell.
pub(super) fn in_order_of_neighbours(energy: AnyEnergy) -> (AnyEnergy, Vec<u32>) {
    let Energy {
        mut unary,
        edges,
        mut borders,
    } = energy;
    let order = Neighbours::new(unary.len(), &edges).order();
    let mut places = vec![0; order.len()];
    for (place, &cell) in (0..).zip(&order) {
        places[cell as usize] = place;
    }
    let edges = edges.iter().map(|cells| cells.map(|c| places[c] as usize));
    let mut edges: Vec<(usize, [usize; 2])> = edges.enumerate().collect();
    edges.sort_by_key(|(edge, [i, j])| (*i.min(j), *edge));
    let order_of_edges: Vec<usize> = edges.iter().map(|e| e.0).collect();
    borders.reorder(&order_of_edges);
    let unary = order
        .iter()
        .map(|&c| std::mem::take(&mut unary[c as usize]));
    let energy = Energy {
        unary: unary.collect(),
        edges: edges.into_iter().map(|e| e.1).collect(),
        borders,
    };
    (energy, places)
}

/// The planes that may cover cells, by plane.
pub(super) struct Candidates {
    /// Those of plane p are `starts[p]..starts[p + 1]`.
    starts: Vec<u32>,
    /// Ascending for each plane.
    pub cells: Vec<u32>,
    /// What the plane costs there.
    pub costs: Vec<f64>,
}

impl Candidates {
    fn new(unary: &[Vec<(u32, f64)>], planes: u32) -> Self {
        let mut starts = vec![0u32; planes as usize + 1];
        for (plane, _) in unary.iter().flatten() {
            starts[*plane as usize + 1] += 1;
        }
        for plane in 0..planes as usize {
            starts[plane + 1] += starts[plane];
        }
        let mut next = starts.clone();
        let all = starts[planes as usize] as usize;
        let (mut cells, mut costs) = (vec![0; all], vec![0.0; all]);
        for (cell, candidates) in (0..).zip(unary) {
            for &(plane, cost) in candidates {
                let place = &mut next[plane as usize];
                cells[*place as usize] = cell;
                costs[*place as usize] = cost;
                *place += 1;
            }
        }
        Self {
            starts,
            cells,
            costs,
        }
    }

    /// The places of a plane's; "no plane" needs none.
    pub(super) fn of(&self, plane: u32) -> std::ops::Range<usize> {
        match plane {
            NO_PLANE => 0..0,
            _ => self.starts[plane as usize] as usize..self.starts[plane as usize + 1] as usize,
        }
    }

    fn place(&self, cell: usize, plane: u32) -> Option<usize> {
        let of_plane = self.of(plane);
        let found = self.cells[of_plane.clone()].binary_search(&(cell as u32));
        found.ok().map(|k| of_plane.start + k)
    }

    /// What a plane costs in a cell.
    pub(super) fn cost(&self, cell: usize, plane: u32) -> f64 {
        match plane {
            NO_PLANE => 0.0,
            _ => self.place(cell, plane).map_or(BLOCKED, |k| self.costs[k]),
        }
    }

    /// The plane may no longer cover the cell.
    pub(super) fn exclude(&mut self, cell: usize, plane: u32) {
        if let Some(place) = self.place(cell, plane) {
            self.costs[place] = BLOCKED;
        }
    }
}

/// Which cells concern a plane, and which lie beside a cell.
pub(super) struct CellGraph {
    pub candidates: Candidates,
    /// The cells that each plane may cover at all and those beside them: where a change concerns
    /// the plane.
    surroundings_of_plane: Vec<Vec<u32>>,
    /// The planes in groups that have no surroundings in common: a plane comes after all those
    /// before it that concern the same cells.
    pub independent_planes: Vec<Vec<u32>>,
    all: Vec<u32>,
    neighbours: Neighbours,
    /// The most that a cell's borders can cost.
    pub border_bound: Vec<f64>,
}

impl CellGraph {
    pub(super) fn new(energy: &AnyEnergy, planes: u32) -> Self {
        let cells = energy.unary.len();
        let mut border_bound = vec![0.0; cells];
        for (edge, pair) in energy.edges.iter().enumerate() {
            for &cell in pair {
                border_bound[cell] += energy.borders.upper_bound(edge);
            }
        }
        let mut graph = Self {
            candidates: Candidates::new(&energy.unary, planes),
            surroundings_of_plane: Vec::new(),
            independent_planes: Vec::new(),
            all: (0..cells as u32).collect(),
            neighbours: Neighbours::new(cells, &energy.edges),
            border_bound,
        };
        graph.surroundings_of_plane = graph.surroundings(planes);
        graph.independent_planes = graph.independent(cells);
        graph
    }

    fn independent(&self, cells: usize) -> Vec<Vec<u32>> {
        let mut groups: Vec<Vec<u32>> = Vec::new();
        // By cell the first group that may still concern it.
        let mut open = vec![0; cells];
        for (plane, cells) in (0..).zip(&self.surroundings_of_plane) {
            let first = cells.iter().map(|&c| open[c as usize]).max().unwrap_or(0);
            cells.iter().for_each(|&c| open[c as usize] = first + 1);
            if groups.len() == first {
                groups.push(Vec::new());
            }
            groups[first].push(plane);
        }
        groups
    }

    /// The candidates of a plane where it does not cost more than all borders of the cell: there no
    /// plane is always better. Their places and cells.
    pub(super) fn paying(&self, plane: u32) -> impl Iterator<Item = (usize, u32)> {
        let Candidates { cells, costs, .. } = &self.candidates;
        let of_plane = self.candidates.of(plane).map(|place| (place, cells[place]));
        of_plane.filter(|&(place, cell)| costs[place] <= self.border_bound[cell as usize])
    }

    /// Per plane the cells that it may cover and those beside them, each once.
    fn surroundings(&self, planes: u32) -> Vec<Vec<u32>> {
        let mut listed_for = vec![NO_PLANE; self.all.len()];
        let around = |plane: u32| {
            let own: Vec<u32> = self.paying(plane).map(|(_, cell)| cell).collect();
            let beside = own.iter().flat_map(|&c| self.beside(c as usize));
            let mut around: Vec<u32> = Vec::with_capacity(own.len());
            for cell in own.iter().copied().chain(beside.map(|b| b.cell)) {
                if listed_for[cell as usize] != plane {
                    listed_for[cell as usize] = plane;
                    around.push(cell);
                }
            }
            around.shrink_to_fit();
            around
        };
        (0..planes).map(around).collect()
    }

    pub(super) fn beside(&self, cell: usize) -> &[Beside] {
        self.neighbours.of(cell)
    }

    pub(super) fn planes(&self) -> usize {
        self.surroundings_of_plane.len()
    }

    /// "No plane" may cover any cell.
    pub(super) fn surroundings_of(&self, plane: u32) -> &[u32] {
        let of_plane = self.surroundings_of_plane.get(plane as usize);
        of_plane.unwrap_or(&self.all)
    }
}
