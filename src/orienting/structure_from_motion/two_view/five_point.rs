//! Essential matrices through five matches (Nister 2004, "An efficient solution to the five-point
//! relative pose problem"): the null space of the epipolar constraints, ten cubic equations, and
//! the roots of a polynomial of degree ten.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::orienting::structure_from_motion::linear::{null_space, real_roots};

/// Monomials of degree 3 in x, y, z in Nister's order, as powers: the ten to eliminate first.
const CUBIC: [[u8; 3]; 20] = [
    [3, 0, 0],
    [0, 3, 0],
    [2, 1, 0],
    [1, 2, 0],
    [2, 0, 1],
    [2, 0, 0],
    [0, 2, 1],
    [0, 2, 0],
    [1, 1, 1],
    [1, 1, 0],
    [1, 0, 2],
    [1, 0, 1],
    [1, 0, 0],
    [0, 1, 2],
    [0, 1, 1],
    [0, 1, 0],
    [0, 0, 3],
    [0, 0, 2],
    [0, 0, 1],
    [0, 0, 0],
];

/// Monomials of degree 2.
const QUADRATIC: [[u8; 3]; 10] = [
    [2, 0, 0],
    [1, 1, 0],
    [0, 2, 0],
    [1, 0, 1],
    [0, 1, 1],
    [0, 0, 2],
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    [0, 0, 0],
];

/// Those of degree 1.
const LINEAR: [[u8; 3]; 4] = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]];

const fn place<const N: usize>(list: &[[u8; 3]; N], m: [u8; 3]) -> usize {
    let mut i = 0;
    while !(list[i][0] == m[0] && list[i][1] == m[1] && list[i][2] == m[2]) {
        i += 1;
    }
    i
}

/// Where the products of the monomials of two lists stand in a third one.
const fn products<const A: usize, const B: usize, const C: usize>(
    first: &[[u8; 3]; A],
    second: &[[u8; 3]; B],
    list: &[[u8; 3]; C],
) -> [[usize; B]; A] {
    let mut table = [[0; B]; A];
    let mut i = 0;
    while i < A {
        let mut j = 0;
        while j < B {
            let (p, q) = (first[i], second[j]);
            table[i][j] = place(list, [p[0] + q[0], p[1] + q[1], p[2] + q[2]]);
            j += 1;
        }
        i += 1;
    }
    table
}

const LINEAR_TIMES_LINEAR: [[usize; 4]; 4] = products(&LINEAR, &LINEAR, &QUADRATIC);
const QUADRATIC_TIMES_LINEAR: [[usize; 4]; 10] = products(&QUADRATIC, &LINEAR, &CUBIC);

type Linear = [f64; 4];
type Quadratic = [f64; 10];
type Cubic = SVector<f64, 20>;

fn times(a: &Linear, b: &Linear) -> Quadratic {
    let mut product = [0.0; 10];
    for i in 0..4 {
        for j in 0..4 {
            product[LINEAR_TIMES_LINEAR[i][j]] += a[i] * b[j];
        }
    }
    product
}

fn times_linear(a: &Quadratic, b: &Linear) -> Cubic {
    let mut product = Cubic::zeros();
    for i in 0..10 {
        for j in 0..4 {
            product[QUADRATIC_TIMES_LINEAR[i][j]] += a[i] * b[j];
        }
    }
    product
}

fn sum(a: &Quadratic, b: &Quadratic, factor: f64) -> Quadratic {
    std::array::from_fn(|i| a[i] + factor * b[i])
}

/// All essential matrices E with `b^T E a = 0` for five pairs of rays `(a, b)`, of norm sqrt(2).
pub(super) fn essential_matrices(rays: &[(Vector3<f64>, Vector3<f64>); 5]) -> Vec<Matrix3<f64>> {
    let constraints = SMatrix::<f64, 5, 9>::from_fn(|k, i| {
        let (a, b) = &rays[k];
        b[i / 3] * a[i % 3]
    });
    let Some(basis) = null_space::<5, 9, 4>(&constraints) else {
        return Vec::new();
    };
    // E = x X + y Y + z Z + W, each element linear in x, y, z.
    let e = |r: usize, c: usize| -> Linear { std::array::from_fn(|n| basis[n][3 * r + c]) };
    let e: [[Linear; 3]; 3] = std::array::from_fn(|r| std::array::from_fn(|c| e(r, c)));
    let Some(reduced) = eliminated(&cubic_constraints(&e)) else {
        return Vec::new();
    };
    let rows = [[4, 5], [6, 7], [8, 9]].map(|[upper, lower]| polynomials(&reduced, upper, lower));
    let mut found = Vec::new();
    for z in real_roots(&determinant(&rows)) {
        let at: [Vector3<f64>; 3] = rows
            .each_ref()
            .map(|row| Vector3::from_fn(|i, _| evaluate(&row[i], z)));
        let crossed = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| at[i].cross(&at[j]));
        let v = crossed.into_iter().fold(
            Vector3::zeros(),
            |a, b| if b.norm() > a.norm() { b } else { a },
        );
        if v.z.abs() < 1e-12 * v.norm() {
            continue;
        }
        let (x, y) = (v.x / v.z, v.y / v.z);
        let vector = basis[0] * x + basis[1] * y + basis[2] * z + basis[3];
        let norm = vector.norm();
        if norm.is_finite() && norm > 0.0 {
            let matrix = Matrix3::from_fn(|r, c| vector[3 * r + c]);
            found.push(matrix * (std::f64::consts::SQRT_2 / norm));
        }
    }
    found
}

/// det E = 0 and 2 E E^T E - tr(E E^T) E = 0: ten equations.
fn cubic_constraints(e: &[[Linear; 3]; 3]) -> SMatrix<f64, 10, 20> {
    let mut equations = SMatrix::<f64, 10, 20>::zeros();
    // E E^T - tr / 2.
    let mut squares = [[[0.0; 10]; 3]; 3];
    for (r, row) in squares.iter_mut().enumerate() {
        for (c, square) in row.iter_mut().enumerate() {
            *square = (0..3).fold([0.0; 10], |s, k| sum(&s, &times(&e[r][k], &e[c][k]), 1.0));
        }
    }
    let trace = (0..3).fold([0.0; 10], |s, i| sum(&s, &squares[i][i], 1.0));
    for (i, row) in squares.iter_mut().enumerate() {
        row[i] = sum(&row[i], &trace, -0.5);
    }
    for (r, row) in squares.iter().enumerate() {
        for c in 0..3 {
            let equation = (row.iter().zip(e)).fold(Cubic::zeros(), |s, (square, e)| {
                s + times_linear(square, &e[c])
            });
            equations.set_row(3 * r + c, &equation.transpose());
        }
    }
    let minor = |c0: usize, c1: usize| {
        let (p, q) = (times(&e[1][c0], &e[2][c1]), times(&e[1][c1], &e[2][c0]));
        sum(&p, &q, -1.0)
    };
    let determinant = times_linear(&minor(1, 2), &e[0][0]) - times_linear(&minor(0, 2), &e[0][1])
        + times_linear(&minor(0, 1), &e[0][2]);
    equations.set_row(9, &determinant.transpose());
    equations
}

/// Gauss-Jordan elimination of the first ten columns; the other ten.
fn eliminated(equations: &SMatrix<f64, 10, 20>) -> Option<SMatrix<f64, 10, 10>> {
    let mut m = *equations;
    for k in 0..10 {
        let pivot = (k..10).fold(k, |best, r| {
            if m[(r, k)].abs() > m[(best, k)].abs() {
                r
            } else {
                best
            }
        });
        if m[(pivot, k)].abs() <= 1e-14 {
            return None;
        }
        m.swap_rows(k, pivot);
        let factor = 1.0 / m[(k, k)];
        for c in k..20 {
            m[(k, c)] *= factor;
        }
        for r in 0..10 {
            let factor = m[(r, k)];
            if r != k && factor != 0.0 {
                for c in k..20 {
                    m[(r, c)] -= factor * m[(k, c)];
                }
            }
        }
    }
    Some(m.fixed_view::<10, 10>(0, 10).into_owned())
}

/// A polynomial in z, lowest power first.
type InZ = [f64; 5];

/// Row `upper` minus z times row `lower`: coefficients of x, y and 1, polynomials in z.
fn polynomials(m: &SMatrix<f64, 10, 10>, upper: usize, lower: usize) -> [InZ; 3] {
    let (e, f) = (m.row(upper), m.row(lower));
    [
        [e[2], e[1] - f[2], e[0] - f[1], -f[0], 0.0],
        [e[5], e[4] - f[5], e[3] - f[4], -f[3], 0.0],
        [e[9], e[8] - f[9], e[7] - f[8], e[6] - f[7], -f[6]],
    ]
}

fn evaluate(p: &InZ, z: f64) -> f64 {
    p.iter().rev().fold(0.0, |sum, c| sum * z + c)
}

/// The determinant of a matrix of polynomials, highest power first.
fn determinant(rows: &[[InZ; 3]; 3]) -> Vec<f64> {
    let mut total = [0.0; 13];
    for (signs, [a, b, c]) in [
        (1.0, [0, 1, 2]),
        (1.0, [1, 2, 0]),
        (1.0, [2, 0, 1]),
        (-1.0, [2, 1, 0]),
        (-1.0, [1, 0, 2]),
        (-1.0, [0, 2, 1]),
    ] {
        let mut pair = [0.0; 9];
        for (i, p) in rows[0][a].iter().enumerate() {
            for (j, q) in rows[1][b].iter().enumerate() {
                pair[i + j] += p * q;
            }
        }
        for (i, p) in pair.iter().enumerate() {
            for (j, q) in rows[2][c].iter().enumerate() {
                total[i + j] += signs * p * q;
            }
        }
    }
    // Two of the columns are of degree 3, one of degree 4.
    total[..=10].iter().rev().copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::rotation_from_axis_angle;
    use crate::orienting::structure_from_motion::random::Random;

    #[test]
    fn the_true_matrix_is_among_the_solutions() {
        let mut random = Random::new(21);
        for _ in 0..50 {
            let any = |random: &mut Random| Vector3::from_fn(|_, _| random.signed());
            let r = rotation_from_axis_angle(&(any(&mut random) * 0.8));
            let t = any(&mut random).normalize();
            let rays: [(Vector3<f64>, Vector3<f64>); 5] = std::array::from_fn(|_| {
                let a = Vector3::new(0.6 * random.signed(), 0.6 * random.signed(), 1.0);
                let seen = r * (a * (4.0 + 2.0 * random.signed())) + t;
                (a, seen / seen.z)
            });
            let truth = t.cross_matrix() * r.matrix();
            let found = essential_matrices(&rays);
            assert!(!found.is_empty() && found.len() <= 10);
            let nearest = found
                .iter()
                .map(|e| (e - truth).norm().min((e + truth).norm()))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-4, "{nearest}");
            for e in &found {
                for (a, b) in &rays {
                    assert!((b.transpose() * e * a)[0].abs() < 1e-8);
                }
                let cubic = e * e.transpose() * e * 2.0 - e * (e * e.transpose()).trace();
                assert!(cubic.norm() < 1e-4, "{}", cubic.norm());
            }
        }
    }
}
