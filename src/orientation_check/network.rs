//! The adjustment behind [`super::shifts`]: tracks of places, the shifts that fit them, and the views that need one.
//!
//! World points are eliminated track by track (Schur complement); rho is Huber's.

use nalgebra::{DMatrix, DVector, Matrix2x3, Matrix3, Point2, Point3, Vector2, Vector3};

use super::Clinic;
use super::fine::Places;
use crate::camera::Camera;
use crate::sorting::sort_by;

/// Share of the sum that freeing a view must take away. Measured: at most 0.022 in sound scenes, rendered and real; half a
/// pixel in one of six views takes a third, and 1.5 px takes 0.043 among photographs that are a pixel off themselves.
const LEAST_GAIN: f64 = 0.035;

/// Most views that are tried at a time: those with the largest residuals.
const MOST_TRIED: usize = 8;

/// Fewest residuals beyond the unknowns for a statement about a scene.
const FEWEST_FREE: usize = 60;

/// Fewest places of a view for a statement about it.
const FEWEST_PLACES: usize = 12;

/// Rounds of linearising and weighting.
const ROUNDS: usize = 5;

/// What to expect of residuals.
pub(crate) struct Scale {
    /// Standard deviation of a place, pixels.
    pub sigma_px: f64,
    /// Residuals beyond this count linearly, pixels.
    pub huber_px: f64,
    /// Residuals beyond this are other places, pixels.
    pub gross_px: f64,
}

/// A place in a view.
type Place = (usize, Point2<f64>);

/// Places that belong together, in the views of these cameras.
pub(crate) struct Network<'a> {
    tracks: Vec<Vec<Place>>,
    cameras: &'a [Camera],
    scale: Scale,
}

impl<'a> Network<'a> {
    /// The places of each interest point, its own first; points whose rays do not meet are left out. `None` where too
    /// little is left.
    pub fn new(
        clinic: &Clinic,
        places: &[Places],
        cameras: &'a [Camera],
        scale: Scale,
    ) -> Option<Self> {
        let mut tracks: Vec<(usize, usize, Vec<Place>)> = Vec::new();
        for (&(i, j), places) in clinic.pairs.iter().zip(places) {
            for place in places {
                match tracks.iter_mut().find(|t| (t.0, t.1) == (i, place.point)) {
                    Some(track) => track.2.push((j, place.second)),
                    None => {
                        tracks.push((i, place.point, vec![(i, place.first), (j, place.second)]));
                    }
                }
            }
        }
        let mut network = Self {
            tracks: Vec::new(),
            cameras,
            scale,
        };
        let tracks = tracks.into_iter().map(|t| t.2);
        network.tracks = tracks.filter(|t| network.meets(t)).collect();
        let observations: usize = network.tracks.iter().map(Vec::len).sum();
        let unknowns = 3 * network.tracks.len() + 2 * cameras.len();
        let free = (2 * observations).checked_sub(unknowns)?;
        (free >= FEWEST_FREE).then_some(network)
    }

    /// Frees views one by one, as long as that helps much: views that are free are the exception.
    pub fn free_views(&self) -> Trial {
        let mut best = Trial::none(self);
        let before = self.residuals(&best.shifts);
        while 2 * (best.free.len() + 1) <= self.cameras.len() {
            let trials = candidates(&before, &best.free).into_iter();
            let next = trials
                .filter_map(|view| Trial::freeing(view, &best, self))
                .min_by(|a, b| a.cost.total_cmp(&b.cost));
            match next.filter(|next| next.cost < (1.0 - LEAST_GAIN) * best.cost) {
                Some(next) => best = next,
                None => break,
            }
        }
        best
    }

    /// Lengths of the residuals of each view under these shifts, pixels.
    pub fn residuals(&self, shifts: &[Vector2<f64>]) -> Vec<Vec<f64>> {
        let mut lengths = vec![Vec::new(); self.cameras.len()];
        for track in &self.tracks {
            let Some(world) = self.triangulate(track, shifts) else {
                continue;
            };
            for place in track {
                if let Some(r) = self.residual(place, &world, shifts) {
                    lengths[place.0].push(r.norm());
                }
            }
        }
        lengths
    }

    /// The sum of rho over all places, pixels^2.
    fn cost(&self, shifts: &[Vector2<f64>]) -> f64 {
        let huber_px = self.scale.huber_px;
        let rho = |length: f64| match length <= huber_px {
            true => 0.5 * length * length,
            false => huber_px * (length - 0.5 * huber_px),
        };
        let of_track = |track: &Vec<Place>| -> f64 {
            let world = self.triangulate(track, shifts);
            let of_place = |place: &Place| {
                let r = world.and_then(|world| self.residual(place, &world, shifts));
                rho(r.map_or(self.scale.gross_px, |r| r.norm()))
            };
            track.iter().map(of_place).sum()
        };
        self.tracks.iter().map(of_track).sum()
    }

    fn meets(&self, track: &[Place]) -> bool {
        let none = vec![Vector2::zeros(); self.cameras.len()];
        let is_near = |place: &Place, world: &Point3<f64>| {
            let r = self.residual(place, world, &none);
            r.is_some_and(|r| r.norm() < self.scale.gross_px)
        };
        let world = self.triangulate(track, &none);
        world.is_some_and(|world| track.iter().all(|place| is_near(place, &world)))
    }

    /// x - (P X + s), pixels.
    fn residual(
        &self,
        (view, x): &Place,
        world: &Point3<f64>,
        shifts: &[Vector2<f64>],
    ) -> Option<Vector2<f64>> {
        Some(x - self.cameras[*view].project(world)? - shifts[*view])
    }

    /// The world point of a track: nearest to its rays, then least squares in the images.
    fn triangulate(&self, track: &[Place], shifts: &[Vector2<f64>]) -> Option<Point3<f64>> {
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
            for place in track {
                let r = self.residual(place, &world, shifts)?;
                let j = self.cameras[place.0].project_jacobian(&world)?;
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

/// Views that may be freed next: enough places, the largest residuals first.
fn candidates(residuals: &[Vec<f64>], free: &[usize]) -> Vec<usize> {
    let mut ranked: Vec<(f64, usize)> = (0..residuals.len())
        .filter(|i| !free.contains(i) && residuals[*i].len() >= FEWEST_PLACES)
        .filter_map(|i| Some((crate::math::median(&mut residuals[i].clone())?, i)))
        .collect();
    sort_by(&mut ranked, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    ranked.into_iter().take(MOST_TRIED).map(|r| r.1).collect()
}

/// Some views free, the others where they are.
pub(crate) struct Trial {
    free: Vec<usize>,
    /// Shifts of all views, pixels.
    pub shifts: Vec<Vector2<f64>>,
    /// Standard deviations of the shifts, pixels.
    pub sigmas: Vec<f64>,
    /// Sum of rho, pixels^2.
    cost: f64,
}

impl Trial {
    fn none(network: &Network) -> Self {
        let count = network.cameras.len();
        let shifts = vec![Vector2::zeros(); count];
        Self {
            cost: network.cost(&shifts),
            sigmas: vec![0.0; count],
            free: Vec::new(),
            shifts,
        }
    }

    /// The same with one more view free.
    fn freeing(view: usize, from: &Self, network: &Network) -> Option<Self> {
        let mut free = from.free.clone();
        free.push(view);
        let (mut shifts, mut sigmas) = (from.shifts.clone(), from.sigmas.clone());
        for _ in 0..ROUNDS {
            let (changes, found) = System::of(network, &shifts).solve(&free)?;
            for ((&i, change), sigma) in free.iter().zip(changes).zip(found) {
                shifts[i] += change;
                sigmas[i] = sigma;
            }
        }
        let cost = network.cost(&shifts);
        Some(Self {
            free,
            shifts,
            sigmas,
            cost,
        })
    }
}

/// Normal equations of changes of the shifts, world points eliminated; weighted by [`Scale::sigma_px`].
struct System {
    normal: DMatrix<f64>,
    right: DVector<f64>,
}

impl System {
    fn of(network: &Network, shifts: &[Vector2<f64>]) -> Self {
        let size = 2 * network.cameras.len();
        let mut system = Self {
            normal: DMatrix::zeros(size, size),
            right: DVector::zeros(size),
        };
        for track in &network.tracks {
            system.add(track, network, shifts);
        }
        system
    }

    /// Adds a track; one whose point cannot be found tells nothing.
    fn add(&mut self, track: &[Place], network: &Network, shifts: &[Vector2<f64>]) -> Option<()> {
        let world = network.triangulate(track, shifts)?;
        let variance = network.scale.sigma_px * network.scale.sigma_px;
        let mut rows: Vec<(usize, Matrix2x3<f64>, Vector2<f64>, f64)> = Vec::new();
        for place in track {
            let r = network.residual(place, &world, shifts)?;
            rows.push((
                place.0,
                network.cameras[place.0].project_jacobian(&world)?,
                r,
                network.huber(&r) / variance,
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

    /// Changes of the shifts of these views, the others staying, and their standard deviations, pixels.
    fn solve(&self, free: &[usize]) -> Option<(Vec<Vector2<f64>>, Vec<f64>)> {
        let place = |k: usize| 2 * free[k / 2] + k % 2;
        let size = 2 * free.len();
        let normal = DMatrix::from_fn(size, size, |a, b| self.normal[(place(a), place(b))]);
        let right = DVector::from_fn(size, |a, _| self.right[place(a)]);
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
