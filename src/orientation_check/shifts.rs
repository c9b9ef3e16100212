//! How far each view is shifted against the others: a small bundle adjustment over the places found again.
//!
//! Places that one interest point has in several views make a track, whose world point X and whose views' shifts s
//! are sought:
//!
//! ```text
//! sum over tracks and views  rho(x - (P X + s)) / sigma^2  ->  min
//! ```
//!
//! Shifts of several pixels are found in the reduced images first. Over a crop of a frame a small error of omega, phi or of the projection centre is a shift of the image; turns and
//! changes of scale within the image are not sought. World points are eliminated track by track (Schur complement);
//! rho is Huber's.
//!
//! Shifts of all views that only move or bend the world are invisible, or nearly so: adjusting all views at once gave
//! shifts of three pixels on sound photographs (real-barns), which fitted hardly better. Therefore views are freed one
//! by one, the one first that helps most, as long as it helps much; most views stay where they are.

use nalgebra::{Point2, Vector2};

use super::fine::{Place as Pair, Places};
use super::network::{Network, Scale};
use super::{Clinic, epipolar, mean_axis};
use crate::camera::Camera;
use crate::execution::parallel;
use crate::scene::ViewShift;

/// Places in the images as they are. Assumption: 0.2 px is what correlation of 9 x 9 windows reaches on roofs and ground.
const FINE: Scale = Scale {
    sigma_px: 0.2,
    huber_px: 0.4,
    gross_px: 3.0,
};

/// Places in the reduced images are whole pixels of theirs.
fn coarse_scale(factor: usize) -> Scale {
    let reduced_px = factor as f64;
    Scale {
        sigma_px: 0.5 * reduced_px,
        huber_px: 0.7 * reduced_px,
        gross_px: COARSE_SHIFT as f64 * reduced_px,
    }
}

/// Farthest line on which the coarse search believes a place, pixels of the reduced images.
const COARSE_SHIFT: i32 = 4;

/// What the coarse search finds below this, the fine one finds better, pixels.
const LEAST_COARSE_PX: f64 = 1.5;

/// Larger shifts are no small errors, pixels.
const MOST_PX: f64 = 20.0;

impl ViewShift {
    /// Is there a shift that is worth a word: seen beyond doubt, and no more than small?
    pub fn is_significant(&self) -> bool {
        let [x, y] = self.shift_px;
        let length = (x * x + y * y).sqrt();
        length > LEAST_SHIFT_PX.max(SIGNIFICANT_SIGMAS * self.sigma_px)
            && length < MOST_PX
            && self.after_px < self.before_px
    }
}

/// Least shift that matters: lines are found to about a tenth of a pixel.
const LEAST_SHIFT_PX: f64 = 0.15;

/// A shift is believed from so many standard deviations on.
const SIGNIFICANT_SIGMAS: f64 = 4.0;

/// The shifts of all views; `None` where too little is found again. `coarse` are the shifts with which the places were
/// looked for.
pub(crate) fn shifts(
    clinic: &Clinic,
    places: &[Places],
    stated: &[Camera],
    coarse: &[Vector2<f64>],
) -> Option<Vec<ViewShift>> {
    let cameras = shifted(stated, coarse);
    let network = Network::new(clinic, places, &cameras, FINE)?;
    let best = network.free_views();
    let before = network.residuals(&coarse.iter().map(|s| -s).collect::<Vec<_>>());
    let after = network.residuals(&best.shifts);
    let of_view = |i: usize| {
        let (mut before, mut after) = (before[i].clone(), after[i].clone());
        let places = after.len();
        ViewShift {
            shift_px: (coarse[i] + best.shifts[i]).into(),
            sigma_px: match coarse[i] == Vector2::zeros() {
                true => best.sigmas[i],
                false => best.sigmas[i].max(FINE.sigma_px),
            },
            before_px: crate::math::median(&mut before).unwrap_or(0.0),
            after_px: crate::math::median(&mut after).unwrap_or(0.0),
            places,
        }
    };
    Some((0..stated.len()).map(of_view).collect())
}

/// Shifts of several pixels, from places in the reduced images; zero where the fine search finds them itself.
pub(crate) fn coarse_shifts(clinic: &Clinic, cameras: &[Camera]) -> Vec<Vector2<f64>> {
    let none = || vec![Vector2::zeros(); cameras.len()];
    let factor = *clinic.factors.iter().max().unwrap_or(&1);
    if factor < 2 {
        return none();
    }
    let places = coarse_places(clinic, cameras);
    let Some(network) = Network::new(clinic, &places, cameras, coarse_scale(factor)) else {
        return none();
    };
    let matters = |s: Vector2<f64>| (s.norm() > LEAST_COARSE_PX).then_some(s);
    let found = network.free_views().shifts;
    found
        .into_iter()
        .map(|s| matters(s).unwrap_or_default())
        .collect()
}

/// Places as the reduced images show them.
fn coarse_places(clinic: &Clinic, cameras: &[Camera]) -> Vec<Places> {
    let (reduced, axis) = (clinic.reduced(cameras), mean_axis(cameras));
    parallel::map(&clinic.pairs, |_, &(i, j)| {
        let scale = [i, j].map(|v| clinic.factors[v] as f64);
        let found = |(point, x): (usize, &Point2<f64>)| {
            let place = epipolar::best_place(&reduced[i], &reduced[j], &axis, x)?;
            (place.shift.abs() <= COARSE_SHIFT).then(|| Pair {
                point,
                first: x * scale[0],
                second: place.at * scale[1],
            })
        };
        let points = clinic.points[i].iter().enumerate();
        points.filter_map(found).collect()
    })
}

/// Cameras whose images are shifted.
pub(crate) fn shifted(cameras: &[Camera], shifts: &[Vector2<f64>]) -> Vec<Camera> {
    let moved = |(camera, shift): (&Camera, &Vector2<f64>)| {
        let mut camera = camera.clone();
        camera.k[(0, 2)] += shift.x;
        camera.k[(1, 2)] += shift.y;
        camera
    };
    cameras.iter().zip(shifts).map(moved).collect()
}
