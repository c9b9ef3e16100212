//! The energy of a labelling: what planes cost in cells, and what their borders cost.

/// No plane covers the cell.
pub(crate) const NO_PLANE: u32 = u32::MAX;

/// What different labels on both sides of a border cost.
pub(crate) trait PairwiseCosts: Sync {
    /// Cost of `left` and `right`, which differ, on the first and the second cell of an edge.
    fn cost(&self, edge: usize, left: u32, right: u32) -> f64;

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

impl<B: PairwiseCosts> Energy<B> {
    pub(super) fn border(&self, edge: usize, left: u32, right: u32) -> f64 {
        if left == right {
            return 0.0;
        }
        self.borders.cost(edge, left, right)
    }

    pub(super) fn unary(&self, cell: usize, label: u32) -> Option<f64> {
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
    pub(super) fn of(&self, labels: &[u32]) -> f64 {
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
}
