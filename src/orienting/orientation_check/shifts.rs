//! How far each view is shifted against the others: a small bundle adjustment over matched points.
//!
//! The matches of one interest point in several views make a track, whose world point X and whose
//! views' shifts s are sought:
//!
//! ```text
//! sum over tracks and views  rho(x - (P X + s)) / sigma^2  ->  min
//! ```
//!
//! Shifts of several pixels are found in the reduced images first. Over a crop of a frame a small
//! error of omega, phi or of the projection centre is a shift of the image; rotations and changes
//! of scale within the image are not sought. World points are eliminated track by track (Schur
//! complement); rho is Huber's.
//!
//! Shifts of all views that only move or bend the world are (nearly) unobservable: adjusting all
//! views at once gave shifts of three pixels on correctly oriented photographs, with hardly smaller
//! residuals. Therefore views are freed one by one, the one first that reduces the cost most, as
//! long as the reduction is large; most views stay fixed.

use nalgebra::{Point2, Vector2};

use super::epipolar::best_match;
use super::epipolar_check::{EpipolarCheck, mean_axis};
use super::shift_adjustment::{ResidualScale, ShiftAdjustment};
use super::subpixel::PointMatch;
use crate::base::execution::parallel;
use crate::base::math::SURE_RESIDUAL_SIGMAS;
use crate::orienting::scene::ViewShift;
use crate::photographs::camera::Camera;

/// Matches in the images at full resolution. Assumption: 0.2 px is what correlation of 9 x 9
/// windows reaches on roofs and ground.
const FULL_RESOLUTION: ResidualScale = ResidualScale {
    sigma_px: 0.2,
    huber_px: 0.4,
    gross_px: 3.0,
};

/// Matches in the reduced images are known to whole pixels there.
fn coarse_scale(factor: usize) -> ResidualScale {
    let reduced_px = factor as f64;
    ResidualScale {
        sigma_px: 0.5 * reduced_px,
        huber_px: 0.7 * reduced_px,
        gross_px: COARSE_SHIFT as f64 * reduced_px,
    }
}

/// Farthest line on which the coarse search accepts a match, pixels of the reduced images.
const COARSE_SHIFT: i32 = 4;

/// Smaller shifts are left to the search at full resolution, pixels.
const MIN_COARSE_SHIFT_PX: f64 = 1.5;

/// Larger shifts are gross errors, which this adjustment does not model, pixels.
const MAX_SHIFT_PX: f64 = 20.0;

impl ViewShift {
    /// Is the shift significant, and still small?
    pub fn is_significant(&self) -> bool {
        let [x, y] = self.shift_px;
        let length = (x * x + y * y).sqrt();
        length > MIN_SHIFT_PX.max(SURE_RESIDUAL_SIGMAS * self.sigma_px)
            && length < MAX_SHIFT_PX
            && self.after_px < self.before_px
    }
}

/// Least shift that matters: lines are found to about a tenth of a pixel.
const MIN_SHIFT_PX: f64 = 0.15;

/// The shifts of all views; `None` where too little is matched. `coarse` are the shifts with which
/// the matches were searched.
pub(crate) fn shifts(
    check: &EpipolarCheck,
    matches: &[Vec<PointMatch>],
    stated: &[Camera],
    coarse: &[Vector2<f64>],
) -> Option<Vec<ViewShift>> {
    let cameras = shifted(stated, coarse);
    let adjustment = ShiftAdjustment::new(check, matches, &cameras, FULL_RESOLUTION)?;
    let best = adjustment.free_views();
    let before = adjustment.residuals(&coarse.iter().map(|s| -s).collect::<Vec<_>>());
    let after = adjustment.residuals(&best.shifts);
    let of_view = |i: usize| {
        let (mut before, mut after) = (before[i].clone(), after[i].clone());
        let places = after.len();
        ViewShift {
            shift_px: (coarse[i] + best.shifts[i]).into(),
            sigma_px: match coarse[i] == Vector2::zeros() {
                true => best.sigmas[i],
                false => best.sigmas[i].max(FULL_RESOLUTION.sigma_px),
            },
            before_px: crate::base::math::median(&mut before).unwrap_or(0.0),
            after_px: crate::base::math::median(&mut after).unwrap_or(0.0),
            places,
        }
    };
    Some((0..stated.len()).map(of_view).collect())
}

/// Shifts of several pixels, from matches in the reduced images; zero where the search at full
/// resolution finds them.
pub(crate) fn coarse_shifts(check: &EpipolarCheck, cameras: &[Camera]) -> Vec<Vector2<f64>> {
    let none = || vec![Vector2::zeros(); cameras.len()];
    let factor = *check.factors.iter().max().unwrap_or(&1);
    if factor < 2 {
        return none();
    }
    let matches = coarse_matches(check, cameras);
    let Some(adjustment) = ShiftAdjustment::new(check, &matches, cameras, coarse_scale(factor))
    else {
        return none();
    };
    let matters = |s: Vector2<f64>| (s.norm() > MIN_COARSE_SHIFT_PX).then_some(s);
    let found = adjustment.free_views().shifts;
    found
        .into_iter()
        .map(|s| matters(s).unwrap_or_default())
        .collect()
}

/// Matches in the reduced images, in pixels of the full images.
fn coarse_matches(check: &EpipolarCheck, cameras: &[Camera]) -> Vec<Vec<PointMatch>> {
    let (reduced, axis) = (check.reduced(cameras), mean_axis(cameras));
    parallel::map(&check.pairs, |_, &(i, j)| {
        let scale = [i, j].map(|v| check.factors[v] as f64);
        let matched = |(point, x): (usize, &Point2<f64>)| {
            let found = best_match(&reduced[i], &reduced[j], &axis, x)?;
            (found.shift.abs() <= COARSE_SHIFT).then(|| PointMatch {
                point,
                first: x * scale[0],
                second: found.at * scale[1],
            })
        };
        let points = check.points[i].iter().enumerate();
        points.filter_map(matched).collect()
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
