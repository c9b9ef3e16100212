//! Symmetric positive definite systems: Cholesky within the envelope (George and Liu 1981).
//!
//! Numbered from one end to the other (reverse Cuthill-McKee), a matrix in which few unknowns meet
//! has its numbers near the diagonal, and so has its factor: a roof of a thousand unknowns takes
//! milliseconds instead of a second. A matrix in which all meet has the whole triangle for its
//! envelope.

use std::collections::VecDeque;
use std::ops::{Index, IndexMut};

use nalgebra::SMatrix;

/// Places of the unknowns in the order of elimination, and where each row of the matrix begins.
#[derive(Clone, Debug)]
pub(crate) struct Pattern {
    place: Vec<usize>,
    first: Vec<usize>,
    start: Vec<usize>,
}

/// A symmetric matrix, lower rows from the first number that may differ from zero; or its Cholesky
/// factor.
#[derive(Clone, Debug)]
pub(crate) struct Envelope<'a> {
    pattern: &'a Pattern,
    values: Vec<f64>,
}

impl Pattern {
    /// For `n` unknowns, of which those in one of the `groups` meet in the matrix.
    pub(crate) fn new(n: usize, groups: &[Vec<usize>]) -> Self {
        let place = reverse_cuthill_mckee(&neighbours(n, groups));
        let mut first: Vec<usize> = (0..n).collect();
        for group in groups {
            let least = group.iter().map(|&u| place[u]).min().unwrap_or(0);
            for &u in group {
                first[place[u]] = first[place[u]].min(least);
            }
        }
        Self::of(place, first)
    }

    /// For `n` unknowns that all meet, eliminated in their order.
    pub(crate) fn dense(n: usize) -> Self {
        Self::of((0..n).collect(), vec![0; n])
    }

    fn of(place: Vec<usize>, first: Vec<usize>) -> Self {
        let mut start = Vec::with_capacity(first.len() + 1);
        let mut total = 0;
        for (row, first) in first.iter().enumerate() {
            start.push(total);
            total += row - first + 1;
        }
        start.push(total);
        Self {
            place,
            first,
            start,
        }
    }

    /// Number of unknowns.
    pub(crate) fn len(&self) -> usize {
        self.first.len()
    }

    /// The zero matrix of this pattern.
    pub(crate) fn zeros(&self) -> Envelope<'_> {
        Envelope {
            pattern: self,
            values: vec![0.0; self.start[self.len()]],
        }
    }

    fn index(&self, (u, v): (usize, usize)) -> usize {
        let (i, j) = (self.place[u], self.place[v]);
        let (row, column) = (i.max(j), i.min(j));
        self.start[row] + column - self.first[row]
    }
}

/// The element at two unknowns; both orders are one element, so a product is added once for each
/// pair.
impl Index<(usize, usize)> for Envelope<'_> {
    type Output = f64;

    fn index(&self, at: (usize, usize)) -> &f64 {
        &self.values[self.pattern.index(at)]
    }
}

impl IndexMut<(usize, usize)> for Envelope<'_> {
    fn index_mut(&mut self, at: (usize, usize)) -> &mut f64 {
        &mut self.values[self.pattern.index(at)]
    }
}

impl Envelope<'_> {
    /// The row of an unknown up to the diagonal, of a dense matrix.
    #[inline]
    pub(crate) fn row_mut(&mut self, u: usize) -> &mut [f64] {
        &mut self.values[self.pattern.start[u]..self.pattern.start[u + 1]]
    }

    /// Adds a block whose rows and columns start at these unknowns, where it lies below or on the
    /// diagonal of a dense matrix.
    #[inline]
    pub(crate) fn add_block<const R: usize, const C: usize>(
        &mut self,
        row: usize,
        column: usize,
        block: &SMatrix<f64, R, C>,
    ) {
        for r in 0..R {
            let width = if row == column { r + 1 } else { C };
            let into = &mut self.row_mut(row + r)[column..column + width];
            for (c, value) in into.iter_mut().enumerate() {
                *value += block[(r, c)];
            }
        }
    }

    /// Adds another matrix of the same pattern.
    pub(crate) fn add(&mut self, other: &Self) {
        for (mine, theirs) in self.values.iter_mut().zip(&other.values) {
            *mine += theirs;
        }
    }

    /// The same matrix with its diagonal multiplied.
    pub(crate) fn damped(&self, factor: f64) -> Self {
        let mut damped = self.clone();
        for u in 0..self.pattern.len() {
            damped[(u, u)] *= factor;
        }
        damped
    }

    /// Its Cholesky factor; `None` when it is not positive definite.
    pub(crate) fn cholesky(mut self) -> Option<Self> {
        let pattern = self.pattern;
        for i in 0..pattern.first.len() {
            let (done, rest) = self.values.split_at_mut(pattern.start[i]);
            let row = &mut rest[..pattern.start[i + 1] - pattern.start[i]];
            let begin = pattern.first[i];
            for j in begin..=i {
                let common = pattern.first[j].max(begin);
                let before = &row[common - begin..j - begin];
                if j == i {
                    let square = row[i - begin] - dot(before, before);
                    // NaN fails the comparison; what rounding leaves of a singular matrix is no
                    // pivot.
                    if square.is_nan() || square <= 1e-14 * row[i - begin] {
                        return None;
                    }
                    row[i - begin] = square.sqrt();
                } else {
                    let other = &done[pattern.start[j]..pattern.start[j + 1]];
                    let above = &other[common - pattern.first[j]..];
                    let (above, pivot) = (&above[..j - common], other[j - pattern.first[j]]);
                    row[j - begin] = (row[j - begin] - dot(before, above)) / pivot;
                }
            }
        }
        Some(self)
    }

    /// Solves with this factor.
    pub(crate) fn solve(&self, rhs: &[f64]) -> Vec<f64> {
        let pattern = self.pattern;
        let n = pattern.len();
        let mut x = vec![0.0; n];
        for (&i, value) in pattern.place.iter().zip(rhs) {
            x[i] = *value;
        }
        let row = |i: usize| {
            let (before, pivot) =
                self.values[pattern.start[i]..pattern.start[i + 1]].split_at(i - pattern.first[i]);
            (before, pivot[0])
        };
        for i in 0..n {
            let (before, pivot) = row(i);
            x[i] = (x[i] - dot(before, &x[pattern.first[i]..i])) / pivot;
        }
        for i in (0..n).rev() {
            let (before, pivot) = row(i);
            x[i] /= pivot;
            let at = x[i];
            for (value, l) in x[pattern.first[i]..i].iter_mut().zip(before) {
                *value -= l * at;
            }
        }
        pattern.place.iter().map(|&i| x[i]).collect()
    }

    /// The inverse of a dense matrix of which this is the factor: (L^-1)^T L^-1.
    pub(crate) fn inverse(&self) -> Self {
        let n = self.pattern.len();
        let rows = &self.pattern.start;
        let mut m = self.pattern.zeros();
        for i in 0..n {
            let row = &self.values[rows[i]..rows[i + 1]];
            let (before, rest) = m.values.split_at_mut(rows[i]);
            let own = &mut rest[..=i];
            for (k, l) in row[..i].iter().enumerate() {
                for (value, other) in own.iter_mut().zip(&before[rows[k]..rows[k + 1]]) {
                    *value -= l * other;
                }
            }
            own.iter_mut().for_each(|v| *v /= row[i]);
            own[i] = 1.0 / row[i];
        }
        let mut inverse = self.pattern.zeros();
        for k in 0..n {
            let row = &m.values[rows[k]..rows[k + 1]];
            for (i, factor) in row.iter().enumerate() {
                for (value, other) in inverse.row_mut(i).iter_mut().zip(row) {
                    *value += factor * other;
                }
            }
        }
        inverse
    }
}

/// Four sums at a time, in one fixed order.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let (ra, rb) = (a4.remainder(), b4.remainder());
    for (x, y) in a4.zip(b4) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    let rest: f64 = ra.iter().zip(rb).map(|(x, y)| x * y).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// For every unknown those that it meets, ascending.
fn neighbours(n: usize, groups: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut of = vec![Vec::new(); n];
    for group in groups {
        for &u in group {
            of[u].extend(group.iter().copied().filter(|&v| v != u));
        }
    }
    of.iter_mut().for_each(|list| {
        list.sort_unstable();
        list.dedup();
    });
    of
}

/// Place of every unknown: breadth first from an unknown at the edge, few neighbours first, and the
/// whole reversed.
fn reverse_cuthill_mckee(neighbours: &[Vec<usize>]) -> Vec<usize> {
    let n = neighbours.len();
    let mut order = Vec::with_capacity(n);
    let mut seen = vec![false; n];
    while order.len() < n {
        let first = (0..n).find(|&u| !seen[u]).expect("not all are seen");
        // The unknown reached last from any one is at the edge.
        let far = *breadth_first(neighbours, first, &mut seen.clone())
            .last()
            .expect("the first one at least");
        order.extend(breadth_first(neighbours, far, &mut seen));
    }
    let mut place = vec![0; n];
    for (i, &u) in order.iter().rev().enumerate() {
        place[u] = i;
    }
    place
}

fn breadth_first(neighbours: &[Vec<usize>], first: usize, seen: &mut [bool]) -> Vec<usize> {
    let mut order = Vec::new();
    let mut queue = VecDeque::from([first]);
    seen[first] = true;
    while let Some(u) = queue.pop_front() {
        order.push(u);
        let mut next: Vec<usize> = neighbours[u]
            .iter()
            .copied()
            .filter(|&v| !seen[v])
            .collect();
        next.sort_by_key(|&v| (neighbours[v].len(), v));
        for v in next {
            seen[v] = true;
            queue.push_back(v);
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn it_solves_what_a_dense_matrix_solves() {
        // A chain with a few long links, numbered without order.
        let n = 40;
        let unknown = |i: usize| (i * 17) % n;
        let mut groups: Vec<Vec<usize>> = (0..n - 2)
            .map(|i| vec![unknown(i), unknown(i + 1), unknown(i + 2)])
            .collect();
        groups.push(vec![unknown(3), unknown(21)]);
        let pattern = Pattern::new(n, &groups);
        let mut dense = DMatrix::<f64>::zeros(n, n);
        let whole = Pattern::dense(n);
        let mut matrices = [pattern.zeros(), whole.zeros()];
        for (k, group) in groups.iter().enumerate() {
            let row: Vec<f64> = (0..group.len())
                .map(|i| ((k * 7 + i * 3) % 11) as f64 - 4.5)
                .collect();
            for (i, &u) in group.iter().enumerate() {
                for (j, &v) in group.iter().enumerate() {
                    dense[(u, v)] += row[i] * row[j];
                    if j <= i {
                        matrices
                            .iter_mut()
                            .for_each(|m| m[(u, v)] += row[i] * row[j]);
                    }
                }
            }
        }
        for u in 0..n {
            dense[(u, u)] += 0.5;
            matrices.iter_mut().for_each(|m| m[(u, u)] += 0.5);
        }
        let rhs = DVector::from_fn(n, |i, _| (i % 5) as f64 - 2.0);
        let expected = dense.clone().cholesky().unwrap();
        for matrix in &matrices {
            let found = matrix.clone().cholesky().unwrap().solve(rhs.as_slice());
            assert!((expected.solve(&rhs) - DVector::from_vec(found)).norm() < 1e-9);
        }
        let inverse = matrices[1].clone().cholesky().unwrap().inverse();
        let inverse = DMatrix::from_fn(n, n, |u, v| inverse[(u, v)]);
        assert!((expected.inverse() - inverse).norm() < 1e-9);
        // Far less than half of n squared is stored.
        assert!(matrices[0].values.len() < n * n / 4);
        for matrix in &mut matrices {
            matrix[(0, 0)] -= 1e6;
            assert!(matrix.clone().cholesky().is_none());
        }
    }
}
