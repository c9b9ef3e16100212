//! A similarity by robust least squares to places of which the plan, the height or both are known,
//! together with the lag of receivers; and what its scale and level are worth.
//!
//! ```text
//! r = (c + (1 + ds) R(w) (p - c) + dt - (X + lag v)) / sigma    p = s R x + t, X stated
//! C = N^-1 (s_p^2 N_p + s_h^2 N_h) N^-1,   N = N_p + N_h        plan and height apart
//! ```
//!
//! The unknowns are ds, the turn w, the shift dt and the lag; c is the middle of the places. Where
//! a receiver states positions late, they are those of the path that was flown `lag` before.

use nalgebra::{Matrix2, Point3, SMatrix, SVector, SymmetricEigen, Vector3};

use super::similarity::Similarity;
use crate::base::geometry::{mean_point, rotation_from_axis_angle};
use crate::base::least_squares::{Loss, NormalEquations, Stop, fit as least_squares};
use crate::orienting::orientation::FrameSigma;

/// What is known of a place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum KnownOf {
    /// Plan and height.
    #[default]
    All,
    /// The plan alone.
    Plan,
    /// The height alone.
    Height,
}

impl KnownOf {
    /// Of x, y and z: is it known?
    pub(super) fn axes(self) -> [bool; 3] {
        let [plan, height] = [self != Self::Height, self != Self::Plan];
        [plan, plan, height]
    }

    /// A vector without what is not known.
    pub(super) fn only(self, v: &Vector3<f64>) -> Vector3<f64> {
        let axes = self.axes();
        Vector3::from_fn(|i, _| if axes[i] { v[i] } else { 0.0 })
    }
}

/// A place of the block, and where it is known to be.
#[derive(Clone, Debug)]
pub(super) struct Tie {
    pub from: Point3<f64>,
    pub to: Point3<f64>,
    pub known: KnownOf,
    /// Standard deviation of a component, metres.
    pub sigma_m: f64,
    /// By how much the place moves in a unit of the lag; zero where there is none.
    pub velocity: Vector3<f64>,
}

/// Which unknowns of a fit are free beside scale, azimuth and shift.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Free {
    /// Where up is; else there is only a turn about it.
    pub up: bool,
    pub lag: bool,
}

impl Free {
    /// Of ds, w, dt, lag: is it held?
    fn held(self) -> [bool; 8] {
        [
            false, !self.up, !self.up, false, false, false, false, !self.lag,
        ]
    }
}

impl Tie {
    /// Placed minus known, metres; what is not known is 0.
    pub(super) fn off(&self, similarity: &Similarity, lag: f64) -> Vector3<f64> {
        let known = self.to + self.velocity * lag;
        self.known.only(&(similarity.point(&self.from) - known))
    }

    /// The residual in standard deviations, with its derivatives by the unknowns.
    fn linearised(
        &self,
        similarity: &Similarity,
        lag: f64,
        middle: &Point3<f64>,
        held: [bool; 8],
    ) -> (Vector3<f64>, SMatrix<f64, 3, 8>) {
        let arm = similarity.point(&self.from) - middle;
        let mut by = SMatrix::<f64, 3, 8>::zeros();
        by.set_column(0, &arm);
        for axis in 0..3 {
            let mut unit = Vector3::zeros();
            unit[axis] = 1.0;
            by.set_column(1 + axis, &unit.cross(&arm));
            by.set_column(4 + axis, &unit);
        }
        by.set_column(7, &-self.velocity);
        let axes = self.known.axes();
        let counts = |row: usize, column: usize| axes[row] && !held[column];
        let by = by.map_with_location(|row, column, d| match counts(row, column) {
            true => d / self.sigma_m,
            false => 0.0,
        });
        (self.off(similarity, lag) / self.sigma_m, by)
    }
}

/// The middle of where the places are known to be.
fn middle_of(ties: &[Tie]) -> Point3<f64> {
    mean_point(&ties.iter().map(|tie| tie.to).collect::<Vec<_>>())
}

/// Adds a residual of 0 for each unknown that is held.
fn hold(equations: &mut NormalEquations<8>, held: [bool; 8]) {
    for i in (0..8).filter(|&i| held[i]) {
        let mut row = SMatrix::<f64, 1, 8>::zeros();
        row[i] = 1.0;
        equations.add_weighted(&SVector::<f64, 1>::zeros(), &row, 1.0);
    }
}

/// The similarity of least cost near a start, and the lag; `None` where the places leave an unknown
/// open.
pub(super) fn fitted(
    start: &Similarity,
    ties: &[Tie],
    free: Free,
    loss: Loss,
) -> Option<(Similarity, f64)> {
    let (middle, held) = (middle_of(ties), free.held());
    let linearised = |(similarity, lag): &(Similarity, f64)| {
        let mut equations = NormalEquations::default();
        for tie in ties {
            let (residual, by) = tie.linearised(similarity, *lag, &middle, held);
            equations.add(&residual, &by, loss);
        }
        hold(&mut equations, held);
        Some(equations)
    };
    let moved = |(similarity, lag): &(Similarity, f64), step: &SVector<f64, 8>| {
        let turn = rotation_from_axis_angle(&step.fixed_rows::<3>(1).into_owned());
        let (stretch, shift) = (1.0 + step[0], step.fixed_rows::<3>(4));
        let from_middle = similarity.shift - middle.coords;
        let next = Similarity {
            scale: similarity.scale * stretch,
            rotation: turn * similarity.rotation,
            shift: middle.coords + turn * from_middle * stretch + shift,
        };
        (next, lag + step[7])
    };
    let (found, equations) =
        least_squares((start.clone(), 0.0), linearised, moved, Stop::default())?;
    equations.inverse()?;
    (found.0.scale > 0.0).then_some(found)
}

/// What a fit is worth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worth {
    pub frame: FrameSigma,
    /// Standard deviation of the lag.
    pub lag: f64,
}

/// What a fit by these places is worth, by their residuals in plan and in height: the standard
/// deviations that are stated count as one residual each. `None` where they leave an unknown open.
pub(super) fn worth(ties: &[Tie], similarity: &Similarity, lag: f64, free: Free) -> Option<Worth> {
    let (middle, is_held) = (middle_of(ties), free.held());
    let mut whole = NormalEquations::default();
    let mut parts = [SMatrix::<f64, 8, 8>::zeros(); 2];
    let (mut squares, mut known) = ([0.0; 2], [0usize; 2]);
    for tie in ties {
        let (residual, by) = tie.linearised(similarity, lag, &middle, is_held);
        whole.add_weighted(&residual, &by, 1.0);
        for (row, is_known) in tie.known.axes().into_iter().enumerate() {
            let part = usize::from(row == 2);
            parts[part] += by.row(row).transpose() * by.row(row);
            squares[part] += residual[row] * residual[row];
            known[part] += usize::from(is_known);
        }
    }
    hold(&mut whole, is_held);
    // Scale, turn, shift and lag follow from the plan, the level from the heights.
    let of_part = [[0, 3, 4, 5, 7].as_slice(), &[1, 2, 6]];
    let mut spread = SMatrix::<f64, 8, 8>::zeros();
    for part in 0..2 {
        let unknowns = of_part[part].iter().filter(|&&i| !is_held[i]).count();
        // One more residual as large as it should be: without redundancy nothing else is known.
        let more = known[part].saturating_sub(unknowns) + 1;
        spread += parts[part] * ((squares[part] + 1.0) / more as f64);
    }
    let inverse = whole.inverse()?;
    let covariance = inverse * spread * inverse;
    let tilts: Matrix2<f64> = covariance.fixed_view::<2, 2>(1, 1).into_owned();
    let tilt = SymmetricEigen::new(tilts).eigenvalues.max().max(0.0).sqrt();
    let scale = covariance[(0, 0)].sqrt();
    Some(Worth {
        frame: FrameSigma::of(Some(scale), free.up.then_some(tilt)),
        lag: covariance[(7, 7)].sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::least_squares::worst_derivative;
    use crate::orienting::structure_from_motion::random::Random;

    const SIGMA_M: f64 = 0.5;

    const BOTH: Free = Free {
        up: true,
        lag: true,
    };
    const NEITHER: Free = Free {
        up: false,
        lag: false,
    };

    fn planted() -> Similarity {
        Similarity {
            scale: 7.5,
            rotation: rotation_from_axis_angle(&Vector3::new(0.2, 1.4, -0.3)),
            shift: Vector3::new(300.0, -20.0, 8.0),
        }
    }

    /// Places over 120 x 60 m, some of them known in part, with noise and a lag of 2.
    fn ties(random: &mut Random, noise_m: f64) -> Vec<Tie> {
        let known = [KnownOf::All, KnownOf::Plan, KnownOf::All, KnownOf::Height];
        (0..24)
            .map(|i| {
                let mut place = Random::new(i);
                let from = Point3::new(8.0 * place.signed(), 4.0 * place.signed(), place.signed());
                let velocity = Vector3::new(place.signed(), place.signed(), 0.0) * 4.0;
                let noise = Vector3::from_fn(|_, _| noise_m * random.normal());
                Tie {
                    from,
                    to: planted().point(&from) - velocity * 2.0 + noise,
                    known: known[i as usize % 4],
                    sigma_m: SIGMA_M,
                    velocity,
                }
            })
            .collect()
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let ties = ties(&mut Random::new(1), SIGMA_M);
        let middle = middle_of(&ties);
        for tie in &ties {
            let (_, by) = tie.linearised(&planted(), 2.0, &middle, [false; 8]);
            let off = worst_derivative(&by, |step: &SVector<f64, 8>| {
                let turn = rotation_from_axis_angle(&step.fixed_rows::<3>(1).into_owned());
                let arm = planted().point(&tie.from) - middle;
                let shift = step.fixed_rows::<3>(4).into_owned();
                let place = middle + turn * arm * (1.0 + step[0]) + shift;
                let known = tie.to + tie.velocity * (2.0 + step[7]);
                tie.known.only(&(place - known)) / tie.sigma_m
            });
            assert!(off < 1e-6, "{off}");
        }
    }

    #[test]
    fn a_planted_similarity_and_lag_are_found_and_scatter_as_stated() {
        let exact = ties(&mut Random::new(1), 0.0);
        let start = Similarity {
            scale: 7.0,
            rotation: rotation_from_axis_angle(&Vector3::new(0.25, 1.3, -0.2)),
            shift: Vector3::new(280.0, -10.0, 0.0),
        };
        let (found, lag) = fitted(&start, &exact, BOTH, Loss::Cauchy(2.0)).unwrap();
        assert!((found.scale - 7.5).abs() < 1e-3 && (lag - 2.0).abs() < 1e-3);
        assert!((found.rotation.matrix() - planted().rotation.matrix()).norm() < 1e-3);
        let mut random = Random::new(2);
        let (mut scattered, mut stated) = ([0.0; 3], [0.0; 3]);
        let draws = 400;
        for _ in 0..draws {
            let noisy = ties(&mut random, SIGMA_M);
            let (s, lag) = fitted(&planted(), &noisy, BOTH, Loss::Squares).unwrap();
            let worth = worth(&noisy, &s, lag, BOTH).unwrap();
            let up = (s.rotation * planted().rotation.inverse()) * Vector3::z();
            // Two tilts, of which the larger is stated.
            let off = [s.scale / 7.5 - 1.0, up.xy().norm(), lag - 2.0];
            let sigma = [worth.frame.scale(), worth.frame.tilt(), worth.lag];
            for i in 0..3 {
                scattered[i] += off[i] * off[i] / f64::from(draws);
                stated[i] += sigma[i] / f64::from(draws);
            }
        }
        let [scale, tilt, lag] = [0, 1, 2].map(|i| stated[i] / scattered[i].sqrt());
        assert!((scale - 1.0).abs() < 0.2, "{scale}");
        assert!((lag - 1.0).abs() < 0.2, "{lag}");
        // Across a narrow place it tilts more than along it: the root of both is a little more.
        assert!((0.6..1.1).contains(&tilt), "{tilt}");
    }

    #[test]
    fn what_is_held_stays_and_what_is_open_gives_none() {
        let noisy = ties(&mut Random::new(3), SIGMA_M);
        let held = fitted(&planted(), &noisy, NEITHER, Loss::Squares).unwrap();
        let up = held.0.rotation * planted().rotation.inverse() * Vector3::z();
        assert!(held.1 == 0.0 && (up.z - 1.0).abs() < 1e-12);
        let sigma = worth(&noisy, &held.0, 0.0, Free { up: false, ..BOTH })
            .unwrap()
            .frame;
        assert_eq!((sigma.tilt(), sigma.height_over_10_m), (0.0, None));
        assert!(sigma.length_of_10_m.is_some());
        let mut still = noisy;
        (still.iter_mut()).for_each(|tie| tie.velocity = Vector3::zeros());
        assert!(fitted(&planted(), &still, BOTH, Loss::Squares).is_none());
        assert!(worth(&still, &planted(), 0.0, BOTH).is_none());
    }
}
