//! Brown's distortion for a lens whose file states the inverse, from measured to ideal points.
//!
//! The coefficients (ideal to measured, [`Distortion`]) and a change of the focal length are found
//! by least squares over pairs of points; all of them are linear.

use nalgebra::{Point2, RowVector6, Vector1};

use crate::base::least_squares::{Equations, Loss, NormalEquations};
use crate::photographs::camera::Distortion;

/// A distortion, and the factor of its focal length.
pub(crate) struct FittedLens {
    pub distortion: Distortion,
    pub focal_factor: f64,
    /// Largest distance between a measured point and the distorted ideal one, in focal lengths.
    pub worst: f64,
}

/// Fits a lens about the principal point to pairs (ideal, measured), principal point subtracted and
/// divided by the focal length. `None` where they determine none.
pub(crate) fn fit(pairs: &[(Point2<f64>, Point2<f64>)]) -> Option<FittedLens> {
    let far = pairs
        .iter()
        .map(|(p, _)| p.coords.norm())
        .fold(0.0, f64::max);
    if !(far > 0.0 && far.is_finite()) {
        return None;
    }
    // Scaled by the farthest point, so that high powers keep their precision.
    let mut equations = NormalEquations::default();
    for (ideal, measured) in pairs {
        let (d, change) = (ideal.coords / far, (measured - ideal) / far);
        for (row, change) in basis(d.x, d.y).iter().zip(change.iter()) {
            equations.add(&Vector1::new(-change), row, Loss::Squares);
        }
    }
    let c = equations.step(0.0)?;
    let unit2 = 1.0 / (far * far);
    let focal_factor = 1.0 + c[0];
    let radial = [
        c[1] * unit2,
        c[2] * unit2 * unit2,
        c[3] * unit2 * unit2 * unit2,
    ];
    let distortion = Distortion::brown(
        radial.map(|k| k / focal_factor),
        [c[4], c[5]].map(|p| p / (far * focal_factor)),
    )?;
    let miss = |(ideal, measured): &(Point2<f64>, Point2<f64>)| {
        (distortion.distort(ideal).coords * focal_factor - measured.coords).norm()
    };
    Some(FittedLens {
        worst: pairs.iter().map(miss).fold(0.0, f64::max),
        distortion,
        focal_factor,
    })
}

/// Derivatives of x and y with respect to (scale, k1, k2, k3, p1, p2).
fn basis(x: f64, y: f64) -> [RowVector6<f64>; 2] {
    let r2 = x * x + y * y;
    let row = |d: f64, p1: f64, p2: f64| {
        RowVector6::new(d, d * r2, d * r2 * r2, d * r2 * r2 * r2, p1, p2)
    };
    [
        row(x, 2.0 * x * y, r2 + 2.0 * x * x),
        row(y, r2 + 2.0 * y * y, 2.0 * x * y),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_planted_lens_and_focal_length_are_found() {
        let planted = Distortion::brown([-0.04, 0.03, -0.002], [3e-4, -2e-4]).unwrap();
        let pair = |i: i32| {
            let ideal = Point2::new(f64::from(i % 9 - 4) * 0.12, f64::from(i / 9 - 4) * 0.1);
            (ideal, planted.distort(&ideal) * 1.001)
        };
        let found = fit(&(0..81).map(pair).collect::<Vec<_>>()).unwrap();
        assert!((found.focal_factor - 1.001).abs() < 1e-9 && found.worst < 1e-12);
        for (a, b) in found.distortion.radial.iter().zip(planted.radial) {
            assert!((a - b).abs() < 1e-6, "{:?}", found.distortion);
        }
        for (a, b) in found.distortion.tangential.iter().zip(planted.tangential) {
            assert!((a - b).abs() < 1e-9, "{:?}", found.distortion);
        }
    }
}
