//! Normal equations: of few unknowns, whose number is known beforehand, and of many.

use nalgebra::{SMatrix, SVector};

use super::cholesky::{Envelope, Pattern};
use super::loss::Loss;
use super::minimise::Equations;

/// N and g of a handful of unknowns.
#[derive(Clone, Debug)]
pub(crate) struct NormalEquations<const N: usize> {
    matrix: SMatrix<f64, N, N>,
    gradient: SVector<f64, N>,
    /// What the unknowns cost.
    pub cost: f64,
}

impl<const N: usize> Default for NormalEquations<N> {
    fn default() -> Self {
        Self {
            matrix: SMatrix::zeros(),
            gradient: SVector::zeros(),
            cost: 0.0,
        }
    }
}

impl<const N: usize> NormalEquations<N> {
    /// Adds the residuals of one observation, with their derivatives by the unknowns.
    #[inline]
    pub(crate) fn add<const R: usize>(
        &mut self,
        residual: &SVector<f64, R>,
        jacobian: &SMatrix<f64, R, N>,
        loss: Loss,
    ) {
        let square = residual.norm_squared();
        self.cost += loss.cost(square);
        self.add_weighted(residual, jacobian, loss.weight(square));
    }

    /// The same with a weight, and at no cost: for single steps.
    #[inline]
    pub(crate) fn add_weighted<const R: usize>(
        &mut self,
        residual: &SVector<f64, R>,
        jacobian: &SMatrix<f64, R, N>,
        weight: f64,
    ) {
        let transposed = jacobian.transpose();
        self.matrix += transposed * jacobian * weight;
        self.gradient += transposed * residual * weight;
    }

    /// N^-1; `None` where N is not positive definite.
    pub(crate) fn inverse(&self) -> Option<SMatrix<f64, N, N>> {
        Some(self.matrix.cholesky()?.inverse())
    }
}

impl<const N: usize> Equations for NormalEquations<N> {
    type Step = SVector<f64, N>;

    fn cost(&self) -> f64 {
        self.cost
    }

    fn step(&self, damping: f64) -> Option<SVector<f64, N>> {
        let mut damped = self.matrix;
        for i in 0..N {
            damped[(i, i)] *= 1.0 + damping;
        }
        Some(-damped.cholesky()?.solve(&self.gradient))
    }
}

/// N and g of many unknowns.
pub(crate) struct EnvelopeEquations<'p> {
    /// N.
    pub matrix: Envelope<'p>,
    /// g.
    pub gradient: Vec<f64>,
    /// What the unknowns cost.
    pub cost: f64,
}

impl<'p> EnvelopeEquations<'p> {
    pub(crate) fn new(pattern: &'p Pattern) -> Self {
        Self {
            matrix: pattern.zeros(),
            gradient: vec![0.0; pattern.len()],
            cost: 0.0,
        }
    }

    /// Adds the residuals of one observation, with a row each of derivatives by these unknowns.
    pub(crate) fn add<const R: usize>(
        &mut self,
        residual: [f64; R],
        unknowns: &[usize],
        rows: [&[f64]; R],
        loss: Loss,
    ) {
        let square: f64 = residual.iter().map(|r| r * r).sum();
        self.cost += loss.cost(square);
        let weight = loss.weight(square);
        for (i, &u) in unknowns.iter().enumerate() {
            let products = |of: &dyn Fn(usize) -> f64| -> f64 {
                (0..R).map(|r| rows[r][i] * of(r)).sum::<f64>() * weight
            };
            self.gradient[u] += products(&|r| residual[r]);
            for (j, &v) in unknowns[..=i].iter().enumerate() {
                self.matrix[(u, v)] += products(&|r| rows[r][j]);
            }
        }
    }
}

impl Equations for EnvelopeEquations<'_> {
    type Step = Vec<f64>;

    fn cost(&self) -> f64 {
        self.cost
    }

    fn step(&self, damping: f64) -> Option<Vec<f64>> {
        let mut step = (self.matrix.damped(1.0 + damping).cholesky()?).solve(&self.gradient);
        step.iter_mut().for_each(|v| *v = -*v);
        Some(step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Residuals `row . x - y` of a planted solution, in three unknowns.
    const ROWS: [[f64; 3]; 5] = [
        [2.0, -1.0, 0.5],
        [0.3, 1.5, -0.7],
        [-1.1, 0.4, 2.2],
        [0.9, 0.9, -0.1],
        [0.2, -2.0, 1.0],
    ];

    fn residual(row: &[f64; 3], x: [f64; 3], planted: [f64; 3]) -> f64 {
        (0..3).map(|i| row[i] * (x[i] - planted[i])).sum()
    }

    #[test]
    fn one_step_leads_to_the_planted_solution() {
        let planted = [1.5, -2.0, 0.25];
        let start = [-3.0, 4.0, 1.0];
        let pattern = Pattern::new(3, &[vec![0, 1, 2]]);
        let mut many = EnvelopeEquations::new(&pattern);
        let mut few = NormalEquations::<3>::default();
        for row in &ROWS {
            let r = residual(row, start, planted);
            many.add([r], &[0, 1, 2], [&row[..]], Loss::Squares);
            let jacobian = SMatrix::<f64, 1, 3>::from_row_slice(row);
            few.add(&SVector::<f64, 1>::new(r), &jacobian, Loss::Squares);
        }
        assert!((many.cost - few.cost).abs() < 1e-9);
        let (many, few) = (many.step(0.0).unwrap(), few.step(0.0).unwrap());
        for i in 0..3 {
            assert!((start[i] + many[i] - planted[i]).abs() < 1e-9);
            assert!((start[i] + few[i] - planted[i]).abs() < 1e-9);
        }
    }

    #[test]
    fn what_no_residual_determines_has_no_step() {
        let pattern = Pattern::dense(2);
        let mut many = EnvelopeEquations::new(&pattern);
        many.add([1.0], &[0, 1], [&[1.0, 1.0]], Loss::Squares);
        assert!(many.step(0.0).is_none());
        assert!(many.step(1e-3).is_some());
    }
}
