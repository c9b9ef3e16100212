//! Metres and Z up: the block in a frame of the world, and what that rests on.
//!
//! Ground control points come before all of this ([`super::ground_control`]).
//!
//! 1. Stated positions (GPS), three or more that differ by more than their noise: a robust
//!    similarity to them. Heights of consumer receivers are off by tens of metres, all by the same,
//!    which no photograph contradicts. Along a single strip the turn about the strip is open, and
//!    follows from the angles or the plane below. Without heights only the plan counts, about that
//!    vertical.
//! 2. Stated angles (XMP): the direction up of those that agree. The scale is arbitrary.
//! 3. The main plane of the points is level. Scale and north are arbitrary.
//!
//! ```text
//! stated     what is stated of photographs, and where the block has them
//! places     stated positions beside those of the block, and the similarity between them
//! positions  which similarity to stated positions can be true
//! lag        positions that are late along the flight, and what they are worth
//! vertical   up by angles, up by the plane of the points
//! checks     whether a placement can be true
//! words      what is doubtful of all that, for people
//! ```

mod checks;
mod lag;
mod places;
mod positions;
mod stated;
#[cfg(test)]
mod tests;
mod vertical;
mod words;

use nalgebra::{Rotation3, Vector3};

pub(super) use self::checks::{ByControl, Doubt, Placement, doubts, tilt_sigma};
pub use self::lag::Lag;
use self::lag::Stated;
pub(super) use self::places::RECEIVER_SIGMA_M;
use self::positions::by_true_positions;
use self::stated::points;
pub(super) use self::stated::{StatedPose, centers, spread};
use self::vertical::{AnglesFinding, up_of_angles, up_of_plane};
pub(super) use self::vertical::{rotation_of_angles, turn_to_up};
pub(super) use self::words::{NOTHING_STATED, OFFER};
use super::block::Block;
use super::ground_control::ControlResidual;
use super::similarity::Similarity;
use crate::base::geometry::mean_point;
use crate::orienting::orientation::{Anchor, FrameSigma, LinearUnit, linear_unit_of_code};

/// What the frame of the world rests on.
#[derive(Clone, Debug, PartialEq)]
pub enum FrameBasis {
    /// Ground control points.
    Control {
        /// The reference system as it is stated.
        system: String,
        /// Its EPSG code, where coordinates are on a map; the files count in its unit.
        epsg: Option<u32>,
        /// Zero of the coordinates on the Earth, for longitudes and latitudes.
        anchor: Option<Anchor>,
        /// Coordinates on the map of the frame's zero, metres.
        offset: [f64; 3],
        /// The points.
        points: Vec<ControlResidual>,
        /// Root mean square residual of the agreeing control points, in plan and in height, metres.
        rms_m: [f64; 2],
        /// What scale and level are worth.
        sigma: Option<FrameSigma>,
    },
    /// Stated positions.
    Positions {
        /// Zero of the coordinates on the Earth.
        anchor: Anchor,
        /// Photographs whose positions agree.
        agreeing: usize,
        /// Photographs with a stated position.
        stated: usize,
        /// Photographs whose stated heights count; without any the points give the zero.
        heights: usize,
        /// Root mean square distance of the agreeing ones, in plan and in height, metres.
        rms_m: [f64; 2],
        /// Is the vertical, or the turn about the line of flight, from the plane of the points or
        /// from angles?
        is_levelled: bool,
        /// By how much they are behind the photographs along the flight, where that tells.
        lag: Option<Lag>,
        /// What scale and level are worth.
        sigma: Option<FrameSigma>,
    },
    /// Stated angles; the scale is arbitrary.
    Angles {
        /// Root mean square difference of the directions up of those that agree, degrees.
        rms_deg: f64,
        /// Photographs whose angles agree, and those that state angles.
        photos: [usize; 2],
    },
    /// The main plane of the points; scale and north are arbitrary.
    MainPlane,
}

impl FrameBasis {
    /// What files in this frame count in: the unit of its code.
    pub(super) fn unit(&self) -> LinearUnit {
        let code = match self {
            Self::Control { epsg, .. } => *epsg,
            _ => None,
        };
        code.and_then(linear_unit_of_code).unwrap_or_default()
    }
}

/// Height of the mean photograph above the mean point where nothing states the scale, metres.
const ASSUMED_HEIGHT_M: f64 = 100.0;

/// Turns, scales and shifts the block into its frame; with what is doubtful of what is stated.
/// `paths` are those of the photographs. With `applies_fix` angles that share a usual mistake count
/// as they were meant.
pub(super) fn to_frame(
    block: &mut Block,
    stated: &[StatedPose],
    anchor: Option<Anchor>,
    applies_fix: bool,
    paths: &[&str],
) -> (FrameBasis, Vec<String>) {
    let angles = up_of_angles(block, stated, applies_fix);
    let mut notes = words::of_angles(&angles, applies_fix, paths);
    if let Some(anchor) = anchor {
        let (basis, said) = to_positions(block, stated, anchor, &angles, paths);
        notes.extend(said);
        if let Some(basis) = basis {
            return (basis, notes);
        }
    }
    let (up, basis) = by_vertical(block, &angles);
    if notes.is_empty() && basis == FrameBasis::MainPlane {
        notes.push(words::NOTHING_STATED.to_owned());
    }
    let upright = Similarity {
        rotation: up,
        ..Similarity::default()
    };
    upright.apply(block);
    let (cameras, points) = (centers(block), points(block));
    let (camera, point) = (mean_point(&cameras), mean_point(&points));
    let scale = ASSUMED_HEIGHT_M / (camera.z - point.z).abs().max(1e-9);
    let similarity = Similarity {
        scale,
        shift: Vector3::new(camera.x, camera.y, point.z) * -scale,
        ..Similarity::default()
    };
    similarity.apply(block);
    (basis, notes)
}

/// The same by stated positions, if they can be true.
fn to_positions(
    block: &mut Block,
    stated: &[StatedPose],
    anchor: Anchor,
    angles: &AnglesFinding,
    paths: &[&str],
) -> (Option<FrameBasis>, Vec<String>) {
    let (found, mistake) = by_true_positions(block, stated, &anchor, angles);
    let mut notes: Vec<String> = mistake.map(words::of_mistake).into_iter().collect();
    let (first, found, doubt) = match found {
        Ok(found) => found,
        Err(why) => {
            notes.extend(words::of_no_positions(&why));
            return (None, notes);
        }
    };
    notes.extend(doubt.map(|doubt| words::of_heights(&doubt)));
    // Heights that do not fit are none.
    let heights = if doubt.is_some() { 0 } else { found.stated[1] };
    let late = Stated {
        block,
        stated,
        similarity: &first,
        found: &found,
        heights,
    };
    let (similarity, found, lag, sigma) = late.without_lag(angles);
    similarity.apply(block);
    notes.extend(words::of_contradicted(&found.contradicted, paths));
    if heights == 0 {
        let to_ground = Similarity {
            shift: -Vector3::z() * mean_point(&points(block)).z,
            ..Similarity::default()
        };
        to_ground.apply(block);
    }
    let basis = FrameBasis::Positions {
        anchor,
        agreeing: found.agreeing,
        stated: found.stated[0],
        heights,
        rms_m: found.rms_m,
        is_levelled: found.is_levelled,
        lag,
        sigma,
    };
    (Some(basis), notes)
}

/// The turn that makes z vertical by angles, or else by the plane of the points.
fn by_vertical(block: &Block, angles: &AnglesFinding) -> (Rotation3<f64>, FrameBasis) {
    match &angles.by_angles {
        Some(found) => (
            found.turn,
            FrameBasis::Angles {
                rms_deg: found.rms.to_degrees(),
                photos: [0, 1].map(|i| found.photos[i].len()),
            },
        ),
        None => (turn_to_up(&up_of_plane(block)), FrameBasis::MainPlane),
    }
}

/// What speaks against a placement of the block by control points.
pub(super) fn control_doubts(
    block: &Block,
    similarity: &Similarity,
    stated: &[StatedPose],
    tilt_sigma: f64,
    control: ByControl,
) -> Vec<Doubt> {
    let angles = up_of_angles(block, stated, false);
    doubts(&Placement {
        block,
        similarity,
        stated,
        angles: angles.by_angles.as_ref(),
        tilt_sigma,
        control: Some(control),
    })
}
