//! Least squares over tracks of matched points: shifts of the views, of which as few as possible
//! are freed.
//!
//! World points are eliminated track by track (Schur complement); rho is Huber's.

use nalgebra::{Matrix2, Matrix2x3, Matrix3, Point2, Point3, Vector2, Vector3};

use super::epipolar_check::EpipolarCheck;
use super::subpixel::{MIN_MATCHES, PointMatch};
use crate::base::least_squares::{EnvelopeEquations, Loss, NormalEquations, Pattern, Stop, fit};
use crate::photographs::camera::Camera;

/// Share of the cost that freeing a view must remove. Measured: at most 0.022 in correct scenes,
/// rendered and real; half a pixel in one of six views removes a third, and 1.5 px 0.043 among
/// photographs with residuals of a pixel.
const MIN_COST_REDUCTION: f64 = 0.035;

/// Most views that are tested at a time: those with the largest residuals.
const MAX_CANDIDATES: usize = 8;

/// Least redundancy (observations minus unknowns) of a scene.
const MIN_REDUNDANCY: usize = 60;

/// Magnitudes of the residuals.
pub(crate) struct ResidualScale {
    /// Standard deviation of a match, pixels.
    pub sigma_px: f64,
    /// Residuals beyond this count linearly, pixels.
    pub huber_px: f64,
    /// Residuals beyond this are wrong matches, pixels.
    pub gross_px: f64,
}

/// View and position of a match.
type ImagePoint = (usize, Point2<f64>);

/// Tracks of matches, in the views of these cameras.
pub(crate) struct ShiftAdjustment<'a> {
    tracks: Vec<Vec<ImagePoint>>,
    cameras: &'a [Camera],
    scale: ResidualScale,
}

impl<'a> ShiftAdjustment<'a> {
    /// One track for each interest point, its own position first; points whose rays do not meet are
    /// left out. `None` where the redundancy is too small.
    pub(super) fn new(
        check: &EpipolarCheck,
        matches: &[Vec<PointMatch>],
        cameras: &'a [Camera],
        scale: ResidualScale,
    ) -> Option<Self> {
        let mut tracks: Vec<(usize, usize, Vec<ImagePoint>)> = Vec::new();
        for (&(i, j), matches) in check.pairs.iter().zip(matches) {
            for found in matches {
                match tracks.iter_mut().find(|t| (t.0, t.1) == (i, found.point)) {
                    Some(track) => track.2.push((j, found.second)),
                    None => {
                        tracks.push((i, found.point, vec![(i, found.first), (j, found.second)]));
                    }
                }
            }
        }
        let mut adjustment = Self {
            tracks: Vec::new(),
            cameras,
            scale,
        };
        let tracks = tracks.into_iter().map(|t| t.2);
        adjustment.tracks = tracks.filter(|t| adjustment.meets(t)).collect();
        let observations: usize = adjustment.tracks.iter().map(Vec::len).sum();
        let unknowns = 3 * adjustment.tracks.len() + 2 * cameras.len();
        let free = (2 * observations).checked_sub(unknowns)?;
        (free >= MIN_REDUNDANCY).then_some(adjustment)
    }

    /// Frees views one by one, as long as each reduces the cost by much: free views are the
    /// exception.
    pub(super) fn free_views(&self) -> ShiftSolution {
        let mut best = ShiftSolution::none(self);
        let before = self.residuals(&best.shifts);
        while 2 * (best.free.len() + 1) <= self.cameras.len() {
            let next = candidates(&before, &best.free)
                .into_iter()
                .filter_map(|view| ShiftSolution::freeing(view, &best, self))
                .min_by(|a, b| a.cost.total_cmp(&b.cost));
            match next.filter(|next| next.cost < (1.0 - MIN_COST_REDUCTION) * best.cost) {
                Some(next) => best = next,
                None => break,
            }
        }
        best
    }

    /// Lengths of the residuals of each view under these shifts, pixels.
    pub(super) fn residuals(&self, shifts: &[Vector2<f64>]) -> Vec<Vec<f64>> {
        let mut lengths = vec![Vec::new(); self.cameras.len()];
        for track in &self.tracks {
            let Some(world) = self.triangulate(track, shifts) else {
                continue;
            };
            for observation in track {
                if let Some(r) = self.residual(observation, &world, shifts) {
                    lengths[observation.0].push(r.norm());
                }
            }
        }
        lengths
    }

    fn loss(&self) -> Loss {
        Loss::Huber(self.scale.huber_px)
    }

    fn meets(&self, track: &[ImagePoint]) -> bool {
        let none = vec![Vector2::zeros(); self.cameras.len()];
        let is_near = |observation: &ImagePoint, world: &Point3<f64>| {
            let r = self.residual(observation, world, &none);
            r.is_some_and(|r| r.norm() < self.scale.gross_px)
        };
        let world = self.triangulate(track, &none);
        world.is_some_and(|world| track.iter().all(|observation| is_near(observation, &world)))
    }

    /// x - (P X + s), pixels.
    fn residual(
        &self,
        (view, x): &ImagePoint,
        world: &Point3<f64>,
        shifts: &[Vector2<f64>],
    ) -> Option<Vector2<f64>> {
        Some(x - self.cameras[*view].project(world)? - shifts[*view])
    }

    /// The world point of a track: nearest to its rays, then least squares in the images.
    fn triangulate(&self, track: &[ImagePoint], shifts: &[Vector2<f64>]) -> Option<Point3<f64>> {
        let base = self.cameras[track[0].0].center;
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for (view, x) in track {
            let camera = &self.cameras[*view];
            let ray = camera.ray(&(x - shifts[*view]));
            let across = Matrix3::identity() - ray * ray.transpose();
            normal += across;
            right += across * (camera.center - base);
        }
        let equations = |world: &Point3<f64>| {
            let mut equations = NormalEquations::default();
            for observation in track {
                let r = self.residual(observation, world, shifts)?;
                let j = self.cameras[observation.0].project_jacobian(world)?;
                equations.add(&r, &-j, self.loss());
            }
            Some(equations)
        };
        let start = base + normal.lu().solve(&right)?;
        let (world, _) = fit(start, equations, |at, step| at + step, Stop::default())?;
        world.coords.iter().all(|v| v.is_finite()).then_some(world)
    }

    /// The normal equations of changes of the shifts of some views, world points eliminated;
    /// weighted by [`ResidualScale::sigma_px`], at the sum of rho over all observations, pixels^2.
    fn equations<'p>(
        &self,
        shifts: &[Vector2<f64>],
        free: &[usize],
        pattern: &'p Pattern,
    ) -> EnvelopeEquations<'p> {
        let mut equations = EnvelopeEquations::new(pattern);
        for track in &self.tracks {
            let world = self.triangulate(track, shifts);
            for observation in track {
                let r = world.and_then(|world| self.residual(observation, &world, shifts));
                let length = r.map_or(self.scale.gross_px, |r| r.norm());
                equations.cost += self.loss().cost(length * length);
            }
            if let Some(world) = world {
                self.add(track, &world, shifts, free, &mut equations);
            }
        }
        equations
    }

    fn add(
        &self,
        track: &[ImagePoint],
        world: &Point3<f64>,
        shifts: &[Vector2<f64>],
        free: &[usize],
        equations: &mut EnvelopeEquations,
    ) -> Option<()> {
        let variance = self.scale.sigma_px * self.scale.sigma_px;
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        let mut rows: Vec<(usize, Matrix2x3<f64>, Vector2<f64>, f64)> = Vec::new();
        for observation in track {
            let r = self.residual(observation, world, shifts)?;
            let j = self.cameras[observation.0].project_jacobian(world)?;
            let w = self.loss().weight(r.norm_squared()) / variance;
            normal += j.transpose() * j * w;
            right += j.transpose() * r * w;
            if let Some(slot) = free.iter().position(|&view| view == observation.0) {
                rows.push((slot, j, r, w));
            }
        }
        let inverse = normal.try_inverse()?;
        for (a, ja, ra, wa) in &rows {
            let pull = (ja * inverse * right - ra) * *wa;
            for (g, pull) in equations.gradient[2 * a..].iter_mut().zip(&pull) {
                *g += pull;
            }
            equations
                .matrix
                .add_block(2 * a, 2 * a, &(Matrix2::identity() * *wa));
            for (b, jb, _, wb) in rows.iter().filter(|(b, ..)| b <= a) {
                let block = ja * inverse * jb.transpose() * -(wa * wb);
                equations.matrix.add_block(2 * a, 2 * b, &block);
            }
        }
        Some(())
    }
}

/// Views that may be freed next: enough observations, the largest residuals first.
fn candidates(residuals: &[Vec<f64>], free: &[usize]) -> Vec<usize> {
    let mut ranked: Vec<(f64, usize)> = (0..residuals.len())
        .filter(|i| !free.contains(i) && residuals[*i].len() >= MIN_MATCHES)
        .filter_map(|i| Some((crate::base::math::median(&mut residuals[i].clone())?, i)))
        .collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    ranked
        .into_iter()
        .take(MAX_CANDIDATES)
        .map(|r| r.1)
        .collect()
}

/// Shifts with some views free and the others fixed.
pub(crate) struct ShiftSolution {
    free: Vec<usize>,
    /// Shifts of all views, pixels.
    pub shifts: Vec<Vector2<f64>>,
    /// Standard deviations of the shifts, pixels.
    pub sigmas: Vec<f64>,
    /// Sum of rho, pixels^2.
    cost: f64,
}

impl ShiftSolution {
    fn none(adjustment: &ShiftAdjustment) -> Self {
        let count = adjustment.cameras.len();
        let shifts = vec![Vector2::zeros(); count];
        Self {
            cost: adjustment.equations(&shifts, &[], &Pattern::dense(0)).cost,
            sigmas: vec![0.0; count],
            free: Vec::new(),
            shifts,
        }
    }

    /// The same with one more view free.
    fn freeing(view: usize, from: &Self, adjustment: &ShiftAdjustment) -> Option<Self> {
        let mut free = from.free.clone();
        free.push(view);
        let pattern = Pattern::dense(2 * free.len());
        let equations =
            |shifts: &Vec<Vector2<f64>>| Some(adjustment.equations(shifts, &free, &pattern));
        let moved = |shifts: &Vec<Vector2<f64>>, step: &Vec<f64>| {
            let mut moved = shifts.clone();
            for (&i, step) in free.iter().zip(step.chunks(2)) {
                moved[i] += Vector2::new(step[0], step[1]);
            }
            moved
        };
        let (shifts, equations) = fit(from.shifts.clone(), equations, moved, Stop::default())?;
        let inverse = equations.matrix.cholesky()?.inverse();
        let mut sigmas = from.sigmas.clone();
        for (k, &i) in free.iter().enumerate() {
            let of = |axis: usize| inverse[(2 * k + axis, 2 * k + axis)];
            sigmas[i] = of(0).max(of(1)).sqrt();
        }
        Some(Self {
            cost: equations.cost,
            free,
            shifts,
            sigmas,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photographs::camera::testing::crop_camera;

    #[test]
    fn the_view_that_is_shifted_is_freed_and_its_shift_found() {
        let cameras = [
            (-280.0, -200.0, 0.0),
            (0.0, -190.0, 0.1),
            (310.0, -200.0, 0.0),
            (10.0, 190.0, 3.1),
            (-290.0, 190.0, 3.0),
        ]
        .map(|(x, y, kappa)| crop_camera(x, y, kappa));
        let planted = Vector2::new(0.6, -0.4);
        let track = |i: u32| {
            let [x, y, z] = [i % 7, i % 5, i % 3].map(f64::from);
            let world = Point3::new(2.0 * x - 6.0, 3.0 * y - 6.0, 3.0 * z);
            let seen = |(view, camera): (usize, &Camera)| {
                let shift = if view == 2 { planted } else { Vector2::zeros() };
                (view, camera.project(&world).unwrap() + shift)
            };
            cameras.iter().enumerate().map(seen).collect()
        };
        let adjustment = ShiftAdjustment {
            tracks: (0..60).map(track).collect(),
            cameras: &cameras,
            scale: ResidualScale {
                sigma_px: 0.2,
                huber_px: 0.4,
                gross_px: 3.0,
            },
        };
        let found = adjustment.free_views();
        for (view, shift) in found.shifts.iter().enumerate() {
            let truth = if view == 2 { planted } else { Vector2::zeros() };
            assert!((shift - truth).norm() < 0.01, "{view}: {shift}");
        }
        // Of sixty points, though each gives three of its coordinates to its place.
        assert!(found.sigmas[2] > 0.2 / 60f64.sqrt() && found.sigmas[2] < 0.1);
    }
}
