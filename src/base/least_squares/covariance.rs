//! How certain measurements and unknowns are.

use nalgebra::Matrix2;

/// The matrix that makes residuals of this covariance independent and of variance one; `None` where
/// the covariance is not positive definite.
pub(crate) fn whitening(covariance: &Matrix2<f64>) -> Option<Matrix2<f64>> {
    covariance.cholesky()?.l().try_inverse()
}

/// The variance of unit weight, by which the inverse of the normal matrix is multiplied: what the
/// residuals cost over what they should by their `redundancy` (residuals minus unknowns). As many
/// expected residuals as `prior` say that the stated covariances are right, for a few residuals
/// hardly tell. At least 1: residuals that are small by chance make nothing more certain.
pub(crate) fn variance_of_unit_weight(cost: f64, redundancy: f64, prior: f64) -> f64 {
    ((cost + prior) / (redundancy.max(0.0) + prior)).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whitened_residuals_have_the_unit_matrix_for_their_covariance() {
        let covariance = Matrix2::new(0.5, 0.1, 0.1, 0.2);
        let w = whitening(&covariance).unwrap();
        assert!((w * covariance * w.transpose() - Matrix2::identity()).norm() < 1e-12);
        assert!(whitening(&-covariance).is_none());
    }

    #[test]
    fn residuals_as_large_as_they_should_be_change_nothing() {
        assert_eq!(variance_of_unit_weight(8.0, 8.0, 4.0), 1.0);
        assert_eq!(variance_of_unit_weight(0.0, 8.0, 4.0), 1.0);
        assert_eq!(variance_of_unit_weight(20.0, 8.0, 4.0), 2.0);
        assert_eq!(variance_of_unit_weight(20.0, -2.0, 4.0), 6.0);
    }
}
