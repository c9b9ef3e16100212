//! One 3D line fitted to its image segments (B99 3.2, figure 4): least squares of the distances
//! between measured segments and the image of the line.
//!
//! The line has four parameters: the offsets of two anchor points in the two directions across it,
//! in metres. That is minimal, free of singularities for the small steps taken here, and its
//! covariance is that of the end points directly. The offsets are applied and the frame rebuilt
//! after each step. The loss is Cauchy's, so that one wrong segment among several views does not
//! move the line.

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

use super::observation::{Observation, PlaneConstraint, WhitenedObservation, line_frame};
use crate::base::geometry::Segment3;
use crate::base::least_squares::{Loss, NormalEquations, Stop, fit, variance_of_unit_weight};
use crate::base::params::Lines3dParams;

/// Weight of the prior that the stated covariances are right, in residuals.
const SCATTER_PRIOR: f64 = 4.0;

/// A fitted 3D line.
#[derive(Clone, Debug)]
pub struct LineFit {
    /// The line, with the anchors as its end points, metres.
    pub line: Segment3,
    /// Two unit vectors across the line.
    pub across: [Vector3<f64>; 2],
    /// Covariance of (start along `across[0]`, start along `across[1]`, end likewise), m^2.
    pub covariance: Matrix4<f64>,
    /// Length of the whitened residual of each observation, in standard deviations (two values in
    /// one).
    pub residuals: Vec<f64>,
}

impl LineFit {
    /// Covariance across the line of the point at fraction `t` (0 start, 1 end), 3 x 3, m^2.
    pub fn covariance_at(&self, t: f64) -> Matrix3<f64> {
        let c = &self.covariance;
        let (s, e) = (1.0 - t, t);
        let start = c.fixed_view::<2, 2>(0, 0);
        let end = c.fixed_view::<2, 2>(2, 2);
        let both = c.fixed_view::<2, 2>(0, 2);
        let m = start * (s * s) + end * (e * e) + (both + both.transpose()) * (s * e);
        let [u, v] = self.across;
        u * u.transpose() * m[(0, 0)]
            + v * v.transpose() * m[(1, 1)]
            + (u * v.transpose() + v * u.transpose()) * (0.5 * (m[(0, 1)] + m[(1, 0)]))
    }

    /// Standard deviation across the line at fraction `t`, metres, in the worst direction.
    pub fn sigma_at(&self, t: f64) -> f64 {
        let values = self.covariance_at(t).symmetric_eigenvalues();
        values.max().max(0.0).sqrt()
    }
}

/// Fits the line to the observations, starting at `initial`. `None` with fewer than two
/// observations or when they leave the line undetermined.
pub fn fit_line(
    observations: &[Observation],
    initial: &Segment3,
    params: &Lines3dParams,
) -> Option<LineFit> {
    fit_line_on(observations, &[], initial, params)
}

/// The same for a line that lies in known planes, which determine it where the observations alone
/// do not: the border of a roof along the baseline of two views.
pub fn fit_line_on(
    observations: &[Observation],
    constraints: &[PlaneConstraint],
    initial: &Segment3,
    params: &Lines3dParams,
) -> Option<LineFit> {
    if observations.len() < 2 || initial.length() < 1e-6 {
        return None;
    }
    let whitened: Vec<_> = observations
        .iter()
        .map(|o| WhitenedObservation::new(o, params))
        .collect();
    let loss = Loss::Cauchy(params.loss_scale);
    let linearised = |line: &Segment3| normal_equations(&whitened, constraints, line, loss);
    let (line, equations) = fit(*initial, linearised, displaced, Stop::default())?;
    let across = line_frame(&line.direction());
    let residuals = whitened
        .iter()
        .map(|o| Some(o.residual(&line, &across)?.0.norm()));
    let redundancy = 2.0 * (whitened.len() + constraints.len()) as f64 - 4.0;
    let variance = variance_of_unit_weight(equations.cost, redundancy, SCATTER_PRIOR);
    Some(LineFit {
        line,
        across,
        // Where nothing determines the line, rounding may leave the information indefinite.
        covariance: equations.inverse()? * variance,
        residuals: residuals.collect::<Option<_>>()?,
    })
}

/// How well observations would determine a line if they agreed with it: [`LineFit`] without
/// fitting, residuals or scatter. `None` when they leave it undetermined.
pub fn conditioning(
    observations: &[Observation],
    line: &Segment3,
    params: &Lines3dParams,
) -> Option<LineFit> {
    let whitened: Vec<_> = observations
        .iter()
        .map(|o| WhitenedObservation::new(o, params))
        .collect();
    Some(LineFit {
        line: *line,
        across: line_frame(&line.direction()),
        covariance: normal_equations(&whitened, &[], line, Loss::Squares)?.inverse()?,
        residuals: Vec::new(),
    })
}

fn normal_equations(
    observations: &[WhitenedObservation],
    constraints: &[PlaneConstraint],
    line: &Segment3,
    loss: Loss,
) -> Option<NormalEquations<4>> {
    let across = line_frame(&line.direction());
    let mut equations = NormalEquations::default();
    for o in observations {
        let (r, j) = o.residual(line, &across)?;
        equations.add(&r, &j.transpose(), loss);
    }
    for constraint in constraints {
        let (r, j) = constraint.residual(line, &across);
        equations.add(&r, &j.transpose(), loss);
    }
    Some(equations)
}

/// The line with its ends moved in the two directions across it.
fn displaced(line: &Segment3, step: &Vector4<f64>) -> Segment3 {
    let [u, v] = line_frame(&line.direction());
    Segment3::new(
        line.p0 + u * step[0] + v * step[1],
        line.p1 + u * step[2] + v * step[3],
    )
}

#[cfg(test)]
mod tests {
    use super::super::plane_intersection::line_of_planes;
    use super::*;
    use crate::base::geometry::{Plane, Segment2};
    use crate::base::least_squares::worst_derivative;
    use crate::photographs::camera::Camera;
    use crate::photographs::camera::testing::crop_camera;
    use nalgebra::{Matrix2, Point2, Point3, Vector2};

    fn cameras() -> Vec<Camera> {
        [
            (-280.0, -200.0, 0.0),
            (0.0, -190.0, 0.1),
            (310.0, -200.0, 0.0),
            (10.0, 190.0, 3.1),
        ]
        .map(|(x, y, kappa)| crop_camera(x, y, kappa))
        .to_vec()
    }

    fn planted() -> Segment3 {
        Segment3::new(Point3::new(-3.0, 2.0, 8.0), Point3::new(5.0, 6.0, 9.5))
    }

    /// Reproducible numbers of variance one, roughly normal.
    fn noise(seed: &mut u64) -> f64 {
        let mut sum = 0.0;
        for _ in 0..12 {
            *seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            sum += (*seed >> 11) as f64 / (1u64 << 53) as f64;
        }
        sum - 6.0
    }

    /// The planted line as each camera measures it, with `sigma_px` of noise at the ends; pieces,
    /// not the whole, as detectors give.
    fn observe<'a>(cameras: &'a [Camera], sigma_px: f64, seed: &mut u64) -> Vec<Observation<'a>> {
        cameras
            .iter()
            .enumerate()
            .map(|(i, camera)| {
                let part = (0.05 * i as f64, 1.0 - 0.1 * i as f64);
                let exact = Segment2::new(
                    camera.project(&planted().at(part.0)).unwrap(),
                    camera.project(&planted().at(part.1)).unwrap(),
                );
                let n = exact.normal();
                let shift = |p: Point2<f64>, seed: &mut u64| p + n * (sigma_px * noise(seed));
                let segment = Segment2::new(shift(exact.p0, seed), shift(exact.p1, seed));
                let (s2, length) = (sigma_px * sigma_px, exact.length());
                let covariance = Matrix2::new(0.5 * s2, 0.0, 0.0, 2.0 * s2 / (length * length));
                Observation {
                    camera,
                    segment,
                    covariance,
                }
            })
            .collect()
    }

    #[test]
    fn a_plane_determines_a_line_along_the_baseline() {
        let all = cameras();
        let cameras = [all[0].clone(), all[2].clone()];
        let baseline = cameras[1].center - cameras[0].center;
        let start = Point3::new(-3.0, 2.0, 8.0);
        let line = Segment3::new(start, start + baseline.normalize() * 9.0);
        let covariance = Matrix2::new(0.01, 0.0, 0.0, 1e-6);
        let observe = |camera| -> Observation {
            let project = |p| Camera::project(camera, p).unwrap();
            let segment = Segment2::new(project(&line.p0), project(&line.p1));
            Observation {
                camera,
                segment,
                covariance,
            }
        };
        let observations = [observe(&cameras[0]), observe(&cameras[1])];
        let raised = |by: f64| Vector3::z() * by;
        let initial = Segment3::new(line.p0 + raised(0.4), line.p1 + raised(-0.3));
        let params = Lines3dParams::default();
        let free = fit_line(&observations, &initial, &params);
        let free_sigma = free.map_or(f64::INFINITY, |fit| fit.sigma_at(0.5));
        assert!(free_sigma > 10.0, "{free_sigma}");
        let roof =
            Plane::from_point_normal(&line.p0, &baseline.cross(&Vector3::new(1.0, 3.0, 0.5)));
        let constraint = PlaneConstraint {
            plane: roof.unwrap().upwards(),
            sigma_m: 0.02,
        };
        let fit = fit_line_on(&observations, &[constraint], &initial, &params).unwrap();
        for p in [fit.line.p0, fit.line.p1] {
            assert!(line.line_distance(&p) < 1e-3, "{}", line.line_distance(&p));
        }
        // No more certain than the plane, and not much less: the views fix it across the slope.
        let sigma = fit.sigma_at(0.5);
        assert!(sigma > 0.01 && sigma < 0.1, "{sigma}");
    }

    #[test]
    fn exact_observations_give_the_planted_line() {
        let cameras = cameras();
        let observations = observe(&cameras, 0.0, &mut 1);
        let start = line_of_planes(&observations).unwrap();
        let off = Segment3::new(
            start.p0 + Vector3::new(0.3, -0.2, 0.8),
            start.p1 + Vector3::new(-0.2, 0.1, -0.5),
        );
        for initial in [start, off] {
            let fit = fit_line(&observations, &initial, &Lines3dParams::default()).unwrap();
            for p in [fit.line.p0, fit.line.p1] {
                assert!(planted().line_distance(&p) < 1e-5);
            }
        }
    }

    #[test]
    fn jacobian_agrees_with_differences() {
        let cameras = cameras();
        let observations = observe(&cameras, 0.3, &mut 7);
        let line = planted();
        let across = line_frame(&line.direction());
        for o in &observations {
            let o = WhitenedObservation::new(o, &Lines3dParams::default());
            let at = |line: &Segment3| o.residual(line, &across).unwrap();
            let jacobian = at(&line).1.transpose();
            let off = worst_derivative(&jacobian, |step| at(&displaced(&line, step)).0);
            assert!(off < 1e-4, "{off}");
        }
    }

    #[test]
    fn sigma_is_calibrated() {
        let cameras = cameras();
        let params = Lines3dParams {
            position_floor_px: 1e-3,
            edge_floor_px: 1e-3,
            ..Lines3dParams::default()
        };
        let (mut seed, mut sum, mut count) = (5u64, 0.0, 0.0);
        for _ in 0..300 {
            let observations = observe(&cameras, 0.2, &mut seed);
            let start = line_of_planes(&observations).unwrap();
            let fit = fit_line(&observations, &start, &params).unwrap();
            // Error of the middle across the line, against its covariance: two degrees of freedom.
            let middle = fit.line.at(0.5);
            let d = planted().direction();
            let foot = planted().p0 + d * (middle - planted().p0).dot(&d);
            let [u, v] = fit.across;
            let e = Vector2::new((middle - foot).dot(&u), (middle - foot).dot(&v));
            let c = fit.covariance_at(0.5);
            let c2 = Matrix2::new(
                (u.transpose() * c * u)[0],
                (u.transpose() * c * v)[0],
                (v.transpose() * c * u)[0],
                (v.transpose() * c * v)[0],
            );
            sum += (e.transpose() * c2.try_inverse().unwrap() * e)[0];
            count += 1.0;
        }
        let mean = sum / count;
        assert!(
            (1.4..2.6).contains(&mean),
            "squared error over variance {mean}, expected 2"
        );
    }

    #[test]
    fn one_wrong_segment_does_not_move_the_line() {
        let cameras = cameras();
        let mut observations = observe(&cameras, 0.05, &mut 3);
        let wrong = &mut observations[1].segment;
        (wrong.p0.x, wrong.p1.x) = (wrong.p0.x + 6.0, wrong.p1.x + 6.0);
        (wrong.p0.y, wrong.p1.y) = (wrong.p0.y + 6.0, wrong.p1.y + 6.0);
        let fit = fit_line(&observations, &planted(), &Lines3dParams::default()).unwrap();
        assert!(planted().line_distance(&fit.line.at(0.5)) < 0.1);
        assert!(fit.residuals[1] > 10.0);
    }

    #[test]
    fn the_weight_of_an_observation_falls_with_its_distance_from_the_line() {
        let camera = &cameras()[0];
        let image = [planted().p0, planted().p1].map(|p| camera.project(&p).expect("in front"));
        let params = Lines3dParams {
            position_floor_px: 0.0,
            ..Lines3dParams::default()
        };
        let weight = |beside_px: f64| {
            let segment = Segment2::new(image[0], image[1]);
            let across = segment.normal() * beside_px;
            let observation = Observation {
                camera,
                segment: Segment2::new(segment.p0 + across, segment.p1 + across),
                covariance: Matrix2::from_diagonal_element(0.25),
            };
            observation.weight(&planted(), &params)
        };
        assert!((weight(0.0) - 1.0).abs() < 1e-9);
        // Two standard deviations, and the loss's scale.
        for e in [2.0, params.loss_scale] {
            let relative = e / params.loss_scale;
            let expected = 1.0 / (1.0 + relative * relative);
            assert!((weight(0.5 * e) - expected).abs() < 1e-6);
            assert!((weight(-0.5 * e) - expected).abs() < 1e-6);
        }
    }

    #[test]
    fn parallel_planes_fix_no_line() {
        let cameras = vec![crop_camera(0.0, 0.0, 0.0), crop_camera(0.0, 0.0, 0.0)];
        assert!(line_of_planes(&observe(&cameras, 0.0, &mut 1)).is_none());
        assert!(fit_line(&[], &planted(), &Lines3dParams::default()).is_none());
    }
}
