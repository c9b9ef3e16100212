//! The unit of angles that no file states: the one with which the images agree.

use super::epipolar_check::{EpipolarCheck, MIN_AGREEMENT};
use super::view::CheckedView;
use super::{MIN_GAIN, SMALLEST_SIDE_PX};
use crate::base::agreement::Agreement;
use crate::orienting::orientation::AngleUnit;
use crate::photographs::camera::Camera;

/// How well the images agree with each reading of the angles.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleReadings {
    /// The reading that the cameras have.
    pub guess: AngleUnit,
    /// The one that the images decide for, where they do.
    pub decided: Option<AngleUnit>,
    /// The agreement under each.
    pub agreements: Vec<(AngleUnit, Agreement)>,
}

/// Tries the readings of the angles; `None` where the files state the unit, or the images are too
/// small to decide anything.
pub fn try_angle_readings(views: &[CheckedView]) -> Option<AngleReadings> {
    let is_small = |v: &CheckedView| v.camera.width.min(v.camera.height) < SMALLEST_SIDE_PX;
    let first = views.first()?;
    let guess = (first.readings.iter())
        .find(|(_, r)| *r == first.camera.r)?
        .0;
    let units: Vec<AngleUnit> = first.readings.iter().map(|(unit, _)| *unit).collect();
    if views.iter().any(is_small) {
        return None;
    }
    let check = EpipolarCheck::new(views);
    let mut agreements = Vec::new();
    for unit in units {
        agreements.push((unit, check.agreement(&cameras_in(views, unit)?)));
    }
    let of_guess = (agreements.iter()).find(|(unit, _)| *unit == guess)?.1;
    let best = (agreements.iter())
        .reduce(|a, b| if b.1.score > a.1.score { b } else { a })
        .filter(|(_, agreement)| agreement.score >= MIN_AGREEMENT)?;
    let (unit, agreement) = *best;
    // The guess stays where another reading is not clearly better.
    let decided = match unit == guess || agreement.score >= of_guess.score + MIN_GAIN {
        true => Some(unit),
        false => None,
    };
    Some(AngleReadings {
        guess,
        decided,
        agreements,
    })
}

/// The cameras with the angles read in this unit; `None` where a view has no such reading.
pub fn cameras_in(views: &[CheckedView], unit: AngleUnit) -> Option<Vec<Camera>> {
    let of_view = |view: &CheckedView| {
        let (_, r) = view.readings.iter().find(|(u, _)| *u == unit)?;
        Some(Camera {
            r: *r,
            ..view.camera.clone()
        })
    };
    views.iter().map(of_view).collect()
}
