//! Symmetric positive definite systems, their lower triangle row by row.

use super::normal_equations::at;

/// L with L L^T = A in place of A; `false` where A is not positive definite.
fn factorise(a: &mut [f64], n: usize) -> bool {
    for i in 0..n {
        for j in 0..=i {
            let (upper, lower) = a.split_at_mut(at(i, 0));
            let row = &mut lower[..=i];
            if j < i {
                let other = &upper[at(j, 0)..=at(j, j)];
                row[j] = (row[j] - dot(&row[..j], &other[..j])) / other[j];
            } else {
                let rest = row[i] - dot(&row[..i], &row[..i]);
                // What rounding leaves of a singular matrix is no pivot.
                if rest.is_nan() || rest <= 1e-14 * row[i] {
                    return false;
                }
                row[i] = rest.sqrt();
            }
        }
    }
    true
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

/// x with A x = b; `None` where A is not positive definite.
pub(super) fn solve(mut a: Vec<f64>, mut b: Vec<f64>, n: usize) -> Option<Vec<f64>> {
    if !factorise(&mut a, n) {
        return None;
    }
    for i in 0..n {
        let row = &a[at(i, 0)..=at(i, i)];
        b[i] = (b[i] - dot(&row[..i], &b[..i])) / row[i];
    }
    for i in (0..n).rev() {
        let row = &a[at(i, 0)..=at(i, i)];
        b[i] /= row[i];
        let x = b[i];
        for (value, l) in b[..i].iter_mut().zip(row) {
            *value -= l * x;
        }
    }
    b.iter().all(|v| v.is_finite()).then_some(b)
}

/// The diagonal blocks of A^-1, `ranges` of the unknowns: each the product of columns of L^-1.
pub(super) fn inverse(mut a: Vec<f64>, n: usize) -> Option<Vec<f64>> {
    if !factorise(&mut a, n) {
        return None;
    }
    // L^-1, row by row, then (L^-1)^T L^-1.
    let mut m = vec![0.0; a.len()];
    for i in 0..n {
        let row = &a[at(i, 0)..=at(i, i)];
        let (before, rest) = m.split_at_mut(at(i, 0));
        let own = &mut rest[..=i];
        for (k, l) in row[..i].iter().enumerate() {
            for (value, other) in own.iter_mut().zip(&before[at(k, 0)..=at(k, k)]) {
                *value -= l * other;
            }
        }
        own.iter_mut().for_each(|v| *v /= row[i]);
        own[i] = 1.0 / row[i];
    }
    let mut inverse = vec![0.0; a.len()];
    for k in 0..n {
        let row = &m[at(k, 0)..=at(k, k)];
        for i in 0..=k {
            let factor = row[i];
            for (value, other) in inverse[at(i, 0)..=at(i, i)].iter_mut().zip(row) {
                *value += factor * other;
            }
        }
    }
    inverse.iter().all(|v| v.is_finite()).then_some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::structure_from_motion::random::Random;

    #[test]
    fn a_system_is_solved_and_inverted() {
        let n = 13;
        let mut random = Random::new(3);
        let m: Vec<Vec<f64>> = (0..n)
            .map(|_| (0..n + 2).map(|_| random.signed()).collect())
            .collect();
        let mut a = vec![0.0; n * (n + 1) / 2];
        for i in 0..n {
            for j in 0..=i {
                a[at(i, j)] = m[i].iter().zip(&m[j]).map(|(x, y)| x * y).sum();
            }
        }
        let element = |a: &[f64], i: usize, j: usize| a[at(i.max(j), i.min(j))];
        let truth: Vec<f64> = (0..n).map(|i| i as f64 - 4.5).collect();
        let b = (0..n).map(|i| (0..n).map(|j| element(&a, i, j) * truth[j]).sum());
        let x = solve(a.clone(), b.collect(), n).unwrap();
        assert!(x.iter().zip(&truth).all(|(p, q)| (p - q).abs() < 1e-8));
        let inverse = inverse(a.clone(), n).unwrap();
        for i in 0..n {
            for j in 0..n {
                let one: f64 = (0..n)
                    .map(|k| element(&a, i, k) * element(&inverse, k, j))
                    .sum();
                assert!((one - f64::from(u8::from(i == j))).abs() < 1e-7);
            }
        }
        a[at(5, 5)] = -1.0;
        assert!(solve(a, vec![0.0; n], n).is_none());
    }
}
