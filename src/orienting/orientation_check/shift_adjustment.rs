//! Least squares over tracks of matched points: shifts of the views, of which as few as possible
//! are freed.
//!
//! World points are eliminated track by track (Schur complement); rho is Huber's.

use nalgebra::{DMatrix, DVector, Matrix2x3, Matrix3, Point2, Point3, Vector2, Vector3};

use super::epipolar_check::EpipolarCheck;
use super::subpixel::PointMatch;
use crate::photographs::camera::Camera;

/// Share of the cost that freeing a view must remove. Measured: at most 0.022 in correct scenes,
/// rendered and real; half a pixel in one of six views removes a third, and 1.5 px 0.043 among
/// photographs with residuals of a pixel.
const MIN_COST_REDUCTION: f64 = 0.035;

/// Most views that are tested at a time: those with the largest residuals.
const MAX_CANDIDATES: usize = 8;

/// Least redundancy (observations minus unknowns) of a scene.
const MIN_REDUNDANCY: usize = 60;

/// Fewest observations of a view that may be freed.
const MIN_OBSERVATIONS: usize = 12;

/// Iterations of linearising and reweighting.
const ROUNDS: usize = 5;

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

    /// The sum of rho over all observations, pixels^2.
    fn cost(&self, shifts: &[Vector2<f64>]) -> f64 {
        let huber_px = self.scale.huber_px;
        let rho = |length: f64| match length <= huber_px {
            true => 0.5 * length * length,
            false => huber_px * (length - 0.5 * huber_px),
        };
        let of_track = |track: &Vec<ImagePoint>| -> f64 {
            let world = self.triangulate(track, shifts);
            let of_observation = |observation: &ImagePoint| {
                let r = world.and_then(|world| self.residual(observation, &world, shifts));
                rho(r.map_or(self.scale.gross_px, |r| r.norm()))
            };
            track.iter().map(of_observation).sum()
        };
        self.tracks.iter().map(of_track).sum()
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
        let mut world = base + normal.lu().solve(&right)?;
        for _ in 0..3 {
            let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
            for observation in track {
                let r = self.residual(observation, &world, shifts)?;
                let j = self.cameras[observation.0].project_jacobian(&world)?;
                let w = self.huber(&r);
                normal += j.transpose() * j * w;
                right += j.transpose() * r * w;
            }
            world += normal.cholesky()?.solve(&right);
        }
        world.coords.iter().all(|v| v.is_finite()).then_some(world)
    }

    /// Weight of a residual under Huber's norm.
    fn huber(&self, residual: &Vector2<f64>) -> f64 {
        let huber_px = self.scale.huber_px;
        let length = residual.norm();
        match length <= huber_px {
            true => 1.0,
            false => huber_px / length,
        }
    }
}

/// Views that may be freed next: enough observations, the largest residuals first.
fn candidates(residuals: &[Vec<f64>], free: &[usize]) -> Vec<usize> {
    let mut ranked: Vec<(f64, usize)> = (0..residuals.len())
        .filter(|i| !free.contains(i) && residuals[*i].len() >= MIN_OBSERVATIONS)
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
            cost: adjustment.cost(&shifts),
            sigmas: vec![0.0; count],
            free: Vec::new(),
            shifts,
        }
    }

    /// The same with one more view free.
    fn freeing(view: usize, from: &Self, adjustment: &ShiftAdjustment) -> Option<Self> {
        let mut free = from.free.clone();
        free.push(view);
        let (mut shifts, mut sigmas) = (from.shifts.clone(), from.sigmas.clone());
        for _ in 0..ROUNDS {
            let (changes, found) = ReducedNormals::of(adjustment, &shifts).solve(&free)?;
            for ((&i, change), sigma) in free.iter().zip(changes).zip(found) {
                shifts[i] += change;
                sigmas[i] = sigma;
            }
        }
        let cost = adjustment.cost(&shifts);
        Some(Self {
            free,
            shifts,
            sigmas,
            cost,
        })
    }
}

/// Normal equations of changes of the shifts, world points eliminated; weighted by
/// [`ResidualScale::sigma_px`].
struct ReducedNormals {
    normal: DMatrix<f64>,
    right: DVector<f64>,
}

impl ReducedNormals {
    fn of(adjustment: &ShiftAdjustment, shifts: &[Vector2<f64>]) -> Self {
        let size = 2 * adjustment.cameras.len();
        let mut system = Self {
            normal: DMatrix::zeros(size, size),
            right: DVector::zeros(size),
        };
        for track in &adjustment.tracks {
            system.add(track, adjustment, shifts);
        }
        system
    }

    /// Adds a track; one whose point cannot be triangulated contributes nothing.
    fn add(
        &mut self,
        track: &[ImagePoint],
        adjustment: &ShiftAdjustment,
        shifts: &[Vector2<f64>],
    ) -> Option<()> {
        let world = adjustment.triangulate(track, shifts)?;
        let variance = adjustment.scale.sigma_px * adjustment.scale.sigma_px;
        let mut rows: Vec<(usize, Matrix2x3<f64>, Vector2<f64>, f64)> = Vec::new();
        for observation in track {
            let r = adjustment.residual(observation, &world, shifts)?;
            rows.push((
                observation.0,
                adjustment.cameras[observation.0].project_jacobian(&world)?,
                r,
                adjustment.huber(&r) / variance,
            ));
        }
        let sum = |f: &dyn Fn(&Matrix2x3<f64>, f64) -> Matrix3<f64>| {
            rows.iter()
                .map(|(_, j, _, w)| f(j, *w))
                .sum::<Matrix3<f64>>()
        };
        let point = sum(&|j, w| j.transpose() * j * w).try_inverse()?;
        let point_right: Vector3<f64> =
            rows.iter().map(|(_, j, r, w)| j.transpose() * r * *w).sum();
        for (a, ja, ra, wa) in &rows {
            let mut at = self.right.fixed_rows_mut::<2>(2 * a);
            at += (ra - ja * point * point_right) * *wa;
            let mut diagonal = self.normal.fixed_view_mut::<2, 2>(2 * a, 2 * a);
            diagonal += nalgebra::Matrix2::identity() * *wa;
            for (b, jb, _, wb) in &rows {
                let mut block = self.normal.fixed_view_mut::<2, 2>(2 * a, 2 * b);
                block -= ja * point * jb.transpose() * (wa * wb);
            }
        }
        Some(())
    }

    /// Changes of the shifts of these views, the others staying, and their standard deviations,
    /// pixels.
    fn solve(&self, free: &[usize]) -> Option<(Vec<Vector2<f64>>, Vec<f64>)> {
        let index = |k: usize| 2 * free[k / 2] + k % 2;
        let size = 2 * free.len();
        let normal = DMatrix::from_fn(size, size, |a, b| self.normal[(index(a), index(b))]);
        let right = DVector::from_fn(size, |a, _| self.right[index(a)]);
        let factors = normal.cholesky()?;
        let change = factors.solve(&right);
        let inverse = factors.inverse();
        let of_view = |k: usize| {
            let variance = inverse[(2 * k, 2 * k)].max(inverse[(2 * k + 1, 2 * k + 1)]);
            (
                Vector2::new(change[2 * k], change[2 * k + 1]),
                variance.sqrt(),
            )
        };
        Some((0..free.len()).map(of_view).unzip())
    }
}
