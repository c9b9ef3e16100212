//! The orientation check: do the images agree with their orientation, and if not, which error
//! explains it?
//!
//! ```text
//! interest_points    corners of the reduced images, spread over the image
//! epipolar           the best match of a point on its epipolar line and on lines shifted across it
//! epipolar_check     share of the points matched on the line, against what chance gives
//! angle_readings     the unit of angles that no file states
//! error_hypothesis   the usual errors of orientation files, and the cameras without them
//! hypothesis_search  the error without which the images agree best
//! subpixel           matches to a fraction of a pixel; an offset of half a pixel
//! shift_adjustment   least squares over tracks of matches
//! shifts             how far each view is shifted against the others
//! heights            between which heights the matches lie
//! finding            what was found, and its report
//! ```
//!
//! Not in the papers, which take the orientation for granted.
//!
//! Invariant: it measures, and names what fits; correcting is left to the scene loader.
//! Invariant: only the images count. An error that moves the whole world (a wrong datum) leaves the
//! views in agreement and is not found here.

mod angle_readings;
mod epipolar;
mod epipolar_check;
mod error_hypothesis;
mod finding;
mod heights;
mod hypothesis_search;
mod interest_points;
mod shift_adjustment;
mod shifts;
mod subpixel;
mod view;

pub use angle_readings::{AngleReadings, cameras_in, try_angle_readings};
pub use error_hypothesis::{AngleOrder, ErrorHypothesis, RotationSequence};
pub use finding::{CheckFinding, OrientationCheck};
pub use heights::surface_heights;
pub use view::CheckedView;

use nalgebra::Vector2;

use self::epipolar_check::{EpipolarCheck, MIN_AGREEMENT, MIN_POINTS, total_agreement};
use self::hypothesis_search::HypothesisSearch;
use crate::base::agreement::Agreement;
use crate::photographs::camera::Camera;

/// In images of a smaller shorter side a line is too short to tell the right match from a wrong
/// one, pixels. Assumption.
const SMALLEST_SIDE_PX: u32 = 128;

/// Least gain in agreement from which on a hypothesis is accepted.
const MIN_GAIN: f64 = 0.12;

/// Checks views, and looks for the error where they do not agree.
pub fn check_orientation(views: &[CheckedView]) -> OrientationCheck {
    let is_small = |v: &CheckedView| v.camera.width.min(v.camera.height) < SMALLEST_SIDE_PX;
    if views.iter().any(is_small) {
        return CheckFinding::Unknown(Agreement::default()).into();
    }
    let mut check = EpipolarCheck::new(views);
    let stated: Vec<Camera> = views.iter().map(|v| v.camera.clone()).collect();
    let mut counts = check.counts(&stated, &check.pairs);
    if total_agreement(&counts).score < MIN_AGREEMENT {
        // Where the orientation may be wrong it does not say which views overlap.
        check.compare_by_list();
        counts = check.counts(&stated, &check.pairs);
    }
    let before = total_agreement(&counts);
    let outliers = check.outlier_views(&counts);
    let coarse = match before.score >= MIN_AGREEMENT {
        true => shifts::coarse_shifts(&check, &stated),
        false => vec![Vector2::zeros(); stated.len()],
    };
    // A view that is only shifted is no outlier.
    let shifted = shifts::shifted(&stated, &coarse);
    let has_outliers = !outliers.is_empty() && {
        let counts = check.counts(&shifted, &check.pairs);
        !check.outlier_views(&counts).is_empty()
    };
    if before.score >= MIN_AGREEMENT && !has_outliers {
        let matches = subpixel::matches(&check, views, &shifted);
        let shifts = shifts::shifts(&check, &matches, &stated, &coarse).unwrap_or_default();
        let offset = subpixel::half_pixel_offset(&check, views, &stated, &matches);
        let offset = offset.map(|(hypothesis, offsets_px)| CheckFinding::Offset {
            hypothesis,
            agreement: before,
            offsets_px,
            words: hypothesis.describe(views),
        });
        return OrientationCheck {
            shifts,
            ..offset.unwrap_or(CheckFinding::Sound(before)).into()
        };
    }
    let HypothesisSearch {
        best: (after, best),
        tested,
    } = HypothesisSearch::run(&check, views, &outliers, before);
    let finding = match best {
        Some(hypothesis)
            if after.score >= MIN_AGREEMENT && after.score >= before.score + MIN_GAIN =>
        {
            CheckFinding::Explained {
                before,
                after,
                hypothesis,
                words: hypothesis.describe(views),
            }
        }
        _ if before.points < MIN_POINTS => CheckFinding::Unknown(before),
        _ if !outliers.is_empty() => CheckFinding::OutlierViews(before, outliers),
        _ => CheckFinding::Unexplained(before),
    };
    OrientationCheck {
        tested,
        ..finding.into()
    }
}
