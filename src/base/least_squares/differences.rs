//! A Jacobian against central differences, for the tests of every problem.

use nalgebra::{SMatrix, SVector};

/// Step of the differences, in the unit of the unknown.
const STEP: f64 = 1e-6;

/// The largest difference between derivatives and central differences of the residuals after a
/// step of one unknown, as a share of the largest derivative by that unknown (at least 1).
pub(crate) fn worst_derivative<const R: usize, const N: usize>(
    jacobian: &SMatrix<f64, R, N>,
    residual: impl Fn(&SVector<f64, N>) -> SVector<f64, R>,
) -> f64 {
    let off = |i: usize| {
        let step = SVector::<f64, N>::from_fn(|k, _| if k == i { STEP } else { 0.0 });
        let numeric = (residual(&step) - residual(&-step)) / (2.0 * STEP);
        let analytic = jacobian.column(i);
        (numeric - analytic).amax() / analytic.amax().max(1.0)
    };
    (0..N).map(off).fold(0.0, f64::max)
}
