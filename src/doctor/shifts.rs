//! How far each view is shifted against the others: a small bundle adjustment over the places found again.
//!
//! Places that one interest point has in several views make a track, whose world point X and whose views' shifts s
//! are sought:
//!
//! ```text
//! sum over tracks and views  rho(x - (P X + s)) / sigma^2  ->  min
//! ```
//!
//! Over a crop of a frame a small error of omega, phi or of the projection centre is a shift of the image; turns and
//! changes of scale within the image are not sought. World points are eliminated track by track (Schur complement);
//! rho is Huber's.
//!
//! Shifts of all views that only move or bend the world are invisible, or nearly so: adjusting all views at once gave
//! shifts of three pixels on sound photographs (real-barns), which fitted hardly better. Therefore views are freed one
//! by one, the one first that helps most, as long as it helps much; most views stay where they are.

use nalgebra::{DMatrix, DVector, Matrix2x3, Matrix3, Point2, Point3, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use super::Clinic;
use super::fine::Places;
use crate::camera::Camera;
use crate::sorting::sort_by;

/// Standard deviation of a place, pixels. Assumption: what correlation of 9 x 9 windows reaches on roofs and ground.
const SIGMA_PX: f64 = 0.2;

/// Residuals beyond this count linearly, pixels.
const HUBER_PX: f64 = 0.4;

/// Residuals beyond this are other places, pixels.
const GROSS_PX: f64 = 3.0;

/// Share of the sum that freeing a view must take away. Assumption: half a pixel in one of six views takes a third; noise
/// and relief take a few percent.
const LEAST_GAIN: f64 = 0.15;

/// Most views that are tried at a time: those with the largest residuals.
const MOST_TRIED: usize = 8;

/// Fewest residuals beyond the unknowns for a statement about a scene.
const FEWEST_FREE: usize = 60;

/// Fewest places of a view for a statement about it.
const FEWEST_PLACES: usize = 12;

/// Rounds of linearising and weighting.
const ROUNDS: usize = 5;

/// Shift of a view against the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ViewShift {
    /// To be added to the principal point, pixels, x right, y down.
    pub shift_px: [f64; 2],
    /// Its standard deviation, pixels; 0 for views that were not shifted.
    pub sigma_px: f64,
    /// Median distance of the view's places from where the world points project, as stated, pixels.
    pub before_px: f64,
    /// The same with the shifts.
    pub after_px: f64,
    /// Number of places.
    pub places: usize,
}

impl ViewShift {
    /// Is there a shift that is worth a word: seen beyond doubt, and no more than small?
    pub fn is_significant(&self) -> bool {
        let [x, y] = self.shift_px;
        let length = (x * x + y * y).sqrt();
        length > LEAST_SHIFT_PX.max(SIGNIFICANT_SIGMAS * self.sigma_px)
            && length < GROSS_PX
            && self.after_px < self.before_px
    }
}

/// Least shift that matters: lines are found to about a tenth of a pixel.
const LEAST_SHIFT_PX: f64 = 0.15;

/// A shift is believed from so many standard deviations on.
const SIGNIFICANT_SIGMAS: f64 = 4.0;

/// A place in a view.
type Place = (usize, Point2<f64>);

/// The shifts of all views; `None` where too little is found again.
pub(super) fn shifts(
    clinic: &Clinic,
    places: &[Places],
    cameras: &[Camera],
) -> Option<Vec<ViewShift>> {
    let tracks = tracks(clinic, places, cameras);
    let observations: usize = tracks.iter().map(Vec::len).sum();
    let free = (2 * observations).checked_sub(3 * tracks.len() + 2 * cameras.len())?;
    if free < FEWEST_FREE {
        return None;
    }
    let mut best = Trial::none(&tracks, cameras);
    let before = residuals(&tracks, cameras, &best.shifts);
    // Views that are free are the exception.
    while 2 * (best.free.len() + 1) <= cameras.len() {
        let trials = candidates(&before, &best.free).into_iter();
        let next = trials
            .filter_map(|view| Trial::freeing(view, &best, &tracks, cameras))
            .min_by(|a, b| a.cost.total_cmp(&b.cost));
        match next.filter(|next| next.cost < (1.0 - LEAST_GAIN) * best.cost) {
            Some(next) => best = next,
            None => break,
        }
    }
    let after = residuals(&tracks, cameras, &best.shifts);
    let of_view = |i: usize| {
        let (mut before, mut after) = (before[i].clone(), after[i].clone());
        let places = after.len();
        ViewShift {
            shift_px: best.shifts[i].into(),
            sigma_px: best.sigmas[i],
            before_px: crate::math::median(&mut before).unwrap_or(0.0),
            after_px: crate::math::median(&mut after).unwrap_or(0.0),
            places,
        }
    };
    Some((0..cameras.len()).map(of_view).collect())
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
struct Trial {
    free: Vec<usize>,
    shifts: Vec<Vector2<f64>>,
    /// Standard deviations of the shifts, pixels.
    sigmas: Vec<f64>,
    /// Sum of rho, pixels^2.
    cost: f64,
}

impl Trial {
    fn none(tracks: &[Vec<Place>], cameras: &[Camera]) -> Self {
        let shifts = vec![Vector2::zeros(); cameras.len()];
        Self {
            cost: cost(tracks, cameras, &shifts),
            sigmas: vec![0.0; cameras.len()],
            free: Vec::new(),
            shifts,
        }
    }

    /// The same with one more view free.
    fn freeing(
        view: usize,
        from: &Self,
        tracks: &[Vec<Place>],
        cameras: &[Camera],
    ) -> Option<Self> {
        let mut free = from.free.clone();
        free.push(view);
        let (mut shifts, mut sigmas) = (from.shifts.clone(), from.sigmas.clone());
        for _ in 0..ROUNDS {
            let (changes, found) = System::of(tracks, cameras, &shifts).solve(&free)?;
            for ((&i, change), sigma) in free.iter().zip(changes).zip(found) {
                shifts[i] += change;
                sigmas[i] = sigma;
            }
        }
        let cost = cost(tracks, cameras, &shifts);
        Some(Self {
            free,
            shifts,
            sigmas,
            cost,
        })
    }
}

/// The sum of rho over all places, pixels^2.
fn cost(tracks: &[Vec<Place>], cameras: &[Camera], shifts: &[Vector2<f64>]) -> f64 {
    let rho = |length: f64| match length <= HUBER_PX {
        true => 0.5 * length * length,
        false => HUBER_PX * (length - 0.5 * HUBER_PX),
    };
    let of_track = |track: &Vec<Place>| -> f64 {
        let world = triangulate(track, cameras, shifts);
        let of_place = |place: &Place| {
            let r = world.and_then(|world| residual(place, &world, cameras, shifts));
            rho(r.map_or(GROSS_PX, |r| r.norm()))
        };
        track.iter().map(of_place).sum()
    };
    tracks.iter().map(of_track).sum()
}

/// The places of each interest point, its own first; points whose rays do not meet are left out.
fn tracks(clinic: &Clinic, places: &[Places], cameras: &[Camera]) -> Vec<Vec<Place>> {
    let mut tracks: Vec<(usize, usize, Vec<Place>)> = Vec::new();
    for (&(i, j), places) in clinic.pairs.iter().zip(places) {
        for place in places {
            match tracks.iter_mut().find(|t| (t.0, t.1) == (i, place.point)) {
                Some(track) => track.2.push((j, place.second)),
                None => tracks.push((i, place.point, vec![(i, place.first), (j, place.second)])),
            }
        }
    }
    let none = vec![Vector2::zeros(); cameras.len()];
    let meets = |track: &Vec<Place>| {
        let world = triangulate(track, cameras, &none);
        let near = |world: &Point3<f64>| {
            track
                .iter()
                .all(|p| residual(p, world, cameras, &none).is_some_and(|r| r.norm() < GROSS_PX))
        };
        world.filter(near).is_some()
    };
    tracks.into_iter().map(|t| t.2).filter(meets).collect()
}

/// x - (P X + s), pixels.
fn residual(
    (view, x): &Place,
    world: &Point3<f64>,
    cameras: &[Camera],
    shifts: &[Vector2<f64>],
) -> Option<Vector2<f64>> {
    Some(x - cameras[*view].project(world)? - shifts[*view])
}

/// The world point of a track: nearest to its rays, then least squares in the images.
fn triangulate(
    track: &[Place],
    cameras: &[Camera],
    shifts: &[Vector2<f64>],
) -> Option<Point3<f64>> {
    let base = cameras[track[0].0].center;
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (view, x) in track {
        let camera = &cameras[*view];
        let ray = camera.ray(&(x - shifts[*view]));
        let across = Matrix3::identity() - ray * ray.transpose();
        normal += across;
        right += across * (camera.center - base);
    }
    let mut world = base + normal.lu().solve(&right)?;
    for _ in 0..3 {
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for place in track {
            let r = residual(place, &world, cameras, shifts)?;
            let j = cameras[place.0].project_jacobian(&world)?;
            let w = huber(&r);
            normal += j.transpose() * j * w;
            right += j.transpose() * r * w;
        }
        world += normal.cholesky()?.solve(&right);
    }
    world.coords.iter().all(|v| v.is_finite()).then_some(world)
}

/// Weight of a residual under Huber's norm.
fn huber(residual: &Vector2<f64>) -> f64 {
    let length = residual.norm();
    if length <= HUBER_PX {
        1.0
    } else {
        HUBER_PX / length
    }
}

/// Lengths of the residuals of each view, pixels.
fn residuals(tracks: &[Vec<Place>], cameras: &[Camera], shifts: &[Vector2<f64>]) -> Vec<Vec<f64>> {
    let mut lengths = vec![Vec::new(); cameras.len()];
    for track in tracks {
        let Some(world) = triangulate(track, cameras, shifts) else {
            continue;
        };
        for place in track {
            if let Some(r) = residual(place, &world, cameras, shifts) {
                lengths[place.0].push(r.norm());
            }
        }
    }
    lengths
}

/// Normal equations of changes of the shifts, world points eliminated; in units of 1 / [`SIGMA_PX`]^2.
struct System {
    normal: DMatrix<f64>,
    right: DVector<f64>,
}

impl System {
    fn of(tracks: &[Vec<Place>], cameras: &[Camera], shifts: &[Vector2<f64>]) -> Self {
        let size = 2 * cameras.len();
        let mut system = Self {
            normal: DMatrix::zeros(size, size),
            right: DVector::zeros(size),
        };
        for track in tracks {
            system.add(track, cameras, shifts);
        }
        system
    }

    /// Adds a track; one whose point cannot be found tells nothing.
    fn add(&mut self, track: &[Place], cameras: &[Camera], shifts: &[Vector2<f64>]) -> Option<()> {
        let world = triangulate(track, cameras, shifts)?;
        let mut rows: Vec<(usize, Matrix2x3<f64>, Vector2<f64>, f64)> = Vec::new();
        for place in track {
            let r = residual(place, &world, cameras, shifts)?;
            rows.push((
                place.0,
                cameras[place.0].project_jacobian(&world)?,
                r,
                huber(&r) / (SIGMA_PX * SIGMA_PX),
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
