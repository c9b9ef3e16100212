//! Small linear algebra with the same bits on every target.

use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, SymmetricEigen, UnitQuaternion, Vector3};

/// A basis of the null space of a matrix with `C - R` dimensions, orthonormal: by Gaussian
/// elimination with full pivoting. `None` where the rank is lower.
pub(super) fn null_space<const R: usize, const C: usize, const N: usize>(
    matrix: &SMatrix<f64, R, C>,
) -> Option<[SVector<f64, C>; N]> {
    let mut m = *matrix;
    let mut order: [usize; C] = std::array::from_fn(|i| i);
    let size = m.amax();
    for k in 0..R {
        let (mut row, mut column) = (k, k);
        for c in k..C {
            for r in k..R {
                if m[(r, c)].abs() > m[(row, column)].abs() {
                    (row, column) = (r, c);
                }
            }
        }
        let largest = m[(row, column)].abs();
        if largest.is_nan() || largest <= 1e-12 * size {
            return None;
        }
        m.swap_rows(k, row);
        m.swap_columns(k, column);
        order.swap(k, column);
        let pivot = 1.0 / m[(k, k)];
        for c in k..C {
            m[(k, c)] *= pivot;
        }
        for r in 0..R {
            let factor = m[(r, k)];
            if r != k && factor != 0.0 {
                for c in k..C {
                    m[(r, c)] -= factor * m[(k, c)];
                }
            }
        }
    }
    let mut basis = [SVector::<f64, C>::zeros(); N];
    for (n, vector) in basis.iter_mut().enumerate() {
        for r in 0..R {
            vector[order[r]] = -m[(r, R + n)];
        }
        vector[order[R + n]] = 1.0;
    }
    for n in 0..N {
        for k in 0..n {
            let along = basis[n].dot(&basis[k]);
            let along = basis[k] * along;
            basis[n] -= along;
        }
        basis[n] /= basis[n].norm();
    }
    Some(basis)
}

/// The rotation R that minimises the weighted sum of |b - R a|^2 (Horn 1987): the eigenvector of
/// the largest eigenvalue of a 4 x 4 matrix, as a quaternion. `correlation` is the weighted sum of
/// a b^T.
pub(super) fn rotation_between(correlation: &Matrix3<f64>) -> Rotation3<f64> {
    let s = correlation;
    let trace = s.trace();
    let delta = Vector3::new(
        s[(1, 2)] - s[(2, 1)],
        s[(2, 0)] - s[(0, 2)],
        s[(0, 1)] - s[(1, 0)],
    );
    let mut n = nalgebra::Matrix4::zeros();
    n[(0, 0)] = trace;
    for i in 0..3 {
        n[(0, i + 1)] = delta[i];
        n[(i + 1, 0)] = delta[i];
        for j in 0..3 {
            n[(i + 1, j + 1)] = s[(i, j)] + s[(j, i)] - if i == j { trace } else { 0.0 };
        }
    }
    let eigen = SymmetricEigen::new(n);
    let largest = eigen.eigenvalues.imax();
    let q = eigen.eigenvectors.column(largest);
    let q = nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]);
    UnitQuaternion::from_quaternion(q).to_rotation_matrix()
}

/// Real roots of a polynomial, whose coefficients stand highest power first, in rising order:
/// between the roots of its derivative it has at most one. Roots beyond 1 are found as reciprocals
/// of those of the reversed polynomial.
pub(super) fn real_roots(coefficients: &[f64]) -> Vec<f64> {
    let inner = roots_within_one(coefficients);
    let reversed: Vec<f64> = coefficients.iter().rev().copied().collect();
    let outer = roots_within_one(&reversed);
    let outer = outer
        .into_iter()
        .filter(|r| r.abs() < 1.0 && r.abs() > 1e-9);
    let mut roots: Vec<f64> = inner.into_iter().chain(outer.map(|r| 1.0 / r)).collect();
    roots.sort_by(f64::total_cmp);
    roots
}

/// The roots from -1 to 1.
fn roots_within_one(coefficients: &[f64]) -> Vec<f64> {
    let degree = coefficients.len() - 1;
    // Roots of the derivatives, the highest first: each list divides the range for the next.
    let mut separators: Vec<f64> = Vec::new();
    for order in (0..degree).rev() {
        let derived = derivative(coefficients, order);
        let mut found = Vec::with_capacity(degree - order);
        let mut low = -1.0;
        for high in separators.iter().copied().chain([1.0]) {
            found.extend(root_between(&derived, low, high));
            low = high;
        }
        separators = found;
    }
    separators
}

/// The coefficients of the derivative of an order, scaled to a largest one of one.
fn derivative(coefficients: &[f64], order: usize) -> Vec<f64> {
    let degree = coefficients.len() - 1;
    let kept = &coefficients[..=degree - order];
    let mut derived: Vec<f64> = (kept.iter().enumerate())
        .map(|(i, c)| {
            let power = degree - i;
            (0..order).fold(*c, |c, k| c * (power - k) as f64)
        })
        .collect();
    let size = derived.iter().fold(0.0f64, |a, c| a.max(c.abs()));
    if size > 0.0 {
        derived.iter_mut().for_each(|c| *c /= size);
    }
    derived
}

fn value(coefficients: &[f64], x: f64) -> (f64, f64) {
    coefficients
        .iter()
        .fold((0.0, 0.0), |(p, d), c| (p * x + c, d * x + p))
}

/// The root of a polynomial that is monotonic between two places: Newton's method kept within a
/// bracket.
fn root_between(p: &[f64], mut low: f64, mut high: f64) -> Option<f64> {
    let (at_low, at_high) = (value(p, low).0, value(p, high).0);
    if at_low == 0.0 {
        return Some(low);
    }
    if (at_low > 0.0) == (at_high > 0.0) {
        return None;
    }
    let mut x = 0.5 * (low + high);
    for _ in 0..60 {
        let (f, slope) = value(p, x);
        if (f > 0.0) == (at_low > 0.0) {
            low = x;
        } else {
            high = x;
        }
        let step = x - f / slope;
        let next = if step > low && step < high {
            step
        } else {
            0.5 * (low + high)
        };
        if (next - x).abs() <= 1e-15 {
            return Some(next);
        }
        x = next;
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::rotation_from_axis_angle;
    use crate::orienting::structure_from_motion::random::Random;

    #[test]
    fn roots_that_were_multiplied_out_are_found() {
        let roots = [-3.2, -0.71, -0.7, 0.0, 0.25, 0.9, 1.4, 20.0];
        let mut p = vec![1.0];
        for root in roots {
            let mut next = vec![0.0; p.len() + 1];
            for (i, c) in p.iter().enumerate() {
                next[i] += c;
                next[i + 1] -= c * root;
            }
            p = next;
        }
        let found = real_roots(&p);
        assert_eq!(found.len(), roots.len(), "{found:?}");
        for (a, b) in found.iter().zip(roots) {
            assert!((a - b).abs() < 1e-6 * (1.0 + b.abs()), "{a} {b}");
        }
        assert!(real_roots(&[1.0, 0.0, 1.0]).is_empty());
    }

    #[test]
    fn a_null_space_is_orthonormal_and_maps_to_zero() {
        let mut random = Random::new(4);
        let m = SMatrix::<f64, 5, 9>::from_fn(|_, _| random.signed());
        let basis: [SVector<f64, 9>; 4] = null_space(&m).unwrap();
        for (i, a) in basis.iter().enumerate() {
            assert!((m * a).norm() < 1e-12);
            for (j, b) in basis.iter().enumerate() {
                let expected = f64::from(u8::from(i == j));
                assert!((a.dot(b) - expected).abs() < 1e-12);
            }
        }
        let mut flat = m;
        flat.set_row(4, &(m.row(0) + m.row(1)));
        assert!(null_space::<5, 9, 4>(&flat).is_none());
    }

    #[test]
    fn a_rotation_is_found_from_directions() {
        let mut random = Random::new(6);
        let r = rotation_from_axis_angle(&Vector3::new(0.4, -2.0, 1.1));
        let correlation = (0..5).fold(Matrix3::zeros(), |sum, _| {
            let a = Vector3::from_fn(|_, _| random.signed());
            sum + a * (r * a).transpose()
        });
        assert!((rotation_between(&correlation).matrix() - r.matrix()).norm() < 1e-9);
    }
}
