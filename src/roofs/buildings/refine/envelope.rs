//! Symmetric positive definite systems that are nearly empty: Cholesky within the envelope (George
//! and Liu 1981).
//!
//! A roof is a planar thing: a vertex meets few facets. Numbered from one end of the building to
//! the other (reverse Cuthill-McKee), the normal matrix has its numbers near the diagonal, and so
//! has its factor. A block of a thousand unknowns takes milliseconds instead of a second.

use std::collections::VecDeque;

use nalgebra::DVector;

/// Places of the unknowns in the order of elimination, and where each row of the matrix begins.
#[derive(Clone, Debug)]
pub(super) struct Pattern {
    place: Vec<usize>,
    first: Vec<usize>,
    start: Vec<usize>,
}

/// A symmetric matrix, lower rows from the first number that may differ from zero; or its Cholesky
/// factor.
#[derive(Clone, Debug)]
pub(super) struct Envelope<'a> {
    pattern: &'a Pattern,
    values: Vec<f64>,
}

impl Pattern {
    /// For `n` unknowns, of which those in one of the `groups` meet in the matrix.
    pub(super) fn new(n: usize, groups: &[Vec<usize>]) -> Self {
        let place = reverse_cuthill_mckee(&neighbours(n, groups));
        let mut first: Vec<usize> = (0..n).collect();
        for group in groups {
            let least = group.iter().map(|&u| place[u]).min().unwrap_or(0);
            for &u in group {
                first[place[u]] = first[place[u]].min(least);
            }
        }
        let mut start = Vec::with_capacity(n + 1);
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

    /// The zero matrix of this pattern.
    pub(super) fn zeros(&self) -> Envelope<'_> {
        Envelope {
            pattern: self,
            values: vec![0.0; self.start[self.first.len()]],
        }
    }
}

impl Envelope<'_> {
    /// Adds to the element at two unknowns; both orders are one element, so a product is added once
    /// for each pair.
    pub(super) fn add(&mut self, u: usize, v: usize, value: f64) {
        let [i, j] = [u, v].map(|w| self.pattern.place[w]);
        let at = self.index(i.max(j), i.min(j));
        self.values[at] += value;
    }

    /// The same matrix with its diagonal multiplied.
    pub(super) fn damped(&self, factor: f64) -> Self {
        let mut damped = self.clone();
        for i in 0..self.pattern.first.len() {
            let at = self.index(i, i);
            damped.values[at] *= factor;
        }
        damped
    }

    /// Its Cholesky factor; `None` when it is not positive definite.
    pub(super) fn cholesky(mut self) -> Option<Self> {
        let pattern = self.pattern;
        for i in 0..pattern.first.len() {
            let (done, rest) = self.values.split_at_mut(pattern.start[i]);
            let row = &mut rest[..pattern.start[i + 1] - pattern.start[i]];
            let begin = pattern.first[i];
            for j in begin..=i {
                let common = pattern.first[j].max(begin);
                let dot = |other: &[f64], row: &[f64]| -> f64 {
                    let (a, b) = (
                        &other[common - pattern.first[j]..j - pattern.first[j]],
                        &row[common - begin..j - begin],
                    );
                    a.iter().zip(b).map(|(x, y)| x * y).sum()
                };
                if j == i {
                    let square = row[i - begin] - dot(row, row);
                    // NaN fails the comparison.
                    if square.is_nan() || square <= 0.0 {
                        return None;
                    }
                    row[i - begin] = square.sqrt();
                } else {
                    let other = &done[pattern.start[j]..pattern.start[j + 1]];
                    let pivot = other[j - pattern.first[j]];
                    row[j - begin] = (row[j - begin] - dot(other, row)) / pivot;
                }
            }
        }
        Some(self)
    }

    /// Solves with this factor.
    pub(super) fn solve(&self, rhs: &DVector<f64>) -> DVector<f64> {
        let pattern = self.pattern;
        let n = pattern.first.len();
        let mut x = vec![0.0; n];
        for (u, &i) in pattern.place.iter().enumerate() {
            x[i] = rhs[u];
        }
        for i in 0..n {
            let row = &self.values[pattern.start[i]..pattern.start[i + 1]];
            let begin = pattern.first[i];
            let sum: f64 = (begin..i).map(|j| row[j - begin] * x[j]).sum();
            x[i] = (x[i] - sum) / row[i - begin];
        }
        for i in (0..n).rev() {
            let row = &self.values[pattern.start[i]..pattern.start[i + 1]];
            let begin = pattern.first[i];
            x[i] /= row[i - begin];
            let at = x[i];
            for j in begin..i {
                x[j] -= row[j - begin] * at;
            }
        }
        DVector::from_fn(n, |u, _| x[pattern.place[u]])
    }

    fn index(&self, row: usize, column: usize) -> usize {
        self.pattern.start[row] + column - self.pattern.first[row]
    }
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
    use nalgebra::DMatrix;

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
        let mut envelope = pattern.zeros();
        for (k, group) in groups.iter().enumerate() {
            let row: Vec<f64> = (0..group.len())
                .map(|i| ((k * 7 + i * 3) % 11) as f64 - 4.5)
                .collect();
            for (i, &u) in group.iter().enumerate() {
                for (j, &v) in group.iter().enumerate() {
                    dense[(u, v)] += row[i] * row[j];
                    if j <= i {
                        envelope.add(u, v, row[i] * row[j]);
                    }
                }
            }
        }
        for u in 0..n {
            dense[(u, u)] += 0.5;
            envelope.add(u, u, 0.5);
        }
        let rhs = DVector::from_fn(n, |i, _| (i % 5) as f64 - 2.0);
        let expected = dense.clone().cholesky().unwrap().solve(&rhs);
        let found = envelope.clone().cholesky().unwrap().solve(&rhs);
        assert!((expected - found).norm() < 1e-9);
        // Far less than half of n squared is stored.
        assert!(envelope.values.len() < n * n / 4);
        envelope.add(0, 0, -1e6);
        assert!(envelope.cholesky().is_none());
    }
}
