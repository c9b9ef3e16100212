//! The energy of a labelling: what planes cost in cells, and what their borders cost.

/// No plane covers the cell.
pub(crate) const NO_PLANE: u32 = u32::MAX;

/// What different labels on both sides of a border cost.
pub(crate) trait PairwiseCosts: Send + Sync {
    /// Cost of `left` and `right`, which differ, on the first and the second cell of an edge.
    fn cost(&self, edge: usize, left: u32, right: u32) -> f64;

    /// The same where both may be one label, which costs nothing.
    fn between(&self, edge: usize, left: u32, right: u32) -> f64 {
        match left == right {
            true => 0.0,
            false => self.cost(edge, left, right),
        }
    }

    /// Puts the edges into another order: `order` holds the former index of each.
    fn reorder(&mut self, order: &[usize]);

    /// The most that any two labels can cost there.
    fn upper_bound(&self, edge: usize) -> f64;
}

/// The energy over cells and planes.
#[derive(Clone, Debug)]
pub(crate) struct Energy<B> {
    /// Per cell: (plane, D) for the planes that may cover it, ascending by plane. "No plane" costs
    /// 0.
    pub unary: Vec<Vec<(u32, f64)>>,
    /// Pairs of neighbouring cells.
    pub edges: Vec<[usize; 2]>,
    /// The costs of the edges.
    pub borders: B,
}

/// An energy with borders of any kind, so that the code that minimises it is there once.
pub(super) type AnyEnergy = Energy<Box<dyn PairwiseCosts>>;

impl<B: PairwiseCosts + 'static> Energy<B> {
    /// The same energy, with borders of any kind.
    pub(super) fn of_any_borders(self) -> AnyEnergy {
        Energy {
            unary: self.unary,
            edges: self.edges,
            borders: Box::new(self.borders),
        }
    }
}

#[cfg(test)]
impl<B: PairwiseCosts> Energy<B> {
    /// The energy of a labelling; infinite when a cell has a plane that may not cover it.
    pub(super) fn of(&self, labels: &[u32]) -> f64 {
        let data: f64 = labels
            .iter()
            .enumerate()
            .map(|(c, &l)| match l {
                NO_PLANE => 0.0,
                _ => (self.unary[c].iter().find(|u| u.0 == l)).map_or(f64::INFINITY, |u| u.1),
            })
            .sum();
        let borders: f64 = self
            .edges
            .iter()
            .enumerate()
            .map(|(e, cells)| self.borders.between(e, labels[cells[0]], labels[cells[1]]))
            .sum();
        data + borders
    }
}
